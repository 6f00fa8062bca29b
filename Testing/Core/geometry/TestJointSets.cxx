// A rock mass that joint sets cut into blocks: volumes, counts, faces that fit.

#include "form.h"
#include "geometry/shapes.h"
#include "massCuts.h"
#include "piles.h"
#include "run/overlaps.h"
#include "slopes.h"
#include "world/World.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>
#include <span>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

MassCut keeping()
{
  MassCut how;
  how.slivers = SliverRule::Keep;
  return how;
}

/// Cubes of 1 m that make one of 3 m, about the origin.
std::vector<JointSet> cubeSets()
{
  return { jointSet(0.0, 0.0, 1.0, 0.5), jointSet(90.0, 90.0, 1.0, 0.5),
    jointSet(90.0, 0.0, 1.0, 0.5) };
}

/// The same body as a file in single precision has it, by polygons or by triangles.
Polyhedron inSinglePrecision(const Polyhedron& body, bool triangles)
{
  std::vector<Vec3> points = body.vertices();
  for (Vec3& p : points)
  {
    p = p.cast<float>().cast<double>();
  }
  std::vector<std::vector<int>> faces;
  for (const std::vector<int>& loop : body.faces())
  {
    if (!triangles)
    {
      faces.push_back(loop);
      continue;
    }
    for (std::size_t i = 2; i < loop.size(); ++i)
    {
      faces.push_back({ loop[0], loop[i - 1], loop[i] });
    }
  }
  return Polyhedron::fromFaces(points, faces, "mass.stl").centred();
}

/// Blocks released as they stand, the lowest point of the mass at the given place.
std::vector<Rock> rocksOf(const CutMass& cut, const Quat& turn, const Vec3& shift)
{
  std::vector<Rock> rocks;
  for (const Polyhedron& block : cut.blocks)
  {
    Rock rock;
    rock.blockId = std::int64_t(rocks.size());
    rock.position = turn * block.integrals().centroid + shift;
    rock.shape = block.centred();
    rock.orientation = turn;
    rocks.push_back(rock);
  }
  return rocks;
}

/// How far blocks have come after `duration`, least and most.
std::array<double, 2> travel(const Terrain& ground, const std::vector<Rock>& rocks, double duration)
{
  SimulationParameters parameters;
  parameters.rockRockContact = true;
  std::vector<Block> blocks;
  for (const Rock& r : rocks)
  {
    blocks.emplace_back(r.shape, r.density, r.youngModulus, r.poissonRatio);
  }
  const Surface surface(ground, 1, 0);
  World fall(surface, rocks, blocks, parameters, 0, false);
  fall.release();
  while (fall.time() < duration - 1e-9 && fall.advance())
  {
  }
  std::array<double, 2> way{ INFINITY, 0.0 };
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    const double moved = (fall.state(int(i)).position - rocks[i].position).norm();
    way = { std::min(way[0], moved), std::max(way[1], moved) };
  }
  return way;
}

} // namespace

TEST(JointSets, NormalsAreThoseOfGeologists)
{
  // Dips 30° to the east: the normal leans east.
  const Vec3 east = jointSet(30.0, 90.0, 1.0).normal();
  EXPECT_NEAR((east - Vec3(0.5, 0.0, std::sqrt(0.75))).norm(), 0.0, 1e-15);
  const Vec3 north = jointSet(90.0, 0.0, 1.0).normal();
  EXPECT_NEAR((north - Vec3::UnitY()).norm(), 0.0, 1e-15);
}

TEST(JointSets, BoxIntoCubes)
{
  const Polyhedron mass = makeBox(Vec3(3.0, 3.0, 3.0));
  EXPECT_NEAR(expectedBlocks(mass, cubeSets()), 64.0, 1e-9); // mean over all offsets: (1 + 3)³
  const CutMass cut = cutMass(mass, cubeSets(), {});
  ASSERT_EQ(cut.blocks.size(), 27u);
  for (const Polyhedron& block : cut.blocks)
  {
    EXPECT_EQ(block.faces().size(), 6u);
    EXPECT_EQ(block.edges().size(), 12u);
    EXPECT_NEAR(block.integrals().volume, 1.0, 1e-14);
  }
  EXPECT_NEAR(sumOf(cut), 27.0, 27.0 * 1e-14);
}

TEST(JointSets, VolumesSumToTheWhole)
{
  // Oblique sets with deviations, through a box and an icosahedron, near the origin and far away.
  std::vector<JointSet> sets = { jointSet(35.0, 120.0, 0.9), jointSet(80.0, 215.0, 1.1, 0.2),
    jointSet(65.0, 330.0, 0.8, -0.1), jointSet(15.0, 20.0, 1.7) };
  for (std::uint64_t seed : { 1u, 2u, 3u, 4u, 5u })
  {
    for (JointSet& set : sets)
    {
      set.spacingDeviation = seed % 2 ? 0.3 : 0.0;
      set.orientationDeviation = seed % 3 ? radians(4.0) : 0.0;
    }
    for (const Polyhedron& mass :
      { makeBox(Vec3(5.0, 4.0, 3.0)), makeShape(Shape::Icosahedron, 50.0),
        makeShape(Shape::Dodecahedron, 50.0)
          .transformed(1.0, Quat::Identity(), Vec3(1e4, 2e4, 500)) })
    {
      MassCut how;
      how.slivers = SliverRule::Drop;
      how.leastThickness = 0.001;
      how.leastVolume = 0.0;
      how.seed = seed;
      const CutMass cut = cutMass(mass, sets, how);
      EXPECT_GT(cut.blocks.size(), 150u);
      // 1e-12: every block rounds its own volume; 1e4 m away the coordinates are rounded, too.
      const double tolerance = mass.integrals().centroid.norm() > 1.0 ? 1e-10 : 1e-12;
      EXPECT_NEAR((sumOf(cut) + cut.sliverVolume) / mass.integrals().volume, 1.0, tolerance)
        << seed;
    }
  }
}

TEST(JointSets, NeighboursHaveTheSamePoints)
{
  // Persistent planes make a complex: every face inside the mass is that of two blocks, with the
  // same points bit for bit, so that blocks touch and neither overlap nor gape.
  const Polyhedron mass = makeBox(Vec3(4.0, 4.0, 4.0));
  const std::vector<JointSet> sets = { jointSet(35.0, 120.0, 1.1), jointSet(80.0, 215.0, 1.3, 0.2),
    jointSet(65.0, 330.0, 1.2, -0.1) };
  MassCut how = keeping();
  const CutMass cut = cutMass(mass, sets, how);
  std::map<std::set<std::array<double, 3>>, int> faces;
  for (const Polyhedron& block : cut.blocks)
  {
    for (const std::vector<int>& loop : block.faces())
    {
      std::set<std::array<double, 3>> points;
      for (const int id : loop)
      {
        const Vec3& p = block.vertices()[std::size_t(id)];
        points.insert({ p.x(), p.y(), p.z() });
      }
      ++faces[points];
    }
  }
  int inner = 0, outer = 0;
  for (const auto& [points, uses] : faces)
  {
    bool onHull = false;
    for (std::size_t f = 0; f < mass.faces().size(); ++f)
    {
      onHull = onHull ||
        std::all_of(points.begin(), points.end(),
          [&](const std::array<double, 3>& p) {
            return std::abs(mass.normals()[f].dot(Vec3(p[0], p[1], p[2])) - mass.offsets()[f]) <
              1e-9;
          });
    }
    EXPECT_EQ(uses, onHull ? 1 : 2);
    ++(onHull ? outer : inner);
  }
  EXPECT_GT(inner, 50);
  EXPECT_GT(outer, 50);
  EXPECT_TRUE(findOverlaps(rocksOf(cut, Quat::Identity(), Vec3::Zero())).empty());
}

TEST(JointSets, CountIsForetold)
{
  // The formula is a mean over offsets: 30 of them come within 3 %, as a count scatters by some 5
  // %.
  const Polyhedron mass = makeBox(Vec3(7.0, 5.0, 4.0));
  double sum = 0.0, expected = 0.0;
  for (int k = 0; k < 30; ++k)
  {
    const std::vector<JointSet> sets = { jointSet(35.0, 120.0, 0.9, 0.03 * k),
      jointSet(80.0, 215.0, 1.1, 0.17 * k), jointSet(65.0, 330.0, 1.3, 0.11 * k) };
    MassCut how;
    how.slivers = SliverRule::Drop;
    how.leastThickness = 1e-3;
    const CutMass cut = cutMass(mass, sets, how);
    sum += double(cut.blocks.size()) + double(cut.slivers);
    expected += expectedBlocks(mass, sets);
  }
  EXPECT_NEAR(sum / expected, 1.0, 0.03);
}

TEST(JointSets, ThroughVerticesAndEdges)
{
  // Planes through corners and along edges and faces: nothing is cut off that has no volume.
  const Polyhedron cube = makeBox(Vec3(2.0, 2.0, 2.0));
  const CutMass diagonal = cutMass(cube, std::vector{ jointSet(45.0, 90.0, 10.0) }, {});
  ASSERT_EQ(diagonal.blocks.size(), 2u);
  for (const Polyhedron& block : diagonal.blocks)
  {
    EXPECT_EQ(block.faces().size(), 5u);
    EXPECT_NEAR(block.integrals().volume, 4.0, 1e-13);
  }
  // Joints in two of the faces and through the middle.
  EXPECT_EQ(cutMass(cube, std::vector{ jointSet(0.0, 0.0, 1.0) }, {}).blocks.size(), 2u);
}

TEST(JointSets, DrawnFromTheSeed)
{
  const Polyhedron mass = makeBox(Vec3(40.0, 4.0, 4.0));
  JointSet set = jointSet(90.0, 90.0, 0.5);
  set.spacingDeviation = 0.25;
  const auto places = jointPlanes(mass, set, 0, 7);
  double sum = 0.0, squares = 0.0;
  for (std::size_t k = 1; k < places.size(); ++k)
  {
    const double gap = places[k].offset - places[k - 1].offset;
    EXPECT_GT(gap, 0.0);
    sum += gap;
    squares += gap * gap;
  }
  const double n = double(places.size() - 1), mean = sum / n;
  // Standard errors of some 80 gaps: 0.028 of the mean, about 0.03 of the deviation.
  EXPECT_NEAR(mean, 0.5, 0.09);
  EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 0.25, 0.09);
  const auto again = jointPlanes(mass, set, 0, 7), other = jointPlanes(mass, set, 0, 8);
  ASSERT_EQ(places.size(), again.size());
  EXPECT_EQ(places[3].offset, again[3].offset);
  EXPECT_NE(places[3].offset, other[3].offset);
}

TEST(JointSets, CutBoxStandsStill)
{
  // 27 cubes that touch face to face, on flat ground: calm from the first step.
  const CutMass cut = cutMass(makeBox(Vec3(3.0, 3.0, 3.0)), cubeSets(), {});
  const Terrain ground = makeSlope(
    9, 5.0, [](double, double) { return 0.0; }, material(0.3, 35.0));
  const auto rocks = rocksOf(cut, Quat::Identity(), Vec3(20.0, 20.0, 1.5));
  const auto [least, most] = travel(ground, rocks, 2.0);
  EXPECT_LT(most, 1e-4);
}

TEST(JointSets, CutBoxSlidesDownASlope)
{
  // On 35° with φ 20° all of it slides, s = ½ g (sin α − cos α tan φ) t², for the blocks in contact
  // with the slope; those above go along or come off.
  const CutMass cut = cutMass(makeBox(Vec3(3.0, 3.0, 3.0)), cubeSets(), {});
  const double angle = radians(35.0), time = 0.5;
  const Terrain ground = makePlane(21, 100.0, angle, 0.0, material(0.3, 20.0));
  const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
  const auto rocks = rocksOf(
    cut, Quat(Eigen::AngleAxisd(angle, Vec3::UnitY())), Vec3(50.0, 50.0, 100.0) + 1.5 * normal);
  const double expected =
    0.5 * kGravity * (std::sin(angle) - std::cos(angle) * std::tan(radians(20.0))) * time * time;
  const auto [least, most] = travel(ground, rocks, time);
  // φ between the blocks (30°) is greater, so that they go as one.
  EXPECT_NEAR(least, expected, 0.02 * expected);
  EXPECT_NEAR(most, expected, 0.02 * expected);
}

TEST(JointSets, CollapseThrowsNoWedgeAbout)
{
  // Masses of 70 blocks and more on a slope, with wedges of a few kilograms among blocks of tonnes:
  // forces far from settled threw such out at up to 31 m/s here, and at 224 m/s elsewhere; and what
  // was pushed or turned in a step drove vertices under the slope by up to half a radius that were
  // out of its reach when the step began.
  const unsigned seeds[] = { 3u, 5u, 8u, 10u };
  for (const unsigned seed : std::span(seeds).first(std::size_t(someOf(4, 1))))
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    const auto next = [&] { return u(random); };
    const double angle = radians(30.0 + 40.0 * next());
    const double friction = 10.0 + 35.0 * next(), restitution = 0.3 + 0.4 * next();
    const double sx = 3.0 + 2.0 * next(), sy = 3.0 + 2.0 * next(), sz = 3.0 + next();
    std::vector<JointSet> sets;
    for (const auto& [dip, dips, azimuth, azimuths] : { std::array{ 0.0, 30.0, 0.0, 360.0 },
           std::array{ 60.0, 30.0, 0.0, 40.0 }, std::array{ 60.0, 30.0, 70.0, 40.0 } })
    {
      JointSet set;
      set.dip = radians(dip + dips * next());
      set.dipDirection = radians(azimuth + azimuths * next());
      set.spacing = 0.9 * (0.7 + next());
      set.spacingDeviation = 0.2 * next();
      set.orientationDeviation = radians(5.0 * next());
      sets.push_back(set);
    }
    MassCut how;
    how.slivers = SliverRule::Drop;
    how.leastVolume = 0.001;
    how.seed = seed;
    const CutMass cut = cutMass(makeBox(Vec3(sx, sy, sz)), sets, how);
    const auto height = [&](double x) { return x < 40.0 ? std::tan(angle) * (40.0 - x) : 0.0; };
    std::vector<Rock> rocks = rocksOf(cut, Quat::Identity(), Vec3(15.0, 80.0, 0.0));
    double lift = 0.0;
    for (const Rock& rock : rocks)
    {
      for (const Vec3& v : rock.shape.vertices())
      {
        const Vec3 at = rock.position + v;
        lift = std::max(lift, height(2.0 * std::floor(0.5 * at.x())) - at.z());
      }
    }
    for (Rock& rock : rocks)
    {
      rock.position.z() += lift;
    }
    Pile pile;
    pile.ground = makeSlope(
      81, 2.0, [&](double x, double) { return height(x); }, material(restitution, friction));
    pile.rocks = rocks;
    pile.parameters.timeStep = 0.01;
    pile.parameters.rockFrictionAngle = radians(15.0 + 30.0 * next());
    pile.start();
    double fastest = 0.0, deepest = 0.0;
    PlacedBlock placed;
    while (pile.fall->time() < 1.0)
    {
      pile.fall->advance();
      for (std::size_t i = 0; i < rocks.size(); ++i)
      {
        fastest = std::max(fastest, pile.fall->state(int(i)).velocity.norm());
        placed.place(pile.blocks[i], pile.fall->state(int(i)));
        for (const Vec3& v : placed.vertices())
        {
          const double depth = std::cos(angle) * (pile.surface->elevation(v.x(), v.y()) - v.z());
          deepest = std::max(deepest, depth / pile.blocks[i].radius());
        }
      }
    }
    EXPECT_GT(rocks.size(), 64u);
    // What strikes at the 9.8 m/s of a free fall throws a light one at (1 + e) times as much, which
    // keeps what it has across.
    EXPECT_LT(fastest, 9.8 * std::hypot(1.0 + pile.parameters.rockRestitution, 1.0))
      << "seed " << seed;
    // A step may press a rock in by kDeepStep, 0.02, and the next one again; a contact that no look
    // has found makes 0.05 to 0.09.
    EXPECT_LT(deepest, 0.04) << "seed " << seed;
  }
}

TEST(JointSets, CutMassesOfSinglePrecision)
{
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const std::vector<JointSet> sets = { jointSet(30.0, 90.0, 1.0), jointSet(75.0, 250.0, 1.3) };
  MassCut how;
  how.slivers = SliverRule::Keep;
  how.leastThickness = how.leastVolume = 0.0;
  for (int k = 0; k < 40; ++k)
  {
    SCOPED_TRACE(k);
    const Quat turn(u(random), u(random), u(random), u(random));
    const Vec3 place(20.0 * u(random), 20.0 * u(random), 20.0 * u(random));
    const Polyhedron body =
      k % 2 == 0 ? makeBox(Vec3(3, 4, 2)) : makeShape(Shape::Dodecahedron, 27);
    const Polyhedron mass =
      inSinglePrecision(body.transformed(1.0, turn.normalized(), place), k % 4 < 2);
    const CutMass cut = cutMass(mass, sets, how);
    EXPECT_GE(cut.blocks.size(), 8u);
    // Points are off their planes by some 1e-6 m.
    EXPECT_NEAR(sumOf(cut), mass.integrals().volume, 1e-6 * mass.integrals().volume);
  }
}
