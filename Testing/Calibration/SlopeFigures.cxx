#include "SlopeFigures.h"

#include "Summaries.h"
#include "longSlope.h"
#include "runEnsemble.h"

#include "statistics/sample.h"

#include <algorithm>
#include <cmath>

namespace rockfall::calibration
{

namespace
{

constexpr double kTop = 8.0;      // of the slope above the release, m
constexpr double kBeyond = 700.0; // of flat ground, m

} // namespace

SlopeFigures figuresOf(std::span<const TrajectorySummary> rocks)
{
  std::vector<double> speeds, jumps, runOuts, reach, times;
  for (const TrajectorySummary& t : rocks)
  {
    speeds.push_back(t.maxSpeed);
    jumps.push_back(t.maxHeightOverGround);
    runOuts.push_back(t.runOut);
    reach.push_back(degrees(std::atan2(t.start.z() - t.stop.z(), t.runOut)));
    times.push_back(t.endTime);
  }
  for (std::vector<double>* values : { &speeds, &jumps, &runOuts, &reach, &times })
  {
    std::ranges::sort(*values);
  }
  return { quantile(speeds, 0.95), quantile(jumps, 0.95), quantile(jumps, 0.5),
    quantile(runOuts, 0.5), quantile(reach, 0.5), quantile(reach, 0.01), times.back() };
}

SlopeFigures measure(
  const GroundSettings& s, const SlopeFall& fall, const std::vector<Polyhedron>& shapes)
{
  const double angle = radians(fall.angle);
  const double foot = 2.0 * std::round((kTop + fall.drop / std::tan(angle)) / 2.0); // on a node
  const testing::SlopeGround own{ s.material, s.roughness, s.deviationPer };
  const Terrain terrain = testing::makeLongSlope(
    angle, foot, kBeyond, own, fall.meadow ? testing::SlopeGround::ofPreset("meadow") : own);
  std::vector<Rock> rocks;
  for (const Polyhedron& shape : shapes)
  {
    Rock rock;
    rock.shape = shape;
    rock.density = s.density;
    const double over = std::max(2.0, 1.01 * shape.radius() / std::cos(angle));
    rock.position = Vec3(kTop, 60.0, terrain.elevation(kTop, 60.0) + over);
    rock.velocity = Vec3(1.5, 0.0, 0.0);
    rock.uncertainty.attitude = AttitudeLaw::Random;
    rock.blockId = std::int64_t(rocks.size()) + 1;
    rocks.push_back(std::move(rock));
  }
  Summaries ends;
  testing::runEnsemble(terrain, rocks, s.simulation, ends);
  return figuresOf(ends.all);
}

std::vector<Polyhedron> mixedShapes(double volume)
{
  const double side = std::cbrt(volume / 2.0);
  return { makeShape(Shape::Eota111, volume), makeShape(Shape::Cube, volume),
    makeBox(Vec3(2.0 * side, side, side)) };
}

} // namespace rockfall::calibration
