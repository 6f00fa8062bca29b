// Spheres and ellipsoids: mass, contact with planes, edges and nodes, rolling, by closed forms.

#include "contact/ground/detection.h"
#include "contact/ground/roundContact.h"
#include "geometry/roundBody.h"
#include "geometry/shapes.h"
#include "slopes.h"

#include "base/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

const double kBall = std::cbrt(0.75 / std::numbers::pi); // m: 1 m³

Rock ballAt(const Vec3& position)
{
  Rock rock;
  rock.shape = makeShape(Shape::Sphere, 1.0);
  rock.position = position;
  return rock;
}

SurfaceMaterial rolling(double restitution, double friction, double resistance)
{
  SurfaceMaterial m = material(restitution, friction);
  m.restitutionModel = RestitutionModel::NormalTangential;
  m.yielding.rollingResistance = resistance;
  return m;
}

std::vector<Contact> contactsOf(
  const Block& block, const BlockState& state, const SurfacePatch& patch, double reach)
{
  PlacedBlock rock;
  rock.place(block, state);
  CandidatePairs candidates;
  gatherCandidates(rock, state, patch, reach, candidates);
  std::vector<Contact> contacts;
  updateContacts(rock, patch, candidates, reach, contacts);
  return contacts;
}

} // namespace

TEST(RoundBodies, HaveTheMassOfTheBodyAndNotOfItsMesh)
{
  const Polyhedron ball = makeShape(Shape::Sphere, 2.0);
  const double r = std::cbrt(1.5 / std::numbers::pi);
  EXPECT_TRUE(isRound(ball.layout()));
  EXPECT_NEAR(ball.integrals().volume, 2.0, 1e-12);
  EXPECT_NEAR(ball.radius(), r, 1e-12);
  EXPECT_LT((ball.integrals().second - 0.4 * r * r * Mat3::Identity()).norm(), 1e-12);
  EXPECT_TRUE(Block(ball, 2500.0, 1e10, 0.1).isotropic());

  const Polyhedron egg = makeEllipsoid(Vec3(1.0, 2.0, 3.0));
  EXPECT_NEAR(egg.integrals().volume, std::numbers::pi, 1e-9);
  const Vec3 second = std::numbers::pi / 20.0 * Vec3(1.0, 4.0, 9.0);
  EXPECT_LT((egg.integrals().second - Mat3(second.asDiagonal())).norm(), 1e-8);
  EXPECT_NEAR(egg.radius(), 1.5, 1e-9);
  const Polyhedron turned = egg.transformed(
    2.0, Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), Vec3(50.0, -20.0, 7.0));
  EXPECT_TRUE(isRound(turned.layout()));
  EXPECT_NEAR(turned.centred().integrals().volume, 8.0 * std::numbers::pi, 1e-7);

  EXPECT_FALSE(isRound(makeShape(Shape::Icosahedron, 1.0).layout()));
  EXPECT_FALSE(isRound(makeShape(Shape::Eota111, 1.0).layout()));
  EXPECT_THROW(makeEllipsoid(Vec3(1.0, 1.0, 6.0)), ParameterError);
}

/// Against places all over the body.
TEST(RoundBodies, DropAsFarAsTheirLowestPlacesAreOverTheGround)
{
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto any = [&](double size) { return Vec3(size * u(random), size * u(random), u(random)); };
  for (int k = 0; k < 40; ++k)
  {
    const Mat3 axes =
      Quat(u(random), u(random), u(random), u(random)).normalized().toRotationMatrix() *
      Vec3(0.6 + 0.3 * u(random), 0.6, 0.5).asDiagonal();
    const Vec3 centre(0.0, 0.0, 3.0);
    Vec3 a = any(1.5), b = any(1.5), c = any(1.5);
    const Vec3 n = (b - a).cross(c - a);
    if (std::abs(n.z()) < 0.05)
    {
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 120; ++i)
    {
      for (int j = 0; j <= 120 - i; ++j)
      {
        const Vec3 p = a + i / 120.0 * (b - a) + j / 120.0 * (c - a);
        // Of the vertical line through p the lower place on the body.
        const Vec3 w = axes.inverse() * (p - centre), up = axes.inverse().col(2);
        const double dot = w.dot(up), root = dot * dot - up.squaredNorm() * (w.squaredNorm() - 1.0);
        if (root >= 0.0)
        {
          least = std::min(least, (-dot - std::sqrt(root)) / up.squaredNorm());
        }
      }
    }
    const double drop = roundDrop(axes, centre, a, b, c);
    if (std::isinf(least))
    {
      continue; // between the places that were looked at
    }
    EXPECT_LE(drop, least + 1e-9) << k;
    EXPECT_NEAR(drop, least, 0.05) << k;
  }
}

/// v² / (2 · 5/7 μ_r g) on the flat, whatever the cells; without resistance it keeps its speed.
TEST(RoundBodies, RollOnTheFlatAsFarAsTheClosedFormHasIt)
{
  const double speed = 5.0, resistance = 0.05;
  for (const int nodes : { 3, 101 })
  {
    Rock ball = ballAt(Vec3(20.0, 50.3, 100.0 + kBall));
    ball.velocity = Vec3(speed, 0.0, 0.0);
    ball.angularVelocity = Vec3(0.0, speed / kBall, 0.0);
    SimulationParameters p;
    p.endTime = 30.0;
    const Trajectory t =
      simulate(makePlane(nodes, 100.0, 0.0, 0.0, rolling(0.5, 35.0, resistance)), ball, p);
    const double way = speed * speed / (2.0 * 5.0 / 7.0 * resistance * kGravity);
    EXPECT_NEAR(t.summary.stop.x() - 20.0, way, 0.01 * way) << nodes;
    EXPECT_NEAR(t.summary.stop.y(), 50.3, 1e-6) << nodes;
    EXPECT_EQ(t.summary.fate, Fate::Rested);
    EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-3 * t.summary.energy.released);

    p.endTime = 10.0;
    const Trajectory free =
      simulate(makePlane(nodes, 100.0, 0.0, 0.0, rolling(0.5, 35.0, 0.0)), ball, p);
    EXPECT_NEAR(free.summary.stop.x() - 20.0, 50.0, 0.1) << nodes;
  }
}

TEST(RoundBodies, RollDownAsTheClosedFormHasIt)
{
  const double angle = radians(30.0);
  for (const double resistance : { 0.0, 0.1 })
  {
    for (const int nodes : { 3, 101 })
    {
      Rock ball = ballAt(Vec3(20.0, 50.0, 100.0 + 30.0 * std::tan(angle)) +
        kBall * Vec3(std::sin(angle), 0.0, std::cos(angle)));
      SimulationParameters p;
      p.endTime = 3.0;
      const Trajectory t =
        simulate(makePlane(nodes, 100.0, angle, 0.0, rolling(0.5, 35.0, resistance)), ball, p);
      const double way =
        0.5 * 5.0 / 7.0 * kGravity * (std::sin(angle) - resistance * std::cos(angle)) * 9.0;
      EXPECT_NEAR((t.summary.stop - ball.position).norm(), way, 0.01 * way)
        << resistance << ' ' << nodes;
    }
  }
}

/// Elastic and without friction: v' = v − 2 (v · n) n, n from where it touches to the centre.
TEST(RoundBodies, BounceOffEdgesAndNodesAlongTheLineToTheirCentre)
{
  const auto ridge = [](double x, double) { return 100.0 - std::abs(x - 50.0); };
  const auto peak = [](double x, double y)
  { return 100.0 - std::abs(x - 50.0) - std::abs(y - 50.0); };
  const double fall = 2.0;
  for (const Vec3& aside :
    { Vec3(0, 0, 0), Vec3(0.2, 0, 0), Vec3(-0.3, 0, 0), Vec3(0.1, 0.2, 0), Vec3(-0.2, -0.1, 0) })
  {
    for (const bool onPeak : { false, true })
    {
      const Vec3 away = onPeak ? aside : Vec3(aside.x(), 0.0, 0.0);
      const double up = std::sqrt(kBall * kBall - away.squaredNorm());
      const Vec3 n = (away + Vec3(0, 0, up)) / kBall;
      const Terrain ground = makeSlope(
        21, 5.0, onPeak ? std::function<double(double, double)>(peak) : ridge, material(1.0, 0.0));
      Rock ball = ballAt(Vec3(50.0, 50.0, 100.0 + up + fall) + Vec3(aside.x(), aside.y(), 0.0));
      const double time = std::sqrt(2.0 * fall / kGravity), later = 0.1;
      SimulationParameters p;
      p.endTime = time + later;
      p.normalPenalty = 1e11; // touches take half a millisecond
      const Trajectory t = simulate(ground, ball, p);
      const Vec3 before(0.0, 0.0, -kGravity * time);
      const Vec3 after = before - 2.0 * n.dot(before) * n;
      const Vec3 end = ball.position - fall * Vec3::UnitZ() + later * after -
        0.5 * kGravity * later * later * Vec3::UnitZ();
      EXPECT_LT((t.summary.stop - end).norm(), 0.01) << aside.transpose() << ' ' << onPeak;
      EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-3 * t.summary.energy.released);
    }
  }
}

/// Without friction an ellipsoid that tumbles keeps its energy, and lies at last on its flat side.
TEST(RoundBodies, EllipsoidsKeepTheirEnergyAndComeToRestFlat)
{
  Rock egg;
  egg.shape = makeEllipsoid(Vec3(1.4, 1.0, 0.7));
  egg.orientation = Quat(Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized()));
  egg.position = Vec3(50.0, 50.0, 102.0);
  egg.angularVelocity = Vec3(1.0, 2.0, 0.5);
  SimulationParameters p;
  p.endTime = 5.0;
  const Trajectory free = simulate(makePlane(21, 100.0, 0.0, 0.0, material(1.0, 0.0)), egg, p);
  const EnergyAudit& e = free.summary.energy;
  EXPECT_LT(std::abs(e.numerical), 1e-3 * e.released);
  EXPECT_LT(std::abs(e.restitution) + std::abs(e.damping), 0.01 * std::abs(e.released));

  p.endTime = 60.0;
  const Trajectory t = simulate(makePlane(21, 100.0, 0.0, 0.0, rolling(0.3, 35.0, 0.05)), egg, p);
  EXPECT_EQ(t.summary.fate, Fate::Rested);
  EXPECT_NEAR(t.summary.stop.z(), 100.35, 0.01);
}

/// Beside a ridge of 2 m that is 1 m wide a ball is on the inner side of the far flank; one that has
/// slipped under the slope is so, too, and has to be found.
TEST(RoundBodies, AreNotTouchedByTheFarFlankOfARidge)
{
  const Terrain ground = makeSlope(
    21, 0.5, [](double x, double) { return std::max(0.0, 2.0 - 4.0 * std::abs(x - 5.0)); },
    material(0.5, 35.0));
  const Block block(makeShape(Shape::Sphere, 0.004), 2500.0, 1e10, 0.1);
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(ground), 0.0, 10.0, 0.0, 10.0, patch);
  BlockState state;
  const auto contactsAt = [&](const Vec3& place)
  {
    state.position = place;
    return contactsOf(block, state, patch, 0.05);
  };
  for (const double height : { 0.2, 0.5, 1.0 })
  {
    const double flank = 5.0 - 0.25 * (2.0 - height); // x there
    const double aside = 1.02 * block.radius() / std::cos(std::atan(0.25));
    const std::vector<Contact> beside = contactsAt(Vec3(flank - aside, 5.2, height));
    ASSERT_FALSE(beside.empty());
    for (const Contact& c : beside)
    {
      EXPECT_LE(c.normal.x(), 1e-9) << height;
      EXPECT_GT(c.distance, 0.0) << height;
    }
  }
  const std::vector<Contact> under = contactsAt(Vec3(2.1, 5.2, -0.3));
  ASSERT_FALSE(under.empty());
  EXPECT_NEAR(under.front().distance, -0.3 - block.radius(), 1e-9);
}

/// What a step of h predicts of a gap with the normal and the point of its middle is off by h³: by h² with
/// those of its start.
TEST(RoundBodies, GapsAreToldToTheSecondOrderOfAStep)
{
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Terrain ground = makeSlope(
    9, 2.0, [&](double, double) { return u(random); }, material(0.5, 35.0));
  const Block block(makeEllipsoid(Vec3(1.6, 1.2, 1.0)), 2500.0, 1e10, 0.1);
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(ground), 0.0, 16.0, 0.0, 16.0, patch);
  const auto any = [&](double scale) // drawn in this order by every compiler
  {
    const double x = u(random), y = u(random), z = u(random);
    return Vec3(scale * x, scale * y, scale * z);
  };
  constexpr double h = 0.004; // s: few of them come to another edge meanwhile
  double coarse = 0.0, fine = 0.0, plain = 0.0;
  int seen = 0;
  for (int trial = 0; trial < 60; ++trial)
  {
    BlockState state;
    state.position = Vec3(8.0, 8.0, 3.0) + any(1.0);
    const Vec3 axis = any(1.0);
    state.orientation = Quat(Eigen::AngleAxisd(3.0 * u(random), axis.normalized()));
    state.velocity = any(4.0);
    const Vec3 turn = any(4.0); // world, rad/s
    state.spin = state.orientation.conjugate() * turn;
    Contact at;
    for (int k = 0; k < 30; ++k) // down until it touches
    {
      const std::vector<Contact> over = contactsOf(block, state, patch, 6.0);
      at = *std::min_element(over.begin(), over.end(),
        [](const Contact& x, const Contact& y) { return x.distance < y.distance; });
      state.position.z() -= at.distance;
    }
    // Along the ground, as far from it distances of an ellipsoid are not exact.
    const Vec3 closing = state.velocity + turn.cross(at.point - state.position);
    state.velocity -= at.normal.dot(closing) * at.normal;
    const auto miss = [&](double step, bool middle)
    {
      BlockState end = state;
      end.position += step * state.velocity;
      end.orientation =
        Quat(Eigen::AngleAxisd(step * turn.norm(), turn.normalized())) * state.orientation;
      std::vector<Contact> told = { at };
      PlacedBlock rock;
      rock.place(block, state);
      if (middle)
      {
        turnToMiddle(rock, state, patch, step, told);
      }
      const Vec3 speed = state.velocity + turn.cross(told[0].point - state.position);
      const double gap = at.distance + step * told[0].normal.dot(speed);
      double least = 1.0;
      for (const Contact& c : contactsOf(block, end, patch, 6.0))
      {
        least = c.surfaceFeature == at.surfaceFeature ? std::abs(c.distance - gap) : least;
      }
      return least;
    };
    const double whole = miss(h, true), half = miss(0.5 * h, true);
    if (at.distance < 1e-9 && whole < 0.1 && half < 0.1) // at the same place of the ground still
    {
      coarse += whole;
      fine += half;
      plain += miss(h, false);
      ++seen;
    }
  }
  EXPECT_GT(seen, 30);
  EXPECT_GT(coarse / fine, 7.0);
  EXPECT_GT(plain, 20.0 * coarse);
}

/// Cells finer than the body: an impact goes over several edges and nodes, and what its springs hold goes
/// over with it.
TEST(RoundBodies, KeepTheirBooksOnGroundFinerThanTheyAre)
{
  std::mt19937_64 random(3);
  std::normal_distribution<double> rough(0.0, 0.05); // m
  const auto benches = [&](double x, double)
  { return 60.0 - 0.3 * x - 8.0 * std::clamp(0.5 * (x - 20.0), 0.0, 1.0) + rough(random); };
  for (const bool elastic : { false, true })
  {
    const Terrain ground =
      makeSlope(161, 0.5, benches, elastic ? material(1.0, 0.0) : material(0.5, 35.0));
    for (const double volume : { 1.0, 20.0 })
    {
      const double size = std::cbrt(volume);
      for (const Polyhedron& shape :
        { makeShape(Shape::Sphere, volume), makeEllipsoid(size * Vec3(1.6, 1.2, 1.0)) })
      {
        SimulationParameters p;
        p.endTime = elastic ? 5.0 : 20.0;
        for (int k = 0; k < 10; ++k)
        {
          Rock rock;
          rock.shape = shape;
          rock.position = Vec3(15.0, 20.0 + 4.0 * k, 0.0);
          rock.position.z() = ground.elevation(15.0, rock.position.y()) + size;
          rock.velocity = Vec3(2.0, 0.0, 0.0);
          const EnergyAudit e = simulate(ground, rock, p).summary.energy;
          EXPECT_LT(std::abs(e.numerical), 0.01 * e.released)
            << elastic << ' ' << volume << ' ' << k;
          EXPECT_GT(e.restitution, -0.01 * e.released) << elastic << ' ' << volume << ' ' << k;
          if (elastic)
          {
            EXPECT_GT(e.kinetic, 0.99 * e.released) << volume << ' ' << k;
          }
        }
      }
    }
  }
}

TEST(RoundBodies, DoNotCollide)
{
  SimulationParameters p;
  p.rockRockContact = true;
  TrajectoryStore store(1, 1);
  EXPECT_THROW(runEnsemble(makePlane(3, 100.0, 0.0, 0.0, material(0.5, 30.0)),
                 std::vector<Rock>{ ballAt(Vec3(50, 50, 102)) }, p, store),
    ParameterError);
}
