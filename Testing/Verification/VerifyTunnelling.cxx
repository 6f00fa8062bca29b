// METHOD 10.7: a fast small rock passes neither through a CFE nor out of the underside of the
// slope.

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;

namespace
{

constexpr int kNodes = 65;

/// The grounds that shots are fired at, all of them jagged at the scale of one cell.
enum class Jagged
{
  Noise,  ///< Every node on its own, up to one cell up or down.
  Ridges, ///< A saw of ridges and valleys, each side one cell wide.
  Pits,   ///< Flat with single nodes two cells deep, and single nodes as high.
  Steps,  ///< Terraces, their walls one cell wide and five cells high: 79°.
};

const char* nameOf(Jagged ground)
{
  constexpr const char* names[] = { "noise", "ridges", "pits and spikes", "vertical steps" };
  return names[int(ground)];
}

Terrain makeGround(Jagged ground, double cell, std::mt19937& random)
{
  std::uniform_real_distribution<double> u(0.0, 1.0);
  return rockfall::testing::makeSlope(
    kNodes, cell,
    [&](double x, double y)
    {
      const int i = int(std::lround(x / cell)), j = int(std::lround(y / cell));
      switch (ground)
      {
        case Jagged::Noise:
          return cell * (2.0 * u(random) - 1.0);
        case Jagged::Ridges:
          return cell * (i % 2) + 0.3 * cell * (j % 2);
        case Jagged::Pits:
          return u(random) < 0.1 ? (u(random) < 0.5 ? -2.0 : 2.0) * cell : 0.0;
        case Jagged::Steps:
          return 5.0 * cell * double((i / 8 + j / 12) % 3);
      }
      return 0.0;
    },
    surface(0.5, 30.0));
}

} // namespace

TEST(Tunnelling, NoShotGoesThrough)
{
  const long wanted = fromEnvironment("ROCKFALL_TUNNELLING_SHOTS", count(3000, 60000));
  const double cells[] = { 0.1, 0.3, 1.0, 2.5, 5.0 };
  constexpr Shape shapes[] = { Shape::Cube, Shape::Tetrahedron, Shape::Icosahedron,
    Shape::Eota221 };
  const long batch = std::min(1000L, std::max(1L, wanted / 20));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  long shots = 0, through = 0, broken = 0;
  std::int64_t unsettled = 0, cut = 0, steps = 0;
  double deepest = 0.0;
  for (long round = 0; shots < wanted; ++round)
  {
    const double cell = cells[round % 5];
    const Jagged kind = Jagged(round / 5 % 4);
    const Terrain ground = makeGround(kind, cell, random);
    std::vector<Rock> rocks;
    for (long k = 0; k < batch; ++k)
    {
      Rock rock;
      rock.blockId = shots + k;
      // 0.1 to 2 m across, the small ones as often as the large ones.
      const double size = 0.1 * std::pow(20.0, u(random));
      rock.shape = makeShape(shapes[k % 4], 1.0);
      rock.shape = rock.shape.transformed(
        0.5 * size / rock.shape.radius(), Quat::Identity(), { 0.0, 0.0, 0.0 });
      const double r = rock.shape.radius(), margin = std::min(0.4 * ground.width(), r + 0.01);
      const double x = margin + (ground.width() - 2.0 * margin) * u(random);
      const double y = margin + (ground.height() - 2.0 * margin) * u(random);
      rock.position = Vec3(x, y, ground.maxHeight(x - r, x + r, y - r, y + r) + r + 0.01);
      rock.orientation = uniformAttitude(u(random), u(random), u(random));
      // Down, from straight to grazing.
      Vec3 direction = uniformDirection(u(random), u(random));
      direction.z() = -std::abs(direction.z());
      rock.velocity = 60.0 * std::sqrt(u(random)) * direction;
      rock.angularVelocity = 20.0 * u(random) * uniformDirection(u(random), u(random));
      rocks.push_back(std::move(rock));
    }
    SimulationParameters p;
    p.endTime = 0.5;
    p.outputInterval = 0.02;
    const std::vector<Trajectory> runs = simulateAll(ground, rocks, p);
    for (std::size_t k = 0; k < runs.size(); ++k)
    {
      const Trajectory& t = runs[k];
      const double radius = rocks[k].shape.radius();
      bool under = false, finite = true;
      for (const Sample& s : t.samples)
      {
        finite = finite && s.position.allFinite() && s.velocity.allFinite() &&
          s.angularVelocity.allFinite();
        // The centroid is inside the rock: below the surface means that the surface is inside, too.
        const double over = s.position.z() - ground.elevation(s.position.x(), s.position.y());
        if (over < 0.0)
        {
          under = true;
          deepest = std::max(deepest, -over / radius);
        }
      }
      through += under;
      broken += !finite;
      unsettled += t.summary.unsettledSteps;
      cut += t.summary.cutSteps;
      steps += t.summary.contactSteps;
      if (under && through <= 10)
      {
        ADD_FAILURE() << "through: shot " << rocks[k].blockId << ", " << nameOf(kind) << ", cell "
                      << cell << " m, rock of " << 2.0 * radius << " m at "
                      << rocks[k].velocity.norm() << " m/s";
      }
    }
    shots += batch;
  }
  const std::string head = std::to_string(shots) +
    " shots of rocks of 0.1 to 2 m, up to 60 m/s, cells of 0.1 to 5 m (noise, ridges, pits and "
    "spikes, vertical steps): ";
  recordAtMost(
    { "Tunnelling", head + "rocks whose centroid got under the surface", "", "METHOD 10.7: none" },
    double(through), 0.0);
  recordAtMost(
    { "Tunnelling", head + "runs with a number that is none", "", "none" }, double(broken), 0.0);
  report({ "Tunnelling", head + "deepest centroid under the surface, in radii", "", "" }, deepest);
  report({ "Tunnelling", head + "share of steps taken unsettled", "", "" },
    double(unsettled) / double(std::max<std::int64_t>(1, steps)));
  report({ "Tunnelling", head + "share of steps that were cut", "", "" },
    double(cut) / double(std::max<std::int64_t>(1, steps)));
}
