// Restitution (METHOD 4): what Rv takes, and when.

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;

TEST(Restitution, FiveMetreDrop)
{
  for (double rv : { 0.6, 0.7, 0.8 })
  {
    Rock rock;
    rock.shape = makeShape(Shape::Cube, 1.0);
    rock.position = Vec3(10.0, 10.0, 5.5);
    rock.youngModulus = 1e11;
    SimulationParameters p;
    p.endTime = 30.0;
    p.outputInterval = 0.002;
    const Trajectory t =
      rockfall::testing::simulate(flatGround(20.0, surface(rv, 15.0), 5), rock, p);
    const std::string head = "Rv " + text(rv) + ", drop of 5 m: ";
    ASSERT_GE(t.impacts.size(), 5u);
    record({ "Restitution", head + "incident speed", "m/s",
             "√(2 g 5 m); the event begins up to one step of 0.2 ms before the touch" },
      -t.impacts[0].velocityBefore.z(), std::sqrt(2.0 * kGravity * 5.0), 0.003);
    double worst = 0.0, firstHeight = 0.0;
    for (int k = 0; k < 4; ++k)
    {
      const double v = t.impacts[k].velocityBefore.z(), next = t.impacts[k + 1].velocityBefore.z();
      worst = std::max(worst, std::abs(next * next / (v * v) / (rv * rv) - 1.0));
    }
    for (const Sample& s : t.samples)
    {
      if (s.time > t.impacts[0].time && s.time < t.impacts[1].time)
      {
        firstHeight = std::max(firstHeight, s.position.z() - 0.5);
      }
    }
    record({ "Restitution", head + "height of the first bounce over that of the drop", "",
             "Rv²; 1 % for the vibration left in the block" },
      firstHeight / 5.0, rv * rv, 0.01 * rv * rv);
    recordAtMost({ "Restitution", head + "ratio of heights over Rv², largest error of 4 bounces",
                   "", "the same at every impact" },
      worst, 0.01);
    // t₁ (1 + Rv) / (1 − Rv), t₁ the time of the first fall; rest is recognised after 0.5 s of it.
    const double series = std::sqrt(2.0 * 5.0 / kGravity) * (1.0 + rv) / (1.0 - rv);
    EXPECT_EQ(t.summary.fate, Fate::Rested);
    record(
      { "Restitution", head + "time until it rests", "s",
        "end of the geometric series; the hops below 0.1 m/s are not made, and after twenty "
        "bounces on four corners rounding makes the cube wobble, which shortens its last ones" },
      t.summary.endTime - 0.5, series, 0.6);
    record({ "Restitution", head + "height at rest", "m", "on the floor, 6e-6 m into the springs" },
      t.summary.stop.z(), 0.5, 2e-5);
    std::vector<double> times, heights;
    for (std::size_t k = 0; k < t.samples.size(); k += 5)
    {
      times.push_back(t.samples[k].time);
      heights.push_back(t.samples[k].position.z() - 0.5);
    }
    addCurve("restitution", "Rv " + text(rv), times, heights);
  }
}

TEST(Restitution, SlidingIsNotSlowedByIt)
{
  for (double rv : { 0.6, 0.8, 1.0 })
  {
    Rock rock;
    rock.shape = makeShape(Shape::Cube, 1.0);
    rock.position = Vec3(10.0, 10.0, 0.5);
    rock.velocity = Vec3(3.0, 0.0, 0.0);
    SimulationParameters p;
    p.endTime = 10.0;
    const Trajectory t =
      rockfall::testing::simulate(flatGround(20.0, surface(rv, 15.0), 5), rock, p);
    const double expected = 9.0 / (2.0 * kGravity * std::tan(radians(15.0)));
    record({ "Restitution",
             "cube pushed at 3 m/s over a floor, φ 15°, Rv " + text(rv) + ": way until it rests",
             "m", "v²/2μg: sliding is no impact (METHOD 4)" },
      t.summary.runOut, expected, 0.005 * expected);
    record({ "Restitution", "the same: impacts", "", "none" }, t.summary.impacts, 0.0, 0.0);
  }
}

TEST(Restitution, RollingIsNotSlowedByIt)
{
  // A ball of 1280 faces for 0.5 s down 30°, below the speed at which it hops from vertex to
  // vertex.
  std::vector<double> ways;
  for (double rv : { 1.0, 0.8, 0.6 })
  {
    Rock rock;
    rock.shape = makeBall(3, 0.62);
    const double angle = radians(30.0);
    const Terrain plane = rockfall::testing::makePlane(2, 100.0, angle, 0.0, surface(rv, 45.0));
    rock.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
    rock.position = Vec3(50.0, 50.0, 100.0) + 0.62 * Vec3(std::sin(angle), 0.0, std::cos(angle));
    SimulationParameters p;
    p.endTime = 0.5;
    const Trajectory t = rockfall::testing::simulate(plane, rock, p);
    ways.push_back((t.summary.stop - t.summary.start).norm());
    record(
      { "Restitution",
        "ball of 1280 faces rolls 0.5 s down 30°, Rv " + text(rv) + ": way over that with Rv 1", "",
        "rolling is no impact (METHOD 4); 2 % as for rolling itself" },
      ways.back() / ways.front(), 1.0, 0.02);
  }
}
