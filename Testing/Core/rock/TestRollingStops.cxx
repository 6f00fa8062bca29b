// Rolling that stops on the preset Meadow, whatever the rock's shape: at rest soon after its last
// bounce, and from there on no faster than its fall explains.

#include "slopes.h"

#include "form.h"
#include "terrain/presets.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kSide = 600.0;       // of the slope, m
constexpr int kNodes = 301;           // a side, for cells that its humps can cut
constexpr double kHeight = 3.0;       // of the centroid over the ground at the release, m
constexpr double kSpeed = 10.0;       // downhill at the release, m/s
constexpr int kAttitudes = 12;        // per shape and slope
constexpr double kSlenderness = 3.0;  // length of the prism over its width
constexpr double kMostRolling = 10.0; // from the last bounce to rest, s
constexpr double kMostWalking = 30.0; // s
constexpr double kWalks = 1.5;        // m/s, and slower
constexpr double kHair = 1e-6;        // m of fall

/// A shape with its name.
struct NamedShape
{
  std::string name;
  Polyhedron shape;
};

std::vector<NamedShape> allShapes()
{
  constexpr double volume = 0.5; // m³
  std::vector<NamedShape> all;
  for (const Shape shape : { Shape::Cube, Shape::Tetrahedron, Shape::Octahedron, Shape::Icosahedron,
         Shape::Eota111, Shape::Eota221 })
  {
    all.push_back({ shapeName(shape), makeShape(shape, volume) });
  }
  const Polyhedron cube = makeShape(Shape::Cube, volume);
  std::vector<Vec3> corners;
  for (const Vec3& v : cube.vertices())
  {
    corners.push_back({ v.x(), v.y(), kSlenderness * v.z() });
  }
  all.push_back({ "slender prism", Polyhedron::convexHull(corners).withVolume(volume) });
  return all;
}

/// Attitude number k: turned about axes that differ, by angles that do not come again.
Quat attitude(int k)
{
  return Quat(Eigen::AngleAxisd(0.7 * k, Vec3(1.0, 0.1 * k, 0.2 + 0.3 * k).normalized()));
}

/// On a slope of so many degrees.
void expectRollingToStop(double slope, const std::vector<NamedShape>& shapes)
{
  const GroundPreset& preset = groundPreset("meadow");
  Terrain meadow =
    makePlane(kNodes, kSide, radians(slope), 0.0, preset.material(), preset.roughness);
  meadow.setDeviationPer(preset.deviationPer());
  SimulationParameters p;
  p.endTime = 120.0;
  p.outputInterval = 0.05;
  for (const NamedShape& named : shapes)
  {
    std::vector<Rock> rocks;
    for (int k = 0; k < kAttitudes; ++k)
    {
      Rock rock;
      rock.shape = named.shape;
      rock.position = Vec3(100.0, 0.5 * kSide, 0.0);
      rock.position.z() = meadow.elevation(rock.position.x(), rock.position.y()) + kHeight;
      rock.orientation = attitude(k);
      rock.velocity = Vec3(kSpeed, 0.1 * k, 0.0);
      rock.blockId = k;
      rocks.push_back(rock);
    }
    TrajectoryStore store(int(rocks.size()), 1);
    runEnsemble(meadow, rocks, p, store);
    for (const Trajectory& t : store.trajectories())
    {
      const std::string name = named.name + ", attitude " + std::to_string(t.summary.rock);
      ASSERT_EQ(t.summary.fate, Fate::Rested) << name;
      ASSERT_FALSE(t.impacts.empty()) << name;
      const double lastBounce = t.impacts.back().time;
      EXPECT_LT(t.summary.endTime, lastBounce + kMostRolling) << name;
      // Height and the springs that the bounce has left compressed may become speed, nothing else.
      // Between the ends of a step samples are interpolated.
      const auto first =
        std::ranges::find_if(t.samples, [&](const Sample& s) { return s.time > lastBounce; });
      if (first == t.samples.end())
      {
        continue;
      }
      const double slack = kHair + first->velocity.norm() * p.timeStep;
      const double has = first->kineticEnergy + first->energy.strain;
      for (auto later = first; later != t.samples.end(); ++later)
      {
        const double fall = first->position.z() - later->position.z();
        EXPECT_LE(later->kineticEnergy, has + t.summary.mass * p.gravity * (fall + slack))
          << name << " at " << later->time << " s";
      }
    }
  }
}

} // namespace

TEST(RollingStops, OnTenDegreesWhateverItsShape)
{
  expectRollingToStop(10.0, allShapes());
}

// Steeper than the rolling resistance: the humps stop them.
TEST(RollingStops, OnTwelveDegreesWhateverItsShape)
{
  expectRollingToStop(12.0, allShapes());
}

// The EOTA 221 rolls on here, on its rim like a wheel.
TEST(RollingStops, OnFifteenDegreesButWheels)
{
  std::vector<NamedShape> shapes = allShapes();
  std::erase_if(shapes, [](const NamedShape& s) { return s.name == shapeName(Shape::Eota221); });
  expectRollingToStop(15.0, shapes);
}

// A little steeper than the rolling resistance: on smooth ground half of the rocks are below 1.5 m/s
// for more than half a minute.
TEST(RollingStops, FewWalkDownAMeadow)
{
  const GroundPreset& preset = groundPreset("meadow");
  Terrain meadow =
    makePlane(kNodes, kSide, radians(17.0), 0.0, preset.material(), preset.roughness);
  meadow.setDeviationPer(preset.deviationPer());
  std::vector<Rock> rocks;
  for (int k = 0; k < someOf(60, 12); ++k)
  {
    Rock rock;
    rock.shape = makeShape(Shape::Eota111, 1.0);
    rock.position = Vec3(50.0, 0.5 * kSide + 0.1 * k, 0.0);
    rock.position.z() = meadow.elevation(rock.position.x(), rock.position.y()) + kHeight;
    rock.orientation = attitude(k);
    rock.velocity = Vec3(5.0, 0.0, 0.0);
    rock.blockId = k;
    rocks.push_back(rock);
  }
  SimulationParameters p;
  p.endTime = 300.0;
  p.outputInterval = 0.1;
  p.normalPenalty = 0.0; // by mass, as in the panel
  TrajectoryStore store(int(rocks.size()), 1);
  runEnsemble(meadow, rocks, p, store);
  int walk = 0;
  for (const Trajectory& t : store.trajectories())
  {
    double slow = 0.0, before = 0.0;
    for (const Sample& s : t.samples)
    {
      slow += s.velocity.norm() < kWalks ? s.time - before : 0.0;
      before = s.time;
    }
    walk += slow > kMostWalking;
  }
  EXPECT_LE(walk, someOf(6, 1)); // a tenth
}
