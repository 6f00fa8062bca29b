// Run-out on slopes of other cells: roughness as a field over the map must give what it gives,
// whatever the distance of the nodes; the paper's, drawn node by node, cannot.

#include "verification.h"

#include "statistics/sample.h"
#include "terrain/presets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace rockfall;
using namespace rockfall::verification;

namespace
{

constexpr double kFoot = 100.0;      // m from the upper edge
constexpr double kStart = 5.0;       // m
constexpr double kSlopeWidth = 60.0; // m
constexpr double kLength = 250.0;    // m
constexpr std::array<double, 4> kCells = { 0.5, 1.0, 2.0, 5.0 };

/// 30° for 100 m, then flat.
Terrain slope(double cell, const SurfaceMaterial& material, const Roughness& roughness,
  DeviationPer per = DeviationPer::Iteration)
{
  GridGeometry g;
  g.cellSize = cell;
  g.columns = int(std::lround(kLength / cell)) + 1;
  g.rows = int(std::lround(kSlopeWidth / cell)) + 1;
  std::vector<double> heights;
  for (int row = 0; row < g.rows; ++row)
  {
    for (int column = 0; column < g.columns; ++column)
    {
      heights.push_back(std::max(0.0, kFoot - column * cell) * std::tan(radians(30.0)));
    }
  }
  Terrain terrain(g, std::move(heights), material, roughness);
  terrain.setDeviationPer(per);
  return terrain;
}

SurfaceMaterial hardGround()
{
  SurfaceMaterial m = surface(0.4, 30.0, RestitutionModel::NormalTangential);
  m.tangentialRestitution = 0.9;
  return m;
}

/// EOTA 111 of 0.5 to 1 m³ in any attitude, each in ten iterations; sorted, m.
std::vector<double> runOuts(const Terrain& terrain, int rocks)
{
  std::mt19937 random(17);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  SimulationParameters p;
  p.endTime = 90.0;
  p.outputInterval = 1.0;
  std::vector<double> all;
  const int iterations = 10;
  std::vector<Rock> released(std::size_t(std::max(1, rocks / iterations)));
  for (Rock& rock : released)
  {
    rock.shape = makeShape(Shape::Eota111, 0.5 + 0.5 * u(random));
    rock.position =
      Vec3(kStart, 20.0 + 20.0 * u(random), (kFoot - kStart) * std::tan(radians(30.0)) + 2.0);
    rock.orientation = uniformAttitude(u(random), u(random), u(random));
  }
  p.iterations = iterations;
  for (const Trajectory& t : simulateAll(terrain, released, p))
  {
    all.push_back(t.summary.stop.x() - t.summary.start.x());
  }
  std::sort(all.begin(), all.end());
  return all;
}

struct Kind
{
  const char* name;
  Roughness roughness;
  bool field;
};

} // namespace

class RoughnessOnCells : public ::testing::TestWithParam<int>
{
};

TEST_P(RoughnessOnCells, RunOutIsThatOfTheGroundNotOfTheCells)
{
  const Kind kinds[] = {
    { "node by node, 0.1 ± 0.1 m", { 0.1, 0.1 }, false },
    { "field of 0.1 m, length 1 m", { 0.0, 0.1, 1.0, {} }, true },
    { "field of 0.15 m, length 1.4 m", { 0.0, 0.15, 1.4, {} }, true },
    { "obstacles of 0.1, 0.2 and 0.4 m, length 2 m", { 0.0, 0.0, 2.0, { 0.1, 0.2, 0.4 } }, true },
  };
  const Kind& kind = kinds[GetParam()];
  const int rocks = count(20, 400);
  const std::string subject = "Roughness and cells";
  double least = 1e9, most = 0.0;
  for (const double cell : kCells)
  {
    const std::vector<double> all = runOuts(slope(cell, hardGround(), kind.roughness), rocks);
    const double median = quantile(all, 0.5);
    const double beyond = median - (kFoot - kStart);
    least = std::min(least, beyond);
    most = std::max(most, beyond);
    const std::string head = std::string(kind.name) + ", cells of " + text(cell) + " m: ";
    report({ subject, head + "median run-out", "m", "" }, median);
    report({ subject, head + "median beyond the foot", "m", "" }, beyond);
    report({ subject, head + "95 % quantile", "m", "" }, quantile(all, 0.95));
  }
  const Figure spread{ subject,
    std::string(kind.name) + ": largest over smallest median beyond the foot", "",
    kind.field ? "the field is the same on all cells" : "drawn node by node: the cells decide" };
  if (kind.field)
  {
    // The median of few rocks scatters.
    recordAtMost(spread, most / least, full() ? 1.1 : 1.5);
  }
  else
  {
    report(spread, most / least);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, RoughnessOnCells, ::testing::Range(0, 4));

// Of all the way: rocks stop on the slope where the ground yields.
TEST(Roughness, PresetsAreTheSameGroundOnAllCells)
{
  const std::string subject = "Roughness and cells";
  for (const char* name : { "bedrock with boulders", "talus", "soil", "meadow" })
  {
    const GroundPreset& preset = groundPreset(name);
    double least = 1e9, most = 0.0;
    for (const double cell : kCells)
    {
      const double median =
        quantile(runOuts(slope(cell, preset.material(), preset.roughness, preset.deviationPer()),
                   count(20, 200)),
          0.5);
      least = std::min(least, median);
      most = std::max(most, median);
      report(
        { subject,
          std::string("preset ") + preset.label + ", cells of " + text(cell) + " m: median run-out",
          "m", "" },
        median);
    }
    // The median of few rocks scatters.
    recordAtMost(
      { subject, std::string("preset ") + preset.label + ": largest over smallest median run-out",
        "", "a preset brings its roughness as a field, the same on all cells" },
      most / least, full() ? 1.1 : 1.5);
  }
}
