/// @file
/// Lines, polygons and what a source says of its rocks: amounts, mixes, distributions, materials,
/// deviations, and every way in which one can be wrong.

#include "base/errors.h"
#include "gis/layers/sources.h"
#include "gisFiles.h"

#include <cmath>
#include <utility>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

constexpr char utmByUrn[] = "urn:ogc:def:crs:EPSG::32632";

std::string feature(const std::string& geometry, const std::string& properties = "")
{
  return writeFile("layer.geojson",
    R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" +
      std::string(utmByUrn) + R"("}},"features":[{"type":"Feature","properties":{)" + properties +
      R"(},"geometry":)" + geometry + "}]}");
}

SourceOptions onTerrain()
{
  SourceOptions options;
  options.haveTerrain = true;
  return options;
}

SourceRow only(const std::string& path, const SourceOptions& options = onTerrain())
{
  const SourceLayer layer = readSourceLayer(path, options);
  EXPECT_EQ(layer.rows.size(), 1u);
  return layer.rows.at(0);
}

std::string failure(const std::string& path, const SourceOptions& options = onTerrain())
{
  return messageOf<DataError>([&] { readSourceLayer(path, options); });
}

std::string table(const std::string& columns, const std::string& cells)
{
  return writeFile("rocks.csv", "x,y,z" + columns + "\n1,2,3" + cells + "\n");
}

const char* const squareRing =
  R"({"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,4],[0,0]]]})";
const char* const lineString = R"({"type":"LineString","coordinates":[[0,0,10],[4,0,20]]})";

TEST(SourceLayers, thatReleaseNothingAreTold)
{
  const auto notes = [](const std::string& cells)
  {
    SourceOptions options;
    options.haveTerrain = true;
    std::vector<std::string> all =
      readSourceLayer(writeFile("idle.csv", "x,y,amount\n1,2,3\n" + cells), options).notes;
    std::erase_if(
      all, [](const std::string& note) { return note.find("no rock") == std::string::npos; });
    return all;
  };
  EXPECT_TRUE(notes("9,9,1\n").empty());
  ASSERT_EQ(notes("9,9,0\n8,8,0\n").size(), 1u);
  EXPECT_TRUE(
    holds(notes("9,9,0\n8,8,0\n")[0], { "2 of 3 sources release no rock", "first row 2" }));
}

TEST(SourceLayers, polygonsAndLinesKeepTheirParts)
{
  const SourceRow flat = only(feature(squareRing, R"("amount":12,"height":0.5,"source":"cliff")"));
  EXPECT_EQ(flat.geometry, SourceGeometry::Polygon);
  ASSERT_EQ(flat.parts.size(), 1u);
  ASSERT_EQ(flat.parts[0].size(), 5u);
  EXPECT_EQ(flat.parts[0][2].head<2>(), Eigen::Vector2d(4.0, 4.0));
  EXPECT_TRUE(std::isnan(flat.parts[0][2].z())); // the ground says it
  EXPECT_EQ(flat.amount, 12);
  EXPECT_EQ(flat.height, 0.5);
  EXPECT_EQ(flat.sourceName, "cliff");
  const SourceRow edge = only(feature(lineString, R"("intensity":0.25,"source_id":7)"));
  EXPECT_EQ(edge.geometry, SourceGeometry::Line);
  ASSERT_EQ(edge.parts.size(), 1u);
  EXPECT_EQ(edge.parts[0][1], Vec3(4.0, 0.0, 20.0));
  EXPECT_EQ(edge.intensity, 0.25);
  EXPECT_EQ(edge.sourceId, 7);
  const SourceRow holed =
    only(feature(R"({"type":"MultiPolygon","coordinates":[[[[0,0],[4,0],[4,4],[0,4],[0,0]],)"
                 R"([[1,1],[1,2],[2,2],[2,1],[1,1]]],[[[8,8],[9,8],[9,9],[8,8]]]]})"));
  EXPECT_EQ(holed.parts.size(), 3u);
  // Without a terrain a column, or a line's own z, is the height.
  const SourceRow high = only(feature(squareRing, "\"z\":55"), {});
  EXPECT_EQ(high.parts[0][0].z(), 55.0);
  EXPECT_EQ(only(feature(lineString), {}).parts[0][0].z(), 10.0);
}

TEST(SourceLayers, reprojectsCorners)
{
  SourceOptions options = onTerrain();
  options.targetCrs = "EPSG:32632";
  const std::string path = writeFile("degrees.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
    R"({"type":"Polygon","coordinates":[[[9,45],[9.001,45],[9,45.001],[9,45]]]}}]})");
  const SourceLayer layer = readSourceLayer(path, options);
  // On the central meridian of zone 32: 0.9996 times the meridian arc to 45° (WGS 84).
  EXPECT_NEAR(layer.rows[0].parts[0][0].x(), 500000.0, 1e-6);
  EXPECT_NEAR(layer.rows[0].parts[0][0].y(), 0.9996 * 4984944.378, 1e-3);
  EXPECT_EQ(layer.crs, wktOfCrs("EPSG:32632"));
  EXPECT_TRUE(holds(layer.ownCrs, { "WGS 84" }));
  EXPECT_TRUE(sameCrs(layer.crs, "EPSG:32632"));
  EXPECT_TRUE(sameCrs(layer.crs, ""));
  for (const char* none :
    { "EPSG:5703", "LOCAL_CS[\"Undefined Cartesian SRS\",UNIT[\"Meter\",1]]" })
  {
    EXPECT_TRUE(sameCrs(layer.crs, none));
    EXPECT_EQ(labelOfCrs(none), none);
    EXPECT_TRUE(holds(messageOf<DataError>([&] { wktOfCrs(none); }), { none, "has no places" }));
  }
  EXPECT_FALSE(sameCrs(layer.crs, "EPSG:32633"));
}

TEST(SourceLayers, ofGeoJsonAreInTheSlopesCoordinatesWhereNothingNamesACrs)
{
  const auto file = [](const std::string& type, const std::string& coordinates)
  {
    return writeFile("metres.geojson",
      R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"amount":3},)"
      R"("geometry":{"type":")" +
        type + R"(","coordinates":)" + coordinates + "}}]}");
  };
  const SourceOptions options = onTerrain();
  const SourceLayer point = readSourceLayer(file("Point", "[600100,5200100,812]"), options);
  EXPECT_EQ(point.rows.front().position, Vec3(600100.0, 5200100.0, 812.0));
  EXPECT_TRUE(point.notes.empty()) << point.notes.front();
  const SourceLayer area = readSourceLayer(
    file("Polygon", "[[[600100,5200050],[600200,5200050],[600200,5200150],[600100,5200050]]]"),
    options);
  ASSERT_EQ(area.rows.front().parts.size(), 1u);
  EXPECT_EQ(area.rows.front().parts[0][1].head<2>(), Eigen::Vector2d(600200.0, 5200050.0));
  const SourceLayer edge =
    readSourceLayer(file("LineString", "[[600100,5200050],[600200,5200150]]"), options);
  EXPECT_EQ(edge.rows.front().parts[0][0].head<2>(), Eigen::Vector2d(600100.0, 5200050.0));
}

/// A rock of a layer of one CRS in another: its place, and what is said of the way.
std::pair<Vec3, std::string> brought(
  const std::string& from, const std::string& place, const std::string& to)
{
  SourceOptions options = onTerrain();
  options.targetCrs = wktOfCrs(to);
  const SourceLayer layer = readSourceLayer(
    writeFile("moved.geojson",
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" + from +
        R"("}},"features":[{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":)" +
        place + "}}]}"),
    options);
  std::string notes;
  for (const std::string& note : layer.notes)
  {
    notes += note + "\n";
  }
  return { layer.rows.at(0).position, notes };
}

TEST(SourceLayers, tellWhereTheWayToTheSlopeIsRough)
{
  // Swiss LV03 to LV95: by the official grid, or by whole millions, which is 1.5 m beside.
  const auto [swiss, said] =
    brought("urn:ogc:def:crs:EPSG::21781", "[720000,80000,500]", "EPSG:2056");
  const bool exact = std::hypot(swiss.x() - 2720000.114, swiss.y() - 1079998.548) < 0.3;
  EXPECT_EQ(said.find("moved.geojson: the best way") == std::string::npos, exact) << said;
  EXPECT_TRUE(exact || holds(said, { "0.2 m", "CHENyx06", "no accuracy" }));
  // NAD27 without its grid: PROJ knows how rough its other ways are.
  const auto nad = brought("urn:ogc:def:crs:EPSG::26716", "[700000,4000000,500]", "EPSG:32616");
  EXPECT_TRUE(nad.second.empty() || holds(nad.second, { "needs the grid", "an accuracy of" }));
  // Nothing is missing on these ways.
  for (const char* to : { "EPSG:32632", "EPSG:25832" })
  {
    EXPECT_EQ(brought("urn:ogc:def:crs:EPSG::4326", "[9,45,500]", to).second, "") << to;
  }
}

TEST(SourceLayers, everyColumnOfARock)
{
  const SourceRow row = only(table(",shape,volume,vol_law,vol_dev,vol_min,vol_max,vol_exp,material,"
                                   "young,poisson,dev_xy,dev_z,dev_att",
    ",cube:2;icosahedron,1.5,LogNormal,0.5,0.1,9,0.6,Basalt,2e10,0.3,1.5,0.25,20"));
  EXPECT_EQ(row.shapes, ShapeMix::fromText("cube:2;icosahedron:1"));
  EXPECT_EQ(row.volume, 1.5);
  EXPECT_EQ(row.volumeLaw, VolumeLaw::LogNormal);
  EXPECT_EQ(row.volumeDeviation, 0.5);
  EXPECT_EQ(row.volumeMinimum, 0.1);
  EXPECT_EQ(row.volumeMaximum, 9.0);
  EXPECT_EQ(row.volumeExponent, 0.6);
  EXPECT_EQ(row.material, "Basalt");
  EXPECT_EQ(row.youngModulus, 2e10);
  EXPECT_EQ(row.poissonRatio, 0.3);
  EXPECT_EQ(row.horizontalDeviation, 1.5);
  EXPECT_EQ(row.verticalDeviation, 0.25);
  EXPECT_EQ(row.attitudeDeviation, 20.0);
  EXPECT_FALSE(row.randomAttitude);
  EXPECT_TRUE(only(table(",dev_att", ",Random")).randomAttitude);
  // With a terrain a table needs no z.
  EXPECT_TRUE(std::isnan(only(writeFile("flat.csv", "x,y\n1,2\n")).position.z()));
}

TEST(SourceLayerErrors, cells)
{
  struct Case
  {
    const char *columns, *cells;
    std::vector<std::string> message;
  };
  for (const Case& wrong : {
         Case{ ",amount", ",-1", { "\"amount\"", "-1", "at least 0" } },
         Case{ ",amount", ",2.5", { "\"amount\"", "2.5", "whole" } },
         Case{ ",amount", ",many", { "\"amount\"", "\"many\"", "not a number" } },
         Case{ ",amount", ",nan", { "\"amount\"", "nan", "finite" } },
         Case{ ",amount", ",\"1,5\"", { "\"amount\"", "\"1,5\"", "point" } },
         Case{ ",intensity", ",-0.1", { "\"intensity\"", "-0.1" } },
         Case{ ",intensity", ",0.1", { "\"intensity\"", "lines and polygons" } },
         Case{ ",height", ",-1", { "\"height\"", "-1", "0 to 500 m" } },
         Case{ ",height", ",1e308", { "\"height\"", "1e+308", "0 to 500 m" } },
         Case{ ",source_id", ",1.5", { "\"source_id\"", "1.5", "whole" } },
         Case{ ",shape", ",cube:2;ball:1", { "\"shape\"", "\"ball\"", "icosahedron" } },
         Case{ ",shape", ",cube:-2", { "\"shape\"", "cube:-2", "at least 0" } },
         Case{ ",shape", ",\"cube:1,5\"", { "\"shape\"", "1,5", "point" } },
         Case{ ",shape", ",cube:0", { "\"shape\"", "sum" } },
         Case{ ",vol_law", ",gamma", { "\"vol_law\"", "\"gamma\"", "lognormal" } },
         Case{ ",vol_dev", ",-1", { "\"vol_dev\"", "-1" } },
         Case{ ",vol_min", ",-1", { "\"vol_min\"", "-1" } },
         Case{ ",vol_max", ",inf", { "\"vol_max\"", "inf" } },
         Case{ ",vol_exp", ",0", { "\"vol_exp\"", "0", "above 0" } },
         Case{ ",material", ",cheese", { "\"material\"", "\"cheese\"", "granite" } },
         Case{ ",young", ",0", { "\"young\"", "above 0" } },
         Case{ ",poisson", ",0.5", { "\"poisson\"", "0.5", "0.49" } },
         Case{ ",dev_xy", ",-1", { "\"dev_xy\"", "-1" } },
         Case{ ",rx,ry,rz", ",0,-9999,0", { "\"ry\" is -9999", "-360 to 360 degrees" } },
         Case{ ",dev_z", ",x", { "\"dev_z\"", "\"x\"" } },
         Case{ ",dev_att", ",any", { "\"dev_att\"", "\"any\"" } },
       })
  {
    const std::string path = table(wrong.columns, wrong.cells);
    const std::string message = failure(path);
    EXPECT_TRUE(holds(message, wrong.message)) << wrong.columns << wrong.cells;
    EXPECT_TRUE(holds(message, { path, "row 1" }));
  }
}

TEST(SourceLayerErrors, rows)
{
  EXPECT_TRUE(holds(failure(writeFile("slip.csv", "x,y,ammount\n1,2,3\n")),
    { "slip.csv", "\"ammount\"", "none \"amount\"" }));
  EXPECT_TRUE(holds(failure(feature(squareRing, R"("amount":1,"intensity":2)")),
    { "row 1", "\"amount\"", "\"intensity\"", "one of them" }));
  EXPECT_TRUE(holds(failure(feature(squareRing), {}), { "row 1", "POLYGON", "Terrain", "\"z\"" }));
  EXPECT_TRUE(holds(failure(table(",height", ",2"), {}), { "\"height\"", "Terrain" }));
  const char* const bow = R"({"type":"Polygon","coordinates":[[[0,0],[4,4],[4,0],[0,4],[0,0]]]})";
  EXPECT_TRUE(holds(failure(feature(bow)), { "row 1", "POLYGON", "not valid", "crosses" }));
  const std::string degrees = writeFile("degrees.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"z":1},)"
    R"("geometry":{"type":"Polygon","coordinates":[[[9,45],[9.1,45],[9,45.1],[9,45]]]}}]})");
  EXPECT_TRUE(holds(failure(degrees, {}), { "POLYGON", "in degrees", "TargetCRS" }));
  SourceOptions few = onTerrain();
  few.mostRocks = 2;
  const std::string many = writeFile("many.csv", "x,y\n1,2\n1,2\n1,2\n");
  EXPECT_TRUE(holds(failure(many, few), { many, "more than 2 rows", "MaximumRocks" }));
}

TEST(SourceLayerErrors, namesOfColumns)
{
  struct Slip
  {
    const char *column, *meant;
  };
  for (const Slip& slip : { Slip{ "materiel", "material" }, { "Mat_Nam", "mat_name" },
         { "matname", "mat_name" }, { "mat", "material" }, { "vol", "volume" },
         { "Volum", "volume" }, { "densite", "density" }, { "intensty", "intensity" },
         { "entensity", "" }, { "intesnty", "intensity" }, { "sourceid", "source_id" } })
  {
    const std::string path = writeFile("slip.csv", std::string("x,y,") + slip.column + "\n1,2,\n");
    if (*slip.meant == 0)
    {
      EXPECT_EQ(readSourceLayer(path, onTerrain()).rows.size(), 1u);
      continue;
    }
    EXPECT_TRUE(holds(failure(path),
      { path, "\"" + std::string(slip.column) + "\" is not read",
        "none \"" + std::string(slip.meant) + "\"" }));
  }
  // Foreign ones, as other programs write them, don't count; nor do names beside those meant.
  const std::string foreign = "x,y,Shape_Leng,Shape_Area,Shap,weight,value,mass,source_ref,no,fid,"
                              "mat_code,dev,column,volume,vol\n1,2,,,,,,,,,,,,,3,4\n";
  const SourceLayer layer = readSourceLayer(writeFile("foreign.csv", foreign), onTerrain());
  EXPECT_EQ(layer.rows.at(0).volume, 3.0);
}

TEST(SourceLayerErrors, columnsTwice)
{
  EXPECT_TRUE(holds(failure(writeFile("twice.csv", "x,y,volume,volume\n1,2,3,4\n")),
    { "twice.csv", "two columns \"volume\"" }));
  EXPECT_TRUE(holds(failure(writeFile("twice.csv", "x,y,volume, Volume\n1,2,3,4\n")),
    { "twice.csv", "\"volume\"", "Volume\"", "upper and lower case are one" }));
  EXPECT_TRUE(holds(
    failure(writeFile("twice.csv", "x,y,shape,SHAPE\n1,2,cube,box\n")), { "\"shape\"", "SHAPE" }));
  const std::string foreign =
    writeFile("twice.csv", "x,y,note,note,Shape_Area,Shape_Area\n1,2,,,,\n");
  EXPECT_EQ(readSourceLayer(foreign, onTerrain()).rows.size(), 1u);
}

TEST(SourceLayers, decimalCommaOfTheLocaleChangesNothing)
{
  const std::string path = table(",shape,vol_dev", ",cube:1.5;box:0.25,0.75");
  const CommaLocale comma;
  const SourceRow row = only(path);
  EXPECT_EQ(row.shapes->parts.at(0).weight, 1.5);
  EXPECT_EQ(row.shapes->parts.at(1).weight, 0.25);
  EXPECT_EQ(row.volumeDeviation, 0.75);
}

} // namespace

} // namespace rockfall
