// Scars wherever a rock touches ground that gives way: at its corners, faces and edges, on an
// embankment, and in mass falls; hard ground as the limit of all of them.

#include "dams.h"

#include "../../overlap.h"
#include "geometry/shapes.h"
#include "law/settings.h"
#include "run/stateHash.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// A cube of 1 m³ that falls straight down onto the middle of a slope, at 7 m/s or so.
Trajectory dropOnMiddle(const Terrain& terrain, const Quat& attitude, double height)
{
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.orientation = attitude;
  const double x = 0.5 * terrain.width(), y = 0.5 * terrain.height();
  rock.position = Vec3(x, y, terrain.elevation(x, y) + height + 3.0);
  SimulationParameters p;
  p.endTime = 3.0;
  return simulate(terrain, rock, p);
}

void expectScar(const Trajectory& t, const char* what)
{
  ASSERT_FALSE(t.impacts.empty()) << what;
  const ImpactEvent& first = t.impacts.front();
  const double down = -first.velocityBefore.z();
  const double depth = softGround().yielding.scarDepth(t.summary.mass, t.summary.volume, down);
  EXPECT_NEAR(first.scarDepth, depth, 0.05 * depth) << what;
  EXPECT_GT(t.summary.energy.scars, 0.0) << what;
  EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-3 * t.summary.energy.released) << what;
}

} // namespace

TEST(Scars, AreMadeByCornersEdgesAndFaces)
{
  const SurfaceMaterial ground = softGround();
  const Quat flat = Quat::Identity();
  const Quat onCorner = turnBetween(Vec3(1.0, 1.0, 1.0), Vec3::UnitZ());
  const Quat onEdge(Eigen::AngleAxisd(radians(45.0), Vec3::UnitX())); // along x
  expectScar(dropOnMiddle(makePlane(21, 40.0, 0.0, 0.0, ground), onCorner, 0.0), "corner, plane");
  const Terrain ridge = makeSlope(
    21, 2.0, [](double x, double) { return 100.0 - 0.5 * std::abs(x - 20.0); }, ground);
  expectScar(dropOnMiddle(ridge, onEdge, 0.0), "edge, ridge");
  const Terrain peak = makeSlope(
    21, 2.0,
    [](double x, double y) { return 100.0 - 0.4 * (std::abs(x - 20.0) + std::abs(y - 20.0)); },
    ground);
  expectScar(dropOnMiddle(peak, flat, 0.0), "face, peak");
}

TEST(Scars, AreMadeOnEmbankmentsOfTheSlopesMaterialOnly)
{
  const double height = 4.0;
  Embankment e = dam(height, 6.0, 1.5);
  Terrain own = level(softGround());
  own.setStructures(only(e));
  const Quat tilted = turnBetween(Vec3(1.0, 0.8, 0.6), Vec3::UnitZ());
  expectScar(dropOnMiddle(own, tilted, height), "crest");
  e.material = 1;
  Structures built = only(e);
  built.materials = { material(0.3, 30.0) };
  Terrain wall = level(softGround());
  wall.setStructures(built);
  const Trajectory t = dropOnMiddle(wall, tilted, height);
  ASSERT_FALSE(t.impacts.empty());
  EXPECT_EQ(t.impacts.front().scarDepth, 0.0);
  EXPECT_EQ(t.summary.energy.scars, 0.0);
}

// The wall is met where it stands, also by rocks that roll over it out of a scar beside it.
TEST(Scars, AWallOfItsOwnMaterialDoesNotSinkWithThem)
{
  const double height = 1.0, width = 1.0;
  Embankment e = dam(height, width, 0.0);
  e.material = 1;
  Structures built = only(e);
  built.materials = { material(0.3, 30.0) };
  Terrain terrain = level(softGround());
  terrain.setStructures(built);
  const Block wall(makeBox({ 60.0, width, height + 2.0 }), 2500.0, 1e10, 0.25);
  BlockState standing;
  standing.position = Vec3(50.0, 50.0, 100.0 + 0.5 * height - 1.0); // with its foot
  double deepestScar = 0.0;
  for (int k = 0; k < 8; ++k)
  {
    Rock rock;
    rock.shape = makeShape(k % 2 ? Shape::Eota111 : Shape::Cube, k < 4 ? 30.0 : 5.0);
    const Block block = blockOf(rock);
    const double edge = std::cbrt(k < 4 ? 30.0 : 5.0);
    rock.position = Vec3(50.0 + 0.3 * k, 50.0 - 1.5 * edge, 100.0 + 1.2 * edge);
    rock.velocity = Vec3(0.5, 8.0 + k % 4, -6.0);
    rock.orientation = Quat(Eigen::AngleAxisd(0.15 * (k % 4), Vec3(0.3, 0.7, 0.2).normalized()));
    SimulationParameters p;
    p.endTime = 4.0;
    p.outputInterval = 0.02;
    const Trajectory t = simulate(terrain, rock, p);
    double deepest = 0.0;
    for (const Sample& s : t.samples)
    {
      BlockState state;
      state.position = s.position;
      state.orientation = s.orientation;
      deepest = std::max(deepest,
        deepestOverlap(
          2, [&](int i) -> const Block& { return i == 0 ? block : wall; },
          [&](int i) { return i == 0 ? state : standing; }));
    }
    EXPECT_LT(deepest, 0.02 * edge) << k;
    for (const ImpactEvent& impact : t.impacts)
    {
      deepestScar = std::max(deepestScar, impact.scarDepth);
    }
    EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-3 * t.summary.energy.released) << k;
  }
  EXPECT_GT(deepestScar, 0.3);
}

// A rock in a scar beside its foot is not in it, however gentle its side is.
TEST(Scars, ADamOfItsOwnMaterialIsMetBelowItsFoot)
{
  const double height = 3.0, width = 1.0, slope = 2.0 / 3.0;
  Embankment e = dam(height, width, slope);
  e.material = 1;
  Structures built = only(e);
  built.materials = { material(0.3, 30.0) };
  Terrain terrain = level(softGround());
  terrain.setStructures(built);
  // The dam and what is under it: upright below its feet.
  const double foot = -kFootDepth, half = 0.5 * width + slope * (height - foot);
  std::vector<Vec3> corners;
  for (const double x : { -30.0, 30.0 })
  {
    for (const double side : { -1.0, 1.0 })
    {
      corners.emplace_back(x, 0.5 * width * side, height);
      corners.emplace_back(x, half * side, foot);
      corners.emplace_back(x, half * side, foot - 3.0);
    }
  }
  const Block solid(Polyhedron::convexHull(corners).centred(), 2500.0, 1e10, 0.25);
  double top = 0.0;
  for (const Vec3& corner : solid.shape().vertices())
  {
    top = std::max(top, corner.z());
  }
  BlockState standing;
  standing.position = Vec3(50.0, 50.0, 100.0 + height - top);
  double deepestScar = 0.0;
  for (int k = 0; k < 16; ++k)
  {
    Rock rock;
    rock.shape = makeShape(k % 2 ? Shape::Eota111 : Shape::Cube, k < 8 ? 30.0 : 5.0);
    const Block block = blockOf(rock);
    const double edge = std::cbrt(k < 8 ? 30.0 : 5.0);
    rock.position =
      Vec3(50.0 + 0.3 * k, 50.0 - half - (0.9 + 0.2 * (k % 4)) * edge, 100.0 + 1.2 * edge);
    rock.velocity = Vec3(0.5, 3.0 + 2.0 * (k % 4), -9.0);
    rock.orientation = Quat(Eigen::AngleAxisd(0.15 * (k % 4), Vec3(0.3, 0.7, 0.2).normalized()));
    SimulationParameters p;
    p.endTime = 4.0;
    p.outputInterval = 0.02;
    const Trajectory t = simulate(terrain, rock, p);
    double deepest = 0.0;
    for (const Sample& s : t.samples)
    {
      BlockState state;
      state.position = s.position;
      state.orientation = s.orientation;
      deepest = std::max(deepest,
        deepestOverlap(
          2, [&](int i) -> const Block& { return i == 0 ? block : solid; },
          [&](int i) { return i == 0 ? state : standing; }));
    }
    EXPECT_LT(deepest, 0.02 * edge) << k;
    for (const ImpactEvent& impact : t.impacts)
    {
      deepestScar = std::max(deepestScar, impact.scarDepth);
    }
    EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-3 * t.summary.energy.released) << k;
  }
  EXPECT_GT(deepestScar, 0.3);
}

TEST(Scars, HardGroundIsTheirLimitInMassFalls)
{
  std::vector<Rock> rocks;
  for (int k = 0; k < 8; ++k)
  {
    Rock rock;
    rock.shape = makeShape(k % 2 ? Shape::Cube : Shape::Eota111, 0.5);
    rock.position = Vec3(10.0 + 1.3 * (k % 2), 20.0 + 0.2 * (k % 3), 111.0 + 1.4 * (k / 2));
    rock.blockId = k;
    rocks.push_back(rock);
  }
  SimulationParameters p;
  p.rockRockContact = true;
  p.endTime = 5.0;
  const auto hashesOn = [&](const SurfaceMaterial& m)
  {
    TrajectoryStore store(int(rocks.size()), 1);
    runEnsemble(makePlane(21, 40.0, radians(25.0), 0.0, m), rocks, p, store);
    std::vector<std::uint64_t> hashes;
    for (const Trajectory& t : store.trajectories())
    {
      hashes.push_back(motionHash(t));
    }
    return hashes;
  };
  SurfaceMaterial hard = material(0.5, 25.0), almost = hard;
  almost.yielding.modulus = 1e15; // yields, but nowhere deeper than a hundredth of the radius
  EXPECT_EQ(hashesOn(hard), hashesOn(almost));
  almost.yielding.modulus = 15e6;
  EXPECT_NE(hashesOn(hard), hashesOn(almost));
}
