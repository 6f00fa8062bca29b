// A block on an incline slides, topples, does both or neither, by b/h against tan α and φ against
// α; a block that slides topples if tan φ exceeds b/h.

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;

namespace
{

struct Outcome
{
  double slip = 0.0; ///< Of the lower front edge along the plane before it has turned by 5°, m.
  double turn = 0.0; ///< Largest angle turned, rad.
};

/// A block b long (along the slope), 1 m wide and h = 1 m high, laid on a plane of angle α (rad)
/// falling towards +x, with `speed` (m/s) downhill.
Outcome release(double breadth, double angle, double friction, double speed, double duration)
{
  constexpr double kExtent = 120.0, kHeight = 1.0;
  const Terrain plane =
    rockfall::testing::makePlane(2, kExtent, angle, 0.0, surface(0.5, degrees(friction)));
  const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
  const Vec3 downhill(std::cos(angle), 0.0, -std::sin(angle));
  Rock rock;
  rock.shape = makeBox({ breadth, 1.0, kHeight });
  rock.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  rock.position =
    Vec3(0.5 * kExtent, 0.5 * kExtent, 100.0) + 0.5 * kHeight * normal - 20.0 * downhill;
  rock.velocity = speed * downhill;
  SimulationParameters p;
  p.endTime = duration;
  p.outputInterval = 0.01;
  const Trajectory t = rockfall::testing::simulate(plane, rock, p);
  const Vec3 toe(0.5 * breadth, 0.0, -0.5 * kHeight);
  const auto toeAt = [&](const Sample& s) { return Vec3(s.position + s.orientation * toe); };
  Outcome outcome;
  for (const Sample& s : t.samples)
  {
    outcome.turn = std::max(outcome.turn, s.orientation.angularDistance(rock.orientation));
    if (outcome.turn < radians(5.0))
    {
      outcome.slip = std::abs(downhill.dot(toeAt(s) - toeAt(t.samples.front())));
    }
  }
  return outcome;
}

/// The angle (rad) at which `happens` turns from false (at low) to true (at high).
double boundary(double low, double high, const std::function<bool(double)>& happens)
{
  EXPECT_FALSE(happens(low)) << "at " << degrees(low) << "°";
  EXPECT_TRUE(happens(high)) << "at " << degrees(high) << "°";
  for (int k = 0; k < 8; ++k)
  {
    const double middle = 0.5 * (low + high);
    (happens(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// Friction angle (rad) that keeps the toe of a block which begins to topple where it is: at the
/// start, turning about the toe at ω̇ = m g (h sin α − b cos α) / 2I.
double frictionOfToppling(double breadth, double angle)
{
  const double rate = 0.5 * kGravity * (std::sin(angle) - breadth * std::cos(angle)) /
    ((breadth * breadth + 1.0) / 3.0);
  return std::atan2(
    kGravity * std::sin(angle) - 0.5 * rate, kGravity * std::cos(angle) + 0.5 * rate * breadth);
}

constexpr double kSlipped = 0.005;       // m: springs give 1e-5 m
constexpr double kTurned = radians(3.0); // springs give 1e-5
const char* const kSubject = "Slide or topple";

} // namespace

TEST(Toppling, StableOrSliding)
{
  for (double friction : { 15.0, 30.0 })
  {
    const double found = boundary(radians(friction - 8.0), radians(friction + 8.0),
      [&](double angle)
      { return release(2.0, angle, radians(friction), 0.0, 2.0).slip > kSlipped; });
    record({ kSubject, "b/h 2, φ " + text(friction) + "°: slope on which it begins to slide", "°",
             "α = φ; within 1° by bisection" },
      degrees(found), friction, 1.0);
  }
}

TEST(Toppling, StableOrToppling)
{
  for (double breadth : { 0.25, 0.5, 0.8 })
  {
    const double expected = std::atan(breadth);
    const double found = boundary(expected - radians(8.0), expected + radians(8.0),
      [&](double angle)
      { return release(breadth, angle, radians(60.0), 0.0, 3.0).turn > kTurned; });
    record({ kSubject, "φ 60°, b/h " + text(breadth) + ": slope on which it begins to topple", "°",
             "tan α = b/h" },
      degrees(found), degrees(expected), 1.0);
  }
}

TEST(Toppling, SlidingOrSlidingAndToppling)
{
  for (double breadth : { 0.3, 0.5 })
  {
    const double expected = std::atan(breadth);
    const double found = boundary(expected - radians(8.0), expected + radians(8.0),
      [&](double friction)
      { return release(breadth, radians(40.0), friction, 0.0, 2.5).turn > kTurned; });
    record({ kSubject,
             "α 40°, b/h " + text(breadth) + ": friction angle at which the sliding block topples",
             "°", "tan φ = b/h: friction's moment about the centroid against the weight's" },
      degrees(found), degrees(expected), 1.0);
  }
}

TEST(Toppling, TopplingOrTopplingAndSliding)
{
  for (double breadth : { 0.3, 0.5 })
  {
    const double angle = std::atan(breadth) + radians(12.0);
    const double expected = frictionOfToppling(breadth, angle);
    const double found = boundary(expected - radians(8.0), expected + radians(8.0),
      [&](double friction) { return release(breadth, angle, friction, 0.0, 2.0).slip < kSlipped; });
    record({ kSubject,
             "α " + text(degrees(angle)) + "°, b/h " + text(breadth) +
               ": friction angle from which on the toppling block does not slip",
             "°",
             "friction that turning about the toe takes, at its start; the toe counts as slipped "
             "beyond 5 mm before 5° of turning" },
      degrees(found), degrees(expected), 1.0);
  }
}

TEST(Toppling, SlidingBlockTripsOverItsFriction)
{
  for (double breadth : { 0.3, 0.5, 0.8 })
  {
    const double expected = std::atan(breadth);
    const double found = boundary(expected - radians(8.0), expected + radians(8.0),
      [&](double friction) { return release(breadth, 0.0, friction, 6.0, 2.0).turn > kTurned; });
    record({ kSubject,
             "thrown at 6 m/s over a floor, b/h " + text(breadth) +
               ": friction angle at which it begins to topple",
             "°", "tan φ = b/h" },
      degrees(found), degrees(expected), 1.0);
  }
}

TEST(Toppling, MapOfTheRegimes)
{
  // 0 stable, 1 slides, 2 topples, 3 both, at φ = 25°; places within 1.5° of a boundary are left
  // out of the comparison: the boundaries have tests of their own, above.
  const double friction = radians(25.0), margin = radians(1.5);
  const double angleStep = full() ? 3.0 : 6.0, breadthStep = full() ? 0.08 : 0.24;
  std::array<std::vector<double>, 4> angles, breadths;
  int compared = 0;
  for (double angle = 2.5; angle < 50.0; angle += angleStep)
  {
    for (double breadth = 0.1; breadth < 1.25; breadth += breadthStep)
    {
      const double alpha = radians(angle), stands = std::atan(breadth);
      const Outcome o = release(breadth, alpha, friction, 0.0, 2.5);
      const int regime = (o.slip > kSlipped ? 1 : 0) + (o.turn > kTurned ? 2 : 0);
      angles[regime].push_back(angle);
      breadths[regime].push_back(breadth);
      const double holds = frictionOfToppling(breadth, alpha);
      const bool topples = std::min(alpha, friction) > stands;
      const bool slips = topples ? friction < holds : alpha > friction;
      if (std::abs(std::min(alpha, friction) - stands) > margin &&
        std::abs(friction - (topples ? holds : alpha)) > margin)
      {
        EXPECT_EQ(regime, (slips ? 1 : 0) + (topples ? 2 : 0)) << angle << "°, b/h " << breadth;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 20);
  const char* names[] = { "stable", "slides", "topples", "slides and topples" };
  for (int k = 0; k < 4; ++k)
  {
    addCurve("topple-map", names[k], angles[k], breadths[k]);
  }
}
