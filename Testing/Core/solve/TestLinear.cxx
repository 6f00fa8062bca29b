// Small dense systems, beside Eigen's.

#include "base/types.h"
#include "solve/step/linear.h"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;

TEST(Linear, SolvesWhatIsNotSymmetric)
{
  std::mt19937 random(4);
  std::normal_distribution<double> u;
  for (int k = 0; k < 1000; ++k)
  {
    Mat6 a;
    Vec6 b;
    for (int i = 0; i < 6; ++i)
    {
      b[i] = u(random);
      for (int j = 0; j < 6; ++j)
      {
        // Every third one has a zero where the first pivot would be.
        a(i, j) = k % 3 == 0 && i == 0 && j == 0 ? 0.0 : u(random);
      }
    }
    const Mat6 expected = a.inverse();
    const double tolerance = 1e-13 * a.norm() * expected.norm() * expected.norm(); // conditioning
    const Vec6 x = expected * b;
    EXPECT_LT((solved<6>(a, b) - x).norm(), tolerance * b.norm() + tolerance) << k;
  }
}
