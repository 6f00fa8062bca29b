// Lengths of flights against the closed form.

#include "block/flight.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;

namespace
{

constexpr double kGravity = 9.81; // m/s²

/// Length of the parabola on which the upward speed goes from `up` to `down` at a horizontal speed,
/// m/s: ∫ √(c² + u²) du / g.
double closedForm(double c, double up, double down)
{
  const auto integral = [c](double u)
  { return 0.5 * (u * std::hypot(u, c) + (c > 0.0 ? c * c * std::asinh(u / c) : 0.0)); };
  return (integral(up) - integral(down)) / kGravity;
}

} // namespace

TEST(Flight, LengthIsThatOfTheParabola)
{
  constexpr double rule = 1e-3; // of four points on each side of the top; 7.2e-4 at worst
  double worst = 0.0;
  for (const double up : { -2.0, 0.0, 0.3, 1.0, 4.0, 10.0, 30.0 })
  {
    for (const double duration : { 1e-4, 0.01, 0.3, 1.0, 2.7, 8.0 })
    {
      const double down = up - kGravity * duration;
      for (double c = 1e-3; c < 200.0; c *= 1.1)
      {
        const double length =
          flightLength(duration, Vec3(0.6 * c, -0.8 * c, up), Vec3(0.6 * c, -0.8 * c, down));
        const double error = std::abs(length / closedForm(c, up, down) - 1.0);
        worst = std::max(worst, error);
        EXPECT_LT(error, rule) << c << " " << up << " " << duration;
      }
      // Straight up and down again: exact but for rounding.
      EXPECT_NEAR(flightLength(duration, Vec3(0.0, 0.0, up), Vec3(0.0, 0.0, down)),
        closedForm(0.0, up, down), 1e-11 * (1.0 + std::abs(up)));
    }
  }
  EXPECT_GT(worst, 1e-4); // steep throws are among them
}

TEST(Flight, LengthsOfPiecesAddUp)
{
  // A usual throw, cut as samples cut it.
  const Vec3 from(8.0, -3.0, 5.0), to = from - Vec3(0.0, 0.0, kGravity * 1.5);
  double sum = 0.0;
  for (int k = 0; k < 30; ++k)
  {
    sum += flightLength(0.05, from + k / 30.0 * (to - from), from + (k + 1) / 30.0 * (to - from));
  }
  EXPECT_NEAR(sum, closedForm(std::hypot(8.0, 3.0), from.z(), to.z()), 1e-12 * sum);
  EXPECT_NEAR(flightLength(1.5, from, to), sum, 1e-5 * sum);
}

TEST(Flight, LengthWithoutGravityIsStraight)
{
  EXPECT_DOUBLE_EQ(flightLength(2.0, Vec3(3.0, 4.0, 0.0), Vec3(3.0, 4.0, 0.0)), 10.0);
  EXPECT_EQ(flightLength(0.0, Vec3::Zero(), Vec3::Zero()), 0.0);
}
