#include "plyCheck.h"

#include "base/errors.h"

#include "vtksys/FStream.hxx"

#include <cstdint>
#include <map>
#include <sstream>
#include <vector>

namespace rockfall::filters
{

namespace
{

struct Property
{
  int size = 0;      ///< Of the value, or of each of a list's, bytes.
  int countSize = 0; ///< Of a list's length, bytes; 0 if it is no list.
};

struct Element
{
  std::int64_t count = 0;
  std::vector<Property> properties;
};

struct Header
{
  std::string format;
  std::vector<Element> elements;
};

int sizeOf(const std::string& type)
{
  static const std::map<std::string, int> sizes = { { "char", 1 }, { "uchar", 1 }, { "int8", 1 },
    { "uint8", 1 }, { "short", 2 }, { "ushort", 2 }, { "int16", 2 }, { "uint16", 2 }, { "int", 4 },
    { "uint", 4 }, { "int32", 4 }, { "uint32", 4 }, { "float", 4 }, { "float32", 4 },
    { "double", 8 }, { "float64", 8 } };
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

/// Leaves the stream where the data begin. An empty format says that it is no header.
Header readHeader(std::istream& file)
{
  Header header;
  std::string line;
  if (!std::getline(file, line) || line.substr(0, 3) != "ply")
  {
    return {};
  }
  while (std::getline(file, line))
  {
    std::istringstream words(line);
    std::string key, type;
    words >> key;
    if (key == "format")
    {
      words >> header.format;
    }
    else if (key == "element")
    {
      Element element;
      words >> type >> element.count;
      if (!words || element.count < 0)
      {
        return {};
      }
      header.elements.push_back(element);
    }
    else if (key == "property" && !header.elements.empty())
    {
      Property property;
      words >> type;
      if (type == "list")
      {
        std::string count;
        words >> count >> type;
        property.countSize = sizeOf(count);
      }
      property.size = sizeOf(type);
      if (property.size == 0)
      {
        return {};
      }
      header.elements.back().properties.push_back(property);
    }
    else if (key == "end_header")
    {
      return header;
    }
  }
  return {};
}

/// One line for each element, with at least a word for each property.
bool completeText(std::istream& file, const Header& header)
{
  std::string line, word;
  for (const Element& element : header.elements)
  {
    for (std::int64_t k = 0; k < element.count; ++k)
    {
      if (!std::getline(file, line))
      {
        return false;
      }
      std::istringstream words(line);
      for (const Property& property : element.properties)
      {
        std::int64_t values = 1;
        if (property.countSize > 0 && !(words >> values))
        {
          return false;
        }
        for (; values > 0; --values)
        {
          if (!(words >> word))
          {
            return false;
          }
        }
      }
    }
  }
  return true;
}

bool completeBinary(std::istream& file, const Header& header)
{
  const bool big = header.format == "binary_big_endian";
  const auto start = file.tellg();
  file.seekg(0, std::ios::end);
  std::int64_t left = file.tellg() - start;
  file.seekg(start);
  for (const Element& element : header.elements)
  {
    for (std::int64_t k = 0; k < element.count; ++k)
    {
      for (const Property& property : element.properties)
      {
        std::int64_t values = 1;
        if (property.countSize > 0)
        {
          unsigned char bytes[8] = {};
          file.read(reinterpret_cast<char*>(bytes), property.countSize);
          values = 0;
          for (int b = 0; b < property.countSize; ++b)
          {
            values |= std::int64_t(bytes[b]) << 8 * (big ? property.countSize - 1 - b : b);
          }
          left -= property.countSize;
        }
        left -= values * property.size;
        if (left < 0 || !file.seekg(values * property.size, std::ios::cur))
        {
          return false;
        }
      }
    }
  }
  return true;
}

} // namespace

void checkPly(const std::string& fileName)
{
  vtksys::ifstream file(fileName.c_str(), std::ios::in | std::ios::binary);
  const Header header = readHeader(file);
  const bool text = header.format == "ascii";
  if (!text && header.format.substr(0, 7) != "binary_")
  {
    throw FileError(fileName + ": has no complete PLY header");
  }
  if (!(text ? completeText(file, header) : completeBinary(file, header)))
  {
    throw FileError(fileName + ": is truncated: its header announces more points or faces");
  }
}

} // namespace rockfall::filters
