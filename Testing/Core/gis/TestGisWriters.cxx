// Files that are written are read again, by this project's readers and as text.

#include "gisFiles.h"

#include "base/errors.h"
#include "gis/layers/layerWriter.h"
#include "gis/layers/lineLayer.h"
#include "gis/layers/sources.h"
#include "gis/raster/raster.h"
#include "gis/raster/rasterWriter.h"

#include <cmath>
#include <filesystem>
#include <limits>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

namespace fs = std::filesystem;

std::string contentOf(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), {} };
}

/// Files beside `path` whose names begin as its own does.
std::size_t filesBeside(const std::string& path)
{
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path()))
  {
    count += entry.path().filename().string().rfind(fs::path(path).stem().string(), 0) == 0;
  }
  return count;
}

/// 4 × 3 cells of 10 m in UTM zone 32; band 2 is 100 row + column, rows from the south.
MapImage smallMap()
{
  MapImage map;
  map.columns = 4;
  map.rows = 3;
  map.cellSize = 10.0;
  map.west = 500000.0;
  map.south = 5100000.0;
  map.crs = wktOfCrs("EPSG:32632");
  map.bands.push_back(
    { "Rocks", "", [](int, std::span<float> v) { std::fill(v.begin(), v.end(), 3); } });
  map.bands.push_back({ "HeightOverGround95", "m",
    [](int row, std::span<float> v)
    {
      for (std::size_t c = 0; c < v.size(); ++c)
      {
        v[c] = float(100 * row) + float(c);
      }
      if (row == 0)
      {
        v[3] = std::numeric_limits<float>::quiet_NaN();
      }
    } });
  return map;
}

} // namespace

TEST(GeoTiff, PixelsAreInTheRightPlace)
{
  const CommaLocale german;
  const std::string path = pathOf("map.tif");
  EXPECT_EQ(writeGeoTiff(path, smallMap()), "COG");
  EXPECT_EQ(filesBeside(path), 1u);
  const RasterSurface read = readRaster(path, { .cellSize = 0.0, .band = 2 });
  // Nodes are the centres of the pixels.
  EXPECT_EQ(read.geometry.columns, 4);
  EXPECT_EQ(read.geometry.rows, 3);
  EXPECT_EQ(read.geometry.cellSize, 10.0);
  EXPECT_EQ(read.geometry.xOrigin, 500005.0);
  EXPECT_EQ(read.geometry.yOrigin, 5100005.0);
  EXPECT_NE(read.geometry.crs.find("UTM zone 32N"), std::string::npos);
  const std::vector<double> expected = { 200, 201, 202, 203, 100, 101, 102, 103, 0, 1, 2, NAN };
  ASSERT_EQ(read.heights.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
  {
    EXPECT_TRUE(
      read.heights[k] == expected[k] || (std::isnan(read.heights[k]) && std::isnan(expected[k])))
      << k << ": " << read.heights[k];
  }
  const std::string bytes = contentOf(path);
  EXPECT_NE(bytes.find("HeightOverGround95"), std::string::npos);
}

TEST(GeoTiff, FailuresLeaveTheOlderFile)
{
  const std::string path = writeFile("old.tif", "old");
  MapImage broken = smallMap();
  broken.crs = "nonsense";
  EXPECT_TRUE(holds(messageOf<DataError>([&] { writeGeoTiff(path, broken); }), { "nonsense" }));
  broken = smallMap();
  broken.bands.clear();
  EXPECT_TRUE(holds(messageOf<ParameterError>([&] { writeGeoTiff(path, broken); }),
    { "old.tif", "4 x 3", "0 bands" }));
  EXPECT_EQ(contentOf(path), "old");
  EXPECT_EQ(filesBeside(path), 1u);
  const std::string nowhere = pathOf("no-folder") + "/map.tif";
  EXPECT_TRUE(holds(
    messageOf<FileError>([&] { writeGeoTiff(nowhere, smallMap()); }), { nowhere, "no folder" }));
  EXPECT_TRUE(
    holds(messageOf<FileError>([&] { writeGeoTiff("", smallMap()); }), { "No file name" }));
  writeGeoTiff(path, smallMap());
  EXPECT_NE(contentOf(path), "old");
}

TEST(LayerWriter, PointsOfAGeoPackage)
{
  const CommaLocale german;
  const std::string path = pathOf("points.gpkg");
  fs::remove(path);
  {
    LayerWriter writer(path, wktOfCrs("EPSG:32632"));
    writer.beginLayer("rocks", LayerWriter::Geometry::Point,
      { { "Volume", FieldType::Real }, { "BlockId", FieldType::Integer },
        { "Shape", FieldType::Text } });
    const Vec3 place(500000.125, 5100000.25, 712.5);
    const FieldValue values[] = { 1.5, std::int64_t(7), std::string("Cube") };
    writer.add({ &place, 1 }, {}, values);
    EXPECT_FALSE(fs::exists(path)); // not before it is whole
    writer.beginLayer("more", LayerWriter::Geometry::Point, {});
    writer.add({ &place, 1 }, {}, {});
    writer.commit();
  }
  EXPECT_EQ(filesBeside(path), 1u);
  const auto [rows, crs, ownCrs, notes] = readSourceLayer(path, {});
  EXPECT_EQ(filesBeside(path), 1u); // a reader leaves nothing
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].position, Vec3(500000.125, 5100000.25, 712.5));
  EXPECT_EQ(rows[0].volume, 1.5);
  EXPECT_EQ(rows[0].shapes, ShapeMix(Shape::Cube));
  EXPECT_NE(crs.find("UTM zone 32N"), std::string::npos);
}

TEST(LayerWriter, LinesOfACsvTable)
{
  const CommaLocale german;
  const std::string path = pathOf("lines.csv");
  {
    LayerWriter writer(path, wktOfCrs("EPSG:32632"));
    EXPECT_FALSE(writer.manyLayers());
    writer.beginLayer("trajectories", LayerWriter::Geometry::MeasuredLine,
      { { "Mass", FieldType::Real }, { "Empty", FieldType::Real } });
    const Vec3 places[] = { { 500000.5, 5100000.25, 712.5 }, { 500010.5, 5100000.75, 700.5 } };
    const double times[] = { 0.0, 2.5 };
    const FieldValue values[] = { 2500.25, std::nan("") };
    writer.add(places, times, values);
    EXPECT_THROW(writer.beginLayer("more", LayerWriter::Geometry::Point, {}), FileError);
    writer.commit();
  }
  EXPECT_EQ(contentOf(path),
    "WKT,Mass,Empty\n"
    "\"LINESTRING ZM (500000.5 5100000.25 712.5 0,500010.5 5100000.75 700.5 2.5)\",2500.25,\n");
  fs::path companion(path);
  EXPECT_TRUE(fs::exists(companion.replace_extension("csvt")));
  EXPECT_NE(contentOf(companion.replace_extension("prj").string()).find("UTM"), std::string::npos);
}

TEST(LayerWriter, NothingStaysWithoutCommit)
{
  const std::string path = writeFile("kept.gpkg", "old");
  {
    LayerWriter writer(path, "");
    writer.beginLayer("rocks", LayerWriter::Geometry::Point, {});
  }
  EXPECT_EQ(contentOf(path), "old");
  EXPECT_EQ(filesBeside(path), 1u);
  EXPECT_TRUE(holds(messageOf<FileError>([] { LayerWriter("paths.shp", ""); }),
    { "paths.shp", "\"shp\"", "gpkg" }));
  EXPECT_TRUE(holds(messageOf<FileError>([] { LayerWriter("", ""); }), { "No file name" }));
}

TEST(LineLayer, GeometryAndBarriersInAnotherCrs)
{
  const CommaLocale german;
  const std::string path = writeFile("road.geojson", R"({ "type": "FeatureCollection",
    "crs": { "type": "name", "properties": { "name": "EPSG:32632" } }, "features": [
    { "type": "Feature", "properties": { "Name": "road", "HEIGHT": 4.5, "capacity": null },
      "geometry": { "type": "LineString", "coordinates": [[500000, 5100000], [500000, 5100000], [500100, 5100050, 7]] } },
    { "type": "Feature", "properties": { "capacity": "2000.5" },
      "geometry": { "type": "MultiLineString",
        "coordinates": [[[500000, 5100000], [500001, 5100000]], [[500002, 5100000], [500003, 5100000]]] } } ] })");
  const auto lines = readLineLayer(path, wktOfCrs("EPSG:32632"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].name, "road");
  EXPECT_EQ(lines[0].height, 4.5);
  EXPECT_FALSE(lines[0].capacity);
  ASSERT_EQ(lines[0].points.size(), 2u); // a place twice is one
  EXPECT_EQ(lines[0].points[1], Eigen::Vector2d(500100, 5100050));
  EXPECT_EQ(lines[2].feature, 2);
  EXPECT_EQ(lines[2].capacity, 2000.5);
  // The central meridian of zone 32 is 9° E; 500 km are the false easting.
  const auto degrees = readLineLayer(path, wktOfCrs("EPSG:4326"));
  EXPECT_NEAR(degrees[0].points[0].x(), 9.0, 1e-9);
  EXPECT_NEAR(degrees[0].points[0].y(), 46.05, 0.05);
}

TEST(LineLayer, BadInput)
{
  const auto json = [](const std::string& properties, const std::string& geometry)
  {
    return writeFile("bad.geojson",
      R"({ "type": "FeatureCollection", "features": [ { "type": "Feature", "properties": )" +
        properties + R"(, "geometry": )" + geometry + " } ] }");
  };
  const std::string line = R"({ "type": "LineString", "coordinates": [[0, 0], [1, 0]] })";
  const auto refused = [](const std::string& path, const std::vector<std::string>& words)
  { EXPECT_TRUE(holds(messageOf<DataError>([&] { readLineLayer(path); }), words)); };
  refused(json(R"({ "height": "4,5" })", line), { "bad.geojson", "row 1", "height", "4,5" });
  refused(json(R"({ "capacity": -1.5 })", line), { "row 1", "capacity", "-1.5" });
  refused(json("{}", R"({ "type": "Point", "coordinates": [0, 0] })"), { "POINT", "LINESTRING" });
  refused(
    json("{}", R"({ "type": "LineString", "coordinates": [[0, 0], [0, 0]] })"), { "one place" });
  refused(json("{}", "null"), { "row 1", "no geometry" });
  refused(writeFile("none.geojson", R"({ "type": "FeatureCollection", "features": [] })"),
    { "none.geojson", "no line" });
  EXPECT_TRUE(holds(messageOf<FileError>([] { readLineLayer("missing.gpkg"); }),
    { "missing.gpkg", "no such file" }));
}
