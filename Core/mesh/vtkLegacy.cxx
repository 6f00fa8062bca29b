#include "mesh/MeshBuilder.h"
#include "mesh/bytes.h"
#include "mesh/cells.h"
#include "mesh/meshFile.h"
#include "mesh/words.h"

#include <algorithm>
#include <optional>

namespace rockfall
{

namespace
{

/// Numbers of VTK's kinds of cells that are faces.
enum CellType
{
  Triangle = 5,
  Strip = 6,
  Polygon = 7,
  Quad = 9
};

/// None also for bits and strings, which points and cells are never of.
NumberType legacyTypeOf(std::string_view word)
{
  using enum NumberType;
  // A vtkIdType is written as an int, whatever it is in memory.
  const std::pair<std::string_view, NumberType> types[] = { { "char", Int8 },
    { "signed_char", Int8 }, { "unsigned_char", UInt8 }, { "short", Int16 },
    { "unsigned_short", UInt16 }, { "int", Int32 }, { "unsigned_int", UInt32 }, { "long", Int64 },
    { "unsigned_long", UInt64 }, { "vtkidtype", Int32 }, { "vtktypeint64", Int64 },
    { "vtktypeuint64", UInt64 }, { "float", Float32 }, { "double", Float64 } };
  for (const auto& [name, type] : types)
  {
    if (name == word)
    {
      return type;
    }
  }
  return None;
}

class LegacyReader
{
public:
  LegacyReader(std::string_view bytes, const std::string& name)
    : words_(bytes, name)
    , mesh_(name)
  {
  }

  Mesh read()
  {
    this->readHeader();
    for (std::string keyword = lowerCase(words_.next());
         !keyword.empty() && keyword != "cell_data" && keyword != "point_data";
         keyword = lowerCase(words_.next()))
    {
      this->readSection(keyword);
    }
    this->addGridFaces();
    return mesh_.finish(single_, digits_);
  }

private:
  void readHeader()
  {
    const std::string_view first = words_.restOfLine();
    constexpr std::string_view start = "# vtk DataFile Version ";
    if (first.substr(0, start.size()) != start)
    {
      throw FileError(
        words_.name() + ": is no VTK file, which begins with \"" + std::string(start) + "\"");
    }
    double version = 0.0;
    parseNumber(trimmed(first.substr(start.size())), version);
    offsets_ = version >= 5.0;
    words_.restOfLine(); // a title
    const std::string format = lowerCase(words_.next());
    words_.restOfLine();
    binary_ = format == "binary";
    if (!binary_ && format != "ascii")
    {
      words_.fail("the third line of a VTK file is ASCII or BINARY, not " + inQuotes(format));
    }
    const std::string keyword = lowerCase(words_.next());
    const std::string_view kind = words_.nextInLine();
    const std::string lower = lowerCase(kind);
    grid_ = lower == "unstructured_grid";
    if (keyword != "dataset" || (!grid_ && lower != "polydata" && lower != "structured_grid"))
    {
      words_.fail("a DATASET of the kind POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID is needed" +
        (kind.empty() ? std::string() : ", not " + inQuotes(kind)));
    }
    words_.restOfLine();
  }

  void readSection(const std::string& keyword)
  {
    if (keyword == "points")
    {
      this->readPoints();
    }
    else if (keyword == "polygons")
    {
      this->readCells([this](std::size_t, auto ids) { mesh_.addFace(ids); });
    }
    else if (keyword == "triangle_strips")
    {
      this->readCells([this](std::size_t, auto ids) { mesh_.addStrip(ids); });
    }
    else if (keyword == "vertices" || keyword == "lines")
    {
      this->readCells([](std::size_t, auto) {});
    }
    else if (keyword == "cells" && grid_)
    {
      this->readCells(
        [this](std::size_t, auto ids) { cells_.emplace_back(ids.begin(), ids.end()); });
    }
    else if (keyword == "cell_types" && grid_)
    {
      const std::int64_t count = this->count();
      words_.restOfLine();
      types_ = this->wholes(count, NumberType::Int32);
    }
    else if (keyword == "dimensions")
    {
      words_.restOfLine();
    }
    else if (keyword == "field")
    {
      this->skipFields();
    }
    else if (keyword == "metadata")
    {
      this->skipMetadata();
    }
    else
    {
      words_.fail(inQuotes(keyword) + " is no part of a VTK file of points and faces");
    }
  }

  std::int64_t count()
  {
    const std::int64_t value = words_.integer();
    if (value < 0)
    {
      words_.fail(std::to_string(value) + " is no count");
    }
    return value;
  }

  /// Throws unless as many numbers have room in what follows.
  void checkRoom(std::int64_t count, std::size_t size)
  {
    const std::size_t left = words_.rest().size();
    const std::size_t room = binary_ ? left / size : (left + 1) / 2;
    if (std::uint64_t(count) > room)
    {
      throw FileError(words_.name() + ": is truncated: it announces " + std::to_string(count) +
        " numbers, there is room for " + std::to_string(room));
    }
  }

  void readPoints()
  {
    const std::int64_t count = this->count();
    const std::string word = lowerCase(words_.nextInLine());
    const NumberType type = legacyTypeOf(word);
    if (type == NumberType::None)
    {
      words_.fail(inQuotes(word) + " is no type that points have");
    }
    words_.restOfLine();
    this->checkRoom(count, 3 * std::size_t(sizeOf(type)));
    single_ = binary_ && type == NumberType::Float32;
    for (std::int64_t k = 0; k < count; ++k)
    {
      Vec3 point;
      for (double& coordinate : point)
      {
        if (binary_)
        {
          coordinate = takeNumber(type, this->take(sizeOf(type)), true);
          continue;
        }
        const std::string_view text = words_.next();
        if (!parseNumber(text, coordinate))
        {
          text.empty() ? words_.failTruncated() : words_.fail(inQuotes(text) + " is not a number");
        }
        digits_.add(text, coordinate);
      }
      mesh_.addPoint(point);
    }
  }

  const char* take(int size)
  {
    const std::string_view rest = words_.rest();
    if (rest.size() < std::size_t(size))
    {
      throw FileError(words_.name() + ": is truncated");
    }
    words_.skip(std::size_t(size));
    return rest.data();
  }

  std::vector<std::int64_t> wholes(std::int64_t count, NumberType type)
  {
    this->checkRoom(count, std::size_t(sizeOf(type)));
    std::vector<std::int64_t> values;
    for (std::int64_t k = 0; k < count; ++k)
    {
      values.push_back(
        binary_ ? takeInteger(type, this->take(sizeOf(type)), true) : words_.integer());
    }
    return values;
  }

  /// Reads one of the two lists of a newer file.
  std::vector<std::int64_t> wholes(std::int64_t count, std::string_view keyword)
  {
    if (lowerCase(words_.next()) != keyword)
    {
      words_.fail("the cells have no list of " + std::string(keyword));
    }
    const std::string word = lowerCase(words_.nextInLine());
    const NumberType type = legacyTypeOf(word);
    if (type == NumberType::None || isReal(type))
    {
      words_.fail(inQuotes(word) + " is no type of whole numbers");
    }
    words_.restOfLine();
    return this->wholes(count, type);
  }

  void readCells(const UseCell& use)
  {
    const std::int64_t count = this->count(), size = this->count();
    words_.restOfLine();
    if (!offsets_)
    {
      forEachCell(this->wholes(size, NumberType::Int32), words_.name(), use);
      return;
    }
    if (count > 0)
    {
      const std::vector<std::int64_t> offsets = this->wholes(count, "offsets");
      forEachCell(offsets, true, this->wholes(size, "connectivity"), words_.name(), use);
    }
  }

  void skipFields()
  {
    words_.nextInLine(); // name
    const std::int64_t arrays = this->count();
    words_.restOfLine();
    for (std::int64_t k = 0; k < arrays; ++k)
    {
      std::string_view name = words_.next();
      while (lowerCase(name) == "metadata")
      {
        this->skipMetadata();
        name = words_.next();
      }
      if (name.empty())
      {
        words_.failTruncated();
      }
      if (name == "NULL_ARRAY")
      {
        continue;
      }
      const std::int64_t components = this->count(), tuples = this->count();
      const std::string type = lowerCase(words_.nextInLine());
      words_.restOfLine();
      // A bit takes the least room of all.
      if (components > 0 && tuples > std::int64_t(words_.rest().size() * 8 + 8) / components)
      {
        words_.failTruncated();
      }
      this->skipArray(components * tuples, type);
    }
  }

  void skipArray(std::int64_t values, const std::string& type)
  {
    const bool text = type == "string" || type == "utf8_string";
    const bool bits = type == "bit";
    if (!text && !bits && legacyTypeOf(type) == NumberType::None)
    {
      words_.fail(inQuotes(type) + " is no type of numbers");
    }
    if (binary_ && !text)
    {
      const std::int64_t bytes = bits ? (values + 7) / 8 : values * sizeOf(legacyTypeOf(type));
      if (bytes > std::int64_t(words_.rest().size()))
      {
        words_.failTruncated();
      }
      words_.skip(std::size_t(bytes));
      return;
    }
    for (std::int64_t k = 0; k < values; ++k)
    {
      if (words_.atEnd())
      {
        words_.failTruncated();
      }
      if (binary_)
      {
        this->skipString();
      }
      else if (text)
      {
        words_.restOfLine();
      }
      else
      {
        words_.next();
      }
    }
  }

  /// A length of 6, 14, 30 or 62 bits, whose first two bits say which, and as many bytes.
  void skipString()
  {
    const auto first = static_cast<unsigned char>(words_.rest().front());
    const int size = 1 << (3 - (first >> 6));
    const char* bytes = this->take(size);
    std::uint64_t length = first & 0x3FU;
    for (int k = 1; k < size; ++k)
    {
      length = length << 8 | static_cast<unsigned char>(bytes[k]);
    }
    words_.skip(std::size_t(length));
  }

  /// To an empty line.
  void skipMetadata()
  {
    words_.restOfLine();
    while (!words_.atEnd() && !trimmed(words_.restOfLine()).empty())
    {
    }
  }

  /// Cells of an unstructured grid are the body's faces if all of them are faces.
  void addGridFaces()
  {
    const auto isFace = [](std::int64_t type)
    { return type == Triangle || type == Strip || type == Polygon || type == Quad; };
    if (cells_.empty())
    {
      return;
    }
    if (types_.size() != cells_.size())
    {
      throw FileError(words_.name() + ": has " + std::to_string(cells_.size()) + " cells and " +
        std::to_string(types_.size()) + " types of cells");
    }
    if (!std::all_of(types_.begin(), types_.end(), isFace))
    {
      mesh_.note(words_.name() +
        ": its cells are not all of them faces, so the convex hull of its points is taken");
      return;
    }
    for (std::size_t k = 0; k < cells_.size(); ++k)
    {
      types_[k] == Strip ? mesh_.addStrip(cells_[k]) : mesh_.addFace(cells_[k]);
    }
  }

  Words words_;
  MeshBuilder mesh_;
  bool offsets_ = false; ///< As from version 5 on.
  bool binary_ = false;
  bool grid_ = false;
  bool single_ = false;
  WrittenDigits digits_;
  std::vector<std::vector<std::int64_t>> cells_; ///< Of an unstructured grid.
  std::vector<std::int64_t> types_;
};

} // namespace

Mesh parseVtkLegacy(std::string_view bytes, const std::string& name)
{
  return LegacyReader(bytes, name).read();
}

} // namespace rockfall
