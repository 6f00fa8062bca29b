// Barriers that a rock meets with a part of itself, behind another one, or where it is released.

#include "../evenGround.h"
#include "../piles.h"
#include "rigidFor.h"
#include "terrain/structures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Barrier netAt(double x, std::int64_t feature, double height, double capacity)
{
  Barrier b;
  b.feature = feature;
  b.points = { { x, 20.0 }, { x, 80.0 } };
  b.height = height;
  b.capacity = capacity;
  return b;
}

Terrain levelWith(const Structures& s)
{
  Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  terrain.setStructures(s);
  return terrain;
}

/// A box that flies level at 20 m/s, its lowest point at first so high over the ground, m.
Rock box(const Vec3& size, double up, double y = 50.0)
{
  Rock rock = brick(size, Vec3(50.0, y, 100.0 + up + 0.5 * size.z()), 0);
  rock.velocity = Vec3(20.0, 0.0, 0.0);
  return rock;
}

} // namespace

TEST(StruckBarriers, PartOfARockIsToldAndTakesNothing)
{
  // At the line the box has fallen 1.23 m; 3 m over the ground is the rope.
  struct Case
  {
    Vec3 size;
    double up, y;
    bool strikes, passes;
  };
  const Case cases[] = { { { 2, 2, 6 }, 1.4, 50.0, true, false }, // higher than the net
    { { 1, 1, 1 }, 4.1, 50.0, true, false },                      // below the rope with its foot
    { { 1, 1, 1 }, 4.3, 50.0, false, true },                      // over it
    { { 1, 2, 1 }, 4.3, 80.5, false, false },                     // over where it would go on
    { { 1, 2, 1 }, 2.0, 80.5, true, false },                      // half of it beside the end
    { { 1, 2, 1 }, 2.0, 81.1, false, false } };
  for (const Case& of : cases)
  {
    for (const bool records : { false, true })
    {
      SCOPED_TRACE(std::to_string(of.size.z()) + ", " + std::to_string(of.up));
      Structures s;
      s.barriers = { netAt(60.0, 1, 3.0, 1e4) };
      s.barriers[0].records = records;
      const Rock rock = box(of.size, of.up, of.y);
      const Trajectory t = simulate(levelWith(s), rock, rigidFor(0.5 + 0.02));
      ASSERT_EQ(t.structures.size(), of.strikes || of.passes ? 1u : 0u);
      EXPECT_NEAR(t.summary.stop.x(), 60.4, 1e-9); // nothing is taken
      if (of.strikes || of.passes)
      {
        const StructureEvent& e = t.structures[0];
        EXPECT_EQ(e.outcome,
          of.passes   ? StructureOutcome::BarrierPassed
            : records ? StructureOutcome::BarrierRecorded
                      : StructureOutcome::BarrierStruck);
        EXPECT_EQ(e.energyTaken, 0.0);
        EXPECT_GT(e.kineticEnergy, 1e5);
        EXPECT_NEAR(e.time, 0.5, 1e-9);
      }
    }
  }
}

TEST(StruckBarriers, ANetThatIsRunOverHoldsNoOtherRock)
{
  for (const double capacity : { 1e6, 1e9 })
  {
    Structures s;
    s.barriers = { netAt(60.0, 1, 3.0, capacity) };
    Pile pile;
    pile.ground = levelWith(s);
    pile.parameters.endTime = 1.2;
    pile.rocks = { box(Vec3(5, 5, 5), 1.5), box(Vec3(1, 1, 1), 3.0, 70.0) };
    pile.rocks[1].blockId = 1;
    pile.rocks[1].position.x() = 48.0;
    pile.make();
    const std::vector<Trajectory> runs = pile.fall->run();
    ASSERT_EQ(runs[0].structures.size(), 1u);
    EXPECT_EQ(runs[0].structures[0].outcome, StructureOutcome::BarrierStruck);
    EXPECT_EQ(runs[1].summary.fate == Fate::Caught, capacity > 1e8);
    ASSERT_EQ(runs[1].structures.size(), 1u);
    EXPECT_EQ(runs[1].structures[0].outcome,
      capacity > 1e8 ? StructureOutcome::BarrierStopped : StructureOutcome::BarrierGone);
  }
}

TEST(StruckBarriers, ABrakingWayMeetsWhatStandsOnIt)
{
  const auto fall = [](const Structures& s)
  { return simulate(levelWith(s), box(Vec3(1, 1, 1), 3.0), rigidFor(3.0)); };
  Structures s;
  s.barriers = { netAt(60.0, 1, 6.0, 1e6) };
  s.barriers[0].braking = 6.0;
  const Trajectory free = fall(s);
  const double energy = free.structures[0].kineticEnergy;
  const double way = 6.0 * std::sqrt(energy / 1e6);
  EXPECT_NEAR(free.summary.stop.x(), 60.0 + way, 1e-6);
  const double left = energy * (1.0 - 4.0 / (way * way)); // 2 m behind the line

  for (const double capacity : { 2.0 * energy, 0.5 * left })
  {
    Structures two = s;
    two.barriers.push_back(netAt(62.0, 2, 6.0, capacity));
    const Trajectory t = fall(two);
    ASSERT_EQ(t.structures.size(), 2u);
    EXPECT_EQ(t.structures[1].feature, 2);
    EXPECT_NEAR(t.structures[1].kineticEnergy, left, 0.03 * energy); // pieces of a sine
    const bool holds = capacity > left;
    EXPECT_EQ(t.structures[1].outcome,
      holds ? StructureOutcome::BarrierStopped : StructureOutcome::BarrierBroken);
    EXPECT_NEAR(t.summary.stop.x(), holds ? 62.0 : 60.0 + way, 1e-6);
    EXPECT_EQ(t.summary.fate, Fate::Caught);
    EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-9 * energy);
  }

  Structures line = s;
  line.barriers.push_back(netAt(62.0, 2, 6.0, 0.0));
  line.barriers.back().records = true;
  const Trajectory recorded = fall(line);
  ASSERT_EQ(recorded.structures.size(), 2u);
  EXPECT_EQ(recorded.structures[1].outcome, StructureOutcome::BarrierRecorded);
  EXPECT_NEAR(recorded.structures[1].kineticEnergy, left, 0.03 * energy);
  EXPECT_EQ(recorded.summary.stop, free.summary.stop);

  Structures wall = s;
  Embankment e;
  e.feature = 2;
  e.points = { { 63.0, 20.0 }, { 63.0, 80.0 } };
  e.height = 8.0;
  e.crestWidth = 1.0;
  for (const double side : { 0.0, 0.05, 0.2 })
  {
    e.mountainSlope = e.valleySlope = side;
    wall.embankments = { e };
    const Trajectory stopped = fall(wall);
    ASSERT_EQ(stopped.structures.size(), 1u);
    EXPECT_EQ(stopped.structures[0].brakingDistance, free.structures[0].brakingDistance);
    EXPECT_GT(stopped.summary.stop.x(), 60.2);
    EXPECT_LT(stopped.summary.stop.x(), 62.5 - 0.5); // half a cube before the crest
    EXPECT_LT(std::abs(stopped.summary.energy.numerical), 1e-9 * energy);
  }
}

TEST(StruckBarriers, ABrakingWayEndsBeforeAHole)
{
  Structures s;
  s.barriers = { netAt(60.0, 1, 6.0, 1e6) };
  s.barriers[0].braking = 6.0;
  Terrain terrain = makeSlope(
    201, 0.5,
    [](double x, double) { return x > 62.2 && x < 63.8 ? std::nan("")
                             : x < 63.0                ? 100.0
                                                       : 103.0; },
    material(0.5, 20.0));
  terrain.setStructures(s);
  const Trajectory t = simulate(terrain, box(Vec3(1, 1, 1), 3.0), rigidFor(3.0));
  EXPECT_EQ(t.summary.fate, Fate::Caught);
  EXPECT_GE(t.summary.stop.x(), 60.0);
  EXPECT_LT(t.summary.stop.x(), 62.2);
  EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-6 * t.structures[0].kineticEnergy);
}

// Drawn from either side, and with the rock on either side of the line by rounding.
TEST(StruckBarriers, ARockReleasedOnALineIsNotBehindIt)
{
  for (const bool turned : { false, true })
  {
    for (const double beside : { -1e-9, 0.0, 1e-9 })
    {
      Structures s;
      s.barriers = { netAt(50.0, 1, 8.0, 1e9) };
      if (turned)
      {
        std::reverse(s.barriers[0].points.begin(), s.barriers[0].points.end());
      }
      Rock rock = box(Vec3(1, 1, 1), 3.0);
      rock.position.x() += beside;
      const Trajectory t = simulate(levelWith(s), rock, rigidFor(0.5));
      EXPECT_TRUE(t.structures.empty());
      EXPECT_NEAR(t.summary.stop.x(), 60.0, 1e-6);
    }
  }
}

/// A net on the edge of a wall stands on its crest, from whichever side a rock comes.
TEST(StruckBarriers, ANetOnTheEdgeOfAWallStandsOnItsCrest)
{
  for (const double at : { 59.0, 61.0 })
  {
    for (const double towards : { -1.0, 1.0 })
    {
      SCOPED_TRACE(std::to_string(at) + ", " + std::to_string(towards));
      Embankment wall;
      wall.feature = 2;
      wall.points = { { 60.0, 20.0 }, { 60.0, 80.0 } };
      wall.height = 4.0;
      wall.crestWidth = 2.0;
      wall.mountainSlope = wall.valleySlope = 0.0;
      Structures s;
      s.barriers = { netAt(at, 1, 3.0, 1e9) };
      s.embankments = { wall };
      Rock rock = box(Vec3(1, 1, 1), 4.0 + 0.7 + 1.23);
      rock.position.x() = at - towards * 10.0;
      rock.velocity.x() = towards * 20.0;
      const Trajectory t = simulate(levelWith(s), rock, rigidFor(2.0));
      ASSERT_EQ(t.structures.size(), 1u);
      EXPECT_EQ(t.structures[0].outcome, StructureOutcome::BarrierStopped);
      EXPECT_NEAR(t.structures[0].heightOverGround, 1.2, 0.05);
    }
  }
}

/// Soil in a scar brakes a rock before the line that it would pass in free flight: the net is met once.
TEST(StruckBarriers, AreMetOnceInAScar)
{
  // Around lines to which the rock comes in a scar.
  const std::pair<const char*, int> cases[] = { { "Talus", 75 }, { "Talus", 92 },
    { "Meadow", 277 } };
  for (const auto& [preset, first] : cases)
  {
    const SurfaceMaterial soft = evenGround(preset);
    for (int k = first; k < first + 15; ++k)
    {
      Structures s;
      s.barriers = { netAt(40.0 + 0.013 * k, 1, 20.0, 1e9) };
      s.barriers[0].records = true;
      Terrain ground = makeSlope(
        101, 1.0, [](double, double) { return 10.0; }, soft);
      ground.setStructures(s);
      Rock rock = box(Vec3(1, 1, 1), 0.0);
      rock.shape = makeShape(Shape::Icosahedron, 0.5);
      rock.density = 2700.0;
      rock.position = Vec3(39.9, 50.0, 10.0 + rock.shape.radius() + 0.3);
      rock.velocity = Vec3(14.0, 0.0, -10.0);
      rock.orientation = Quat(1.0, 0.03 * k, 0.2, 0.1).normalized();
      EXPECT_EQ(simulate(ground, rock, rigidFor(2.5)).structures.size(), 1u) << preset << k;
    }
  }
}
