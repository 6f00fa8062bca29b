#pragma once

/// @file
/// Annual frequencies: of volume classes, of rocks that pass a cell with an energy, and the
/// intensity classes of scenarios.
///
/// Terms of Hantz et al. (2021), Geosciences 11(4), 158. Intensity by return period as in FOEN
/// (2016), Protection against mass movement hazards: a cell's class in the scenario T is the one
/// that is reached or exceeded at least once in T years on average.

#include "statistics/passages.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace rockfall
{

/// Annual frequency A (V₁^−B − V₂^−B) of the volumes V₁ ≤ V < V₂ (m³), where A V^−B (1/a) is that
/// of V and more. V₂ may be infinite. Throws ParameterError unless A ≥ 0, B > 0 and 0 < V₁ ≤ V₂.
double powerLawFrequency(double a, double b, double v1, double v2);

/// Probability 1 − exp(−f t) of at least one event in `years` t of a Poisson process of f a year.
double probabilityWithin(double frequency, double years);

/// How many of the `frequencies` (1/a) of reach and of ascending thresholds are at least 1 / period
/// (a): 0 none, 1 reach alone, and one more per threshold. A part in 10⁹ is rounding, so that ten
/// rocks of 0.001 a year make a hundred years.
int intensityClass(std::span<const double> frequencies, double period);

/// The note where rocks have frequencies of their own, but AnnualFrequency (1/a) goes before them.
std::string ownNotUsed(double annualFrequency);

/// Frequencies (1/a) of rocks of one sample: of a line, of a cell.
class FrequencyRange
{
public:
  void add(double frequency); ///< NaN is not known, and not in it.
  void add(const FrequencyRange& other);
  bool differs() const; ///< By more than rounding.
  /// The note where they differ, as quantiles of the sample count each rock alike; none else.
  std::vector<std::string> notes() const;
  /// The same of all rocks released, of which the shares at lines are.
  std::vector<std::string> notesOnShares() const;

private:
  std::vector<std::string> notesOn(
    const char* rocks, const char* numbers, const char* instead) const;

  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

/// A cell that something passed: first of all rocks, then of those of each threshold.
struct CellFrequency
{
  std::uint32_t cell = 0;
  std::vector<std::int64_t> rocks; ///< Rocks × iterations.
  std::vector<double> frequencies; ///< Of passage by one of them, 1/a.
};

/// Calls `use` for each cell of passages that come in their order and are summed in it: the results
/// are the same bits however they were shared out. A rock counts for a threshold (J) if its largest
/// energy on the way through the cell is at least that.
class FrequencySummarizer
{
public:
  FrequencySummarizer(std::vector<double> thresholds, std::function<double(const Passage&)> weight,
    std::function<void(const CellFrequency&)> use)
    : thresholds_(std::move(thresholds))
    , weight_(std::move(weight))
    , use_(std::move(use))
  {
  }

  void add(const Passage& passage);
  void finish(); ///< Hands on the last cell.
  /// Of the rocks of cells in which they differ.
  const FrequencyRange& differing() const { return differing_; }

private:
  std::vector<double> thresholds_;
  FrequencyRange ofCell_, differing_;
  std::function<double(const Passage&)> weight_;
  std::function<void(const CellFrequency&)> use_;
  CellFrequency cell_;
};

/// With 95 % confidence a cell that nothing passed is not passed more often than this, 1/a, where
/// no trajectory weighs more than `largestWeight`: of Σ fₖ pₖ under Π (1 − pₖ)^Nₖ ≥ 0.05, as pₖ ≤
/// −ln(1 − pₖ), at most ln 20 times the largest fₖ / Nₖ. It is the rule of three.
double frequencyLimit(double largestWeight);

} // namespace rockfall
