// A crest made of many triangles is one plane: rocks slide, roll and tumble over the edges inside
// it as over the same plane made of the terrain.

#include "slopes.h"
#include "terrain/Obstacles.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kSize = 256.0, kHeight = 8.0; // m

/// z = 100 + `raised` − x/4, exact in binary.
Terrain plane(double raised, const SurfaceMaterial& m)
{
  return makeSlope(
    2, kSize, [=](double x, double) { return 100.0 + raised - 0.25 * x; }, m);
}

/// The same plane as a crest, 48 m wide and upright on both sides, down the slope; its pieces are
/// 0.5 to 6 m long.
Terrain crest(bool inPieces, const SurfaceMaterial& m)
{
  Embankment e;
  e.feature = 1;
  e.points = { { 40.0, 128.0 } };
  for (int k = 0; inPieces && e.points.back().x() < 212.0; ++k)
  {
    e.points.emplace_back(e.points.back().x() + 0.5 + 0.6875 * ((5 * k) % 9), 128.0);
  }
  e.points.emplace_back(220.0, 128.0);
  e.height = kHeight;
  e.crestWidth = 48.0;
  e.mountainSlope = e.valleySlope = 0.0;
  Structures s;
  s.embankments = { e };
  Terrain terrain = plane(0.0, m);
  terrain.setStructures(s);
  return terrain;
}

constexpr double kStart = 60.0; // m, where rocks are let go

} // namespace

/// Lasting contact over some twelve joints and the diagonals between them, turning, so that all
/// edges are met at all angles.
TEST(ObstacleEdges, InsideACrestAreNotFeltBySlidingRocks)
{
  const SurfaceMaterial m = material(0.8, 10.0);
  const Vec3 normal = Vec3(0.25, 0.0, 1.0).normalized();
  const std::pair<Polyhedron, double> shapes[] = { { makeShape(Shape::Cube, 1.0), 0.5 },
    { makeBox({ 2.0, 1.5, 0.3 }), 0.15 } };
  for (const auto& [shape, half] : shapes)
  {
    Rock rock;
    rock.shape = shape;
    rock.orientation =
      turnBetween(Vec3::UnitZ(), normal) * Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
    rock.position = Vec3(kStart, 129.0, 100.0 + kHeight - 0.25 * kStart) + half * normal;
    rock.velocity = 6.0 * Vec3(1.0, 0.0, -0.25).normalized();
    rock.angularVelocity = 1.5 * normal;
    SimulationParameters p;
    p.endTime = 5.0;
    p.outputInterval = 0.02;
    const Trajectory on = simulate(crest(true, m), rock, p);
    const Trajectory flat = simulate(plane(kHeight, m), rock, p);
    const std::vector<Sample> a = evenSamples(on), b = evenSamples(flat);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GT(on.summary.runOut, 35.0);
    EXPECT_EQ(on.summary.impacts, 0);
    for (std::size_t k = 0; k < a.size(); ++k)
    {
      // The planes are the same to the last digit but for where they are cut.
      ASSERT_LT((a[k].position - b[k].position).norm(), 1e-6) << k;
      ASSERT_LT(a[k].orientation.angularDistance(b[k].orientation), 1e-6) << k;
    }
  }
}

/// Rolling and tumbling, on a crest in pieces and on the same in one. An impact is resolved in some
/// eight steps; where the first of them begins depends on how closely flight was bounded, and so, a
/// little, on the triangles. After that, paths of tumbling rocks part. So compared are the impact
/// with which they begin to part, which must be the same within what the steps leave open (an edge
/// that is felt turns the rock), and how many do not part at all. Terrain bounds flight otherwise:
/// with it rocks are the same on average.
TEST(ObstacleEdges, InsideACrestAreNotFeltByTumblingRocks)
{
  const SurfaceMaterial m = material(0.7, 30.0);
  const Terrain pieces = crest(true, m), one = crest(false, m), flat = plane(kHeight, m);
  SimulationParameters p;
  p.endTime = 2.0;
  p.outputInterval = 0.02;
  p.normalPenalty = 1e9;
  std::mt19937_64 random(1);
  const auto uniform = [&] { return 2.0 * (double(random() >> 11) * 0x1p-53) - 1.0; };
  int same = 0, impacts = 0;
  Vec3 bias = Vec3::Zero();
  for (int k = 0; k < 60; ++k)
  {
    Rock rock;
    rock.shape = makeShape(k % 2 ? Shape::Cube : Shape::Icosahedron, 1.0);
    rock.orientation = Quat(uniform(), uniform(), uniform(), uniform()).normalized();
    const double x = kStart + 5.0 * uniform();
    rock.position = Vec3(x, 128.0 + 5.0 * uniform(), 100.0 + kHeight - 0.25 * x + 1.8);
    rock.velocity = Vec3(9.0 + 3.0 * uniform(), 2.0 * uniform(), 0.0);
    rock.angularVelocity = Vec3(uniform(), 3.0 + 2.0 * uniform(), uniform());
    const Trajectory a = simulate(pieces, rock, p), b = simulate(one, rock, p);
    for (const ImpactEvent& impact : a.impacts)
    {
      EXPECT_GT(impact.cfe, pieces.cfeCapacity()); // none on the ground beside the crest
    }
    impacts += a.summary.impacts;
    bias += (a.summary.stop - simulate(flat, rock, p).summary.stop) / 60.0;
    const std::size_t count = std::min(a.impacts.size(), b.impacts.size());
    std::size_t n = 0;
    while (n < count && std::abs(a.impacts[n].time - b.impacts[n].time) < 1e-9)
    {
      ++n;
    }
    // Rounding of 1e-12 m in the first impact has grown a thousand times after five.
    if ((a.summary.stop - b.summary.stop).norm() < (n == count ? 1e-8 : 1e-9))
    {
      ++same;
      continue;
    }
    ASSERT_LT(n, count);
    const ImpactEvent &i = a.impacts[n], &j = b.impacts[n];
    EXPECT_NEAR(i.time, j.time, 5e-4); // the length of such a step, r / 1000 over the speed
    EXPECT_LT((i.velocityAfter - j.velocityAfter).norm(), 0.02 * i.velocityBefore.norm())
      << "impact " << n << " at x = " << i.position.x();
  }
  EXPECT_GT(impacts, 150);
  EXPECT_GT(same, 30);
  EXPECT_LT(bias.norm(), 0.1); // of a way of 10 m
}
