#pragma once

/// @file
/// How far a sample of simulated values is from one that was observed.

#include <array>
#include <span>
#include <vector>

namespace rockfall::calibration
{

/// The continuous ranked probability score of a sample of at least two, in its unit:
/// mean |x − y| − ½ mean |x − x'| over all pairs of different x (Gneiting & Raftery 2007).
double crps(std::vector<double> sample, double observed);

/// The same in the plane, of places (x, y).
double energyScore(
  std::span<const std::array<double, 2>> sample, const std::array<double, 2>& observed);

/// Share of a sample that is below the observed value, 0 … 1; what is equal counts half.
double rankOf(std::span<const double> sample, double observed);

double mean(std::span<const double> sample);
double median(std::vector<double> sample);

} // namespace rockfall::calibration
