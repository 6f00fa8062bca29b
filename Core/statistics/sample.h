#pragma once

/// @file
/// Mean, deviation, maximum and quantiles of a sample.

#include <array>
#include <span>
#include <vector>

namespace rockfall
{

/// The quantiles that hazard maps and tables have: 50, 90, 95 and 99 %.
constexpr std::array<double, 4> hazardQuantiles = { 0.50, 0.90, 0.95, 0.99 };

/// Statistics of a sample. All NaN for an empty one.
struct SampleStatistics
{
  double mean = 0.0;
  double deviation = 0.0; ///< Standard deviation, of n − 1; 0 for a single value.
  double maximum = 0.0;
  std::array<double, hazardQuantiles.size()> quantiles{};
};

/// Value at (n − 1) q of the ascending values, counted from 0, linear in between: type 7 of Hyndman
/// & Fan (1996), Sample quantiles in statistical packages, The American Statistician 50(4),
/// 361–365; the one of NumPy. NaN for no values.
double quantile(std::span<const double> ascending, double q);

/// Sums in the order that is given, then sorts: the same order gives the same bits.
SampleStatistics statisticsOf(std::vector<double>& values);

/// Standard error √(p (1 − p) / n) of a share of n independent trials; NaN for none.
double binomialError(double share, double trials);

} // namespace rockfall
