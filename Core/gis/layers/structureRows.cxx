#include "gis/layers/structureRows.h"

#include "base/errors.h"
#include "base/text/pointText.h"
#include "gis/base/gdal.h"
#include "gis/layers/lines.h"
#include "terrain/Terrain.h"

namespace rockfall::gis
{

namespace
{

/// Most rows of a layer: more trees than any slope has, and a wrong layer does not fill the memory.
constexpr std::int64_t kMostRows = 1000000;

} // namespace

StructurePlaces::StructurePlaces(const std::string& fileName, const LayerHeights& heights,
  const Terrain& terrain, std::vector<std::string>& notes)
  : fileName_(fileName)
  , heights_(heights)
  , terrain_(terrain)
  , notes_(notes)
  , places_(
      fileName, heights, terrain.geometry().crs, terrain.geometry().fileUnits, "the terrain", notes)
  , origin_(terrain.geometry().origin().head<2>())
{
}

std::vector<std::vector<Eigen::Vector2d>> StructurePlaces::lines(const FeatureRow& row)
{
  std::vector<std::vector<Eigen::Vector2d>> lines;
  for (const OGRLineString* part : linesIn(row))
  {
    for (Eigen::Vector2d& corner : lines.emplace_back(places_.line(row, *part, 1e-6)))
    {
      corner -= origin_;
    }
  }
  return lines;
}

double StructurePlaces::elevation(const FeatureRow& row, const char* column, double number)
{
  places_.doubt.height(row, column, number);
  OGREnvelope box;
  if (const OGRGeometry* geometry = row.geometry())
  {
    geometry->getEnvelope(&box);
  }
  if (!heightChange_)
  {
    if (!heights_.note.empty())
    {
      notes_.push_back(heights_.note);
    }
    heightChange_.emplace(
      fileName_, heights_.reference, terrain_.geometry().crs, heights_.kml, notes_);
  }
  return (*heightChange_)(0.5 * (box.MinX + box.MaxX), 0.5 * (box.MinY + box.MaxY),
    heights_.ofColumn(column).metres(number));
}

void StructurePlaces::requireOverlap() const
{
  const Eigen::Vector2d size(terrain_.width(), terrain_.height());
  const Eigen::AlignedBox2d slope(origin_, origin_ + size);
  if (!places_.box.intersects(slope))
  {
    const std::string assumed = heights_.horizontal
      ? ""
      : ". The layer does not say in which CRS it is, so its coordinates were taken as they are";
    throw DataError(fileName_ + ": does not overlap the terrain: it spans " +
      boundsText(places_.box, 10) + ", the terrain " + boundsText(slope, 10) + assumed);
  }
}

int OwnMaterials::of(const FeatureRow& row)
{
  const auto rv = row.ranged({ "rv", "rn" }, 0.0, 1.0, "0 to 1");
  const auto rt = row.ranged({ "rt" }, 0.0, 1.0, "0 to 1");
  const auto phi = row.ranged({ "phi" }, 0.0, 89.0, "0 to 89 degrees");
  const auto cohesion = row.notNegative("cohesion");
  if (!rv && !rt && !phi && !cohesion)
  {
    return 0;
  }
  SurfaceMaterial m = base_;
  m.yielding = {}; // built ground of its own is hard
  m.restitution = rv.value_or(m.restitution);
  m.tangentialRestitution = rt.value_or(m.tangentialRestitution);
  m.frictionAngle = phi ? radians(*phi) : m.frictionAngle;
  m.cohesion = cohesion.value_or(m.cohesion);
  m.restitutionDeviation = rv ? 0.0 : m.restitutionDeviation;
  m.frictionAngleDeviation = phi ? 0.0 : m.frictionAngleDeviation;
  const auto [found, isNew] =
    numbers_.try_emplace({ m.restitution, m.restitutionDeviation, m.tangentialRestitution,
                           m.frictionAngle, m.frictionAngleDeviation, m.cohesion },
      0);
  if (isNew)
  {
    all_.push_back(m);
    found->second = int(all_.size());
  }
  return found->second;
}

void StructureReader::forEachRow(const LayerWish& wish, const ColumnNames& numbers,
  const std::function<void(const FeatureRow&, std::int64_t, StructurePlaces&)>& use) const
{
  const std::string& fileName = wish.fileName;
  Messages messages;
  LayerFile file(wish, messages);
  OGRLayer& layer = file.layer();
  // Columns that say what a feature is, and where: no number of it is missed.
  const ColumnNames others = { "name", "x", "y", "z", "elevation", "elev", "altitude", "length",
    "slope" };
  refuseNearMisses(file.definition(), fileName, numbers, others);
  tellUnread(file.definition(), fileName, numbers, others, notes);
  const Columns columns = columnsOf(*layer.GetLayerDefn());
  const LayerHeights heights = heightsOf(file.dataset(), layer, fileName, notes);
  if (!heights.doubt.empty())
  {
    notes.push_back(heights.doubt);
  }
  file.refuseForeignAxes(heights.horizontal, terrain.geometry().crs);
  StructurePlaces places(fileName, heights, terrain, notes);
  std::int64_t count = 0;
  while (const OGRFeatureUniquePtr feature = file.next())
  {
    ++count;
    if (count > kMostRows)
    {
      throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has more than " +
        std::to_string(kMostRows) +
        " rows. Is it the right layer? Cut out what stands on the terrain");
    }
    const FeatureRow row(fileName, columns, *feature, file.number());
    row.refuseLostText(messages);
    use(row, file.number(), places);
  }
  file.tell(notes, true);
  places.tellDoubt();
  if (count == 0)
  {
    throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has no row");
  }
  places.requireOverlap();
}

void StructureReader::tell(
  const std::string& fileName, const std::vector<std::string>& sentences) const
{
  for (const std::string& sentence : sentences)
  {
    notes.push_back(fileName + ": " + sentence);
  }
}

LayerWish lineWish(const std::string& fileName, const std::string& layer, const char* property)
{
  LayerWish wish{ fileName, layer, property };
  wish.what = "layer of lines";
  wish.kinds = kLines;
  return wish;
}

double needed(const FeatureRow& row, const char* field, const char* what)
{
  const auto value = row.positive(field);
  if (!value)
  {
    row.failAbsent(field, std::string("; it is ") + what);
  }
  return *value;
}

} // namespace rockfall::gis
