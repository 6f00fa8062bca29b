// Many rocks: piles that stand for a minute, heaps that come to rest without overlap and steeper
// with more friction, crowds that go as far as if every impact in them were resolved.

#include "Core/piles.h"
#include "verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::Pile;

namespace
{

const char* const kStanding = "Piles that stand";
const char* const kHeap = "Heaps";
const char* const kCrowd = "Crowds";

void stand(const char* name, Pile& pile)
{
  pile.start();
  pile.run(1.0); // the springs take up the weight
  const std::vector<Vec3> settled = pile.places();
  const double duration = count(2, 59);
  pile.run(duration);
  const std::string circumstances =
    std::string(name) + ", " + text(duration) + " s after the first second, nothing asleep: ";
  recordAtMost({ kStanding, circumstances + "drift", "m", "the bar of a pile that stands" },
    pile.drift(settled), 1e-4);
  record({ kStanding, circumstances + "forces of the floor over the weight", "", "" },
    pile.carried(), 1.0, 1e-3);
}

constexpr double kTimeStep = 0.005; // s
constexpr double kStill = 3e-3; // m/s, at which a rock of this size that touches something rests

struct Heap
{
  double repose = 0.0;  ///< Angle, rad.
  double overlap = 0.0; ///< The deepest at any time, of the edge of a cube.
  double resting = 0.0; ///< Share of the cubes.
  double duration = 0.0;
};

/// Cubes of 0.6 m³, turned at random, let fall onto a floor.
Heap drop(int cubes, double friction)
{
  constexpr double kVolume = 0.6;
  const double edge = std::cbrt(kVolume);
  Pile pile;
  pile.ground = rockfall::testing::makeSlope(
    21, 5.0, [](double, double) { return 0.0; }, rockfall::testing::material(0.2, friction));
  pile.awake = false;
  pile.parameters.rockFrictionAngle = radians(friction);
  pile.parameters.rockRestitution = 0.2;
  pile.parameters.endTime = 60.0;
  pile.parameters.timeStep = kTimeStep;
  // 1000 cubes meet at up to 17 m/s.
  pile.rocks = rockfall::testing::levelsOfCubes(cubes, cubes >= 500 ? 10 : 3, kVolume, 7);
  pile.start();
  Heap heap;
  bool moves = true;
  while (moves)
  {
    moves = pile.fall->advance();
    heap.overlap = std::max(heap.overlap, pile.overlap() / edge);
  }
  heap.duration = pile.fall->time();
  // Of a cone of angle θ, the centre of gravity is at a quarter of its height, and half of it is
  // within half of its radius from the axis: tan θ = 2 z / r. The mean distance would be as large,
  // but single cubes roll far.
  Vec3 middle = Vec3::Zero();
  int moving = 0;
  for (int i = 0; i < cubes; ++i)
  {
    const BlockState& state = pile.fall->state(i);
    middle += state.position / cubes;
    const bool on = (state.position - Vec3(50, 50, 0)).head<2>().cwiseAbs().maxCoeff() < 50.0;
    moving += !on || state.velocity.norm() > kStill;
  }
  heap.resting = double(cubes - moving) / cubes;
  std::vector<double> distances;
  for (int i = 0; i < cubes; ++i)
  {
    distances.push_back((pile.fall->state(i).position - middle).head<2>().norm());
  }
  std::nth_element(distances.begin(), distances.begin() + cubes / 2, distances.end());
  heap.repose = std::atan(2.0 * middle.z() / distances[std::size_t(cubes) / 2]);
  return heap;
}

struct Fall
{
  double way = 0.0;   ///< Mean of all rocks along the slope, m.
  double lead = 0.0;  ///< The same of the tenth that went farthest.
  EnergyAudit energy; ///< Of all.
};

/// Cuboids of random sizes and attitudes, side by side above a slope of 42°, that come to rest on
/// the level below.
Fall rush(int rocks, std::uint64_t seed, int resolved)
{
  const auto height = [](double x, double y)
  { return (x < 100.0 ? 0.9 * (100.0 - x) : 0.0) + 0.05 * std::sin(0.9 * x) * std::cos(0.7 * y); };
  Pile pile;
  pile.ground =
    rockfall::testing::makeSlope(151, 2.0, height, rockfall::testing::material(0.7, 12.0));
  pile.awake = false;
  pile.parameters.timeStep = kTimeStep;
  pile.parameters.endTime = 40.0;
  pile.parameters.seed = seed;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const int side = int(std::ceil(std::cbrt(rocks)));
  double start = 0.0;
  for (int k = 0; k < rocks; ++k)
  {
    const int a = k % side, b = k / side % side, c = k / side / side;
    const double x = 20.0 + 1.7 * a, y = 150.0 + 1.7 * b, size = 0.6 + 0.3 * u(random);
    Rock rock = rockfall::testing::brick(
      size * Vec3(1.0, 0.8, 1.2), Vec3(x, y, height(x, y) + 2.0 + 1.7 * c + 1.2 * a), k);
    rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    pile.rocks.push_back(rock);
    start += x / rocks;
  }
  pile.make();
  pile.fall->setLargestSoft(resolved);
  Fall fall;
  std::vector<double> stops;
  for (const Trajectory& t : pile.fall->run())
  {
    stops.push_back(t.summary.stop.x() - start);
    fall.way += stops.back() / rocks;
    rockfall::testing::add(fall.energy, t.summary.energy);
  }
  std::sort(stops.begin(), stops.end(), std::greater<>());
  const int tenth = rocks / 10;
  for (int k = 0; k < tenth; ++k)
  {
    fall.lead += stops[std::size_t(k)] / tenth;
  }
  return fall;
}

} // namespace

TEST(MassFall, ColumnOfTenStands)
{
  Pile pile;
  pile.ground = rockfall::testing::floorSlope();
  pile.rocks = rockfall::testing::column(10);
  stand("column of 10 cubes", pile);
}

TEST(MassFall, WallStands)
{
  Pile pile;
  pile.ground = rockfall::testing::floorSlope();
  pile.rocks = rockfall::testing::wall(10, 5);
  stand("wall of 10 rows of 5 bricks", pile);
}

TEST(MassFall, ArchStands)
{
  Pile pile;
  pile.ground = rockfall::testing::floorSlope(45.0);
  pile.parameters.rockFrictionAngle = radians(40.0);
  pile.rocks = rockfall::testing::arch();
  stand("arch of 11 stones", pile);
}

TEST(MassFall, HeapsOfCubes)
{
  const int cubes = count(45, 1000);
  const std::vector<double> frictions =
    full() ? std::vector<double>{ 10.0, 20.0, 30.0, 40.0 } : std::vector<double>{ 10.0, 40.0 };
  std::vector<double> angles;
  for (const double friction : frictions)
  {
    const Heap heap = drop(cubes, friction);
    const std::string circumstances =
      text(cubes) + " cubes of 0.6 m³, φ " + text(friction) + "°, Δt " + text(kTimeStep) + " s: ";
    recordAtMost({ kHeap, circumstances + "deepest overlap", "of an edge", "the bar: 1 %" },
      heap.overlap, 0.01);
    record({ kHeap, circumstances + "share at rest in the end", "", "all of them" }, heap.resting,
      1.0, 0.0);
    // All of them sleep then: what trembles or turns on the spot has been found out.
    recordAtMost({ kHeap, circumstances + "time to rest", "s", "before the run of 60 s ends" },
      heap.duration, 59.0);
    report(
      { kHeap, circumstances + "slope of the heap, 2 z / r of its mean height and median distance",
        "°", "" },
      degrees(heap.repose));
    angles.push_back(degrees(heap.repose));
  }
  // Some dozen cubes are no heap whose slope says anything. Beyond 30° cubes roll before they
  // slide.
  for (std::size_t k = 1; full() && k < angles.size(); ++k)
  {
    const Figure figure = { kHeap,
      "slope of the heap at φ " + text(frictions[k]) + "° less that at φ " +
        text(frictions[k - 1]) + "°",
      "°", frictions[k] <= 30.0 ? "it grows with φ" : "" };
    frictions[k] <= 30.0 ? recordAtLeast(figure, angles[k] - angles[k - 1], 0.0)
                         : report(figure, angles[k] - angles[k - 1]);
  }
  addCurve("heap-repose", text(cubes) + " cubes", frictions, angles);
}

TEST(MassFall, CrowdsGoAsFarAsResolved)
{
  // The same rocks twice: as islands, with each impact by itself, and all stepped as a crowd.
  const int rocks = 40, runs = count(6, 40);
  struct Kind
  {
    std::vector<double> ways, leads;
    EnergyAudit energy;
  };
  Kind kinds[2];
  for (int k = 0; k < runs; ++k)
  {
    for (int crowd = 0; crowd < 2; ++crowd)
    {
      const Fall fall = rush(rocks, std::uint64_t(k + 1), crowd ? 0 : rocks);
      Kind& kind = kinds[crowd];
      kind.ways.push_back(fall.way);
      kind.leads.push_back(fall.lead);
      rockfall::testing::add(kind.energy, fall.energy);
    }
  }
  const std::string circumstances =
    text(rocks) + " cuboids of 0.03 to 0.7 m³ down 42°, " + text(runs) + " times: ";
  const auto compare = [&](const char* what, const std::vector<double>& resolved,
                         const std::vector<double>& crowd, double share)
  {
    // Runs of chaos: neither knows of the other one's after the first impacts.
    double means[2] = {}, variance = 0.0;
    for (int side = 0; side < 2; ++side)
    {
      const std::vector<double>& values = side ? crowd : resolved;
      for (const double v : values)
      {
        means[side] += v / runs;
      }
      for (const double v : values)
      {
        variance += (v - means[side]) * (v - means[side]) / (runs * (runs - 1.0));
      }
    }
    record({ kCrowd, circumstances + what + ", as a crowd", "m",
             text(100.0 * share) + " % of the way, and three standard errors of the difference" },
      means[1], means[0], share * means[0] + 3.0 * std::sqrt(variance));
  };
  compare("mean way", kinds[0].ways, kinds[1].ways, 0.03);
  compare("mean way of the leading tenth", kinds[0].leads, kinds[1].leads, 0.05);
  const EnergyAudit &a = kinds[0].energy, &b = kinds[1].energy;
  const auto shares = [&](const char* what, double EnergyAudit::*part)
  {
    // A crowd has one impulse for the step in which an impact falls, and friction by how it slides
    // in the end: of what an impact takes some more is friction's.
    record({ kCrowd, circumstances + "share of the energy that " + what + ", as a crowd", "",
             "3 % of what was released" },
      b.*part / b.released, a.*part / a.released, 0.03);
  };
  shares("friction with the slope takes", &EnergyAudit::friction);
  shares("impacts on the slope take", &EnergyAudit::restitution);
  shares("is lost between rocks", &EnergyAudit::exchanged);
  shares("is damped", &EnergyAudit::damping);
  recordAtMost({ kCrowd, circumstances + "numerical remainder of the audit, as a crowd", "",
                 "every joule is booked" },
    std::abs(b.numerical / b.released), 1e-3);
}
