/// @file
/// Rasters that have to be brought to square north-up metric nodes, against surfaces known in
/// closed form. The projection is checked against Krüger's series, not against PROJ itself.

#include "gis/raster/raster.h"
#include "gisFiles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

struct Place
{
  double east, north; // m
};

/// UTM on WGS 84 by Krüger's series in n up to n⁴ (error < 0.1 mm within a zone).
Place toUtm(double longitude, double latitude, int zone)
{
  constexpr double a = 6378137.0, f = 1.0 / 298.257223563, k0 = 0.9996;
  constexpr double n = f / (2.0 - f), n2 = n * n, n3 = n2 * n, n4 = n3 * n;
  const double radius = a / (1.0 + n) * (1.0 + n2 / 4.0 + n4 / 64.0);
  const double alpha[4] = { n / 2.0 - 2.0 * n2 / 3.0 + 5.0 * n3 / 16.0 + 41.0 * n4 / 180.0,
    13.0 * n2 / 48.0 - 3.0 * n3 / 5.0 + 557.0 * n4 / 1440.0, 61.0 * n3 / 240.0 - 103.0 * n4 / 140.0,
    49561.0 * n4 / 161280.0 };
  const double phi = radians(latitude), lambda = radians(longitude - (6.0 * zone - 183.0));
  const double e = 2.0 * std::sqrt(n) / (1.0 + n);
  const double t = std::sinh(std::atanh(std::sin(phi)) - e * std::atanh(e * std::sin(phi)));
  const double xi = std::atan2(t, std::cos(lambda));
  const double eta = std::asinh(std::sin(lambda) / std::hypot(t, std::cos(lambda)));
  double north = xi, east = eta;
  for (int j = 1; j <= 4; ++j)
  {
    north += alpha[j - 1] * std::sin(2 * j * xi) * std::cosh(2 * j * eta);
    east += alpha[j - 1] * std::cos(2 * j * xi) * std::sinh(2 * j * eta);
  }
  return { 500000.0 + k0 * radius * east, (latitude < 0.0 ? 1e7 : 0.0) + k0 * radius * north };
}

/// Largest difference from a surface over all nodes that have a height.
double largestError(
  const RasterSurface& surface, const std::function<double(double, double)>& height)
{
  const GridGeometry& g = surface.geometry;
  double worst = 0.0;
  for (int row = 0; row < g.rows; ++row)
  {
    for (int column = 0; column < g.columns; ++column)
    {
      const double z = surface.heights[std::size_t(row) * g.columns + column];
      if (!std::isnan(z))
      {
        const double x = g.xOrigin + column * g.cellSize;
        const double y = g.yOrigin + (g.rows - 1 - row) * g.cellSize;
        worst = std::max(worst, std::abs(z - height(x, y)));
      }
    }
  }
  return worst;
}

std::int64_t withHeight(const RasterSurface& surface)
{
  return std::count_if(surface.heights.begin(), surface.heights.end(),
    [](double height) { return !std::isnan(height); });
}

double plane(double x, double y)
{
  return 1000.0 + 0.5 * (x - 600000.0) - 0.3 * (y - 5100000.0);
}

/// `columns` × `rows` nodes of 10 m in UTM zone 32, on the plane.
RawRaster onPlane(int columns, int rows)
{
  RawRaster raster;
  raster.columns = columns;
  raster.rows = rows;
  raster.affine = { 600000.0, 10.0, 0.0, 5100000.0 + 10.0 * rows, 0.0, -10.0 };
  raster.crs = "EPSG:32632";
  raster.fill(plane);
  return raster;
}

/// One second of arc, as SRTM and Copernicus have it.
RawRaster oneSecond(double west, double north)
{
  RawRaster raster;
  raster.columns = 60;
  raster.rows = 50;
  raster.affine = { west, 1.0 / 3600.0, 0.0, north, 0.0, -1.0 / 3600.0 };
  raster.crs = "EPSG:4326";
  return raster;
}

TEST(RasterResampling, geographicPlaneKeepsItsPlace)
{
  struct Case
  {
    double west, north;
    int zone;
    const char* code;
  };
  // Alps; Andes (south); Fiji, across the antimeridian; Bergen, in Norway's wide zone 32; Caucasus
  // with longitudes counted beyond 360.
  for (const Case& site : { Case{ 7.6, 46.6, 32, "32632" }, Case{ -70.1, -33.2, 19, "32719" },
         Case{ 179.99, -17.0, 60, "32760" }, Case{ 5.3, 60.4, 32, "32632" },
         Case{ 44.5 - 360.0, 42.7, 38, "32638" } })
  {
    RawRaster raster = oneSecond(site.west, site.north);
    // The antimeridian's other side belongs to the same zone as the centre: z has no step there.
    const Place centre = toUtm(site.west + 30.0 / 3600.0, site.north - 25.0 / 3600.0, site.zone);
    const auto height = [&centre](double east, double north)
    { return 1500.0 + 0.5 * (east - centre.east) + 0.3 * (north - centre.north); };
    raster.fill(
      [&](double longitude, double latitude)
      {
        const Place p = toUtm(longitude, latitude, site.zone);
        return height(p.east, p.north);
      });
    const RasterSurface surface = readRaster(raster.write());
    // A plane is not one in longitude and latitude: bending h² tan φ / (8 R) · slope ~ 1e-5 m, and
    // 1e-4 of a 31 m cell for interpolating the projection: 2 mm. Half a cell's shift would be 5 m.
    EXPECT_LT(largestError(surface, height), 3e-3) << site.code;
    EXPECT_TRUE(holds(surface.geometry.crs, { site.code }));
    ASSERT_FALSE(surface.notes.empty());
    EXPECT_TRUE(holds(surface.notes[0],
      { "EPSG:4326", "60 x 50", std::string("EPSG:") + site.code, "bilinear", "m, " }));
    // As many nodes as the file has, but for the rim.
    EXPECT_GT(withHeight(surface), 0.9 * 60 * 50) << site.code;
    EXPECT_LE(withHeight(surface), 1.1 * 60 * 50) << site.code;
    const double k = surface.geometry.xOrigin / surface.geometry.cellSize;
    EXPECT_NEAR(k, std::round(k), 1e-6);
  }
}

TEST(RasterResampling, geographicHillsWithinTheBilinearBound)
{
  const auto hills = [](double east, double north)
  {
    return 1000.0 +
      100.0 * std::sin(2.0 * std::numbers::pi * east / 2000.0) *
      std::cos(2.0 * std::numbers::pi * north / 3000.0);
  };
  RawRaster raster = oneSecond(7.6, 46.6);
  raster.fill(
    [&](double longitude, double latitude)
    {
      const Place p = toUtm(longitude, latitude, 32);
      return hills(p.east, p.north);
    });
  const RasterSurface surface = readRaster(raster.write(), { .cellSize = 20.0 });
  EXPECT_EQ(surface.geometry.cellSize, 20.0);
  // Bilinear: (hx² |zxx| + hy² |zyy|) / 8 with cells of 21.3 × 30.9 m and curvatures of 100
  // (2π/2000)² and 100 (2π/3000)² per m: 0.108 m; a little for the turn of the grid (1.2° of
  // convergence).
  EXPECT_LT(largestError(surface, hills), 0.115);
  EXPECT_GT(largestError(surface, hills), 0.01); // so the test sees the interpolation at all
}

TEST(RasterResampling, polesGoToUps)
{
  RawRaster raster = oneSecond(20.0, -81.0);
  raster.fill([](double, double) { return 100.0; });
  EXPECT_TRUE(holds(readRaster(raster.write()).geometry.crs, { "32761" }));
}

TEST(RasterResampling, projectedFeetBecomeMetres)
{
  RawRaster raster = onPlane(30, 20);
  for (double& a : raster.affine)
  {
    a /= surveyFoot;
  }
  raster.crs = "+proj=utm +zone=32 +datum=WGS84 +units=us-ft";
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_NEAR(surface.geometry.cellSize, 10.0, 1e-12);
  EXPECT_LT(largestError(surface, plane), 1e-3); // 1e-4 of a 10 m cell, slope 0.6
  ASSERT_EQ(surface.notes.size(), 2u);
  EXPECT_TRUE(holds(surface.notes[0], { "is in feet", "heights", "taken as metres" }));
  EXPECT_TRUE(holds(surface.notes[1], { "foot", "EPSG:32632" }));
}

TEST(RasterResampling, webMercatorIsNoMetre)
{
  constexpr double radius = 6378137.0;
  RawRaster raster;
  raster.columns = 40;
  raster.rows = 40;
  raster.affine = { 1145800.0, 30.0, 0.0, 5789000.0, 0.0, -30.0 };
  raster.crs = "EPSG:3857";
  raster.fill(
    [](double x, double y)
    {
      const Place p = toUtm(degrees(x / radius), degrees(std::atan(std::sinh(y / radius))), 32);
      return plane(p.east, p.north);
    });
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_LT(largestError(surface, plane), 4e-3);
  EXPECT_NEAR(surface.geometry.cellSize, 30.0 * 0.695, 0.1); // cos 46°, nearly
  EXPECT_TRUE(holds(surface.notes[0], { "EPSG:3857", "on the ground" }));
}

TEST(RasterResampling, shearedProjection)
{
  // Sinusoidal: lengths along parallels and the spacing of parallels are true, angles are not.
  constexpr double radius = 6378137.0;
  RawRaster raster;
  raster.columns = 40;
  raster.rows = 40;
  raster.crs = "+proj=sinu +lon_0=0 +R=6378137 +units=m";
  const double north = radians(46.5) * radius,
               east = radians(10.0) * radius * std::cos(radians(46.5));
  raster.affine = { east, 30.0, 0.0, north, 0.0, -30.0 };
  raster.fill([](double, double) { return 500.0; });
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_TRUE(holds(surface.notes[0], { "axes are not square on the ground" }));
}

TEST(RasterResampling, turnedRaster)
{
  RawRaster raster = onPlane(40, 30);
  const double c = 10.0 * std::cos(radians(30.0)), s = 10.0 * std::sin(radians(30.0));
  raster.affine = { 600000.0, c, s, 5100000.0, s, -c };
  raster.fill(plane);
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_EQ(surface.geometry.cellSize, 10.0);
  EXPECT_LT(largestError(surface, plane), 1e-8); // rounding of 5e6 m times a few operations
  EXPECT_NEAR(double(withHeight(surface)), 39.0 * 29.0, 70.0); // the area, give or take its rim
  EXPECT_TRUE(holds(surface.notes[0], { "30 degrees", "40 x 30", "bilinear" }));
}

TEST(RasterResampling, quarterTurnIsExact)
{
  RawRaster raster = onPlane(3, 2);
  raster.affine = { 600000.0, 0.0, 10.0, 5100000.0, 10.0, 0.0 }; // columns to the north
  raster.values = { 1.0, 2.0, 3.0, 4.0, 5.0, 6.0 };
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_EQ(surface.geometry.columns, 2);
  EXPECT_EQ(surface.heights, (std::vector<double>{ 3.0, 6.0, 2.0, 5.0, 1.0, 4.0 }));
}

TEST(RasterResampling, cellsThatAreNotSquare)
{
  RawRaster raster = onPlane(20, 10);
  raster.affine = { 600000.0, 10.0, 0.0, 5100200.0, 0.0, -20.0 };
  raster.fill(plane);
  const RasterSurface surface = readRaster(raster.write());
  EXPECT_EQ(surface.geometry.cellSize, 10.0);
  EXPECT_EQ(surface.geometry.columns, 20);
  EXPECT_EQ(surface.geometry.rows, 19);
  EXPECT_EQ(withHeight(surface), 20 * 19);
  EXPECT_LT(largestError(surface, plane), 1e-8);
  EXPECT_TRUE(holds(surface.notes[0], { "not square", "10 x 20 m", "20 x 19 nodes of 10 m" }));
}

TEST(RasterResampling, finerCells)
{
  const RasterSurface surface = readRaster(onPlane(5, 4).write(), { .cellSize = 4.0 });
  EXPECT_EQ(surface.geometry.columns, 11);
  EXPECT_EQ(surface.geometry.rows, 8);
  EXPECT_EQ(surface.geometry.xOrigin, 600005.0);
  EXPECT_EQ(surface.geometry.yOrigin, 5100005.0);
  EXPECT_EQ(withHeight(surface), 88);
  EXPECT_LT(largestError(surface, plane), 1e-8);
  EXPECT_TRUE(holds(surface.notes[0], { "4 m was asked for", "5 x 4", "11 x 8", "bilinear" }));
}

TEST(RasterResampling, coarserCellsAreMeans)
{
  RawRaster raster = onPlane(6, 6);
  for (int i = 0; i < 36; ++i)
  {
    raster.values[i] = i;
  }
  const RasterSurface surface = readRaster(raster.write(), { .cellSize = 30.0 });
  EXPECT_EQ(surface.geometry.columns, 2);
  EXPECT_EQ(surface.geometry.rows, 2);
  EXPECT_EQ(surface.geometry.xOrigin, 600015.0);
  EXPECT_EQ(surface.geometry.yOrigin, 5100015.0);
  EXPECT_EQ(surface.heights, (std::vector<double>{ 7.0, 10.0, 25.0, 28.0 }));
  EXPECT_TRUE(holds(surface.notes[0], { "3 x 3 bilinear", "30 m was asked for" }));
}

TEST(RasterResampling, sameCellSizeIsNoResampling)
{
  const RawRaster raster = onPlane(5, 4);
  const RasterSurface surface = readRaster(raster.write(), { .cellSize = 10.0 });
  EXPECT_EQ(surface.heights, raster.values);
  EXPECT_TRUE(surface.notes.empty());
}

/// A flat raster at 100 m with one node of nodata at row 4, column 5.
RawRaster withHole()
{
  RawRaster raster = onPlane(11, 9);
  raster.values.assign(99, 100.0);
  raster.values[4 * 11 + 5] = -9999.0;
  raster.band = "<NoDataValue>-9999</NoDataValue>";
  return raster;
}

TEST(RasterResampling, nodataDoesNotBleed)
{
  for (const double cellSize : { 3.0, 4.0, 5.0, 7.0 })
  {
    const RasterSurface surface = readRaster(withHole().write(), { .cellSize = cellSize });
    const GridGeometry& g = surface.geometry;
    for (int row = 0; row < g.rows; ++row)
    {
      for (int column = 0; column < g.columns; ++column)
      {
        // The hole is 50 m east and 40 m north of the first node; its neighbourhood is open: a node
        // that stands on a neighbour keeps that neighbour's height.
        const bool touches = std::abs(column * cellSize - 50.0) < 10.0 &&
          std::abs((g.rows - 1 - row) * cellSize - 40.0) < 10.0;
        const double z = surface.heights[std::size_t(row) * g.columns + column];
        EXPECT_TRUE(touches ? std::isnan(z) : std::abs(z - 100.0) < 1e-12) << z;
      }
    }
  }
}

TEST(RasterResampling, nodataDoesNotBleedIntoMeans)
{
  const RasterSurface surface = readRaster(withHole().write(), { .cellSize = 30.0 });
  // The hole lies in one cell; the mean of its other eight nodes would be a height of fewer.
  EXPECT_EQ(withHeight(surface), std::int64_t(surface.heights.size()) - 1);
  EXPECT_LT(largestError(surface, [](double, double) { return 100.0; }), 1e-12);
}

TEST(RasterResampling, nodataDoesNotBleedInReprojection)
{
  RawRaster raster = oneSecond(7.6, 46.6);
  raster.fill([](double, double) { return 100.0; });
  raster.values[25 * 60 + 30] = -32768.0;
  raster.type = "Int16";
  raster.band = "<NoDataValue>-32768</NoDataValue>";
  const RasterSurface surface = readRaster(raster.write());
  // Flat to the last digit of a weighted mean wherever there is a height.
  EXPECT_LT(largestError(surface, [](double, double) { return 100.0; }), 1e-12);
  const GridGeometry& g = surface.geometry;
  const Place hole = toUtm(7.6 + 30.5 / 3600.0, 46.6 - 25.5 / 3600.0, 32);
  const int column = int(std::round((hole.east - g.xOrigin) / g.cellSize));
  const int row = g.rows - 1 - int(std::round((hole.north - g.yOrigin) / g.cellSize));
  EXPECT_TRUE(std::isnan(surface.heights[std::size_t(row) * g.columns + column]));
  EXPECT_FALSE(std::isnan(surface.heights[std::size_t(row) * g.columns + column + 3]));
  EXPECT_TRUE(holds(surface.notes.back(), { "nodes have no data" }));
}

} // namespace

} // namespace rockfall
