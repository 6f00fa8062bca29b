#pragma once

/// @file
/// What a barrier at a line has to hold: characteristic values with their limits, design values by
/// partial factors, classes of net fences, and what each would catch.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace rockfall
{

/// Limits of a quantile. NaN where the sample is too small for one.
struct QuantileLimits
{
  double low = 0.0;
  double high = 0.0;
};

/// Two values of the sample, whatever it is drawn of: with 95 % confidence the q quantile is not
/// below `low`, and with 95 % confidence not above `high`; both hold with 90 %. They are the order
/// statistics of the ranks that the binomial distribution gives: Hahn & Meeker (1991), Statistical
/// intervals, 5.2. `high` is there from leastForQuantile(q) values on.
QuantileLimits quantileLimits(std::span<const double> ascending, double q);

/// Probability of at most k successes in n independent trials of probability p.
double binomialAtMost(std::int64_t k, std::int64_t n, double p);

/// The largest probability of a success for which so few of n trials are not less likely than 5 %:
/// the upper 95 % limit of Clopper & Pearson (1934), Biometrika 26(4), 404–413. NaN without trials.
double shareAtMost(std::int64_t successes, std::int64_t trials);

/// Levels of the tables: the largest value behind the quantiles.
constexpr std::array<double, 5> designQuantiles = { 0.50, 0.90, 0.95, 0.98, 0.99 };

/// Partial factors in the terms of UNI 11211-4:2018; 1 changes nothing.
struct PartialFactors
{
  double slopeSurvey = 1.0;  ///< γ_Dp, on speed and height.
  double trajectories = 1.0; ///< γ_Tr, on speed and height.
  double blockSurvey = 1.0;  ///< γ_Vol, on mass.
  double unitWeight = 1.0;   ///< γ_γ, on mass.
  double risk = 1.0;         ///< γ_R, on energy.
  double barrier = 1.0;      ///< γ_E, by which the barrier's energy is divided.
  double freeboard = 0.0;    ///< f_min, m above the design height.
  double designMass = 0.0;   ///< kg; 0 = energies as they were simulated.

  double ofSpeed() const { return slopeSurvey * trajectories; }
  double ofMass() const { return blockSurvey * unitWeight; }
  /// E_d of a characteristic energy (J) and speed (m/s) of one level: γ_R γ_m γ_v² E, or of a
  /// design mass ½ γ_m m (γ_v v)² γ_R.
  double energy(double characteristic, double speed) const;
  double height(double characteristic) const { return ofSpeed() * characteristic; }
};

/// Throws ParameterError that names factor and value if one is below 1 or not finite, or a length
/// or mass negative.
void checkFactors(const PartialFactors& factors);

/// Energy level of falling rock protection kits, EAD 340059-00-0106, table 1.
struct BarrierClass
{
  double maximum; ///< MEL, J.
  double service; ///< SEL, J; 0 for none.
};
/// Levels 0 to 7. Level 8 is what is declared above the last.
constexpr std::array<BarrierClass, 8> barrierClasses = { { { 100e3, 0.0 }, { 250e3, 85e3 },
  { 500e3, 170e3 }, { 1000e3, 330e3 }, { 1500e3, 500e3 }, { 2000e3, 660e3 }, { 3000e3, 1000e3 },
  { 4500e3, 1500e3 } } };

/// The lowest level whose MEL is at least this energy (J), 8 above all; −1 for NaN.
int sufficientClass(double energy);

/// A rock that passes a line for the first time.
struct DesignPassing
{
  std::int64_t source = 0;
  double energy = 0.0;    ///< Of translation and rotation, J.
  double speed = 0.0;     ///< m/s
  double top = 0.0;       ///< Height of its highest point, m; NaN if it is not known.
  double frequency = 0.0; ///< 1/a; NaN if it is not known.
  int run = 0;            ///< As RockRuns has it: each numbers its sources by itself.

  /// A rock that broke counts once, with the largest values of its pieces; its top is known if that
  /// of each piece is.
  void takeLarger(double ofEnergy, double ofSpeed, double ofTop)
  {
    energy = std::max(energy, ofEnergy);
    speed = std::max(speed, ofSpeed);
    top = ofTop > top || std::isnan(ofTop) ? ofTop : top;
  }
};

/// A characteristic value and its limits.
struct DesignValue
{
  double value = 0.0;
  QuantileLimits limits;
};

/// A level of one line.
struct DesignLevel
{
  double quantile = 0.0; ///< 1 for the largest value, which has no limits.
  DesignValue energy, speed, top;
};

/// One level per designQuantiles, and the largest.
std::vector<DesignLevel> designLevels(std::span<const DesignPassing> passings);

/// What a barrier does to rocks. Each is one of the three, in this order: over it, or too strong
/// for it, or caught. A rock without a height is over it.
struct BarrierOutcome
{
  struct Count
  {
    int rocks = 0;
    double frequency = 0.0; ///< 1/a; NaN if it is not known, of no rocks, too.
  };
  Count caught, over, tooStrong;

  int rocks() const { return caught.rocks + over.rocks + tooStrong.rocks; }
  double frequency() const { return caught.frequency + over.frequency + tooStrong.frequency; }
};

/// Of a barrier of this height (m) and capacity (J). Frequencies are summed in the order given.
/// Unless they are `known` there is no sum of them, not even of none: 0 would say never.
BarrierOutcome outcomeOf(
  std::span<const DesignPassing> passings, double height, double capacity, bool known = true);

} // namespace rockfall
