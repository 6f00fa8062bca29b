// An impact as an event in impulse space: energetic restitution, Coulomb's law, books.

#include "solve/step/impulse.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

using namespace rockfall;

namespace
{

constexpr double kMass = 2500.0;         // kg
constexpr double kInertia = kMass / 6.0; // of a cube of 1 m, kg m²
constexpr double kQuiet = 1e-3;          // m/s

ImpulseBody falling(const Vec3& velocity, const Vec3& angularVelocity = Vec3::Zero())
{
  return { 1.0 / kMass, Mat3::Identity() / kInertia, velocity, angularVelocity };
}

ImpulsePoint pointAt(const Vec3& lever, double restitution, double friction)
{
  ImpulsePoint point;
  point.normal = Vec3::UnitZ();
  point.lever = lever;
  point.restitution = restitution;
  point.friction = friction;
  point.stiffness = 1e9;
  return point;
}

std::vector<ImpulsePoint> corners(double restitution, double friction)
{
  std::vector<ImpulsePoint> points;
  for (const double x : { -0.5, 0.5 })
  {
    for (const double y : { -0.5, 0.5 })
    {
      points.push_back(pointAt({ x, y, -0.5 }, restitution, friction));
    }
  }
  return points;
}

double energy(const ImpulseBody& b)
{
  return 0.5 * kMass * b.velocity.squaredNorm() + 0.5 * kInertia * b.angularVelocity.squaredNorm();
}

Vec3 velocityAt(const ImpulseBody& b, const ImpulsePoint& p)
{
  return b.velocity + b.angularVelocity.cross(p.lever);
}

} // namespace

TEST(Impulse, ACubeThatFallsFlatKeepsWhatRestitutionSays)
{
  for (const double e : { 1.0, 0.8, 0.4, 0.0 })
  {
    ImpulseBody body = falling({ 0.0, 0.0, -5.0 });
    std::vector<ImpulsePoint> points = corners(e, 0.0);
    const double before = energy(body);
    resolveImpulse(body, points, kQuiet);
    EXPECT_NEAR(energy(body) / before, e * e, 1e-9) << e;
    EXPECT_NEAR(body.velocity.z(), 5.0 * e, 1e-9) << e;
    EXPECT_LT(body.angularVelocity.norm(), 1e-9) << e;
  }
}

TEST(Impulse, OnePointWithoutFrictionIsNewtons)
{
  for (const double e : { 1.0, 0.8, 0.4, 0.0 })
  {
    ImpulseBody body = falling({ 3.0, 1.0, -5.0 }, { 1.0, -2.0, 0.5 });
    std::vector<ImpulsePoint> points = { pointAt({ 0.5, 0.2, -0.6 }, e, 0.0) };
    const double before = velocityAt(body, points[0]).z();
    resolveImpulse(body, points, kQuiet);
    EXPECT_NEAR(velocityAt(body, points[0]).z(), -e * before, 1e-9) << e;
  }
}

TEST(Impulse, ABallTakesSpinUntilItRolls)
{
  // Slides all the time: ΔV = μ (1 + e) V. Sticks: ω r = V.
  for (const double friction : { 0.05, 0.8 })
  {
    ImpulseBody body{ 1.0 / kMass, Mat3::Identity() / (0.4 * kMass * 0.25), { 4.0, 0.0, -3.0 },
      Vec3::Zero() };
    std::vector<ImpulsePoint> points = { pointAt({ 0.0, 0.0, -0.5 }, 0.5, friction) };
    resolveImpulse(body, points, kQuiet);
    EXPECT_NEAR(body.velocity.z(), 1.5, 1e-9);
    const double slides = 4.0 - friction * 1.5 * 3.0, rolls = 5.0 / 7.0 * 4.0;
    EXPECT_NEAR(body.velocity.x(), std::max(slides, rolls), 1e-9) << friction;
  }
}

TEST(Impulse, GivesBackTheSquareOfRestitutionOfWhatItTookWhateverFrictionDoes)
{
  // Stronge's law, and what Newton's breaks: a slender rod that slips back gains nothing.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  double gain = 0.0, books = 0.0, left = 0.0;
  for (int k = 0; k < 5000; ++k)
  {
    ImpulseBody body = falling({ 10.0 * u(random), 10.0 * u(random), -6.0 + 2.0 * u(random) },
      { 5.0 * u(random), 5.0 * u(random), 5.0 * u(random) });
    std::vector<ImpulsePoint> points;
    for (int n = 0; n < 1 + k % 5; ++n)
    {
      points.push_back(pointAt({ 0.6 * u(random), 0.6 * u(random), -0.5 + 0.2 * u(random) },
        0.5 + 0.5 * u(random), 1.0 + u(random)));
      points.back().normal = Vec3(0.3 * u(random), 0.3 * u(random), 1.0).normalized();
      points.back().stiffness = 1e9 * (1.5 + u(random));
    }
    const double before = energy(body);
    resolveImpulse(body, points, kQuiet);
    double lost = 0.0;
    for (const ImpulsePoint& point : points)
    {
      lost += point.restitutionLoss + point.frictionLoss;
      EXPECT_GE(point.impulse, 0.0);
      EXPECT_GT(point.restitutionLoss, -1e-9 * before);
      EXPECT_GT(point.frictionLoss, -1e-2 * before);
      left = std::min(left, velocityAt(body, point).dot(point.normal));
    }
    gain = std::max(gain, energy(body) / before);
    books = std::max(books, std::abs(before - energy(body) - lost) / before);
  }
  EXPECT_LE(gain, 1.0 + 1e-12);
  EXPECT_LT(books, 1e-12);
  EXPECT_GE(left, -1.01 * kQuiet);
}
