#pragma once

/// @file
/// Mean, deviation, maximum and quantiles of a sample.

#include <array>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// The quantiles that hazard maps and tables have: 50, 90, 95 and 99 %.
constexpr std::array<double, 4> hazardQuantiles = { 0.50, 0.90, 0.95, 0.99 };

/// 1 − confidence of each limit: of shares, quantiles and frequencies.
constexpr double kDoubt = 0.05;

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

/// Standard error √(p (1 − p) / n) of a share of n independent trials; NaN for
/// none. A share of 0 or 1 has its limit instead (shareLimit): that it is
/// exactly so no number of trials can say.
double binomialError(double share, double trials);

/// 1 − 0.05^(1/n), about 3 / n: with 95 % confidence an event that never
/// happened in n independent trials is not more probable, and one that always
/// did not less than 1 minus this. The one-sided bound of Clopper & Pearson
/// (1934), The use of confidence or fiducial limits illustrated in the case of
/// the binomial, Biometrika 26(4), 404–413. NaN for no trials.
double shareLimit(double trials);

/// Least number of values whose largest is, with 95 % confidence, not below the
/// q quantile of what they are drawn of: n ≥ ln 0.05 / ln q, which is 5, 29, 59
/// and 299 for 50, 90, 95 and 99 %. With fewer, the sample does not reach as
/// far as the quantile. Wilks (1941), Determination of sample sizes for setting
/// tolerance limits, The Annals of Mathematical Statistics 12(1), 91–96.
int leastForQuantile(double q);

/// The highest of hazardQuantiles that so many values can give, %; 0 if none.
int highestQuantile(std::size_t values);

/// "50, 90, 95 and 99 % take 5, 29, 59 and 299": hazardQuantiles and what each needs.
std::string quantileNeeds();

/// Of a sample that has this one as its highest: "the 95 and 99 % quantiles, which take 59 and 299
/// rocks; 50 and 90 % are in reach".
std::string quantilesMissed(int highest);

} // namespace rockfall
