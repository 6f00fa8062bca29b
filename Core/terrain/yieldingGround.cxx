#include "terrain/yieldingGround.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "law/settings.h"

#include <cmath>
#include <numbers>
#include <string>

namespace rockfall
{

namespace
{

struct Bounds
{
  double least, most;
};

/// SI, of ground that yields, in the order of yieldingFields().
constexpr Bounds bounds[] = {
  { kLeastGroundModulus, kMostModulus }, // GroundModulus
  { 0.0, kMostScarFactor },              // ScarDepthFactor
  { kLeastDensity, kMostDensity },       // GroundDensity
  { 0.0, kMostScarDrag },                // ScarCompaction
  { 0.0, kMostScarDrag },                // ScarSpinDrag
  { 0.0, kMostGroundFriction },          // SlipFrictionMin
  { 0.0, kMostGroundFriction },          // SlipFrictionMax
  { 0.0, kMostSlipRate },                // SlipFrictionGrowth
  { 0.0, kMostSlipRate },                // SlipFrictionDecay
  { 0.0, kMostGroundFriction },          // RollingResistance
  { 0.0, kMostGroundDeviation },         // GroundDeviation
  { 0.0, kMostAlike },                   // GroundDeviationLength
  { 0.0, kMostScarRadius },              // ScarRadius
};

/// Of a value in SI, which must be `rule`.
[[noreturn]] void refuse(const YieldingField& field, double value, const std::string& rule)
{
  throw ParameterError(std::string(field.property) + " is " + numberText(value / field.scale) +
    (*field.unit ? std::string(" ") + field.unit : "") + ", it must be " + rule +
    (field.noneIsInfinite ? " (0: hard ground)" : ""));
}

} // namespace

double YieldingGround::scarDepth(double mass, double volume, double speed, double softness) const
{
  if (!this->scars() || !(speed > 0.0))
  {
    return 0.0;
  }
  const double kiloNewtons = 1e-3 * this->modulus / softness;
  const double alike =
    this->depthFactor * std::cbrt(mass) * std::pow(kiloNewtons, -0.4) * std::pow(speed, 0.8);
  if (!(this->scarRadius > 0.0))
  {
    return alike;
  }
  const double radius = std::cbrt(0.75 * volume / std::numbers::pi);
  return alike * std::cbrt(this->scarRadius / radius);
}

double YieldingGround::frictionAfter(double s) const
{
  return this->frictionLeast +
    (2.0 / std::numbers::pi) * (this->frictionMost - this->frictionLeast) *
    std::atan(this->frictionGrowth * s);
}

double YieldingGround::speedLeft(double volume, double mass) const
{
  return std::exp(-this->speedLost(volume, mass));
}

double YieldingGround::speedLost(double volume, double mass) const
{
  return 0.5 * (1.0 + this->compaction) * this->density * volume / mass;
}

double YieldingGround::spinLeft(double volume, double mass) const
{
  return std::exp(-0.5 * this->spinDrag * this->density * volume / mass);
}

void YieldingGround::validate() const
{
  static_assert(std::size(bounds) == 13); // as many as yieldingFields()
  for (std::size_t k = 0; k < std::size(bounds); ++k)
  {
    const YieldingField& field = yieldingFields()[k];
    const double value = this->*field.member;
    if (field.noneIsInfinite ? !(value > 0.0) : !(value >= 0.0 && std::isfinite(value)))
    {
      refuse(field, value, "a finite number, not negative");
    }
    if (field.noneIsInfinite && std::isinf(value))
    {
      continue;
    }
    if (value < bounds[k].least)
    {
      refuse(field, value, "at least " + numberText(bounds[k].least / field.scale));
    }
    if (value > bounds[k].most)
    {
      refuse(field, value, "at most " + numberText(bounds[k].most / field.scale));
    }
  }
  if (this->deviation > 0.0 && this->deviationLength < kLeastAlike)
  {
    throw ParameterError("GroundDeviationLength is " + numberText(this->deviationLength) +
      " m, it must be at least " + numberText(kLeastAlike) + " where GroundDeviation is " +
      numberText(this->deviation));
  }
  if (this->slips() && this->frictionLeast > this->frictionMost)
  {
    throw ParameterError("SlipFrictionMin is " + numberText(this->frictionLeast) +
      ", it must not exceed SlipFrictionMax, which is " + numberText(this->frictionMost));
  }
}

double YieldingField::typed(const YieldingGround& ground) const
{
  const double value = ground.*this->member;
  return this->noneIsInfinite && std::isinf(value) ? 0.0 : value / this->scale;
}

void YieldingField::set(YieldingGround& ground, double typed) const
{
  if (std::isinf(typed)) // no one types that for hard ground
  {
    refuse(*this, typed * this->scale, "a finite number, not negative");
  }
  ground.*this->member =
    this->noneIsInfinite && typed == 0.0 ? YieldingGround::hard : typed * this->scale;
}

std::span<const YieldingField> yieldingFields()
{
  using G = YieldingGround;
  static constexpr YieldingField fields[] = {
    { "GroundModulus", "me", "MN/m²", &G::modulus, 1e6, true },
    { "ScarDepthFactor", "scar_factor", "", &G::depthFactor, 1.0, false },
    { "GroundDensity", "ground_density", "kg/m³", &G::density, 1.0, false },
    { "ScarCompaction", "cs", "", &G::compaction, 1.0, false },
    { "ScarSpinDrag", "spin_drag", "", &G::spinDrag, 1.0, false },
    { "SlipFrictionMin", "mu_min", "", &G::frictionLeast, 1.0, false },
    { "SlipFrictionMax", "mu_max", "", &G::frictionMost, 1.0, false },
    { "SlipFrictionGrowth", "kappa", "1/m", &G::frictionGrowth, 1.0, false },
    { "SlipFrictionDecay", "beta", "1/s", &G::frictionDecay, 1.0, false },
    { "RollingResistance", "mu_r", "", &G::rollingResistance, 1.0, false },
    { "GroundDeviation", "ground_deviation", "", &G::deviation, 1.0, false },
    { "GroundDeviationLength", "ground_length", "m", &G::deviationLength, 1.0, false },
    { "ScarRadius", "scar_radius", "m", &G::scarRadius, 1.0, false },
  };
  return fields;
}

} // namespace rockfall
