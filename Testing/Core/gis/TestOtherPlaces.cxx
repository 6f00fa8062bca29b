/// @file
/// Rasters whose place or CRS is said twice, or is not where the CRS is used, or is counted to the
/// west and south.

#include "base/errors.h"
#include "gis/layers/lineLayer.h"
#include "gis/layers/sources.h"
#include "gis/raster/raster.h"
#include "gis/raster/rasterWriter.h"
#include "gisFiles.h"

#include <algorithm>
#include <cstdio>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

/// A GeoTIFF of 4 × 3 cells of 10 m in UTM zone 32, its upper left corner at (500000, 5100030).
std::string geoTiff()
{
  MapImage map;
  map.columns = 4;
  map.rows = 3;
  map.cellSize = 10.0;
  map.west = 500000.0;
  map.south = 5100000.0;
  map.crs = wktOfCrs("EPSG:32632");
  map.bands.push_back({ "Height", "m",
    [](int row, std::span<float> v) { std::fill(v.begin(), v.end(), float(100 + row)); } });
  const std::string path = pathOf("dem.tif");
  for (const char* beside : { "dem.tfw", "dem.prj", "dem.tif.aux.xml" })
  {
    std::remove(pathOf(beside).c_str());
  }
  writeGeoTiff(path, map);
  return path;
}

/// 8 × 8 cells.
RawRaster square(const std::string& crs, const std::array<double, 6>& affine)
{
  RawRaster raster = smallRaster();
  raster.columns = raster.rows = 8;
  raster.crs = crs;
  raster.affine = affine;
  raster.values.assign(64, 700.0);
  return raster;
}

/// Notes on a raster that say that something is said twice.
std::vector<std::string> twice(const std::string& path)
{
  std::vector<std::string> notes = readRaster(path).notes;
  std::erase_if(notes,
    [](const std::string& note)
    {
      return note.find("said twice") == std::string::npos &&
        note.find("not read") == std::string::npos;
    });
  return notes;
}

std::string worldFile(double cell, double x, double y)
{
  return writeFile("dem.tfw",
    exactText(cell) + "\n0\n0\n" + exactText(-cell) + "\n" + exactText(x) + "\n" + exactText(y) +
      "\n");
}

TEST(OtherPlaces, AWorldFileBesideAGeoTiff)
{
  const std::string path = geoTiff();
  EXPECT_TRUE(twice(path).empty());
  worldFile(10.0, 500005.0, 5100025.0); // the centre of the first cell
  EXPECT_TRUE(twice(path).empty());
  worldFile(10.0, 500005.004, 5100025.0); // digits
  EXPECT_TRUE(twice(path).empty());
  worldFile(10.0, 500000.0, 5100030.0); // its corner
  const std::vector<std::string> half = twice(path);
  ASSERT_EQ(half.size(), 1u);
  EXPECT_TRUE(
    holds(half[0], { "dem.tfw has", "(499995, 5100035)", "the file itself", "(500000, 5100030)" }))
    << half[0];
  worldFile(5.0, 500002.5, 5100027.5); // another resolution
  const std::vector<std::string> other = twice(path);
  ASSERT_EQ(other.size(), 1u);
  EXPECT_TRUE(holds(other[0], { "dem.tfw", "cells of 5", "cells of 10, which was taken" }))
    << other[0];
}

TEST(OtherPlaces, AnAuxiliaryFileBesideAGeoTiff)
{
  const std::string path = geoTiff();
  writeFile("dem.tif.aux.xml",
    "<PAMDataset><SRS dataAxisToSRSAxisMapping=\"1,2\">EPSG:31254</SRS>"
    "<GeoTransform>500000, 10, 0, 5200030, 0, -10</GeoTransform></PAMDataset>");
  const std::vector<std::string> told = twice(path);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_TRUE(holds(
    told[0], { "the file itself has", "5100030", "dem.tif.aux.xml", "5200030", "which was taken" }))
    << told[0];
  EXPECT_TRUE(holds(told[1], { "32632", "31254", "dem.tif.aux.xml" })) << told[1];
}

TEST(OtherPlaces, AProjectionFileBesideAGeoTiff)
{
  const std::string path = geoTiff();
  const auto prj = [](const char* name, double meridian)
  {
    writeFile("dem.prj",
      std::string("PROJCS[\"") + name +
        "\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,"
        "298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],"
        "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],"
        "PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\"," +
        exactText(meridian) +
        "],PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],"
        "UNIT[\"Meter\",1.0]]");
  };
  prj("WGS_1984_UTM_Zone_32N", 9.0);
  EXPECT_TRUE(twice(path).empty());
  prj("WGS_1984_UTM_Zone_33N", 15.0);
  const std::vector<std::string> told = twice(path);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(holds(told[0], { "dem.prj", "33N", "the file itself", "EPSG:32632", "taken" }))
    << told[0];
}

TEST(OtherPlaces, ACrsThatIsUsedElsewhere)
{
  const auto far = [](const RawRaster& raster)
  {
    const std::vector<std::string> notes = readRaster(raster.write()).notes;
    return std::count_if(notes.begin(), notes.end(),
      [](const std::string& note) { return note.find("is far from where") != std::string::npos; });
  };
  const std::array<double, 6> utm = { 600000.0, 10.0, 0.0, 5100020.0, 0.0, -10.0 };
  EXPECT_EQ(far(square("EPSG:32632", utm)), 0);
  std::array<double, 6> east = utm;
  east[0] = 1100000.0; // 7.7 degrees east of its meridian: neighbours use it
  EXPECT_EQ(far(square("EPSG:32632", east)), 0);
  EXPECT_EQ(far(square("EPSG:2056", utm)), 1); // numbers of UTM in Swiss coordinates
  // Latitude first.
  EXPECT_EQ(far(square("EPSG:4258", { 46.0, 1e-4, 0.0, 7.5, 0.0, -1e-4 })), 1);
  EXPECT_EQ(far(square("EPSG:4258", { 7.5, 1e-4, 0.0, 46.0, 0.0, -1e-4 })), 0);
}

TEST(OtherPlaces, SlopesThatCountToTheWestAndSouth)
{
  // Westing and southing on the Cape's Lo29: the node in the west has the larger x.
  RawRaster raster = square("EPSG:2053", { 50000.0, 10.0, 0.0, 2900080.0, 0.0, -10.0 });
  raster.fill([](double x, double) { return 0.5 * (x - 50000.0); }); // rises to the west
  const RasterSurface slope = readRaster(raster.write());
  EXPECT_NE(slope.geometry.crs.find("UTM zone 35S"), std::string::npos) << slope.geometry.crs;
  EXPECT_TRUE(std::any_of(slope.notes.begin(), slope.notes.end(),
    [](const std::string& note)
    { return note.find("its coordinates count to the west and south") != std::string::npos; }));
  int pairs = 0;
  for (std::size_t k = 0; k + 1 < slope.heights.size(); ++k)
  {
    if ((k + 1) % std::size_t(slope.geometry.columns) != 0 && !std::isnan(slope.heights[k]) &&
      !std::isnan(slope.heights[k + 1]))
    {
      ++pairs;
      EXPECT_LT(slope.heights[k + 1], slope.heights[k]) << k;
    }
  }
  EXPECT_GT(pairs, 0);

  const std::string path = writeFile("rocks.geojson",
    R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
    R"("urn:ogc:def:crs:EPSG::2053"}},"features":[{"type":"Feature","properties":{},)"
    R"("geometry":{"type":"Point","coordinates":[50000,2900000,700]}}]})");
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readSourceLayer(path, {}); }),
    { path, "counts to the west and south", "EPSG:2053", "TargetCRS" }));
  SourceOptions options;
  options.haveTerrain = true;
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readSourceLayer(path, options); }),
    { path, "counts to the west and south", "in which CRS the slope is" }));
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { wktOfCrs("EPSG:2053"); }), { "EPSG:2053", "west and south" }));
  const std::string road = writeFile("road.geojson",
    R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
    R"("urn:ogc:def:crs:EPSG::5513"}},"features":[{"type":"Feature","properties":{},)"
    R"("geometry":{"type":"LineString","coordinates":[[1100000,600000],[1100100,600000]]}}]})");
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readLineLayer(road, ""); }),
    { road, "counts to the south and west", "EPSG:5513" }));
  // About a pole both axes have one direction, which is a map as any.
  EXPECT_FALSE(wktOfCrs("EPSG:3413").empty());
  EXPECT_FALSE(wktOfCrs("EPSG:32661").empty());
}

} // namespace

} // namespace rockfall
