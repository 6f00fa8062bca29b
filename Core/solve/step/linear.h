#pragma once

/// @file
/// Small dense systems of a size known to the compiler.

#include <Eigen/Core>

#include <cmath>
#include <utility>

namespace rockfall
{

/// Solves K x = b by elimination with row pivots. For N = 6 several times faster than a general LU,
/// and it does not matter that friction makes K unsymmetric. A singular K gives numbers that are not
/// finite.
template <int N>
Eigen::Matrix<double, N, 1> solved(
  const Eigen::Matrix<double, N, N>& k, const Eigen::Matrix<double, N, 1>& b)
{
  double a[N][N + 1];
  for (int i = 0; i < N; ++i)
  {
    for (int j = 0; j < N; ++j)
    {
      a[i][j] = k(i, j);
    }
    a[i][N] = b[i];
  }
  for (int c = 0; c < N; ++c)
  {
    int pivot = c;
    for (int i = c + 1; i < N; ++i)
    {
      pivot = std::abs(a[i][c]) > std::abs(a[pivot][c]) ? i : pivot;
    }
    if (pivot != c)
    {
      for (int j = c; j <= N; ++j)
      {
        std::swap(a[c][j], a[pivot][j]);
      }
    }
    const double inverse = 1.0 / a[c][c];
    for (int i = c + 1; i < N; ++i)
    {
      const double factor = a[i][c] * inverse;
      for (int j = c + 1; j <= N; ++j)
      {
        a[i][j] -= factor * a[c][j];
      }
    }
  }
  Eigen::Matrix<double, N, 1> x;
  for (int i = N - 1; i >= 0; --i)
  {
    double sum = a[i][N];
    for (int j = i + 1; j < N; ++j)
    {
      sum -= a[i][j] * x[j];
    }
    x[i] = sum / a[i][i];
  }
  return x;
}

} // namespace rockfall
