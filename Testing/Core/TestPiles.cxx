// Rocks that lie on each other: they stand, slide and fall as they must.

#include "simulation/MassFall.h"
#include "slopes.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

struct Pile
{
  Terrain ground;
  std::vector<Rock> rocks;
  std::vector<Block> blocks;
  SimulationParameters parameters;
  std::unique_ptr<Surface> surface;
  std::unique_ptr<MassFall> fall;

  void start()
  {
    for (const Rock& r : rocks)
    {
      blocks.emplace_back(r.shape, r.density, r.youngModulus, r.poissonRatio);
    }
    parameters.rockRockContact = true;
    surface = std::make_unique<Surface>(ground, parameters.seed, 0);
    fall = std::make_unique<MassFall>(*surface, rocks, blocks, parameters);
    fall->awake = true;
    fall->release();
  }
  double run(double duration)
  {
    const double end = fall->time() + duration;
    while (fall->time() < end - 1e-9 && fall->advance())
    {
    }
    return fall->time();
  }
  double drift() const
  {
    double most = 0.0;
    for (int i = 0; i < fall->rocks(); ++i)
    {
      most = std::max(most, (fall->state(i).position - rocks[i].position).norm());
    }
    return most;
  }
  /// Sum of the slope's forces over the weight.
  double carried() const
  {
    double force = 0.0, weight = 0.0;
    for (int i = 0; i < fall->rocks(); ++i)
    {
      weight += blocks[i].mass() * parameters.gravity;
      for (const Contact& c : fall->slopeContacts(i))
      {
        force += c.normalForce * c.normal.z();
      }
    }
    return force / weight;
  }
};

Terrain floorSlope()
{
  return makeSlope(
    9, 5.0, [](double, double) { return 0.0; }, material(0.3, 35.0));
}

Rock brick(const Vec3& size, const Vec3& center, std::int64_t id)
{
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
  {
    corners.emplace_back((k & 1 ? 0.5 : -0.5) * size.x(), (k & 2 ? 0.5 : -0.5) * size.y(),
      (k & 4 ? 0.5 : -0.5) * size.z());
  }
  Rock rock;
  rock.blockId = id;
  rock.shape = Polyhedron::convexHull(corners);
  rock.position = center;
  return rock;
}

} // namespace

TEST(Piles, ColumnOfTenStands)
{
  Pile pile;
  pile.ground = floorSlope();
  for (int i = 0; i < 10; ++i)
  {
    pile.rocks.push_back(brick(Vec3(1, 1, 1), Vec3(20.0, 20.0, 0.5 + i), i));
  }
  pile.start();
  for (int k = 0; k < 6; ++k)
  {
    pile.run(k == 0 ? 1.0 : 0.5);
    double v = 0;
    for (int i = 0; i < 10; ++i)
      v = std::max(v, pile.fall->state(i).velocity.norm());
    std::printf(
      "t %g drift %.3e carried %.6f v %g\n", pile.fall->time(), pile.drift(), pile.carried(), v);
  }
}

TEST(Piles, WallStands)
{
  Pile pile;
  pile.ground = floorSlope();
  for (int row = 0; row < 10; ++row)
  {
    for (int k = 0; k < 5; ++k)
    {
      pile.rocks.push_back(brick(Vec3(1.0, 0.5, 0.5),
        Vec3(18.0 + k + 0.25 * (row % 2), 20.0, 0.25 + 0.5 * row), 10 * row + k));
    }
  }
  pile.start();
  for (int k = 0; k < 4; ++k)
  {
    pile.run(0.25);
    double v = 0;
    for (int i = 0; i < 50; ++i)
      v = std::max(v, pile.fall->state(i).velocity.norm());
    std::printf(
      "t %g drift %.3e carried %.6f v %g\n", pile.fall->time(), pile.drift(), pile.carried(), v);
  }
}

TEST(Piles, ArchStands)
{
  // Eleven voussoirs of a semicircle on two abutments.
  Pile pile;
  pile.ground = floorSlope();
  pile.ground = makeSlope(
    9, 5.0, [](double, double) { return 0.0; }, material(0.3, 45.0));
  pile.parameters.rockFrictionAngle = radians(40.0);
  const int n = 11;
  const double r0 = 2.0, r1 = 3.0, depth = 0.5;
  for (int k = 0; k < n; ++k)
  {
    std::vector<Vec3> corners;
    for (int s = 0; s < 2; ++s)
    {
      const double a = std::numbers::pi * (k + s) / n;
      for (double r : { r0, r1 })
      {
        for (double y : { -depth, depth })
        {
          corners.emplace_back(20.0 + r * std::cos(a), 20.0 + y, r * std::sin(a));
        }
      }
    }
    Rock rock;
    rock.blockId = k;
    const Polyhedron hull = Polyhedron::convexHull(corners);
    rock.position = hull.integrals().centroid;
    rock.shape = hull.centred();
    pile.rocks.push_back(rock);
  }
  pile.start();
  for (int k = 0; k < 6; ++k)
  {
    pile.run(0.5);
    double v = 0;
    for (int i = 0; i < n; ++i)
      v = std::max(v, pile.fall->state(i).velocity.norm());
    std::printf(
      "t %g drift %.3e carried %.6f v %g\n", pile.fall->time(), pile.drift(), pile.carried(), v);
  }
}

TEST(Piles, Dominoes)
{
  for (double dt : { 0.01, 0.005, 0.0025, 0.00125 })
  {
    Pile pile;
    pile.ground = floorSlope();
    pile.parameters.timeStep = dt;
    pile.parameters.rockRestitution = 0.0;
    for (int k = 0; k < 20; ++k)
    {
      pile.rocks.push_back(brick(Vec3(0.2, 0.5, 1.0), Vec3(15.0 + 0.5 * k, 20.0, 0.5), k));
    }
    // The first leans beyond its edge.
    const double lean = radians(14.0);
    pile.rocks[0].orientation = Quat(Eigen::AngleAxisd(lean, Vec3::UnitY()));
    pile.rocks[0].position = Vec3(15.0, 20.0, 0.5 * std::cos(lean) + 0.1 * std::sin(lean));
    pile.start();
    double first = 0, last = 0;
    while (pile.fall->time() < 8.0 && last == 0)
    {
      pile.fall->advance();
      if (first == 0 && pile.fall->state(5).position.z() < 0.49)
        first = pile.fall->time();
      if (last == 0 && pile.fall->state(18).position.z() < 0.49)
        last = pile.fall->time();
    }
    std::printf("dt %g: first %g last %g speed %g\n", dt, first, last, 13 * 0.5 / (last - first));
  }
}
