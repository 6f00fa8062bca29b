#include "base/VolumeDistribution.h"

#include "base/require.h"
#include "base/text/placeOfName.h"

#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Names in the order of VolumeLaw.
constexpr const char* names[] = { "fixed", "uniform", "normal", "lognormal", "powerlaw" };

/// Bounds that leave less than this of a distribution are a mistake, not a choice.
constexpr double leastShare = 1e-6;
/// Deviation in means beyond which a distribution is refused: all but a few rocks would be dust.
constexpr double mostDeviation = 1e3;

/// A normal distribution of V, or of ln V, with the shares that the bounds cut off below.
struct Bell
{
  double centre, width;       ///< m³, or of ln(V/m³)
  double lowShare, highShare; ///< Cumulated at the bounds.
  bool logarithmic;

  explicit Bell(const VolumeDistribution& d)
    : logarithmic(d.law == VolumeLaw::LogNormal)
  {
    const double ratio = d.deviation / d.mean;
    width = logarithmic ? std::sqrt(std::log1p(ratio * ratio)) : d.deviation;
    centre = logarithmic ? std::log(d.mean) - 0.5 * width * width : d.mean;
    lowShare = !logarithmic || d.minimum > 0.0 ? this->share(d.minimum) : 0.0;
    highShare = d.maximum > 0.0 ? this->share(d.maximum) : 1.0;
  }
  double share(double volume) const
  {
    const double place = logarithmic ? std::log(volume) : volume;
    return boost::math::cdf(boost::math::normal(centre, width), place);
  }
  double quantile(double u) const
  {
    const double share = lowShare + u * (highShare - lowShare);
    // Rounding must not reach the ends, where the quantile is infinite.
    const double within = std::clamp(share, std::numeric_limits<double>::min(), 1.0 - 0x1p-53);
    const double place = boost::math::quantile(boost::math::normal(centre, width), within);
    return logarithmic ? std::exp(place) : place;
  }
};

} // namespace

std::string volumeLawName(VolumeLaw law)
{
  if (law < VolumeLaw::Fixed || law > VolumeLaw::PowerLaw)
  {
    throw ParameterError("VolumeLaw is " + std::to_string(int(law)) + ", it must be 0 to 4");
  }
  return names[int(law)];
}

VolumeLaw volumeLawFromName(const std::string& name)
{
  return VolumeLaw(placeOfName(names, name, "VolumeLaw"));
}

void VolumeDistribution::validate() const
{
  volumeLawName(this->law); // throws if there is no such law
  const auto notNegative = [](double value, const char* field)
  {
    require(
      value >= 0.0 && std::isfinite(value), field, value, "", "a finite number of m³, at least 0");
  };
  notNegative(this->deviation, "VolumeDeviation");
  notNegative(this->minimum, "VolumeMinimum");
  notNegative(this->maximum, "VolumeMaximum");
  require(this->exponent > 0.0 && std::isfinite(this->exponent), "VolumeExponent", this->exponent,
    "", "positive and finite");
  const bool bell = this->law == VolumeLaw::Normal || this->law == VolumeLaw::LogNormal;
  const bool hasMean = this->law == VolumeLaw::Fixed || bell;
  require(!hasMean || (this->mean > 0.0 && std::isfinite(this->mean)), "Volume", this->mean, "",
    "a positive, finite number of m³");
  if (this->law == VolumeLaw::Fixed)
  {
    return;
  }
  require(this->law != VolumeLaw::PowerLaw || this->minimum != 0.0, "VolumeMinimum", this->minimum,
    "", "above 0 for the law powerlaw");
  require(bell || this->maximum != 0.0, "VolumeMaximum", this->maximum, "",
    "above 0 for the law " + volumeLawName(this->law));
  require(!(this->maximum > 0.0) || this->maximum > this->minimum, "VolumeMaximum", this->maximum,
    "", "above VolumeMinimum, which is " + numberText(this->minimum));
  const bool single = bell && this->deviation == 0.0;
  require(!single ||
      (this->mean >= this->minimum && (this->maximum == 0.0 || this->mean <= this->maximum)),
    "Volume", this->mean, "",
    "within VolumeMinimum and VolumeMaximum, which are " + numberText(this->minimum) + " and " +
      numberText(this->maximum));
  require(!bell || this->deviation <= mostDeviation * this->mean, "VolumeDeviation",
    this->deviation, "", "at most a thousand times Volume, which is " + numberText(this->mean));
  if (bell && this->deviation > 0.0)
  {
    const Bell curve(*this);
    if (!(curve.highShare - curve.lowShare > leastShare))
    {
      throw ParameterError("VolumeMinimum " + numberText(this->minimum) + " and VolumeMaximum " +
        numberText(this->maximum) + " m³ leave nothing of the law " + volumeLawName(this->law) +
        " with Volume " + numberText(this->mean) + " and VolumeDeviation " +
        numberText(this->deviation));
    }
  }
}

double VolumeDistribution::quantile(double u) const
{
  switch (this->law)
  {
    case VolumeLaw::Uniform:
      return this->minimum + u * (this->maximum - this->minimum);
    case VolumeLaw::Normal:
    case VolumeLaw::LogNormal:
    {
      if (this->deviation == 0.0)
      {
        return this->mean;
      }
      const double volume = Bell(*this).quantile(u);
      // Bounds are kept to the last bit, and a volume is never 0.
      const double least = std::max(this->minimum, 1e-12 * this->mean);
      return std::clamp(volume, least, this->maximum > 0.0 ? this->maximum : INFINITY);
    }
    case VolumeLaw::PowerLaw:
    {
      // The share below V is (1 − (V/min)⁻ᵇ) / (1 − (max/min)⁻ᵇ).
      const double b = this->exponent;
      const double all = -std::expm1(-b * std::log(this->maximum / this->minimum));
      return std::min(this->maximum, this->minimum * std::exp(-std::log1p(-u * all) / b));
    }
    case VolumeLaw::Fixed:
      break;
  }
  return this->mean;
}

} // namespace rockfall
