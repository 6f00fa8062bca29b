// Contact detection (METHOD 3, 5, 10.5): the indexed, pruned search against brute force, flat
// edges, clearance.

#include "bruteForce.h"
#include "contact/ground/clearance.h"
#include "contact/ground/detection.h"
#include "slopes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

struct Placed
{
  Block block;
  BlockState state;
  PlacedBlock rock;

  Placed(const Polyhedron& shape, const Vec3& position, const Quat& orientation)
    : block(shape, 2500.0, 1e10, 0.1)
  {
    state.position = position;
    state.orientation = orientation;
    rock.place(block, state);
  }
};

Quat randomRotation(std::mt19937& random)
{
  std::normal_distribution<double> n(0.0, 1.0);
  return Quat(n(random), n(random), n(random), n(random)).normalized();
}

Terrain roughTerrain(unsigned seed, double relief)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> z(0.0, relief);
  return makeSlope(13, 0.8, [&](double, double) { return z(random); });
}

/// Lowers a rock until it is `gap` over the surface along the vertical, at its lowest.
double restingHeight(
  const Terrain& terrain, const Polyhedron& shape, const Quat& q, double x, double y)
{
  // Bisection; a rock under the surface is apart from it as well, so the side counts.
  double low = -5.0, high = 10.0;
  for (int k = 0; k < 60; ++k)
  {
    const double middle = 0.5 * (low + high);
    Placed p(shape, Vec3(x, y, middle), q);
    SurfacePatch patch;
    gatherPatch(Surface::asSurveyed(terrain), 0.0, terrain.width(), 0.0, terrain.height(), patch);
    const bool clear = middle > terrain.elevation(x, y) &&
      clearance(p.rock, p.state, patch, 0.0, 1.0).distance > 0.0;
    (clear ? high : low) = middle;
  }
  return high;
}

void expectSame(const std::vector<Contact>& one, const std::vector<Contact>& other)
{
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i)
  {
    EXPECT_EQ(one[i].kind, other[i].kind);
    EXPECT_EQ(one[i].rockFeature, other[i].rockFeature);
    EXPECT_EQ(one[i].surfaceFeature, other[i].surfaceFeature);
    EXPECT_EQ(one[i].distance, other[i].distance);
  }
}

} // namespace

TEST(Contacts, PrunedSearchFindsWhatBruteForceFinds)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(3.0, 6.5), lift(0.0, 0.02);
  int pairs = 0, lonely = 0, kinds[3] = { 0, 0, 0 };
  for (int trial = 0; trial < 200; ++trial)
  {
    const Terrain terrain = roughTerrain(100 + trial, trial % 2 ? 0.3 : 1.5);
    const Shape shapes[] = { Shape::Cube, Shape::Icosahedron, Shape::Eota221, Shape::Tetrahedron };
    const Polyhedron shape = makeShape(shapes[trial % 4], 0.7);
    const Quat q = randomRotation(random);
    const double x = place(random), y = place(random);
    const double z = restingHeight(terrain, shape, q, x, y) + lift(random);
    Placed p(shape, Vec3(x, y, z), q);
    const Surface surface = Surface::asSurveyed(terrain);
    SurfacePatch local, whole;
    const Vec3 lower = p.rock.lower(), upper = p.rock.upper();
    const double reach = 0.05; // m
    gatherPatch(
      surface, lower.x() - reach, upper.x() + reach, lower.y() - reach, upper.y() + reach, local);
    gatherPatch(surface, 0.0, terrain.width(), 0.0, terrain.height(), whole);
    std::vector<Contact> indexed, brute;
    CandidatePairs candidates;
    gatherCandidates(p.rock, p.state, local, reach, candidates);
    updateContacts(p.rock, local, candidates, reach, indexed);
    findEntrancesBruteForce(p.rock, whole, reach, brute);
    const auto order = [](const Contact& a, const Contact& b)
    {
      return std::tie(a.kind, a.rockFeature, a.surfaceFeature) <
        std::tie(b.kind, b.rockFeature, b.surfaceFeature);
    };
    std::sort(indexed.begin(), indexed.end(), order);
    std::sort(brute.begin(), brute.end(), order);
    ASSERT_EQ(indexed.size(), brute.size()) << "trial " << trial;
    expectSame(indexed, brute);
    for (const Contact& c : brute)
    {
      ++pairs;
      ++kinds[int(c.kind)];
    }
    lonely += brute.empty();
  }
  // A rock that all but touches has an entrance, unless what is nearest is a vertex beside a ridge.
  EXPECT_LE(lonely, 3);
  EXPECT_GT(kinds[0], 50);
  EXPECT_GT(kinds[1], 3);
  EXPECT_GT(kinds[2], 20);
  std::printf("%d pairs: %d vertex-face, %d face-vertex, %d edge-edge\n", pairs, kinds[0], kinds[1],
    kinds[2]);
}

// A pair that was far is not looked at again before the rock may have come that way.
TEST(Contacts, LooksOnTheWayFindWhatAFirstLookFinds)
{
  std::mt19937 random(12);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const double around = 0.3, reach = 0.02; // m
  int looks = 0, found = 0;
  for (int trial = 0; trial < 40; ++trial)
  {
    const Terrain terrain = roughTerrain(300 + trial, trial % 2 ? 0.3 : 1.5);
    const Shape shapes[] = { Shape::Cube, Shape::Icosahedron, Shape::Eota221, Shape::Tetrahedron };
    const Polyhedron shape = makeShape(shapes[trial % 4], 0.7);
    const Quat q = randomRotation(random);
    const double x = 4.7 + 1.5 * u(random), y = 4.7 + 1.5 * u(random);
    Placed p(shape, Vec3(x, y, restingHeight(terrain, shape, q, x, y) + 0.05), q);
    SurfacePatch patch;
    gatherPatch(Surface::asSurveyed(terrain), x - 2.0, x + 2.0, y - 2.0, y + 2.0, patch);
    CandidatePairs first;
    gatherCandidates(p.rock, p.state, patch, around, first);
    const CandidatePairs kept = first;
    const Vec3 way = 0.05 * Vec3(u(random), u(random), -1.0),
               turn = 0.05 * Vec3(u(random), u(random), u(random));
    for (int step = 0; first.room(p.state, p.block.radius(), reach) > 0.0; ++step)
    {
      const CandidatePairs fresh = first; // nobody has looked
      std::vector<Contact> one, other;
      updateContacts(p.rock, patch, kept, reach, one);
      updateContacts(p.rock, patch, fresh, reach, other);
      ASSERT_EQ(one.size(), other.size()) << "trial " << trial << ", step " << step;
      expectSame(one, other);
      ++looks;
      found += int(one.size());
      p.state.position += (0.3 + 0.7 * std::abs(u(random))) * 0.2 * way;
      p.state.orientation =
        (Quat(1.0, 0.1 * turn.x(), 0.1 * turn.y(), 0.1 * turn.z()) * p.state.orientation)
          .normalized();
      p.rock.place(p.block, p.state);
    }
  }
  EXPECT_GT(looks, 400);
  EXPECT_GT(found, 100);
}

TEST(Contacts, AFlatPlaneOfManyCfesHasNoInnerFeatures)
{
  const double angle = radians(30.0);
  const Terrain plane = makePlane(101, 50.0, angle, 0.4, material(0.8, 15.0));
  const Rock cube = cubeOnPlane(50.0, angle, 0.4, 3.3);
  Placed p(cube.shape, cube.position, cube.orientation);
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(plane), p.rock.lower().x(), p.rock.upper().x(),
    p.rock.lower().y(), p.rock.upper().y(), patch);
  std::vector<Contact> contacts;
  CandidatePairs candidates;
  gatherCandidates(p.rock, p.state, patch, 0.01, candidates);
  updateContacts(p.rock, patch, candidates, 0.01, contacts);
  ASSERT_EQ(contacts.size(), 4u); // the corners of the face that lies on it, nothing else
  for (const Contact& c : contacts)
  {
    EXPECT_EQ(c.kind, ContactKind::VertexFace);
    EXPECT_NEAR(c.distance, 0.0, 1e-12);
  }
}

TEST(Contacts, ClearanceIsALowerBound)
{
  std::mt19937 random(12);
  std::uniform_real_distribution<double> place(3.0, 6.5), lift(0.05, 1.0), speed(-8.0, 8.0);
  for (int trial = 0; trial < 60; ++trial)
  {
    const Terrain terrain = roughTerrain(300 + trial, 1.0);
    const Polyhedron shape = makeShape(trial % 2 ? Shape::Cube : Shape::Dodecahedron, 0.5);
    const Quat q = randomRotation(random);
    const double x = place(random), y = place(random);
    Placed p(shape, Vec3(x, y, restingHeight(terrain, shape, q, x, y) + lift(random)), q);
    p.state.velocity = Vec3(0.2 * speed(random), 0.2 * speed(random), speed(random));
    p.state.spin = Vec3(speed(random), speed(random), speed(random));
    SurfacePatch patch;
    gatherPatch(Surface::asSurveyed(terrain), 0.0, terrain.width(), 0.0, terrain.height(), patch);
    const Clearance c = clearance(p.rock, p.state, patch, kGravity, 0.5);
    EXPECT_GT(c.distance, 0.0);
    EXPECT_GT(c.time, 0.0);
    // No vertex is under the slope, and no peak in the rock, at any time before.
    for (int k = 0; k <= 20; ++k)
    {
      const double t = 0.999 * c.time * k / 20.0;
      BlockState s = p.state;
      s.position += t * s.velocity - Vec3(0, 0, 0.5 * kGravity * t * t);
      const Vec3 w = s.spin;
      s.orientation = s.orientation * Quat(Eigen::AngleAxisd(t * w.norm(), w.normalized()));
      PlacedBlock later;
      later.place(p.block, s);
      EXPECT_LT(penetration(later, patch), 1e-9);
    }
  }
}

// A slab of 0.2 m stands aslant on a peak that is a millimetre in its lower side, near its end. The
// ridge that falls away from the peak is 0.36 m "under" the far edge of that end, with a normal
// that is in both cones: it never came in there, and pressing it out would wind the slab up.
TEST(Contacts, ARidgeThatTouchesOneSideOfASlabHasNotComeInOnTheOther)
{
  const Terrain terrain =
    makeSlope(21, 1.0, [](double x, double y) { return x == 10.0 && y == 10.0 ? 4.0 : 0.0; });
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(terrain), 0.0, terrain.width(), 0.0, terrain.height(), patch);
  const Quat tilt(Eigen::AngleAxisd(std::asin(0.8), Vec3::UnitY()));
  const Vec3 peak(10.0, 10.0, 4.0), in(3.7, 0.0, -0.099);
  Placed p(makeBox(Vec3(8.0, 8.0, 0.2)), peak - tilt * in, tilt);
  std::vector<Contact> contacts;
  findEntrancesBruteForce(p.rock, patch, 0.01, contacts);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].kind, ContactKind::FaceVertex);
  EXPECT_NEAR(contacts[0].distance, -0.001, 1e-9);
}
