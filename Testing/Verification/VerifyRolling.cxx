// A ball rolls; its oblique impacts stick or slide. Meshes of 320 to 5120 faces are each taken as the
// sphere that they stand for (geometry/roundBody.h): results must not hang on the number of faces.

#include "verification.h"

#include "block/Block.h"
#include "rock/parts/rollingResistance.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;
using rockfall::testing::makePlane;

namespace
{

constexpr double kRadius = 0.62;       // m: 1 m³
constexpr double kInclineSize = 100.0; // m

struct Ball
{
  Rock rock;
  double ratio;  ///< I / m r², 2/5 for a sphere.
  double radius; ///< m
};

Ball makeRollingBall(int subdivisions)
{
  Ball ball;
  ball.rock.shape = makeBall(subdivisions, kRadius);
  const Block block(ball.rock.shape, ball.rock.density, 1e10, 0.1);
  ball.radius = kRadius;
  ball.ratio = block.inertia().trace() / 3.0 / (block.mass() * ball.radius * ball.radius);
  return ball;
}

/// Lays the ball on a plane that falls towards +x from z = 100 m in the middle, on the middle of the
/// lowest face of its mesh, which is no face of the sphere.
void layOn(Rock& rock, double angle)
{
  const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
  int lowest = 0;
  for (std::size_t f = 0; f < rock.shape.normals().size(); ++f)
  {
    lowest =
      rock.shape.normals()[f].z() < rock.shape.normals()[std::size_t(lowest)].z() ? int(f) : lowest;
  }
  rock.orientation =
    rockfall::testing::turnBetween(rock.shape.normals()[std::size_t(lowest)], -normal);
  rock.position = Vec3(0.5 * kInclineSize, 0.5 * kInclineSize, 100.0) + kRadius * normal;
}

/// Means over a piece of a run down an incline, energy by energy, so that neither the start from a
/// face nor the ripple of the height over the faces counts.
struct Gait
{
  double translation =
    0.0;                ///< Share of the height's energy that is in translation: 5/7 of a sphere.
  double turning = 0.0; ///< ω r / v: 1 without slip.
};

Gait gaitOf(const Trajectory& t, double radius, double from, double to)
{
  Gait mean;
  int samples = 0;
  for (const Sample& s : t.samples)
  {
    if (s.time > from - 1e-9 && s.time < to + 1e-9)
    {
      const double fallen = t.samples.front().position.z() - s.position.z();
      mean.translation += 0.5 * s.velocity.squaredNorm() / (kGravity * fallen);
      mean.turning += s.angularVelocity.y() * radius / s.velocity.norm();
      ++samples;
    }
  }
  mean.translation /= samples;
  mean.turning /= samples;
  return mean;
}

} // namespace

TEST(Rolling, DownAnIncline)
{
  const double angle = radians(30.0);
  const double sphere = 5.0 / 7.0 * kGravity * std::sin(angle);
  for (int subdivisions : { 2, 3, 4 })
  {
    for (double rv : { 1.0, 0.8, 0.5 })
    {
      Ball ball = makeRollingBall(subdivisions);
      layOn(ball.rock, angle);
      SimulationParameters p;
      p.endTime = 0.6; // to 2.1 m/s
      p.outputInterval = 0.01;
      const Terrain plane = makePlane(2, kInclineSize, angle, 0.0, surface(rv, 45.0));
      const Trajectory t = rockfall::testing::simulate(plane, ball.rock, p);
      const Gait gait = gaitOf(t, ball.radius, 0.25, 0.4);
      const std::string faces = std::to_string(ball.rock.shape.faces().size()) + " faces";
      const std::string head =
        faces + ", 30°, φ 45°, Rv " + text(rv) + ", 0.25 to 0.4 s from rest: ";
      const double acceleration = gait.translation * kGravity * std::sin(angle);
      // It starts a face's depth in the ground, the deeper the fewer faces there are.
      if (subdivisions == 4 || (subdivisions == 3 && rv < 1.0))
      {
        record(
          { "Rolling", head + "acceleration (½ v²/Δz sin α)", "m/s²", "5/7 g sin α of a sphere" },
          acceleration, sphere, 0.02 * sphere);
      }
      else
      {
        report({ "Rolling", head + "acceleration (½ v²/Δz sin α)", "m/s²",
                 "no bar: what presses it out of the ground at the start counts" },
          acceleration, sphere);
      }
      if (subdivisions == 4)
      {
        record(
          { "Rolling", head + "ω r over v", "", "it rolls: no slip" }, gait.turning, 1.0, 0.02);
      }
      else
      {
        report({ "Rolling", head + "ω r over v", "", "" }, gait.turning, 1.0);
      }
      if (rv == 0.8)
      {
        std::vector<double> times, speeds, exact;
        for (const Sample& s : t.samples)
        {
          times.push_back(s.time);
          speeds.push_back(s.velocity.norm());
          exact.push_back(sphere * s.time);
        }
        addCurve("rolling", faces, times, speeds);
        if (subdivisions == 4)
        {
          addCurve("rolling", "5/7 g sin α t", times, exact);
        }
      }
    }
  }
}

TEST(Rolling, FasterThanItCanHoldTheGround)
{
  // A polyhedron would hop from vertex to vertex beyond √(g r). It stays slower than what slides
  // without friction, and no energy comes from nowhere.
  const double angle = radians(30.0);
  for (double rv : { 1.0, 0.8 })
  {
    Ball ball = makeRollingBall(3);
    layOn(ball.rock, angle);
    ball.rock.position -= 40.0 * Vec3(std::cos(angle), 0.0, -std::sin(angle));
    SimulationParameters p;
    p.endTime = 4.0;
    p.outputInterval = 0.02;
    const Trajectory t = rockfall::testing::simulate(
      makePlane(2, kInclineSize, angle, 0.0, surface(rv, 45.0)), ball.rock, p);
    const EnergyAudit& e = t.summary.energy;
    EXPECT_LT(t.samples.back().velocity.norm(), kGravity * std::sin(angle) * 4.0);
    EXPECT_GT(e.kinetic, 0.0);
    EXPECT_LT(std::abs(e.numerical), 1e-3 * e.released);
    report({ "Rolling",
             "1280 faces, 30°, φ 45°, Rv " + text(rv) + ": speed after 4 s over that of a sphere",
             "", "a sphere loses nothing" },
      t.samples.back().velocity.norm() / (5.0 / 7.0 * kGravity * std::sin(angle) * 4.0), 1.0);
  }
}

TEST(Rolling, SlipTurnsIntoRollingOnTheFlat)
{
  // Pushed off at v₀ without spin: friction takes v and makes ω until v = 5/7 v₀ at t = 2 v₀ / 7 μ
  // g.
  constexpr double kStart = 2.0, kFriction = 20.0;
  std::vector<double> faces, errors;
  for (int subdivisions = 2; subdivisions <= count(4, 5); ++subdivisions)
  {
    Ball ball = makeRollingBall(subdivisions);
    layOn(ball.rock, 0.0);
    ball.rock.velocity = Vec3(kStart, 0.0, 0.0);
    SimulationParameters p;
    p.endTime = 0.6;
    p.outputInterval = 0.005;
    const Trajectory t = rockfall::testing::simulate(
      makePlane(2, kInclineSize, 0.0, 0.0, surface(0.8, kFriction)), ball.rock, p);
    const double until = 2.0 * kStart / (7.0 * std::tan(radians(kFriction)) * kGravity);
    double sum = 0.0, turning = 0.0;
    int samples = 0;
    std::vector<double> times, speeds, rims;
    for (const Sample& s : t.samples)
    {
      times.push_back(s.time);
      speeds.push_back(s.velocity.x());
      rims.push_back(s.angularVelocity.y() * ball.radius);
      if (s.time >= 1.1 * until && s.time <= 2.0 * until)
      {
        sum += s.velocity.x();
        turning += s.angularVelocity.y() * ball.radius;
        ++samples;
      }
    }
    const std::string number = std::to_string(ball.rock.shape.faces().size());
    const std::string head = number +
      " faces on the flat, v₀ 2 m/s, φ 20°, Rv 0.8, mean from 1.1 to 2 times the end of slip: ";
    faces.push_back(double(ball.rock.shape.faces().size()));
    errors.push_back(std::abs(sum / samples / kStart / (5.0 / 7.0) - 1.0));
    if (subdivisions == 4)
    {
      addCurve("slip-to-roll", "v, " + number + " faces", times, speeds);
      addCurve("slip-to-roll", "ω r, " + number + " faces", times, rims);
    }
    if (subdivisions >= 4)
    {
      record({ "Rolling", head + "speed over v₀", "", "5/7 of a sphere" }, sum / samples / kStart,
        5.0 / 7.0, 0.02 * 5.0 / 7.0);
      record({ "Rolling", head + "ω r over v", "", "it rolls" }, turning / sum, 1.0, 0.02);
    }
    else
    {
      report(
        { "Rolling", head + "speed over v₀", "", "no bar: it starts a face's depth in the ground" },
        sum / samples / kStart, 5.0 / 7.0);
    }
  }
  addCurve("ball", "slip to roll, error of v", faces, errors);
}

TEST(Rolling, ObliqueImpactSticksOrSlides)
{
  // With
  // NormalTangential v_n' = e v_n; sliding v_t' = v_t − μ (1+e) v_n; sticking from
  // v_t/v_n = 3.5 μ (1+e) down: v_t' = 5/7 v_t and the contact at rest.
  constexpr double kFriction = 20.0, kNormal = 2.0;
  const double mu = std::tan(radians(kFriction));
  for (double e : { 1.0, 0.8, 0.5 })
  {
    const double limit = 3.5 * mu * (1.0 + e);
    std::vector<Rock> rocks;
    std::vector<double> shares;
    Ball ball = makeRollingBall(3);
    // The mass and the moment of the body itself, about the vertex it lands on.
    const Block block(ball.rock.shape, ball.rock.density, 1e10, 0.1);
    const double kappa = block.inertia().trace() / 3.0 / (block.mass() * kRadius * kRadius);
    const double keep = 1.0 / (1.0 + kappa);
    for (double share = 0.1; share < 2.05; share += 0.1)
    {
      Rock rock = ball.rock;
      const double fall = 0.001;
      rock.position = Vec3(0.5 * kInclineSize, 0.5 * kInclineSize, 100.0 + kRadius + fall);
      rock.velocity =
        Vec3(share * limit * kNormal, 0.0, -std::sqrt(kNormal * kNormal - 2.0 * kGravity * fall));
      rocks.push_back(rock);
      shares.push_back(share);
    }
    SimulationParameters p;
    p.endTime = 0.04;
    p.outputInterval = 0.0005;
    p.normalPenalty = 1e10; // 1 mm pressed in
    const std::vector<Trajectory> runs =
      simulateAll(makePlane(2, kInclineSize, 0.0, 0.0,
                    surface(e, kFriction, RestitutionModel::NormalTangential)),
        rocks, p);
    double slidingError = 0.0, stickingError = 0.0, rest = 0.0, normalError = 0.0;
    std::vector<double> ratios, kept, exact;
    for (std::size_t k = 0; k < runs.size(); ++k)
    {
      bool touched = false;
      const Sample* after = nullptr;
      for (const Sample& s : runs[k].samples)
      {
        touched = touched || s.contact || s.velocity.z() > 0.0;
        if (touched && !s.contact && s.velocity.z() > 0.0)
        {
          after = &s;
          break;
        }
      }
      const double tangential = rocks[k].velocity.x();
      const bool sticks = shares[k] < 1.0;
      const double expected = sticks ? keep * tangential : tangential - mu * (1.0 + e) * kNormal;
      ratios.push_back(tangential / kNormal);
      exact.push_back(expected / tangential);
      kept.push_back(after ? after->velocity.x() / tangential : std::nan(""));
      ASSERT_NE(after, nullptr) << "no rebound, e " << e << ", share " << shares[k];
      const double error = std::abs(after->velocity.x() - expected) / tangential;
      normalError = std::max(normalError, std::abs(after->velocity.z() / (e * kNormal) - 1.0));
      if (std::abs(shares[k] - 1.0) < 0.01)
      {
        continue; // on the limit itself both forms are the same
      }
      if (sticks)
      {
        stickingError = std::max(stickingError, error);
        const double slip = after->velocity.x() - after->angularVelocity.y() * kRadius;
        rest = std::max(rest, std::abs(slip) / tangential);
      }
      else
      {
        slidingError = std::max(slidingError, error);
      }
    }
    addCurve("oblique", "e " + text(e) + ", this code", ratios, kept);
    addCurve("oblique", "e " + text(e) + ", closed form", ratios, exact);
    const std::string subject = "Oblique impact of a ball";
    const std::string head = "e " + text(e) + ", μ " + text(mu) + ", v_n 2 m/s: ";
    record({ subject, head + "v_n'/e v_n, largest error", "", "normal restitution as given" },
      normalError, 0.0, 0.02);
    recordAtMost(
      { subject,
        head + "sliding (v_t/v_n > " + text(limit) + "): largest error of v_t', share of v_t", "",
        "v_t' = v_t − μ (1+e) v_n" },
      slidingError, 0.02);
    recordAtMost(
      { subject,
        head + "sticking (v_t/v_n < " + text(limit) + "): largest error of v_t', share of v_t", "",
        "v_t' = v_t/(1 + I/mr²), 5/7 v_t of a sphere" },
      stickingError, 0.02);
    recordAtMost({ subject, head + "sticking: velocity of the contact afterwards, share of v_t", "",
                   "zero: it sticks; 3.5 times the error of v_t', of which 1 % is allowed" },
      rest, 0.035);
  }
}

// Azzoni, La Barbera & Zaninetti (1995): v² = v₀² + 2 A g cosθ (tanθ − μ_r) d, A = 1/(1 + k²/R²).
// On hard ground, so slow that setting down faces takes next to nothing.
TEST(Rolling, StopsAtAzzonisDistance)
{
  // Slower, the millimetres until the ball that barely touches is found to do so would count.
  const double speed = 3.0, resistance = 0.4;
  for (const double degrees : { 0.0, 8.0, 15.0 })
  {
    const double angle = radians(degrees);
    Ball ball = makeRollingBall(4);
    layOn(ball.rock, angle);
    const Vec3 down(std::cos(angle), 0.0, -std::sin(angle));
    ball.rock.velocity = speed * down;
    ball.rock.angularVelocity = Vec3(0.0, speed / ball.radius, 0.0);
    SurfaceMaterial ground = surface(0.8, 60.0);
    ground.yielding.rollingResistance = resistance;
    SimulationParameters p;
    p.endTime = 10.0;
    const Trajectory t =
      rockfall::testing::simulate(makePlane(2, kInclineSize, angle, 0.0, ground), ball.rock, p);
    const Block block(ball.rock.shape, ball.rock.density, 1e10, 0.1);
    const double arm = rollingArm(block) / ball.radius;
    const double exact = speed * speed * (1.0 + ball.ratio) /
      (2.0 * kGravity * std::cos(angle) * (resistance * arm - std::tan(angle)));
    record({ "Rolling", "5120 faces, " + text(degrees) + "°, μ_r 0.4, from 3 m/s: distance to rest",
             "m", "Azzoni et al. (1995)" },
      (t.summary.stop - t.summary.start).dot(down), exact, 0.02 * exact);
    EXPECT_EQ(t.summary.fate, Fate::Rested);
  }
}
