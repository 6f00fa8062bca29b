/// @file
/// Files that reach out, to the network or to other files of the machine, and rasters that would
/// take more memory than they are worth.

#include "base/errors.h"
#include "gis/base/externalReferences.h"
#include "gis/layers/lineLayer.h"
#include "gis/layers/sources.h"
#include "gis/raster/contours.h"
#include "gis/raster/raster.h"
#include "gisFiles.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

std::string refusal(const std::string& file)
{
  return messageOf<FileError>([&] { readRaster(file); });
}

/// A virtual raster of one band with this inside.
std::string virtualRaster(const std::string& inside, const std::string& subClass = "")
{
  return writeFile("reach.vrt",
    "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><GeoTransform>0,5,0,100,0,-5</GeoTransform>"
    "<VRTRasterBand dataType=\"Byte\" band=\"1\"" +
      subClass + ">" + inside + "</VRTRasterBand></VRTDataset>");
}

std::string source(const std::string& name)
{
  return "<SimpleSource><SourceFilename>" + name +
    "</SourceFilename><SourceBand>1</SourceBand></SimpleSource>";
}

TEST(Reach, addressesAreRefused)
{
  for (const char* name : { "/vsicurl/http://127.0.0.1:9/a.tif", "http://127.0.0.1:9/a.tif",
         "/vsis3/bucket/a.tif", "/vsizip//vsicurl/https://127.0.0.1:9/a.zip",
         "NETCDF:\"https://127.0.0.1:9/a.nc\":z", "PG:host=127.0.0.1", "WFS:http://127.0.0.1:9" })
  {
    EXPECT_TRUE(holds(refusal(name), { name, "AllowReferences" }));
    EXPECT_TRUE(
      holds(messageOf<FileError>([&] { readSourceLayer(name, {}); }), { "AllowReferences" }));
    EXPECT_TRUE(holds(messageOf<FileError>([&] { readLineLayer(name); }), { "AllowReferences" }));
  }
}

/// A port of this machine on which somebody listens.
class Listener
{
public:
  Listener()
    : socket_(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0))
  {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const name = reinterpret_cast<sockaddr*>(&address);
    good_ = bind(socket_, name, size) == 0 && listen(socket_, 16) == 0 &&
      getsockname(socket_, name, &size) == 0;
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/";
  }
  ~Listener() { close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  bool good() const { return good_; }
  const std::string& url() const { return url_; }
  /// Whether anybody has called.
  bool called() const
  {
    const int call = accept(socket_, nullptr, nullptr);
    if (call >= 0)
    {
      close(call);
    }
    return call >= 0;
  }

private:
  int socket_;
  bool good_ = false;
  std::string url_;
};

TEST(Reach, nobodyIsCalled)
{
  setenv("GDAL_HTTP_TIMEOUT", "1", 1); // for the day when somebody is
  setenv("GDAL_HTTP_CONNECTTIMEOUT", "1", 1);
  const Listener listener;
  ASSERT_TRUE(listener.good());
  // Tables are looked into before GDAL opens them.
  for (const char* name : { "a.csv", "a.tif", "a.geojson", "a.xlsx", "a.vrt", "a.gml" })
  {
    const std::string url = "/vsicurl/" + listener.url() + name;
    EXPECT_THROW(readRaster(url), FileError);
    EXPECT_THROW(readContours(url), FileError);
    EXPECT_THROW(readSourceLayer(url, {}), FileError);
    EXPECT_THROW(readLineLayer(url), FileError);
    EXPECT_FALSE(listener.called()) << url;
  }
  const std::string inside = virtualRaster(source("/vsicurl/" + listener.url() + "a.tif"));
  EXPECT_THROW(readRaster(inside), FileError);
  EXPECT_FALSE(listener.called());
}

TEST(Reach, servicesInFilesAreRefused)
{
  const std::string wms = writeFile("map.xml",
    "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://127.0.0.1:9/${z}/${x}/${y}.png</ServerUrl>"
    "</Service><DataWindow><UpperLeftX>0</UpperLeftX><UpperLeftY>10</UpperLeftY><LowerRightX>10"
    "</LowerRightX><LowerRightY>0</LowerRightY><SizeX>100</SizeX><SizeY>100</SizeY></DataWindow>"
    "<BandsCount>1</BandsCount></GDAL_WMS>");
  EXPECT_TRUE(holds(refusal(wms), { wms, "driver WMS", "AllowReferences" }));
  EXPECT_TRUE(holds(refusal(virtualRaster(source(wms))), { "names", "map.xml", "driver WMS" }));
  const std::string mrf = writeFile("tiles.mrf",
    "<MRF_META><Raster><Size x=\"2\" y=\"2\" "
    "c=\"1\"/><DataType>Byte</DataType><DataFile>/etc/hostname"
    "</DataFile><Compression>NONE</Compression></Raster></MRF_META>");
  EXPECT_TRUE(holds(refusal(mrf), { "driver MRF" }));
  EXPECT_TRUE(holds(refusal("<GDAL_WMS><Service name=\"TMS\"/></GDAL_WMS>"), { "driver WMS" }));
}

TEST(Reach, virtualRastersNameWhatIsBesideThemOnly)
{
  const std::string raw = " subClass=\"VRTRawRasterBand\"";
  for (const char* name :
    { "/etc/hostname", "../../../../../../../../../../etc/hostname",
      "/vsicurl/http://127.0.0.1:9/a.tif", "http://127.0.0.1:9/a.tif", "NETCDF:/etc/hostname:z" })
  {
    EXPECT_TRUE(holds(refusal(virtualRaster(source(name))), { name, "beside it" }));
    EXPECT_TRUE(holds(refusal(virtualRaster("<SourceFilename>" + std::string(name) +
                          "</SourceFilename><PixelOffset>1</PixelOffset><LineOffset>2</LineOffset>",
                        raw)),
      { name }));
  }
  EXPECT_TRUE(
    holds(refusal("<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><VRTRasterBand dataType="
                  "\"Byte\" band=\"1\">" +
            source("/etc/hostname") + "</VRTRasterBand></VRTDataset>"),
      { "/etc/hostname" }));
  EXPECT_TRUE(holds(refusal("vrt:///etc/hostname"), { "AllowReferences" }));
  // A link to elsewhere is elsewhere.
  const std::string link = pathOf("link");
  std::filesystem::remove(link);
  std::filesystem::create_symlink("/etc/hostname", link);
  EXPECT_TRUE(holds(refusal(virtualRaster(source(link))), { "not beside it" }));
  // A virtual raster of a virtual raster.
  const std::string inner = virtualRaster(source("/etc/hostname"));
  const std::string outer = writeFile("outer.vrt",
    "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><VRTRasterBand dataType=\"Byte\" band=\"1\">" +
      source(inner) + "</VRTRasterBand></VRTDataset>");
  EXPECT_TRUE(holds(refusal(outer), { outer, "/etc/hostname" }));
}

TEST(Reach, MemoryIsNoFile)
{
  const unsigned char pixels[4] = {};
  char place[32]; // where there is something to read
  std::snprintf(place, sizeof place, "%p", static_cast<const void*>(pixels));
  const std::string memory = "MEM:::DATAPOINTER=" + std::string(place) + ",PIXELS=2,LINES=2";
  for (const bool allowed : { false, true })
  {
    const AllowReferences allow(allowed);
    EXPECT_TRUE(holds(refusal(memory), { memory, "no file" }));
    EXPECT_TRUE(
      holds(messageOf<FileError>([&] { readSourceLayer(memory, {}); }), { memory, "no file" }));
  }
  EXPECT_TRUE(holds(refusal(virtualRaster(source(memory))), { memory, "not beside it" }));
}

TEST(Reach, PipesAreNoFiles)
{
  const std::string pipe = pathOf("pipe.asc");
  std::filesystem::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const bool allowed : { false, true })
  {
    const AllowReferences allow(allowed);
    EXPECT_TRUE(holds(refusal(pipe), { pipe, "a pipe or device" }));
    EXPECT_TRUE(holds(
      messageOf<FileError>([&] { readSourceLayer(pipe, {}); }), { pipe, "a pipe or device" }));
  }
  EXPECT_TRUE(holds(refusal(virtualRaster(source(pipe))), { "pipe.asc", "a pipe or device" }));
  for (const char* name : { "/dev/zero", "/dev/tty", "/dev/stdin" })
  {
    if (std::filesystem::is_other(name))
    {
      EXPECT_TRUE(holds(refusal(name), { name, "a pipe or device" }));
    }
  }
  // Some of the kernel's wait for events, and say that they are files.
  for (const char* name : { "/proc/kmsg", "/proc/self/maps", "/sys/kernel/mm" })
  {
    if (std::filesystem::exists(name))
    {
      EXPECT_TRUE(holds(refusal(name), { name, "a file of the kernel's, no file" }));
    }
  }
  std::filesystem::remove(pipe);
}

TEST(Reach, virtualLayersNameWhatIsBesideThemOnly)
{
  const auto layer = [](const std::string& inside)
  {
    const std::string path = writeFile("layer.vrt",
      "<OGRVRTDataSource><OGRVRTLayer name=\"a\">" + inside + "</OGRVRTLayer></OGRVRTDataSource>");
    return messageOf<FileError>([&] { readSourceLayer(path, {}); });
  };
  EXPECT_TRUE(holds(layer("<SrcDataSource>/etc/passwd</SrcDataSource>"), { "/etc/passwd" }));
  EXPECT_TRUE(holds(layer("<SrcDataSource>PG:host=127.0.0.1</SrcDataSource>"), { "PG:host" }));
  EXPECT_TRUE(holds(layer("<SrcDataSource>http://127.0.0.1:9/a.json</SrcDataSource>"), { "http" }));
  const std::string table = writeFile("a.csv", "x,y,z\n1,2,3\n");
  EXPECT_TRUE(holds(layer("<SrcDataSource>" + table +
                      "</SrcDataSource><SrcSQL dialect=\"SQLITE\">SELECT * FROM "
                      "ogr_layer_Extent('/etc/passwd')</SrcSQL>"),
    { "SQL" }));
}

/// A number of SQLite's: seven bits a byte.
std::string varint(std::size_t value)
{
  std::string bytes(1, char(value & 0x7f));
  for (value >>= 7; value > 0; value >>= 7)
  {
    bytes.insert(0, 1, char(0x80 | (value & 0x7f)));
  }
  return bytes;
}

std::string bigEnd(std::size_t value, int bytes)
{
  std::string text;
  for (int k = bytes - 1; k >= 0; --k)
  {
    text += char(value >> 8 * k & 0xff);
  }
  return text;
}

/// A database of one page whose one table is what a module reads of `file`, by default one of
/// SpatiaLite's.
std::string virtualTable(const std::string& name, const std::string& file,
  const std::string& module = "VirtualText('",
  const std::string& rest = "','UTF-8',1,POINT,DOUBLEQUOTE,',')")
{
  constexpr std::size_t page = 4096;
  const std::string sql = "CREATE VIRTUAL TABLE leak USING " + module + file + rest;
  const auto type = [](std::size_t length) { return varint(2 * length + 13); };
  std::string types = type(5) + type(4) + type(4) + char(8) + type(sql.size());
  types = varint(types.size() + 1) + types;
  const std::string row = types + "tableleakleak" + sql;
  const std::string cell = varint(row.size()) + varint(1) + row;

  std::string bytes("SQLite format 3\0", 16);
  bytes += bigEnd(page, 2) + std::string("\1\1\0\100\40\40", 6) + bigEnd(1, 4) + bigEnd(1, 4);
  bytes += bigEnd(0, 8) + bigEnd(1, 4) + bigEnd(4, 4) + bigEnd(0, 8) + bigEnd(1, 4);
  bytes += std::string(32, '\0') + bigEnd(1, 4) + bigEnd(3040001, 4);
  // The page's own head, and where its one cell is.
  bytes += std::string("\15\0\0\0\1", 5) + bigEnd(page - cell.size(), 2) + '\0';
  bytes += bigEnd(page - cell.size(), 2);
  bytes.resize(page - cell.size(), '\0');
  return writeFile(name, bytes + cell);
}

TEST(Reach, namesOfOverviewsAreNotCalled)
{
  setenv("GDAL_HTTP_TIMEOUT", "1", 1);
  setenv("GDAL_HTTP_CONNECTTIMEOUT", "1", 1);
  const Listener listener;
  ASSERT_TRUE(listener.good());
  RawRaster heights;
  heights.columns = heights.rows = 8;
  heights.affine = { 0.0, 5.0, 0.0, 100.0, 0.0, -5.0 };
  heights.values.assign(64, 12.0);
  const std::string path = heights.write("a");
  writeFile("a.vrt.aux.xml",
    "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">/vsicurl/" +
      listener.url() + "a.tif</MDI></Metadata></PAMDataset>");
  EXPECT_TRUE(holds(refusal(path), { path, "/vsicurl/" + listener.url() }));
  EXPECT_FALSE(listener.called());
}

TEST(Reach, tablesOfADatabaseAreItsOwn)
{
  // A table that a module of SpatiaLite makes of a file elsewhere, in a database of one page.
  const std::string secret = writeFile("secret.csv", "x,y,z\n1,2,3\n");
  const std::string path = virtualTable("leak.sqlite", secret);
  SourceOptions table;
  table.layer = "leak";
  const std::string message = messageOf<Error>([&] { readSourceLayer(path, table); });
  EXPECT_TRUE(holds(message, { path })) << message;
  const AllowReferences allow(true);
  EXPECT_EQ(readSourceLayer(path, table).rows.size(), 1u);
}

TEST(Reach, isAllowedWhereItIsAskedFor)
{
  // The numbers of a raster in another folder.
  const std::string folder = pathOf("elsewhere");
  std::filesystem::create_directories(folder);
  const std::string numbers = folder + "/numbers.raw";
  std::ofstream(numbers, std::ios::binary) << std::string("\x01\x02\x03\x04");
  std::filesystem::create_directories(pathOf("here"));
  const std::string path = pathOf("here") + "/a.vrt";
  std::ofstream(path)
    << "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><GeoTransform>0,5,0,100,0,"
       "-5</GeoTransform><VRTRasterBand dataType=\"Byte\" band=\"1\" subClass="
       "\"VRTRawRasterBand\"><SourceFilename>"
    << numbers
    << "</SourceFilename><PixelOffset>1</PixelOffset><LineOffset>2</LineOffset>"
       "</VRTRasterBand></VRTDataset>";
  EXPECT_TRUE(holds(refusal(path), { numbers, "not beside it" }));
  {
    const AllowReferences allow(true);
    EXPECT_EQ(readRaster(path).heights, (std::vector<double>{ 1.0, 2.0, 3.0, 4.0 }));
    {
      const AllowReferences not_(false);
      EXPECT_TRUE(holds(refusal(path), { "not beside it" }));
    }
    EXPECT_NO_THROW(readRaster(path));
  }
  EXPECT_TRUE(holds(refusal(path), { "not beside it" }));
}

/// A virtual raster, in a folder of its own, with this beside its band.
std::string rasterWith(const std::string& inside)
{
  std::filesystem::create_directories(pathOf("home"));
  RawRaster raster = smallRaster();
  raster.dataset = inside;
  return raster.write("home/with");
}

/// Each way in which a file names an address; the address is called by GDAL where
/// references are allowed, and by nobody else.
TEST(Reach, addressesInFilesAreNotCalled)
{
  setenv("GDAL_HTTP_TIMEOUT", "1", 1);
  setenv("GDAL_HTTP_CONNECTTIMEOUT", "1", 1);
  const Listener listener;
  ASSERT_TRUE(listener.good());
  const std::string url = listener.url();
  const std::string line = "\"features\":[{\"type\":\"Feature\",\"properties\":{},\"geometry\":"
                           "{\"type\":\"LineString\",\"coordinates\":[[1,2],[3,4]]}}]}";
  const std::string link = writeFile("link.geojson",
    "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"link\",\"properties\":{\"href\":\"" + url +
      "crs.wkt\",\"type\":\"ogcwkt\"}}," + line);
  EXPECT_TRUE(holds(messageOf<FileError>([&] { readLineLayer(link); }),
    { link, "names the address " + url, "AllowReferences" }));
  EXPECT_FALSE(listener.called());

  // A schema, and a further document: taken without them, or refused.
  const std::string gml = writeFile("schema.gml",
    "<ogr:FeatureCollection xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
    "xsi:schemaLocation=\"http://ogr.maptools.org/ " +
      url +
      "a.xsd\" xmlns:ogr=\"http://ogr.maptools.org/\" xmlns:gml=\"http://www.opengis.net/gml\">"
      "<gml:featureMember><ogr:a "
      "fid=\"a.0\"><ogr:geometryProperty><gml:LineString><gml:coordinates>"
      "1,2 3,4</gml:coordinates></gml:LineString></ogr:geometryProperty></ogr:a>"
      "</gml:featureMember></ogr:FeatureCollection>");
  const std::string kml = writeFile("further.kml",
    "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><NetworkLink><Link><href>" + url +
      "a.kml</href></Link></NetworkLink><Placemark><LineString><coordinates>9,46,1 9.001,46,2"
      "</coordinates></LineString></Placemark></Document></kml>");
  for (const std::string& file : { gml, kml })
  {
    try
    {
      EXPECT_EQ(readLineLayer(file).size(), 1u);
    }
    catch (const Error&)
    {
    }
    EXPECT_FALSE(listener.called()) << file;
  }

  const std::string inner = virtualRaster("<ColorInterp>Gray</ColorInterp>");
  for (const std::string& value : std::vector<std::string>{ "/vsicurl/" + url + "a.tif",
         "/vsicurl_streaming/" + url + "a", "/vsis3_streaming/bucket/a", "/vsioss/bucket/a.tif",
         "/vsisparse/" + inner, "/vsizip//vsicurl/" + url + "a.zip/a.tif", url + "a.tif",
         "&lt;GDAL_WMS>&lt;Service name=\"TMS\"/>&lt;/GDAL_WMS>", "PG:host=127.0.0.1" })
  {
    const std::string path = rasterWith(
      "<Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">" + value + "</MDI></Metadata>");
    std::string said;
    try
    {
      readRaster(path);
    }
    catch (const FileError& error)
    {
      said = error.what();
    }
    // An address among metadata stands there often, and nothing opens it.
    EXPECT_EQ(holds(said, { path, "AllowReferences" }), value != url + "a.tif") << value << said;
    EXPECT_FALSE(listener.called()) << value;
  }
  // The same file calls where it may.
  const AllowReferences allow(true);
  std::atomic<bool> called = false, done = false;
  std::thread hangUp(
    [&]
    {
      while (!done)
      {
        called = listener.called() || called;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
  EXPECT_NO_THROW(readLineLayer(link));
  done = true;
  hangUp.join();
  EXPECT_TRUE(called);
}

TEST(Reach, anyValueThatNamesAFileIsLookedAt)
{
  std::filesystem::create_directories(pathOf("away"));
  const std::string away = pathOf("away") + "/numbers.txt";
  std::ofstream(away) << "1 2\n3 4\n";
  const std::string up = "../" + away.substr(away.find("Reach"));
  const auto item = [](const std::string& domain, const std::string& key, const std::string& value)
  {
    return "<Metadata domain=\"" + domain + "\"><MDI key=\"" + key + "\">" + value +
      "</MDI></Metadata>";
  };
  for (const std::string& inside :
    std::vector<std::string>{ item("OVERVIEWS", "OVERVIEW_FILE", away),
      item("GEOLOCATION", "X_DATASET", away),
      item("OVERVIEWS", "OVERVIEW_FILE", "NETCDF:" + away + ":z"),
      "<MaskBand><VRTRasterBand dataType=\"Byte\">" + source(away) + "</VRTRasterBand></MaskBand>",
      "<GDALWarpOptions><Transformer><Option name=\"DEM\">" + away +
        "</Option></Transformer></GDALWarpOptions>",
      "<OpenOptions><OOI key=\"XSD\">" + away + "</OOI></OpenOptions>" })
  {
    const std::string path = rasterWith(inside);
    EXPECT_TRUE(holds(refusal(path), { path, "numbers.txt", "not beside it" })) << inside;
  }
  // Beside another format, and up from its folder.
  const std::string raw = smallRaster().write("home/b");
  writeFile("home/b.vrt.aux.xml",
    "<PAMDataset>" + item("OVERVIEWS", "OVERVIEW_FILE", ":::BASE:::" + away) + "</PAMDataset>");
  EXPECT_TRUE(holds(refusal(raw), { raw, away }));
  std::filesystem::remove(raw + ".aux.xml");
  // Plain metadata, numbers and a file beside it do no harm.
  EXPECT_NO_THROW(readRaster(rasterWith("<Metadata><MDI key=\"reference\">https://127.0.0.1/"
                                        "a</MDI><MDI key=\"made\">2020:01:02 10:00:00</MDI><MDI "
                                        "key=\"of\">b.vrt</MDI></Metadata>")));
}

TEST(Reach, tablesThatAreMadeOfOthersAreRefused)
{
  writeFile("part.csv", "x,y,z\n1,2,3\n");
  const std::string sql = writeFile("sql.vrt",
    "<OGRVRTDataSource><OGRVRTLayer name=\"a\"><SrcDataSource "
    "relativeToVRT=\"1\">part.csv</SrcDataSource><SrcSQL>SELECT x FROM part</SrcSQL></OGRVRTLayer>"
    "</OGRVRTDataSource>");
  EXPECT_TRUE(holds(
    messageOf<FileError>([&] { readSourceLayer(sql, {}); }), { sql, "SQL", "AllowReferences" }));
  const std::string view = writeFile("view.tab",
    "!table\n!version 100\n\nopen table \"/etc/a.tab\"\n\ncreate view view as\nselect x\nfrom a\n");
  EXPECT_TRUE(holds(messageOf<FileError>([&] { readLineLayer(view); }), { view, "MapInfo" }));
  // GDAL's own module of SQLite.
  const std::string own = virtualTable("own.sqlite", pathOf("part.csv"), "VirtualOGR('", "')");
  SourceOptions table;
  table.layer = "leak";
  EXPECT_TRUE(holds(messageOf<Error>([&] { readSourceLayer(own, table); }), { own }));
}

TEST(Limits, ofMemoryAreInProportionToTheFile)
{
  const std::string sparse =
    writeFile("sparse.asc", "ncne8 98 96 N01\n1.5 2 -\n1e1 2 6\n4e8 5 6\n");
  EXPECT_THROW(readRaster(sparse), Error);
  const std::string points = writeFile("points.xyz", "0 0 1\n1 0 2\n0 1 3\n40000000 1 4\n");
  EXPECT_TRUE(holds(messageOf<Error>([&] { readRaster(points); }), { "points.xyz" }));
  const std::string huge = writeFile("huge.vrt",
    "<VRTDataset rasterXSize=\"40000\" rasterYSize=\"40000\"><GeoTransform>0,5,0,100,0,-5"
    "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"><NoDataValue>-9999</NoDataValue>"
    "</VRTRasterBand></VRTDataset>");
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readRaster(huge); }), { "12.8 GB", "40000 x 40000" }));
  const std::string header =
    writeAscii({ "1 2 3", "4 5 6" }, 30000, "xllcorner 0\nyllcorner 0\n", "1");
  EXPECT_THROW(readRaster(header), FileError);
  const std::string tile = writeAscii({ "1 2", "3 4" }, 2, "xllcorner 0\nyllcorner 90\n", "5");
  const std::string mosaic = writeFile("mosaic.vrt",
    "<VRTDataset rasterXSize=\"40000\" rasterYSize=\"40000\"><GeoTransform>0,5,0,100,0,-5"
    "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"><NoDataValue>-9999</NoDataValue>"
    "<SimpleSource><SourceFilename>" +
      tile +
      "</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"2\" ySize="
      "\"2\"/><DstRect xOff=\"0\" yOff=\"0\" xSize=\"2\" ySize=\"2\"/></SimpleSource>"
      "</VRTRasterBand></VRTDataset>");
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRaster(mosaic); }), { "-projwin" }));
}

TEST(Limits, ofContoursThatAreNoPlace)
{
  for (const char* text : { "WKT,elev\n\"LINESTRING(2 1)\",10\n\"LINESTRING(16 5)\",20\n",
         "WKT,elev\n\"LINESTRING(0 0,1e308 0)\",10\n\"LINESTRING(-1e308 5,3 5)\",20\n",
         "WKT,elev\n\"LINESTRING(0 0,1e200 1e200)\",10\n\"LINESTRING(0 5,3 5)\",20\n",
         "WKT,elev\n\"LINESTRING(2 1shap0 0)\",10\n\"LINESTRING(16 555)\",20\n\"LIN,2LINEe\n" })
  {
    const std::string path = writeFile("lines.csv", text);
    EXPECT_THROW(readContours(path), Error) << text;
    EXPECT_THROW(readContours(path, { .cellSize = 1e-300 }), Error) << text;
  }
}

} // namespace

} // namespace rockfall
