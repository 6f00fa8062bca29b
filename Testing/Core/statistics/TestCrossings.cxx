// Collectors: a parabola through a line in closed form, a walk along random curves, and what a
// barrier catches.

#include "hermitePaths.h"

#include "base/errors.h"
#include "form.h"
#include "statistics/crossings.h"
#include "terrain/Terrain.h"

#include <gtest/gtest.h>

#include <limits>

using namespace rockfall;
using rockfall::testing::g;
using rockfall::testing::hops;
using rockfall::testing::rockPathOf;
using rockfall::testing::wild;

namespace
{

std::vector<Crossing> crossingsOf(const RockPath& path, const CollectorLine& line)
{
  std::vector<Crossing> found;
  appendCrossings(path, line, 0, nullptr, found);
  return found;
}

CollectorLine lineOf(std::vector<Eigen::Vector2d> points)
{
  CollectorLine line;
  line.points = std::move(points);
  return line;
}

} // namespace

/// A cube of 2 m that stands on a corner over a slope of 1 in 5: its centre is √3 m over its lowest
/// vertex, its top as far above the centre.
TEST(Crossings, TopOfTheRock)
{
  std::vector<double> heights;
  for (int row = 0; row < 5; ++row)
  {
    for (int column = 0; column < 5; ++column)
    {
      heights.push_back(2.0 * column);
    }
  }
  const Terrain terrain({ 5, 5, 10.0, 0.0, 0.0, "" }, heights);
  const double radius = std::sqrt(3.0);
  std::vector<PathPoint> points(2);
  for (int k = 0; k < 2; ++k)
  {
    points[k].time = k;
    points[k].position = Vec3(10.0 + 10.0 * k, 20.0, 2.0 + 2.0 * k + 3.0 + radius);
    points[k].velocity = Vec3(10.0, 0.0, 2.0);
    points[k].heightOverGround = 3.0;
  }
  std::vector<Crossing> found;
  appendCrossings(
    rockPathOf(points, 0, 0, 1.0), lineOf({ { 15, 0 }, { 15, 40 } }), 0, &terrain, found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].centreOverGround, 3.0 + radius, 1e-12);
  EXPECT_NEAR(topOverGround(found[0], 2.0), 3.0 + 2.0 * radius, 1e-12);
  // Without a slope the width is known alone.
  found = crossingsOf(rockPathOf(points, 0, 0, 1.0), lineOf({ { 15, 0 }, { 15, 40 } }));
  EXPECT_NEAR(topOverGround(found[0], 2.0), 5.0, 1e-12);
}

TEST(Crossings, ParabolaThroughALine)
{
  const double mass = 2000.0, spin = 700.0;
  // Thrown with (10, 5, 8) m/s from (0, 0, 3); the line x = 6 from y = −20 to y = 20, then away.
  const CollectorLine line = lineOf({ { 6, -20 }, { 6, 20 }, { 30, 20 } });
  for (const double interval : { 100.0, 0.013 })
  {
    const auto points = hops(interval, { 0, 0, 3 }, { 10, 5, 8 }, mass, spin, 0);
    const auto found = crossingsOf(rockPathOf(points, 4, 2, mass), line);
    ASSERT_EQ(found.size(), 1u);
    const Crossing& c = found[0];
    const double t = 0.6, vz = 8.0 - g * t;
    // Coefficients of pieces of 13 ms are good to 1e-12 of a speed.
    EXPECT_NEAR(c.time, t, 1e-10);
    EXPECT_NEAR((c.position - Vec3(6, 3, 3.0 + 8.0 * t - 0.5 * g * t * t)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(c.distance, 23.0, 1e-9);
    EXPECT_EQ(c.direction, -1); // the line runs north, the rock goes to its right
    EXPECT_NEAR((c.velocity - Vec3(10, 5, vz)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(c.translationalEnergy, 0.5 * mass * (125.0 + vz * vz), 1e-5);
    EXPECT_NEAR(c.kineticEnergy - c.translationalEnergy, spin, 1e-5);
    EXPECT_NEAR(c.heightOverGround, c.position.z(), 1e-9);
    EXPECT_NEAR(c.horizontalAngle, std::atan2(5.0, 10.0), 1e-10);
    EXPECT_NEAR(c.verticalAngle, std::atan2(vz, std::sqrt(125.0)), 1e-10);
    EXPECT_EQ(c.iteration, 4);
    EXPECT_EQ(c.rock, 2);
    EXPECT_EQ(c.blockId, 102);
  }
}

TEST(Crossings, BackAndForthAndAtKnots)
{
  // A path of straight pieces whose knots lie on the line: through it, along it, back, touching.
  const CollectorLine line = lineOf({ { 0, 0 }, { 0, 10 } });
  const double xs[] = { -2, 0, 2, 0, 0, -2, 0, -2, 0, 3 };
  std::vector<PathPoint> points;
  for (std::size_t k = 0; k < std::size(xs); ++k)
  {
    PathPoint p;
    p.time = double(k);
    p.position = Vec3(xs[k], 1.0 + 0.5 * double(k), 0.0);
    points.push_back(p); // velocity 0: every piece eases in and out, its x monotone
  }
  const auto found = crossingsOf(rockPathOf(points, 0, 0, 1.0), line);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].direction, -1);
  EXPECT_NEAR(found[0].time, 1.0, 1e-12);
  EXPECT_EQ(found[1].direction, 1);
  EXPECT_NEAR(found[1].time, 4.0, 1e-12); // lay on it from 3 to 4 s, then left on the other side
  EXPECT_EQ(found[2].direction, -1);
  EXPECT_NEAR(found[2].time, 8.0, 1e-12); // at 6 s it only touched
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_EQ(found[std::size_t(k)].number, k);
  }
}

TEST(Crossings, WhatEndsOnTheLineHasNotCrossedIt)
{
  // A net catches a rock on its line, on either side of it by rounding.
  const CollectorLine line = lineOf({ { 10, -20 }, { 10, 20 } });
  for (const double beyond : { -1e-9, 0.0, 1e-9, 1e-3 })
  {
    std::vector<PathPoint> points(2);
    points[0].velocity = points[1].velocity = Vec3((10.0 + beyond) / 2.0, 0.0, 0.0);
    points[1].time = 2.0;
    points[1].position.x() = 10.0 + beyond;
    EXPECT_EQ(crossingsOf(rockPathOf(points, 0, 0, 1.0), line).size(), beyond > 1e-6 ? 1u : 0u);
  }
}

TEST(Crossings, WhatBeginsOnTheLineHasNotCrossedIt)
{
  // A rock that is released on the line falls along it, on either side of it by rounding or by the
  // swing of a cubic, then goes.
  const CollectorLine line = lineOf({ { 10, -20 }, { 10, 20 } });
  for (const double first : { -1e-7, -1e-12, 0.0, 1e-12, 1e-7 })
  {
    for (const double away : { -5.0, 5.0 })
    {
      std::vector<PathPoint> points(4);
      const double xs[] = { first, -2.0 * first, first, away };
      for (std::size_t k = 0; k < points.size(); ++k)
      {
        points[k].time = double(k);
        points[k].position.x() = 10.0 + xs[k];
      }
      points[2].velocity.x() = 0.02; // comes to it as from the other side, by 3 mm
      EXPECT_TRUE(crossingsOf(rockPathOf(points, 0, 0, 1.0), line).empty()) << first << " " << away;
      points.push_back(points.back()); // and back over it
      points.back().time = 5.0;
      points.back().position.x() = 10.0 - away;
      EXPECT_EQ(crossingsOf(rockPathOf(points, 0, 0, 1.0), line).size(), 1u);
    }
  }
}

TEST(Crossings, ThroughAVertex)
{
  // Through a vertex of the line, or up to it and off elsewhere, with and without a knot there: one
  // passing if it goes from one side of the line to the other, none or as many back if not.
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> turn(-M_PI, M_PI), way(5.0, 60.0), speed(1.0, 20.0);
  const auto towards = [](double angle)
  { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
  const auto left = [](double angle, double in, double out)
  {
    const auto from = [out](double a)
    { return a - out - 2 * M_PI * std::floor((a - out) / (2 * M_PI)); };
    return from(angle) < from(in); // between the line's way on and its way back
  };
  int passed = 0;
  for (int trial = 0; trial < 4000; ++trial)
  {
    const Eigen::Vector2d vertex =
      trial % 4 == 0 ? Eigen::Vector2d(100.0, 50.0) : Eigen::Vector2d(100.1 + way(random), 50.7);
    const double in = turn(random), out = turn(random), from = turn(random);
    const bool knot = trial % 2, bent = trial % 3 == 0 && knot;
    const double to = bent ? turn(random) : from + M_PI;
    const auto apart = [](double a, double b) { return std::abs(std::remainder(a - b, 2 * M_PI)); };
    if (apart(in, out) < 0.01 ||
      std::min({ apart(from, in), apart(from, out), apart(to, in), apart(to, out) }) < 0.001)
    {
      continue;
    }
    const double v = speed(random);
    const auto point = [&](double angle, double distance, double time, double along)
    {
      PathPoint p;
      p.position << vertex + distance * towards(angle), 0.0;
      p.velocity << v * towards(along), 0.0;
      p.time = time;
      return p;
    };
    const double before = way(random), after = way(random);
    std::vector<PathPoint> points = { point(from, before, 0.0, from + M_PI) };
    if (knot)
    {
      points.push_back(point(0.0, 0.0, before / v, from + M_PI));
      points.push_back(point(0.0, 0.0, before / v, to));
    }
    points.push_back(point(to, after, (before + after) / v, to));
    const CollectorLine line =
      lineOf({ vertex + way(random) * towards(in), vertex, vertex + way(random) * towards(out) });
    const auto found = crossingsOf(rockPathOf(points, 0, 0, 1.0), line);
    const int change = int(left(to, in, out)) - int(left(from, in, out));
    ASSERT_EQ(found.size(), std::size_t(std::abs(change))) << trial;
    if (change != 0)
    {
      ++passed;
      EXPECT_EQ(found[0].direction, change) << trial;
      EXPECT_NEAR((found[0].position.head<2>() - vertex).norm(), 0.0, 1e-5) << trial;
      EXPECT_NEAR(found[0].distance, (line.points[0] - vertex).norm(), 1e-5) << trial;
    }
  }
  EXPECT_GT(passed, 1000);
}

TEST(Crossings, KnotsOnAnObliqueLine)
{
  // A path whose own vertex is on the line but for rounding passes there.
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> place(0.1, 0.9), turn(0.1, 3.0), speed(0.5, 20.0);
  const CollectorLine line = lineOf({ { 101.3, 7.7 }, { 317.9, 211.1 } });
  const Eigen::Vector2d way = line.points[1] - line.points[0];
  const double angle = std::atan2(way.y(), way.x());
  for (int trial = 0; trial < 2000; ++trial)
  {
    const Eigen::Vector2d knot = line.points[0] + place(random) * way;
    std::vector<PathPoint> points(3);
    double on = 0.0; // towards the left of the line
    for (std::size_t k = 0; k < 3; ++k)
    {
      on = k == 1 ? on : angle + turn(random);
      points[k].time = double(k);
      points[k].position << knot, 0.0;
      points[k].velocity = speed(random) * Vec3(std::cos(on), std::sin(on), 0.0);
      points[k].position += (double(k) - 1.0) * points[k].velocity;
    }
    const auto found = crossingsOf(rockPathOf(points, 0, 0, 1.0), line);
    ASSERT_EQ(found.size() % 2, 1u) << trial; // the curve may swing over the line and back
    double nearest = 1.0;
    for (const Crossing& crossing : found)
    {
      nearest = std::min(nearest, (crossing.position.head<2>() - knot).norm());
    }
    EXPECT_LT(nearest, 1e-9) << trial;
  }
}

TEST(Crossings, EndsAtAVertexAndComesAlongTheLine)
{
  const CollectorLine line = lineOf({ { 0, 0 }, { 10, 0 }, { 20, 10 } });
  const auto passings = [&](const std::vector<Eigen::Vector2d>& places)
  {
    std::vector<PathPoint> points(places.size());
    for (std::size_t k = 0; k < places.size(); ++k)
    {
      points[k].time = double(k);
      points[k].position << places[k], 0.0;
    }
    return crossingsOf(rockPathOf(points, 0, 0, 1.0), line).size();
  };
  EXPECT_EQ(passings({ { 10, -5 }, { 10, 0 } }), 0u);
  EXPECT_EQ(passings({ { 10, 0 }, { 10, 5 } }), 0u);
  EXPECT_EQ(passings({ { 10, -5 }, { 10, 0 }, { 10, 0 }, { 10, 5 } }), 1u); // rests there
  EXPECT_EQ(passings({ { 10, -5 }, { 10, 0 }, { 12, -5 } }), 0u);
  // Along the first segment, off at the vertex: the line bends to the left of it.
  EXPECT_EQ(passings({ { 2, 5 }, { 4, 0 }, { 25, 0 } }), 1u);
  EXPECT_EQ(passings({ { 2, -5 }, { 4, 0 }, { 25, 0 } }), 0u);
  // A closed line has a vertex where it begins.
  const CollectorLine ring = lineOf({ { 0, 0 }, { 10, 0 }, { 10, 10 }, { 0, 10 }, { 0, 0 } });
  std::vector<PathPoint> points(2);
  points[0].position = Vec3(-3, -3, 0);
  points[1].position = Vec3(4, 4, 0);
  points[1].time = 1.0;
  points[0].velocity = points[1].velocity = Vec3(7, 7, 0);
  EXPECT_EQ(crossingsOf(rockPathOf(points, 0, 0, 1.0), ring).size(), 1u);
}

TEST(Crossings, NothingIsFasterThanThePointsOfThePath)
{
  // Two points at one time but for rounding, and an impact, whose curve swings out.
  std::vector<PathPoint> points(2);
  points[0].position = points[1].position = Vec3(100.0, 50.0, 30.0);
  points[0].velocity = Vec3(20.0, 0.0, -10.0);
  points[1].velocity = Vec3(19.9, 0.0, 8.0);
  points[0].time = 0.15;
  for (const double duration : { 3e-14, 1e-3 })
  {
    points[1].time = points[0].time + duration;
    points[1].position.x() = 100.0 + (duration < 1e-9 ? 1e-13 : 0.015);
    points[0].kineticEnergy = 500.0 * points[0].velocity.squaredNorm();
    points[1].kineticEnergy = 500.0 * points[1].velocity.squaredNorm();
    const PathPiece piece(points[0], points[1], 1000.0);
    EXPECT_LE(piece.maxSpeed(0.0, 1.0), points[0].velocity.norm());
    EXPECT_LE(piece.maxKineticEnergy(0.0, 1.0), points[0].kineticEnergy * (1.0 + 1e-12));
    for (int k = 0; k <= 100; ++k)
    {
      EXPECT_LE(piece.velocity(0.01 * k).norm(), points[0].velocity.norm());
      EXPECT_LE(piece.kineticEnergy(0.01 * k), points[0].kineticEnergy * (1.0 + 1e-12));
    }
  }
}

TEST(Crossings, BruteForceAlongRandomCurves)
{
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(0.0, 60.0);
  int all = 0;
  const int trials = rockfall::testing::someOf(40, 4);
  for (int trial = 0; trial < trials; ++trial)
  {
    const auto points = wild(random, 5, 60.0);
    const CollectorLine line = lineOf({ { place(random), place(random) },
      { place(random), place(random) }, { place(random), place(random) } });
    const auto found = crossingsOf(rockPathOf(points, 0, 0, 1.0), line);
    std::vector<double> times;
    const int steps = 20000;
    for (std::size_t k = 1; k < points.size(); ++k)
    {
      const PathPiece piece(points[k - 1], points[k], 1.0);
      Vec3 before = piece.position(0.0);
      for (int i = 1; i <= steps; ++i)
      {
        const Vec3 after = piece.position(double(i) / steps);
        for (std::size_t j = 1; j < line.points.size(); ++j)
        {
          const Eigen::Vector2d a = line.points[j - 1], d = line.points[j] - a;
          const auto side = [&](const Vec3& p)
          { return d.x() * (p.y() - a.y()) - d.y() * (p.x() - a.x()); };
          const double share = d.dot(Eigen::Vector2d(after.head<2>()) - a) / d.squaredNorm();
          if ((side(before) < 0.0) != (side(after) < 0.0) && share >= 0.0 && share < 1.0)
          {
            times.push_back(piece.time(double(i) / steps));
          }
        }
        before = after;
      }
    }
    ASSERT_EQ(found.size(), times.size()) << trial;
    for (std::size_t k = 0; k < times.size(); ++k)
    {
      EXPECT_NEAR(
        found[k].time, times[k], 1.5 / steps); // a step of the walk: pieces last 1.5 s at most
    }
    all += int(times.size());
  }
  EXPECT_GT(all, trials);
}

TEST(Crossings, ABarrierCatchesWhatIsNoHigherWithItsTop)
{
  // 2 m high, its lowest point at 3 m; the barrier has 4 m, then 5.
  CollectorLine line = lineOf({ { 5, 0 }, { 5, 100 } });
  line.barrierCapacity = 100.0;
  std::vector<PathPoint> points(2);
  for (PathPoint& p : points)
  {
    p.velocity = Vec3(10, 0, 0);
    p.heightOverGround = 3.0;
  }
  points[0].position = Vec3(0, 1, 20);
  points[1].position = Vec3(10, 1, 20);
  points[1].time = 1.0;
  const auto caught = [&](double width, double height)
  {
    RockPath path = rockPathOf(points, 0, 0, 1.0);
    path.width = width;
    std::vector<Crossing> crossings;
    appendCrossings(path, line, 0, nullptr, crossings);
    line.barrierHeight = height;
    return summarizeLine(line, 0, crossings, 1).caught;
  };
  EXPECT_EQ(caught(2.0, 4.0), 0);
  EXPECT_EQ(caught(2.0, 5.0), 1);
  EXPECT_EQ(caught(std::numeric_limits<double>::quiet_NaN(), 50.0), 0); // it is not known
}

TEST(Crossings, WhatABarrierCatches)
{
  // Ten rocks at heights 0.5, 1.5, … 9.5 m and speeds 1 … 10 m/s through a barrier of 5 m and 32 J:
  // 1 kg at 8 m/s has 32 J, so height decides: five are caught. Ten more do not come.
  CollectorLine line = lineOf({ { 5, 0 }, { 5, 100 } });
  line.barrierHeight = 5.0;
  line.barrierCapacity = 32.0;
  std::vector<Crossing> crossings;
  for (int k = 9; k >= 0; --k)
  {
    std::vector<PathPoint> points(2);
    for (PathPoint& p : points)
    {
      p.velocity = Vec3(k + 1, 0, 0);
      p.kineticEnergy = 0.5 * (k + 1) * (k + 1);
      p.heightOverGround = 0.5 + k;
    }
    points[0].position = Vec3(0, 10 * k + 1, 20);
    points[1].position = Vec3(10, 10 * k + 1, 20);
    points[1].time = 10.0 / (k + 1);
    appendCrossings(rockPathOf(points, 0, k, 1.0), line, 0, nullptr, crossings);
  }
  LineSummary summary = summarizeLine(line, 0, crossings, 20);
  EXPECT_EQ(summary.rocks, 10);
  EXPECT_EQ(summary.crossings, 10);
  EXPECT_DOUBLE_EQ(summary.share, 0.5);
  EXPECT_DOUBLE_EQ(summary.shareError, std::sqrt(0.25 / 20.0));
  EXPECT_EQ(summary.caught, 5);
  EXPECT_DOUBLE_EQ(summary.caughtShare, 0.5);
  EXPECT_DOUBLE_EQ(summary.caughtShareError, std::sqrt(0.25 / 10.0));
  EXPECT_NEAR(summary.speed.mean, 5.5, 1e-12);
  EXPECT_NEAR(summary.speed.maximum, 10.0, 1e-12);
  EXPECT_NEAR(summary.height.quantiles[0], 5.0, 1e-12);
  line.barrierHeight = std::numeric_limits<double>::infinity();
  EXPECT_EQ(summarizeLine(line, 0, crossings, 20).caught, 8);
  line.barrierCapacity = 31.0;
  EXPECT_EQ(summarizeLine(line, 0, crossings, 20).caught, 7);
  EXPECT_EQ(summarizeLine(line, 1, crossings, 20).rocks, 0);
  EXPECT_TRUE(std::isnan(summarizeLine(line, 1, crossings, 20).caughtShare));
}
