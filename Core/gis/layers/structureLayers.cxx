#include "gis/layers/structureLayers.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/numberText.h"
#include "gis/base/crs.h"
#include "gis/base/gdal.h"
#include "gis/layers/FeatureRow.h"
#include "gis/layers/LayerFile.h"
#include "gis/layers/barrierUnits.h"
#include "gis/layers/lines.h"
#include "gis/trust/heightReference.h"
#include "gis/trust/heights.h"
#include "gis/trust/unitDoubt.h"
#include "terrain/Obstacles.h"
#include "terrain/Terrain.h"
#include "terrain/plausible.h"
#include "terrain/stand.h"

#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

namespace rockfall
{

using namespace gis;

namespace
{

constexpr double kJ = 1000.0; // J
constexpr double cm = 0.01;   // m
/// Most rows of a layer: more trees than any slope has, and a wrong layer does not fill the memory.
constexpr std::int64_t kMostRows = 1000000;

void tellOf(const std::string& fileName, const std::vector<std::string>& doubts,
  std::vector<std::string>& notes)
{
  for (const std::string& doubt : doubts)
  {
    notes.push_back(fileName + ": " + doubt);
  }
}

/// Brings places to the terrain's local frame, and keeps the extent for the message that they are
/// beside it.
class Placing
{
public:
  Placing(const std::string& fileName, const LayerHeights& heights, const Terrain& terrain,
    std::vector<std::string>& notes)
    : heights_(heights)
    , fileName_(fileName)
    , targetCrs_(terrain.geometry().crs)
    , notes_(notes)
    , doubt_(heights, terrain.geometry().fileUnits)
    , origin_(terrain.geometry().origin().head<2>())
  {
    const CrsPtr& from = heights.horizontal;
    if (from && !terrain.geometry().crs.empty())
    {
      change_ = layerChange(fileName, from, crsFromText(terrain.geometry().crs), notes);
    }
    else if (!from)
    {
      assumed_ = ". The layer does not say in which CRS it is, so its coordinates were taken as "
                 "they are";
    }
  }

  Eigen::Vector2d local(const FeatureRow& row, double x, double y)
  {
    doubt_.place(row, x, y);
    Eigen::Vector2d p = Eigen::Vector2d(x, y) * heights_.plane;
    if (!p.allFinite() || !change_.forth(1, &p.x(), &p.y()))
    {
      row.fail("the point " + number(x) + ", " + number(y) +
        " cannot be brought to the coordinates of the terrain");
    }
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
    return p - origin_;
  }

  /// Elevation over what the terrain's refer to, m, of a column's number, at the row's place.
  double elevation(const FeatureRow& row, const char* column, double number)
  {
    doubt_.height(row, column, number);
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
      heightChange_.emplace(fileName_, heights_.reference, targetCrs_, heights_.kml, notes_);
    }
    return (*heightChange_)(0.5 * (box.MinX + box.MaxX), 0.5 * (box.MinY + box.MaxY),
      heights_.ofColumn(column).metres(number));
  }

  const std::string& assumed() const { return assumed_; }
  void tellDoubt() const { doubt_.tell(notes_); }

  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d most = -least;

private:
  const LayerHeights& heights_;
  const std::string& fileName_;
  std::string targetCrs_;
  std::vector<std::string>& notes_;
  std::optional<HeightChange> heightChange_; ///< Made for the first elevation.
  CrsChange change_;
  UnitDoubt doubt_;
  std::string assumed_; ///< For the message.
  Eigen::Vector2d origin_;
};

/// Calls `use` for every row, then tells a layer beside the terrain.
void forEachRow(const LayerWish& wish, const Terrain& terrain, std::vector<std::string>& notes,
  std::initializer_list<const char*> numbers,
  const std::function<void(const FeatureRow&, std::int64_t, Placing&)>& use)
{
  const std::string& fileName = wish.fileName;
  Messages messages;
  LayerFile file(wish, messages);
  OGRLayer& layer = file.layer();
  refuseNearMisses(file.definition(), fileName, numbers, { "name", "x", "y" });
  const Columns columns = columnsOf(*layer.GetLayerDefn());
  const LayerHeights heights = heightsOf(file.dataset(), layer, fileName, notes);
  if (!heights.doubt.empty())
  {
    notes.push_back(heights.doubt);
  }
  file.refuseDegrees(heights.horizontal, terrain.geometry().crs);
  Placing placing(fileName, heights, terrain, notes);
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
    use(row, file.number(), placing);
  }
  file.tell(notes, true);
  placing.tellDoubt();
  if (count == 0)
  {
    throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has no row");
  }
  const GridGeometry& g = terrain.geometry();
  const double east = g.xOrigin + terrain.width(), north = g.yOrigin + terrain.height();
  if (!(placing.least.x() <= east && placing.least.y() <= north && placing.most.x() >= g.xOrigin &&
        placing.most.y() >= g.yOrigin))
  {
    throw DataError(fileName + ": does not overlap the terrain: it spans x " +
      number(placing.least.x()) + " to " + number(placing.most.x()) + ", y " +
      number(placing.least.y()) + " to " + number(placing.most.y()) + ", the terrain x " +
      number(g.xOrigin) + " to " + number(east) + ", y " + number(g.yOrigin) + " to " +
      number(north) + placing.assumed());
  }
}

double needed(const FeatureRow& row, const char* field, const char* what)
{
  const auto value = row.positive(field);
  if (!value)
  {
    row.failField(field,
      std::string(row.has(field) ? " is empty" : " is missing: the layer has no such column") +
        "; it is " + what);
  }
  return *value;
}

/// Sides of embankments, m across per m down. Engineers of Europe write rise : run (1:1.5, 2:3),
/// others run : rise (3:2), and mean the same side: of a ratio the larger number is the way across.
class Sides
{
public:
  std::optional<double> of(const FeatureRow& row, const char* field)
  {
    const auto text = row.text(field);
    const auto colon = text ? text->find(':') : std::string::npos;
    if (colon == std::string::npos)
    {
      return row.notNegative(field);
    }
    const auto one = parsedNumber(trimmed(text->substr(0, colon)));
    const auto other = parsedNumber(trimmed(text->substr(colon + 1)));
    if (!one || !other || !(*one > 0.0) || !(*other > 0.0))
    {
      row.failField(field,
        " is \"" + *text +
          "\", it must be a ratio of two numbers above 0, as 2:3, or the metres across per metre "
          "down, as 1.5");
    }
    const auto [down, across] = std::minmax(*one, *other);
    ratios_.try_emplace(std::string(trimmed(*text)), across / down);
    return across / down;
  }

  void tell(const std::string& fileName, std::vector<std::string>& notes) const
  {
    std::string list;
    for (const auto& [text, slope] : ratios_)
    {
      list += (list.empty() ? "" : ", ") + text + " as " + numberText(slope, 4) +
        " m across per m down (" + numberText(degrees(std::atan(1.0 / slope)), 3) + " degrees)";
    }
    if (!list.empty())
    {
      notes.push_back(fileName + ": of a ratio the larger number is taken as the way across: " +
        list + ". A side steeper than 45 degrees is a number, as 0.5.");
    }
  }

private:
  std::map<std::string, double> ratios_;
};

/// Materials of rows that have their own, each kept once. What a row does not give is the slope's
/// own, with its deviation; what it gives has none.
class OwnMaterials
{
public:
  OwnMaterials(const Terrain& terrain, std::vector<SurfaceMaterial>& all)
    : base_(terrain.material())
    , all_(all)
  {
  }

  /// Number of the row's own, 0 if it has none.
  int of(const FeatureRow& row)
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

private:
  SurfaceMaterial base_;
  std::vector<SurfaceMaterial>& all_;
  std::map<std::array<double, 6>, int> numbers_;
};

/// The lines of a row, each in the local frame.
std::vector<std::vector<Eigen::Vector2d>> linesOf(const FeatureRow& row, Placing& placing)
{
  std::vector<std::vector<Eigen::Vector2d>> lines;
  for (const OGRLineString* part : linesIn(row))
  {
    std::vector<Eigen::Vector2d>& line = lines.emplace_back();
    for (int k = 0; k < part->getNumPoints(); ++k)
    {
      const Eigen::Vector2d p = placing.local(row, part->getX(k), part->getY(k));
      if (line.empty() || (line.back() - p).norm() > 1e-6)
      {
        line.push_back(p);
      }
    }
    if (line.size() < 2)
    {
      row.fail("is a line of one place only");
    }
  }
  return lines;
}

LayerWish wishFor(const std::string& fileName, const std::string& layer, const char* property)
{
  LayerWish wish{ fileName, layer, property };
  wish.what = "layer of lines";
  wish.kinds = kLines;
  return wish;
}

void readEmbankments(const StructureFiles& files, const Terrain& terrain, OwnMaterials& own,
  Structures& all, std::vector<std::string>& notes)
{
  LayerWish wish = wishFor(files.embankments, files.embankmentLayer, "EmbankmentLayerName");
  wish.columns = { { "width" }, { "height", "crest" } };
  Sides sides;
  forEachRow(wish, terrain, notes,
    { "height", "crest", "width", "slope", "slope_up", "slope_down", "rv", "rn", "rt", "phi",
      "cohesion" },
    [&](const FeatureRow& row, std::int64_t count, Placing& placing)
    {
      Embankment e;
      e.feature = count;
      e.name = row.text("name").value_or("");
      const auto height = row.positive("height"), crest = row.number("crest");
      if (bool(height) == bool(crest))
      {
        row.fail(height ? "has a \"height\" and a \"crest\"; it must have one of them"
                        : "has no \"height\" over ground and no \"crest\" elevation, in m");
      }
      e.height = height.value_or(e.height);
      e.elevation = crest ? placing.elevation(row, "crest", *crest) : e.elevation;
      e.crestWidth = needed(row, "width", "the width of the crest in m");
      const auto both = sides.of(row, "slope"), up = sides.of(row, "slope_up"),
                 down = sides.of(row, "slope_down");
      if (!both && !(up && down))
      {
        row.fail("has no \"slope\" of its sides (as 1.5 or 2:3), nor \"slope_up\" and "
                 "\"slope_down\"");
      }
      e.mountainSlope = up ? *up : *both;
      e.valleySlope = down ? *down : *both;
      e.material = own.of(row);
      for (std::vector<Eigen::Vector2d>& line : linesOf(row, placing))
      {
        e.points = std::move(line);
        all.embankments.push_back(e);
      }
    });
  sides.tell(wish.fileName, notes);
}

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

Tree treeOf(const FeatureRow& row, const StructureFiles& files, Placing& placing)
{
  Tree t;
  const OGRGeometry* geometry = row.geometry();
  if (geometry && wkbFlatten(geometry->getGeometryType()) != wkbPoint)
  {
    row.fail(std::string("is a ") + geometry->getGeometryName() +
      ", a POINT is needed, or a POLYGON with the column \"stems_ha\"");
  }
  if (!geometry && !(row.number("x") && row.number("y")))
  {
    row.fail("has no point, and no fields \"x\" and \"y\"");
  }
  t.position = geometry
    ? placing.local(row, geometry->toPoint()->getX(), geometry->toPoint()->getY())
    : placing.local(row, *row.number("x"), *row.number("y"));
  t.diameter = diameterOf(row, "diameter", "that of the stem in cm");
  t.height = needed(row, "height", "that of the tree in m");
  const double factor = row.positive("factor").value_or(1.0);
  if (const auto capacity = row.notNegative("capacity"))
  {
    t.capacity = kJ * *capacity;
  }
  else if (files.treesBreak)
  {
    t.capacity = stemCapacity(t.diameter, factor);
  }
  return t;
}

void gatherRings(const OGRGeometry& geometry, const FeatureRow& row, Placing& placing,
  std::vector<std::vector<Vec3>>& rings)
{
  if (wkbFlatten(geometry.getGeometryType()) == wkbPolygon)
  {
    for (const OGRLinearRing* ring : *geometry.toPolygon())
    {
      std::vector<Vec3>& corners = rings.emplace_back();
      for (int k = 0; k < ring->getNumPoints(); ++k)
      {
        const Eigen::Vector2d place = placing.local(row, ring->getX(k), ring->getY(k));
        corners.emplace_back(place.x(), place.y(), 0.0);
      }
    }
    return;
  }
  for (const OGRGeometry* part : *geometry.toGeometryCollection())
  {
    gatherRings(*part, row, placing, rings);
  }
}

/// A polygon that is given by its density.
Stand standOf(const FeatureRow& row, std::int64_t count, int material, Placing& placing)
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
  gatherRings(*row.geometry(), row, placing, stand.rings);
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
    row.fail(": " + std::string(error.what()));
  }
}

/// Trees of their own first, then those of stands, of a layer or of the cells of a raster. Gives
/// how many are of their own.
std::size_t readTrees(const StructureFiles& files, const Terrain& terrain,
  std::span<const Stand> cells, OwnMaterials& own, Structures& all, std::vector<std::string>& notes)
{
  std::int64_t outside = 0;
  std::vector<Tree> grown;
  std::vector<Stand> stands;
  LayerWish wish{ files.trees, files.treeLayer, "TreeLayerName" };
  wish.what = "layer of points or polygons";
  wish.kinds = kPoints | kPolygons | kRows;
  wish.better = kPoints | kRows;
  wish.columns = { { "diameter", "stems_ha" }, { "height" } };
  const auto add = [&](const Tree& tree, std::vector<Tree>& trees)
  {
    if (std::isnan(terrain.elevation(tree.position.x(), tree.position.y())))
    {
      ++outside;
      return;
    }
    trees.push_back(tree);
  };
  const auto readLayer = [&]
  {
    forEachRow(wish, terrain, notes,
      { "diameter", "height", "factor", "capacity", "stems_ha", "dbh_mean", "dbh_dev", "conifers",
        "f_conifer", "f_broad", "spacing", "rv", "rn", "rt", "phi", "cohesion" },
      [&](const FeatureRow& row, std::int64_t count, Placing& placing)
      {
        const int material = own.of(row);
        if (kindOf(row.geometry()) == kPolygons && row.has("stems_ha"))
        {
          stands.push_back(standOf(row, count, material, placing));
          for (const Tree& tree : stemsOf(stands.back(), row, files))
          {
            add(tree, grown);
          }
          return;
        }
        Tree tree = treeOf(row, files, placing);
        tree.feature = count;
        tree.material = material;
        add(tree, all.trees);
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
  tellOf(files.trees, doubts, notes);
  return alone;
}

void readBarriers(const StructureFiles& files, const Terrain& terrain, Structures& all,
  std::vector<std::string>& notes)
{
  LayerWish wish = wishFor(files.barriers, files.barrierLayer, "BarrierLayerName");
  wish.columns = { { "height" } };
  forEachRow(wish, terrain, notes,
    { "height", "capacity", "overhang", "braking", "residual", "fill", "mode", "absorbs" },
    [&](const FeatureRow& row, std::int64_t count, Placing& placing)
    {
      Barrier b;
      b.feature = count;
      b.name = row.text("name").value_or("");
      b.height = needed(row, "height", "that of the barrier over ground in m");
      const auto capacity = row.notNegative("capacity");
      b.capacity = capacity ? kJ * *capacity : b.capacity;
      const std::string mode = nameKey(row.text("mode").value_or("stop"));
      if (mode != "stop" && mode != "record")
      {
        row.failField("mode", " is \"" + mode + "\", it must be stop or record");
      }
      b.records = mode == "record";
      if (!b.records) // what records may be as high as it likes
      {
        refuseOtherUnits(row, b.height, capacity);
      }
      b.overhang = row.ranged({ "overhang" }, 0.0, 0.5, "0 to 0.5").value_or(b.overhang);
      b.braking = row.notNegative("braking").value_or(b.braking);
      const auto residual = row.ranged({ "residual" }, 0.0, 100.0, "0 to 100 %");
      b.residual = residual ? 0.01 * *residual : b.residual;
      b.room = row.positive("fill").value_or(b.room);
      for (const char* field : { "braking", "residual" })
      {
        if (row.number(field) && !capacity)
        {
          row.failField(field, " is given without a \"capacity\", which it refers to");
        }
      }
      b.absorbs = row.ranged({ "absorbs" }, 0.0, 1.0, "1 or 0").value_or(1.0) != 0.0;
      for (std::vector<Eigen::Vector2d>& line : linesOf(row, placing))
      {
        b.points = std::move(line);
        all.barriers.push_back(b);
      }
    });
}

/// Errors of structures that cannot be built name the file, and so do notes of what is too good to
/// be true. Stems behind the first `alone` were drawn: they may stand side by side.
void tryOut(const std::string& fileName, Structures part, std::size_t alone, const Terrain& terrain,
  std::vector<std::string>& notes)
{
  Structures given = part;
  given.trees.resize(alone);
  std::vector<std::string> doubts;
  askAfterNumbers(part, doubts);
  askAfterTwins(given, doubts);
  tellOf(fileName, doubts, notes);
  try
  {
    const Obstacles built(std::move(part), terrain);
  }
  catch (const Error& error)
  {
    throw DataError(fileName + ", " + error.what());
  }
}

} // namespace

Structures readStructures(const StructureFiles& files, const Terrain& terrain,
  std::vector<std::string>& notes, std::span<const Stand> cells)
{
  Structures all;
  OwnMaterials own(terrain, all.materials);
  if (!files.embankments.empty())
  {
    readEmbankments(files, terrain, own, all, notes);
    tryOut(files.embankments, { all.embankments, {}, {}, all.materials }, 0, terrain, notes);
  }
  if (!files.trees.empty())
  {
    const std::size_t alone = readTrees(files, terrain, cells, own, all, notes);
    tryOut(files.trees, { {}, all.trees, {}, all.materials }, alone, terrain, notes);
  }
  if (!files.barriers.empty())
  {
    readBarriers(files, terrain, all, notes);
    tryOut(files.barriers, { {}, {}, all.barriers, {} }, 0, terrain, notes);
  }
  return all;
}

} // namespace rockfall
