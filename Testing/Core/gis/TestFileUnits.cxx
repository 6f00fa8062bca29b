/// @file
/// Tables and layers that say no unit beside a slope whose file declares feet.

#include "gis/layers/lineLayer.h"
#include "gis/layers/sources.h"
#include "gis/layers/structureLayers.h"
#include "gis/raster/contours.h"
#include "gis/raster/ground.h"
#include "gis/raster/raster.h"
#include "gisFiles.h"
#include "terrain/Terrain.h"

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

/// One feature in UTM zone 32, which says nothing of heights.
std::string inUtm(const std::string& geometry, const std::string& properties)
{
  return writeFile("layer.geojson",
    R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
    R"("urn:ogc:def:crs:EPSG::32632"}},"features":[{"type":"Feature","properties":{)" +
      properties + R"(},"geometry":)" + geometry + "}]}");
}

/// A plain at 60 m whose file had both in feet.
Terrain plain(const std::string& crs)
{
  GridGeometry g;
  g.columns = g.rows = 21;
  g.cellSize = 10.0;
  g.xOrigin = 599900.0;
  g.yOrigin = 5099900.0;
  g.crs = wktOfCrs(crs);
  g.fileUnits = { foot, crs.empty() ? foot : 1.0 };
  return Terrain(g, std::vector<double>(std::size_t(g.nodeCount()), 60.0));
}

SourceOptions besideFeet()
{
  SourceOptions options;
  options.haveTerrain = true;
  options.terrainUnits = { foot, foot };
  return options;
}

std::string notesOfSources(const std::string& file, const SourceOptions& options)
{
  return joined(readSourceLayer(file, options).notes);
}

TEST(FileUnits, areRememberedByTheSlope)
{
  RawRaster raster = smallRaster();
  raster.crs = "LOCAL_CS[\"peg\",UNIT[\"foot\",0.3048]]";
  raster.band = "<UnitType>ft</UnitType>";
  const FileUnits both = readRaster(raster.write()).geometry.fileUnits;
  EXPECT_EQ(both.heights, foot);
  EXPECT_EQ(both.plan, foot);
  raster = smallRaster();
  raster.band = "<Scale>0.3048</Scale>";
  EXPECT_EQ(readRaster(raster.write()).geometry.fileUnits.heights, foot);
  EXPECT_EQ(readRaster(raster.write()).geometry.fileUnits.plan, 1.0);
  raster.band = "<Scale>0.1</Scale>"; // packs numbers; nobody has heights so
  EXPECT_EQ(readRaster(raster.write()).geometry.fileUnits.heights, 1.0);
  const std::string lines = writeFile(
    "lines.csv", "WKT,elev_ft\n\"LINESTRING(0 0,100 0)\",100\n\"LINESTRING(0 100,100 100)\",200\n");
  EXPECT_EQ(readContours(lines).geometry.fileUnits.heights, foot);
}

TEST(FileUnits, ofATableWithoutAreNoted)
{
  const std::string table = writeFile("rocks.csv", "x,y,z\n1,2,300\n3,4,301\n");
  const std::string notes = notesOfSources(table, besideFeet());
  EXPECT_TRUE(holds(notes,
    { table + ", row 1: its field \"z\" of 300 says no unit", "its heights in feet", "\"z_ft\"",
      table + ", row 1: its place 1, 2 says no unit", "its coordinates in feet", "0.3048" }));
  EXPECT_EQ(notes.find("row 2"), std::string::npos); // one note of each kind
}

TEST(FileUnits, ofPointsWithoutAreNoted)
{
  const std::string notes = notesOfSources(
    inUtm(R"({"type":"Point","coordinates":[600000,5100000,300]})", ""), besideFeet());
  EXPECT_TRUE(holds(notes, { "row 1: its z of 300 says no unit", "vertical CRS" }));
  EXPECT_EQ(notes.find("its place"), std::string::npos); // the CRS says their unit
}

TEST(FileUnits, ofStructuresAndLinesWithoutAreNoted)
{
  std::vector<std::string> notes;
  StructureFiles files;
  files.embankments =
    inUtm(R"({"type":"LineString","coordinates":[[600000,5100000],[600050,5100000]]})",
      R"("crest":64,"width":2,"slope":1.5)");
  readStructures(files, plain("EPSG:32632"), notes);
  EXPECT_TRUE(holds(joined(notes), { "row 1: its field \"crest\" of 64 says no unit" }));
  notes.clear();
  files = {};
  files.trees = writeFile("trees.csv", "x,y,diameter,height\n600000,5100000,35,22\n");
  readStructures(files, plain(""), notes);
  EXPECT_TRUE(holds(joined(notes), { files.trees + ", row 1: its place 600000" }));
  notes.clear();
  const std::string road = writeFile("road.csv", "WKT,name\n\"LINESTRING(0 0,10 0)\",road\n");
  readLineLayer(road, "", "", &notes, { foot, foot });
  EXPECT_TRUE(holds(joined(notes), { road + ", row 1: its place 0, 0", "coordinates in feet" }));
}

/// Notes of classes of the plain, of a raster of one class at this corner with these cells.
std::string notesOfClasses(const std::string& crs, double x, double y, double cell)
{
  RawRaster raster;
  raster.columns = raster.rows = 40;
  raster.affine = { x, cell, 0.0, y, 0.0, -cell };
  raster.crs = crs;
  raster.type = "Byte";
  raster.values.assign(1600, 1.0);
  const std::string table = writeFile("classes.csv", "class,preset\n1,Meadow\n");
  std::vector<std::string> notes;
  readGround(GroundKind::Restitution, { raster.write("classes"), table, "" }, plain(""), notes);
  return joined(notes);
}

TEST(FileUnits, ofClassRastersWithoutAreNoted)
{
  const std::string notes = notesOfClasses("", 599900.0, 5100100.0, 6.0);
  EXPECT_TRUE(
    holds(notes, { "classes.vrt: its place 599900, 5100100 says no unit", "coordinates in feet" }));
  // The same place in feet that are declared.
  const std::string said = notesOfClasses(
    "LOCAL_CS[\"peg\",UNIT[\"foot\",0.3048]]", 599900.0 / foot, 5100100.0 / foot, 20.0);
  EXPECT_TRUE(holds(said, { "in foot were multiplied by 0.3048", "1 100 %" }));
  EXPECT_EQ(said.find("says no unit"), std::string::npos);
}

TEST(FileUnits, thatAreSaidLeaveNoDoubt)
{
  SourceOptions options = besideFeet();
  options.terrainUnits.plan = 1.0;
  for (const char* table : { "x,y,z_ft\n1,2,300\n", "x,y,z_m\n1,2,300\n", "x,y\n1,2\n" })
  {
    EXPECT_EQ(notesOfSources(writeFile("rocks.csv", table), options), "") << table;
  }
  options.terrainUnits = {};
  EXPECT_EQ(notesOfSources(writeFile("rocks.csv", "x,y,z\n1,2,300\n"), options), "");
}

} // namespace

} // namespace rockfall
