/// @file
/// What stands for no data, however a file writes it, and what looks as if it did; grids of text
/// with words in them, and axes that are no grid's.

#include "base/errors.h"
#include "gis/raster/contours.h"
#include "gis/raster/raster.h"
#include "gisFiles.h"
#include "netCdf.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

/// Heights 401 … 412 m in 4 × 3 cells of 10 m.
RawRaster twelve()
{
  RawRaster raster;
  raster.columns = 4;
  raster.rows = 3;
  raster.affine = { 600000.0, 10.0, 0.0, 5100030.0, 0.0, -10.0 };
  raster.crs = "EPSG:32632";
  for (int i = 0; i < 12; ++i)
  {
    raster.values.push_back(401.0 + i);
  }
  return raster;
}

std::int64_t holesOf(const RasterSurface& surface)
{
  return std::count_if(
    surface.heights.begin(), surface.heights.end(), [](double z) { return std::isnan(z); });
}

TEST(Nodata, ofDoublePrecisionWrittenInFewDigits)
{
  for (const auto& [value, text] :
    { std::pair<double, const char*>{ double(-FLT_MAX), "-3.40282346638529e+38" },
      { double(-FLT_MAX), "-3.4e+38" }, { -DBL_MAX, "-1.79769313486231e+308" },
      { -DBL_MAX, "-1.79769313486232e+308" }, { 1.70141000918783e38, "1.70141e+38" },
      { -99999.123456789012, "-99999.12346" }, { 1e20, "1e+20" } })
  {
    RawRaster raster = twelve();
    raster.values[5] = raster.values[6] = value;
    raster.band = std::string("<NoDataValue>") + text + "</NoDataValue>";
    if (std::string(text) == "-3.4e+38") // not that value any more
    {
      EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(raster.write()); }), { "row 2" }));
      continue;
    }
    EXPECT_EQ(holesOf(readRaster(raster.write())), 2) << text;
  }
}

TEST(Nodata, thatTheMessageAdvisesIsTaken)
{
  for (const double value : { -DBL_MAX, double(-FLT_MAX), -99999.123456789012, -32768.0, 1e30 })
  {
    RawRaster raster = twelve();
    raster.values[5] = value;
    const std::string message = messageOf<DataError>([&] { readRaster(raster.write()); });
    const std::string option = "-a_nodata ";
    const std::size_t at = message.find(option);
    ASSERT_NE(at, std::string::npos) << message;
    const std::string advised = message.substr(at + option.size());
    raster.band = "<NoDataValue>" + advised.substr(0, advised.find(' ')) + "</NoDataValue>";
    EXPECT_EQ(holesOf(readRaster(raster.write())), 1) << message;
  }
}

TEST(Nodata, ofNetCdfAreAllThatItDeclares)
{
  const std::vector<double> values = { 401, 402, -999, 404, 405, 406, -888, 408, 409, 410, 411,
    412 };
  const auto holes = [&](const std::vector<NetCdfAttribute>& attributes, bool isSingle = false)
  {
    NetCdf file = gridOfHeights(values, 4, attributes);
    file.variables[2].isSingle = isSingle;
    return holesOf(readRaster(file.write()));
  };
  using Doubles = std::vector<double>;
  EXPECT_EQ(holes({ { "missing_value", Doubles{ -999.0, -888.0 } } }), 2);
  EXPECT_EQ(
    holes({ { "_FillValue", Doubles{ -999.0 } }, { "missing_value", Doubles{ -888.0 } } }), 2);
  EXPECT_EQ(holes({ { "missing_value", std::vector<float>{ -999.f, -888.f } } }, true), 2);
  EXPECT_EQ(holes({ { "valid_range", Doubles{ 0.0, 9000.0 } } }), 2);
  EXPECT_EQ(holes({ { "valid_min", Doubles{ -900.0 } } }), 1);
  EXPECT_EQ(holes({ { "valid_max", Doubles{ 411.5 } }, { "_FillValue", Doubles{ -999.0 } } }), 2);
}

std::string sagaWithNodata(const std::string& nodata)
{
  std::string bytes;
  for (const float value : { 401.f, 402.f, -99999.f, 404.f, 405.f, -99990.f })
  {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  writeFile("grid.sgrd",
    "NAME\t= grid\nDATAFORMAT\t= FLOAT\nDATAFILE_OFFSET\t= 0\nBYTEORDER_BIG\t= FALSE\nPOSITION_XMIN"
    "\t= 600005.0\nPOSITION_YMIN\t= 5100005.0\nCELLCOUNT_X\t= 3\nCELLCOUNT_Y\t= 2\nCELLSIZE\t= 10.0"
    "\nZ_FACTOR\t= 1.000000\nNODATA_VALUE\t= " +
      nodata + "\nTOPTOBOTTOM\t= FALSE\n");
  return writeFile("grid.sdat", bytes);
}

TEST(Nodata, ofSagaIsARange)
{
  EXPECT_EQ(holesOf(readRaster(sagaWithNodata("-99999.000000;-99990.000000"))), 2);
  EXPECT_TRUE(holds(messageOf<DataError>([] { readRaster(sagaWithNodata("-99999.000000")); }),
    { "-99990", "-a_nodata" }));
}

TEST(Nodata, ofAllBandsTogether)
{
  RawRaster raster = twelve();
  raster.values[3] = 0.0;
  const std::string second = twelve().write("second");
  raster.dataset = "<Metadata><MDI key=\"NODATA_VALUES\">0</MDI></Metadata>";
  EXPECT_EQ(holesOf(readRaster(raster.write())), 1);
}

std::string grass(const std::string& lines, const std::string& cells)
{
  return writeFile("grass.txt",
    "north: 5100020\nsouth: 5100000\neast: 600030\nwest: 600000\nrows: 2\ncols: 3\n" + lines +
      cells);
}

TEST(Nodata, ofGrassIsAWord)
{
  for (const char* null : { "*", "NULL", "-9999", "none" })
  {
    const std::string line = std::string(null) == "*" ? "" : "null: " + std::string(null) + "\n";
    const RasterSurface surface =
      readRaster(grass(line, "10 " + std::string(null) + " 30\n0 50 " + null + "\n"));
    EXPECT_EQ(holesOf(surface), 2) << null;
    EXPECT_TRUE(std::isnan(surface.heights[1])) << null;
    EXPECT_EQ(surface.heights[3], 0.0) << null; // a height, whatever GDAL makes of the word
  }
  EXPECT_TRUE(holds(messageOf<DataError>([] { readRaster(grass("", "10 20 high\n40 50 60\n")); }),
    { "\"high\" in row 1, column 3" }));
  EXPECT_TRUE(
    holds(messageOf<DataError>([] { readRaster(grass("null: -1\n", "10 NA 3\n4 5 6\n")); }),
      { "\"NA\"" }));
  EXPECT_TRUE(holds(messageOf<FileError>([] { readRaster(grass("", "10 20 30\n40 50\n")); }),
    { "it has 5 numbers" }));
}

TEST(Nodata, ofEsriIsAWord)
{
  for (const char* null : { "null", "NA", "NODATA", "*" })
  {
    const RasterSurface surface =
      readRaster(writeAscii({ "10 " + std::string(null) + " 30", "0 50 60" }, 3,
        "xllcorner 600000\nyllcorner 5100000\n", "10", "NODATA_value " + std::string(null) + "\n"));
    EXPECT_EQ(holesOf(surface), 1) << null;
    EXPECT_TRUE(std::isnan(surface.heights[1])) << null;
    EXPECT_EQ(surface.heights[3], 0.0) << null;
  }
  EXPECT_TRUE(holds(messageOf<DataError>(
                      [] {
                        readRaster(writeAscii({ "1 null 3", "4 5 6" }, 3));
                      }),
    { "\"null\"" }));
}

TEST(TextGrids, whatIsNoHeightIsNotZeroAmongWholeNumbers)
{
  // GDAL takes such grids for integers, and reads these words as 0.
  for (const char* word : { "nan", "NaN", "-nan", "inf", "-Inf", "1.#QNAN", "0x10" })
  {
    const std::string esri = writeAscii({ "10 " + std::string(word) + " 30", "40 50 60" }, 3);
    EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(esri); }), { "row 1, column 2" }))
      << word;
    const std::string other = grass("", "10 " + std::string(word) + " 30\n40 50 60\n");
    EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(other); }), { "row 1, column 2" }))
      << word;
  }
  const RasterSurface declared = readRaster(writeAscii({ "10 nan 30", "0 50 60" }, 3,
    "xllcorner 600000\nyllcorner 5100000\n", "10", "NODATA_value nan\n"));
  EXPECT_EQ(holesOf(declared), 1);
  EXPECT_TRUE(std::isnan(declared.heights[1]));
}

TEST(TextGrids, wordsAreErrors)
{
  // GDAL looks at the first thousand bytes itself.
  std::string good;
  for (int y = 299; y > 0; --y)
  {
    good += "0 " + std::to_string(y) + "0 1\n10 " + std::to_string(y) + "0 2\n";
  }
  const auto xyz = [&](const std::string& line)
  {
    const std::string path = writeFile("grid.xyz", good + "0 0 1\n" + line + "\n");
    return messageOf<DataError>([&] { readRaster(path); });
  };
  EXPECT_TRUE(holds(xyz("10 0 high"), { "line 600", "\"high\"" }));
  EXPECT_TRUE(holds(xyz("10 0 n/a"), { "line 600", "\"n/a\"" }));
  EXPECT_TRUE(holds(xyz("10 0 -"), { "line 600", "\"-\"" }));
  const std::string gxf = writeFile("grid.gxf",
    "#POINTS\n3\n#ROWS\n2\n#PTSEPARATION\n10\n#RWSEPARATION\n10\n#GRID\n1 high "
    "3\n4 5 6\n");
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readRaster(gxf); }), { "\"high\" in row 1, column 2" }));
  const std::string isg = writeFile("geoid.isg",
    "begin_of_head =====\nmodel name : x\nunits : meters\nlat min = 41.0\nlat max = 41.2\nlon min "
    "= "
    "1.0\nlon max = 1.2\ndelta lat = 0.1\ndelta lon = 0.1\nnrows = 2\nncols = 2\nnodata = "
    "-9999\nISG "
    "format = 1.0\nend_of_head =====\n1 high\n3 4\n");
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readRaster(isg); }), { "\"high\" in row 1, column 2" }));
}

TEST(TextGrids, pointsAreReadInAnyOrderOfColumnsAndSeparators)
{
  for (const char* text : { "0 10 1\n10 10 2\n0 0 3\n10 0 4\n", "0,10,1\n10,10,2\n0,0,3\n10,0,4\n",
         "0, 10, 1\n10, 10, 2\n0, 0, 3\n10, 0, 4\n",
         "x y z name\n0 10 1 a\n10 10 2 b\n0 0 3 c\n10 0 4 d\n",
         "0\t10\t1\n10\t10\t2\n0\t0\t3\n10\t0\t4\n" })
  {
    const RasterSurface surface = readRaster(writeFile("grid.xyz", text));
    EXPECT_EQ(surface.heights, (std::vector<double>{ 1.0, 2.0, 3.0, 4.0 })) << text;
  }
}

TEST(TextGrids, nodesWithoutAPointAreNodata)
{
  for (const char* text :
    { "1 2 451.5\n2 2 452.5\n3 2 453\n1 1 454.5\n3 1 0\n", "1 2 1\n2 2 2\n3 2 3\n1 1 4\n3 1 0\n",
      "1;2;1\n2;2;2\n3;2;3\n1;1;4\n3;1;0\n", "y,x,z\n2,1,1\n2,2,2\n2,3,3\n1,1,4\n1,3,0\n" })
  {
    const RasterSurface surface = readRaster(writeFile("grid.xyz", text));
    EXPECT_EQ(holesOf(surface), 1) << text;
    EXPECT_TRUE(std::isnan(surface.heights[4])) << text;
    EXPECT_EQ(surface.heights[5], 0.0) << text;
  }
}

TEST(Nodata, thatNobodyDeclaredIsNoted)
{
  for (const double mark : { -999.0, -99.0, 9999.0, -500.0, 2000.0 })
  {
    RawRaster raster = twelve();
    raster.values[5] = mark;
    const std::string notes = joined(readRaster(raster.write()).notes);
    EXPECT_TRUE(holds(notes,
      { "1 nodes of band 1 are exactly", "stands for no data",
        "-a_nodata " + exactText(mark) + " says so" }));
    raster.band = "<NoDataValue>" + exactText(mark) + "</NoDataValue>";
    EXPECT_EQ(joined(readRaster(raster.write()).notes).find("stands for"), std::string::npos);
  }
  // Two marks, more of them than ground.
  RawRaster raster = twelve();
  raster.values = { -999, -999, -888, -888, -999, 450, 451, 452, -999, -999, 453, 454 };
  const auto notes = readRaster(raster.write()).notes;
  EXPECT_EQ(std::count_if(notes.begin(), notes.end(),
              [](const std::string& note) { return note.find("stands for") != note.npos; }),
    1);
  EXPECT_TRUE(holds(joined(notes),
    { "5 nodes of band 1 are exactly -999 m", "2 are exactly -888 m", "-999 says so" }));
  // Marks near sea level, with ground from 5 m to 900 m.
  raster.fill([](double x, double) { return 5.0 + (x - 600005.0) * 0.5; });
  raster.values[3] = -99.0;
  EXPECT_TRUE(holds(joined(readRaster(raster.write()).notes), { "-99 says so" }));
  // Steep ground, a cliff and a deep cut are none.
  for (const std::vector<double>& ground :
    { std::vector<double>{ 100, 140, 180, 220, 260, 300, 340, 380, 420, 460, 500, 540 },
      { 100, 101, 102, 150, 151, 152, 153, 154, 155, 156, 157, 158 },
      { 0, 10, 20, 30, 40, 50, 100, 110, 120, 130, 140, 150 } })
  {
    raster.values = ground;
    EXPECT_EQ(joined(readRaster(raster.write()).notes).find("stands for"), std::string::npos);
  }
  // Contours too.
  const std::string lines = writeFile("lines.csv",
    "WKT,elev\n\"LINESTRING(0 0,50 0)\",450\n\"LINESTRING(0 30,50 30)\",460\n"
    "\"LINESTRING(0 60,50 60)\",-999\n");
  EXPECT_TRUE(holds(joined(readContours(lines, { .cellSize = 10.0 }).notes), { "exactly -999 m" }));
}

TEST(TextGrids, sayCornerOrCentreAlongEachAxis)
{
  const auto place = [](const std::string& x, const std::string& y)
  {
    const RasterSurface surface =
      readRaster(writeAscii({ "1.5 2.5 3", "4 5 6" }, 3, x + " 600000\n" + y + " 5100000\n"));
    return std::array{ surface.geometry.xOrigin, surface.geometry.yOrigin };
  };
  EXPECT_EQ(place("xllcorner", "yllcorner"), (std::array{ 600005.0, 5100005.0 }));
  EXPECT_EQ(place("xllcenter", "yllcenter"), (std::array{ 600000.0, 5100000.0 }));
  EXPECT_EQ(place("xllcorner", "yllcenter"), (std::array{ 600005.0, 5100000.0 }));
  EXPECT_EQ(place("XLLCENTER", "YLLCORNER"), (std::array{ 600000.0, 5100005.0 }));
  // Cells that are not square: steps of their own.
  const RasterSurface oblong = readRaster(writeFile("oblong.asc",
    "ncols 3\nnrows 2\nxllcenter 600000\nyllcorner 5100000\ndx 10\ndy 20\n1.5 2 3\n4 5 6\n"));
  EXPECT_EQ(oblong.geometry.xOrigin, 600000.0);
  EXPECT_EQ(oblong.geometry.yOrigin, 5100010.0);
  EXPECT_TRUE(holds(joined(oblong.notes), { "corner along one axis" }));
  EXPECT_TRUE(holds(messageOf<DataError>(
                      [] {
                        readRaster(writeAscii({ "1 2", "3 4" }, 2, "xllcorner 600000\n"));
                      }),
    { "grid.asc", "along x only", "yllcorner or yllcenter" }));
}

TEST(GridAxes, thatAreUnevenAreErrors)
{
  const std::vector<double> values = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 };
  NetCdf even = gridOfHeights(values, 4);
  EXPECT_EQ(readRaster(even.write()).geometry.cellSize, 10.0);
  NetCdf wide = even;
  wide.variables[0].values = { 600005, 600015, 600060, 600070 };
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(wide.write()); }),
    { "axis \"x\" is not evenly spaced", "10 to 45" }));
  NetCdf growing = even;
  growing.variables[1].values = { 5100005, 5100015, 5100026 };
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(growing.write()); }), { "axis \"y\"" }));
  NetCdf twice = even;
  twice.variables[0].values = { 600005, 600015, 600015, 600025 };
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(twice.write()); }), { "axis \"x\"" }));
  // The rounding of single precision is no unevenness.
  NetCdf rounded = even;
  rounded.variables[0].isSingle = true;
  for (std::size_t i = 0; i < 4; ++i)
  {
    rounded.variables[0].values[i] = 600000.3 + 0.7 * double(i);
    rounded.variables[1].values[std::min<std::size_t>(i, 2)] =
      5100000.0 + 0.7 * double(std::min<std::size_t>(i, 2));
  }
  EXPECT_NO_THROW(readRaster(rounded.write()));
}

TEST(GridAxes, ofCartesianGmtGridsAreTheirPlace)
{
  const std::vector<double> values = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 };
  NetCdf file = gridOfHeights(values, 4);
  file.variables.pop_back();
  file.variables[0].attributes = { { "long_name", "x" } };
  file.variables[1].attributes = { { "long_name", "y" } };
  file.variables[2].attributes = { { "long_name", "z" } };
  const auto expectPlaced = [](const NetCdf& grid)
  {
    const RasterSurface surface = readRaster(grid.write());
    EXPECT_EQ(surface.geometry.cellSize, 10.0);
    EXPECT_EQ(surface.geometry.xOrigin, 600005.0);
    EXPECT_EQ(surface.geometry.yOrigin, 5100005.0);
    // The northern row first.
    EXPECT_EQ(surface.heights, (std::vector<double>{ 9, 10, 11, 12, 5, 6, 7, 8, 1, 2, 3, 4 }));
  };
  expectPlaced(file);
  // The northern row first in the file, too.
  NetCdf down = file;
  down.variables[1].values = { 5100025, 5100015, 5100005 };
  down.variables[2].values = { 9, 10, 11, 12, 5, 6, 7, 8, 1, 2, 3, 4 };
  expectPlaced(down);
  NetCdf kilometres = file;
  for (int axis = 0; axis < 2; ++axis)
  {
    kilometres.variables[axis].attributes.push_back({ "units", "km" });
    for (double& place : kilometres.variables[axis].values)
    {
      place *= 0.001;
    }
  }
  const RasterSurface scaled = readRaster(kilometres.write());
  EXPECT_NEAR(scaled.geometry.cellSize, 10.0, 1e-6);
  NetCdf uneven = file;
  uneven.variables[0].values[3] = 600100.0;
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(uneven.write()); }), { "not evenly" }));
}

TEST(GridAxes, haveTheUnitThatTheyDeclare)
{
  // Where GDAL knows them for axes, and nothing names a CRS.
  const std::vector<double> values = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 };
  for (const auto& [unit, metres] : { std::pair<const char*, double>("km", 1000.0), { "cm", 0.01 },
         { "m", 1.0 }, { "ft", 0.3048 } })
  {
    NetCdf file = gridOfHeights(values, 4);
    const char* const names[] = { "projection_x_coordinate", "projection_y_coordinate" };
    for (int axis = 0; axis < 2; ++axis)
    {
      file.variables[axis].attributes = { { "standard_name", names[axis] }, { "units", unit } };
      for (double& place : file.variables[axis].values)
      {
        place /= metres;
      }
    }
    file.variables[2].attributes = { { "units", "m" } };
    const RasterSurface surface = readRaster(file.write());
    EXPECT_NEAR(surface.geometry.cellSize, 10.0, 1e-6) << unit;
    EXPECT_NEAR(surface.geometry.xOrigin, 600005.0, 1e-4) << unit;
    EXPECT_NEAR(surface.geometry.yOrigin, 5100005.0, 1e-4) << unit;
    EXPECT_EQ(joined(surface.notes).find("were multiplied") != std::string::npos, metres != 1.0);
    file.variables[0].attributes[1] = { "units", "km" };
    file.variables[1].attributes[1] = { "units", "m" };
    EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(file.write()); }),
      { "axis \"x\" is in km, \"y\" in m" }));
  }
}

TEST(GridAxes, thatAreTurnedAreErrorsAndFurtherOnesAreNoted)
{
  const std::vector<double> values = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 };
  NetCdf turned = gridOfHeights(values, 4);
  turned.variables[2].dimensions = { 1, 0 };
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(turned.write()); }),
    { "rows of \"z\" run along \"y\"", "gdalmdimtranslate" }));
  NetCdf deep = gridOfHeights(values, 4);
  deep.dimensions.push_back({ "time", 2 });
  deep.variables[2].dimensions = { 2, 0, 1 };
  deep.variables[2].values.insert(deep.variables[2].values.end(), values.begin(), values.end());
  EXPECT_TRUE(holds(joined(readRaster(deep.write()).notes), { "further axes (time of 2)" }));
}

} // namespace

} // namespace rockfall
