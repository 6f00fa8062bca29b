// Damping ratios are the roots that halving finds, to the last bit.

#include "law/springs.h"

#include <gtest/gtest.h>

namespace rockfall
{

namespace
{

double byHalving(double restitution)
{
  const double wanted = -std::log(std::max(restitution, kLeastRestitution));
  double low = 0.0, high = 8.0;
  for (int k = 0; k < 50; ++k)
  {
    const double z = 0.5 * (low + high);
    const double exponent = std::abs(z - 1.0) < 1e-6 ? 2.0
      : z < 1.0 ? 2.0 * z * std::acos(z) / std::sqrt(1.0 - z * z)
                : 2.0 * z * std::acosh(z) / std::sqrt(z * z - 1.0);
    (exponent < wanted ? low : high) = z;
  }
  return 0.5 * (low + high);
}

} // namespace

TEST(DampingRatio, IsThatOfHalving)
{
  EXPECT_EQ(dampingRatio(1.0), 0.0);
  constexpr int several = 100003; // none of the coefficients is a round number
  for (int k = 0; k < several; ++k)
  {
    const double restitution = double(k) / several;
    ASSERT_EQ(dampingRatio(restitution), byHalving(restitution)) << restitution;
  }
  const double critical = std::exp(-2.0);
  for (int k = -1000; k <= 1000; ++k)
  {
    const double restitution = critical * (1.0 + 1e-4 * k);
    ASSERT_EQ(dampingRatio(restitution), byHalving(restitution)) << restitution;
  }
}

} // namespace rockfall
