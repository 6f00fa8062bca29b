#include "mesh/MeshBuilder.h"
#include "mesh/bytes.h"
#include "mesh/meshFile.h"
#include "mesh/words.h"

#include <algorithm>

namespace rockfall
{

namespace
{

struct Property
{
  std::string name;
  NumberType type = NumberType::None;  ///< Of the value, or of each of a list's.
  NumberType count = NumberType::None; ///< Of a list's length; None if it is no list.
};

struct Element
{
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

NumberType typeOf(std::string_view word)
{
  using enum NumberType;
  const std::pair<std::string_view, NumberType> types[] = { { "char", Int8 }, { "int8", Int8 },
    { "uchar", UInt8 }, { "uint8", UInt8 }, { "short", Int16 }, { "int16", Int16 },
    { "ushort", UInt16 }, { "uint16", UInt16 }, { "int", Int32 }, { "int32", Int32 },
    { "uint", UInt32 }, { "uint32", UInt32 }, { "float", Float32 }, { "float32", Float32 },
    { "double", Float64 }, { "float64", Float64 } };
  for (const auto& [name, type] : types)
  {
    if (name == word)
    {
      return type;
    }
  }
  return None;
}

enum class Format
{
  None,
  Text,
  LittleEndian,
  BigEndian
};

class PlyReader
{
public:
  PlyReader(std::string_view bytes, const std::string& name)
    : words_(bytes, name)
    , mesh_(name)
  {
  }

  Mesh read()
  {
    this->readHeader();
    for (const Element& element : elements_)
    {
      this->checkCount(element);
      for (std::int64_t k = 0; k < element.count; ++k)
      {
        this->readRecord(element);
      }
    }
    return mesh_.finish(single_, digits_);
  }

private:
  void readHeader()
  {
    if (words_.nextInLine() != "ply")
    {
      words_.fail("is no PLY file, which begins with \"ply\"");
    }
    words_.restOfLine();
    for (std::string_view keyword = words_.next(); keyword != "end_header"; keyword = words_.next())
    {
      if (keyword == "format")
      {
        const std::string_view word = words_.nextInLine();
        format_ = word == "ascii"          ? Format::Text
          : word == "binary_little_endian" ? Format::LittleEndian
          : word == "binary_big_endian"    ? Format::BigEndian
                                           : Format::None;
      }
      else if (keyword == "element")
      {
        Element& element = elements_.emplace_back();
        element.name = words_.nextInLine();
        element.count = parsedInteger(words_.nextInLine()).value_or(-1);
        if (element.count < 0)
        {
          words_.fail("an element of the header has a name and a number, not negative");
        }
      }
      else if (keyword == "property")
      {
        this->readProperty();
      }
      else if (keyword != "comment" && keyword != "obj_info")
      {
        keyword.empty() ? words_.failTruncated()
                        : words_.fail(inQuotes(keyword) + " is no line of a PLY header");
      }
      words_.restOfLine();
    }
    words_.restOfLine();
    if (format_ == Format::None)
    {
      words_.fail("the header says no format: ascii, binary_little_endian or binary_big_endian");
    }
  }

  void readProperty()
  {
    Property property;
    std::string_view word = words_.nextInLine();
    if (word == "list")
    {
      property.count = typeOf(words_.nextInLine());
      if (property.count == NumberType::None || isReal(property.count))
      {
        words_.fail("the length of a list must be of a whole type: uchar, int …");
      }
      word = words_.nextInLine();
    }
    property.type = typeOf(word);
    property.name = words_.nextInLine();
    if (property.type == NumberType::None || property.name.empty() || elements_.empty())
    {
      words_.fail("a property of the header has an element before it, a type and a name; the type "
                  "here is " +
        inQuotes(word));
    }
    elements_.back().properties.push_back(property);
  }

  /// Elements that the header announces must have room in the rest of the file.
  void checkCount(const Element& element)
  {
    std::size_t least = 0; // bytes of a record
    for (const Property& p : element.properties)
    {
      least += format_ == Format::Text
        ? 2
        : std::size_t(sizeOf(p.count == NumberType::None ? p.type : p.count));
    }
    // The last word of a text has no blank behind it.
    const std::size_t left = words_.rest().size() + (format_ == Format::Text ? 1 : 0);
    if (element.count > 0 && (least == 0 || std::uint64_t(element.count) > left / least))
    {
      throw FileError(words_.name() + ": is truncated: its header announces " +
        std::to_string(element.count) + " of the element " + inQuotes(element.name) +
        ", there is room for " + std::to_string(least == 0 ? 0 : left / least));
    }
    if (element.name == "vertex")
    {
      for (const char* axis : { "x", "y", "z" })
      {
        const auto is = [&](const Property& p)
        { return p.name == axis && p.count == NumberType::None; };
        const auto found = std::find_if(element.properties.begin(), element.properties.end(), is);
        if (found == element.properties.end())
        {
          throw FileError(
            words_.name() + ": its element \"vertex\" has no property \"" + axis + "\"");
        }
        single_ = single_ || (format_ != Format::Text && found->type == NumberType::Float32);
      }
    }
  }

  double takeReal(NumberType type)
  {
    if (format_ == Format::Text)
    {
      const std::string_view word = words_.next();
      const auto value = parsedNumber(word);
      if (!value)
      {
        word.empty() ? words_.failTruncated() : words_.fail(inQuotes(word) + " is not a number");
      }
      lastWord_ = word;
      return *value;
    }
    const double value = takeNumber(type, this->take(sizeOf(type)), format_ == Format::BigEndian);
    lastWord_ = {};
    return value;
  }

  std::int64_t takeWhole(NumberType type)
  {
    return format_ == Format::Text
      ? words_.integer()
      : std::int64_t(takeNumber(type, this->take(sizeOf(type)), format_ == Format::BigEndian));
  }

  /// The next bytes, which are read.
  const char* take(int size)
  {
    const std::string_view rest = words_.rest();
    if (rest.size() < std::size_t(size))
    {
      throw FileError(words_.name() + ": is truncated: its header announces more points or faces");
    }
    words_.skip(std::size_t(size));
    return rest.data();
  }

  void readRecord(const Element& element)
  {
    const bool vertex = element.name == "vertex";
    Vec3 point = Vec3::Zero();
    for (const Property& p : element.properties)
    {
      if (p.count != NumberType::None)
      {
        this->readList(element, p);
        continue;
      }
      const double value = this->takeReal(p.type);
      const int axis = p.name == "x" ? 0 : p.name == "y" ? 1 : p.name == "z" ? 2 : -1;
      if (vertex && axis >= 0)
      {
        point[axis] = value;
        if (!lastWord_.empty())
        {
          digits_.add(lastWord_, value);
        }
      }
    }
    if (vertex)
    {
      mesh_.addPoint(point);
    }
  }

  void readList(const Element& element, const Property& p)
  {
    const std::int64_t length = this->takeWhole(p.count);
    const std::size_t room =
      (words_.rest().size() + 1) / (format_ == Format::Text ? 2 : std::size_t(sizeOf(p.type)));
    if (length < 0 || std::uint64_t(length) > room)
    {
      throw FileError(words_.name() + ": a list of the element " + inQuotes(element.name) +
        " has " + std::to_string(length) + " numbers, there is room for " + std::to_string(room));
    }
    const bool indices = p.name == "vertex_indices" || p.name == "vertex_index";
    const bool face = element.name == "face" && indices;
    const bool strips = element.name == "tristrips" && indices;
    if ((face || strips) && isReal(p.type))
    {
      throw FileError(words_.name() + ": the numbers of a face's points are of the type " +
        (p.type == NumberType::Float32 ? "float" : "double") + ", they must be whole");
    }
    ids_.clear();
    for (std::int64_t k = 0; k < length; ++k)
    {
      if (!face && !strips)
      {
        this->takeReal(p.type);
        continue;
      }
      ids_.push_back(this->takeWhole(p.type));
      if (strips && ids_.back() == -1) // begins another strip
      {
        ids_.pop_back();
        mesh_.addStrip(ids_);
        ids_.clear();
      }
    }
    if (strips)
    {
      mesh_.addStrip(ids_);
    }
    else if (face)
    {
      mesh_.addFace(ids_);
    }
  }

  Words words_;
  MeshBuilder mesh_;
  Format format_ = Format::None;
  std::vector<Element> elements_;
  bool single_ = false;
  WrittenDigits digits_;
  std::string_view lastWord_;
  std::vector<std::int64_t> ids_;
};

} // namespace

Mesh parsePly(std::string_view bytes, const std::string& name)
{
  return PlyReader(bytes, name).read();
}

} // namespace rockfall
