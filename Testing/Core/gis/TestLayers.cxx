// Files with several layers: which one is read, that a note says so, and that more than one which
// would do is an error that lists them. Lines and polygons of every kind, and drawings with what is
// no contour.
#include "base/errors.h"
#include "geometry/planeSampling.h"
#include "gis/layers/layerWriter.h"
#include "gis/layers/lineLayer.h"
#include "gis/layers/sources.h"
#include "gis/layers/structureLayers.h"
#include "gis/raster/contours.h"
#include "gis/raster/ground.h"
#include "gisFiles.h"
#include "run/releasePlaces.h"
#include "slopes.h"
#include "terrain/structures.h"

#include <algorithm>
#include <cmath>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// A layer of a GeoPackage: a line or a point at each of these places, with one field.
struct Layer
{
  std::string name;
  LayerWriter::Geometry geometry;
  std::string field;
  std::vector<std::vector<Vec3>> features;
};

std::string geoPackage(const std::string& name, const std::vector<Layer>& layers)
{
  const std::string path = pathOf(name);
  LayerWriter writer(path, "EPSG:32632");
  for (const Layer& layer : layers)
  {
    writer.beginLayer(layer.name, layer.geometry, { { layer.field } });
    for (const std::vector<Vec3>& places : layer.features)
    {
      const std::vector<double> measures(
        layer.geometry == LayerWriter::Geometry::Point ? 0 : places.size(), 0.0);
      const std::vector<FieldValue> values = { places.front().z() };
      writer.add(places, measures, values);
    }
  }
  writer.commit();
  return path;
}

const std::string utm32 = "EPSG:32632";

constexpr auto lineLayer = LayerWriter::Geometry::MeasuredLine;
constexpr auto pointLayer = LayerWriter::Geometry::Point;

/// Contours from 50 m down to 0 along x, at y 0 to 100.
std::vector<std::vector<Vec3>> contours(double scale = 1.0)
{
  std::vector<std::vector<Vec3>> lines;
  for (int z = 50; z >= 0; z -= 10)
  {
    lines.push_back({ { 600000.0 + 2 * (50 - z), 5100000.0, scale * z },
      { 600000.0 + 2 * (50 - z), 5100100.0, scale * z } });
  }
  return lines;
}

double highest(const RasterSurface& surface)
{
  double high = -1e300;
  for (const double height : surface.heights)
  {
    high = std::isnan(height) ? high : std::max(high, height);
  }
  return high;
}

double lowest(const RasterSurface& surface)
{
  double low = 1e300;
  for (const double height : surface.heights)
  {
    low = std::isnan(height) ? low : std::min(low, height);
  }
  return low;
}

RasterSurface slopeOf(const std::string& file, const std::string& layer = {})
{
  return readSlope(file, layer, {}, {});
}

bool anyHas(const std::vector<std::string>& notes, const std::string& part)
{
  return std::any_of(notes.begin(), notes.end(),
    [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

SourceOptions onTerrain(const std::string& layer = {})
{
  SourceOptions options;
  options.haveTerrain = true;
  options.layer = layer;
  return options;
}

/// A GPX file of these elements.
std::string gpx(const std::string& name, const std::string& elements)
{
  return writeFile(name,
    "<?xml version=\"1.0\"?><gpx version=\"1.1\" creator=\"x\" "
    "xmlns=\"http://www.topografix.com/GPX/1/1\">" +
      elements + "</gpx>");
}

const std::string track = "<trk><name>road</name><trkseg><trkpt lat=\"46.1\" lon=\"9.1\"/>"
                          "<trkpt lat=\"46.2\" lon=\"9.2\"/></trkseg></trk>";
const std::string waypoint = "<wpt lat=\"46.05\" lon=\"9.01\"><ele>900</ele></wpt>";

} // namespace

TEST(Layers, TheOneThatWillDoIsTakenAndTold)
{
  const std::string file = geoPackage("site.gpkg",
    { { "trees", pointLayer, "age", { { { 600010, 5100010, 0 } } } },
      { "contours", lineLayer, "n", contours() } });
  const RasterSurface surface = slopeOf(file);
  EXPECT_NEAR(highest(surface), 50.0, 0.5);
  EXPECT_TRUE(anyHas(surface.notes, "\"contours\" was taken"));
  EXPECT_TRUE(anyHas(surface.notes, "\"trees\" (3D Point, 1 feature)"));
  std::vector<std::string> notes;
  EXPECT_EQ(readLineLayer(file, {}, {}, &notes).size(), 6u);
  EXPECT_TRUE(anyHas(notes, "\"contours\" was taken (LayerName"));
}

TEST(Layers, SeveralThatWouldDoAreAnErrorThatListsThem)
{
  const std::string file = geoPackage("site.gpkg",
    { { "planned road", lineLayer, "n", contours(2.0) }, { "Höhen", lineLayer, "n", contours() } });
  EXPECT_TRUE(holds(messageOf<DataError>([&] { slopeOf(file); }),
    { "site.gpkg", "2 layers that would do", "\"planned road\", \"Höhen\"", "LayerName" }));
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readLineLayer(file); }), { "2 layers that would do" }));
  EXPECT_NEAR(highest(slopeOf(file, "HÖHEN")), 50.0, 0.5);
  EXPECT_NEAR(highest(slopeOf(file, "planned road")), 100.0, 1.0);
  EXPECT_TRUE(holds(messageOf<DataError>([&] { slopeOf(file, "contours"); }),
    { "no layer \"contours\" (LayerName)", "\"planned road\"", "\"Höhen\"" }));
}

TEST(Layers, ColumnsTellLayersApart)
{
  // Only one of two layers of lines has the column of a barrier, only one of the points that of a
  // tree.
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  const std::string file = geoPackage("site.gpkg",
    { { "roads", lineLayer, "lanes", { { { 20, 20, 2 }, { 80, 20, 2 } } } },
      { "nets", lineLayer, "height", { { { 20, 50, 4 }, { 80, 50, 4 } } } } });
  StructureFiles files;
  files.barriers = file;
  std::vector<std::string> notes;
  EXPECT_EQ(readStructures(files, terrain, notes).barriers.at(0).height, 4.0);
  EXPECT_TRUE(anyHas(notes, "\"nets\" was taken (BarrierLayerName"));
  files.barrierLayer = "roads";
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readStructures(files, terrain, notes); }),
    { "field \"height\" is missing" }));
}

TEST(Layers, SourcesOfOneOfSeveralKinds)
{
  const std::vector<std::vector<Vec3>> line = { { { 600255, 5100055, 0 },
    { 600255, 5100155, 0 } } };
  const std::vector<std::vector<Vec3>> point = { { { 600055, 5100105, 0 } } };
  // Points rather than lines, and what has a column of sources rather than those.
  const std::string file = geoPackage("site.gpkg",
    { { "roads", lineLayer, "n", line }, { "release points", pointLayer, "n", point } });
  const SourceLayer layer = readSourceLayer(file, onTerrain());
  EXPECT_EQ(layer.rows.at(0).position.x(), 600055.0);
  EXPECT_TRUE(anyHas(layer.notes, "\"release points\" was taken (LayerName"));
  EXPECT_EQ(readSourceLayer(file, onTerrain("roads")).rows.at(0).geometry, SourceGeometry::Line);
  const std::string cliff = geoPackage(
    "cliff.gpkg", { { "trees", pointLayer, "n", point }, { "cliff", lineLayer, "amount", line } });
  EXPECT_EQ(readSourceLayer(cliff, onTerrain()).rows.at(0).geometry, SourceGeometry::Line);
  const std::string two = geoPackage(
    "two.gpkg", { { "old", pointLayer, "n", point }, { "new", pointLayer, "n", point } });
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readSourceLayer(two, onTerrain()); }),
    { "two.gpkg", "2 layers that would do", "\"old\", \"new\"", "LayerName" }));
}

TEST(Layers, EmptyOnesDoNotCount)
{
  const std::string file = geoPackage(
    "site.gpkg", { { "draft", lineLayer, "n", {} }, { "lines", lineLayer, "n", contours() } });
  EXPECT_NEAR(highest(slopeOf(file)), 50.0, 0.5);
}

TEST(Layers, FoldersOfAKmlFile)
{
  const auto folder = [](const std::string& name, const std::string& geometry)
  {
    return "<Folder><name>" + name + "</name><Placemark><name>p</name>" + geometry +
      "</Placemark></Folder>";
  };
  const std::string point = "<Point><coordinates>9.1,46.1,900</coordinates></Point>";
  const std::string line =
    "<LineString><coordinates>9.1,46.1,0 9.2,46.1,0</coordinates></LineString>";
  const auto kml = [&](const std::string& name, const std::string& folders)
  {
    return writeFile(name,
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><kml xmlns=\"http://www.opengis.net/kml/2.2\">"
      "<Document>" +
        folders + "</Document></kml>");
  };
  std::vector<std::string> notes;
  const auto lines = readLineLayer(
    kml("a.kml", folder("places", point) + folder("Straße", line)), utm32, {}, &notes);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].layer, "Straße");
  EXPECT_TRUE(anyHas(notes, "\"Straße\" was taken"));
  EXPECT_TRUE(
    holds(messageOf<DataError>([&]
            { readLineLayer(kml("b.kml", folder("road", line) + folder("path", line)), utm32); }),
      { "2 layers that would do", "\"road\", \"path\"" }));
}

TEST(Layers, PolygonsOfClasses)
{
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  // Shapes of a file that has several layers: sheets that hold WKT are rows, so polygons of a KML.
  const std::string table = writeFile("t.csv", "class,preset\nscree,talus\n");
  const std::string roads = geoPackage("roads.gpkg",
    { { "a", lineLayer, "n", contours() }, { "b", pointLayer, "n", { { { 1, 1, 1 } } } } });
  std::vector<std::string> notes;
  EXPECT_TRUE(holds(messageOf<DataError>(
                      [&] {
                        readGround(GroundKind::Restitution, { roads, table, "" }, terrain, notes);
                      }),
    { "roads.gpkg", "no layer of polygons", "\"a\"", "\"b\"" }));
}

TEST(Lines, CurvesEmptyPartsAndTracksWhereverLinesAreRead)
{
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  struct Case
  {
    const char* wkt;
    std::size_t lines;
  };
  const Case cases[] = {
    { "COMPOUNDCURVE((20 20,20 40),CIRCULARSTRING(20 40,25 50,20 60),(20 60,20 90))", 1 },
    { "CIRCULARSTRING(20 20,30 30,20 40)", 1 },
    { "MULTICURVE((20 20,20 40),CIRCULARSTRING(30 20,35 30,30 40))", 2 },
    { "MULTILINESTRING((20 20,20 80),EMPTY)", 1 },
    { "MULTILINESTRING(EMPTY,(20 20,20 80),EMPTY,(30 20,30 80))", 2 },
    { "GEOMETRYCOLLECTION(LINESTRING(20 20,20 80),LINESTRING EMPTY,LINESTRING(30 20,30 80))", 2 },
    { "LINESTRING M(20 20 0,20 80 5)", 1 },
  };
  for (const Case& one : cases)
  {
    const std::string row = "\"" + std::string(one.wkt) + "\"";
    const std::string lines = writeFile("lines.csv", "WKT,height\n" + row + ",4\n");
    EXPECT_EQ(readLineLayer(lines).size(), one.lines) << one.wkt;
    EXPECT_EQ(readSourceLayer(lines, onTerrain()).rows.at(0).parts.size(), one.lines) << one.wkt;
    StructureFiles files;
    files.barriers = lines;
    files.embankments = writeFile("dams.csv", "WKT,height,width,slope\n" + row + ",3,1,1.5\n");
    std::vector<std::string> notes;
    const Structures s = readStructures(files, terrain, notes);
    EXPECT_EQ(s.barriers.size(), one.lines) << one.wkt;
    EXPECT_EQ(s.embankments.size(), one.lines) << one.wkt;
    ContourOptions terraces;
    terraces.relaxFlats = false;
    const RasterSurface slope =
      readContours(writeFile("contours.csv",
                     "WKT,elev\n" + row +
                       ",40\n\"LINESTRING(90 0,90 100)\",10\n\"LINESTRING(60 0,60 100)\",20\n"),
        terraces);
    EXPECT_NEAR(highest(slope), 40.0, 1.0) << one.wkt;
  }
}

TEST(Lines, AnArcIsFollowed)
{
  const auto lines = readLineLayer(writeFile(
    "arc.csv", "WKT,name\n\"COMPOUNDCURVE((0 -9,0 0),CIRCULARSTRING(0 0,50 50,100 0))\",a\n"));
  double top = 0.0;
  for (const Eigen::Vector2d& p : lines.at(0).points)
  {
    top = std::max(top, p.y());
    EXPECT_TRUE(p.y() < 0.0 || std::abs((p - Eigen::Vector2d(50, 0)).norm() - 50.0) < 1e-6);
  }
  EXPECT_GT(top, 49.9);
}

TEST(Polygons, CurvesAndSurfacesAreAsTheirStraightForms)
{
  const auto read = [](const std::string& wkt)
  {
    const std::string file = writeFile("areas.csv", "WKT,amount\n\"" + wkt + "\",20\n");
    return readSourceLayer(file, onTerrain()).rows.at(0);
  };
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  const auto expectSame = [&](const SourceRow& row, const SourceRow& straight)
  {
    EXPECT_EQ(row.geometry, SourceGeometry::Polygon);
    ASSERT_EQ(row.parts.size(), straight.parts.size());
    EXPECT_EQ(PolygonSampler(row.parts).area(), PolygonSampler(straight.parts).area());
    const auto places = releasePlaces({ &row, 1 }, &terrain, {}, "areas.csv");
    const auto others = releasePlaces({ &straight, 1 }, &terrain, {}, "areas.csv");
    ASSERT_EQ(places.size(), 20u);
    for (std::size_t k = 0; k < places.size(); ++k)
    {
      EXPECT_EQ(places[k].position.head<2>(), others[k].position.head<2>());
    }
  };
  const std::string square = "((20 20,40 20,40 40,20 40,20 20),(25 25,25 30,30 30,30 25,25 25))";
  const std::string wedge = "((60 60,80 60,70 80,60 60))";
  expectSame(read("MULTISURFACE(" + square + ")"), read("POLYGON" + square));
  expectSame(read("MULTISURFACE(" + square + "," + wedge + ")"),
    read("MULTIPOLYGON(" + square + "," + wedge + ")"));

  // A circle, which gets a corner every 4 degrees.
  const std::string circle = "CURVEPOLYGON(CIRCULARSTRING(40 50,50 60,60 50,50 40,40 50))";
  const SourceRow round = read(circle);
  ASSERT_EQ(round.parts.size(), 1u);
  std::string corners;
  for (const Vec3& corner : round.parts[0])
  {
    EXPECT_NEAR((corner - Vec3(50, 50, 0)).head<2>().norm(), 10.0, 1e-9);
    corners += (corners.empty() ? "" : ",") + exactText(corner.x()) + " " + exactText(corner.y());
  }
  EXPECT_NEAR(PolygonSampler(round.parts).area(), 45.0 * 100.0 * std::sin(radians(4.0)), 1e-6);
  expectSame(round, read("POLYGON((" + corners + "))"));
  expectSame(read("MULTISURFACE(" + circle + "," + wedge + ")"),
    read("MULTIPOLYGON(((" + corners + "))," + wedge + ")"));
}

TEST(Lines, TracksAndRoutesOfAGpxFile)
{
  std::vector<std::string> notes;
  const auto lines = readLineLayer(gpx("road.gpx", waypoint + track), utm32, {}, &notes);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].layer, "tracks");
  EXPECT_EQ(lines[0].name, "road");
  EXPECT_NEAR(lines[0].points.at(1).y(), 5.116e6, 2e3); // 46.2° N
  EXPECT_TRUE(anyHas(notes, "\"tracks\" was taken"));
  const std::string route =
    "<rte><rtept lat=\"46\" lon=\"9\"/><rtept lat=\"46\" lon=\"9.1\"/></rte>";
  EXPECT_EQ(readLineLayer(gpx("route.gpx", route), utm32).at(0).layer, "routes");
  const std::string both = gpx("both.gpx", route + track);
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readLineLayer(both, utm32); }), { "\"routes\", \"tracks\"" }));
  EXPECT_EQ(readLineLayer(both, utm32, "routes").size(), 1u);
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readLineLayer(gpx("points.gpx", waypoint), utm32); }),
      { "points.gpx", "has no line" }));
  SourceOptions options = onTerrain();
  options.targetCrs = utm32;
  EXPECT_EQ(readSourceLayer(gpx("sources.gpx", waypoint), options).rows.size(), 1u);
}

TEST(Lines, DegreesAreNoMetres)
{
  // Where nothing says in which CRS the slope is, a layer in degrees can be nowhere on it.
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  const std::string file = gpx("road.gpx", track);
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readLineLayer(file); }),
    { "road.gpx", "layer \"tracks\" is in degrees (EPSG:4326 (WGS 84))" }));
  StructureFiles files;
  files.barriers = file;
  std::vector<std::string> notes;
  EXPECT_TRUE(holds(
    messageOf<DataError>([&] { readStructures(files, terrain, notes); }), { "is in degrees" }));
  const std::string points = gpx("points.gpx", waypoint);
  EXPECT_TRUE(holds(
    messageOf<DataError>([&] { readSourceLayer(points, onTerrain()); }), { "is in degrees" }));
}

namespace
{

/// An AutoCAD drawing of contours from 15 m to 0, 6 m apart, and further entities.
std::string drawing(const std::string& name, const std::string& more,
  const std::string& layer = "CONT", double offset = 0.0)
{
  std::string text =
    "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n"
    "0\nSECTION\n2\nENTITIES\n";
  for (int z = 15; z >= 0; z -= 3)
  {
    text += "0\nLWPOLYLINE\n8\n" + (z % 2 ? layer : layer + "_MAIN") +
      "\n100\nAcDbEntity\n100\nAcDbPolyline\n90\n3\n70\n0\n38\n" + exactText(z + offset) + "\n";
    for (int y = 0; y <= 40; y += 20)
    {
      text += "10\n" + exactText(2 * (15 - z)) + "\n20\n" + exactText(y) + "\n";
    }
  }
  return writeFile(name, text + more + "0\nENDSEC\n0\nEOF\n");
}

const std::string label = "0\nTEXT\n8\nLABEL\n10\n10.0\n20\n20.0\n30\n10.0\n40\n2.5\n1\n10\n";
const std::string spot = "0\nPOINT\n8\nSPOTS\n10\n10.0\n20\n20.0\n30\n99.0\n";

/// A closed rectangle about the contours, with its elevation or none.
std::string frame(const std::string& layer, const std::string& elevation = "")
{
  return "0\nLWPOLYLINE\n8\n" + layer + "\n100\nAcDbEntity\n100\nAcDbPolyline\n90\n4\n70\n1\n" +
    elevation +
    "10\n-10.0\n20\n-10.0\n10\n50.0\n20\n-10.0\n10\n50.0\n20\n50.0\n10\n-10.0\n20\n50.0\n";
}

} // namespace

TEST(Drawings, LabelsAndPointsAreLeftOutWithANote)
{
  const RasterSurface surface = slopeOf(drawing("labels.dxf", label + spot + label));
  EXPECT_NEAR(highest(surface), 15.0, 1e-6);
  EXPECT_TRUE(anyHas(surface.notes, "\"LABEL\" (labels, no heights)"));
  EXPECT_TRUE(anyHas(surface.notes, "\"CONT\", \"CONT_MAIN\" were taken"));
  // On the layer of the contours itself.
  std::string same = label + spot;
  for (const char* name : { "LABEL", "SPOTS" })
  {
    same.replace(same.find(name), 5, "CONT");
  }
  const RasterSurface mixed = slopeOf(drawing("mixed.dxf", same));
  EXPECT_NEAR(highest(mixed), 15.0, 1e-6);
  EXPECT_TRUE(anyHas(mixed.notes, "2 entities of the drawing"));
}

TEST(Drawings, AFrameIsNoContour)
{
  for (const std::string elevation : { "", "38\n0.0\n" })
  {
    // On a layer of its own, on one with the contours, and turned.
    const RasterSurface own = slopeOf(drawing("frame.dxf", frame("FRAME", elevation)));
    EXPECT_GT(lowest(own), -0.5);
    EXPECT_TRUE(anyHas(own.notes, "\"FRAME\" (1 line, no heights)"));
    const std::string shared = drawing("shared.dxf", frame("CONT", elevation));
    if (elevation.empty())
    {
      EXPECT_TRUE(
        holds(messageOf<DataError>([&] { slopeOf(shared); }), { "shared.dxf", "row 7", "no z" }));
    }
    else
    {
      const RasterSurface surface = slopeOf(shared);
      EXPECT_GT(lowest(surface), -0.5);
      EXPECT_TRUE(anyHas(surface.notes, "frame of a drawing"));
    }
  }
}

TEST(Drawings, TheFootOfAPyramidIsNoFrame)
{
  std::string text = "WKT,elev\n";
  for (int k = 0; k < 4; ++k)
  {
    const std::string a = std::to_string(10 * k), b = std::to_string(100 - 10 * k);
    text += "\"LINESTRING(" + a + " " + a + "," + b + " " + a + "," + b + " " + b + "," + a + " " +
      b + "," + a + " " + a + ")\"," + std::to_string(10 * k) + "\n";
  }
  ContourOptions terraces;
  terraces.relaxFlats = false;
  const RasterSurface surface = readContours(writeFile("pyramid.csv", text), terraces);
  EXPECT_NEAR(lowest(surface), 0.0, 1e-9);
  EXPECT_TRUE(anyHas(surface.notes, "was taken as a contour; is it the frame"));
}

TEST(Drawings, FlatSketchesFarBelowTheContours)
{
  // Contours from 400 m: a sketch at 0 on their layer is no contour, whatever its shape.
  const std::string sketch =
    "0\nLWPOLYLINE\n8\nCONT\n100\nAcDbEntity\n100\nAcDbPolyline\n90\n2\n70\n0\n"
    "38\n0.0\n10\n5.0\n20\n5.0\n10\n25.0\n20\n30.0\n";
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { slopeOf(drawing("sketch.dxf", sketch, "CONT", 400.0)); }),
      { "sketch.dxf", "1 line lies at exactly 0 m", "400 m", "415 m" }));
  std::string apart = sketch;
  apart.replace(apart.find("CONT"), 4, "PLAN");
  EXPECT_NEAR(lowest(slopeOf(drawing("apart.dxf", apart, "CONT", 400.0))), 400.0, 0.5);
}

TEST(Drawings, PaperIsNoGround)
{
  const std::string title =
    "0\nLINE\n67\n1\n8\nCONT\n10\n0.0\n20\n0.0\n30\n70.0\n11\n9.0\n21\n9.0\n31\n70.0\n";
  const RasterSurface surface = slopeOf(drawing("paper.dxf", title));
  EXPECT_NEAR(highest(surface), 15.0, 1e-6);
}

TEST(Drawings, LayersByName)
{
  const std::string file = drawing("layers.dxf", frame("FRAME") + label);
  EXPECT_NEAR(highest(slopeOf(file, "cont_main")), 12.0, 1e-6);
  EXPECT_NEAR(highest(slopeOf(file, "CONT, CONT_MAIN")), 15.0, 1e-6);
  EXPECT_TRUE(holds(messageOf<DataError>([&] { slopeOf(file, "CONTOURS"); }),
    { "no layer \"CONTOURS\" (LayerName)", "\"CONT\" (3 lines)",
      "\"FRAME\" (1 line, no heights)" }));
  // Lines of a collector: several layers would do.
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readLineLayer(file); }),
    { "3 layers that would do", "\"CONT\", \"CONT_MAIN\", \"FRAME\"", "* for all" }));
  EXPECT_EQ(readLineLayer(file, {}, "FRAME").size(), 1u);
  EXPECT_EQ(readLineLayer(file, {}, "*").size(), 7u);
}
