#pragma once

/// @file
/// How the volumes of rocks are distributed.

#include <string>

namespace rockfall
{

enum class VolumeLaw
{
  Fixed = 0,     ///< V = mean.
  Uniform = 1,   ///< Between minimum and maximum.
  Normal = 2,    ///< Mean and deviation, cut off at the bounds.
  LogNormal = 3, ///< Mean and deviation of V itself, cut off at the bounds.
  /// N(> V) ∝ V⁻ᵇ between the bounds, b = exponent. Rockfall inventories have b from 0.4 to 0.7:
  /// Dussauge, Grasso & Helmstetter (2003), Statistical analysis of rockfall volume distributions,
  /// Journal of Geophysical Research 108(B6), 2286.
  PowerLaw = 4,
};

/// "fixed", "uniform", "normal", "lognormal", "powerlaw" and back; the way back ignores case and
/// throws ParameterError naming the word and the choices.
std::string volumeLawName(VolumeLaw law);
VolumeLaw volumeLawFromName(const std::string& name);

/// A distribution of volumes. The cut-off at the bounds is exact: what is beyond is drawn never,
/// and the rest in proportion.
struct VolumeDistribution
{
  VolumeLaw law = VolumeLaw::Fixed;
  double mean = 1.0;      ///< m³, > 0. Fixed, Normal, LogNormal.
  double deviation = 0.5; ///< Standard deviation, m³, ≥ 0. Normal, LogNormal.
  double minimum = 0.1;   ///< m³, ≥ 0; > 0 for PowerLaw. All but Fixed.
  double maximum = 10.0;  ///< m³; 0: no upper bound, for Normal and LogNormal only.
  double exponent = 0.5;  ///< b, dimensionless, > 0. PowerLaw.

  /// Throws ParameterError naming field and value: signs always, the rest as the law needs it.
  void validate() const;
  /// The volume below which a share u of all rocks is, 0 < u < 1, m³.
  double quantile(double u) const;

  bool operator==(const VolumeDistribution&) const = default;
};

} // namespace rockfall
