// Long slopes of ground that yields: speeds, jumps and reach angles as field surveys have them, and
// rocks that come to rest on gentle meadows. The presets as they are.
//
// Field figures: speeds mostly below 30 m/s, jumps of some metres, reach angles of single
// rocks 27.5° to 40° (Heim's fahrböschung, from the release to the stop).

#include "longSlope.h"
#include "verification.h"

#include "statistics/sample.h"
#include "terrain/presets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;
using namespace rockfall::verification;

namespace
{

constexpr double kWidth = 120.0; // m
constexpr double kAbove = 20.0;  // from the edge to the top, m

/// A slope of this length and angle (rad) with a flat foot; the foot is of another ground.
Terrain makeSlopeWithFoot(double length, double angle, const char* upper, const char* lower)
{
  return makeLongSlope(angle, kAbove + length * std::cos(angle), 300.0,
    SlopeGround::ofPreset(upper), SlopeGround::ofPreset(lower));
}

/// EOTA rocks and cubes of 0.2 to 2 m³, let go at the top at 1.5 m/s.
std::vector<Rock> releaseAtTop(const Terrain& terrain, int count)
{
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Rock> rocks;
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    const Shape shape = k % 3 == 0 ? Shape::Eota111 : k % 3 == 1 ? Shape::Cube : Shape::Eota221;
    rock.shape = makeShape(shape, 0.2 * std::pow(10.0, unit(generator)));
    const double y = 0.5 * kWidth + 6.0 * (unit(generator) - 0.5);
    rock.position = Vec3(kAbove + 8.0, y, terrain.elevation(kAbove + 8.0, y) + 2.0);
    const double u = unit(generator), v = unit(generator), w = unit(generator);
    rock.orientation = uniformAttitude(u, v, w);
    rock.velocity = Vec3(1.5, 0.6 * (unit(generator) - 0.5), 0.0);
    rock.blockId = k;
    rocks.push_back(rock);
  }
  return rocks;
}

double quantileOf(std::vector<double> values, double share)
{
  std::sort(values.begin(), values.end());
  return quantile(values, share);
}

} // namespace

TEST(LongSlopes, SpeedsJumpsAndReachAngles)
{
  struct Case
  {
    double angle, length;            // degrees, m
    std::optional<double> mostReach; // degrees; none: docs/validation.md has what is missed
  };
  for (const Case& c : { Case{ 40.0, 150.0, {} }, Case{ 35.0, 450.0, 35.0 } })
  {
    const Terrain terrain = makeSlopeWithFoot(c.length, radians(c.angle), "talus", "meadow");
    SimulationParameters p;
    p.endTime = 300.0;
    p.outputInterval = 0.5;
    p.normalPenalty = 0.0; // by mass, as in the panel
    std::vector<double> speeds, jumps, reach;
    for (const Trajectory& t : simulateAll(terrain, releaseAtTop(terrain, count(40, 300)), p))
    {
      const TrajectorySummary& s = t.summary;
      speeds.push_back(s.maxSpeed);
      jumps.push_back(s.maxHeightOverGround);
      reach.push_back(degrees(std::atan2(s.start.z() - s.stop.z(), s.runOut)));
    }
    const std::string head =
      text(c.length) + " m of talus at " + text(c.angle) + "°, then flat meadow: ";
    recordAtMost(
      { "Long slopes", head + "greatest speed, 95 %", "m/s", "field surveys: mostly below 30 m/s" },
      quantileOf(speeds, 0.95), full() ? 30.0 : 34.0); // of few rocks it is that of two
    recordAtMost({ "Long slopes", head + "greatest height over ground, 95 %", "m",
                   "field surveys: some metres on soft ground" },
      quantileOf(jumps, 0.95), 8.0);
    recordAtLeast({ "Long slopes", head + "reach angle, 5 %", "°",
                    "field surveys: few single rocks below 27.5°" },
      quantileOf(reach, 0.05), 27.0);
    const Figure middle{ "Long slopes", head + "reach angle, median", "°",
      "field surveys: 27° to 35° on long slopes, to 40° on all" };
    if (c.mostReach)
    {
      recordAtMost(middle, quantileOf(reach, 0.5), *c.mostReach);
    }
    else
    {
      report(middle, quantileOf(reach, 0.5));
    }
  }
}

// No loss counted twice: bare rock does not brake more than what is dug into.
TEST(LongSlopes, BedrockIsAsFastAsTalus)
{
  const auto median = [](const char* ground)
  {
    const Terrain terrain = makeSlopeWithFoot(200.0, radians(30.0), ground, ground);
    SimulationParameters p;
    p.endTime = 300.0;
    p.outputInterval = 0.5;
    p.normalPenalty = 0.0;
    std::vector<double> speeds;
    for (const Trajectory& t : simulateAll(terrain, releaseAtTop(terrain, count(20, 200)), p))
    {
      speeds.push_back(t.summary.maxSpeed);
    }
    return quantileOf(speeds, 0.5);
  };
  recordAtLeast(
    { "Long slopes",
      "200 m of 30°: greatest speed on bedrock with boulders over that on talus, median", "",
      "bare rock brakes no more than talus" },
    median("bedrock with boulders") / median("talus"), full() ? 1.0 : 0.9); // few scatter
}

// Talus sorts: the largest blocks go farthest.
TEST(LongSlopes, LargeBlocksGoFarther)
{
  const auto median = [](double volume)
  {
    const Terrain terrain =
      makeSlopeWithFoot(174.0, radians(35.0), "talus", "talus"); // 100 m of drop
    std::vector<Rock> rocks = releaseAtTop(terrain, count(60, 300));
    for (Rock& rock : rocks)
    {
      rock.shape = makeShape(Shape::Eota111, volume);
    }
    SimulationParameters p;
    p.endTime = 300.0;
    p.outputInterval = 1.0;
    p.normalPenalty = 0.0;
    std::vector<double> runOuts;
    for (const Trajectory& t : simulateAll(terrain, rocks, p))
    {
      runOuts.push_back(t.summary.runOut);
    }
    return quantileOf(runOuts, 0.5);
  };
  record(
    { "Long slopes", "35° of 100 m of drop, talus: run-out of 10 m³ over that of 0.1 m³, median",
      "", "talus sorts by size: 1.1 to 1.6" },
    median(10.0) / median(0.1), 1.35, 0.25);
}

TEST(LongSlopes, NothingCreepsOnAMeadow)
{
  for (const double angle : { 10.0, 15.0 })
  {
    Terrain meadow = rockfall::testing::makePlane(301, 600.0, radians(angle), 0.0,
      groundPreset("meadow").material(), groundPreset("meadow").roughness);
    meadow.setDeviationPer(groundPreset("meadow").deviationPer());
    std::vector<Rock> rocks;
    for (int k = 0; k < count(20, 100); ++k)
    {
      Rock rock;
      rock.shape = makeShape(Shape::Eota111, 0.2 + 0.05 * (k % 10));
      rock.position = Vec3(100.0, 300.0, meadow.elevation(100.0, 300.0) + 3.0);
      rock.orientation = uniformAttitude(0.137 * k - int(0.137 * k), 0.61 * k - int(0.61 * k), 0.3);
      rock.velocity = Vec3(10.0, 0.2 * (k % 5), 0.0);
      rocks.push_back(rock);
    }
    SimulationParameters p;
    p.endTime = 120.0;
    p.outputInterval = 1.0;
    double longest = 0.0;
    for (const Trajectory& t : simulateAll(meadow, rocks, p))
    {
      EXPECT_EQ(t.summary.fate, Fate::Rested);
      longest = std::max(longest, t.summary.endTime - t.impacts.back().time);
    }
    recordAtMost(
      { "Long slopes",
        "EOTA 111 on a meadow of " + text(angle) + "°: longest time from the last bounce to rest",
        "s", "rocks roll on for seconds, not minutes" },
      longest, 10.0);
  }
}
