/// @file
/// What a raster's numbers become where nothing has to be resampled, and the notes about it.

#include "base/errors.h"
#include "gis/raster/raster.h"
#include "gisFiles.h"

#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string joined(const RasterSurface& surface)
{
  std::string text;
  for (const std::string& note : surface.notes)
  {
    text += note + "\n";
  }
  return text;
}

TEST(Raster, nodesArePixelCentresNorthFirst)
{
  const RasterSurface surface = readRaster(smallRaster().write());
  EXPECT_EQ(surface.geometry.columns, 3);
  EXPECT_EQ(surface.geometry.rows, 2);
  EXPECT_EQ(surface.geometry.cellSize, 10.0);
  EXPECT_EQ(surface.geometry.xOrigin, 600005.0);
  EXPECT_EQ(surface.geometry.yOrigin, 5100005.0);
  EXPECT_EQ(surface.heights, smallRaster().values);
  EXPECT_TRUE(surface.notes.empty()) << joined(surface);
  EXPECT_TRUE(holds(surface.geometry.crs, { "PROJCRS[", "zone 32N", "32632" }));
}

TEST(Raster, twoByTwoNodesAreOneCell)
{
  RawRaster raster = smallRaster();
  raster.columns = 2;
  raster.values = { 1.0, 2.0, 3.0, 4.0 };
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_EQ(surface.geometry.cellCount(), 1);
  EXPECT_EQ(surface.heights, raster.values);
}

TEST(Raster, asciiGridWithoutCrsIsLocal)
{
  const std::string path = writeAscii({ "1.5 2.25 -9999", "4 5 6" }, 3);
  const RasterSurface surface = readRaster(path);
  EXPECT_EQ(surface.heights[0], 1.5);
  EXPECT_EQ(surface.heights[1], 2.25);
  EXPECT_TRUE(std::isnan(surface.heights[2]));
  EXPECT_EQ(surface.heights[5], 6.0);
  EXPECT_EQ(surface.geometry.crs, "");
  EXPECT_TRUE(holds(joined(surface), { "no CRS", "1 of 6 nodes have no data" }));
}

TEST(Raster, smallLocalSlopeIsNoLongitude)
{
  // 50 m from the origin: fits the globe, but its cells and slopes are those of metres.
  const RasterSurface surface =
    readRaster(writeAscii({ "50 40 30", "50 40 30" }, 3, "xllcorner 0\nyllcorner 0\n"));
  EXPECT_EQ(surface.geometry.cellSize, 10.0);
}

TEST(Raster, doublesAreNotRounded)
{
  RawRaster raster = smallRaster();
  raster.values[4] = 1234.0 + 0x1p-40;
  EXPECT_EQ(readRaster(raster.write()).heights[4], 1234.0 + 0x1p-40);
}

TEST(Raster, southUpIsTurnedOver)
{
  RawRaster raster = smallRaster();
  raster.affine = { 600000.0, 10.0, 0.0, 5100000.0, 0.0, 10.0 };
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_EQ(surface.heights, (std::vector<double>{ 4.0, 5.0, 6.0, 1.0, 2.0, 3.0 }));
  EXPECT_EQ(surface.geometry.yOrigin, 5100005.0);
  EXPECT_TRUE(holds(joined(surface), { "2 rows", "south to north" }));
}

TEST(Raster, pictureWithoutPlaceKeepsItsOrder)
{
  RawRaster raster = smallRaster();
  raster.georeferenced = false;
  raster.crs = "";
  raster.type = "Byte";
  raster.band = "<ColorInterp>Red</ColorInterp>";
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_EQ(surface.heights, smallRaster().values);
  EXPECT_EQ(surface.geometry.cellSize, 1.0);
  EXPECT_TRUE(holds(joined(surface), { "no georeferencing", "picture's colour (Red)" }));
}

TEST(Raster, bytesMayBeAHillshade)
{
  RawRaster raster = smallRaster();
  raster.type = "Byte";
  EXPECT_TRUE(holds(joined(readRaster(raster.write())), { "whole numbers up to 255" }));
  raster.band = "<Offset>1000</Offset><Scale>0.5</Scale>"; // somebody packed heights
  EXPECT_FALSE(holds(joined(readRaster(raster.write())), { "whole numbers up to 255" }));
}

TEST(Raster, whatIsNotTheHeightsOfASlopeIsTold)
{
  RawRaster raster = smallRaster();
  raster.dataset = "<VRTRasterBand dataType=\"Byte\" band=\"2\"/>";
  raster.band = "<Description>elevation</Description>";
  EXPECT_TRUE(holds(joined(readRaster(raster.write())),
    { "Of 2 bands the first one, \"elevation\", was taken", "Band takes another" }));

  raster = smallRaster();
  raster.values.assign(6, 500.0);
  EXPECT_TRUE(holds(joined(readRaster(raster.write())), { "All heights are 500 m" }));

  // Patches of three classes; the same as decimetres.
  raster = smallRaster();
  raster.columns = raster.rows = 9;
  raster.type = "Float32";
  raster.fill([](double x, double) { return x < 600030.0 ? 1.0 : x < 600060.0 ? 7.0 : 3.0; });
  EXPECT_TRUE(
    holds(joined(readRaster(raster.write())), { "whole numbers from 1 to 7", "map of classes" }));
  raster.band = "<Scale>0.1</Scale>";
  EXPECT_FALSE(holds(joined(readRaster(raster.write())), { "map of classes" }));

  // Heights have a CRS, places none.
  raster = smallRaster();
  raster.crs = "EPSG:5703";
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_TRUE(holds(joined(surface), { "has no CRS" }));
  EXPECT_EQ(surface.geometry.crs, "");
}

TEST(Raster, scaleAndOffsetAreApplied)
{
  RawRaster raster = smallRaster();
  raster.type = "Int16";
  raster.values[0] = -32768;
  raster.band = "<NoDataValue>-32768</NoDataValue><Offset>1000</Offset><Scale>0.5</Scale>";
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_TRUE(std::isnan(surface.heights[0])); // nodata is met before the scale
  EXPECT_EQ(surface.heights[1], 1001.0);
  EXPECT_EQ(surface.heights[5], 1003.0);
  EXPECT_TRUE(holds(joined(surface), { "scale 0.5", "offset 1000" }));
}

TEST(Raster, feetBecomeMetres)
{
  struct Case
  {
    const char* unit;
    double metres;
  };
  for (const Case& feet : { Case{ "ft", 0.3048 }, Case{ "Foot", 0.3048 },
         Case{ "US survey foot", 1200.0 / 3937.0 }, Case{ "m", 1.0 }, Case{ "metre", 1.0 } })
  {
    RawRaster raster = smallRaster();
    raster.band = std::string("<UnitType>") + feet.unit + "</UnitType>";
    const RasterSurface surface = readRaster(raster.write());
    EXPECT_DOUBLE_EQ(surface.heights[5], 6.0 * feet.metres) << feet.unit;
    EXPECT_EQ(surface.notes.size(), feet.metres == 1.0 ? 0u : 1u) << joined(surface);
  }
  RawRaster raster = smallRaster();
  raster.band = "<UnitType>fathom</UnitType>";
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(raster.write()); }),
    { "band 1", "\"fathom\"", "not known", "gdal_edit.py -units" }));
}

TEST(Raster, transparencyOfRealNumbersIsAMask)
{
  RawRaster raster = smallRaster();
  std::string bytes;
  for (const double alpha : { 255.0, 255.0, 0.0, 255.0, 255.0, 255.0 })
  {
    bytes.append(reinterpret_cast<const char*>(&alpha), sizeof(alpha));
  }
  raster.dataset = "<VRTRasterBand dataType=\"Float64\" band=\"2\" subClass=\"VRTRawRasterBand\">"
                   "<ColorInterp>Alpha</ColorInterp><SourceFilename relativeToVRT=\"1\">" +
    nameOf(writeFile("alpha.raw", bytes)) +
    "</SourceFilename><PixelOffset>8</PixelOffset><LineOffset>24</LineOffset><ByteOrder>LSB"
    "</ByteOrder></VRTRasterBand>";
  const RasterSurface surface = readRaster(raster.write());
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(std::isnan(surface.heights[i]), i == 2) << i;
  }
}

TEST(Raster, zerosBesideHighGroundAreNoted)
{
  RawRaster raster = smallRaster();
  raster.values = { 0.0, 35.0, 0.0, 3.0, 700.0, 0.0 };
  EXPECT_TRUE(holds(joined(readRaster(raster.write())),
    { "3 nodes of band 1 are exactly 0 m, 1 of them", "-a_nodata 0" }));
  raster.values[4] = 39.0; // a shore
  EXPECT_EQ(joined(readRaster(raster.write())).find("exactly 0"), std::string::npos);
  raster.values[4] = 75.0; // a pit with walls of 82 degrees
  EXPECT_TRUE(holds(joined(readRaster(raster.write())), { "beside ground more than 40 m off" }));
}

TEST(Raster, nodesThatStandAloneAreNoted)
{
  RawRaster raster = smallRaster();
  raster.columns = raster.rows = 9;
  const auto told = [&](double bird, double well)
  {
    raster.fill([](double x, double) { return 500.0 + 0.8 * (x - 600000.0); }); // 39°
    raster.values[4 * 9 + 4] += bird;
    raster.values[0] -= well; // in a corner
    return joined(readRaster(raster.write()));
  };
  EXPECT_EQ(told(30.0, 30.0).find("stand alone"), std::string::npos);
  const std::string both = told(60.0, 70.0);
  EXPECT_TRUE(holds(both,
    { "2 nodes of band 1 stand alone, more than 40 m above or below all around, "
      "first 70 m below in row 1, column 1" }))
    << both;
  EXPECT_TRUE(holds(told(60.0, 0.0), { "1 nodes", "first 52 m above in row 5, column 5" }));
  // A hole of nodata has ground around, and no height.
  raster.band = "<NoDataValue>nan</NoDataValue>";
  EXPECT_EQ(
    told(std::numeric_limits<double>::quiet_NaN(), 0.0).find("stand alone"), std::string::npos);
}

TEST(Raster, HeightsOfNoMountainAreNoted)
{
  RawRaster raster = smallRaster();
  raster.columns = raster.rows = 20;
  const auto notes = [&](double first, double rise)
  {
    raster.fill([&](double x, double) { return first + rise * (x - 600000.0); });
    return joined(readRaster(raster.write()));
  };
  EXPECT_EQ(notes(400.0, 0.6).find("?"), std::string::npos);
  EXPECT_TRUE(holds(notes(0.4, 0.0006), { "All heights are within", "are they in metres?" }));
  EXPECT_TRUE(holds(notes(-400.0, 0.6), { "All heights are at 0 m or below", "depths" }));
  EXPECT_TRUE(holds(notes(400.0, 3.0), { "steeper than 60 degrees" }));
  // Surveyed coarsely: as read, made finer, as degrees; averaged on purpose; as fine as offices have it.
  raster.affine[1] = 90.0;
  raster.affine[5] = -90.0;
  const std::string coarse = "Its heights are some 90 m apart";
  EXPECT_TRUE(holds(notes(400.0, 0.6), { coarse, "not on the slope" }));
  EXPECT_TRUE(holds(joined(readRaster(raster.write(), { .cellSize = 10.0 })), { " m apart" }));
  raster.affine[1] = 25.0;
  raster.affine[5] = -25.0;
  EXPECT_EQ(notes(400.0, 0.6).find("apart"), std::string::npos);
  raster.crs = "EPSG:4326";
  raster.affine = { 9.0, 0.0008, 0.0, 46.0, 0.0, -0.0008 };
  raster.fill([](double x, double) { return 400.0 + 40000.0 * (x - 9.0); });
  EXPECT_TRUE(holds(joined(readRaster(raster.write(), { .cellSize = 10.0 })), { "m apart" }));
}

TEST(Raster, APlaceBeyondAllNumbersIsRefused)
{
  EXPECT_TRUE(holds(
    messageOf<DataError>(
      [] {
        readRaster(writeAscii({ "1 2", "3 4" }, 2, "xllcorner 600000\nyllcorner 5100000\n", "-10"));
      }),
    { "cellsize -10", "above 0" }));
  EXPECT_TRUE(
    holds(messageOf<DataError>(
            [] {
              readRaster(writeAscii({ "1 2", "3 4" }, 2, "xllcorner 1e300\nyllcorner 0\n"));
            }),
      { "1e+300", "cannot be told apart" }));
}

TEST(Raster, terracesOfWholeMetresAreNoted)
{
  RawRaster raster = smallRaster();
  raster.columns = raster.rows = 30;
  const auto notes = [&](double rise, double unit)
  {
    raster.fill([&](double x, double) { return std::round(rise * (x - 600000.0) / unit) * unit; });
    return joined(readRaster(raster.write()));
  };
  EXPECT_TRUE(holds(notes(0.05, 1.0), { "whole numbers", "48 % of the cells are level" }));
  EXPECT_EQ(notes(0.05, 0.1).find("whole numbers"), std::string::npos); // decimals
  EXPECT_EQ(notes(0.5, 1.0).find("whole numbers"), std::string::npos); // steeper than a step a cell
  EXPECT_EQ(notes(0.01, 1.0).find("whole numbers"), std::string::npos); // a plain
}

TEST(Raster, verticalCrsInFeet)
{
  RawRaster raster = smallRaster();
  raster.crs = "EPSG:32632+6360"; // NAVD88 height (ftUS)
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_NEAR(surface.heights[5], 6.0 * 1200.0 / 3937.0, 1e-11); // PROJ rounds its unit
  EXPECT_TRUE(holds(joined(surface), { "0.3048006096", "vertical CRS" }));
  // What the heights refer to is kept, their unit is not.
  EXPECT_TRUE(holds(surface.geometry.crs, { "North American Vertical Datum 1988" }));
  EXPECT_EQ(surface.geometry.crs.find("foot"), std::string::npos) << surface.geometry.crs;
}

TEST(Raster, nodataAsNan)
{
  RawRaster raster = smallRaster();
  raster.values[1] = nan;
  raster.band = "<NoDataValue>nan</NoDataValue>";
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_TRUE(std::isnan(surface.heights[1]));
  EXPECT_EQ(surface.heights[2], 3.0);
}

TEST(Raster, nodataOfSinglePrecisionWrittenAsDecimal)
{
  for (const char* text : { "-9999.9", "-3.4028235e+38", "-3.4028234663852886e+38", "1e-30" })
  {
    RawRaster raster = smallRaster();
    raster.type = "Float32";
    raster.values[1] = double(float(std::stof(text)));
    raster.band = std::string("<NoDataValue>") + text + "</NoDataValue>";
    const RasterSurface surface = readRaster(raster.write());
    EXPECT_TRUE(std::isnan(surface.heights[1])) << text;
    EXPECT_EQ(surface.heights[2], 3.0);
  }
}

TEST(Raster, maskBandIsNodata)
{
  RawRaster mask = smallRaster();
  mask.type = "Byte";
  mask.values = { 255, 255, 0, 255, 255, 255 };
  mask.write("mask");
  const std::string maskFile = pathOf("mask.raw");
  RawRaster raster = smallRaster();
  raster.values[0] = -9999.0; // beside the mask, a nodata value of its own
  raster.band = "<NoDataValue>-9999</NoDataValue>";
  raster.dataset = "<MaskBand><VRTRasterBand dataType=\"Byte\" subClass=\"VRTRawRasterBand\">"
                   "<SourceFilename relativetoVRT=\"1\">" +
    maskFile.substr(maskFile.find_last_of('/') + 1) +
    "</SourceFilename><PixelOffset>1</PixelOffset><LineOffset>3</LineOffset></VRTRasterBand>"
    "</MaskBand>";
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_TRUE(std::isnan(surface.heights[0]));
  EXPECT_TRUE(std::isnan(surface.heights[2]));
  EXPECT_EQ(surface.heights[1], 2.0);
  EXPECT_EQ(surface.heights[5], 6.0);
}

TEST(Raster, localUnitsAreMultiplied)
{
  RawRaster raster = smallRaster();
  raster.crs = "LOCAL_CS[\"mine\",UNIT[\"foot\",0.3048]]";
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_DOUBLE_EQ(surface.geometry.cellSize, 3.048);
  EXPECT_EQ(surface.geometry.crs, "");
  EXPECT_TRUE(holds(joined(surface), { "foot", "0.3048" }));
}

TEST(Raster, manyRowsAreReadInBlocks)
{
  // More nodes than one block of rows holds.
  RawRaster raster;
  raster.columns = 3000;
  raster.rows = 3001;
  raster.affine = { 0.0, 1.0, 0.0, 3001.0, 0.0, -1.0 };
  raster.crs = "EPSG:32632";
  raster.type = "Float32";
  raster.fill([](double x, double y) { return 2.0 * std::floor(x) + 3.0 * std::floor(y); });
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_EQ(surface.heights, raster.values);
}

TEST(Raster, decimalCommaOfTheLocaleChangesNothing)
{
  const std::string path = smallRaster().write();
  const std::string ascii =
    writeAscii({ "1.5 2.25 3", "4 5 6" }, 3, "xllcorner 600000.5\nyllcorner 5100000.5\n", "2.5");
  const CommaLocale comma;
  const RasterSurface surface = readRaster(path);
  EXPECT_EQ(surface.geometry.xOrigin, 600005.0);
  EXPECT_EQ(surface.heights, smallRaster().values);
  const RasterSurface text = readRaster(ascii);
  EXPECT_EQ(text.heights, (std::vector<double>{ 1.5, 2.25, 3.0, 4.0, 5.0, 6.0 }));
  EXPECT_EQ(text.geometry.cellSize, 2.5);
  EXPECT_EQ(text.geometry.xOrigin, 600001.75);
  const RasterSurface finer = readRaster(path, { .cellSize = 2.5 });
  EXPECT_TRUE(holds(joined(finer), { "2.5 m was asked for" }));
}

TEST(Raster, decimalCommasInAnAsciiGrid)
{
  const RasterSurface surface = readRaster(writeAscii({ "1,5 2,25", "4,0 5,125" }, 2));
  EXPECT_EQ(surface.heights, (std::vector<double>{ 1.5, 2.25, 4.0, 5.125 }));
}

} // namespace

TEST(Raster, AnUndefinedCrsIsNone)
{
  RawRaster raster = smallRaster();
  for (const char* crs :
    { "GEOGCS[\"Undefined geographic SRS\",DATUM[\"unknown\",SPHEROID[\"unknown\","
      "6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\","
      "0.0174532925199433]]",
      "LOCAL_CS[\"Undefined Cartesian SRS\",UNIT[\"Meter\",1]]" })
  {
    raster.crs = crs;
    const RasterSurface surface = readRaster(raster.write());
    EXPECT_TRUE(surface.geometry.crs.empty());
    EXPECT_EQ(surface.geometry.xOrigin, 600005.0);
    EXPECT_TRUE(holds(joined(surface.notes), { "The file has no CRS" }));
  }
}

} // namespace rockfall
