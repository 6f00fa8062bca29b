// Rocks set on the ground, and what of their release is drawn in each iteration.

#include "base/errors.h"
#include "base/random.h"
#include "contact/ground/detection.h"
#include "gisFiles.h"
#include "rock/placement.h"
#include "slopes.h"

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Ridges, peaks and pits of the size of the rocks.
Terrain bumps()
{
  return makeSlope(61, 0.5,
    [](double x, double y)
    { return 40.0 - 0.5 * x + 0.4 * std::sin(3.1 * x) * std::cos(2.3 * y); });
}

double penetrationAt(const Terrain& terrain, const Rock& rock)
{
  const Block block(rock.shape, 2500.0, 1e10, 0.1);
  BlockState state;
  state.position = rock.position;
  state.orientation = rock.orientation;
  PlacedBlock placed;
  placed.place(block, state);
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(terrain), placed.lower().x(), placed.upper().x(),
    placed.lower().y(), placed.upper().y(), patch);
  return penetration(placed, patch);
}

double heightOver(const Terrain& terrain, const Rock& rock)
{
  return rock.position.z() -
    touchingHeight(Surface::asSurveyed(terrain), rock.shape, rock.orientation, rock.position.x(),
      rock.position.y());
}

Rock rockOver(const Terrain& terrain, double height)
{
  Rock rock;
  rock.blockId = 5;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(15.0, 15.0, 0.0);
  rock.position.z() = height - heightOver(terrain, rock);
  return rock;
}

} // namespace

TEST(Placement, touchesAndNoMore)
{
  // A unit cube along the axes on a plane of 30° stands on its upper edge: ½ + ½ tan 30° over it.
  const Terrain plane = makePlane(41, 40.0, radians(30.0), 0.0, material(0.8, 15.0));
  Rock cube = rockOver(plane, 0.0);
  EXPECT_NEAR(cube.position.z(),
    100.0 + 5.0 * std::tan(radians(30.0)) + 0.5 + 0.5 * std::tan(radians(30.0)), 1e-12);
  // On bumps: at rest no overlap, a hair lower there is one.
  const Terrain rough = bumps();
  std::mt19937 random(3);
  std::normal_distribution<double> n;
  std::uniform_real_distribution<double> u(3.0, 27.0);
  const Shape shapes[] = { Shape::Cube, Shape::Tetrahedron, Shape::Icosahedron, Shape::Eota221 };
  int deeper = 0;
  for (int k = 0; k < 200; ++k)
  {
    Rock rock;
    rock.shape = makeShape(shapes[k % 4], 0.01 * (1 + k % 50));
    rock.orientation = Quat(n(random), n(random), n(random), n(random)).normalized();
    rock.position = Vec3(u(random), u(random), 0.0);
    rock.position.z() = touchingHeight(Surface::asSurveyed(rough), rock.shape, rock.orientation,
      rock.position.x(), rock.position.y());
    EXPECT_LT(penetrationAt(rough, rock), 1e-9) << k;
    rock.position.z() -= 0.01;
    deeper += penetrationAt(rough, rock) > 0.0;
  }
  // Of edges across ridges `penetration` knows nothing: most of the rocks touch otherwise.
  EXPECT_GT(deeper, 100);
  // A peak under a face: the middle node of 0.5 m cells, 0.3 m above flat ground.
  const Terrain peak =
    makeSlope(21, 2.0, [](double x, double y) { return x == 20.0 && y == 20.0 ? 10.3 : 10.0; });
  EXPECT_NEAR(touchingHeight(Surface::asSurveyed(peak), makeShape(Shape::Cube, 1.0),
                Quat::Identity(), 20.1, 20.2),
    10.8, 1e-12);
  EXPECT_TRUE(std::isnan(touchingHeight(
    Surface::asSurveyed(peak), makeShape(Shape::Cube, 1.0), Quat::Identity(), -1.0, 20.0)));
}

TEST(Realise, isAFunctionOfSeedIterationAndRock)
{
  const Terrain terrain = bumps();
  Rock rock = rockOver(terrain, 1.0);
  rock.uncertainty.horizontalDeviation = 2.0;
  rock.uncertainty.verticalDeviation = 0.3;
  rock.uncertainty.attitude = AttitudeLaw::Random;
  rock.uncertainty.volume.law = VolumeLaw::LogNormal;
  const Rock once = realise(terrain, rock, 1, 3, 7), again = realise(terrain, rock, 1, 3, 7);
  EXPECT_EQ(once.position, again.position);
  EXPECT_EQ(once.orientation.coeffs(), again.orientation.coeffs());
  EXPECT_EQ(once.shape.integrals().volume, again.shape.integrals().volume);
  const std::uint64_t far = 7 + (std::uint64_t(1) << 40); // beyond 32 bits
  for (const Rock& other : { realise(terrain, rock, 2, 3, 7), realise(terrain, rock, 1, 4, 7),
         realise(terrain, rock, 1, 3, 8), realise(terrain, rock, 1, 3, far) })
  {
    EXPECT_NE(once.position, other.position);
    EXPECT_NE(once.orientation.coeffs(), other.orientation.coeffs());
    EXPECT_NE(once.shape.integrals().volume, other.shape.integrals().volume);
  }
  EXPECT_EQ(once.blockId, 5);
  EXPECT_FALSE(once.uncertainty.any());
}

TEST(Realise, deviationsAreThoseAskedFor)
{
  const Terrain plane = makePlane(41, 400.0, radians(20.0), 0.5, material(0.8, 15.0));
  Rock rock;
  rock.shape = makeShape(Shape::Icosahedron, 1.0);
  rock.position = Vec3(200.0, 200.0, 0.0);
  rock.position.z() = 5.0 - heightOver(plane, rock);
  rock.uncertainty.horizontalDeviation = 3.0;
  rock.uncertainty.verticalDeviation = 0.5;
  rock.uncertainty.attitude = AttitudeLaw::Deviate;
  rock.uncertainty.attitudeDeviation = radians(10.0);
  const int n = 2000;
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  double angles = 0.0;
  for (int k = 0; k < n; ++k)
  {
    const Rock drawn = realise(plane, rock, 1, k, 0);
    Vec3 d = drawn.position - rock.position;
    d.z() = heightOver(plane, drawn) - 5.0; // goes along with the slope
    sum += d;
    squares += d.cwiseProduct(d);
    const double angle = drawn.orientation.angularDistance(rock.orientation);
    angles += angle * angle;
  }
  // Of 2000 draws a standard deviation is known within 1.6 %, a mean within 2.2 % of it: 4 times.
  const Vec3 asked(3.0, 3.0, 0.5);
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_NEAR(sum[k] / n, 0.0, 0.09 * asked[k]);
    EXPECT_NEAR(std::sqrt(squares[k] / n), asked[k], 0.065 * asked[k]);
  }
  EXPECT_NEAR(std::sqrt(angles / n / 3.0), radians(10.0), 0.05 * radians(10.0));
}

TEST(Realise, randomAttitudesAreUniform)
{
  const Terrain terrain = bumps();
  Rock rock = rockOver(terrain, 5.0);
  rock.uncertainty.attitude = AttitudeLaw::Random;
  const int n = 2000;
  Vec3 sum = Vec3::Zero();
  double cosines = 0.0, traces = 0.0;
  for (int k = 0; k < n; ++k)
  {
    const Mat3 turn = realise(terrain, rock, 1, 0, std::uint64_t(k)).orientation.toRotationMatrix();
    sum += turn * Vec3::UnitX();
    cosines += turn(2, 2) * turn(2, 2);
    traces += turn.trace() * turn.trace();
  }
  // Uniform over rotations: means 0 and ⟨cos²⟩ = 1/3, ⟨tr²⟩ = 1; four standard errors.
  EXPECT_LT((sum / n).cwiseAbs().maxCoeff(), 4.0 * std::sqrt(1.0 / 3.0 / n));
  EXPECT_NEAR(cosines / n, 1.0 / 3.0, 4.0 * 0.3 / std::sqrt(double(n)));
  EXPECT_NEAR(traces / n, 1.0, 4.0 * 1.5 / std::sqrt(double(n)));
}

TEST(Realise, neverStartsInsideOrOutsideTheSlope)
{
  const Terrain terrain = bumps();
  Rock rock = rockOver(terrain, 0.0);
  rock.uncertainty.horizontalDeviation = 10.0; // a third of the slope's width
  rock.uncertainty.verticalDeviation = 1.0;
  rock.uncertainty.attitude = AttitudeLaw::Random;
  rock.uncertainty.volume.law = VolumeLaw::Uniform;
  rock.uncertainty.volume.maximum = 3.0;
  for (int k = 0; k < 500; ++k)
  {
    const Rock drawn = realise(terrain, rock, 1, k, 0);
    EXPECT_NE(terrain.cfeAt(drawn.position.x(), drawn.position.y()), 0) << k;
    EXPECT_GT(heightOver(terrain, drawn), -1e-9) << k;
  }
  // Where only one cell in a hundred thousand is ground, it says so.
  GridGeometry grid;
  grid.columns = grid.rows = 401;
  grid.cellSize = 1.0;
  std::vector<double> heights(401 * 401, NAN);
  for (int k : { 0, 1, 401, 402 })
  {
    heights[std::size_t(200 * 401 + 200 + k)] = 0.0;
  }
  const Terrain island(grid, heights);
  rock.position = Vec3(200.5, 199.5, 10.0);
  rock.uncertainty.horizontalDeviation = 400.0;
  EXPECT_TRUE(holds(messageOf<PlacementError>([&] { realise(island, rock, 1, 0, 0); }),
    { "block 5", "HorizontalDeviation 400", "outside the slope 1000 times", "iteration 0" }));
}

TEST(Realise, anEnsembleHasItInItsSummaries)
{
  const Terrain terrain = bumps();
  Rock sure = rockOver(terrain, 1.0), unsure = sure;
  unsure.uncertainty.horizontalDeviation = 1.0;
  unsure.uncertainty.volume.law = VolumeLaw::PowerLaw;
  const Rock rocks[] = { sure, unsure };
  SimulationParameters p;
  p.iterations = 8;
  p.endTime = 1.0;
  std::vector<Trajectory> first;
  for (int threads : { 1, 2 })
  {
    p.threads = threads;
    TrajectoryStore store(2, p.iterations);
    runEnsemble(terrain, rocks, p, store);
    for (std::size_t k = 0; k < store.trajectories().size(); ++k)
    {
      const Trajectory& t = store.trajectories()[k];
      const TrajectorySummary& s = t.summary;
      if (s.rock == 0)
      {
        EXPECT_EQ(s.start, sure.position);
        EXPECT_EQ(s.volume, sure.shape.integrals().volume);
      }
      else
      {
        const Rock drawn = realise(terrain, unsure, p.seed, s.iteration, 1);
        EXPECT_NEAR((s.start - drawn.position).norm(), 0.0, 1e-9);
        EXPECT_EQ(s.volume, drawn.shape.integrals().volume);
        EXPECT_DOUBLE_EQ(s.mass, 2500.0 * s.volume);
      }
      if (threads == 2)
      {
        EXPECT_EQ(s.stop, first[k].summary.stop); // bit for bit
      }
    }
    first = store.trajectories();
  }
}

TEST(Realise, badDeviationsAreNamed)
{
  const Terrain terrain = bumps();
  const auto error = [&](auto change)
  {
    Rock rock = rockOver(terrain, 1.0);
    change(rock.uncertainty);
    SimulationParameters p;
    p.endTime = 0.1;
    return messageOf<ParameterError>([&] { simulate(terrain, rock, p); });
  };
  using U = ReleaseUncertainty;
  EXPECT_TRUE(holds(
    error([](U& u) { u.horizontalDeviation = -1.0; }), { "block 5", "HorizontalDeviation is -1" }));
  EXPECT_TRUE(holds(error([](U& u) { u.horizontalDeviation = 1000.0; }),
    { "block 5", "HorizontalDeviation is 1000", "wide" }));
  EXPECT_TRUE(
    holds(error([](U& u) { u.verticalDeviation = NAN; }), { "VerticalDeviation is nan" }));
  EXPECT_TRUE(holds(
    error([](U& u) { u.attitudeDeviation = radians(-0.1); }), { "AttitudeDeviation is -0.1" }));
  EXPECT_TRUE(holds(error([](U& u) { u.attitude = AttitudeLaw(4); }), { "AttitudeLaw is 4" }));
  EXPECT_TRUE(
    holds(error([](U& u) { u.volume.deviation = -2.0; }), { "block 5", "VolumeDeviation is -2" }));
}

TEST(Random, uniformDeviatesAreUniform)
{
  const int n = 20000;
  double sum = 0.0, squares = 0.0, product = 0.0;
  for (int k = 0; k < n; ++k)
  {
    const auto [u, v] = uniformDeviates(1, 0, Draw::SourcePlace, std::uint64_t(k));
    ASSERT_TRUE(u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0);
    sum += u;
    squares += u * u;
    product += u * v;
  }
  // Standard errors: √(1/12/n), √(4/45/n), √(7/144/n); four of each.
  EXPECT_NEAR(sum / n, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / n));
  EXPECT_NEAR(product / n, 0.25, 4.0 * std::sqrt(7.0 / 144.0 / n));
  EXPECT_EQ(uniformDeviate(1, 2, Draw::Volume, 3), uniformDeviates(1, 2, Draw::Volume, 3)[0]);
  EXPECT_NE(uniformDeviate(1, 2, Draw::Volume, 3), uniformDeviate(1, 2, Draw::SourceVolume, 3));
}
