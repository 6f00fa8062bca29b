/// @file
/// Every way in which a raster can be unusable: the exception's type, and that its message names
/// the file and the value. That nothing is printed is seen by `messageOf`.

#include "base/errors.h"
#include "gis/raster/raster.h"
#include "gisFiles.h"

#include <cmath>
#include <limits>
#include <thread>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

template <class Expected>
std::string failure(const std::string& path, const RasterOptions& options = {})
{
  return messageOf<Expected>([&] { readRaster(path, options); });
}

TEST(RasterErrors, missingFile)
{
  const std::string path = pathOf("nowhere.tif");
  EXPECT_TRUE(holds(failure<FileError>(path), { path, "no such file" }));
  EXPECT_TRUE(holds(failure<FileError>(""), { "No file name" }));
}

TEST(RasterErrors, folder)
{
  const std::string path = ::testing::TempDir();
  EXPECT_TRUE(holds(failure<FileError>(path), { path, "folder" }));
}

TEST(RasterErrors, notARaster)
{
  const std::string text = writeFile("letter.tif", "Dear reader");
  EXPECT_TRUE(holds(failure<FileError>(text), { text, "not a raster" }));
  const std::string nothing = writeFile("empty.tif", "");
  EXPECT_TRUE(holds(failure<FileError>(nothing), { nothing, "not a raster" }));
}

TEST(RasterErrors, vectorLayer)
{
  const std::string path = writeFile("points.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},)"
    R"("geometry":{"type":"Point","coordinates":[1,2,3]}}]})");
  EXPECT_TRUE(holds(failure<FileError>(path), { path, "vector layer", "raster is needed" }));
}

/// netCDF, classic: two variables a and b over 2 × 2 nodes. GDAL makes a container of it.
std::string twoVariables()
{
  std::string bytes = "CDF\x01";
  const auto put = [&bytes](std::initializer_list<int> words)
  {
    for (const int word : words)
    {
      bytes += { char(word >> 24), char(word >> 16), char(word >> 8), char(word) };
    }
  };
  const auto name = [&](char letter)
  {
    put({ 1 });
    bytes += { letter, 0, 0, 0 };
  };
  put({ 0, 10, 2 }); // no records; two dimensions
  name('y');
  put({ 2 });
  name('x');
  put({ 2, 0, 0, 11, 2 }); // no attributes; two variables
  const int header = 44 + 4 + 2 * 44;
  for (int i = 0; i < 2; ++i)
  {
    name(char('a' + i));
    put({ 2, 0, 1, 0, 0, 5, 16, header + 16 * i }); // of both dimensions; floats
  }
  bytes.resize(header + 32, 0);
  return writeFile("two.nc", bytes);
}

TEST(RasterErrors, containerWithoutBand)
{
  const std::string path = twoVariables();
  EXPECT_TRUE(holds(failure<FileError>(path),
    { path, "no raster band", "container", "NETCDF:\"" + path + "\":a" }));
}

TEST(RasterErrors, wrongBand)
{
  const std::string path = smallRaster().write();
  EXPECT_TRUE(holds(failure<DataError>(path, { .band = 3 }), { path, "band 3", "1 band" }));
  EXPECT_TRUE(holds(failure<DataError>(path, { .band = 0 }), { path, "band 0" }));
}

TEST(RasterErrors, complexNumbers)
{
  RawRaster raster = smallRaster();
  raster.type = "CFloat32";
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "complex", "CFloat32" }));
}

TEST(RasterErrors, truncated)
{
  // The header promises more numbers than the file has.
  writeFile("half.hdr",
    "NROWS 100\nNCOLS 100\nNBANDS 1\nNBITS 32\nPIXELTYPE FLOAT\nBYTEORDER I\nLAYOUT BIL\n"
    "ULXMAP 600000\nULYMAP 5100000\nXDIM 10\nYDIM 10\n");
  const std::string raw = writeFile("half.bil", std::string(20000, '\0'));
  EXPECT_TRUE(holds(
    failure<FileError>(raw), { raw, "rows 1 to 100 of band 1", "cannot be read", "scanline 50" }));
}

/// An ENVI raster of 3 × 4 numbers of 4 bytes in each of two bands, after 8 bytes of something
/// else: 104 bytes, of which this many are written.
std::string writeEnvi(std::size_t bytes, const std::string& interleave = "bsq")
{
  writeFile("envi.hdr",
    "ENVI\nsamples = 3\nlines = 4\nbands = 2\nheader offset = 8\nfile type = ENVI Standard\n"
    "data type = 4\ninterleave = " +
      interleave +
      "\nbyte order = 0\nmap info = {UTM, 1, 1, 600000, 5100000, 10, 10, 32, North, WGS-84}\n");
  return writeFile("envi.dat", std::string(bytes, '\1'));
}

TEST(RasterErrors, truncatedEnvi)
{
  for (const char* interleave : { "bsq", "bil", "bip" })
  {
    EXPECT_EQ(readRaster(writeEnvi(104, interleave)).geometry.rows, 4) << interleave;
    EXPECT_EQ(readRaster(writeEnvi(200, interleave)).geometry.rows, 4) << interleave;
    const std::string path = writeEnvi(103, interleave);
    EXPECT_TRUE(holds(failure<FileError>(path),
      { path, "truncated", "band 2", "3 x 4", "needs 104 bytes", "has 103" }))
      << interleave;
  }
  const std::string path = writeEnvi(40); // the first band is cut off, too
  EXPECT_TRUE(
    holds(failure<FileError>(path), { path, "band 1", "needs 56 bytes", "the file has 40" }));
  const std::string empty = writeEnvi(0);
  EXPECT_TRUE(holds(failure<FileError>(empty), { empty }));
}

TEST(RasterErrors, truncatedRawBandOfAVrt)
{
  const std::string path = smallRaster().write();
  EXPECT_EQ(readRaster(path).geometry.columns, 3);
  const std::string raw = writeFile("raster.raw", std::string(47, '\0'));
  EXPECT_TRUE(holds(failure<FileError>(path),
    { path, raw, "truncated", "band 1", "3 x 2", "needs 48 bytes", "has 47" }));

  // Rows that run backwards through the file begin at its last one.
  const auto backwards = [](const std::string& numbers)
  {
    return writeFile("backwards.vrt",
      "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"><GeoTransform>0, 10, 0, 20, 0, -10"
      "</GeoTransform><VRTRasterBand dataType=\"Float64\" band=\"1\" "
      "subClass=\"VRTRawRasterBand\"><SourceFilename relativeToVRT=\"1\">" +
        nameOf(numbers) +
        "</SourceFilename><ImageOffset>24</ImageOffset><PixelOffset>8</PixelOffset>"
        "<LineOffset>-24</LineOffset></VRTRasterBand></VRTDataset>");
  };
  EXPECT_EQ(readRaster(backwards(writeFile("whole", std::string(48, '\0')))).geometry.rows, 2);
  const std::string cut = writeFile("cut", std::string(40, '\0'));
  EXPECT_TRUE(
    holds(failure<FileError>(backwards(cut)), { cut, "needs 48 bytes", "the file has 40" }));
}

TEST(RasterErrors, truncatedMaskOfAVrt)
{
  RawRaster raster = smallRaster();
  const std::string mask = writeFile("mask.raw", std::string(5, '\1'));
  raster.dataset = "<MaskBand><VRTRasterBand dataType=\"Byte\" subClass=\"VRTRawRasterBand\">"
                   "<SourceFilename relativeToVRT=\"1\">" +
    nameOf(mask) +
    "</SourceFilename><PixelOffset>1</PixelOffset><LineOffset>3</LineOffset></VRTRasterBand>"
    "</MaskBand>";
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<FileError>(path), { path, mask, "needs 6 bytes", "has 5" }));
}

TEST(RasterErrors, truncatedSourceOfAVrt)
{
  const auto over = [](const std::string& envi)
  {
    return writeFile("over.vrt",
      "<VRTDataset rasterXSize=\"3\" rasterYSize=\"4\"><GeoTransform>0, 10, 0, 40, 0, -10"
      "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
      "<SourceFilename>" +
        envi +
        "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>");
  };
  EXPECT_EQ(readRaster(over(writeEnvi(104))).geometry.rows, 4);
  const std::string envi = writeEnvi(60);
  const std::string path = over(envi);
  EXPECT_TRUE(
    holds(failure<FileError>(path), { path, envi, "truncated", "needs 104 bytes", "has 60" }));
}

TEST(RasterErrors, asciiGridOfTheWrongLength)
{
  const std::string less = writeAscii({ "1 2 3", "4 5" }, 3);
  EXPECT_TRUE(holds(failure<FileError>(less), { less, "5 numbers", "3 x 2 = 6" }));
  const std::string more = writeAscii({ "1 2 3", "4 5 6 7" }, 3);
  EXPECT_TRUE(holds(failure<FileError>(more), { more, "7 numbers", "3 x 2 = 6" }));
}

TEST(RasterErrors, wordsInAnAsciiGrid)
{
  const std::string path = writeAscii({ "1 2 3", "4 high 6" }, 3);
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "\"high\"", "row 2, column 2" }));
  const std::string joined = writeAscii({ "1 2 3", "4 5.5.5 6" }, 3);
  EXPECT_TRUE(holds(failure<DataError>(joined), { joined, "\"5.5.5\"", "row 2, column 2" }));
}

TEST(RasterErrors, tooSmall)
{
  RawRaster raster = smallRaster();
  raster.rows = 1;
  raster.values.resize(3);
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "3 columns", "1 rows" }));
}

TEST(RasterErrors, allNodata)
{
  RawRaster raster = smallRaster();
  raster.values.assign(6, -9999.0);
  raster.band = "<NoDataValue>-9999</NoDataValue>";
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "all 3 x 2 nodes", "nodata" }));
}

TEST(RasterErrors, nothingLeftAfterResampling)
{
  // A chessboard of nodata: no new node between has four neighbours.
  RawRaster raster = smallRaster();
  raster.columns = raster.rows = 4;
  raster.values.assign(16, 5.0);
  for (int i = 0; i < 16; ++i)
  {
    raster.values[i] = (i + i / 4) % 2 ? -9999.0 : 5.0;
  }
  raster.band = "<NoDataValue>-9999</NoDataValue>";
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<DataError>(path, { .cellSize = 20.0 }), { path, "no node is left" }));
}

TEST(RasterErrors, heightsThatAreNotNumbers)
{
  RawRaster raster = smallRaster();
  raster.values[5] = std::numeric_limits<double>::quiet_NaN();
  const std::string undeclared = raster.write("nan");
  EXPECT_TRUE(holds(failure<DataError>(undeclared), { undeclared, "row 2, column 3", "nan" }));

  raster.band = "<NoDataValue>-9999</NoDataValue>";
  const std::string other = raster.write("other");
  EXPECT_TRUE(holds(failure<DataError>(other), { other, "row 2, column 3", "nan" }));

  raster.values[5] = 6.0;
  raster.values[1] = -std::numeric_limits<double>::infinity();
  const std::string infinite = raster.write("infinite");
  EXPECT_TRUE(holds(failure<DataError>(infinite), { infinite, "row 1, column 2", "-inf" }));

  const std::string ascii = writeAscii({ "1.5 2.5 3.5", "4.5 nan 6.5" }, 3);
  EXPECT_TRUE(holds(failure<DataError>(ascii), { ascii, "row 2, column 2", "nan" }));
}

TEST(RasterErrors, absurdHeight)
{
  RawRaster raster = smallRaster();
  raster.values[2] = -32768.0;
  const std::string path = raster.write();
  EXPECT_TRUE(
    holds(failure<DataError>(path), { path, "row 1, column 3", "-32768 m", "-a_nodata -32768" }));
}

TEST(RasterErrors, usualNodataThatIsNotDeclared)
{
  RawRaster raster = smallRaster();
  raster.values[4] = -9999.0;
  EXPECT_TRUE(
    holds(failure<DataError>(raster.write()), { "row 2, column 2", "-9999 m", "-a_nodata -9999" }));
  raster.values[4] = -4900.0; // interpolated between one and ground
  EXPECT_TRUE(holds(failure<DataError>(raster.write()), { "row 2, column 2", "-4900 m" }));
  raster.values[4] = -430.0; // the Dead Sea
  EXPECT_EQ(readRaster(raster.write()).heights[4], -430.0);
}

TEST(RasterErrors, gapsOfAMosaic)
{
  const std::string tile = smallRaster().write("tile");
  const auto mosaic = [&](const std::string& nodata)
  {
    return writeFile("mosaic.vrt",
      "<VRTDataset rasterXSize=\"6\" rasterYSize=\"2\"><SRS>EPSG:32632</SRS><GeoTransform>600000, "
      "10, 0, 5100020, 0, -10</GeoTransform><VRTRasterBand dataType=\"Float64\" band=\"1\">" +
        nodata + "<SimpleSource><SourceFilename>" + tile +
        "</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"3\" "
        "ySize=\"2\"/><DstRect xOff=\"0\" yOff=\"0\" xSize=\"3\" ySize=\"2\"/></SimpleSource>"
        "</VRTRasterBand></VRTDataset>");
  };
  const std::string path = mosaic("");
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "50 %", "band 1", "-vrtnodata" }));
  const RasterSurface read = readRaster(mosaic("<NoDataValue>-9999</NoDataValue>"));
  EXPECT_EQ(read.heights[2], 3.0);
  EXPECT_TRUE(std::isnan(read.heights[3]));
}

TEST(RasterErrors, degreesWithoutCrs)
{
  // Small cells; and cells that could be metres but for the cliffs.
  const std::string fine = writeAscii(
    { "500 510 520", "500 510 520" }, 3, "xllcorner 7.5\nyllcorner 46.5\n", "0.000277777778");
  EXPECT_TRUE(holds(failure<DataError>(fine), { fine, "no CRS", "-a_srs EPSG:4326", "7.5001" }));
  const std::string coarse =
    writeAscii({ "500 900 1500", "500 400 200" }, 3, "xllcorner 7.5\nyllcorner 46.5\n", "0.1");
  EXPECT_TRUE(holds(failure<DataError>(coarse), { coarse, "no CRS", "-a_srs EPSG:4326" }));
}

TEST(RasterErrors, metresCalledDegrees)
{
  RawRaster raster = smallRaster();
  raster.crs = "EPSG:4326";
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "EPSG:4326", "geographic", "600005" }));
}

TEST(RasterErrors, halfTheWorld)
{
  RawRaster raster = smallRaster();
  raster.crs = "EPSG:4326";
  raster.affine = { 0.0, 20.0, 0.0, 60.0, 0.0, -20.0 };
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "too large", "km" }));
}

TEST(RasterErrors, geocentric)
{
  RawRaster raster = smallRaster();
  raster.crs = "EPSG:4978";
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "EPSG:4978", "geocentric" }));
}

TEST(RasterErrors, cellSize)
{
  const std::string path = smallRaster().write();
  EXPECT_TRUE(holds(failure<ParameterError>(path, { .cellSize = -5.0 }), { "CellSize", "-5" }));
  EXPECT_TRUE(holds(failure<ParameterError>(path, { .cellSize = std::nan("") }), { "nan" }));
  // Coarser than the raster is wide, and finer than any memory.
  EXPECT_TRUE(holds(failure<DataError>(path, { .cellSize = 50.0 }), { path, "50 m", "0 x 0" }));
  EXPECT_TRUE(holds(failure<DataError>(path, { .cellSize = 1e-6 }), { path, "GB of memory" }));
}

TEST(RasterErrors, cellsWithoutArea)
{
  RawRaster raster = smallRaster();
  raster.affine = { 600000.0, 0.0, 0.0, 5100020.0, 0.0, -10.0 };
  const std::string path = raster.write();
  EXPECT_TRUE(holds(failure<DataError>(path), { path, "no area", "600000" }));
}

TEST(RasterErrors, threadsDoNotMixTheirMessages)
{
  const std::string good = smallRaster().write();
  const std::string bad = writeFile("letter.tif", "Dear reader");
  std::vector<std::thread> threads;
  std::array<int, 4> right{};
  for (int t = 0; t < 4; ++t)
  {
    threads.emplace_back(
      [&, t]
      {
        for (int i = 0; i < 50; ++i)
        {
          try
          {
            right[t] += readRaster(t % 2 ? good : bad).heights.size() == 6;
          }
          catch (const FileError& error)
          {
            right[t] += bool(holds(error.what(), { bad }));
          }
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(right, (std::array<int, 4>{ 50, 50, 50, 50 }));
}

} // namespace

} // namespace rockfall
