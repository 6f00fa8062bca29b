// Where structure layers lie: in another CRS than the terrain, in none, beside it; and the same
// numbers under a locale with a decimal comma.

#include "base/errors.h"
#include "gis/base/crs.h"
#include "gis/layers/layerWriter.h"
#include "gis/layers/lineLayer.h"
#include "gis/layers/structureLayers.h"
#include "gisFiles.h"
#include "slopes.h"
#include "terrain/Obstacles.h"

#include <cmath>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

using Vec2 = Eigen::Vector2d;

/// On the central meridian of UTM 32, 9° E, the easting is 500,000 m; at 45° N the northing is
/// 0.9996 times the meridian's arc of 4,984,944.378 m.
constexpr double kEast = 500000.0, kNorth = 4982950.400;
constexpr double kSize = 200.0; // m

/// An incline of 30° towards +x whose middle is at 9° E, 45° N.
Terrain site(const std::string& crs = "EPSG:32632")
{
  GridGeometry g;
  g.columns = g.rows = 41;
  g.cellSize = 5.0;
  g.xOrigin = kEast - 0.5 * kSize;
  g.yOrigin = kNorth - 0.5 * kSize;
  g.crs = crs;
  std::vector<double> heights;
  for (int k = 0; k < 41 * 41; ++k)
  {
    heights.push_back(500.0 - 5.0 * (k % 41) * std::tan(radians(30.0)));
  }
  return Terrain(g, std::move(heights), material(0.5, 25.0));
}

// In the terrain's CRS, m from its middle.
const std::vector<Vec2> dam{ { 30.0, -60.0 }, { 33.0, 5.0 }, { 30.0, 60.0 } };
const std::vector<Vec2> net{ { -20.0, -80.0 }, { -20.0, 80.0 } };
const Vec2 stem(-40.0, 20.0);

/// The three layers as GeoJSON in a CRS, with as many digits as it takes for a tenth of a
/// millimetre.
StructureFiles layersIn(const std::string& crs)
{
  const bool degrees = crs == "EPSG:4326" || crs == "EPSG:4258";
  const gis::CrsChange change(gis::crsFromText("EPSG:32632"), gis::crsFromText(crs));
  const auto place = [&](const Vec2& p)
  {
    double x = kEast + p.x(), y = kNorth + p.y();
    EXPECT_TRUE(change.forth(1, &x, &y));
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.setf(std::ios::fixed);
    text.precision(degrees ? 9 : 4);
    text << "[" << x << "," << y << "]";
    return text.str();
  };
  const auto file = [&](const std::string& name, const std::string& type,
                      const std::string& coordinates, const std::string& fields)
  {
    const std::string code = crs.substr(5);
    return writeFile(name + code + ".geojson",
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
      R"("urn:ogc:def:crs:EPSG::)" +
        code + R"("}},"features":[{"type":"Feature","geometry":{"type":")" + type +
        R"(","coordinates":)" + coordinates + R"(},"properties":{)" + fields + "}}]}");
  };
  const auto line = [&](const std::vector<Vec2>& points)
  {
    std::string text;
    for (const Vec2& p : points)
    {
      text += (text.empty() ? "[" : ",") + place(p);
    }
    return text + "]";
  };
  StructureFiles files;
  files.embankments =
    file("dams", "LineString", line(dam), R"("height":3.5,"width":1.5,"slope":1.5)");
  files.trees = file("trees", "Point", place(stem), R"("diameter":35,"height":22)");
  files.barriers = file("nets", "LineString", line(net), R"("height":4,"capacity":1000)");
  return files;
}

Structures read(const StructureFiles& files, const Terrain& terrain)
{
  std::vector<std::string> notes;
  Structures all = readStructures(files, terrain, notes);
  for (const std::string& n : notes)
    ADD_FAILURE() << n;
  return all;
}

/// Over the slope, a little down it: into what stands there.
Trajectory shot(const Structures& structures, double x)
{
  Terrain terrain = site();
  terrain.setStructures(structures);
  Rock rock;
  rock.shape = makeShape(Shape::Icosahedron, 1.0);
  rock.position = Vec3(x, 104.0, terrain.elevation(x, 104.0) + 1.5);
  rock.velocity = Vec3(14.0, 0.0, -3.0);
  SimulationParameters p;
  p.rigid = true;
  p.endTime = 2.0;
  return simulate(terrain, rock, p);
}

double worstOff(const std::vector<Vec2>& a, const std::vector<Vec2>& b)
{
  double worst = a.size() == b.size() ? 0.0 : 1e9;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
  {
    worst = std::max(worst, (a[k] - b[k]).norm());
  }
  return worst;
}

double worstOff(const Structures& a, const Structures& b)
{
  EXPECT_EQ(b.embankments.size() + b.trees.size() + b.barriers.size(), 3u);
  return std::max({ worstOff(a.embankments.at(0).points, b.embankments.at(0).points),
    worstOff(a.barriers.at(0).points, b.barriers.at(0).points),
    (a.trees.at(0).position - b.trees.at(0).position).norm() });
}

std::string errorOf(const StructureFiles& files, const Terrain& terrain)
{
  return messageOf<DataError>(
    [&]
    {
      std::vector<std::string> notes;
      readStructures(files, terrain, notes);
    });
}

} // namespace

/// A point whose place in both systems is known without any library.
TEST(StructurePlaces, DegreesBecomeMetres)
{
  StructureFiles files;
  files.trees = writeFile("trees.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"Point",)"
    R"("coordinates":[9.0,45.0]},"properties":{"diameter":30,"height":20}}]})");
  const Structures s = read(files, site());
  ASSERT_EQ(s.trees.size(), 1u);
  // The arc above is rounded to a millimetre.
  EXPECT_LT((s.trees[0].position - Vec2(100.0, 100.0)).norm(), 1.5e-3);
}

TEST(StructurePlaces, AnyCrsGivesTheSameStructuresAndTheSameHits)
{
  const Structures own = read(layersIn("EPSG:32632"), site());
  EXPECT_LT(worstOff(own.embankments.at(0).points,
              []
              {
                std::vector<Vec2> local;
                for (const Vec2& p : dam)
                {
                  local.push_back(p + Vec2(100.0, 100.0));
                }
                return local;
              }()),
    1e-4);
  const Trajectory caught = shot(own, 70.0), over = shot(own, 118.0);
  ASSERT_EQ(caught.summary.fate, Fate::Caught);
  ASSERT_FALSE(over.impacts.empty());
  ASSERT_GT(over.impacts[0].cfe, site().cfeCapacity()); // the dam's

  // The last digit of the file is 1e-9° or 0.1 mm. The Swiss system has another datum: the shift to
  // it and back goes through a height that a plan does not have, and leaves 1.3 mm.
  const std::pair<std::string, double> systems[] = { { "EPSG:4326", 2e-4 }, { "EPSG:32631", 2e-4 },
    { "EPSG:3857", 2e-4 }, { "EPSG:25832", 2e-4 }, { "EPSG:4258", 2e-4 }, { "EPSG:2056", 2e-3 } };
  for (const auto& [crs, tolerance] : systems)
  {
    const Structures other = read(layersIn(crs), site());
    EXPECT_LT(worstOff(own, other), tolerance) << crs;
    // What is met in flight is met where it stands; oblique hits move by more than it.
    const Trajectory t = shot(other, 70.0), u = shot(other, 118.0);
    ASSERT_EQ(t.structures.size(), 1u) << crs;
    EXPECT_LT((t.structures[0].position - caught.structures[0].position).norm(), 5.0 * tolerance)
      << crs;
    ASSERT_FALSE(u.impacts.empty()) << crs;
    EXPECT_EQ(u.impacts[0].cfe, over.impacts[0].cfe) << crs;
    EXPECT_LT((u.impacts[0].position - over.impacts[0].position).norm(), 5.0 * tolerance) << crs;
  }
}

TEST(StructurePlaces, WithoutACrsCoordinatesAreTakenAsTheyAre)
{
  StructureFiles files;
  files.trees = writeFile("trees.csv", "x,y,diameter,height\n500010.25,4982960.650,30,20\n");
  const Vec2 expected(110.25, 110.25);
  // To the rounding of a northing of 5,000 km.
  EXPECT_LT((read(files, site()).trees.at(0).position - expected).norm(), 2e-9);
  // Degrees on a terrain without a CRS are numbers, too.
  files = layersIn("EPSG:4326");
  EXPECT_TRUE(holds(errorOf(files, site("")),
    { files.embankments, "does not overlap the terrain: it spans x 9.000",
      "the terrain x 499900" }));
}

/// GDAL gives layers of a GeoPackage without a CRS the undefined one of degrees.
TEST(StructurePlaces, AGeoPackageWithoutACrsIsAsATable)
{
  StructureFiles files;
  files.barriers = pathOf("nets.gpkg");
  LayerWriter writer(files.barriers, "");
  writer.beginLayer("nets", LayerWriter::Geometry::MeasuredLine,
    { { "height", FieldType::Real }, { "capacity", FieldType::Real } });
  const std::vector<Vec3> places{ { kEast - 20.0, kNorth - 80.0, 0.0 },
    { kEast - 20.0, kNorth + 80.0, 0.0 } };
  const std::vector<double> measures{ 0.0, 1.0 };
  const std::vector<FieldValue> values{ 4.0, 1000.0 };
  writer.add(places, measures, values);
  writer.commit();
  std::vector<std::string> notes;
  const Structures s = readStructures(files, site(), notes);
  ASSERT_EQ(s.barriers.size(), 1u);
  EXPECT_EQ(s.barriers[0].points[0], Vec2(0.5 * kSize - 20.0, 0.5 * kSize - 80.0));
  const std::vector<LayerLine> lines =
    readLineLayer(files.barriers, gis::crsWkt(*gis::crsFromText("EPSG:32632")));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].points[1], Vec2(kEast - 20.0, kNorth + 80.0));
}

TEST(StructurePlaces, APlaceThatIsNoneInDegreesNamesBothSystems)
{
  StructureFiles files;
  files.barriers = writeFile("net.geojson",
    "{\"type\":\"Feature\",\"properties\":{\"height\":4,\"capacity\":1000},\"geometry\":{\"type\":"
    "\"LineString\",\"coordinates\":[[500170,5199830],[500170,5199950]]}}");
  std::vector<std::string> notes;
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readStructures(files, site(), notes); }),
    { "row 1: the point 500170, 5199830 cannot be brought from EPSG:4326 (WGS 84) to EPSG:32632 "
      "(WGS 84 / UTM zone 32N), the CRS of the terrain" }));
}

TEST(StructurePlaces, BesideTheTerrainIsAnErrorThatSaysWhere)
{
  // A degree too far north, in the right system.
  StructureFiles files;
  files.barriers = writeFile("nets.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"LineString",)"
    R"("coordinates":[[8.999,46.0],[9.001,46.0]]},"properties":{"height":4}}]})");
  EXPECT_TRUE(holds(errorOf(files, site()),
    { files.barriers, "does not overlap the terrain: it spans x 49992", "y 509404",
      "the terrain x 499900 to 500100" }));
  // Degrees in a file that does not say so: the message says what was assumed.
  files.barriers = writeFile("nets.csv", "WKT,height\n\"LINESTRING(8.999 45,9.001 45)\",4\n");
  EXPECT_TRUE(holds(errorOf(files, site()),
    { files.barriers, "does not overlap the terrain: it spans x 8.999 to 9.001",
      "does not say in which CRS it is" }));
}

TEST(StructurePlaces, ADecimalCommaIsRefusedAndALocaleChangesNothing)
{
  const auto files = []
  {
    StructureFiles f = layersIn("EPSG:4326");
    f.barriers = writeFile("nets.csv",
      "WKT,height,capacity\n\"LINESTRING(499980.5 4982870,499980.5 4983030)\",3.5,150.75\n");
    return f;
  };
  const Structures plain = read(files(), site());
  const std::string spans = [&]
  {
    StructureFiles beside;
    beside.trees = writeFile("beside.csv", "x,y,diameter,height\n1234.5,2345.25,30,20\n");
    return errorOf(beside, site());
  }();
  const CommaLocale german;
  const Structures same = read(files(), site());
  EXPECT_EQ(worstOff(plain, same), 0.0);
  EXPECT_EQ(same.embankments.at(0).height, 3.5);
  EXPECT_EQ(same.embankments.at(0).mountainSlope, 1.5);
  EXPECT_EQ(same.barriers.at(0).height, 3.5);
  EXPECT_EQ(same.barriers.at(0).capacity, 150750.0);
  EXPECT_DOUBLE_EQ(same.trees.at(0).diameter, 0.35);
  EXPECT_EQ(shot(plain, 118.0).summary.hash, shot(same, 118.0).summary.hash);

  StructureFiles beside;
  beside.trees = writeFile("beside.csv", "x,y,diameter,height\n1234.5,2345.25,30,20\n");
  EXPECT_EQ(errorOf(beside, site()), spans);

  // As a German office exports tables: semicolons between, commas within numbers.
  const std::string line = "\"LINESTRING(499980 4982870,499980 4983030)\"";
  StructureFiles bad;
  bad.embankments =
    writeFile("semicolons.csv", "WKT;height;width;slope\n" + line + ";3,5;1,5;1,5\n");
  EXPECT_TRUE(holds(errorOf(bad, site()), { bad.embankments, "row 1", "\"height\"", "3,5" }));
  bad = {};
  bad.trees = writeFile("trees.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":)"
    R"({"type":"Point","coordinates":[9.0,45.0]},"properties":)"
    R"({"diameter":"32,5","height":20}}]})");
  EXPECT_TRUE(holds(errorOf(bad, site()), { bad.trees, "\"diameter\"", "32,5" }));
  bad = {};
  bad.barriers = writeFile("nets2.csv", "WKT,height,capacity\n" + line + ",4,\"1.000,5\"\n");
  EXPECT_TRUE(holds(errorOf(bad, site()), { bad.barriers, "\"capacity\"", "1.000,5" }));
}
