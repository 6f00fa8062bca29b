#include "gis/layers/sources.h"

#include "base/RockMaterial.h"
#include "base/errors.h"
#include "base/text/columnName.h"
#include "base/text/nameKey.h"
#include "gis/base/FeatureRow.h"
#include "gis/base/crs.h"
#include "gis/base/gdal.h"
#include "gis/layers/LayerFile.h"
#include "gis/layers/sourceGeometry.h"
#include "gis/layers/sourceTwins.h"
#include "gis/trust/heightReference.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

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

} // namespace

std::string wktOfCrs(const std::string& text)
{
  Messages messages;
  const CrsPtr crs = text.empty() ? nullptr : crsFromText(text);
  if (!text.empty() && !crs)
  {
    throw DataError("\"" + text + "\" has no places: it is undefined, or a CRS of heights alone");
  }
  if (const std::string axes = crs ? backwardAxes(*crs) : std::string(); !axes.empty())
  {
    throw DataError("\"" + text + "\" counts to the " + axes + ", no slope does");
  }
  return crs ? crsWkt(crs, heightCrsFromText(text)) : std::string();
}

std::string labelOfCrs(const std::string& text)
{
  Messages messages;
  const CrsPtr crs = text.empty() ? nullptr : crsFromText(text);
  return crs ? crsLabel(*crs) : text;
}

bool sameCrs(const std::string& one, const std::string& other)
{
  Messages messages;
  const CrsPtr first = one.empty() ? nullptr : crsFromText(one);
  const CrsPtr second = other.empty() ? nullptr : crsFromText(other);
  return !first || !second || first->IsSame(second.get());
}

std::string differentHeights(const std::string& one, const std::string& other)
{
  Messages messages;
  const CrsPtr a = heightCrsFromText(one), b = heightCrsFromText(other);
  return a && b && !sameReference(*a, *b) ? referenceLabel(*a) + " and " + referenceLabel(*b)
                                          : std::string();
}

namespace
{

/// Sources of which no rock falls.
void tellIdle(
  const std::vector<SourceRow>& rows, const std::string& fileName, std::vector<std::string>& notes)
{
  const auto isIdle = [](const SourceRow& row)
  { return row.amount == std::int64_t(0) || row.intensity == 0.0; };
  const auto first = std::find_if(rows.begin(), rows.end(), isIdle);
  if (first != rows.end())
  {
    notes.push_back(fileName + ": " + std::to_string(std::count_if(first, rows.end(), isIdle)) +
      " of " + std::to_string(rows.size()) +
      " sources release no rock, as their amount or intensity is 0, "
      "first row " +
      std::to_string(first->row));
  }
}

} // namespace

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
    file.refuseForeignAxes(placing.from, options.targetCrs);
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
  if (placed && !backwardAxes(*placed).empty())
  {
    throw DataError(fileName + ": layer \"" + layer.GetName() + "\" counts to the " +
      backwardAxes(*placed) + " (" + crsLabel(*placed) +
      "); it needs the Terrain input, or a TargetCRS");
  }
  result.crs =
    crsWkt(placed, placing.to ? heightCrsFromText(options.targetCrs) : placing.heights.reference);
  placing.tell(fileName, result.notes);
  tellUnread(definition, fileName, kColumns, kShortColumns, result.notes);
  tellIdle(result.rows, fileName, result.notes);
  tellSourceTwins(result.rows, fileName, result.notes);
  return result;
}

} // namespace rockfall
