/// @file
/// Rockfall sources as tables and point layers: what each cell becomes, and every way in which one
/// can be wrong.

#include "base/errors.h"
#include "gis/layers/sources.h"
#include "gisFiles.h"

#include <algorithm>
#include <cstdio>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

std::vector<SourceRow> readSources(const std::string& path, const std::string& crs = {})
{
  return readSourceLayer(path, { .targetCrs = crs }).rows;
}

template <class Expected>
std::string refusal(const std::string& path, const std::string& crs = {})
{
  return messageOf<Expected>([&] { readSources(path, crs); });
}

std::string table(const std::string& text)
{
  return writeFile("rocks.csv", text);
}

/// A GeoJSON layer of one feature. Without a crs member its coordinates are longitude and latitude.
std::string rocksAt(
  const std::string& geometry, const std::string& properties = "", const std::string& crs = "")
{
  return writeFile("rocks.geojson",
    "{\"type\":\"FeatureCollection\"," +
      (crs.empty() ? ""
                   : "\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"" + crs + "\"}},") +
      "\"features\":[{\"type\":\"Feature\",\"properties\":{" + properties +
      "},\"geometry\":" + geometry + "}]}");
}

TEST(Sources, everyColumnOfATable)
{
  const auto rows = readSources(table("X,y,Z,Shape,VOLUME,density,vx,vy,vz,wx,wy,wz,rx,ry,rz,lx,ly,"
                                      "lz,remark\n"
                                      "600000.25,5100000.5,1234.125,cube,1.5,2700,1,-2,3e0,.1,.2,"
                                      "+.3,10,20,30,1,2,3,by the road\n"));
  ASSERT_EQ(rows.size(), 1u);
  const SourceRow& row = rows[0];
  EXPECT_EQ(row.row, 1);
  EXPECT_EQ(row.position, Vec3(600000.25, 5100000.5, 1234.125));
  EXPECT_EQ(row.shapes, ShapeMix(Shape::Cube));
  EXPECT_EQ(row.volume, 1.5);
  EXPECT_EQ(row.density, 2700.0);
  EXPECT_EQ(row.velocity, Vec3(1.0, -2.0, 3.0));
  EXPECT_EQ(row.angularVelocity, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(row.orientation, Vec3(10.0, 20.0, 30.0));
  EXPECT_EQ(row.lengths, Vec3(1.0, 2.0, 3.0));
}

TEST(Sources, whatIsNotSaidStaysEmpty)
{
  const auto rows = readSources(table("x,y,z,volume,shape,vz\n1,2,3,,,\n4,5,6,2,,-1\n7,8,9\n"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_FALSE(rows[0].volume || rows[0].shapes || rows[0].density || rows[0].velocity ||
    rows[0].angularVelocity || rows[0].orientation || rows[0].lengths);
  EXPECT_EQ(rows[1].row, 2);
  EXPECT_EQ(rows[1].volume, 2.0);
  EXPECT_EQ(rows[1].velocity, Vec3(0.0, 0.0, -1.0));
  EXPECT_EQ(rows[2].position, Vec3(7.0, 8.0, 9.0));
}

TEST(Sources, separatorsBlanksAndDigits)
{
  for (const char separator : { ';', '\t' })
  {
    std::string text = "x; y; z\n 1.5 ; 2 ;0.1234567890123456\n";
    std::replace(text.begin(), text.end(), ';', separator);
    const auto rows = readSources(table(text));
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].position, Vec3(1.5, 2.0, 0.1234567890123456));
  }
}

TEST(Sources, decimalCommaOfTheLocaleChangesNothing)
{
  const std::string path = table("x,y,z,volume\n600000.25,5100000.5,1234.5,0.75\n");
  const std::string points =
    rocksAt(R"({"type":"Point","coordinates":[10.25,20.5,30.75]})", "\"volume\":0.75");
  const CommaLocale comma;
  EXPECT_EQ(readSources(path)[0].position, Vec3(600000.25, 5100000.5, 1234.5));
  EXPECT_EQ(readSources(path)[0].volume, 0.75);
  EXPECT_EQ(readSources(points)[0].position, Vec3(10.25, 20.5, 30.75));
  EXPECT_EQ(readSources(points)[0].volume, 0.75);
}

TEST(Sources, pointsWithAndWithoutHeight)
{
  const std::string properties = R"("z":99.5,"Volume":2,"shape":"cube","density":2600.5)";
  const std::string three = rocksAt(R"({"type":"Point","coordinates":[10,20,30]})", properties);
  EXPECT_EQ(readSources(three)[0].position, Vec3(10.0, 20.0, 30.0)); // its own before the column
  EXPECT_EQ(readSources(three)[0].volume, 2.0);
  EXPECT_EQ(readSources(three)[0].density, 2600.5);
  EXPECT_EQ(readSources(three)[0].shapes, ShapeMix(Shape::Cube));
  const std::string two = rocksAt(R"({"type":"Point","coordinates":[10,20]})", properties);
  EXPECT_EQ(readSources(two)[0].position, Vec3(10.0, 20.0, 99.5));
  const std::string one =
    rocksAt(R"({"type":"MultiPoint","coordinates":[[10,20,30]]})", properties);
  EXPECT_EQ(readSources(one)[0].position, Vec3(10.0, 20.0, 30.0));
  const std::string none = rocksAt("null", R"("x":1,"y":2,"z":3)");
  EXPECT_EQ(readSources(none)[0].position, Vec3(1.0, 2.0, 3.0));
}

TEST(Sources, shapefile)
{
  // One PointZ and its table with a number and a word, byte by byte.
  std::string shp, shx, dbf;
  const auto big = [](std::string& to, int word) {
    to += { char(word >> 24), char(word >> 16), char(word >> 8), char(word) };
  };
  const auto raw = [](std::string& to, auto value)
  { to.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  const auto header = [&](std::string& to, int words)
  {
    for (const int word : { 9994, 0, 0, 0, 0, 0, words })
    {
      big(to, word);
    }
    raw(to, 1000);
    raw(to, 11);
    for (const double bound : { 600000.5, 5100000.5, 600000.5, 5100000.5, 321.5, 321.5, 0.0, 0.0 })
    {
      raw(to, bound);
    }
  };
  header(shp, 50 + 4 + 18);
  header(shx, 50 + 4);
  for (std::string* to : { &shp, &shx })
  {
    big(*to, to == &shp ? 1 : 50);
    big(*to, 18);
  }
  raw(shp, 11);
  for (const double value : { 600000.5, 5100000.5, 321.5, 0.0 })
  {
    raw(shp, value);
  }
  dbf += { 3, 123, 1, 1 };
  raw(dbf, 1);
  raw(dbf, std::int16_t(32 + 2 * 32 + 1));
  raw(dbf, std::int16_t(1 + 8 + 4));
  dbf.resize(32);
  const auto field = [&dbf](const std::string& name, char type, char width, char decimals)
  {
    std::string text = name;
    text.resize(11);
    text += type;
    text.resize(16);
    text += { width, decimals };
    text.resize(32);
    dbf += text;
  };
  field("VOLUME", 'N', 8, 3);
  field("SHAPE", 'C', 4, 0);
  dbf += "\r    1.125cube\x1a";
  const std::string path = writeFile("rocks.shp", shp);
  writeFile("rocks.shx", shx);
  writeFile("rocks.dbf", dbf);

  const auto rows = readSources(path);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].position, Vec3(600000.5, 5100000.5, 321.5));
  EXPECT_EQ(rows[0].volume, 1.125);
  EXPECT_EQ(rows[0].shapes, ShapeMix(Shape::Cube));
}

TEST(Sources, pointsAreBroughtToTheTerrain)
{
  // On the central meridian of zone 32: 0.9996 times the meridian arc to 45° (WGS 84).
  const std::string lonLat = rocksAt(R"({"type":"Point","coordinates":[9,45,700]})");
  const Vec3 there = readSources(lonLat, "EPSG:32632")[0].position;
  EXPECT_NEAR(there.x(), 500000.0, 1e-6);
  EXPECT_NEAR(there.y(), 0.9996 * 4984944.378, 1e-3);
  EXPECT_EQ(there.z(), 700.0);
  EXPECT_EQ(readSources(lonLat)[0].position, Vec3(9.0, 45.0, 700.0)); // no target: as written

  // The same CRS: not a bit changes.
  const std::string same = rocksAt(R"({"type":"Point","coordinates":[600000.5,5100000.25,700]})",
    "", "urn:ogc:def:crs:EPSG::32632");
  EXPECT_EQ(readSources(same, "EPSG:32632")[0].position, Vec3(600000.5, 5100000.25, 700.0));
  // A table without geometry is in the terrain's CRS by definition.
  EXPECT_EQ(readSources(table("x,y,z\n1,2,3\n"), "EPSG:32632")[0].position, Vec3(1.0, 2.0, 3.0));
}

TEST(Sources, sayInWhichCrsTheyAre)
{
  const auto crsOf = [](const std::string& path, const std::string& target = {})
  { return readSourceLayer(path, { .targetCrs = target }).crs; };
  const std::string lonLat = rocksAt(R"({"type":"Point","coordinates":[9,45,700]})");
  EXPECT_TRUE(holds(crsOf(lonLat, "EPSG:32632"), { "PROJCRS[", "UTM zone 32N" }));
  EXPECT_EQ(crsOf(lonLat, "EPSG:32632"), wktOfCrs("EPSG:32632"));
  EXPECT_TRUE(holds(crsOf(lonLat), { "GEOGCRS[", "WGS 84" }));
  // A row without a point has no part in the layer's CRS.
  EXPECT_EQ(crsOf(rocksAt("null", R"("x":1,"y":2,"z":3)")), "");
  EXPECT_EQ(crsOf(table("x,y,z\n1,2,3\n")), "");
  EXPECT_EQ(crsOf(table("x,y,z\n1,2,3\n"), "EPSG:32632"), wktOfCrs("EPSG:32632"));
  EXPECT_EQ(wktOfCrs(""), "");
  EXPECT_TRUE(holds(messageOf<DataError>([] { wktOfCrs("EPSG:nowhere"); }), { "EPSG:nowhere" }));
}

TEST(SourceErrors, files)
{
  const std::string nowhere = pathOf("nowhere.csv");
  EXPECT_TRUE(holds(refusal<FileError>(nowhere), { nowhere, "no such file" }));
  EXPECT_TRUE(holds(refusal<FileError>(""), { "No file name" }));
  const std::string text = writeFile("letter.shp", "Dear reader");
  EXPECT_TRUE(holds(refusal<FileError>(text), { text, "not a vector layer" }));
  const std::string raster = writeAscii({ "1 2", "3 4" }, 2);
  EXPECT_TRUE(holds(refusal<FileError>(raster), { raster, "is a raster", "points" }));
}

TEST(SourceErrors, empty)
{
  const std::string path = table("x,y,z\n");
  EXPECT_TRUE(holds(refusal<DataError>(path), { path, "no row" }));
  const std::string layer =
    writeFile("none.geojson", R"({"type":"FeatureCollection","features":[]})");
  EXPECT_TRUE(holds(refusal<DataError>(layer), { layer, "no row" }));
}

TEST(SourceErrors, numbersThatAreNone)
{
  struct Case
  {
    const char* text;
    std::vector<std::string> message;
  };
  for (const Case& wrong : {
         Case{ "x;y;z\n1;2;3\n1,5;2;3\n", { "row 2", "\"x\"", "\"1,5\"", "point" } },
         Case{ "x,y,z\n1,2,high\n", { "row 1", "\"z\"", "\"high\"", "not a number" } },
         Case{ "x,y,z,volume\n1,2,3,1m3\n", { "row 1", "\"volume\"", "\"1m3\"" } },
         Case{ "x,y,z,volume\n1,2,3,nan\n", { "\"volume\"", "nan", "finite" } },
         Case{ "x,y,z\n1,inf,3\n", { "\"y\"", "inf", "finite" } },
         Case{ "x,y,z,volume\n1,2,3,0\n", { "\"volume\"", "is 0", "above 0" } },
         Case{ "x,y,z,density\n1,2,3,-2500\n", { "\"density\"", "is -2500", "above 0" } },
         Case{ "x,y,z,vy\n1,2,3,1e999\n", { "\"vy\"", "\"1e999\"" } },
         Case{ "x,y,z,lx,ly,lz\n1,2,3,1,-1,1\n", { "\"ly\"", "is -1" } },
         Case{ "x,y,z,lx,ly,lz\n1,2,3,1,,1\n", { "\"ly\"", "empty", "lx, ly and lz" } },
         // Decimal commas that split numbers in two: too many fields.
         Case{ "x,y,z\n1,2,3\n1,5,2,5,3,5\n", { "row 2", "6 fields", "header 3", "\"5\"" } },
       })
  {
    const std::string path = table(wrong.text);
    const std::string message = refusal<DataError>(path);
    EXPECT_TRUE(holds(message, wrong.message)) << wrong.text;
    EXPECT_TRUE(holds(message, { path }));
  }
}

TEST(SourceErrors, numbersInAJsonLayer)
{
  const std::string point = R"({"type":"Point","coordinates":[1,2,3]})";
  EXPECT_TRUE(holds(
    refusal<DataError>(rocksAt(point, "\"volume\":-0.5")), { "row 1", "\"volume\"", "-0.5" }));
  EXPECT_TRUE(holds(refusal<DataError>(rocksAt(point, "\"volume\":\"big\"")),
    { "row 1", "\"volume\"", "\"big\"" }));
}

TEST(Sources, elevationsOfWaypointsAreTold)
{
  const std::string path = writeFile("way.gpx",
    R"(<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1">)"
    R"(<wpt lat="46.05" lon="10.29"><ele>700</ele></wpt></gpx>)");
  SourceOptions options;
  options.targetCrs = "EPSG:32632";
  options.haveTerrain = true;
  const std::vector<std::string> notes = readSourceLayer(path, options).notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(),
    [](const std::string& note)
    { return note.find("not read is its column \"ele\"") != std::string::npos; }));
  for (const std::string column : { "return_period", "annual_frequency", "BlockVolume" })
  {
    const std::string often = writeFile("often.csv", "x,y," + column + "\n1,2,30\n");
    EXPECT_TRUE(holds(
      readSourceLayer(often, options).notes.front(), { "not read is its column \"" + column }));
  }
}

TEST(SourceErrors, trueIsNoNumber)
{
  const std::string point = R"({"type":"Point","coordinates":[1,2,3]})";
  EXPECT_TRUE(holds(refusal<DataError>(rocksAt(point, "\"volume\":true")),
    { "row 1", "\"volume\"", "\"true\" is not a number" }));
  EXPECT_TRUE(holds(refusal<DataError>(rocksAt(point, "\"density\":false")),
    { "row 1", "\"density\"", "\"false\" is not a number" }));
  // Beside numbers GDAL's column is one of numbers.
  const auto two = [](const char* first, const char* second)
  {
    return writeFile("two.geojson",
      std::string(R"({"type":"FeatureCollection","features":[)") +
        R"({"type":"Feature","geometry":{"type":"Point","coordinates":[1,2,3]},"properties":{"volume":)" +
        first +
        R"(}},{"type":"Feature","geometry":{"type":"Point","coordinates":[9,2,3]},"properties":{"volume":)" +
        second + "}}]}");
  };
  EXPECT_EQ(readSources(two("1", "0.5")).at(0).volume, 1.0);
  EXPECT_TRUE(holds(refusal<DataError>(two("0.5", "true")), { "row 2", "\"volume\"", "\"true\"" }));
  EXPECT_TRUE(holds(refusal<DataError>(two("true", "2")), { "row 1", "\"volume\"", "\"true\"" }));
  // A logical column of a typed table.
  const std::string typed = table("x,y,z,volume\n1,2,3,1\n");
  writeFile("rocks.csvt", "\"Real\",\"Real\",\"Real\",\"Integer(Boolean)\"\n");
  EXPECT_TRUE(holds(refusal<DataError>(typed), { typed, "row 1", "\"volume\"", "\"true\"" }));
}

TEST(Sources, aSchemaBesideGmlIsNotRead)
{
  const std::string path = writeFile("rocks.gml",
    R"(<ogr:FeatureCollection xmlns:ogr="http://ogr.maptools.org/" )"
    R"(xmlns:gml="http://www.opengis.net/gml"><gml:featureMember><ogr:rocks fid="r.0">)"
    R"(<ogr:geometryProperty><gml:Point srsName="EPSG:32632"><gml:coordinates>1,2,3)"
    R"(</gml:coordinates></gml:Point></ogr:geometryProperty><ogr:volume>3.5</ogr:volume>)"
    R"(</ogr:rocks></gml:featureMember></ogr:FeatureCollection>)");
  const std::string beside = path.substr(0, path.size() - 3) + "gfs";
  std::remove(beside.c_str());
  const SourceLayer alone = readSourceLayer(path, {});
  EXPECT_EQ(alone.rows.at(0).volume, 3.5);
  EXPECT_TRUE(alone.notes.empty());
  EXPECT_FALSE(std::ifstream(beside).good()) << "was written beside the user's file";
  const auto schema = [](const std::string& property, const char* crs)
  {
    writeFile("rocks.gfs",
      std::string("<GMLFeatureClassList><GMLFeatureClass><Name>rocks</Name><ElementPath>rocks"
                  "</ElementPath><GeometryName>geometryProperty</GeometryName><GeometryElementPath>"
                  "geometryProperty</GeometryElementPath><GeometryType>-2147483647</GeometryType>"
                  "<SRSName>") +
        crs + "</SRSName>" + property + "</GMLFeatureClass></GMLFeatureClassList>");
  };
  const auto volume = [](const char* type)
  {
    return std::string("<PropertyDefn><Name>volume</Name><ElementPath>volume</ElementPath><Type>") +
      type + "</Type></PropertyDefn>";
  };
  schema(volume("Real"), "EPSG:32632");
  EXPECT_TRUE(readSourceLayer(path, {}).notes.empty());
  for (const auto& [property, crs] : { std::pair(std::string(), "EPSG:32632"),
         std::pair(volume("Integer"), "EPSG:32632"), std::pair(volume("Real"), "EPSG:32633") })
  {
    schema(property, crs);
    const SourceLayer layer = readSourceLayer(path, {});
    EXPECT_EQ(layer.rows.at(0).volume, 3.5);
    EXPECT_NE(layer.crs.find("zone 32N"), std::string::npos);
    ASSERT_EQ(layer.notes.size(), 1u);
    EXPECT_TRUE(holds(layer.notes[0], { "rocks.gfs beside it says otherwise", "not read" }));
  }
  std::remove(beside.c_str());
}

TEST(SourceErrors, textInATypedTable)
{
  // A .csvt beside the table makes OGR turn words into zeros.
  const std::string path = table("x,y,z\n1,2,3\n1,2,high\n");
  writeFile("rocks.csvt", "\"Real\",\"Real\",\"Real\"\n");
  EXPECT_TRUE(holds(refusal<DataError>(path), { path, "row 2", "z" }));
  // Another warning before it hides nothing.
  const std::string longer = table("x,y,z\n1234567,2,3\n1,2,high\n");
  writeFile("rocks.csvt", "\"Real(5.2)\",\"Real\",\"Real\"\n");
  EXPECT_TRUE(holds(refusal<DataError>(longer), { longer, "row 2", "z" }));
}

TEST(SourceErrors, noPosition)
{
  const std::string flat = table("x,y\n1,2\n");
  EXPECT_TRUE(holds(refusal<DataError>(flat), { flat, "row 1", "\"z\"", "no such column" }));
  const std::string cell = table("x,y,z\n1,2,3\n,2,3\n");
  EXPECT_TRUE(holds(refusal<DataError>(cell), { cell, "row 2", "\"x\"", "empty" }));
  const std::string bare = table("1,2,3\n4,5,6\n");
  EXPECT_TRUE(holds(refusal<DataError>(bare), { bare, "\"x\"", "no such column" }));
  const std::string point = rocksAt(R"({"type":"Point","coordinates":[1,2]})");
  EXPECT_TRUE(holds(refusal<DataError>(point), { point, "row 1", "\"z\"", "elevation" }));
}

TEST(SourceErrors, unknownShape)
{
  const std::string path = table("x,y,z,shape\n1,2,3,banana\n");
  EXPECT_TRUE(
    holds(refusal<DataError>(path), { path, "row 1", "\"shape\"", "banana", "cube", "eota111" }));
}

TEST(SourceErrors, wrongGeometry)
{
  const std::string mixed = rocksAt(
    R"({"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,2,3]}]})");
  EXPECT_TRUE(holds(refusal<DataError>(mixed), { mixed, "row 1", "GEOMETRYCOLLECTION", "POINT" }));
  const std::string two = rocksAt(R"({"type":"MultiPoint","coordinates":[[1,2,3],[4,5,6]]})");
  EXPECT_TRUE(holds(refusal<DataError>(two), { two, "row 1", "MULTIPOINT", "2 points" }));
}

TEST(SourceErrors, crs)
{
  const std::string point = rocksAt(R"({"type":"Point","coordinates":[9,45,700]})");
  EXPECT_TRUE(holds(refusal<DataError>(point, "EPSG:nothing"), { "\"EPSG:nothing\"" }));
  // Metres in a file that says degrees.
  const std::string metres = rocksAt(R"({"type":"Point","coordinates":[600000,5100000,700]})");
  EXPECT_TRUE(holds(refusal<DataError>(metres, "EPSG:32632"),
    { metres, "row 1", "600000, 5100000", "EPSG:32632" }));
}

TEST(Sources, columnsThatAreNotWhereThePointIsAreTold)
{
  const auto notesOf = [](const std::string& point)
  {
    SourceOptions options;
    options.haveTerrain = true;
    return readSourceLayer(
      writeFile("moved.csv", "WKT,x,y\n" + point + ",1,2\n\"POINT(9 8)\",9,8\n"), options)
      .notes;
  };
  EXPECT_TRUE(notesOf("\"POINT(1.05 2)\"").empty());
  const std::vector<std::string> moved = notesOf("\"POINT(1 50)\"");
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_NE(moved[0].find("1 rows have an x and y other than their geometry, which counts, first "),
    std::string::npos);
  EXPECT_NE(moved[0].find("moved.csv, row 1: 1, 2 and 1, 50"), std::string::npos) << moved[0];
}

TEST(Sources, thatReleaseTheSameRocksTwiceAreTold)
{
  const auto notesOf = [](const std::string& text)
  {
    SourceOptions options;
    options.haveTerrain = true;
    return readSourceLayer(writeFile("twice.csv", text), options).notes;
  };
  const std::vector<std::string> points =
    notesOf("x,y,z,amount,volume\n1,2,9,4,1\n1,2,9,4,1\n1,2.05,9,2,1\n5,2,9,4,1\n");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NE(
    points[0].find("2 of 4 sources release the same rocks within 0.1 m of another one, first rows "
                   "1 and 2"),
    std::string::npos)
    << points[0];
  // Another size, height or speed is another source.
  EXPECT_TRUE(notesOf("x,y,z,volume,vx\n1,2,9,1,0\n1,2,9,2,0\n1,2,12,1,0\n1,2,9,1,5\n").empty());
  // Of the second size, too.
  EXPECT_EQ(notesOf("x,y,z,volume\n1,2,9,1\n1,2,9,2\n1,2,9,2\n").size(), 1u);
  const std::string line = "\"LINESTRING(0 0,9 0)\",", back = "\"LINESTRING(9 0.05,4 0,0 0)\",";
  EXPECT_EQ(notesOf("WKT,amount,height\n" + line + "5,1\n" + back + "5,1\n").size(), 1u);
  const std::string ring = "\"POLYGON((0 0,9 0,9 9,0 0))\",";
  EXPECT_EQ(notesOf("WKT,amount,height\n" + ring + "5,1\n" + ring + "5,1\n").size(), 1u);
  // Over a part of it.
  const auto shared = [&](const std::string& one, const std::string& other,
                        const std::string& words, const std::string& rocks = "5,1")
  {
    const std::vector<std::string> notes =
      notesOf("WKT,amount,height\n\"" + one + "\",5,1\n\"" + other + "\"," + rocks + "\n");
    return notes.size() == 1 &&
      notes[0].find("1 of 2 sources release the same rocks on a part of another one or of "
                    "themselves, first row " +
        words) != std::string::npos;
  };
  const std::string nine = "LINESTRING(0 0,9 0)";
  EXPECT_TRUE(shared(nine, "LINESTRING(6 0,1 0)", "2 on row 1 over 5 m"));
  EXPECT_FALSE(shared(nine, "LINESTRING(6 0,1 0)", "2", "5,3"));
  EXPECT_TRUE(shared(nine, "MULTILINESTRING((0 5,9 5),(0 5,4 5))", "2 on itself over 4 m"));
  const std::string square = "POLYGON((0 0,10 0,10 10,0 10,0 0))";
  EXPECT_TRUE(shared(square, "POLYGON((5 0,15 0,15 10,5 10,5 0))", "2 on row 1 on"));
  EXPECT_TRUE(
    shared(square, "POLYGON((-50 -50,60 -50,60 60,-50 60,-50 -50))", "2 on row 1 on 100"));
  EXPECT_FALSE(shared(square, "POLYGON((10 0,15 0,15 10,10 10,10 0))", "2")); // beside it
}

} // namespace

} // namespace rockfall
