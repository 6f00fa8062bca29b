// Four single impacts of a platy rock of 780 kg whose scars were measured: depth and length of the
// simulated scars beside them, by slope of the ground, which is not given with them.
//
//   luImpacts [--set name=value]… [--iterations N] [--seed N]
//
// Lu, Caviezel, Christen, Bühler & Bartelt (2019), Landslides 16, 2353,
// doi:10.1007/s10346-019-01238-z: velocities, modulus and compaction of each impact, depth and
// length. The rock comes like a wheel, its axis level and across its way, turned about it by
// chance.

#include "GroundSettings.h"
#include "SingleImpact.h"
#include "fieldScores.h"

#include "Core/slopes.h"

#include "base/random.h"
#include "geometry/shapes.h"
#include "statistics/sample.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

using namespace rockfall;
using namespace rockfall::calibration;

namespace
{

/// An impact as published: before it, the ground's two fitted numbers, the scar.
struct Published
{
  Vec3 velocity; ///< m/s
  double rate;   ///< |ω|, rad/s
  double modulus, compaction;
  double depth, length;                 ///< Measured, m.
  double computedDepth, computedLength; ///< There, m.
};

constexpr double kMass = 780.0;                                       // kg
const Vec3 kSize(0.93, 0.93, 0.47);                                   // m
constexpr double kPlane = 20.0, kNodes = 201;                         // m; nodes of 0.1 m
constexpr std::array<double, 4> kSlopes = { 15.0, 20.0, 25.0, 30.0 }; // degrees

const std::array<Published, 4>& published()
{
  static const std::array<Published, 4> all = { {
    { { 5.56, -14.62, -11.20 }, 23.85, 25e6, 4.0, 0.13, 1.40, 0.14, 1.80 },
    { { 5.30, -12.70, -10.74 }, 26.30, 15e6, 1.5, 0.15, 1.80, 0.16, 1.64 },
    { { 5.34, -12.31, -10.36 }, 29.33, 10e6, 0.1, 0.18, 1.55, 0.18, 1.26 },
    { { 5.34, -14.19, -8.52 }, 28.69, 10e6, 0.5, 0.21, 1.52, 0.18, 1.77 },
  } };
  return all;
}

/// A plane that falls along the way of the rock.
Terrain makeGround(const GroundSettings& s, double degrees)
{
  GridGeometry g;
  g.columns = g.rows = int(kNodes);
  g.cellSize = kPlane / (kNodes - 1);
  std::vector<double> heights;
  for (int row = 0; row < g.rows; ++row)
  {
    for (int column = 0; column < g.columns; ++column)
    {
      heights.push_back(100.0 - std::tan(radians(degrees)) * column * g.cellSize);
    }
  }
  return makeTerrain(s, g, std::move(heights));
}

std::vector<Rock> drawRocks(const Published& impact, const Terrain& ground, const GroundSettings& s)
{
  Rock rock;
  rock.shape = makeShape(Shape::Eota221, 1.0);
  double half = 0.0;
  for (const Vec3& v : rock.shape.vertices())
  {
    half = std::max(half, v.x());
  }
  rock.shape = rock.shape.withVolume(std::pow(0.5 * kSize.x() / half, 3));
  rock.density = kMass / rock.shape.integrals().volume;
  // The way is along x here.
  rock.velocity = Vec3(impact.velocity.head<2>().norm(), 0.0, impact.velocity.z());
  rock.angularVelocity = impact.rate * Vec3::UnitY();
  rock.position = Vec3(0.4 * kPlane, 0.5 * kPlane, 0.0);
  rock.position.z() = ground.elevation(rock.position.x(), rock.position.y()) + 0.4;
  std::vector<Rock> rocks;
  for (int k = 0; k < s.simulation.iterations; ++k)
  {
    const double turn = 2.0 * std::numbers::pi *
      uniformDeviate(s.simulation.seed, std::uint32_t(k), Draw::Attitude, 0);
    rock.orientation = rockfall::testing::turnBetween(Vec3::UnitZ(), Vec3::UnitY()) *
      Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
    rocks.push_back(heldBack(ground, rock, s.simulation.gravity));
  }
  return rocks;
}

int run(int count, char** words)
{
  GroundSettings defaults;
  defaults.material.restitutionModel = RestitutionModel::NormalTangential;
  defaults.material.restitution = 0.0;
  defaults.material.yielding.frictionLeast = 0.55;
  defaults.material.yielding.frictionMost = 2.0;
  defaults.material.yielding.frictionGrowth = 3.0;
  defaults.material.yielding.frictionDecay = 185.0;
  defaults.simulation.normalPenalty = 0.0; // by mass, as in the panel
  defaults.simulation.iterations = 400;
  defaults.simulation.endTime = 1.0;
  defaults.simulation.outputInterval = 0.01;
  const Arguments arguments = parseArguments(count, words, defaults, {}, false);
  std::printf("%-8s %6s | %6s %6s %6s %6s %6s | %6s %6s %6s %6s %6s | %6s %6s %6s\n", "impact",
    "slope", "depth", "there", "5 %", "50 %", "95 %", "length", "there", "5 %", "50 %", "95 %",
    "E1/E0", "w1/w0", "dt s");
  int number = 0;
  for (const Published& impact : published())
  {
    ++number;
    for (const double slope : kSlopes)
    {
      GroundSettings s = arguments.settings;
      s.material.yielding.modulus = impact.modulus;
      s.material.yielding.compaction = impact.compaction;
      const Terrain ground = makeGround(s, slope);
      std::vector<double> depths, lengths, ratios, rates, durations;
      for (const ImpactOutcome& o :
        simulateImpacts(ground, drawRocks(impact, ground, s), s.simulation))
      {
        if (o.touched)
        {
          depths.push_back(o.scarDepth);
          lengths.push_back(o.scarLength);
          ratios.push_back(o.energyAfter / o.energyBefore);
          rates.push_back(o.rateAfter / o.rateBefore);
          durations.push_back(o.duration);
        }
      }
      std::ranges::sort(depths);
      std::ranges::sort(lengths);
      std::printf("%-8d %5.0f° | %6.2f %6.2f %6.2f %6.2f %6.2f | %6.2f %6.2f %6.2f %6.2f %6.2f | "
                  "%6.2f %6.2f %6.2f\n",
        number, slope, impact.depth, impact.computedDepth, quantile(depths, 0.05),
        quantile(depths, 0.5), quantile(depths, 0.95), impact.length, impact.computedLength,
        quantile(lengths, 0.05), quantile(lengths, 0.5), quantile(lengths, 0.95), median(ratios),
        median(rates), median(durations));
    }
  }
  return 0;
}

} // namespace

int main(int count, char** words)
{
  return runProgram(run, count, words);
}
