#include "gis/layers/sources.h"

#include "base/RockMaterial.h"
#include "base/errors.h"
#include "base/text/columnName.h"
#include "base/text/nameKey.h"
#include "gis/base/crs.h"
#include "gis/base/gdal.h"
#include "gis/layers/FeatureRow.h"
#include "gis/layers/LayerFile.h"
#include "gis/layers/sourceGeometry.h"
#include "gis/trust/heightReference.h"
#include "terrain/plausible.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <map>

namespace rockfall
{

namespace
{

using namespace gis;

const ColumnNames kColumns = { "amount", "intensity", "volume", "vol_law", "vol_dev", "vol_min",
  "vol_max", "vol_exp", "material", "mat_name", "density", "young", "poisson", "height",
  "source_id", "frequency", "freq_ha", "freq_a", "dev_xy", "dev_z", "dev_att" };
const ColumnNames kShortColumns = { "x", "y", "z", "shape", "source", "vx", "vy", "vz", "wx", "wy",
  "wz", "rx", "ry", "rz", "lx", "ly", "lz" };

/// Columns whose name, but for a unit, is z.
std::vector<std::string> heightColumnsOf(const OGRFeatureDefn& definition)
{
  std::vector<std::string> names;
  for (int i = 0; i < definition.GetFieldCount(); ++i)
  {
    const std::string written = definition.GetFieldDefn(i)->GetNameRef();
    if (ColumnName(written).name == "z")
    {
      names.push_back(written);
    }
  }
  return names;
}

/// Words and ranges that other parts of the Core check, with the row and the field before.
template <class Make>
auto checked(const FeatureRow& row, const char* field, Make&& make)
{
  try
  {
    return make();
  }
  catch (const ParameterError& error)
  {
    row.failField(field, std::string(": ") + error.what());
  }
}

void readNumbers(const FeatureRow& row, SourceRow& source)
{
  source.amount = row.count("amount");
  source.intensity = row.notNegative("intensity");
  if (source.amount && source.intensity)
  {
    row.fail("has an \"amount\" and an \"intensity\"; it must have one of them");
  }
  if (source.intensity && source.geometry == SourceGeometry::Point)
  {
    row.failField("intensity", " is for lines and polygons; a point needs an \"amount\"");
  }
  if (const auto id = row.number("source_id"))
  {
    if (*id != std::floor(*id) || std::abs(*id) > 0x1p53)
    {
      row.failField("source_id", " is " + number(*id) + ", it must be a whole number");
    }
    source.sourceId = std::int64_t(*id);
  }
  source.sourceName = row.text("source").value_or("");
}

void readFrequency(const FeatureRow& row, SourceRow& source)
{
  source.frequency = row.notNegative("frequency");
  source.frequencyPerHectare = row.notNegative("freq_ha");
  source.frequencyA = row.notNegative("freq_a");
  if (bool(source.frequency) + bool(source.frequencyPerHectare) + bool(source.frequencyA) > 1)
  {
    row.fail("has several of \"frequency\", \"freq_ha\" and \"freq_a\"; it must have one of them");
  }
  if (source.frequencyPerHectare && source.geometry != SourceGeometry::Polygon)
  {
    row.failField("freq_ha", " is for polygons; a point or a line needs a \"frequency\"");
  }
}

void readBody(const FeatureRow& row, SourceRow& source)
{
  if (const auto text = row.text("shape"))
  {
    source.shapes = checked(row, "shape", [&] { return ShapeMix::fromText(*text); });
  }
  source.volume = row.positive("volume");
  if (const auto text = row.text("vol_law"))
  {
    source.volumeLaw = checked(row, "vol_law", [&] { return volumeLawFromName(*text); });
  }
  source.volumeDeviation = row.notNegative("vol_dev");
  source.volumeMinimum = row.notNegative("vol_min");
  source.volumeMaximum = row.notNegative("vol_max");
  source.volumeExponent = row.positive("vol_exp");
  if (const auto text = row.text("material"))
  {
    checked(row, "material", [&] { return rockMaterialFromName(*text); });
    source.material = *text;
  }
  source.materialName = row.text("mat_name").value_or("");
  source.density = row.positive("density");
  source.youngModulus = row.positive("young");
  source.poissonRatio = row.notNegative("poisson");
  if (source.poissonRatio && *source.poissonRatio > 0.49)
  {
    row.failField("poisson", " is " + number(*source.poissonRatio) + ", it must be 0 to 0.49");
  }
  source.lengths = row.lengths();
}

void readRelease(const FeatureRow& row, SourceRow& source)
{
  source.velocity = row.vector({ "vx", "vy", "vz" });
  source.angularVelocity = row.vector({ "wx", "wy", "wz" });
  for (const char* angle : { "rx", "ry", "rz" })
  {
    row.ranged({ angle }, -360.0, 360.0, "-360 to 360 degrees");
  }
  source.orientation = row.vector({ "rx", "ry", "rz" });
  source.horizontalDeviation = row.notNegative("dev_xy");
  source.verticalDeviation = row.notNegative("dev_z");
  if (const auto text = row.text("dev_att"); text && EQUAL(text->c_str(), "random"))
  {
    source.randomAttitude = true;
  }
  else
  {
    source.attitudeDeviation = row.notNegative("dev_att");
  }
}

/// Whether both release the same rocks, if at one place in plan.
bool sameRocks(SourceRow a, SourceRow b)
{
  const double rise = std::abs(a.position.z() - b.position.z());
  if (rise > plausible::kTwinDistance || std::isnan(a.position.z()) != std::isnan(b.position.z()))
  {
    return false;
  }
  // How many, and of which name, is no difference.
  a.row = b.row;
  a.position = b.position = Vec3::Zero();
  a.parts.clear();
  b.parts.clear();
  a.sourceId = b.sourceId;
  a.sourceName = b.sourceName;
  a.amount = b.amount;
  a.intensity = b.intensity;
  return a == b;
}

/// One note of rows that release again what another one does at the same place.
void tellTwice(
  const std::vector<SourceRow>& rows, const std::string& fileName, std::vector<std::string>& notes)
{
  constexpr std::size_t mostCompared = 100;
  std::vector<int> numbers;
  std::vector<Eigen::Vector2d> points;
  std::vector<int> lineNumbers;
  std::vector<PlanLine> lines;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    if (rows[i].geometry == SourceGeometry::Point)
    {
      numbers.push_back(int(i));
      points.push_back(rows[i].position.head<2>());
      continue;
    }
    PlanLine& line = lines.emplace_back();
    lineNumbers.push_back(int(i));
    for (const std::vector<Vec3>& part : rows[i].parts)
    {
      for (const Vec3& corner : part)
      {
        line.push_back(corner.head<2>());
      }
    }
  }
  std::int64_t count = 0;
  std::string first;
  const auto look = [&](const std::vector<int>& of, const std::vector<int>& earlier)
  {
    std::map<int, std::vector<int>> places; // of the first one: all with other rocks
    for (std::size_t i = 0; i < of.size(); ++i)
    {
      if (earlier[i] < 0)
      {
        continue;
      }
      std::vector<int>& there =
        places.try_emplace(earlier[i], 1, of[std::size_t(earlier[i])]).first->second;
      const auto same = std::find_if(there.begin(), there.end(),
        [&](int k) { return sameRocks(rows[std::size_t(k)], rows[std::size_t(of[i])]); });
      if (same != there.end())
      {
        if (++count == 1)
        {
          first = std::to_string(rows[std::size_t(*same)].row) + " and " +
            std::to_string(rows[std::size_t(of[i])].row);
        }
      }
      else if (there.size() < mostCompared)
      {
        there.push_back(of[i]);
      }
    }
  };
  look(numbers, earlierPoints(points));
  look(lineNumbers, earlierLines(lines));
  if (count > 0)
  {
    notes.push_back(fileName + ": " + std::to_string(count) + " of " + std::to_string(rows.size()) +
      " sources release the same rocks within " + number(plausible::kTwinDistance) +
      " m of another one, first rows " + first + ". Was something given twice?");
  }
}

} // namespace

std::string wktOfCrs(const std::string& text)
{
  Messages messages;
  return text.empty() ? std::string() : crsWkt(crsFromText(text), heightCrsFromText(text));
}

std::string labelOfCrs(const std::string& text)
{
  Messages messages;
  return text.empty() ? std::string() : crsLabel(*crsFromText(text));
}

bool sameCrs(const std::string& one, const std::string& other)
{
  Messages messages;
  return one.empty() || other.empty() || crsFromText(one)->IsSame(crsFromText(other).get());
}

std::string differentHeights(const std::string& one, const std::string& other)
{
  Messages messages;
  const CrsPtr a = heightCrsFromText(one), b = heightCrsFromText(other);
  return a && b && !sameReference(*a, *b) ? referenceLabel(*a) + " and " + referenceLabel(*b)
                                          : std::string();
}

SourceLayer readSourceLayer(const std::string& fileName, const SourceOptions& options)
{
  Messages messages;
  LayerWish wish{ fileName, options.layer };
  wish.what = "layer of points, lines or polygons, nor a table with x and y";
  wish.kinds = kPoints | kLines | kPolygons | kRows;
  wish.better = kPoints | kRows;
  wish.columns = { { "amount", "intensity", "volume", "vol_law", "shape", "source", "source_id",
    "density", "dev_xy", "dev_att" } };
  LayerFile file(wish, messages);
  OGRLayer& layer = file.layer();
  const OGRFeatureDefn& definition = *layer.GetLayerDefn();
  refuseNearMisses(definition, fileName, kColumns, kShortColumns);
  const Columns columns = columnsOf(definition);

  SourceLayer result;
  SourcePlacing placing;
  placing.heights = heightsOf(file.dataset(), layer, fileName, result.notes);
  placing.from = placing.heights.horizontal;
  placing.haveTerrain = options.haveTerrain;
  placing.heightColumns = heightColumnsOf(definition);
  if (options.haveTerrain)
  {
    file.refuseDegrees(placing.from, options.targetCrs);
    if (options.targetCrs.empty() && placing.from && placing.from->IsGeographic())
    {
      // GeoJSON that names no CRS: its degrees are believed to be the slope's coordinates.
      placing.from.reset();
      placing.heights.reference.reset();
      placing.heights.planeDeclared = false;
    }
  }
  placing.doubt = UnitDoubt(placing.heights, options.terrainUnits);
  if (!options.targetCrs.empty())
  {
    placing.to = crsFromText(options.targetCrs);
    placing.change = layerChange(fileName, placing.from, placing.to, result.notes);
  }
  if (options.haveTerrain || !options.targetCrs.empty())
  {
    placing.target = options.targetCrs;
  }

  result.ownCrs = placing.from ? crsLabel(*placing.from) : std::string();
  bool allHaveGeometry = true;
  while (const OGRFeatureUniquePtr feature = file.next())
  {
    SourceRow source;
    source.row = file.number();
    if (std::int64_t(result.rows.size()) >= options.mostRocks)
    {
      throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has more than " +
        std::to_string(options.mostRocks) +
        " rows, each a source of rocks. Is it the right layer? MaximumRocks allows more");
    }
    const FeatureRow row(fileName, columns, *feature, source.row);
    row.refuseLostText(messages);
    placing.place(row, source);
    allHaveGeometry = allHaveGeometry && row.geometry();
    readNumbers(row, source);
    readFrequency(row, source);
    readBody(row, source);
    readRelease(row, source);
    result.rows.push_back(std::move(source));
  }
  file.tell(result.notes, true);
  if (result.rows.empty())
  {
    throw DataError(
      fileName + ": layer \"" + layer.GetName() + "\" has no row, so there is no rock");
  }
  const CrsPtr placed = placing.to ? placing.to : allHaveGeometry ? placing.from : nullptr;
  result.crs =
    crsWkt(placed, placing.to ? heightCrsFromText(options.targetCrs) : placing.heights.reference);
  placing.tell(fileName, result.notes);
  tellUnread(definition, fileName, kColumns, kShortColumns, result.notes);
  tellTwice(result.rows, fileName, result.notes);
  return result;
}

std::vector<SourceRow> readSources(
  const std::string& fileName, const std::string& targetCrs, std::string* crs)
{
  SourceOptions options;
  options.targetCrs = targetCrs;
  SourceLayer layer = readSourceLayer(fileName, options);
  if (crs)
  {
    *crs = layer.crs;
  }
  return std::move(layer.rows);
}

} // namespace rockfall
