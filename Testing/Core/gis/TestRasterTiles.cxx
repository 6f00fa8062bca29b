// Tiles as a VRT: two rasters beside each other, with an overlap, a hole, or one of them gone.
#include "base/errors.h"
#include "gis/raster/raster.h"
#include "gisFiles.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

double height(double x, double y)
{
  return 1000.0 + 0.5 * (x - 600000.0) - 0.25 * (y - 5100000.0);
}

/// 10 × 8 nodes of 10 m whose first column stands at `column` of the whole.
std::string tile(
  const std::string& name, int column, double nodata = -9999.0, const std::string& unit = "")
{
  RawRaster raster;
  raster.columns = 10;
  raster.rows = 8;
  raster.affine = { 600000.0 + 10.0 * column, 10.0, 0.0, 5100080.0, 0.0, -10.0 };
  raster.crs = "EPSG:32632";
  raster.type = "Float32";
  raster.band = "<NoDataValue>" + exactText(nodata) + "</NoDataValue>" +
    (unit.empty() ? "" : "<UnitType>" + unit + "</UnitType>");
  raster.fill([&](double x, double y)
    { return x > 600095.0 && x < 600110.0 && y > 5100070.0 ? nodata : height(x, y); });
  return raster.write(name);
}

std::string source(const std::string& file, int column)
{
  return "<ComplexSource><SourceFilename relativeToVRT=\"0\">" + file +
    "</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"10\" "
    "ySize=\"8\"/><DstRect xOff=\"" +
    std::to_string(column) +
    "\" yOff=\"0\" xSize=\"10\" ySize=\"8\"/><NODATA>-9999</NODATA></ComplexSource>";
}

/// As gdalbuildvrt writes it.
std::string mosaic(int columns, const std::string& sources, const std::string& unit = "")
{
  return writeFile("mosaic.vrt",
    "<VRTDataset rasterXSize=\"" + std::to_string(columns) +
      "\" rasterYSize=\"8\"><SRS dataAxisToSRSAxisMapping=\"1,2\">EPSG:32632</SRS><GeoTransform>"
      "600000, 10, 0, 5100080, 0, -10</GeoTransform><VRTRasterBand dataType=\"Float32\" "
      "band=\"1\"><NoDataValue>-9999</NoDataValue>" +
      (unit.empty() ? "" : "<UnitType>" + unit + "</UnitType>") + sources +
      "</VRTRasterBand></VRTDataset>");
}

/// All nodes are the closed form but those of the tiles' nodata and of the columns in between.
void expectHeights(const RasterSurface& s, int gap0, int gap1)
{
  const GridGeometry& g = s.geometry;
  for (int row = 0; row < g.rows; ++row)
  {
    for (int column = 0; column < g.columns; ++column)
    {
      const double x = g.xOrigin + column * g.cellSize;
      const double y = g.yOrigin + (g.rows - 1 - row) * g.cellSize;
      const double z = s.heights[std::size_t(row) * g.columns + column];
      const bool hole = x > 600095.0 && x < 600110.0 && y > 5100070.0;
      if (hole || (column >= gap0 && column < gap1))
      {
        EXPECT_TRUE(std::isnan(z)) << row << " " << column;
      }
      else
      {
        EXPECT_NEAR(z, height(x, y), 1e-4) << row << " " << column; // single precision
      }
    }
  }
}

} // namespace

TEST(RasterTiles, SideBySide)
{
  const RasterSurface s =
    readRaster(mosaic(20, source(tile("west", 0), 0) + source(tile("east", 10), 10)));
  ASSERT_EQ(s.geometry.columns, 20);
  ASSERT_EQ(s.geometry.rows, 8);
  EXPECT_EQ(s.geometry.xOrigin, 600005.0);
  expectHeights(s, 0, 0);
}

TEST(RasterTiles, OverlappingAndWithAGap)
{
  expectHeights(
    readRaster(mosaic(17, source(tile("west", 0), 0) + source(tile("east", 7), 7))), 0, 0);
  expectHeights(
    readRaster(mosaic(23, source(tile("west", 0), 0) + source(tile("east", 13), 13))), 10, 13);
}

TEST(RasterTiles, AtAnotherCellSize)
{
  const RasterSurface s = readRaster(
    mosaic(20, source(tile("west", 0), 0) + source(tile("east", 10), 10)), { .cellSize = 5.0 });
  EXPECT_EQ(s.geometry.columns, 39);
  // Across the seam as anywhere: bilinear of a plane is the plane.
  for (int column = 0; column < 39; ++column)
  {
    const double z = s.heights[std::size_t(14) * 39 + column];
    EXPECT_NEAR(z, height(600005.0 + 5.0 * column, 5100005.0), 1e-4);
  }
}

TEST(RasterTiles, UnitsThatTheMosaicHasLost)
{
  const auto joined =
    [](const std::string& westUnit, const std::string& eastUnit, const std::string& unit = "")
  {
    return mosaic(20,
      source(tile("west", 0, -9999.0, westUnit), 0) +
        source(tile("east", 10, -9999.0, eastUnit), 10),
      unit);
  };
  const std::string west = pathOf("west.vrt"), east = pathOf("east.vrt");
  const auto refusal = [](const std::string& file)
  { return messageOf<DataError>([&] { readRaster(file); }); };
  const std::string file = joined("ft", "ft");
  EXPECT_EQ(refusal(file),
    file + ": the heights of band 1 have no unit and would be in metres, but its source " + west +
      " has the unit \"ft\"; gdal_edit.py -units ft " + file + " says it");
  EXPECT_TRUE(holds(refusal(joined("m", "ft")),
    { "of its sources " + east + " has the unit \"ft\" and " + west + " has the unit \"m\"" }));
  EXPECT_TRUE(holds(refusal(joined("ft", "")),
    { "of its sources " + west + " has the unit \"ft\" and " + east + " has no unit" }));
  expectHeights(readRaster(joined("m", "")), 0, 0);
  // The mosaic's own unit counts.
  EXPECT_NEAR(
    readRaster(joined("ft", "ft", "ft")).heights[0], foot * height(600005.0, 5100075.0), 1e-4);
  expectHeights(readRaster(joined("ft", "ft", "m")), 0, 0);
}

TEST(RasterTiles, AMosaicOfMosaics)
{
  // As west and east, and one within another; a source whose numbers are changed is in no unit.
  const std::string feet = tile("west", 0, -9999.0, "ft");
  std::string inner = mosaic(10, source(feet, 0));
  std::filesystem::rename(inner, pathOf("inner.vrt"));
  const std::string file = mosaic(10, source(pathOf("inner.vrt"), 0));
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(file); }),
    { file, "its source " + feet + " has the unit \"ft\"" }));
  std::string changed = source(feet, 0);
  changed.insert(changed.find("<NODATA>"),
    "<ScaleOffset>0</ScaleOffset><ScaleRatio>0.3048"
    "</ScaleRatio>");
  EXPECT_NEAR(readRaster(mosaic(10, changed)).heights[0], foot * height(600005.0, 5100075.0), 1e-4);
}

TEST(RasterTiles, MoreOfThemThanAreAskedForAUnit)
{
  const std::string west = source(tile("west", 0), 0);
  std::string sources;
  for (int k = 0; k < 501; ++k)
  {
    sources += west;
  }
  const RasterSurface s = readRaster(mosaic(10, sources));
  EXPECT_TRUE(std::any_of(s.notes.begin(), s.notes.end(),
    [](const std::string& note) {
      return holds(note, { "taken to be in metres", "250 of the raster's sources" });
    }));
}

TEST(RasterTiles, ATileThatIsGone)
{
  const std::string east = tile("east", 10);
  const std::string file = mosaic(20, source(tile("west", 0), 0) + source(east, 10));
  std::remove(east.c_str());
  EXPECT_TRUE(holds(messageOf<FileError>([&] { readRaster(file); }), { file, "east.vrt" }));
}
