// Single impacts of tracked rocks, attitudes drawn: per impact the distribution of the energy left
// and of the rotation after it, and where the observed one lies in it. The folder has
// observed_contact_events.csv, observed_trajectories.csv and a grid terrain*.asc.
//
//   chantSura FOLDER [--ground NAME] [--set name=value]… [--iterations N] [--seed N]
//     [--wheel] [--plane]
//
// The ground is the preset Meadow where nothing else is said.
//
// Attitudes are uniform over all rotations; with --wheel a plate stands on its rim, its axis along
// its spin. A spin that was not tracked is drawn between none and rolling. With --plane the ground
// is the plane through the grid within 0.6 m of the place, else the grid itself, gone on beyond its
// edge.

#include "GroundSettings.h"
#include "SingleImpact.h"
#include "fieldScores.h"
#include "fieldTables.h"

#include "Core/slopes.h"

#include "base/errors.h"
#include "base/random.h"
#include "geometry/shapes.h"
#include "gis/raster/raster.h"
#include "statistics/sample.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

using namespace rockfall;
using namespace rockfall::calibration;

namespace
{

/// An impact as observed, at the seam of two flights.
struct Impact
{
  std::string id, track;
  Vec3 place, velocity;     ///< Of the centroid, in the world; before.
  Vec3 spin = Vec3::Zero(); ///< Before, rad/s.
  bool tracked = false;     ///< The spin is known.
  double mass = 0.0, volume = 0.0;
  bool plate = false;
  double energyRatio = 0.0; ///< Of translation.
  double spinEnergy = 0.0;  ///< After, J, as given at the start of the flight.
  double flightSpin = 0.0;  ///< The same, median of the flight.
  double rate = 0.0;        ///< |ω| after, median of the flight, rad/s.
};

std::vector<Impact> readImpacts(const std::string& folder)
{
  const FieldTable events(folder + "/observed_contact_events.csv");
  const FieldTable flights(folder + "/observed_trajectories.csv");
  std::map<std::string, std::vector<std::size_t>> rows;
  for (std::size_t k = 0; k < flights.size(); ++k)
  {
    rows[flights.text(k, "segment_id")].push_back(k);
  }
  std::vector<Impact> impacts;
  for (std::size_t k = 0; k < events.size(); ++k)
  {
    Impact i;
    i.id = events.text(k, "event_id");
    i.track = events.text(k, "source_trajectory_id");
    i.place = events.vector(k, "", "_m");
    i.velocity = events.vector(k, "incoming_v", "_mps");
    i.mass = events.number(k, "mass_kg");
    i.volume = 4.0 / 3.0 * std::numbers::pi * std::pow(events.number(k, "radius_m"), 3);
    // The plates of the experiment: 780 kg, and 250 kg in 2020.
    i.plate = i.mass > 500.0 || i.track.starts_with("RF20");
    i.energyRatio =
      events.number(k, "post_impact_kinetic_j") / events.number(k, "pre_impact_kinetic_j");
    const auto& before = rows.at(events.text(k, "source_segment_id"));
    const auto& after = rows.at(events.text(k, "next_segment_id"));
    const Vec3 spin = flights.vector(before.back(), "omega_", "_radps");
    i.tracked = spin.allFinite();
    if (i.tracked)
    {
      i.spin = spin;
      std::vector<double> energies, rates;
      for (const std::size_t row : after)
      {
        energies.push_back(flights.number(row, "rotational_j"));
        rates.push_back(flights.vector(row, "omega_", "_radps").norm());
      }
      i.spinEnergy = energies.front();
      i.flightSpin = median(energies);
      i.rate = median(rates);
    }
    impacts.push_back(i);
  }
  return impacts;
}

/// The plane z = a + bx (x − x0) + by (y − y0) by least squares of the nodes within a distance.
struct Plane
{
  double a = 0.0, bx = 0.0, by = 0.0;
};
Plane fitPlane(const Terrain& t, double x0, double y0, double within)
{
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (int row = 0; row < t.geometry().rows; ++row)
  {
    for (int column = 0; column < t.geometry().columns; ++column)
    {
      const Vec3 node = t.node(row, column);
      const Vec3 basis(1.0, node.x() - x0, node.y() - y0);
      if (std::isfinite(node.z()) && basis.tail<2>().norm() <= within)
      {
        normal += basis * basis.transpose();
        right += node.z() * basis;
      }
    }
  }
  const Vec3 solved = normal.ldlt().solve(right);
  return { solved[0], solved[1], solved[2] };
}

/// The grid with a margin on all sides, m, that goes on as the plane of all of it does, raised to
/// meet the edge; or the plane at a place.
Terrain groundAt(
  const Terrain& grid, const GroundSettings& s, const Vec3& place, bool plane, double margin)
{
  GridGeometry g = grid.geometry();
  const int more = int(std::ceil(margin / g.cellSize));
  const Plane own =
    plane ? fitPlane(grid, place.x(), place.y(), 0.6) : fitPlane(grid, place.x(), place.y(), 1e9);
  const auto heightOf = [&](double x, double y)
  { return own.a + own.bx * (x - place.x()) + own.by * (y - place.y()); };
  const int rows = g.rows, columns = g.columns;
  g.rows += 2 * more;
  g.columns += 2 * more;
  g.xOrigin -= more * g.cellSize;
  g.yOrigin -= more * g.cellSize;
  std::vector<double> heights;
  for (int row = -more; row < rows + more; ++row)
  {
    for (int column = -more; column < columns + more; ++column)
    {
      const double x = column * g.cellSize, y = (rows - 1 - row) * g.cellSize;
      double z = heightOf(x, y);
      if (!plane)
      {
        const Vec3 edge =
          grid.node(std::clamp(row, 0, rows - 1), std::clamp(column, 0, columns - 1));
        z += edge.z() - heightOf(edge.x(), edge.y());
      }
      heights.push_back(z);
    }
  }
  return makeTerrain(s, g, std::move(heights));
}

/// Rocks of one impact with attitudes, places and, where it is not known, spins that are drawn.
std::vector<Rock> drawRocks(const Impact& impact, const Terrain& ground, const Arguments& arguments)
{
  const GroundSettings& s = arguments.settings;
  const SimulationParameters& p = s.simulation;
  Rock rock;
  rock.shape = makeShape(impact.plate ? Shape::Eota221 : Shape::Eota111, impact.volume);
  rock.density = impact.mass / impact.volume;
  const Vec3 place = impact.place - ground.geometry().origin();
  std::vector<Rock> rocks;
  for (int k = 0; k < p.iterations; ++k)
  {
    const auto draw = [&](std::uint64_t number)
    { return uniformDeviates(p.seed, std::uint32_t(k), Draw::Attitude, number); };
    const auto deviates = normalDeviates(p.seed, std::uint32_t(k), Draw::StartPosition, 0);
    const auto [u, v] = draw(0);
    const auto [w, share] = draw(1);
    const Vec3 off = s.placeDeviation * Vec3(deviates[0], deviates[1], 0.0);
    rock.position = place + off;
    rock.position.z() += ground.elevation(rock.position.x(), rock.position.y()) -
      ground.elevation(place.x(), place.y());
    rock.velocity = impact.velocity;
    rock.angularVelocity = impact.spin;
    const Vec3 rolling = Vec3::UnitZ().cross(impact.velocity);
    if (!impact.tracked)
    {
      rock.angularVelocity = share * rolling / std::cbrt(0.75 * impact.volume / std::numbers::pi);
    }
    rock.orientation = randomRotation(u, v, w);
    if (impact.plate && arguments.has("--wheel"))
    {
      const Vec3 axis = rock.angularVelocity.norm() > 1e-6 ? rock.angularVelocity : rolling;
      rock.orientation = rockfall::testing::turnBetween(Vec3::UnitZ(), axis) *
        Quat(Eigen::AngleAxisd(2.0 * std::numbers::pi * u, Vec3::UnitZ()));
    }
    rocks.push_back(heldBack(ground, rock, p.gravity));
  }
  return rocks;
}

int run(int count, char** words)
{
  GroundSettings defaults;
  defaults.setGround("meadow");
  defaults.roughness = {}; // its survey has the humps
  defaults.cellSize = 0.1;
  defaults.simulation.normalPenalty = 0.0; // by mass, as in the panel
  defaults.simulation.iterations = 200;
  defaults.simulation.endTime = 1.2;
  defaults.simulation.outputInterval = 0.01;
  const Arguments arguments = parseArguments(count, words, defaults, { "--wheel", "--plane" });
  const GroundSettings& s = arguments.settings;
  const RasterSurface surface = readRaster(arguments.folder + "/terrain_rf16.asc", { s.cellSize });
  const Terrain grid(surface.geometry, surface.heights);
  const auto begin = std::chrono::steady_clock::now();

  std::printf("%-22s %5s | %5s %5s %5s %5s %5s %5s | %7s %7s %7s %7s %6s %6s | %5s %5s %5s %5s\n",
    "impact", "E1/E0", "5 %", "25 %", "50 %", "75 %", "95 %", "rank", "Erot J", "flight",
    "sim 50 %", "sim/obs", "rate", "sim", "flies", "dt s", "way m", "dep m");
  int inside = 0;
  std::vector<double> factors, flightFactors, rateFactors, observedRatios, medians;
  for (const Impact& impact : readImpacts(arguments.folder))
  {
    const Vec3 local = impact.place - surface.geometry.origin();
    const Terrain ground = groundAt(grid, s, local, arguments.has("--plane"), 3.0);
    std::vector<double> ratios, spins, rates, durations, ways, depths;
    double flies = 0.0;
    for (const ImpactOutcome& o :
      simulateImpacts(ground, drawRocks(impact, ground, arguments), s.simulation))
    {
      if (o.touched)
      {
        ratios.push_back(o.energyAfter / o.energyBefore);
        spins.push_back(o.spinAfter);
        rates.push_back(o.rateAfter);
        durations.push_back(o.duration);
        ways.push_back(o.way);
        depths.push_back(o.scarDepth);
        flies += o.tookOff;
      }
    }
    if (ratios.size() < 2)
    {
      throw DataError(impact.id + ": its rocks do not touch the ground");
    }
    std::ranges::sort(ratios);
    const double rank = rankOf(ratios, impact.energyRatio);
    const bool in = rank >= 0.05 && rank <= 0.95;
    inside += in;
    observedRatios.push_back(impact.energyRatio);
    medians.push_back(quantile(ratios, 0.5));
    std::printf("%-22s %5.2f | %5.2f %5.2f %5.2f %5.2f %5.2f %4.2f%c | ", impact.id.c_str(),
      impact.energyRatio, quantile(ratios, 0.05), quantile(ratios, 0.25), quantile(ratios, 0.5),
      quantile(ratios, 0.75), quantile(ratios, 0.95), rank, in ? ' ' : '*');
    if (impact.tracked)
    {
      factors.push_back(median(spins) / impact.spinEnergy);
      flightFactors.push_back(median(spins) / impact.flightSpin);
      rateFactors.push_back(median(rates) / impact.rate);
      std::printf("%7.0f %7.0f %7.0f  %7.2f %6.1f %6.1f", impact.spinEnergy, impact.flightSpin,
        median(spins), factors.back(), impact.rate, median(rates));
    }
    else
    {
      std::printf("%7s %7s %7.0f  %7s %6s %6.1f", "-", "-", median(spins), "-", "-", median(rates));
    }
    std::printf(" | %4.0f%% %5.2f %5.2f %5.2f\n", 100.0 * flies / double(ratios.size()),
      median(durations), median(ways), median(depths));
  }
  std::printf(
    "%d of %zu inside their 5-95 %% interval. Energy left: mean of medians %.2f, observed %.2f.\n"
    "Rotational energy, simulated median over observed: median factor %.2f (start of the "
    "flight), %.2f (median of the flight); rotation rate %.2f. %.1f s\n",
    inside, observedRatios.size(), mean(medians), mean(observedRatios), median(factors),
    median(flightFactors), median(rateFactors),
    std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  return 0;
}

} // namespace

int main(int count, char** words)
{
  return runProgram(run, count, words);
}
