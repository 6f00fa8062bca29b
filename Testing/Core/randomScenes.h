#pragma once

/// @file
/// Scenes of random rocks on random ground, and what must hold in each of them whatever it is.

#include "base/errors.h"
#include "block/Block.h"
#include "geometry/shapes.h"
#include "runEnsemble.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace rockfall::testing
{

struct RandomScene
{
  Terrain terrain;
  std::vector<Rock> rocks;
  SimulationParameters parameters;
};

/// Draws with the same numbers on every platform.
class SceneDraw
{
public:
  explicit SceneDraw(std::uint64_t seed)
    : random_(seed * 0x9e3779b97f4a7c15ull + 1)
  {
  }
  double unit() { return double(random_() >> 11) * 0x1p-53; }
  double even(double low, double high) { return low + (high - low) * this->unit(); }
  /// Even in the logarithm.
  double over(double low, double high) { return low * std::pow(high / low, this->unit()); }
  int among(int count) { return int(random_() % std::uint64_t(count)); }
  bool oneIn(int count) { return this->among(count) == 0; }
  Vec3 direction()
  {
    const double z = this->even(-1.0, 1.0), turn = this->even(-M_PI, M_PI);
    const double r = std::sqrt(1.0 - z * z);
    return { r * std::cos(turn), r * std::sin(turn), z };
  }

private:
  std::mt19937_64 random_;
};

/// Boxes, splinters, plates, hulls, flat hulls and regular bodies; `size` is the longest edge, m.
inline Polyhedron randomShape(SceneDraw& draw, double size)
{
  const auto hull = [&](int points, double least, double width, double height)
  {
    std::vector<Vec3> corners;
    for (int k = 0; k < points; ++k)
    {
      const Vec3 d = 0.5 * size * draw.even(least, 1.0) * draw.direction();
      corners.push_back({ d.x(), width * d.y(), height * d.z() });
    }
    return Polyhedron::convexHull(corners).centred();
  };
  switch (draw.among(6))
  {
    case 0:
      return makeBox(size * Vec3(1.0, draw.even(0.3, 1.0), draw.even(0.3, 1.0)));
    case 1:
      return makeBox(size * Vec3(1.0, draw.over(0.02, 0.2), draw.over(0.02, 0.2)));
    case 2:
      return makeBox(size * Vec3(1.0, draw.even(0.5, 1.0), draw.over(0.02, 0.1)));
    case 3:
      return hull(6 + draw.among(40), 0.4, 1.0, 1.0);
    case 4:
      return hull(8 + draw.among(30), 1.0, draw.over(0.05, 1.0), draw.over(0.05, 0.5));
    default:
    {
      constexpr Shape regular[] = { Shape::Cube, Shape::Tetrahedron, Shape::Octahedron,
        Shape::Dodecahedron, Shape::Icosahedron, Shape::Eota111, Shape::Eota221 };
      return makeShape(regular[draw.among(7)], 0.3 * size * size * size);
    }
  }
}

/// A plane, a rough one, one with ridges, a bowl, stairs, one with pits, or a rough roof.
inline Terrain randomGround(SceneDraw& draw, double cell, int nodes)
{
  SurfaceMaterial m;
  m.restitution = draw.oneIn(8) ? double(draw.among(2)) : draw.unit();
  m.frictionAngle = radians(draw.even(0.0, 80.0));
  m.restitutionModel = RestitutionModel(draw.among(3));
  m.tangentialRestitution = draw.unit();
  m.restitutionSpeed = draw.over(0.1, 50.0);
  m.cohesion = draw.oneIn(6) ? draw.over(1.0, 1e4) : 0.0;
  const int kind = draw.among(7);
  const double slope = std::tan(radians(draw.even(0.0, 50.0))), middle = 0.5 * (nodes - 1) * cell;
  const double high = draw.over(0.01, 3.0) * cell, wave = draw.over(2.0, 20.0) * cell;
  GridGeometry g;
  g.columns = g.rows = nodes;
  g.cellSize = cell;
  std::vector<double> heights;
  for (int row = 0; row < nodes; ++row)
  {
    for (int column = 0; column < nodes; ++column)
    {
      const double x = column * cell, y = (nodes - 1 - row) * cell, noise = draw.even(-1.0, 1.0);
      const double heightsOf[] = { -slope * x, -slope * x + high * noise,
        -slope * x + 8.0 * high * std::abs(std::remainder(x + 0.3 * y, wave)) / wave,
        slope * (std::abs(x - middle) + 0.5 * std::abs(y - middle)),
        -0.5 * wave * std::floor(x / wave), -slope * x - (noise > 0.85 ? 4.0 * high : 0.0),
        -slope * std::abs(x - middle) + high * noise };
      heights.push_back(heightsOf[kind]);
    }
  }
  return Terrain(g, std::move(heights), m);
}

/// Stiffness of springs that carry a rock, N/m: the Core refuses what would lie deep in the ground.
inline double carryingPenalty(const Rock& rock)
{
  return 60.0 * rock.density * rock.shape.integrals().volume * 9.81 / rock.shape.radius();
}

/// One to `most` rocks; several hit each other.
inline RandomScene randomScene(std::uint64_t seed, int most, double seconds)
{
  SceneDraw draw(seed);
  RandomScene scene;
  const int count = draw.oneIn(4) ? 1 : 2 + draw.among(most - 1);
  const double size = draw.over(0.01, 10.0);
  const int nodes = 32;
  const double cell = std::max(draw.over(0.1, 10.0), 6.0 * size / (nodes - 1));
  scene.terrain = randomGround(draw, cell, nodes);
  SimulationParameters& p = scene.parameters;
  p.timeStep = draw.over(0.001, 0.03);
  p.endTime = seconds;
  p.outputInterval = 0.02;
  const double penalty = draw.over(1e7, 1e11);
  double carrying = 0.0;
  p.rigid = draw.oneIn(3);
  p.seed = int(seed % 1000);
  p.rockRockContact = p.pushRocksApart = count > 1;
  p.rockRestitution = draw.unit();
  p.rockFrictionAngle = radians(draw.even(0.0, 80.0));
  const double length = (nodes - 1) * cell;
  const double spread = std::min(0.3 * length, 2.0 * size * std::cbrt(double(count)));
  const double speed = draw.oneIn(2) ? 0.0 : draw.over(0.1, 30.0);
  const double spin = draw.oneIn(2) ? 0.0 : draw.over(0.1, 50.0);
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = randomShape(draw, size * draw.over(0.2, 1.0));
    rock.orientation =
      Quat(draw.even(-1.0, 1.0), draw.even(-1.0, 1.0), draw.even(-1.0, 1.0), draw.even(-1.0, 1.0))
        .normalized();
    rock.density = draw.over(500.0, 5000.0);
    rock.youngModulus = draw.over(1e8, 1e11);
    rock.velocity = speed * draw.direction();
    rock.angularVelocity = spin * draw.direction();
    const double r = rock.shape.radius();
    const double x = 0.5 * length + draw.even(-spread, spread);
    const double y = 0.5 * length + draw.even(-spread, spread);
    rock.position = { x, y,
      scene.terrain.maxHeight(x - r, x + r, y - r, y + r) + 1.01 * r + 2.0 * size * draw.unit() };
    carrying = std::max(carrying, carryingPenalty(rock));
    scene.rocks.push_back(std::move(rock));
  }
  // One scene of three has the panel's, where it carries the rocks.
  if (seed % 3 != 0 || carrying > p.pairPenalty())
  {
    p.normalPenalty = std::max(penalty, carrying);
  }
  return scene;
}

/// The first rock of a random scene, alone, as a sphere or an ellipsoid about as large.
inline RandomScene roundScene(std::uint64_t seed, double seconds)
{
  RandomScene scene = randomScene(seed, 2, seconds);
  scene.rocks.resize(1);
  SimulationParameters& p = scene.parameters;
  p.rockRockContact = p.pushRocksApart = false;
  SceneDraw draw(~seed);
  Rock& rock = scene.rocks.front();
  const double r = rock.shape.radius();
  Vec3 lengths(2.0 * r, 2.0 * r, 2.0 * r);
  if (draw.oneIn(2))
  {
    lengths.y() *= draw.even(0.3, 1.0);
    lengths.z() *= draw.even(0.25, 1.0);
  }
  rock.shape = makeEllipsoid(lengths);
  if (p.normalPenalty > 0.0)
  {
    p.normalPenalty = std::max(p.normalPenalty, carryingPenalty(rock));
  }
  return scene;
}

/// The shortest way (m) from a point under the slope out of it; 0 over it.
inline double depthUnder(const Terrain& terrain, const Vec3& point)
{
  const GridGeometry& g = terrain.geometry();
  double least = terrain.elevation(point.x(), point.y()) - point.z();
  if (!(least > 0.0))
  {
    return 0.0;
  }
  const auto node = [&](int row, int column)
  {
    return Vec3(
      column * g.cellSize, (g.rows - 1 - row) * g.cellSize, terrain.nodeHeight(row, column));
  };
  const auto toSegment = [&](const Vec3& a, const Vec3& b)
  {
    const double t = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (point - a - t * (b - a)).norm();
  };
  const auto toTriangle = [&](const Vec3& a, const Vec3& b, const Vec3& c)
  {
    const Vec3 n = (b - a).cross(c - a).normalized();
    const Vec3 foot = point - n.dot(point - a) * n;
    const bool inside = n.dot((b - a).cross(foot - a)) >= 0.0 &&
      n.dot((c - b).cross(foot - b)) >= 0.0 && n.dot((a - c).cross(foot - c)) >= 0.0;
    return inside ? std::abs(n.dot(point - a))
                  : std::min({ toSegment(a, b), toSegment(b, c), toSegment(c, a) });
  };
  const int reach = int(std::ceil(least / g.cellSize)) + 1;
  const int column = int(point.x() / g.cellSize), row = g.rows - 2 - int(point.y() / g.cellSize);
  for (int r = std::max(0, row - reach); r <= std::min(g.rows - 2, row + reach); ++r)
  {
    for (int c = std::max(0, column - reach); c <= std::min(g.columns - 2, column + reach); ++c)
    {
      const Vec3 nw = node(r, c), ne = node(r, c + 1), sw = node(r + 1, c), se = node(r + 1, c + 1);
      const bool rising = terrain.isRising(r, c);
      least = std::min(
        { least, toTriangle(nw, sw, rising ? ne : se), toTriangle(rising ? sw : nw, se, ne) });
    }
  }
  return least;
}

/// What a scene has shown.
struct SceneOutcome
{
  bool refused = false;  ///< Nothing was simulated: the Core says why.
  bool givenUp = false;  ///< It took longer than it may.
  double heard = 0.0;    ///< After what time that was heard, s.
  bool sameBits = true;  ///< On one thread and on two.
  double released = 0.0; ///< Energy that gravity released, J.
  double made = 0.0;     ///< Energy that came from nowhere, J; < 0: that was lost to it.
  double gained = 0.0;   ///< What rocks have and gave away beyond what gravity released of them, J.
  double tooDeep = 0.0;  ///< The deepest vertex, beyond what its spring explains, of the radius.
  std::string worst;     ///< Which one that is.
};

/// How deep springs let a rock be pressed into the ground, m: by what it comes with itself or by
/// another of `largestEnergy` (J) on it, at the weight of `load` (kg).
inline double explainedDepth(
  const Rock& rock, const SimulationParameters& p, double largestEnergy, double load)
{
  const Block block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
  const double soft = 1.0 / p.pairPenalty() + (p.rigid ? 0.0 : block.largestCompliance());
  return std::sqrt(2.0 * largestEnergy * soft) + 2.0 * load * p.gravity * soft;
}

/// Runs a scene on one thread and on two, each for at most `patience` (s).
inline SceneOutcome runScene(const RandomScene& scene, double patience)
{
  SceneOutcome outcome;
  std::vector<std::uint64_t> hashes[2];
  std::vector<Trajectory> trajectories;
  for (const int threads : { 1, 2 })
  {
    SimulationParameters p = scene.parameters;
    p.threads = threads;
    TrajectoryStore store(int(scene.rocks.size()), 1);
    const auto seconds = [start = std::chrono::steady_clock::now()]
    { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    const auto goOn = [&](double) { return seconds() < patience; };
    try
    {
      if (!runEnsemble(scene.terrain, scene.rocks, p, store, goOn))
      {
        outcome.givenUp = true;
        outcome.heard = seconds() - patience;
        return outcome;
      }
    }
    catch (const Error&)
    {
      outcome.refused = true;
      return outcome;
    }
    for (const Trajectory& t : store.trajectories())
    {
      hashes[threads - 1].push_back(t.summary.hash);
    }
    trajectories = store.take();
  }
  outcome.sameBits = hashes[0] == hashes[1];
  double largestEnergy = 0.0, load = 0.0;
  for (const Trajectory& t : trajectories)
  {
    largestEnergy = std::max(largestEnergy, t.summary.maxKineticEnergy);
    load += t.summary.mass;
  }
  for (const Trajectory& t : trajectories)
  {
    const TrajectorySummary& s = t.summary;
    const Rock& rock = scene.rocks[std::size_t(s.rock)];
    const double r = rock.shape.radius();
    outcome.released += s.energy.released;
    outcome.made -= s.energy.numerical;
    const double has = s.energy.kinetic + s.energy.strain + s.energy.exchanged;
    outcome.gained += std::max(0.0, has - s.energy.released);
    const double allowed =
      std::max(0.02 * r, 1.5 * explainedDepth(rock, scene.parameters, largestEnergy, load));
    for (const Sample& x : t.samples)
    {
      for (const Vec3& v :
        x.heightOverGround < -allowed ? rock.shape.vertices() : std::vector<Vec3>())
      {
        const double deep =
          (depthUnder(scene.terrain, x.position + x.orientation * v) - allowed) / r;
        if (deep > outcome.tooDeep)
        {
          outcome.tooDeep = deep;
          outcome.worst = "rock " + std::to_string(s.rock) + " at " + std::to_string(x.time) + " s";
        }
      }
    }
  }
  return outcome;
}

} // namespace rockfall::testing
