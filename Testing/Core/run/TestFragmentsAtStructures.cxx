// Pieces of rocks that broke, at nets and stems: each meets what those before it have left.

#include "evenGround.h"
#include "fragments.h"
#include "law/settings.h"
#include "run/brokenFall.h"
#include "terrain/structures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Breaks at (100, 100) into pieces that fly on along x.
Rock thrownDown(double speed)
{
  constexpr double height = 15.0;
  Rock rock = dropped(height);
  rock.position.x() -= speed * std::sqrt(2.0 * height / kGravity);
  rock.velocity = Vec3(speed, 0.0, 0.0);
  return rock;
}

/// A net across the ground, which is the weaker the more it has held.
Barrier netAt(double x, double capacity)
{
  Barrier net;
  net.feature = 1;
  net.points = { { x, 10.0 }, { x, 190.0 } };
  net.height = 30.0;
  net.capacity = capacity;
  net.residual = 0.9;
  return net;
}

Terrain withNets(const std::vector<Barrier>& nets)
{
  Terrain terrain = flatGround();
  Structures s;
  s.barriers = nets;
  terrain.setStructures(s);
  return terrain;
}

/// Flat ground with a net behind the place where a rock breaks.
Terrain withNet(double capacity, double x = 106.0)
{
  return withNets({ netAt(x, capacity) });
}

/// Meetings of all pieces with structures, by time.
std::vector<StructureEvent> eventsOf(const std::vector<Trajectory>& all)
{
  std::vector<StructureEvent> events;
  for (const Trajectory& t : all)
  {
    events.insert(events.end(), t.structures.begin(), t.structures.end());
  }
  std::stable_sort(
    events.begin(), events.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return events;
}

} // namespace

TEST(Fragmentation, ANetHasHeldThePiecesThatCameBefore)
{
  // Within a step two pieces may come in either order.
  constexpr double capacity = 3e5;
  const Rock rock = thrownDown(12.0);
  Fragmentation law = lawOf(50e3, 5e-3);
  law.spread = radians(30.0);
  const auto all = runOf(withNet(capacity), { rock }, law);
  double held = 0.0;
  int count = 0;
  for (const StructureEvent& event : eventsOf(all))
  {
    EXPECT_NEAR(event.heldBefore, held, 1e-9 * capacity) << event.time;
    EXPECT_EQ(event.outcome, StructureOutcome::BarrierStopped);
    held += event.kineticEnergy;
    ++count;
  }
  EXPECT_GT(count, 2);
  EXPECT_LT(held, capacity);
  // With less than all of them bring, it holds the first ones, breaks, and is gone.
  const auto strong = runOf(withNet(0.5 * held), { rock }, law);
  double left = 0.5 * held;
  bool broken = false;
  for (const StructureEvent& event : eventsOf(strong))
  {
    EXPECT_EQ(event.outcome == StructureOutcome::BarrierGone, broken) << event.time;
    if (broken)
    {
      continue;
    }
    broken = event.outcome == StructureOutcome::BarrierBroken;
    EXPECT_EQ(broken, event.kineticEnergy > left) << event.time;
    left -= broken ? 0.0 : event.kineticEnergy;
  }
  EXPECT_TRUE(broken);
  // What came before is as it was: the net does not reach back in time.
  EXPECT_EQ(strong[0].summary.hash, all[0].summary.hash);
}

/// A rock breaks with its centre before a net and some of its pieces behind it: it holds them, too.
TEST(Fragmentation, ANetHoldsPiecesThatAreBornBehindIt)
{
  const Rock rock = thrownDown(12.0);
  Fragmentation law = lawOf(50e3, 5e-3);
  law.spread = radians(30.0);
  const double breaks = runOf(flatGround(), { rock }, law)[0].summary.stop.x();
  for (const double ahead : { 0.01, 0.1, 0.2 })
  {
    const double net = breaks + ahead;
    const auto all = runOf(withNet(1e12, net), { rock }, law);
    ASSERT_EQ(all[0].summary.fate, Fate::Broken);
    ASSERT_NEAR(all[0].summary.stop.x(), breaks, 1e-9);
    int held = 0;
    for (std::size_t k = 1; k < all.size(); ++k)
    {
      const TrajectorySummary& s = all[k].summary;
      EXPECT_LT(s.stop.x(), net + 1e-6) << k << ' ' << ahead;
      EXPECT_NEAR(s.energy.numerical, 0.0, 1e-6 * all[0].summary.maxKineticEnergy);
      held +=
        all[k].structures.size() == 1 && all[k].samples.front().time == all[k].structures[0].time;
    }
    EXPECT_GT(held, 0) << ahead;
  }
}

/// Through a weak net on the line of a strong one, or just before it, no piece comes.
TEST(Fragmentation, PiecesThatAreBornBehindTwoNetsMeetBoth)
{
  const Rock rock = thrownDown(12.0);
  Fragmentation law = lawOf(50e3, 5e-3);
  law.spread = radians(30.0);
  const double breaks = runOf(flatGround(), { rock }, law)[0].summary.stop.x();
  for (const double apart : { 0.0, 0.1 })
  {
    const double weak = breaks + 0.02, strong = weak + apart;
    const auto all = runOf(withNets({ netAt(weak, 1.0), netAt(strong, 1e12) }), { rock }, law);
    int both = 0;
    for (std::size_t k = 1; k < all.size(); ++k)
    {
      const TrajectorySummary& summary = all[k].summary;
      EXPECT_LT(summary.stop.x(), strong + 1e-6) << k << ' ' << apart;
      EXPECT_NEAR(summary.energy.numerical, 0.0, 1e-6 * all[0].summary.maxKineticEnergy);
      both += all[k].structures.size() == 2;
    }
    EXPECT_GT(both, 0) << apart;
  }
}

TEST(Fragmentation, AStemThatAPieceBreaksIsGoneForTheOthers)
{
  Terrain terrain = flatGround();
  Structures s;
  for (int k = 0; k < 40; ++k)
  {
    Tree tree;
    tree.feature = k + 1;
    tree.position = { 106.0 + 3.0 * (k % 4), 91.0 + 2.0 * (k / 4) };
    tree.diameter = 0.3;
    tree.height = 15.0;
    tree.capacity = 500.0;
    s.trees.push_back(tree);
  }
  terrain.setStructures(s);
  const Rock rock = thrownDown(15.0);
  Fragmentation law = lawOf(50e3, 2e-3);
  law.spread = radians(20.0);
  const auto all = runOf(terrain, { rock }, law, 12);
  std::map<std::pair<int, std::int64_t>, int> broken;
  int count = 0;
  for (const Trajectory& t : all)
  {
    for (const StructureEvent& event : t.structures)
    {
      if (event.outcome == StructureOutcome::TreeBroken)
      {
        EXPECT_EQ(++broken[std::make_pair(t.summary.iteration, event.feature)], 1)
          << event.feature << " at " << event.time;
        ++count;
      }
    }
    const EnergyAudit& e = t.summary.energy;
    EXPECT_NEAR(e.released, sumOf(e), 1e-6 * all[0].summary.energy.released);
  }
  EXPECT_GT(count, 12);
}

TEST(Fragmentation, ALookAtTheBeginningDoesNotTakeAllOfTheTime)
{
  // Pieces share structures by Δt; to go on to the end by steps of nothing would take hours.
  const Rock rock = thrownDown(12.0);
  SimulationParameters p;
  p.fragmentation = lawOf(50e3, 5e-3);
  p.timeStep = kLeastTimeStep;
  p.endTime = kMostEndTime;
  const Terrain terrain = withNet(1e9);
  const Surface surface(terrain, p.seed, 0);
  const double fallTime = std::sqrt(2.0 * 15.0 / kGravity);
  for (const double enough : { 0.5 * fallTime, fallTime + 0.02 })
  {
    const auto all = fallAndBreak(surface, rock, p, 0, enough);
    EXPECT_EQ(all.size() > 1, enough > fallTime);
    for (const Trajectory& t : all)
    {
      EXPECT_GE(t.samples.back().time, std::min(enough, t.summary.endTime));
      EXPECT_LT(t.samples.back().time, enough + 1.0);
    }
  }
}

namespace
{

/// Number of attitudes in which a rock that comes to `slope` breaks, and the most time from the first
/// touch to then, s.
std::pair<int, double> breakingOn(const Terrain& slope, Rock rock, double energy, int attitudes)
{
  int broken = 0;
  double latest = 0.0;
  for (int k = 0; k < attitudes; ++k)
  {
    rock.orientation = Quat(1.0, 0.21 * k, 0.3, 0.2).normalized();
    const auto all = runOf(slope, { rock }, lawOf(energy, 0.05));
    const Trajectory& t = all[0];
    if (t.summary.fate == Fate::Broken)
    {
      ++broken;
      latest = std::max(latest, t.summary.endTime - t.impacts.back().time);
    }
  }
  return { broken, latest };
}

Rock icosahedronAt(double height, const Vec3& velocity, double x)
{
  Rock rock = dropped(0.0);
  rock.shape = makeShape(Shape::Icosahedron, 1.0);
  rock.position = Vec3(x, 100.0, height);
  rock.velocity = velocity;
  return rock;
}

} // namespace

/// A rock that digs a scar breaks when it takes off from the hard surface in it, not when it has left
/// the scar, and whatever it meets thereafter.
TEST(Fragmentation, OnSoftGroundARockBreaksWhereItHits)
{
  for (const char* preset : { "Meadow", "Talus", "Soil" })
  {
    SCOPED_TRACE(preset);
    const double r = makeShape(Shape::Icosahedron, 1.0).radius();
    for (const bool net : { false, true })
    {
      Terrain slope = makeSlope(
        101, 2.0, [](double x, double) { return std::max(0.0, 0.35 * (100.0 - x)); },
        evenGround(preset));
      Structures s;
      s.barriers = { netAt(100.0, 1e9) };
      if (net)
      {
        slope.setStructures(s);
      }
      const double x = 98.0 - r;
      const Rock rock = icosahedronAt(0.35 * (100.0 - x) + 1.2 * r, Vec3(9.0, 0.0, -14.0), x);
      const auto [broken, latest] = breakingOn(slope, rock, 100e3, 8);
      EXPECT_EQ(broken, 8);
      EXPECT_LT(latest, 0.06); // the way to the bottom of a scar and back, at 13 m/s
    }
  }
}

/// Each hit in a scar breaks the rock by its own energy, or not: a rock that grazes the level at
/// 2 m/s and comes to a counter slope of 45° at 11 m/s across it, 160 kJ/m³.
TEST(Fragmentation, EachHitInAScarIsJudgedByItself)
{
  const double r = makeShape(Shape::Icosahedron, 1.0).radius();
  const Terrain slope = makeSlope(
    401, 0.5, [](double x, double) { return std::max(0.0, x - 100.0); }, evenGround("Talus"));
  const Rock rock = icosahedronAt(1.02 * r, Vec3(18.0, 0.0, -2.0), 98.0 - 0.414 * r);
  EXPECT_GE(breakingOn(slope, rock, 60e3, 10).first, 9);
  EXPECT_GE(breakingOn(slope, rock, 100e3, 10).first, 8);
  EXPECT_EQ(breakingOn(slope, rock, 250e3, 10).first, 0);
}

/// A rock that turns lands with one corner after the other: soil brakes it between them, but the hit is
/// the one that began at the surface.
TEST(Fragmentation, ARockThatTurnsBreaksByTheSpeedWithWhichItLands)
{
  constexpr double speed = 12.0; // downwards, m/s
  const double r = makeShape(Shape::Cube, 0.01).radius();
  Rock rock = icosahedronAt(1.001 * r, Vec3(speed, 0.0, -speed), 60.0);
  rock.shape = makeShape(Shape::Cube, 0.01);
  rock.angularVelocity = Vec3(0.0, 1.4 * speed / r, 0.0);
  const double energy = 0.5 * rock.density * speed * speed;
  for (const char* preset : { "Meadow", "Talus", "Soil" })
  {
    const Terrain slope = makeSlope(
      201, 1.0, [](double, double) { return 0.0; }, evenGround(preset));
    Fragmentation law = lawOf(energy / 1.02, 0.001);
    int broken = 0;
    for (int k = 0; k < 24; ++k)
    {
      rock.orientation = Quat(1.0, 0.2 * k, 0.3, 0.17 * k).normalized();
      broken += runOf(slope, { rock }, law)[0].summary.fate == Fate::Broken;
    }
    EXPECT_EQ(broken, 24) << preset;
  }
}
