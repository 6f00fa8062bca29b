// Many rocks on rough ground: every one is accounted for, none ends under the slope, and the result
// does not depend on threads. Bad input is one clear error.

#include "base/errors.h"
#include "rock/parts/Recorder.h"
#include "run/stateHash.h"
#include "slopes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Terrain roughSlope()
{
  const Terrain smooth = makeBiplanarSlope(2.0);
  const std::span<const double> h = smooth.heights();
  SurfaceMaterial m = material(0.6, 35.0); // more friction than slope: they come to rest
  m.restitutionDeviation = 0.05;
  m.frictionAngleDeviation = radians(2.0);
  return Terrain(
    smooth.geometry(), std::vector<double>(h.begin(), h.end()), m, Roughness{ 0.1, 0.15 });
}

std::vector<Rock> mixedRocks(int count)
{
  std::mt19937 random(21);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::normal_distribution<double> n(0.0, 1.0);
  const Shape shapes[] = { Shape::Cube, Shape::Tetrahedron, Shape::Octahedron, Shape::Dodecahedron,
    Shape::Icosahedron, Shape::Eota111, Shape::Eota221 };
  std::vector<Rock> rocks(count);
  for (int k = 0; k < count; ++k)
  {
    rocks[k].blockId = 100 + k;
    rocks[k].shape = makeShape(shapes[k % 7], 0.2 + u(random));
    const double x = 5.0 + 5.0 * u(random);
    rocks[k].position = Vec3(x, 20.0 + 60.0 * u(random), 57.7 * (1.0 - x / 100.0) + 3.0);
    rocks[k].orientation = Quat(n(random), n(random), n(random), n(random)).normalized();
    rocks[k].velocity = Vec3(2.0, n(random), 0.0);
  }
  return rocks;
}

std::uint64_t hashOf(const std::vector<Trajectory>& trajectories)
{
  std::uint64_t hash = 1469598103934665603ull; // FNV-1a over the bits of every sample
  const auto mix = [&](double value)
  {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211ull;
  };
  for (const Trajectory& t : trajectories)
  {
    for (const Sample& s : t.samples)
    {
      for (int k = 0; k < 3; ++k)
      {
        mix(s.position[k]);
        mix(s.angularVelocity[k]);
      }
    }
  }
  return hash;
}

} // namespace

TEST(Ensemble, AccountsForEveryRockAndNoneEndsUnderTheSlope)
{
  const Terrain slope = roughSlope();
  const std::vector<Rock> rocks = mixedRocks(42);
  SimulationParameters p;
  p.iterations = 2;
  p.endTime = 60.0;
  TrajectoryStore store(int(rocks.size()), p.iterations);
  ASSERT_TRUE(runEnsemble(slope, rocks, p, store));
  ASSERT_EQ(store.trajectories().size(), 84u);
  int fates[3] = { 0, 0, 0 };
  double worst = 0.0;
  for (std::size_t i = 0; i < store.trajectories().size(); ++i)
  {
    const Trajectory& t = store.trajectories()[i];
    const TrajectorySummary& s = t.summary;
    EXPECT_EQ(s.rock, int(i % rocks.size()));
    EXPECT_EQ(s.iteration, int(i / rocks.size()));
    EXPECT_EQ(s.blockId, rocks[s.rock].blockId);
    ++fates[int(s.fate)];
    ASSERT_FALSE(t.samples.empty());
    EXPECT_EQ(t.samples.front().time, 0.0);
    EXPECT_NEAR(t.samples.back().time, s.endTime, 1e-12);
    for (const Sample& sample : t.samples)
    {
      ASSERT_TRUE(sample.position.allFinite() && sample.velocity.allFinite());
      // A hard impact presses a vertex in by v √(m/p): 25 m/s and 3 t give 4 cm.
      EXPECT_TRUE(!(sample.heightOverGround < -0.06))
        << s.blockId << " at " << sample.time << ": " << sample.heightOverGround;
    }
    if (s.fate == Fate::Rested)
    {
      // At rest it stands on the ground, not in it; on a ridge its vertices hang over the sides.
      EXPECT_GT(t.samples.back().heightOverGround, -0.001) << s.blockId;
      EXPECT_LT(t.samples.back().heightOverGround, 0.1) << s.blockId;
    }
    EXPECT_LE(s.maxSpeed, std::sqrt(2.0 * kGravity * 62.0 + 10.0));
    worst = std::max(worst, std::abs(s.energy.numerical) / s.energy.released);
    EXPECT_EQ(s.unsettledSteps, 0) << s.blockId;
  }
  EXPECT_EQ(fates[0] + fates[1] + fates[2], 84);
  // Dodecahedra and the 26-faced EOTA blocks roll on down 30° at 1 to 2 m/s for minutes.
  EXPECT_GE(fates[0], 60);
  // The bar of the energy audit.
  EXPECT_LT(worst, 0.005);
  std::printf("%d rested, %d left, %d moving; largest numerical energy share %.4f\n", fates[0],
    fates[1], fates[2], worst);
}

TEST(Ensemble, RoughnessThatRisesIntoARockLiftsIt)
{
  // A small rock laid on the surveyed slope, which roughness of its own size raises or lowers.
  const Terrain slope = makeSlope(
    21, 0.5, [](double, double) { return 50.0; }, material(0.6, 35.0), Roughness{ 0.0, 0.1 });
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 0.001);
  rock.position = Vec3(5.1, 5.2, 50.051);
  SimulationParameters p;
  p.iterations = 40;
  p.endTime = 5.0;
  TrajectoryStore store(1, p.iterations);
  runEnsemble(slope, std::span<const Rock>(&rock, 1), p, store);
  for (const Trajectory& t : store.trajectories())
  {
    EXPECT_GT(t.samples.front().heightOverGround, -1e-5) << t.summary.iteration;
    EXPECT_GT(t.samples.back().heightOverGround, -1e-3) << t.summary.iteration;
    EXPECT_EQ(t.summary.fate, Fate::Rested) << t.summary.iteration;
  }
}

TEST(Ensemble, SameBitsForAnyNumberOfThreads)
{
  const Terrain slope = roughSlope();
  const std::vector<Rock> rocks = mixedRocks(14);
  SimulationParameters p;
  p.iterations = 2;
  p.endTime = 10.0;
  std::uint64_t hashes[2];
  for (int k = 0; k < 2; ++k)
  {
    p.threads = k + 1;
    TrajectoryStore store(int(rocks.size()), p.iterations);
    ASSERT_TRUE(runEnsemble(slope, rocks, p, store));
    hashes[k] = hashOf(store.trajectories());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  // The output interval is for looking, not for the motion.
  p.outputInterval = 0.013;
  TrajectoryStore fine(int(rocks.size()), p.iterations);
  ASSERT_TRUE(runEnsemble(slope, rocks, p, fine));
  p.outputInterval = 0.05;
  TrajectoryStore coarse(int(rocks.size()), p.iterations);
  ASSERT_TRUE(runEnsemble(slope, rocks, p, coarse));
  for (std::size_t i = 0; i < fine.trajectories().size(); ++i)
  {
    EXPECT_EQ(fine.trajectories()[i].summary.stop, coarse.trajectories()[i].summary.stop);
  }
  // Another seed is another realisation.
  p.seed = 2;
  TrajectoryStore other(int(rocks.size()), p.iterations);
  ASSERT_TRUE(runEnsemble(slope, rocks, p, other));
  EXPECT_NE(other.trajectories()[0].summary.stop, coarse.trajectories()[0].summary.stop);
}

namespace
{

/// Checks what a sink is promised.
class StrictSink : public TrajectorySink
{
public:
  Kept kept(int) const override { return { Retention::Nothing, false }; }
  void consume(Trajectory&& t) override
  {
    EXPECT_FALSE(busy_.exchange(true)) << "two threads at once";
    EXPECT_EQ(t.samples.capacity() + t.impacts.capacity(), 0u) << "nobody asks for them";
    numbers.push_back({ t.summary.iteration, t.summary.rock });
    hash.add(t.summary.hash);
    busy_ = false;
    if (numbers.size() == failAt)
    {
      throw DataError("the sink is full");
    }
  }
  std::vector<std::pair<int, int>> numbers;
  StateHash hash;
  std::size_t failAt = 0;

private:
  std::atomic<bool> busy_{ false };
};

} // namespace

TEST(Ensemble, HandsOnInOrderAndInParts)
{
  const Terrain slope = roughSlope();
  const std::vector<Rock> rocks = mixedRocks(7);
  SimulationParameters p;
  p.iterations = 6;
  p.firstIteration = 10;
  p.endTime = 4.0;
  p.threads = 3;
  const Ensemble ensemble(slope, rocks, p);
  StrictSink sink;
  ASSERT_TRUE(ensemble.run(ensemble.whole(), sink));
  ASSERT_EQ(sink.numbers.size(), 42u);
  for (int n = 0; n < 42; ++n)
  {
    EXPECT_EQ(sink.numbers[std::size_t(n)], std::pair(10 + n / 7, n % 7));
  }

  // Every third from the fifth on.
  StrictSink part;
  const EnsembleShare share{ 4, 40, 3 };
  ASSERT_TRUE(ensemble.run(share, part));
  ASSERT_EQ(part.numbers.size(), std::size_t(share.count()));
  ASSERT_EQ(share.count(), 12);
  for (int k = 0; k < 12; ++k)
  {
    EXPECT_EQ(part.numbers[std::size_t(k)], sink.numbers[std::size_t(4 + 3 * k)]);
  }
  StrictSink none;
  EXPECT_TRUE(ensemble.run({ 5, 5, 1 }, none, [](double) { return false; }));
  EXPECT_TRUE(none.numbers.empty());

  // Iterations 12 to 14 alone are as in the whole.
  StateHash expected;
  for (int n = 14; n < 35; ++n)
  {
    expected.add(ensemble.simulate(n).front().summary.hash);
  }
  p.firstIteration = 12;
  p.iterations = 3;
  StrictSink middle;
  ASSERT_TRUE(runEnsemble(slope, rocks, p, middle));
  EXPECT_EQ(middle.hash.value(), expected.value());

  // Nothing is handed on after a failure.
  StrictSink full;
  full.failAt = 5;
  EXPECT_THROW(ensemble.run(ensemble.whole(), full), DataError);
  EXPECT_EQ(full.numbers.size(), 5u);
}

TEST(Ensemble, EnoughIsAsInTheWholeRun)
{
  const Terrain slope = roughSlope();
  const std::vector<Rock> rocks = mixedRocks(7);
  SimulationParameters p;
  p.endTime = 8.0;
  const Ensemble ensemble(slope, rocks, p);
  for (int rock = 0; rock < 7; ++rock)
  {
    const Trajectory whole = ensemble.simulate(rock).front();
    for (double enough : { 0.0, 1.0, 3.33, 8.0 })
    {
      const Trajectory part = ensemble.simulate(rock, {}, enough).front();
      // Up to the first sample at that time or later they are the same.
      for (std::size_t k = 0; k == 0 || whole.samples[k - 1].time < enough; ++k)
      {
        ASSERT_LT(k, part.samples.size());
        EXPECT_EQ(part.samples[k].time, whole.samples[k].time);
        EXPECT_EQ(part.samples[k].position, whole.samples[k].position);
        EXPECT_EQ(part.samples[k].velocity, whole.samples[k].velocity);
        EXPECT_EQ(part.samples[k].contact, whole.samples[k].contact);
        if (k + 1 == whole.samples.size())
        {
          break;
        }
      }
      if (enough <= 1.0)
      {
        EXPECT_LT(part.samples.back().time, 4.0); // and it did stop there
      }
    }
  }
}

TEST(Ensemble, AbortsWhenAsked)
{
  const std::vector<Rock> rocks = mixedRocks(200);
  SimulationParameters p;
  p.endTime = 60.0;
  p.iterations = 10;
  TrajectoryStore store(int(rocks.size()), p.iterations);
  int calls = 0;
  EXPECT_FALSE(runEnsemble(roughSlope(), rocks, p, store, [&](double) { return ++calls < 2; }));
  EXPECT_EQ(calls, 2);
}

TEST(Ensemble, LeavesOverAHoleAndOverTheEdge)
{
  GridGeometry g;
  g.columns = g.rows = 21;
  g.cellSize = 2.0;
  std::vector<double> z(std::size_t(g.nodeCount()));
  for (int row = 0; row < 21; ++row)
  {
    for (int column = 0; column < 21; ++column)
    {
      const bool hole = column >= 12 && column <= 16 && row >= 8 && row <= 12;
      z[std::size_t(row) * 21 + column] = hole ? std::nan("") : 50.0 - 0.6 * column * 2.0;
    }
  }
  const Terrain slope(g, z, material(0.7, 5.0));
  Rock rock;
  rock.shape = makeShape(Shape::Icosahedron, 0.5);
  SimulationParameters p;
  p.endTime = 60.0;
  rock.position = Vec3(4.0, 20.0, 50.0); // up the slope from the hole
  const Trajectory overHole = simulate(slope, rock, p);
  EXPECT_EQ(overHole.summary.fate, Fate::LostInNodata);
  EXPECT_LT(overHole.summary.stop.x(), 34.0);
  rock.position = Vec3(4.0, 4.0, 50.0); // past it
  const Trajectory overEdge = simulate(slope, rock, p);
  EXPECT_EQ(overEdge.summary.fate, Fate::LeftDomain);
  // In contact it is let go at the end of the step that takes it over: 9 m/s and 5 ms.
  EXPECT_NEAR(overEdge.summary.stop.x(), 40.0, 0.05);
}

namespace
{

template <typename Exception>
void expectError(const std::function<void()>& run, const std::string& part)
{
  try
  {
    run();
    FAIL() << "no error, expected one with: " << part;
  }
  catch (const Exception& e)
  {
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

} // namespace

TEST(Ensemble, APathKeepsItsEnergyUntilTheImpactIsOver)
{
  // What restitution takes it takes in the end. A path without a point right before would lose it
  // on the whole way from the touch, and a line crossed there would see too little.
  Rock rock;
  rock.shape = makeShape(Shape::Icosahedron, 30.0);
  rock.position = Vec3(50.0, 50.0, 110.0);
  rock.angularVelocity = Vec3(0.3, 0.7, 0.2);
  rock.velocity = Vec3(4.0, 0.0, 0.0);
  SimulationParameters p;
  p.endTime = 3.0;
  const Trajectory t =
    simulate(makePlane(21, 100.0, radians(20.0), 0.0, material(0.6, 35.0)), rock, p);
  std::size_t jumps = 0;
  for (std::size_t k = 1; k < t.samples.size(); ++k)
  {
    const Sample &a = t.samples[k - 1], &b = t.samples[k];
    ASSERT_GT(b.time, a.time) << k;
    if (b.time - a.time < 2e-9)
    {
      EXPECT_NEAR(b.velocity.norm(), 0.6 * a.velocity.norm(), 1e-9 * a.velocity.norm());
      EXPECT_NEAR(a.energy.kinetic, a.kineticEnergy, 1e-6 * a.kineticEnergy);
      EXPECT_NEAR(a.energy.released,
        a.energy.kinetic + a.energy.strain + a.energy.friction + a.energy.restitution +
          a.energy.vibration + a.energy.damping + a.energy.numerical,
        1e-9 * a.kineticEnergy);
      EXPECT_LT(std::abs(a.energy.numerical), 1e-6 * a.kineticEnergy);
      ++jumps;
    }
  }
  EXPECT_GE(jumps, 2u);
  EXPECT_EQ(jumps, t.impacts.size());
}

TEST(Ensemble, OutputIntervalChangesNothing)
{
  // Thrown straight up, and down again.
  Rock rock;
  rock.shape = makeBox(Vec3(0.5, 1.0, 1.5));
  rock.position = Vec3(50.0, 50.0, 130.0);
  rock.velocity = Vec3(0.0, 0.0, kGravity);
  rock.angularVelocity = Vec3(1.0, 2.0, 3.0);
  const auto run = [&](double interval, double endTime)
  {
    SimulationParameters p;
    p.endTime = endTime;
    p.outputInterval = interval;
    return simulate(makePlane(21, 100.0, radians(20.0), 0.0, material(0.6, 35.0)), rock, p);
  };
  // The corner at the top is met in the middle of the pieces.
  EXPECT_NEAR(run(0.05, 2.0).summary.pathLength, kGravity, 1e-12);
  for (const double endTime : { 2.0, 8.0 })
  {
    const Trajectory fine = run(0.013, endTime), coarse = run(100.0, endTime);
    EXPECT_EQ(fine.summary.pathLength, coarse.summary.pathLength);
    EXPECT_EQ(fine.summary.maxSpeed, coarse.summary.maxSpeed);
    EXPECT_EQ(fine.summary.maxKineticEnergy, coarse.summary.maxKineticEnergy);
    EXPECT_EQ(motionHash(fine), motionHash(coarse));
  }
}

TEST(Ensemble, BadInputIsOneClearError)
{
  const Terrain slope = makeBiplanarSlope(5.0);
  Rock good;
  good.blockId = 7;
  good.shape = makeShape(Shape::Cube, 1.0);
  good.position = Vec3(5.0, 50.0, 58.0);
  const auto with = [&](auto change)
  {
    return [=, &slope]
    {
      Rock rock = good;
      SimulationParameters p;
      p.endTime = 0.1;
      change(rock, p);
      simulate(slope, rock, p);
    };
  };
  using P = SimulationParameters;
  expectError<ParameterError>(with([](Rock&, P& p) { p.timeStep = 0.0; }), "TimeStep is 0,");
  expectError<ParameterError>(with([](Rock&, P& p) { p.timeStep = -1.0; }), "TimeStep is -1,");
  expectError<ParameterError>(
    with([](Rock&, P& p) { p.normalPenalty = -1.0; }), "NormalPenalty is -1 N/m");
  // 2600 kg and 0.866 m: 26 kN in 0.02 of the radius.
  expectError<ParameterError>(with([](Rock&, P& p) { p.normalPenalty = 1.4e6; }),
    "NormalPenalty is 1400000 N/m, too soft for block 7: at rest its ");
  EXPECT_NO_THROW(with([](Rock&, P& p) { p.normalPenalty = 1.7e6; })());
  // Alone a rock has the stiffness of its mass; on others it lies on the paper's.
  for (const bool together : { false, true })
  {
    const auto heavy = with(
      [=](Rock& r, P& p)
      {
        r.shape = makeShape(Shape::Cube, 1000.0);
        r.position.z() += 20.0;
        p.gravity = 1000.0;
        p.rockRockContact = together;
      });
    if (together)
    {
      expectError<ParameterError>(
        heavy, "NormalPenalty is 0, that is 1e+09 N/m, too soft for block 7: at rest its ");
    }
    else
    {
      EXPECT_NO_THROW(heavy());
    }
  }
  expectError<ParameterError>(with([](Rock&, P& p) { p.endTime = NAN; }), "EndTime is nan");
  expectError<ParameterError>(with([](Rock&, P& p) { p.outputInterval = 0; }), "OutputInterval");
  expectError<ParameterError>(with([](Rock&, P& p) { p.iterations = 0; }), "Iterations is 0");
  expectError<ParameterError>(
    with([](Rock&, P& p) { p.firstIteration = -1; }), "FirstIteration is -1");
  expectError<ParameterError>(
    with([](Rock&, P& p) { p.firstIteration = 2147483647; }), "FirstIteration is 2147483647");
  expectError<ParameterError>(
    with([](Rock& r, P&) { r.density = -2500.0; }), "block 7: Density is -2500");
  expectError<ParameterError>(with([](Rock& r, P&) { r.youngModulus = 0.0; }), "YoungModulus");
  expectError<ParameterError>(with([](Rock& r, P&) { r.poissonRatio = 0.5; }), "PoissonRatio");
  expectError<ParameterError>(
    with([](Rock& r, P&) { r.velocity.x() = INFINITY; }), "block 7: Velocity");
  expectError<PlacementError>(
    with([](Rock& r, P&) { r.position.x() = -10.0; }), "block 7 at (-10,");
  expectError<PlacementError>(
    with([](Rock& r, P&) { r.position.z() = 54.0; }), "starts inside the slope, by ");
  const Terrain holed = makeSlope(
    21, 5.0, [](double x, double y) { return std::hypot(x - 5.0, y - 50.0) < 8.0 ? NAN : 50.0; });
  expectError<PlacementError>([&] { simulate(holed, good, P()); }, "lies on nodata of the slope");
  expectError<ParameterError>(
    [&]
    {
      TrajectoryStore store(0, 1);
      runEnsemble(slope, {}, P(), store);
    },
    "no rock blocks");
}

// Where none is typed a spring follows the mass: ω² m, and the paper's at least. Together, too, as
// long as no other rock is near.
TEST(Ensemble, PenaltyByMass)
{
  const Terrain hard = makePlane(41, 40.0, radians(30.0), 0.0, material(0.5, 30.0));
  const Terrain soft = makePlane(41, 40.0, radians(30.0), 0.0, softGround());
  const auto hash = [](const Terrain& slope, double volume, double penalty, bool together = false)
  {
    Rock rock = cubeOnPlane(40.0, radians(30.0), 0.0, 10.0);
    rock.shape = makeShape(Shape::Cube, volume);
    rock.density = 2500.0;
    rock.position.z() += 3.0;
    SimulationParameters p;
    p.endTime = 2.0;
    p.normalPenalty = penalty;
    p.rockRockContact = together;
    return simulate(slope, rock, p).summary.hash;
  };
  for (const Terrain* slope : { &hard, &soft })
  {
    EXPECT_EQ(hash(*slope, 1.0, 0.0), hash(*slope, 1.0, 1e8 * 2500.0));
    EXPECT_EQ(hash(*slope, 0.001, 0.0), hash(*slope, 0.001, 1e9));
    EXPECT_NE(hash(*slope, 1.0, 0.0), hash(*slope, 1.0, 1e9));
    EXPECT_EQ(hash(*slope, 1.0, 0.0, true), hash(*slope, 1.0, 1e8 * 2500.0, true));
  }
}
