// Many rocks: piles that stand for a minute, heaps that come to rest without overlap and steeper
// with more friction.

#include "Core/piles.h"
#include "verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::Pile;

namespace
{

const char* const kStanding = "Piles that stand";
const char* const kHeap = "Heaps";

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
    recordAtMost({ kHeap, circumstances + "time to rest", "s", "the bar" }, heap.duration, 12.0);
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
