#include "gis/sources.h"

#include "base/errors.h"
#include "gis/crs.h"
#include "gis/gdal.h"

#include <cpl_csv.h>
#include <cpl_string.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace rockfall
{

namespace
{

using namespace gis;

std::string trimmed(const std::string& text)
{
  const char* const blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  return first == std::string::npos ? std::string()
                                    : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// All of the text, with a decimal point in every locale; nothing if any of it is no number.
std::optional<double> parsed(const std::string& text)
{
  const char* first = text.data() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
  const char* const last = text.data() + text.size();
  double value = 0.0;
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last ? std::optional(value) : std::nullopt;
}

/// One feature of the layer, asked by column name.
class Row
{
public:
  Row(const std::string& fileName, const std::map<std::string, int>& columns,
    const OGRFeature& feature, std::int64_t number)
    : fileName_(fileName)
    , columns_(columns)
    , feature_(feature)
    , number_(number)
  {
  }

  [[noreturn]] void fail(const std::string& what) const
  {
    throw DataError(fileName_ + ", row " + std::to_string(number_) + ": " + what);
  }

  std::optional<std::string> text(const std::string& name) const
  {
    const auto column = columns_.find(name);
    if (column == columns_.end() || !feature_.IsFieldSetAndNotNull(column->second))
    {
      return std::nullopt;
    }
    const std::string value = trimmed(feature_.GetFieldAsString(column->second));
    return value.empty() ? std::nullopt : std::optional(value);
  }

  std::optional<double> number(const std::string& name) const
  {
    const auto written = this->text(name);
    if (!written)
    {
      return std::nullopt;
    }
    const int column = columns_.at(name);
    const OGRFieldType type = feature_.GetFieldDefnRef(column)->GetType();
    // A field of numbers is taken as such: its text is rounded.
    const auto value = type == OFTReal || type == OFTInteger || type == OFTInteger64
      ? std::optional(feature_.GetFieldAsDouble(column))
      : parsed(*written);
    if (!value)
    {
      const bool comma = written->find(',') != std::string::npos;
      this->fail("field \"" + name + "\": \"" + *written + "\" is not a number" +
        (comma ? " (the decimal sign is a point)" : ""));
    }
    if (!std::isfinite(*value))
    {
      this->fail("field \"" + name + "\" is " + *written + ", it must be finite");
    }
    return value;
  }

  std::optional<double> positive(const std::string& name) const
  {
    const auto value = this->number(name);
    if (value && !(*value > 0.0))
    {
      this->fail("field \"" + name + "\" is " + gis::number(*value) + ", it must be above 0");
    }
    return value;
  }

  double needed(const std::string& name) const
  {
    const auto value = this->number(name);
    if (!value)
    {
      this->fail("field \"" + name + "\" is " +
        (columns_.count(name) ? "empty" : "missing: the layer has no such column") +
        ", and the row has no " + (name == "z" ? "elevation" : "point") + " of its own");
    }
    return *value;
  }

  /// Empty if none of the three is there.
  std::optional<Vec3> vector(const std::array<const char*, 3>& names) const
  {
    std::optional<Vec3> result;
    for (int i = 0; i < 3; ++i)
    {
      if (const auto value = this->number(names[i]))
      {
        result = result.value_or(Vec3::Zero());
        (*result)[i] = *value;
      }
    }
    return result;
  }

  std::optional<Vec3> lengths() const
  {
    const auto x = this->positive("lx"), y = this->positive("ly"), z = this->positive("lz");
    if (!x && !y && !z)
    {
      return std::nullopt;
    }
    if (!x || !y || !z)
    {
      this->fail(std::string("field \"") +
        (!x      ? "lx"
            : !y ? "ly"
                 : "lz") +
        "\" is empty; a box needs all of lx, ly and lz");
    }
    return Vec3(*x, *y, *z);
  }

  std::optional<Shape> shape() const
  {
    const auto name = this->text("shape");
    if (!name)
    {
      return std::nullopt;
    }
    try
    {
      return shapeFromName(*name);
    }
    catch (const Error& error)
    {
      this->fail(std::string("field \"shape\": ") + error.what());
    }
  }

  /// The feature's point, or null if it has no geometry. A collection of one point is one, too:
  /// some programs write nothing else.
  const OGRPoint* point() const
  {
    const OGRGeometry* geometry = feature_.GetGeometryRef();
    if (!geometry || geometry->IsEmpty())
    {
      return nullptr;
    }
    if (wkbFlatten(geometry->getGeometryType()) == wkbMultiPoint)
    {
      const OGRMultiPoint& points = *geometry->toMultiPoint();
      if (points.getNumGeometries() != 1)
      {
        this->fail("geometry is a MULTIPOINT of " + std::to_string(points.getNumGeometries()) +
          " points, one point is needed");
      }
      return points.getGeometryRef(0);
    }
    if (wkbFlatten(geometry->getGeometryType()) != wkbPoint)
    {
      this->fail(
        std::string("geometry is a ") + geometry->getGeometryName() + ", a POINT is needed");
    }
    return geometry->toPoint();
  }

private:
  const std::string& fileName_;
  const std::map<std::string, int>& columns_;
  const OGRFeature& feature_;
  std::int64_t number_;
};

/// Brings points to the CRS of the terrain.
struct Placing
{
  CrsPtr from;
  CrsPtr to;
  CrsChange change;
  double heightUnit = 1.0; ///< m

  Vec3 operator()(const Row& row) const
  {
    const OGRPoint* point = row.point();
    if (!point)
    {
      return { row.needed("x"), row.needed("y"), row.needed("z") };
    }
    Vec3 place(point->getX(), point->getY(), 0.0);
    place.z() = point->Is3D() ? point->getZ() * heightUnit : row.needed("z");
    if (!place.allFinite())
    {
      row.fail("the point " + number(place.x()) + ", " + number(place.y()) + ", " +
        number(place.z()) + " is not finite");
    }
    const Vec3 written = place;
    if (!change.forth(1, &place.x(), &place.y()))
    {
      row.fail("the point " + number(written.x()) + ", " + number(written.y()) +
        " cannot be brought from " + crsLabel(*from) + " to " + crsLabel(*to));
    }
    return place;
  }
};

/// OGR drops what stands beyond the last column of the header, so a table whose decimal commas
/// split every number in two would be read without a word.
void refuseSurplusCells(const std::string& fileName)
{
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(
    VSIFOpenL(fileName.c_str(), "rb"), VSIFCloseL);
  const char* first = file ? CPLReadLineL(file.get()) : nullptr;
  if (!first)
  {
    return;
  }
  const char separator = CSVDetectSeperator(first);
  VSIRewindL(file.get());
  const auto next = [&] { return CPLStringList(CSVReadParseLine2L(file.get(), separator)); };
  const int columns = next().size();
  for (std::int64_t row = 1; !VSIFEofL(file.get()); ++row)
  {
    const CPLStringList cells = next();
    for (int i = columns; i < cells.size(); ++i)
    {
      if (!trimmed(cells[i]).empty())
      {
        throw DataError(fileName + ", row " + std::to_string(row) + ": has " +
          std::to_string(cells.size()) + " fields, the header " + std::to_string(columns) + "; \"" +
          cells[i] + "\" is one too many (the decimal sign is a point)");
      }
    }
  }
}

std::map<std::string, int> columnsOf(const OGRFeatureDefn& definition)
{
  std::map<std::string, int> columns;
  for (int i = 0; i < definition.GetFieldCount(); ++i)
  {
    std::string name = trimmed(definition.GetFieldDefn(i)->GetNameRef());
    // ASCII only, on purpose: tolower would ask the locale.
    std::transform(name.begin(), name.end(), name.begin(),
      [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    columns.emplace(name, i); // the first of two that differ in case only
  }
  return columns;
}

} // namespace

std::string wktOfCrs(const std::string& text)
{
  Messages messages;
  const CrsPtr crs = text.empty() ? nullptr : crsFromText(text);
  return crs ? crsWkt(*crs) : std::string();
}

std::vector<SourceRow> readSources(
  const std::string& fileName, const std::string& targetCrs, std::string* crs)
{
  Messages messages;
  const DatasetPtr dataset = openVector(fileName, messages);
  if (dataset->GetLayerCount() == 0)
  {
    throw DataError(fileName + ": has no layer");
  }
  if (dataset->GetDriver() && EQUAL(dataset->GetDriver()->GetDescription(), "CSV"))
  {
    refuseSurplusCells(fileName);
  }
  OGRLayer& layer = *dataset->GetLayer(0);
  const auto columns = columnsOf(*layer.GetLayerDefn());

  Placing placing;
  placing.from = horizontalCrs(layer.GetSpatialRef());
  placing.heightUnit = verticalUnit(layer.GetSpatialRef());
  if (!targetCrs.empty())
  {
    placing.to = crsFromText(targetCrs);
    placing.change = CrsChange(placing.from, placing.to);
  }

  std::vector<SourceRow> rows;
  bool allHavePoints = true;
  messages.clear();
  while (const OGRFeatureUniquePtr feature{ layer.GetNextFeature() })
  {
    const Row row(fileName, columns, *feature, std::int64_t(rows.size()) + 1);
    // OGR only warns where a typed table (.csvt) holds text in a column of numbers, and gives 0.
    if (messages.warning().find("Invalid value type") != std::string::npos)
    {
      row.fail(messages.warning());
    }
    SourceRow source;
    source.row = std::int64_t(rows.size()) + 1;
    source.position = placing(row);
    allHavePoints = allHavePoints && row.point();
    source.shape = row.shape();
    source.volume = row.positive("volume");
    source.density = row.positive("density");
    source.velocity = row.vector({ "vx", "vy", "vz" });
    source.angularVelocity = row.vector({ "wx", "wy", "wz" });
    source.orientation = row.vector({ "rx", "ry", "rz" });
    source.lengths = row.lengths();
    rows.push_back(std::move(source));
  }
  if (!messages.failure().empty())
  {
    throw FileError(fileName + ": row " + std::to_string(rows.size() + 1) +
      " cannot be read: " + messages.failure());
  }
  if (rows.empty())
  {
    throw DataError(
      fileName + ": layer \"" + layer.GetName() + "\" has no row, so there is no rock");
  }
  if (crs)
  {
    const CrsPtr placed = placing.to ? placing.to : allHavePoints ? placing.from : nullptr;
    *crs = placed ? crsWkt(*placed) : std::string();
  }
  return rows;
}

} // namespace rockfall
