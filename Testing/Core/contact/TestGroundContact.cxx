// Rocks on a slope of several classes: the contact takes what lies under it.
#include "law/settings.h"
#include "randomScenes.h"
#include "slopes.h"
#include "terrain/Surface.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

MaterialClasses classesOf(const Terrain& terrain, std::vector<SurfaceMaterial> materials,
  const std::function<int(double, double)>& classAt)
{
  const GridGeometry& g = terrain.geometry();
  auto cells = std::make_shared<std::vector<std::uint8_t>>();
  for (int row = 0; row + 1 < g.rows; ++row)
  {
    for (int column = 0; column + 1 < g.columns; ++column)
    {
      cells->push_back(
        std::uint8_t(classAt((column + 0.5) * g.cellSize, (g.rows - 1.5 - row) * g.cellSize)));
    }
  }
  MaterialClasses classes;
  classes.names.assign(materials.size(), "class");
  classes.materials = std::move(materials);
  classes.cells = *cells;
  classes.owner = cells;
  return classes;
}

SimulationParameters parameters(double endTime)
{
  SimulationParameters p;
  p.timeStep = 0.005;
  p.endTime = endTime;
  p.outputInterval = 0.05;
  return p;
}

Terrain floor(const SurfaceMaterial& m)
{
  return makeSlope(
    41, 1.0, [](double, double) { return 100.0; }, m);
}

Rock cubeOver(double x, double height)
{
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(x, 20.3, 100.5 + height);
  rock.youngModulus = 1e11;
  return rock;
}

double reboundOf(const Trajectory& t)
{
  const ImpactEvent& impact = t.impacts.at(0);
  return -impact.velocityAfter.z() / impact.velocityBefore.z();
}

} // namespace

TEST(GroundContact, EachSideHasItsOwnRv)
{
  Terrain terrain = floor(material(0.9, 15.0));
  terrain.setRestitutionClasses(classesOf(terrain, { material(0.6, 15.0), material(0.3, 15.0) },
    [](double x, double) { return x < 12.0 ? 1
                             : x < 28.0    ? 2
                                           : 0; }));
  // The bar of TestRebound: 1 % of the speed stays in the block as vibration.
  EXPECT_NEAR(reboundOf(simulate(terrain, cubeOver(6.3, 2.0), parameters(1.0))), 0.6, 0.01);
  EXPECT_NEAR(reboundOf(simulate(terrain, cubeOver(20.3, 2.0), parameters(1.0))), 0.3, 0.01);
  EXPECT_NEAR(reboundOf(simulate(terrain, cubeOver(34.3, 2.0), parameters(1.0))), 0.9, 0.01);
  const Trajectory t = simulate(terrain, cubeOver(20.3, 2.0), parameters(1.0));
  EXPECT_EQ(t.impacts.at(0).restitution, 0.3); // and the event says so
}

TEST(GroundContact, EachSideHasItsOwnModel)
{
  Terrain terrain = floor(material(0.9, 0.0));
  SurfaceMaterial soft = material(0.5, 0.0);
  soft.restitutionModel = RestitutionModel::NormalTangential;
  soft.tangentialRestitution = 0.7;
  terrain.setRestitutionClasses(
    classesOf(terrain, { soft }, [](double x, double) { return x < 20.0 ? 1 : 0; }));
  Rock rock = cubeOver(6.3, 2.0);
  rock.velocity = Vec3(3.0, 0.0, 0.0);
  const ImpactEvent impact = simulate(terrain, rock, parameters(1.0)).impacts.at(0);
  EXPECT_NEAR(impact.velocityAfter.x(), 0.7 * 3.0, 0.01);
  rock.position.x() = 26.3;
  const ImpactEvent other = simulate(terrain, rock, parameters(1.0)).impacts.at(0);
  EXPECT_NEAR(other.velocityAfter.x(), 0.9 * 3.0, 0.01);
}

// A cube slides over the border between two frictions: v² = 2 a₁ s₁, then 2 a₂ s₂ less.
TEST(GroundContact, SlidingTakesTheFrictionUnderIt)
{
  const double angle = radians(30.0), size = 200.0;
  Terrain plane = makePlane(101, size, angle, 0.0, material(0.8, 10.0));
  // 20 m down the slope from the start is 17.3 m east of it.
  const double start = 0.5 * size - 20.0 * std::cos(angle);
  const double border = 2.0 * std::round((start + 16.0) / 2.0); // at a node
  plane.setJointClasses(classesOf(
    plane, { material(0.8, 38.0) }, [&](double x, double) { return x > border ? 1 : 0; }));
  const Trajectory t = simulate(plane, cubeOnPlane(size, angle, 0.0, 20.0), parameters(20.0));
  EXPECT_EQ(t.summary.fate, Fate::Rested);
  const auto pull = [&](double phi)
  { return kGravity * (std::sin(angle) - std::cos(angle) * std::tan(radians(phi))); };
  const double first = (border - start) / std::cos(angle);
  const double second = first * pull(10.0) / -pull(38.0);
  const double slid = (t.summary.stop - t.summary.start).norm();
  // The weight of a cube that is braked presses ½ m · tan φ ahead of its middle, so it meets the
  // border earlier by as much at most; each metre earlier it stops this much shorter.
  const double ahead = 0.5 * std::tan(radians(38.0));
  const double shorter = 1.0 + pull(10.0) / -pull(38.0);
  EXPECT_LT(slid, first + second);
  EXPECT_GT(slid, first + second - ahead * shorter);
}

TEST(GroundContact, OneClassEverywhereIsTheUniformSlope)
{
  SurfaceMaterial m = material(0.7, 20.0);
  m.restitutionDeviation = 0.1;
  m.frictionAngleDeviation = radians(3.0);
  const Terrain plain = Terrain(makeBiplanarSlope(5.0), m, { .mean = 0.1, .deviation = 0.1 });
  Terrain classed = plain;
  // Class 0 on a layer is the slope's own material: the same numbers, bit for bit.
  classed.setRestitutionClasses(
    classesOf(plain, { material(0.1, 1.0) }, [](double, double) { return 0; }));
  classed.setJointClasses(
    classesOf(plain, { material(0.1, 1.0) }, [](double, double) { return 0; }));
  Rock rock;
  rock.shape = makeShape(Shape::Icosahedron, 1.0);
  rock.position = Vec3(10.0, 50.0, 55.0);
  SimulationParameters p = parameters(30.0);
  p.iterations = 5;
  TrajectoryStore before(1, 5), after(1, 5);
  runEnsemble(plain, std::span<const Rock>(&rock, 1), p, before);
  runEnsemble(classed, std::span<const Rock>(&rock, 1), p, after);
  for (int i = 0; i < 5; ++i)
  {
    EXPECT_EQ(before.trajectories()[std::size_t(i)].summary.stop,
      after.trajectories()[std::size_t(i)].summary.stop);
    EXPECT_EQ(before.trajectories()[std::size_t(i)].summary.pathLength,
      after.trajectories()[std::size_t(i)].summary.pathLength);
  }
}

// Newton's matrix has what turns within a step: directions, levers, momentum.
TEST(GroundContact, LongStepsOfSlidingRocksAreNotCut)
{
  std::mt19937_64 random(3);
  std::normal_distribution<double> rough(0.0, 0.1);
  const Terrain terrain = makeSlope(
    101, 1.0, [&](double x, double) { return 100.0 - 0.58 * x + rough(random); },
    material(0.0, 15.0));
  std::int64_t steps = 0, cut = 0, iterations = 0;
  for (int k = 0; k < 12; ++k)
  {
    Rock rock;
    rock.shape = makeShape(k % 2 ? Shape::Cube : Shape::Icosahedron, 1.0);
    rock.position =
      Vec3(10.0 + k, 20.0 + 4.0 * k, terrain.elevation(10.0 + k, 20.0 + 4.0 * k) + 1.5);
    rock.velocity = Vec3(3.0, 0.0, 0.0);
    rock.orientation = Quat(1.0, 0.1 * k, 0.3, -0.05 * k).normalized();
    SimulationParameters p = parameters(6.0);
    p.rigid = true;
    const Trajectory t = simulate(terrain, rock, p);
    steps += t.summary.contactSteps;
    cut += t.summary.cutSteps;
    iterations += t.summary.openCloseIterations;
  }
  EXPECT_GT(steps, 1000);
  EXPECT_LT(double(cut), 0.002 * double(steps));
  EXPECT_LT(double(iterations), 4.0 * double(steps));
}

TEST(GroundContact, APlateThatTopplesOntoItsFaceStaysOnTheGround)
{
  // A step of lasting contact turns it from an edge onto the face, whose other corners did not face
  // the ground before.
  for (const double friction : { 20.0, 70.0 })
  {
    for (const double lean : { radians(5.0), radians(25.0) })
    {
      for (const double spin : { 0.0, 2.0, 8.0 })
      {
        for (const double edge : { 0.024, 0.5, 2.0 })
        {
          for (const double step : { 0.005, 0.013, 0.03 })
          {
            Rock plate;
            plate.shape = makeBox(edge * Vec3(1.0, 1.2, 0.1));
            plate.orientation = Quat(Eigen::AngleAxisd(lean, Vec3::UnitY()));
            plate.position = Vec3(20.0, 20.0,
              100.0 + 0.5 * edge * (std::sin(lean) + 0.1 * std::cos(lean)) + 1e-6 * edge);
            plate.angularVelocity = Vec3(0.0, -spin / std::sqrt(edge), 0.0);
            plate.velocity = plate.angularVelocity.cross(
              0.5 * edge * Vec3(-std::cos(lean), 0.0, std::sin(lean))); // about the lower edge
            SimulationParameters p = parameters(0.5);
            p.timeStep = step;
            p.outputInterval = 2e-4;
            p.rigid = true;
            const Trajectory t =
              simulate(makePlane(9, 40.0, 0.0, 0.0, material(0.3, friction)), plate, p);
            double deepest = 0.0;
            for (const Sample& s : t.samples)
            {
              deepest = std::max(deepest, -s.heightOverGround);
            }
            // What is met too late may be as deep as a contact that carries nothing.
            const double allowed = std::max(kLooseOverlap * plate.shape.radius(),
              1.5 * explainedDepth(plate, p, t.summary.maxKineticEnergy, t.summary.mass));
            EXPECT_LE(deepest, allowed)
              << "friction " << friction << " degrees, lean " << lean << ", spin " << spin
              << ", edge " << edge << " m, step " << step << " s";
          }
        }
      }
    }
  }
}
