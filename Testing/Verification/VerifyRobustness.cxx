// Nothing hangs and nothing becomes NaN, however unreasonable the input. Each case is a test of its
// own, so that ctest's TIMEOUT is the guard of one.

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::makeSlope;

namespace
{

struct Ordeal
{
  const char* name;
  const char* words;
  std::function<Terrain()> ground;
  std::function<std::vector<Rock>()> rocks;
  std::function<void(SimulationParameters&)> change;
};

std::vector<Rock> shower(const std::function<Polyhedron(int)>& shape, double height, double speed,
  const Vec3& middle, double spread, int number = 8)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Rock> rocks;
  for (int k = 0; k < number; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = shape(k);
    rock.orientation = uniformAttitude(u(random), u(random), u(random));
    rock.position = middle +
      Vec3(spread * (u(random) - 0.5), spread * (u(random) - 0.5), height + rock.shape.radius());
    rock.velocity = speed * Vec3(u(random) - 0.5, u(random) - 0.5, -u(random)).normalized();
    rock.angularVelocity = 5.0 * uniformDirection(u(random), u(random));
    rocks.push_back(rock);
  }
  return rocks;
}

Polyhedron mixed(int k)
{
  constexpr Shape shapes[] = { Shape::Cube, Shape::Tetrahedron, Shape::Icosahedron,
    Shape::Eota221 };
  return makeShape(shapes[k % 4], 1.0);
}

Terrain bumpy(double cell, int nodes, double height, const SurfaceMaterial& material)
{
  std::mt19937 random(17);
  std::uniform_real_distribution<double> u(-0.5, 0.5);
  return makeSlope(
    nodes, cell, [&](double, double) { return height * u(random); }, material);
}

/// Two walls that meet at a sharp angle along y, and a spike of a pit in them.
Terrain gorge(const SurfaceMaterial& material)
{
  return makeSlope(
    41, 0.5, [](double x, double y) { return 4.0 * std::abs(x - 10.0) + 0.5 * std::abs(y - 10.0); },
    material);
}

std::vector<Ordeal> ordeals()
{
  const Vec3 ten(10.0, 10.0, 0.0);
  const auto on = [=](double height, double speed = 3.0, double spread = 4.0)
  { return [=] { return shower(mixed, height, speed, ten, spread); }; };
  const auto none = [](SimulationParameters&) {};
  return {
    { "OpenCloseThatDoesNotSettle", "two open–close iterations and no cuts allowed, rough ground",
      [] { return bumpy(0.5, 41, 0.4, surface(0.8, 30.0)); }, on(2.0),
      [](SimulationParameters& p)
      {
        p.maxOpenClose = 2;
        p.maxCuts = 0;
      } },
    { "WedgedInAPit", "rocks of 1 m³ fall into a gorge of 76° walls, φ 40°",
      [] { return gorge(surface(0.5, 40.0)); }, [=] { return shower(mixed, 8.0, 1.0, ten, 0.5); },
      none },
    { "WedgedWithoutFriction", "the same with φ 0", [] { return gorge(surface(0.5, 0.0)); },
      [=] { return shower(mixed, 8.0, 1.0, ten, 0.5); }, none },
    { "Needle", "boxes of 0.02 x 0.02 x 2 m on rough ground",
      [] { return bumpy(0.5, 41, 0.3, surface(0.7, 30.0)); },
      [=] {
        return shower([](int) { return makeBox({ 0.02, 0.02, 2.0 }); }, 1.0, 5.0, ten, 4.0);
      },
      none },
    { "Plate", "plates of 1 : 1 : 0.05 on rough ground",
      [] { return bumpy(0.5, 41, 0.3, surface(0.7, 30.0)); },
      [=] {
        return shower([](int) { return makeBox({ 1.0, 1.0, 0.05 }); }, 1.0, 5.0, ten, 4.0);
      },
      none },
    { "RockAThousandTimesACell", "a rock of 10 m on cells of 0.01 m",
      [] { return bumpy(0.01, 2001, 0.002, surface(0.7, 30.0)); },
      [=]
      {
        return shower(
          [](int) { return makeShape(Shape::Icosahedron, 300.0); }, 0.01, 0.5, ten, 0.0, 1);
      },
      [](SimulationParameters& p) { p.endTime = 1.0; } },
    { "RockAThousandthOfACell", "rocks of 0.05 m on cells of 50 m",
      [] { return bumpy(50.0, 11, 20.0, surface(0.7, 30.0)); },
      []
      {
        return shower([](int k) { return mixed(k).withVolume(1e-4); }, 20.0, 5.0,
          Vec3(250.0, 250.0, 0.0), 50.0);
      },
      none },
    { "ZeroFriction", "rough ground without friction, Rv 1: nothing is ever lost",
      [] { return bumpy(0.5, 41, 0.3, surface(1.0, 0.0)); }, on(2.0), none },
    { "FrictionOf89Degrees", "φ 89°, rough ground",
      [] { return bumpy(0.5, 41, 0.3, surface(0.7, 89.0)); }, on(2.0), none },
    { "HundredMetresPerSecond", "released at 100 m/s, rough ground of 200 m",
      [] { return bumpy(2.0, 101, 1.5, surface(0.7, 30.0)); },
      [] { return shower(mixed, 2.0, 100.0, Vec3(100.0, 100.0, 0.0), 20.0); }, none },
    { "SoftBlock", "E 1e6 Pa under a penalty of 1e10 N/m",
      [] { return bumpy(0.5, 41, 0.3, surface(0.8, 30.0)); },
      [=]
      {
        std::vector<Rock> rocks = shower(mixed, 2.0, 3.0, ten, 4.0);
        for (Rock& rock : rocks)
        {
          rock.youngModulus = 1e6;
        }
        return rocks;
      },
      [](SimulationParameters& p) { p.normalPenalty = 1e10; } },
    { "OverTheEdge", "rocks of 0.4 m³ that land half on, half beyond the edge of cells of 0.1 m",
      [] { return bumpy(0.1, 65, 0.2, surface(0.5, 30.0)); },
      []
      {
        std::vector<Rock> rocks = shower([](int k) { return mixed(k).withVolume(0.4); }, 0.15, 15.0,
          Vec3(3.2, 3.2, 0.0), 6.0, 400);
        for (Rock& rock : rocks)
        {
          // Outwards, to the nearest edge.
          Vec3 way = rock.position - Vec3(3.2, 3.2, 0.0);
          way.z() = -0.3;
          rock.velocity = 15.0 * way.normalized();
          rock.angularVelocity *= 3.0;
        }
        return rocks;
      },
      [](SimulationParameters& p) { p.endTime = 1.0; } },
  };
}

} // namespace

class Robustness : public ::testing::TestWithParam<std::size_t>
{
};

TEST_P(Robustness, EndsWithNumbers)
{
  const Ordeal ordeal = ordeals()[GetParam()];
  const Terrain ground = ordeal.ground();
  const std::vector<Rock> rocks = ordeal.rocks();
  SimulationParameters p;
  p.endTime = 20.0;
  p.outputInterval = 0.05;
  ordeal.change(p);
  const std::vector<Trajectory> runs = simulateAll(ground, rocks, p);
  int broken = 0, under = 0;
  double worst = 0.0, gained = 0.0;
  std::int64_t cut = 0, unsettled = 0, steps = 0;
  for (std::size_t k = 0; k < runs.size(); ++k)
  {
    const Trajectory& t = runs[k];
    const TrajectorySummary& s = t.summary;
    bool finite = s.stop.allFinite() && std::isfinite(s.energy.numerical) &&
      std::isfinite(s.energy.friction) && std::isfinite(s.pathLength);
    bool below = false;
    for (const Sample& sample : t.samples)
    {
      finite = finite && sample.position.allFinite() && sample.velocity.allFinite() &&
        sample.angularVelocity.allFinite() && sample.orientation.coeffs().allFinite();
      below =
        below || sample.position.z() < ground.elevation(sample.position.x(), sample.position.y());
    }
    broken += !finite;
    under += below;
    worst = std::max(worst, std::abs(s.energy.numerical) / std::max(1.0, s.energy.released));
    gained = std::max(gained, -s.energy.numerical / std::max(1.0, s.energy.released));
    cut += s.cutSteps;
    unsettled += s.unsettledSteps;
    steps += s.contactSteps;
  }
  const std::string head = std::string(ordeal.words) + " (" + std::to_string(runs.size()) +
    (runs.size() == 1 ? " rock): " : " rocks): ");
  const std::string subject = "Robustness";
  recordAtMost({ subject, head + "runs with a number that is none", "",
                 "never; that the test ends at all is watched by a guard of 120 s" },
    broken, 0.0);
  recordAtMost(
    { subject, head + "rocks whose centroid got under the ground", "", "none" }, under, 0.0);
  recordAtMost({ subject, head + "largest energy made, share of that released", "",
                 "an input without reason may cost accuracy, but must not feed a rock" },
    gained, 0.05);
  report({ subject, head + "steps of contact", "", "" }, double(steps));
  report({ subject, head + "steps cut, counted in the summary", "", "" }, double(cut));
  report(
    { subject, head + "steps taken unsettled, counted in the summary", "", "" }, double(unsettled));
  if (std::string(ordeal.name) == "OpenCloseThatDoesNotSettle")
  {
    recordAtLeast({ subject, head + "steps taken unsettled are counted", "",
                    "two iterations are never enough to close a contact and see that it stays" },
      double(unsettled), 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Ordeals, Robustness, ::testing::Range<std::size_t>(0, 12),
  [](const ::testing::TestParamInfo<std::size_t>& ordeal)
  { return std::string(ordeals()[ordeal.param].name); });
