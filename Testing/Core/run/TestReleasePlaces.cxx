// Rocks from points, lines, polygons and steep ground: how many, where, and always the same ones.

#include "base/errors.h"
#include "geometry/planeSampling.h"
#include "gisFiles.h"
#include "run/releasePlaces.h"
#include "slopes.h"

#include <cmath>
#include <numbers>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

using Rings = std::vector<std::vector<Vec3>>;

Vec3 at(double x, double y, double z = NAN)
{
  return { x, y, z };
}

/// An L with a hole, 4 × 4 less 2 × 2 at its upper right and 0.5 × 0.5 within: 11.75 m².
Rings holedL(double x, double y)
{
  return { { at(x, y), at(x + 4, y), at(x + 4, y + 2), at(x + 2, y + 2), at(x + 2, y + 4),
             at(x, y + 4), at(x, y) },
    { at(x + 0.5, y + 0.5), at(x + 0.5, y + 1), at(x + 1, y + 1), at(x + 1, y + 0.5) } };
}

bool inHoledL(double x, double y)
{
  const bool hole = x > 0.5 && x < 1 && y > 0.5 && y < 1;
  return x >= 0 && y >= 0 && x <= 4 && y <= 4 && !(x > 2 && y > 2) && !hole;
}

SourceRow source(SourceGeometry geometry, const Rings& parts)
{
  SourceRow row;
  row.row = 1;
  row.geometry = geometry;
  row.parts = parts;
  return row;
}

/// Flat to x = 100 m, then 45° up; its south-west node at (1000, 2000).
Terrain ground()
{
  const Terrain local =
    makeSlope(41, 5.0, [](double x, double) { return 50.0 + std::max(0.0, x - 100.0); });
  GridGeometry grid = local.geometry();
  grid.xOrigin = 1000.0;
  grid.yOrigin = 2000.0;
  return Terrain(grid, std::vector<double>(local.heights().begin(), local.heights().end()));
}

template <class Expected>
std::string failure(const std::vector<SourceRow>& rows, const ReleaseDefaults& defaults = {})
{
  return messageOf<Expected>(
    [&]
    {
      const Terrain terrain = ground();
      releasePlaces(rows, &terrain, defaults, "layer.gpkg");
    });
}

} // namespace

TEST(PlaneSampling, polygonIsFilledEvenly)
{
  const PolygonSampler polygon(holedL(0, 0));
  EXPECT_NEAR(polygon.area(), 11.75, 1e-12);
  // A regular grid of the three numbers: the share in any part is that of its area.
  const int n = 24;
  int all = 0, lowerRight = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < n * n * n; ++i)
  {
    const auto number = [&](int k) { return (k % n + 0.5) / n; };
    const Eigen::Vector2d p = polygon.at((i + 0.5) / (n * n * n), number(i / n), number(i));
    ASSERT_TRUE(inHoledL(p.x(), p.y())) << p.transpose();
    ++all;
    lowerRight += p.x() > 2;
    sum += p;
  }
  // A grid of 24 numbers resolves shares to about 1/24 of a trapezoid.
  EXPECT_NEAR(double(lowerRight) / all, 4.0 / 11.75, 0.01);
  // Centroid: (2·8 + 1·4 − 0.75·0.25)/11.75 along x, the same along y by symmetry.
  EXPECT_NEAR(sum.x() / all, (16.0 + 4.0 - 0.1875) / 11.75, 0.02);
  EXPECT_NEAR(sum.y() / all, (8.0 + 12.0 - 0.1875) / 11.75, 0.02);
}

TEST(PlaneSampling, triangleHeightsFollowTheWidth)
{
  // The share below the height s of a triangle that stands on its point is s².
  const PolygonSampler wedge({ { at(0, 0), at(3, 6), at(-3, 6) } });
  EXPECT_NEAR(wedge.area(), 18.0, 1e-12);
  for (double v : { 0.04, 0.25, 0.81 })
  {
    EXPECT_NEAR(wedge.at(0.5, v, 0.5).y(), 6.0 * std::sqrt(v), 1e-12);
    EXPECT_NEAR(wedge.at(0.5, v, 1.0).x(), 3.0 * std::sqrt(v), 1e-12);
  }
}

TEST(PlaneSampling, sidesThatCrossBoundWhatIsBetweenThem)
{
  // A bow tie, its crossing at (15, 20) beside no corner; and a star of five points, whose middle,
  // enclosed twice, is outside.
  const PolygonSampler bow({ { at(0, 0), at(30, 40), at(30, 0), at(0, 40) } });
  EXPECT_NEAR(bow.area(), 600.0, 1e-9);
  Rings star(1);
  for (int k = 0; k < 5; ++k)
  {
    const double angle = 0.3 + 0.8 * std::numbers::pi * k;
    star.front().push_back(at(10.0 * std::cos(angle), 10.0 * std::sin(angle)));
  }
  const PolygonSampler points(star);
  // With the radii R and r = R sin 18° / sin 54° of its ten corners: 5 R r sin 36° encloses once
  // all, 5/2 r² sin 72° the middle.
  const double inner = 10.0 * std::sin(std::numbers::pi / 10.0) / std::sin(0.3 * std::numbers::pi);
  EXPECT_NEAR(points.area(),
    50.0 * inner * std::sin(std::numbers::pi / 5.0) -
      2.5 * inner * inner * std::sin(0.4 * std::numbers::pi),
    1e-9);
  const int n = 24;
  for (int i = 0; i < n * n * n; ++i)
  {
    const auto number = [&](int k) { return (k % n + 0.5) / n; };
    const Eigen::Vector2d p = bow.at((i + 0.5) / (n * n * n), number(i / n), number(i));
    ASSERT_GE(std::abs(p.x() - 15.0) / 15.0, std::abs(p.y() - 20.0) / 20.0 - 1e-9) << p.transpose();
    const Eigen::Vector2d q = points.at((i + 0.5) / (n * n * n), number(i / n), number(i));
    ASSERT_GE(q.norm(), inner * std::cos(std::numbers::pi / 5.0) - 1e-9) << q.transpose();
  }
}

TEST(PlaneSampling, outlinesThatCrossThemselvesAreRefused)
{
  const auto refusal = [](const std::vector<Vec3>& corners)
  {
    return messageOf<DataError>(
      [&] { requireValidOutline(corners, "Points: the area is a POLYGON"); });
  };
  const std::string said =
    "Points: the area is a POLYGON that is not valid: its outline crosses or touches itself";
  EXPECT_EQ(refusal({ at(0, 0), at(30, 40), at(30, 0), at(0, 40) }), said);
  EXPECT_EQ(refusal({ at(0, 0), at(9, 0), at(9, 9), at(0, 0), at(9, 0), at(9, 9) }), said);
  EXPECT_NO_THROW(requireValidOutline({ at(0, 0), at(30, 0), at(30, 40), at(0, 40) }, "Points"));
  EXPECT_NO_THROW(requireValidOutline(holedL(1000, 2000).front(), "Points"));
}

TEST(PlaneSampling, lineByItsLengthInPlan)
{
  const LineSampler line({ { at(0, 0, 10), at(3, 4, 20) }, { at(10, 0, 0), at(10, 15, 30) } });
  EXPECT_DOUBLE_EQ(line.length(), 20.0);
  EXPECT_NEAR((line.at(0.125) - Vec3(1.5, 2.0, 15.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((line.at(0.5) - Vec3(10.0, 5.0, 10.0)).norm(), 0.0, 1e-12);
}

TEST(ReleasePlaces, amountsAndIntensities)
{
  const Terrain terrain = ground();
  ReleaseDefaults defaults;
  defaults.height = 0.25;
  std::vector<SourceRow> rows(2);
  rows[0].position = Vec3(1010, 2010, 77);
  rows[0].row = 1;
  rows[0].amount = 3;
  rows[1] = source(SourceGeometry::Polygon, holedL(1020, 2020));
  rows[1].row = 2;
  rows[1].intensity = 2.0; // 23.5 rocks
  const auto places = releasePlaces(rows, &terrain, defaults, "layer.gpkg");
  ASSERT_TRUE(places.size() == 3u + 23u || places.size() == 3u + 24u) << places.size();
  for (std::size_t k = 0; k < 3; ++k)
  {
    EXPECT_EQ(places[k].source, 0u);
    EXPECT_EQ(places[k].position, Vec3(1010, 2010, 77));
    EXPECT_FALSE(places[k].overGround);
  }
  for (std::size_t k = 3; k < places.size(); ++k)
  {
    EXPECT_EQ(places[k].source, 1u);
    EXPECT_TRUE(places[k].overGround);
    EXPECT_EQ(places[k].height, 0.25);
    EXPECT_TRUE(inHoledL(places[k].position.x() - 1020, places[k].position.y() - 2020));
  }
  // The same again, bit for bit; another seed is another draw.
  const auto again = releasePlaces(rows, &terrain, defaults, "layer.gpkg");
  ASSERT_EQ(again.size(), places.size());
  EXPECT_EQ(again.back().position.head<2>(), places.back().position.head<2>());
  defaults.seed = 2;
  const auto other = releasePlaces(rows, &terrain, defaults, "layer.gpkg");
  EXPECT_NE(other[3].position.x(), places[3].position.x());
  // On the ground, whatever z says.
  defaults.onGround = true;
  EXPECT_TRUE(releasePlaces(rows, &terrain, defaults, "layer.gpkg")[0].overGround);
}

TEST(ReleasePlaces, aRowDoesNotChangeTheRocksOfAnother)
{
  const Terrain terrain = ground();
  std::vector<SourceRow> rows(2, source(SourceGeometry::Polygon, holedL(1020, 2020)));
  rows[1].row = 2;
  rows[0].amount = 5;
  rows[1].amount = 5;
  const auto before = releasePlaces(rows, &terrain, {}, "layer.gpkg");
  rows[0].amount = 9;
  const auto after = releasePlaces(rows, &terrain, {}, "layer.gpkg");
  for (std::size_t k = 0; k < 5; ++k)
  {
    EXPECT_EQ(after[9 + k].position.head<2>(), before[5 + k].position.head<2>());
  }
  EXPECT_NE(before[0].position.x(), before[5].position.x());
}

TEST(ReleasePlaces, whatReachesBeyondTheTerrain)
{
  const Terrain terrain = ground();
  // Half of the square is west of the terrain.
  const Rings half = { { at(990, 2010), at(1010, 2010), at(1010, 2030), at(990, 2030) } };
  SourceRow row = source(SourceGeometry::Polygon, half);
  row.intensity = 1.0; // 400 rocks, of which 200 ± 10
  auto places = releasePlaces({ &row, 1 }, &terrain, {}, "layer.gpkg");
  EXPECT_NEAR(double(places.size()), 200.0, 50.0); // five standard deviations
  row.intensity.reset();
  row.amount = 100;
  places = releasePlaces({ &row, 1 }, &terrain, {}, "layer.gpkg");
  EXPECT_EQ(places.size(), 100u);
  for (const ReleasePlace& place : places)
  {
    EXPECT_GE(place.position.x(), 1000.0);
  }
}

TEST(ReleasePlaces, areaOfAPolygonOnTheTerrain)
{
  const Terrain whole = ground();
  const auto area = [](const Rings& rings, const Terrain* terrain)
  { return areaOnTerrain(source(SourceGeometry::Polygon, rings), terrain); };
  EXPECT_NEAR(area(holedL(1020, 2020), &whole), 11.75, 1e-9);
  // A square on its corner, over the terrain's corner, and one that is nowhere on it.
  const Rings corner = { { at(990, 2000), at(1000, 1990), at(1010, 2000), at(1000, 2010) } };
  EXPECT_NEAR(area(corner, &whole), 50.0, 1e-9);
  EXPECT_NEAR(area(corner, nullptr), 200.0, 1e-9);
  EXPECT_EQ(area(holedL(900, 2000), &whole), 0.0);

  // Nodata at a node in the middle, and all along the east.
  std::vector<double> heights(whole.heights().begin(), whole.heights().end());
  for (int row = 0; row < 41; ++row)
  {
    heights[std::size_t(row) * 41 + 40] = NAN;
  }
  heights[20 * 41 + 20] = NAN;
  const Terrain gaps(whole.geometry(), heights);
  std::int64_t cfes = 0;
  for (std::int64_t cfe = 1; cfe <= gaps.cfeCapacity(); ++cfe)
  {
    cfes += gaps.hasCfe(cfe);
  }
  const Rings all = { { at(900, 1900), at(1300, 1900), at(1300, 2300), at(900, 2300) } };
  EXPECT_NEAR(area(all, &gaps), 12.5 * double(cfes), 1e-7);
  // Over the gap in the middle, with a hole and sides across the cells, by a count of places.
  const Rings over = { { at(1091, 2096), at(1107, 2089), at(1109, 2108), at(1094, 2103) },
    { at(1097, 2098), at(1101, 2097), at(1099, 2101) } };
  const double step = 0.01;
  const double x0 = 1091.0, y0 = 2089.0;
  double counted = 0.0;
  for (double y = y0 + 0.5 * step; y < y0 + 19.0; y += step)
  {
    for (double x = x0 + 0.5 * step; x < x0 + 18.0; x += step)
    {
      bool inside = false;
      for (const std::vector<Vec3>& ring : over)
      {
        for (std::size_t k = 0; k < ring.size(); ++k)
        {
          const Vec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
          inside ^= (a.y() > y) != (b.y() > y) &&
            x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        }
      }
      counted += inside && gaps.cfeAt(x - 1000.0, y - 2000.0) != 0 ? step * step : 0.0;
    }
  }
  EXPECT_GT(area(over, nullptr), counted + 30.0);
  EXPECT_NEAR(area(over, &gaps), counted, 0.05);
  // Where rocks of an intensity are.
  SourceRow row = source(SourceGeometry::Polygon, over);
  row.intensity = 50.0;
  const double rocks = double(releasePlaces({ &row, 1 }, &gaps, {}, "layer.gpkg").size());
  EXPECT_NEAR(rocks, 50.0 * counted, 5.0 * std::sqrt(50.0 * counted)); // five standard deviations
}

TEST(ReleasePlaces, steepCells)
{
  const Terrain terrain = ground();
  ReleaseDefaults defaults;
  defaults.amount = 400;
  const auto places = steepPlaces(terrain, radians(44.0), defaults);
  ASSERT_EQ(places.size(), 400u);
  double sum = 0.0;
  for (const ReleasePlace& place : places)
  {
    EXPECT_GE(place.position.x(), 1100.0);
    EXPECT_LE(place.position.x(), 1200.0);
    EXPECT_TRUE(place.overGround);
    sum += place.position.x();
  }
  // Evenly over 100 m: standard deviation 28.9/√400 = 1.44 m; four of them.
  EXPECT_NEAR(sum / 400.0, 1150.0, 5.8);
  defaults.intensity = 0.01; // 100 × 200 m²
  EXPECT_EQ(steepPlaces(terrain, radians(44.0), defaults).size(), 200u);
  EXPECT_TRUE(holds(messageOf<DataError>([&] { steepPlaces(terrain, radians(46.0), defaults); }),
    { "SlopeThreshold is 46", "no CFE" }));
  defaults.intensity = 1e6;
  EXPECT_TRUE(
    holds(messageOf<ParameterError>([&] { steepPlaces(terrain, radians(44.0), defaults); }),
      { "20000 m²", "2e+10 rocks", "MaximumRocks", "160000 GB" }));
}

TEST(ReleasePlaceErrors, namedWithTheirRow)
{
  SourceRow row = source(SourceGeometry::Polygon, holedL(1020, 2020));
  row.amount = 12000000;
  EXPECT_TRUE(holds(failure<ParameterError>({ row }),
    { "layer.gpkg", "row 1", "12000000 rocks", "MaximumRocks", "1000000", "96 GB" }));
  row.amount = 0;
  EXPECT_TRUE(holds(failure<DataError>({ row }), { "layer.gpkg", "no rock" }));
  row.amount.reset();
  row.parts = { { at(1020, 2020), at(1030, 2020), at(1020, 2020) } };
  EXPECT_TRUE(holds(failure<DataError>({ row }), { "row 1", "no area" }));
  row.geometry = SourceGeometry::Line;
  row.parts = { { at(1020, 2020), at(1020, 2020) } };
  EXPECT_TRUE(holds(failure<DataError>({ row }), { "row 1", "no length" }));
  row.parts = { { at(0, 0), at(10, 0) } };
  EXPECT_TRUE(holds(failure<DataError>({ row }), { "row 1", "x 0 to 10", "x 1000 to 1200" }));
  SourceRow point;
  point.row = 4;
  point.position = at(900, 2010);
  EXPECT_TRUE(holds(failure<DataError>({ point }), { "row 4", "900, 2010", "x 1000 to 1200" }));
  const Terrain terrain = ground();
  EXPECT_TRUE(holds(messageOf<DataError>(
                      [&] {
                        requireOverlap({ &point, 1 }, terrain, "layer.gpkg", "");
                      }),
    { "layer.gpkg", "do not overlap", "x 900 to 900, y 2010 to 2010",
      "x 1000 to 1200, y 2000 to 2200", "does not say in which CRS" }));
  ReleaseDefaults bad;
  bad.amount = 0;
  EXPECT_TRUE(holds(failure<ParameterError>({ point }, bad), { "Amount is 0" }));
  bad.amount = 1;
  bad.intensity = NAN;
  EXPECT_TRUE(holds(failure<ParameterError>({ point }, bad), { "Intensity is nan" }));
  bad.intensity = 0.0;
  bad.height = -1.0;
  EXPECT_TRUE(holds(failure<ParameterError>({ point }, bad), { "ReleaseHeight is -1" }));
  bad.height = 0.0;
  bad.mostRocks = 0;
  EXPECT_TRUE(holds(failure<ParameterError>({ point }, bad), { "MaximumRocks is 0" }));
}

TEST(ReleasePlaces, aDrawnLineWithoutLengthIsNamed)
{
  const SourceRow row = source(SourceGeometry::Line, { { at(1010, 2010), at(1010, 2010) } });
  EXPECT_EQ(messageOf<DataError>(
              [&] {
                releasePlaces({ &row, 1 }, nullptr, {}, "");
              }),
    "Points: the line has no length");
}
