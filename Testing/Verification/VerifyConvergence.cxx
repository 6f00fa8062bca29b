// Halving Δt and doubling the penalty: the answer settles, and how fast it does is reported.

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;
using rockfall::testing::makePlane;

namespace
{

constexpr double kSize = 100.0; // m

/// One answer of one run, and what it should be.
struct Problem
{
  const char* name;
  const char* quantity;
  const char* unit;
  double expected;
  double bar; ///< Largest relative error at the finest Δt and at the stiffest contact.
  const char* reason;
  std::function<double(double timeStep, double penalty)> answer;
};

SimulationParameters parameters(double timeStep, double penalty, double endTime)
{
  SimulationParameters p;
  p.timeStep = timeStep;
  p.normalPenalty = penalty;
  p.endTime = endTime;
  p.outputInterval = 0.01;
  return p;
}

/// Thrown up a slope that it sticks on: the way it gets.
double slideUntilItSticks(double timeStep, double penalty)
{
  const double angle = radians(20.0);
  Rock rock = rockfall::testing::cubeOnPlane(kSize, angle, 0.0, 0.0);
  rock.velocity = -5.0 * Vec3(std::cos(angle), 0.0, -std::sin(angle));
  const Trajectory t = rockfall::testing::simulate(
    makePlane(2, kSize, angle, 0.0, surface(0.8, 30.0)), rock, parameters(timeStep, penalty, 4.0));
  return (t.summary.stop - t.summary.start).norm();
}

double slidingWay()
{
  const double angle = radians(20.0);
  return 25.0 / (2.0 * kGravity * (std::sin(angle) + std::cos(angle) * std::tan(radians(30.0))));
}

/// Tilt of a rocking block (half-sizes 0.25 × 1 m, from α/2) at 0.4 s, before the first impact,
/// rad.
double rockingTilt(double timeStep, double penalty)
{
  Rock rock;
  rock.shape = makeBox({ 0.5, 1.0, 2.0 });
  rock.orientation = Quat(Eigen::AngleAxisd(0.5 * std::atan(0.25), Vec3::UnitY()));
  rock.position = Vec3(50.0, 50.0, 0.0) - rock.orientation * Vec3(0.25, 0.0, -1.0);
  const Trajectory t = rockfall::testing::simulate(
    flatGround(kSize, surface(0.8, 60.0)), rock, parameters(timeStep, penalty, 0.4));
  const Vec3 up = t.samples.back().orientation * Vec3::UnitZ();
  return std::atan2(up.x(), up.z());
}

/// The same by a fine integration of θ̈ = −p² sin(α − θ).
double rockingTiltExact()
{
  const double alpha = std::atan(0.25);
  const double square = 3.0 * kGravity / (4.0 * std::hypot(0.25, 1.0));
  double theta = 0.5 * alpha, rate = 0.0;
  constexpr int kSteps = 400000;
  const double h = 0.4 / kSteps;
  for (int k = 0; k < kSteps; ++k)
  {
    rate -= 0.5 * h * square * std::sin(alpha - theta);
    theta += h * rate;
    rate -= 0.5 * h * square * std::sin(alpha - theta);
  }
  return theta;
}

/// Way of a ball of 5120 faces down 30° in 0.4 s, m.
double rollingWay(double timeStep, double penalty)
{
  const double angle = radians(30.0);
  Rock rock;
  static const Polyhedron ball = makeBall(4, 0.62);
  rock.shape = ball;
  rock.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  rock.position =
    Vec3(0.5 * kSize, 0.5 * kSize, 100.0) + 0.62 * Vec3(std::sin(angle), 0.0, std::cos(angle));
  const Trajectory t = rockfall::testing::simulate(
    makePlane(2, kSize, angle, 0.0, surface(0.8, 45.0)), rock, parameters(timeStep, penalty, 0.4));
  return (t.summary.stop - t.summary.start).norm();
}

/// Rebound over incident speed of a cube that falls 2 m face down.
double rebound(double timeStep, double penalty)
{
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(50.0, 50.0, 2.5);
  rock.youngModulus = 1e11;
  const Trajectory t = rockfall::testing::simulate(
    flatGround(kSize, surface(1.0, 15.0)), rock, parameters(timeStep, penalty, 1.0));
  const Sample* s = lastInFlight(t);
  return s ? std::sqrt((s->velocity.squaredNorm() + 2.0 * kGravity * (s->position.z() - 0.5)) /
               (4.0 * kGravity))
           : 0.0;
}

std::vector<Problem> problems()
{
  return {
    { "sliding until it sticks", "way up 20°, φ 30°, from 5 m/s", "m", slidingWay(), 1e-3,
      "v²/2g(sin α + cos α tan φ)", slideUntilItSticks },
    { "rocking", "tilt at 0.4 s", "rad", rockingTiltExact(), 5e-3, "θ̈ = −p² sin(α − θ)",
      rockingTilt },
    { "rolling", "way of 5120 faces in 0.4 s down 30°", "m",
      0.5 * 5.0 / 7.0 * kGravity * 0.5 * 0.16, 3e-2,
      "5/14 g sin α t² of a sphere; 3 %, as it starts on a vertex", rollingWay },
    { "rebound", "ratio of speeds, E 1e11 Pa", "", 1.0, 1e-2, "1", rebound },
  };
}

} // namespace

TEST(Convergence, InTimeStepAndPenalty)
{
  for (const Problem& problem : problems())
  {
    const std::string head = std::string(problem.name) + ", " + problem.quantity + ": ";
    const auto study = [&](const std::string& what, const std::vector<double>& values, auto answer)
    {
      std::vector<double> errors;
      for (double value : values)
      {
        errors.push_back(std::abs(answer(value) / problem.expected - 1.0));
        report({ "Convergence", head + "relative error at " + what + " " + text(value), "",
                 problem.reason },
          errors.back());
      }
      addCurve("convergence-" + what, problem.name, values, errors);
      recordAtMost({ "Convergence", head + "relative error at " + what + " " + text(values.back()),
                     "", problem.reason },
        errors.back(), problem.bar);
      // Where all errors are at the same small level, there is nothing left to converge.
      recordAtMost({ "Convergence", head + "error at the last " + what + " over that at the first",
                     "", "it does not grow, or is below a tenth of its bar" },
        errors.back() <= 0.1 * problem.bar ? 0.0 : errors.back() / errors.front(), 1.01);
      report({ "Convergence", head + "observed order in " + what, "",
               "least squares; meaningless where the errors are at one level" },
        observedOrder(values, errors));
    };
    study("Δt", { 0.02, 0.01, 0.005, 0.0025, 0.00125 },
      [&](double timeStep) { return problem.answer(timeStep, 1e9); });
    study("penalty", { 1e7, 1e8, 1e9, 1e10, 1e11 },
      [&](double penalty) { return problem.answer(0.005, penalty); });
  }
}
