// Trees, stems that lie and stands of a layer.
#include "gis/layers/structureRows.h"

#include "base/errors.h"
#include "gis/base/gdal.h"
#include "gis/layers/lines.h"
#include "terrain/Terrain.h"
#include "terrain/plausible.h"
#include "terrain/stand.h"

#include <cmath>

namespace rockfall::gis
{

namespace
{

double diameterOf(const FeatureRow& row, const char* field, const char* what)
{
  const double diameter = cm * needed(row, field, what);
  if (diameter > plausible::kStemDiameter.refused)
  {
    row.failField(field, " is " + number(diameter / cm) + " cm: is it in millimetres?");
  }
  if (diameter < cm)
  {
    row.failField(field, " is " + number(diameter / cm) + " cm: is it in metres?");
  }
  return diameter;
}

/// Fills in a stem from its row, but for the place.
void setStem(const FeatureRow& row, const StructureFiles& files, Tree& stem)
{
  stem.diameter = diameterOf(row, "diameter", "that of the stem in cm");
  const double factor = row.positive("factor").value_or(1.0);
  if (const auto capacity = row.notNegative("capacity"))
  {
    stem.capacity = kJ * *capacity;
  }
  else if (files.treesBreak)
  {
    stem.capacity = stemCapacity(stem.diameter, factor);
  }
}

Tree treeOf(const FeatureRow& row, const StructureFiles& files, StructurePlaces& places)
{
  Tree t;
  const OGRGeometry* geometry = row.geometry();
  if (geometry && wkbFlatten(geometry->getGeometryType()) != wkbPoint)
  {
    row.fail(std::string("is a ") + geometry->getGeometryName() +
      ", a POINT is needed, a LINESTRING of a stem that lies, or a POLYGON with the column "
      "\"stems_ha\"");
  }
  if (!geometry && !(row.number("x") && row.number("y")))
  {
    row.fail("has no point, and no fields \"x\" and \"y\"");
  }
  t.position = geometry ? places.at(row, geometry->toPoint()->getX(), geometry->toPoint()->getY())
                        : places.at(row, *row.number("x"), *row.number("y"));
  setStem(row, files, t);
  t.height = needed(row, "height", "that of the tree in m");
  return t;
}

/// A stem for each piece of the row's lines.
std::vector<Tree> lyingStemsOf(
  const FeatureRow& row, const StructureFiles& files, StructurePlaces& places)
{
  Tree stem;
  setStem(row, files, stem);
  std::vector<Tree> stems;
  for (const std::vector<Eigen::Vector2d>& line : places.lines(row))
  {
    for (std::size_t k = 1; k < line.size(); ++k)
    {
      stem.position = line[k - 1];
      stem.end = line[k];
      stems.push_back(stem);
    }
  }
  return stems;
}

/// A polygon that is given by its density.
Stand standOf(const FeatureRow& row, std::int64_t count, int material, StructurePlaces& places)
{
  Stand stand;
  stand.feature = count;
  stand.material = material;
  stand.stemsPerHectare = needed(row, "stems_ha", "the number of stems per hectare");
  stand.diameterMean = diameterOf(row, "dbh_mean", "the mean diameter of the stems in cm");
  stand.diameterDeviation = cm * row.notNegative("dbh_dev").value_or(0.0);
  if (stand.diameterDeviation > stand.diameterMean)
  {
    row.failField("dbh_dev",
      " is " + number(stand.diameterDeviation / cm) + " cm, it must be at most the mean");
  }
  stand.height = needed(row, "height", "that of the trees in m");
  stand.conifers =
    0.01 * row.ranged({ "conifers" }, 0.0, 100.0, "0 to 100 %").value_or(100.0 * stand.conifers);
  stand.coniferFactor = row.positive("f_conifer").value_or(stand.coniferFactor);
  stand.broadleafFactor = row.positive("f_broad").value_or(stand.broadleafFactor);
  stand.spacing = row.notNegative("spacing").value_or(0.0);
  for (const OGRLineString* ring : ringsIn(*row.geometry()))
  {
    std::vector<Vec3>& corners = stand.rings.emplace_back();
    for (int k = 0; k < ring->getNumPoints(); ++k)
    {
      const Eigen::Vector2d place = places.at(row, ring->getX(k), ring->getY(k));
      corners.emplace_back(place.x(), place.y(), 0.0);
    }
  }
  return stand;
}

std::vector<Tree> stemsOf(const Stand& stand, const FeatureRow& row, const StructureFiles& files)
{
  try
  {
    return growStand(stand, files.treesBreak);
  }
  catch (const DataError& error)
  {
    row.fail(error.what());
  }
}

} // namespace

std::size_t StructureReader::readTrees(std::span<const Stand> cells) const
{
  std::int64_t outside = 0;
  std::vector<Tree> grown;
  std::vector<Stand> stands;
  LayerWish wish{ files.trees, files.treeLayer, "TreeLayerName" };
  wish.what = "layer of points, lines or polygons";
  wish.kinds = kPoints | kLines | kPolygons | kRows;
  wish.better = kPoints | kRows;
  wish.columns = { { "diameter", "stems_ha" }, { "height" } };
  const auto add = [&](const Tree& tree, std::vector<Tree>& trees)
  {
    const Eigen::Vector2d& end = tree.lies() ? tree.end : tree.position;
    if (std::isnan(terrain.elevation(tree.position.x(), tree.position.y())) ||
      std::isnan(terrain.elevation(end.x(), end.y())))
    {
      ++outside;
      return;
    }
    trees.push_back(tree);
  };
  const auto readLayer = [&]
  {
    this->forEachRow(wish,
      { "diameter", "height", "factor", "capacity", "stems_ha", "dbh_mean", "dbh_dev", "conifers",
        "f_conifer", "f_broad", "spacing", "rv", "rn", "rt", "phi", "cohesion" },
      [&](const FeatureRow& row, std::int64_t count, StructurePlaces& places)
      {
        const int material = own.of(row);
        if (kindOf(row.geometry()) == kPolygons && row.has("stems_ha"))
        {
          requireValidPolygon(row);
          stands.push_back(standOf(row, count, material, places));
          for (const Tree& tree : stemsOf(stands.back(), row, files))
          {
            add(tree, grown);
          }
          return;
        }
        std::vector<Tree> trees = kindOf(row.geometry()) == kLines
          ? lyingStemsOf(row, files, places)
          : std::vector<Tree>{ treeOf(row, files, places) };
        for (Tree& tree : trees)
        {
          tree.feature = count;
          tree.material = material;
          add(tree, all.trees);
        }
      });
  };
  if (cells.empty())
  {
    readLayer();
  }
  for (const Stand& cell : cells)
  {
    for (const Tree& tree : growStand(cell, files.treesBreak))
    {
      add(tree, grown);
    }
  }
  const std::size_t alone = all.trees.size();
  if (!grown.empty())
  {
    notes.push_back(files.trees + ": " + std::to_string(grown.size()) +
      " stems of stands were drawn from their density, the same for all iterations.");
    all.trees.insert(all.trees.end(), grown.begin(), grown.end());
  }
  if (all.trees.empty())
  {
    throw DataError(files.trees +
      (outside > 0 ? ": none of its " + std::to_string(outside) +
            " trees stands where the terrain has ground"
                   : ": its stands have no stem: are stems_ha per hectare?"));
  }
  if (outside > 0)
  {
    notes.push_back(files.trees + ": " + std::to_string(outside) +
      " trees stand where the terrain has no ground and are left out; " +
      std::to_string(all.trees.size()) + " are taken.");
  }
  std::vector<std::string> doubts;
  askAfterStands(stands, doubts);
  askAfterStands(cells, doubts, true);
  this->tell(files.trees, doubts);
  return alone;
}

} // namespace rockfall::gis
