// Rocks that break in impacts: at the threshold, into volumes of the law, with their mass, energy
// and momentum, alike on any number of threads; their sources count once.

#include "base/errors.h"
#include "form.h"
#include "fragments.h"
#include "run/brokenFall.h"
#include "run/stateHash.h"
#include "statistics/HazardRaster.h"
#include "statistics/crossings.h"
#include "summarizePassages.h"
#include "terrain/structures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

RockPath pathOf(const Trajectory& trajectory, std::vector<PathPoint>& points)
{
  for (const Sample& s : trajectory.samples)
  {
    points.push_back(
      { s.time, s.position, s.velocity, s.angularVelocity, s.kineticEnergy, s.heightOverGround });
  }
  RockPath path;
  path.iteration = trajectory.summary.iteration;
  path.rock = trajectory.summary.rock;
  path.blockId = trajectory.summary.blockId;
  path.piece = trajectory.summary.piece;
  path.mass = trajectory.summary.mass;
  path.rested = trajectory.summary.fate == Fate::Rested;
  path.points = points;
  return path;
}

} // namespace

TEST(Fragmentation, BreaksFromTheThresholdOn)
{
  // A fall of h has ρ g h of normal energy by volume.
  const Terrain ground = flatGround();
  const double height = 4.0, energy = kDensity * kGravity * height;
  for (const ImpactResolution resolution : { ImpactResolution::Springs, ImpactResolution::Impulse })
  {
    const auto whole =
      runOf(ground, { dropped(height) }, lawOf(1.001 * energy, 0.02), 1, 1, resolution);
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole[0].summary.fate, Fate::Rested);
    const auto broken =
      runOf(ground, { dropped(height) }, lawOf(0.999 * energy, 0.02), 1, 1, resolution);
    ASSERT_GT(broken.size(), 1u);
    EXPECT_EQ(broken[0].summary.fate, Fate::Broken);
    EXPECT_EQ(broken[0].summary.impacts, 1);
    EXPECT_NEAR(broken[0].summary.endTime, std::sqrt(2.0 * height / kGravity), 0.02);
  }
  // One that cannot break falls as without the law, bit for bit.
  SimulationParameters p;
  p.endTime = 20.0;
  p.threads = 1;
  TrajectoryStore store;
  ASSERT_TRUE(runEnsemble(ground, std::vector<Rock>{ dropped(height) }, p, store));
  const auto whole = runOf(ground, { dropped(height) }, lawOf(2.0 * energy, 0.02));
  EXPECT_EQ(whole[0].summary.hash, store.trajectories()[0].summary.hash);
}

TEST(Fragmentation, MassEnergyAndMomentumGoOverToThePieces)
{
  const Terrain ground = flatGround();
  Rock rock = dropped(10.0);
  rock.velocity = Vec3(5.0, 1.0, 0.0);
  rock.angularVelocity = Vec3(1.0, 2.0, -0.5);
  for (const double loss : { 0.0, 0.2 })
  {
    Fragmentation law = lawOf(50e3, 1e-3);
    law.loss = loss;
    const auto all = runOf(ground, { rock }, law);
    const TrajectorySummary& parent = all[0].summary;
    ASSERT_EQ(parent.fate, Fate::Broken);
    ASSERT_GT(parent.pieces, 3);
    const Sample& end = all[0].samples.back();
    double mass = parent.finesMass, energy = parent.finesEnergy;
    for (int k = 1; k <= parent.pieces; ++k)
    {
      const Trajectory& piece = all[std::size_t(k)];
      EXPECT_EQ(piece.summary.piece, k);
      EXPECT_EQ(piece.summary.blockId, 7);
      EXPECT_GE(piece.summary.volume, law.leastVolume);
      EXPECT_EQ(piece.samples.front().time, end.time);
      mass += piece.summary.mass;
      energy += piece.samples.front().kineticEnergy;
      // As parts of the whole: v + ω × r.
      const Vec3 lever = piece.samples.front().position - end.position;
      EXPECT_LT(
        (piece.samples.front().velocity - end.velocity - end.angularVelocity.cross(lever)).norm(),
        1e-9);
      EXPECT_LT((piece.samples.front().angularVelocity - end.angularVelocity).norm(), 1e-9);
    }
    EXPECT_NEAR(mass, parent.mass, 1e-9 * parent.mass);
    EXPECT_NEAR(energy, parent.energy.kinetic, 1e-9 * parent.energy.kinetic);
    // What breaking takes is its share of what the impact left.
    EXPECT_NEAR(parent.energy.breaking, loss * (parent.energy.kinetic + parent.energy.breaking),
      1e-3 * parent.energy.kinetic);
    for (const Trajectory& t : all)
    {
      const EnergyAudit& e = t.summary.energy;
      EXPECT_NEAR(e.released, sumOf(e), 1e-9 * parent.energy.released);
      EXPECT_LT(std::abs(e.numerical), 1e-3 * parent.energy.released) << t.summary.piece;
    }
  }
}

TEST(Fragmentation, PiecesWithoutFinesHaveAllOfTheEnergyAndMomentum)
{
  // The pieces fill the body, so integrals over them are those over it.
  const Terrain ground = flatGround();
  const Surface surface(ground, 3, 0);
  const Polyhedron body = makeShape(Shape::Icosahedron, 2.0);
  const Fragmentation law = lawOf(1.0, 1e-7 * body.integrals().volume, 1.0);
  for (std::uint32_t number = 0; number < std::uint32_t(someOf(20, 3)); ++number)
  {
    double volume = 0.0;
    Vec3 moment = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (const Polyhedron& piece : fragmentsOf(body, law, surface, number))
    {
      const VolumeIntegrals& of = piece.integrals();
      const Vec3 lever = of.centroid - body.integrals().centroid;
      volume += of.volume;
      moment += of.volume * lever;
      second += of.second + of.volume * lever * lever.transpose();
    }
    const double least = 1e-3; // in pieces too small to be followed: 2e-5 in the mean
    EXPECT_NEAR(volume, body.integrals().volume, least * body.integrals().volume) << number;
    EXPECT_LT(moment.norm(), least * body.integrals().volume * body.radius());
    EXPECT_LT((second - body.integrals().second).norm(), least * body.integrals().second.norm());
  }
}

TEST(Fragmentation, VolumesFollowThePowerLaw)
{
  const Terrain ground = flatGround();
  const Polyhedron body = makeShape(Shape::Eota221, 1.0);
  const double whole = body.integrals().volume;
  const int trials = someOf(1500, 60);
  for (const double dimension : { 1.5, 2.0 })
  {
    const double least = 0.003;
    const Fragmentation law = lawOf(1.0, least * whole, dimension);
    std::vector<std::vector<double>> counts(4);
    std::vector<double> lost;
    const double shares[] = { 0.5, 0.1, 0.02, least };
    for (int k = 0; k < trials; ++k)
    {
      double sum = 0.0, numbers[4] = {};
      for (const Polyhedron& piece :
        fragmentsOf(body, law, Surface(ground, 5, k), std::uint32_t(k)))
      {
        const double share = piece.integrals().volume / whole;
        sum += share;
        for (int i = 0; i < 4; ++i)
        {
          numbers[i] += share >= shares[i];
        }
      }
      for (std::size_t i = 0; i < 4; ++i)
      {
        counts[i].push_back(numbers[i]);
      }
      lost.push_back(1.0 - sum);
    }
    const auto expectMean = [&](std::vector<double>& values, double expected)
    {
      const SampleStatistics of = statisticsOf(values);
      EXPECT_NEAR(of.mean, expected, 4.0 * of.deviation / std::sqrt(double(trials)))
        << dimension << ", " << expected;
    };
    for (std::size_t i = 0; i < 4; ++i)
    {
      expectMean(counts[i], meanFragments(dimension, shares[i]));
    }
    expectMean(lost, std::pow(least, 1.0 - dimension / 3.0));
  }
}

TEST(Fragmentation, DoesNotDependOnThreads)
{
  const Terrain slope = makeSlope(
    41, 5.0, [](double x, double) { return 120.0 - 0.6 * x; }, material(0.5, 25.0));
  std::vector<Rock> rocks;
  for (int k = 0; k < 4; ++k)
  {
    Rock& rock = rocks.emplace_back(dropped(0.0));
    rock.blockId = k;
    rock.position = Vec3(20.0, 40.0 + 20.0 * k, 120.0 - 12.0 + 12.0);
  }
  Fragmentation law = lawOf(60e3, 0.02);
  law.spread = radians(20.0);
  law.survival = 0.3;
  const auto one = runOf(slope, rocks, law, 3, 1), two = runOf(slope, rocks, law, 3, 2);
  ASSERT_EQ(one.size(), two.size());
  ASSERT_GT(one.size(), 12u);
  std::size_t again = 0, wholes = 0;
  for (std::size_t k = 0; k < one.size(); ++k)
  {
    EXPECT_EQ(one[k].summary.hash, two[k].summary.hash);
    EXPECT_EQ(one[k].summary.piece, two[k].summary.piece);
    again += one[k].summary.piece > 0 && one[k].summary.fate == Fate::Broken;
    wholes += one[k].summary.piece == 0;
  }
  EXPECT_EQ(wholes, 12u);
  EXPECT_GT(again, 0u) << "no piece broke again";
}

TEST(Fragmentation, ShapesAreThoseThatFell)
{
  const Terrain ground = flatGround();
  const std::vector<Rock> rocks = { dropped(20.0) };
  SimulationParameters p;
  p.fragmentation = lawOf(20e3, 0.01);
  p.endTime = 20.0;
  TrajectoryStore store;
  ASSERT_TRUE(runEnsemble(ground, rocks, p, store));
  PieceShapes shapes(ground, p);
  bool again = false;
  for (const Trajectory& t : store.trajectories())
  {
    const Polyhedron shape = shapes.next(t.summary, rocks[0]);
    again = again || (t.summary.piece > 0 && t.summary.pieces > 0);
    if (t.summary.piece > 0)
    {
      EXPECT_EQ(shape.integrals().volume, t.summary.volume);
    }
  }
  EXPECT_TRUE(again);
}

TEST(Fragmentation, SpreadIsUniformOverTheConeAndLeavesTheGround)
{
  const Terrain ground = flatGround();
  Fragmentation law = lawOf(1.0, 1.0);
  law.spread = radians(30.0);
  const Vec3 velocity(3.0, 0.0, 0.2);
  std::vector<double> shares;
  for (std::uint32_t k = 0; k < 2000; ++k)
  {
    const Surface surface(ground, 9, 0);
    const Vec3 free = spreadVelocity(velocity, Vec3::Zero(), law, surface, k);
    EXPECT_NEAR(free.norm(), velocity.norm(), 1e-12);
    const double cosine = free.dot(velocity) / velocity.squaredNorm();
    shares.push_back((1.0 - cosine) / (1.0 - std::cos(law.spread)));
    EXPECT_GE(spreadVelocity(velocity, Vec3::UnitZ(), law, surface, k).z(), 0.0);
  }
  const SampleStatistics of = statisticsOf(shares);
  EXPECT_NEAR(of.mean, 0.5, 0.02); // uniform in 0 … 1
  EXPECT_NEAR(of.deviation, std::sqrt(1.0 / 12.0), 0.01);
  EXPECT_LE(of.maximum, 1.0 + 1e-12);
}

TEST(Fragmentation, ASourceCountsOnceInACell)
{
  const Terrain slope = makeSlope(
    41, 5.0, [](double x, double) { return 120.0 - 0.6 * x; }, material(0.6, 20.0));
  Rock rock = dropped(0.0);
  rock.position = Vec3(20.0, 100.0, 125.0);
  const auto all = runOf(slope, { rock }, lawOf(40e3, 0.01), 2);
  ASSERT_GT(all.size(), 8u);
  HazardRaster raster({ 40, 40, 5.0, 0.0, 0.0 });
  CollectorLine road;
  road.points = { { 60.0, 0.0 }, { 60.0, 200.0 } };
  road.barrierHeight = road.barrierCapacity = std::numeric_limits<double>::infinity();
  std::vector<Crossing> crossings;
  double most = 0.0;
  for (const Trajectory& t : all)
  {
    std::vector<PathPoint> points;
    const RockPath path = pathOf(t, points);
    raster.add(path);
    appendCrossings(path, road, 0, nullptr, crossings);
    most = std::max(most, t.summary.maxKineticEnergy);
  }
  EXPECT_EQ(raster.released(), 2);
  double largest = 0.0;
  int stops = 0;
  summarize(raster,
    [&](const CellSummary& cell)
    {
      EXPECT_LE(cell.rocks, 2);
      EXPECT_LE(cell.reach, 1.0);
      stops += cell.stops;
      largest = std::max(largest, cell.statistics[0].maximum);
    });
  EXPECT_NEAR(largest, most, 1e-2 * most);
  const LineSummary summary = summarizeLine(road, 0, crossings, raster.released());
  EXPECT_EQ(summary.rocks, 2);
  EXPECT_EQ(summary.share, 1.0);
  // Each with the most of its pieces.
  ASSERT_EQ(summary.energies.size(), 2u);
  ASSERT_GT(crossings.size(), 2u);
  const auto strongest = std::max_element(crossings.begin(), crossings.end(),
    [](const Crossing& a, const Crossing& b) { return a.kineticEnergy < b.kineticEnergy; });
  EXPECT_EQ(summary.energies.back(), strongest->kineticEnergy);
}

TEST(Fragmentation, APieceBeginsWithItsPartOfTheMotionAndGainsNothing)
{
  // Steep, with bumps, stems and a net: pieces roll, slide, jump and are held.
  const auto height = [](double x, double y)
  { return 140.0 * std::exp(-x / 80.0) + 2.0 * std::sin(x / 9.0) * std::cos(y / 13.0); };
  Structures s;
  for (int k = 0; k < 60; ++k)
  {
    Tree& tree = s.trees.emplace_back();
    tree.feature = k + 1;
    tree.position = { 60.0 + 5.0 * (k % 6), 60.0 + 12.0 * (k / 6) };
    tree.diameter = 0.3;
    tree.height = 15.0;
    tree.capacity = 30e3;
  }
  Barrier& net = s.barriers.emplace_back();
  net.feature = 1;
  net.points = { { 110.0, 40.0 }, { 110.0, 200.0 } };
  net.height = 3.0;
  net.capacity = 1e5;
  std::vector<Rock> rocks;
  for (int k = 0; k < someOf(3, 1); ++k)
  {
    Rock& rock = rocks.emplace_back(dropped(0.0));
    rock.blockId = k;
    const double x = 12.0, y = 60.0 + 30.0 * k;
    rock.position = Vec3(x, y, height(x, y) + 6.0);
  }
  for (const bool yields : { false, true })
  {
    Terrain slope = makeSlope(61, 4.0, height, yields ? softGround() : material(0.6, 25.0));
    slope.setStructures(s);
    Fragmentation law = lawOf(20e3, 0.01);
    law.loss = yields ? 0.0 : 0.3;
    const auto all = runOf(slope, rocks, law);
    // Of one rock and iteration: parents by their order, pieces behind each other.
    int born = 0, faster = 0, scars = 0;
    for (std::size_t first = 0; first < all.size();)
    {
      std::size_t next = first + 1;
      for (std::size_t parent = first; parent < next; ++parent)
      {
        const Sample& end = all[parent].samples.back();
        for (int k = 0; k < all[parent].summary.pieces; ++k, ++next)
        {
          const Trajectory& piece = all[next];
          scars += piece.summary.energy.scars > 0.0;
          const Sample& begin = piece.samples.front();
          // As a part of the whole, which has left its share of the energy.
          const Vec3 lever = begin.position - end.position;
          const Vec3 field = end.velocity + end.angularVelocity.cross(lever);
          EXPECT_LT((begin.velocity - field).norm(), 1e-9 * std::max(1.0, field.norm()));
          EXPECT_LT((begin.angularVelocity - end.angularVelocity).norm(), 1e-9);
          // Nothing that comes later has more energy.
          const double mass = piece.summary.mass;
          const double most = begin.kineticEnergy / mass + kGravity * begin.position.z();
          for (const Sample& sample : piece.samples)
          {
            EXPECT_LE(sample.kineticEnergy / mass + kGravity * sample.position.z(),
              most + 1e-3 * begin.kineticEnergy / mass + 0.01)
              << piece.summary.piece << " at " << sample.time;
          }
          ++born;
          faster += begin.velocity.norm() > 1.05 * end.velocity.norm();
        }
      }
      first = next;
    }
    EXPECT_GT(born, someOf(30, 5));
    EXPECT_TRUE(yields || faster > someOf(3, 0)) << "no piece was flung off";
    EXPECT_EQ(scars > 0, yields);
  }
}

TEST(Fragmentation, BadNumbersAreNamed)
{
  const Terrain ground = flatGround();
  const auto messageOf = [&](const Fragmentation& law, bool contact = false)
  {
    SimulationParameters p;
    p.fragmentation = law;
    p.rockRockContact = contact;
    TrajectoryStore store;
    try
    {
      runEnsemble(ground, std::vector<Rock>{ dropped(1.0) }, p, store);
    }
    catch (const ParameterError& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto has = [](const std::string& text, const char* part)
  { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(messageOf(lawOf(0.0, 0.1)), "FragmentationEnergy is 0 J/m³"));
  EXPECT_TRUE(has(messageOf(lawOf(1e4, 0.0)), "LeastFragment is 0 m³"));
  EXPECT_TRUE(has(messageOf(lawOf(1e4, 0.1, 3.0)), "FractalDimension is 3"));
  EXPECT_TRUE(has(messageOf(lawOf(1e4, 1e-6)), "pieces, at most 1000"));
  // Ranges hold whether rocks break or not.
  Fragmentation idle;
  EXPECT_EQ(messageOf(idle), "");
  idle.fractalDimension = 4.0;
  EXPECT_TRUE(has(messageOf(idle), "FractalDimension is 4, it must be 0 to 3"));
  EXPECT_TRUE(has(messageOf(lawOf(1e4, 0.1), true), "RockRockContact"));
}
