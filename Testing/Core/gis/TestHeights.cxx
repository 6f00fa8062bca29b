/// @file
/// What a height means, whatever the file: its unit, its direction, what it refers to. Each file is
/// of one slope or place whose heights are known in metres.

#include "base/errors.h"
#include "gis/layers/lineLayer.h"
#include "gis/layers/sources.h"
#include "gis/layers/structureLayers.h"
#include "gis/raster/contours.h"
#include "gis/raster/raster.h"
#include "gis/trust/headers.h"
#include "gisFiles.h"
#include "netCdf.h"
#include "sheets.h"
#include "terrain/Terrain.h"

#include <cmath>
#include <fstream>
#include <iterator>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

/// Numbers 10, 20, … 60 in cells of 10 m.
RawRaster six(const std::string& crs)
{
  RawRaster raster;
  raster.columns = 3;
  raster.rows = 2;
  raster.affine = { 600000.0, 10.0, 0.0, 5100020.0, 0.0, -10.0 };
  raster.crs = crs;
  raster.values = { 10.0, 20.0, 30.0, 40.0, 50.0, 60.0 };
  return raster;
}

const std::vector<std::string> sixRows = { "10 20 30", "40 50 60" };

/// Height of the last node over that of the first: 50 units.
void expectUnit(const std::string& path, double metres, const std::string& note)
{
  const RasterSurface surface = readRaster(path);
  ASSERT_EQ(surface.heights.size(), 6u) << path;
  // South-up files begin with the southern row.
  EXPECT_NEAR(surface.heights[2] - surface.heights[0], 20.0 * metres, 1e-5) << path;
  EXPECT_NEAR(std::abs(surface.heights[5] - surface.heights[2]), 30.0 * std::abs(metres), 1e-5);
  EXPECT_NEAR(std::abs(surface.heights[0] + surface.heights[5]), 70.0 * std::abs(metres), 1e-5);
  EXPECT_TRUE(holds(joined(surface.notes), { note })) << path;
}

std::string threeDimensional(const std::string& axis)
{
  return "PROJCRS[\"UTM 32 3D\",BASEGEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\","
         "ELLIPSOID[\"WGS 84\",6378137,298.257223563]]],CONVERSION[\"UTM zone 32N\",METHOD["
         "\"Transverse Mercator\",ID[\"EPSG\",9807]],PARAMETER[\"Latitude of natural origin\",0],"
         "PARAMETER[\"Longitude of natural origin\",9,ANGLEUNIT[\"degree\",0.0174532925199433]],"
         "PARAMETER[\"Scale factor at natural origin\",0.9996],PARAMETER[\"False easting\",500000],"
         "PARAMETER[\"False northing\",0]],CS[Cartesian,3],AXIS[\"easting\",east,LENGTHUNIT["
         "\"metre\",1]],AXIS[\"northing\",north,LENGTHUNIT[\"metre\",1]]," +
    axis + "]";
}

const std::string feetUp = threeDimensional("AXIS[\"height\",up,LENGTHUNIT[\"foot\",0.3048]]");

TEST(Heights, ofTheThirdAxisOfACrs)
{
  expectUnit(six(feetUp).write(), foot, "0.3048");
  expectUnit(
    six(threeDimensional("AXIS[\"depth\",down,LENGTHUNIT[\"metre\",1]]")).write(), -1.0, "depths");
  expectUnit(six("EPSG:32632+6360").write(), surveyFoot, "vertical CRS");
  expectUnit(six("EPSG:32632+8228").write(), foot, "vertical CRS");
  expectUnit(six("EPSG:32632+5715").write(), -1.0, "depths");
  expectUnit(six("EPSG:32632+6358").write(), -surveyFoot, "depths");
  expectUnit(six("ENGCRS[\"site\",EDATUM[\"peg\"],CS[Cartesian,3],AXIS[\"x\",east,LENGTHUNIT["
                 "\"metre\",1]],AXIS[\"y\",north,LENGTHUNIT[\"metre\",1]],AXIS[\"z\",up,LENGTHUNIT["
                 "\"foot\",0.3048]]]")
               .write(),
    foot, "vertical axis");
  expectUnit(six("COMPD_CS[\"site\",LOCAL_CS[\"peg\",UNIT[\"metre\",1]],VERT_CS[\"bench\","
                 "VERT_DATUM[\"bench\",2005],UNIT[\"foot\",0.3048]]]")
               .write(),
    foot, "vertical CRS");
}

std::string besidePrj(const std::string& prj)
{
  const std::string grid = writeAscii(sixRows, 3);
  writeFile("grid.prj", prj);
  return grid;
}

std::string esri(const std::string& vertical)
{
  return "PROJCS[\"WGS_1984_UTM_Zone_32N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID["
         "\"WGS_1984\",6378137.0,298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\","
         "0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\","
         "500000.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",9.0],"
         "PARAMETER["
         "\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]],"
         "VERTCS[\"NAVD_1988\"," +
    vertical + "]";
}

TEST(Heights, ofAPrjFile)
{
  const std::string navd = "VDATUM[\"North_American_Vertical_Datum_1988\"],PARAMETER["
                           "\"Vertical_Shift\",";
  expectUnit(besidePrj(esri(navd +
               "0.0],PARAMETER[\"Direction\",1.0],UNIT[\"Foot_US\","
               "0.3048006096012192]")),
    surveyFoot, "vertical CRS");
  expectUnit(besidePrj(esri(navd + "0.0],PARAMETER[\"Direction\",-1.0],UNIT[\"Meter\",1.0]")), -1.0,
    "depths");
  const std::string shifted =
    besidePrj(esri(navd + "5.0],PARAMETER[\"Direction\",1.0],UNIT[\"Meter\",1.0]"));
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(shifted); }), { "shifted by 5" }));
  const std::string old = "Projection UTM\nZone 32\nDatum WGS84\nUnits METERS\nXshift 0.0\n"
                          "Yshift 0.0\nParameters\n";
  expectUnit(besidePrj("Zunits FEET\n" + old), foot, "multiplied by 0.3048");
  expectUnit(besidePrj("Zunits 10\n" + old), 0.1, "multiplied by 0.1");
}

TEST(Heights, ofTheUnitOfABand)
{
  for (const auto& [unit, metres] : { std::pair<const char*, double>{ "ft", foot },
         { "Feet (International)", foot }, { "foot_us", surveyFoot }, { "0.1 m", 0.1 },
         { "[ft]", foot }, { "yd", 0.9144 }, { "m a.s.l.", 1.0 }, { "centimeters", 0.01 } })
  {
    RawRaster raster = six("EPSG:32632");
    raster.band = std::string("<UnitType>") + unit + "</UnitType>";
    expectUnit(raster.write(), metres, metres == 1.0 ? "" : "were multiplied by");
  }
  RawRaster raster = six("EPSG:32632+6360");
  raster.band = "<UnitType>m</UnitType>";
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(raster.write()); }),
    { "have the unit \"m\"", "US survey foot" }));
  raster = six("EPSG:32632");
  raster.band = "<UnitType>unspecified</UnitType>";
  expectUnit(raster.write(), 1.0, "");
}

TEST(Heights, ofNetCdf)
{
  const std::vector<double> values = { 40.0, 50.0, 60.0, 10.0, 20.0, 30.0 };
  const auto grid = [&](const std::vector<NetCdfAttribute>& attributes)
  { return gridOfHeights(values, 3, attributes).write(); };
  expectUnit(grid({ { "units", "ft" } }), foot, "\"ft\"");
  expectUnit(grid({ { "units", "0.1 m" } }), 0.1, "0.1");
  expectUnit(grid({ { "units", "m" }, { "positive", "down" } }), -1.0, "positive: down");
  expectUnit(
    grid({ { "units", "m" }, { "standard_name", "sea_floor_depth_below_geoid" } }), -1.0, "depth");
  expectUnit(grid({ { "units", "feet" }, { "standard_name", "surface_altitude" } }), foot, "feet");
  expectUnit(
    grid({ { "units", "m" }, { "scale_factor", std::vector<double>{ 0.5 } } }), 0.5, "scale 0.5");
  EXPECT_TRUE(holds(messageOf<DataError>(
                      [&] {
                        readRaster(grid({ { "units", "K" } }));
                      }),
    { "\"K\"", "not known" }));
}

/// `lines` of the header beside those that a grid needs.
std::string saga(const std::string& lines)
{
  std::string bytes;
  for (const float value : { 40.f, 50.f, 60.f, 10.f, 20.f, 30.f }) // the southern row first
  {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  writeFile("grid.sgrd",
    "NAME\t= grid\nDATAFORMAT\t= FLOAT\nDATAFILE_OFFSET\t= 0\nBYTEORDER_BIG\t= FALSE\nPOSITION_XMIN"
    "\t= 600005.0\nPOSITION_YMIN\t= 5100005.0\nCELLCOUNT_X\t= 3\nCELLCOUNT_Y\t= 2\nCELLSIZE\t= 10.0"
    "\nTOPTOBOTTOM\t= FALSE\n" +
      lines);
  return writeFile("grid.sdat", bytes);
}

TEST(Heights, ofSaga)
{
  expectUnit(saga("Z_FACTOR\t= 0.100000\n"), 0.1, "Z_FACTOR");
  expectUnit(saga("UNIT\t= ft\nZ_FACTOR\t= 1.000000\n"), foot, "\"ft\"");
  expectUnit(saga("UNIT\t= ft\nZ_FACTOR\t= 0.1\n"), 0.1 * foot, "Z_FACTOR");
  expectUnit(saga("UNIT\t=\nZ_FACTOR\t= 1.0\n"), 1.0, "");
  EXPECT_TRUE(holds(
    messageOf<DataError>([&] { readRaster(saga("Z_FACTOR\t= 0\n")); }), { "Z_FACTOR \"0\"" }));
}

TEST(Heights, ofSagaWithAnOffset)
{
  const auto heights = [](const std::string& lines) { return readRaster(saga(lines)).heights; };
  const auto times = [](double factor, double offset)
  {
    std::vector<double> expected;
    for (const double number : { 10.0, 20.0, 30.0, 40.0, 50.0, 60.0 })
    {
      expected.push_back(number * factor + offset);
    }
    return expected;
  };
  EXPECT_EQ(heights("Z_OFFSET\t= 500.000000\n"), times(1.0, 500.0));
  EXPECT_EQ(heights("Z_FACTOR\t= 0.5\nZ_OFFSET\t= 1000.0\n"), times(0.5, 1000.0));
  // The offset is in the header's unit.
  const auto feet = heights("UNIT\t= ft\nZ_OFFSET\t= 100\n");
  EXPECT_NEAR(feet[0], 110.0 * foot, 1e-12);
  EXPECT_TRUE(holds(readRaster(saga("Z_OFFSET\t= 500\n")).notes.at(0), { "500", "Z_OFFSET" }));
  expectUnit(saga("Z_OFFSET\t= 0.0\n"), 1.0, "");
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(saga("Z_OFFSET\t= nan\n")); }),
    { "grid.sdat", "Z_OFFSET \"nan\"" }));
}

TEST(Heights, ofAZippedSagaGridWithAnOffset)
{
  const std::string grid = saga("Z_FACTOR\t= 0.5\nZ_OFFSET\t= 1000.0\n");
  const auto content = [](const std::string& path)
  {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string header = content(grid.substr(0, grid.size() - 4) + "sgrd");
  const std::string zip = writeFile(
    "packed.sg-grd-z", zipOf({ { "packed.sgrd", header }, { "packed.sdat", content(grid) } }));
  EXPECT_EQ(readRaster(zip).heights,
    (std::vector<double>{ 1005.0, 1010.0, 1015.0, 1020.0, 1025.0, 1030.0 }));
}

TEST(Heights, ofGrass)
{
  const auto grass = [](const std::string& line)
  {
    return writeFile("grass.txt",
      "north: 5100020\nsouth: 5100000\neast: 600030\nwest: 600000\nrows: 2\ncols: 3\n" + line +
        sixRows[0] + "\n" + sixRows[1] + "\n");
  };
  expectUnit(grass("multiplier: 0.1\n"), 0.1, "multiplier");
  expectUnit(grass("type: int\nMultiplier: 0.3048\n"), foot, "multiplier");
  expectUnit(grass(""), 1.0, "");
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readRaster(grass("multiplier: ten\n")); }), { "\"ten\"" }));
}

TEST(Heights, besideCoordinatesInOtherUnitsAreNoted)
{
  for (const char* crs : { "EPSG:2274", "LOCAL_CS[\"peg\",UNIT[\"foot\",0.3048]]",
         "LOCAL_CS[\"peg\",UNIT[\"cm\",0.01]]" })
  {
    RawRaster raster = six(crs);
    raster.columns = raster.rows = 10; // of which a reprojection leaves enough
    raster.values.assign(100, 50.0);
    EXPECT_TRUE(holds(joined(readRaster(raster.write()).notes),
      { "nothing says what its heights are in; they were taken as metres", "-a_scale" }))
      << crs;
    raster.band = "<UnitType>m</UnitType>";
    EXPECT_EQ(joined(readRaster(raster.write()).notes).find("nothing says"), std::string::npos);
  }
}

/// A table with a CRS: `geometry` says in which columns its geometry is.
std::string layer(const std::string& content, const std::string& crs, const std::string& geometry)
{
  const std::string table = writeFile("layer.csv", content);
  const std::size_t first = table.find_last_of('/') + 1;
  return writeFile("layer.vrt",
    "<OGRVRTDataSource><OGRVRTLayer name=\"" + table.substr(first, table.size() - 4 - first) +
      "\"><SrcDataSource>" + table + "</SrcDataSource><LayerSRS>" + crs + "</LayerSRS>" + geometry +
      "</OGRVRTLayer></OGRVRTDataSource>");
}
const std::string pointFields = "<GeometryType>wkbPoint25D</GeometryType><GeometryField encoding="
                                "\"PointFromColumns\" x=\"e\" y=\"n\" z=\"h\"/>";
const std::string flatPoints = "<GeometryType>wkbPoint</GeometryType><GeometryField encoding="
                               "\"PointFromColumns\" x=\"e\" y=\"n\"/>";
const std::string wktField = "<GeometryField encoding=\"WKT\" field=\"WKT\"/>";

std::string pointAt300(const std::string& crs)
{
  return layer("e,n,h\n600000,5100000,300\n", crs, pointFields);
}

TEST(Heights, ofPoints)
{
  for (const auto& [crs, metres] :
    { std::pair<std::string, double>{ feetUp, foot }, { "EPSG:32632+6360", surveyFoot },
      { "EPSG:32632+5715", -1.0 }, { "EPSG:32632", 1.0 }, { "EPSG:32632+8228", foot } })
  {
    const SourceLayer read = readSourceLayer(pointAt300(crs), {});
    EXPECT_NEAR(read.rows.at(0).position.z(), 300.0 * metres, 1e-4) << crs;
    EXPECT_EQ(read.notes.size(), metres == 1.0 ? 0u : 1u) << crs << joined(read.notes);
  }
  // A column of heights is in the unit of the vertical axis, unless its name says another.
  for (const auto& [column, metres] :
    { std::pair<std::string, double>{ "z", surveyFoot }, { "z_m", 1.0 }, { "z_ft", foot } })
  {
    const SourceLayer read = readSourceLayer(
      layer("e,n," + column + "\n600000,5100000,300\n", "EPSG:32632+6360", flatPoints), {});
    EXPECT_NEAR(read.rows.at(0).position.z(), 300.0 * metres, 1e-4) << column;
  }
  const SourceLayer table = readSourceLayer(writeFile("rocks.csv", "x,y,z_ft\n1,2,300\n"), {});
  EXPECT_NEAR(table.rows.at(0).position.z(), 300.0 * foot, 1e-9);
  // The unit may be written otherwise, and what is not read is said.
  for (const char* name : { "z [ft]", "Z (ft)", "zFt", "z in feet" })
  {
    const SourceLayer other = readSourceLayer(
      writeFile("rocks.csv", "x,y," + std::string(name) + ",mass\n1,2,300,5\n"), {});
    EXPECT_NEAR(other.rows.at(0).position.z(), 300.0 * foot, 1e-9) << name;
    EXPECT_TRUE(holds(joined(other.notes), { "not read is its column \"mass\"" })) << name;
  }
}

TEST(Heights, ofPointsBesideCoordinatesInFeetAreNoted)
{
  const SourceLayer read = readSourceLayer(pointAt300("EPSG:2274"), {});
  EXPECT_TRUE(holds(
    joined(read.notes), { "in feet, and nothing says what its heights are in", "EPSG:2274+6360" }));
  EXPECT_TRUE(readSourceLayer(pointAt300("EPSG:2274+6360"), {}).notes.at(0).find("0.30480") !=
    std::string::npos);
  // Local coordinates become metres.
  const SourceLayer local =
    readSourceLayer(pointAt300("LOCAL_CS[\"peg\",UNIT[\"foot\",0.3048]]"), {});
  EXPECT_NEAR(local.rows.at(0).position.x(), 600000.0 * foot, 1e-6);
  EXPECT_TRUE(holds(joined(local.notes), { "multiplied by 0.3048", "nothing says" }));
}

std::string contours(const std::string& crs, const std::string& column = "elev")
{
  return layer("WKT," + column +
      "\n\"LINESTRING(600000 5100000,600100 5100000)\",100\n"
      "\"LINESTRING(600000 5100100,600100 5100100)\",200\n",
    crs, wktField);
}

TEST(Heights, ofContours)
{
  for (const auto& [crs, metres] : { std::pair<std::string, double>{ feetUp, foot },
         { "EPSG:32632+6360", surveyFoot }, { "EPSG:32632+5715", -1.0 }, { "EPSG:32632", 1.0 } })
  {
    const RasterSurface surface = readContours(contours(crs), { .cellSize = 10.0 });
    EXPECT_NEAR(surface.heights.front(), 200.0 * metres, 1e-4) << crs;
    EXPECT_NEAR(surface.heights.back(), 100.0 * metres, 1e-4) << crs;
  }
  EXPECT_NEAR(readContours(contours("EPSG:32632+6360", "elev_m"), { .cellSize = 10.0 }).heights[0],
    200.0, 1e-9);
  EXPECT_TRUE(holds(joined(readContours(contours("EPSG:2274"), { .cellSize = 10.0 }).notes),
    { "nothing says what its heights are in" }));
}

/// Contours 3 m apart over 12 m of height and 24 m of width, 40 m long, drawn in a unit.
std::string drawing(double metres, int code)
{
  std::string text = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n";
  text += code < 0 ? "" : "9\n$INSUNITS\n70\n" + std::to_string(code) + "\n";
  text += "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  for (int z = 0; z <= 12; z += 3)
  {
    text += "0\nLWPOLYLINE\n8\nCONT\n100\nAcDbEntity\n100\nAcDbPolyline\n90\n2\n70\n0\n38\n" +
      exactText(z / metres) + "\n";
    for (const double y : { 0.0, 40.0 })
    {
      text += "10\n" + exactText(2.0 * z / metres) + "\n20\n" + exactText(y / metres) + "\n";
    }
  }
  return writeFile("drawing.dxf", text + "0\nENDSEC\n0\nEOF\n");
}

TEST(Heights, ofDrawings)
{
  for (const auto& [code, metres] : { std::pair<int, double>{ 6, 1.0 }, { 2, foot }, { 4, 0.001 },
         { 1, foot / 12.0 }, { 5, 0.01 }, { 14, 0.1 }, { 21, surveyFoot }, { -1, 1.0 } })
  {
    const RasterSurface surface = readContours(drawing(metres, code), { .cellSize = 2.0 });
    EXPECT_EQ(surface.geometry.columns, 13) << code;
    EXPECT_EQ(surface.geometry.rows, 21) << code;
    EXPECT_NEAR(surface.heights.back(), 12.0, 1e-6) << code;
    EXPECT_EQ(joined(surface.notes).find("$INSUNITS") != std::string::npos, metres != 1.0) << code;
  }
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readContours(drawing(1.0, 99)); }), { "$INSUNITS is 99" }));
}

Terrain site(const std::string& crs)
{
  GridGeometry g;
  g.columns = g.rows = 21;
  g.cellSize = 10.0;
  g.xOrigin = 599900.0;
  g.yOrigin = 5099900.0;
  g.crs = wktOfCrs(crs);
  return Terrain(g, std::vector<double>(std::size_t(g.nodeCount()), 60.0));
}

TEST(Heights, ofCrestsOfDams)
{
  const std::string dam = "WKT,crest,width,slope\n\"LINESTRING(600000 5100000,600050 5100000)\","
                          "210,2,1.5\n";
  std::vector<std::string> notes;
  StructureFiles files;
  files.embankments = layer(dam, "EPSG:32632+6360", wktField);
  const Structures built = readStructures(files, site("EPSG:32632+5703"), notes);
  EXPECT_NEAR(built.embankments.at(0).elevation, 210.0 * surveyFoot, 1e-4);
  EXPECT_TRUE(holds(joined(notes), { "multiplied by 0.3048006" }));
  files.embankments = layer(dam, "EPSG:4937", wktField);
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readStructures(files, site("EPSG:32632+7837"), notes); }),
      { "ETRS89", "DHHN2016" }));
}

TEST(Heights, ofTreesAndLinesBesideCoordinatesInFeetAreNoted)
{
  std::vector<std::string> notes;
  StructureFiles files;
  files.trees = layer("e,n,diameter,height\n1968504,16732283,35,22\n", "EPSG:2274", flatPoints);
  Terrain wide = site("");
  GridGeometry g = wide.geometry();
  g.xOrigin = 1968400.0;
  g.yOrigin = 16732200.0;
  readStructures(files, Terrain(g, std::vector<double>(std::size_t(g.nodeCount()), 60.0)), notes);
  EXPECT_TRUE(holds(joined(notes), { "nothing says what its heights are in" }));
  notes.clear();
  readLineLayer(
    layer("WKT,height\n\"LINESTRING(0 0,10 0)\",4\n", "EPSG:2274", wktField), "", "", &notes);
  EXPECT_TRUE(holds(joined(notes), { "nothing says what its heights are in" }));
}

std::string kml(const std::string& mode, const std::string& altitude = "12")
{
  return writeFile("place.kml",
    "<?xml version=\"1.0\"?><kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Placemark>"
    "<Point>" +
      (mode.empty() ? mode : "<altitudeMode>" + mode + "</altitudeMode>") + "<coordinates>9,45," +
      altitude + "</coordinates></Point></Placemark></Document></kml>");
}

TEST(Heights, ofKmlAreOverWhatTheirModeSays)
{
  SourceOptions options;
  options.haveTerrain = true;
  options.targetCrs = "EPSG:4326";
  SourceLayer read = readSourceLayer(kml("absolute"), options);
  EXPECT_EQ(read.rows.at(0).position.z(), 12.0);
  read = readSourceLayer(kml("relativeToGround"), options);
  EXPECT_EQ(read.rows.at(0).height, 12.0);
  for (const char* mode : { "", "clampToGround" })
  {
    read = readSourceLayer(kml(mode), options);
    EXPECT_TRUE(std::isnan(read.rows.at(0).position.z()));
    EXPECT_FALSE(read.rows.at(0).height);
    EXPECT_TRUE(holds(joined(read.notes), { "clamped to the ground" }));
  }
  EXPECT_TRUE(readSourceLayer(kml("", "0"), options).notes.empty());
  EXPECT_TRUE(holds(
    messageOf<DataError>([&] { readSourceLayer(kml("relativeToGround"), {}); }), { "Terrain" }));
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readSourceLayer(kml("relativeToGround", "-3"), options); }),
      { "-3 m" }));
}

TEST(Heights, ofKmlWithoutLibkmlHaveTheModeOfTheFile)
{
  EXPECT_EQ(gis::kmlMode(kml("absolute")), "absolute");
  EXPECT_EQ(gis::kmlMode(kml("")), "clampToGround");
  const std::string two = writeFile("two.kml",
    "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Placemark><Point><altitudeMode>"
    "absolute</altitudeMode><coordinates>9,45,1</coordinates></Point></Placemark><Placemark><Point>"
    "<coordinates>9,45,2</coordinates></Point></Placemark></Document></kml>");
  EXPECT_TRUE(holds(messageOf<DataError>([&] { gis::kmlMode(two); }),
    { two, "absolute", "clampToGround", "libkml" }));
}

SourceOptions onSite(const std::string& crs)
{
  SourceOptions options;
  options.haveTerrain = true;
  options.targetCrs = wktOfCrs(crs);
  return options;
}

TEST(Heights, ofOtherReferencesAreBroughtToTheTerrains)
{
  // EGM96 comes with PROJ: its geoid at 9° E, 45° N.
  const std::string path = layer("e,n,h\n9,45,300\n", "EPSG:4979", pointFields);
  const SourceLayer read = readSourceLayer(path, onSite("EPSG:32632+5773"));
  EXPECT_NEAR(read.rows.at(0).position.z(), 300.0 - 45.0, 5.0);
  EXPECT_GT(std::abs(read.rows.at(0).position.z() - 300.0), 30.0);
  EXPECT_TRUE(holds(joined(read.notes), { "brought from", "WGS 84", "EGM96" }));
  // And back.
  const std::string over = layer(
    "e,n,h\n9,45," + exactText(read.rows.at(0).position.z()) + "\n", "EPSG:4326+5773", pointFields);
  EXPECT_NEAR(readSourceLayer(over, onSite("EPSG:4979")).rows.at(0).position.z(), 300.0, 1e-6);
  // The same datum in another unit.
  const SourceLayer feet =
    readSourceLayer(pointAt300("EPSG:32632+6360"), onSite("EPSG:32632+5703"));
  EXPECT_NEAR(feet.rows.at(0).position.z(), 300.0 * surveyFoot, 1e-4);
}

TEST(Heights, ofReferencesWithoutAWayAreAnError)
{
  for (const auto& [own, ground, names] :
    { std::tuple<const char*, const char*, std::vector<std::string>>{
        "EPSG:4937", "EPSG:25832+7837", { "ETRS89", "DHHN2016" } },
      { "EPSG:4326+5773", "EPSG:25832+7837", { "EGM96", "DHHN2016" } },
      { "EPSG:4326+5703", "EPSG:25832+5773", { "NAVD88", "EGM96" } } })
  {
    const std::string path = layer("e,n,h\n9,45,300\n", own, pointFields);
    std::vector<std::string> parts = names;
    parts.push_back(path);
    EXPECT_TRUE(
      holds(messageOf<DataError>([&, &ground = ground] { readSourceLayer(path, onSite(ground)); }),
        parts));
  }
}

TEST(Heights, ofOneReferenceAloneAreNoted)
{
  const std::string path = layer("e,n,h\n9,45,300\n", "EPSG:4937", pointFields);
  const SourceLayer read = readSourceLayer(path, onSite("EPSG:25832"));
  EXPECT_EQ(read.rows.at(0).position.z(), 300.0);
  EXPECT_TRUE(holds(joined(read.notes), { "ETRS89", "nothing says" }));
}

TEST(Heights, keepWhatTheyReferTo)
{
  // In metres upwards, whatever they were in.
  const std::string feet = readRaster(six("EPSG:32632+6360").write()).geometry.crs;
  EXPECT_TRUE(holds(feet, { "North American Vertical Datum 1988" }));
  EXPECT_EQ(feet.find("foot"), std::string::npos) << feet;
  EXPECT_EQ(
    readRaster(six("EPSG:32632+6358").write()).geometry.crs.find("down"), std::string::npos);
  EXPECT_EQ(differentHeights(feet, "EPSG:32616+5703"), "");
  EXPECT_TRUE(holds(differentHeights(feet, "EPSG:32616+5773"), { "EGM96" }));
  EXPECT_EQ(differentHeights(feet, "EPSG:32616"), "");
  EXPECT_TRUE(sameCrs(feet, "EPSG:32632"));
  EXPECT_TRUE(holds(differentHeights(readRaster(six(feetUp).write()).geometry.crs, feet),
    { "the ellipsoid of WGS 84", "North American" }));
}

} // namespace

} // namespace rockfall
