// Long work of every kind is given up soon after it is no longer wanted.

#include "base/abort.h"
#include "base/detachedCall.h"
#include "base/parallel.h"
#include "geometry/shell.h"
#include "patience.h"
#include "randomScenes.h"
#include "run/overlaps.h"
#include "slopes.h"
#include "statistics/HazardRaster.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Grit of some milligrams that lies on stiff ground: a second of its way takes hours.
std::vector<Rock> grit(int count, double apart)
{
  std::vector<Rock> rocks;
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = makeBox(Vec3(2e-3, 1e-3, 1e-3));
    rock.position = Vec3(5.0 + apart * (k % 10), 5.0 + apart * (k / 10), 100.01);
    rock.velocity = Vec3(1.0, 0.0, 0.0);
    rock.angularVelocity = Vec3(3.0, 200.0, 1.0);
    rocks.push_back(rock);
  }
  return rocks;
}

SimulationParameters longRun(bool together)
{
  SimulationParameters p;
  p.timeStep = 0.02;
  p.endTime = 1000.0;
  p.outputInterval = 1.0;
  p.normalPenalty = 5e11;
  p.rockRockContact = p.pushRocksApart = together;
  p.rockRestitution = 1.0;
  return p;
}

Terrain bouncy()
{
  return makePlane(2, 2000.0, radians(0.0), 0.0, material(1.0, 0.0));
}

double runUntilHeard(const std::vector<Rock>& rocks, const SimulationParameters& p)
{
  const Terrain terrain = bouncy();
  TrajectoryStore store(int(rocks.size()), 1);
  Patience patience;
  const bool finished =
    runEnsemble(terrain, rocks, p, store, [&](double) { return patience.stillWanted(); });
  return finished ? -1.0 : patience.spentSince();
}

} // namespace

TEST(Abort, OfARockAlone)
{
  const double heard = runUntilHeard(grit(1, 0.0), longRun(false));
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
}

TEST(Abort, OfRocksThatFallTogether)
{
  const double heard = runUntilHeard(grit(60, 1.5e-3), longRun(true));
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
}

TEST(Abort, OfPushingRocksApart)
{
  // All in one place, but for a hair.
  std::vector<Rock> rocks = grit(3000, 1e-6);
  const Terrain terrain = bouncy();
  const double heard = heardAfter([&] { pushApart(terrain, rocks); });
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
}

TEST(Abort, OfAHazardMap)
{
  CellGrid grid;
  grid.columns = grid.rows = 1000;
  grid.cellSize = 1.0;
  RockPath path;
  path.mass = 1.0;
  std::vector<PathPoint> points;
  for (int k = 0; k <= 2000; ++k)
  {
    PathPoint point;
    point.time = 0.1 * k;
    point.position = Vec3(0.4 * k + 1.0, 500.0 + 400.0 * std::sin(0.1 * k), 0.0);
    point.velocity = Vec3(4.0, 0.0, 0.0);
    points.push_back(point);
  }
  path.points = points;
  HazardRaster raster(grid);
  const double heard = heardAfter(
    [&]
    {
      for (path.rock = 0; path.rock < 1000000; ++path.rock)
      {
        raster.add(path);
      }
    });
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
}

TEST(Abort, OfLoopsThatSeveralThreadsShare)
{
  std::atomic<int> asked{ 0 };
  const auto work = [&]
  {
    forEach(1000, 1,
      [&](std::size_t)
      {
        const auto start = std::chrono::steady_clock::now();
        while (secondsSince(start) < 0.01)
        {
          stayWanted();
        }
        ++asked;
      });
  };
  const double heard = heardAfter(work);
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
  EXPECT_GT(asked, 0);
  EXPECT_LT(asked, 1000);
}

TEST(Abort, OfWorkThatAsksNobody)
{
  // The work is left, and keeps what it owns to its end.
  const auto owned = std::make_shared<int>(1);
  const std::weak_ptr<int> seen = owned;
  const double heard = heardAfter(
    [owned]
    {
      detachedCall(
        [owned]
        {
          std::this_thread::sleep_for(std::chrono::milliseconds(1500));
          return *owned;
        });
    });
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
  EXPECT_GE(seen.use_count(), 2);
}

TEST(Abort, WorkThatIsWantedGivesWhatItGives)
{
  EXPECT_EQ(detachedCall([] { return 3; }), 3); // on this thread
  const AbortScope scope([] { return true; });
  EXPECT_EQ(detachedCall([] { return 4; }), 4);
  EXPECT_THROW(
    detachedCall([]() -> int { throw std::runtime_error("a fault"); }), std::runtime_error);
  EXPECT_EQ(*detachedCall([] { return std::make_unique<int>(5); }), 5);
}

TEST(Abort, OfAHull)
{
  std::vector<Vec3> points; // all of them corners
  for (int k = 0; k < 120000; ++k)
  {
    const double z = std::fmod(k * 0.754877666, 1.0) * 2.0 - 1.0, angle = 2.399963 * k;
    const double r = std::sqrt(1.0 - z * z);
    points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  const double heard = heardAfter([&] { hullFaces(points, "points"); });
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
}

TEST(Abort, LeavesNothingBehind)
{
  EXPECT_GE(heardAfter(
              []
              {
                for (;;)
                  stayWanted();
              }),
    0.0);
  stayWanted(); // no scope: goes on
  EXPECT_EQ(AbortScope::current(), nullptr);
}
