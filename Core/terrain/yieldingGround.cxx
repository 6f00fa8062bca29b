#include "terrain/yieldingGround.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "law/settings.h"

#include <cmath>
#include <numbers>
#include <string>

namespace rockfall
{

double YieldingGround::scarDepth(double mass, double speed, double softness) const
{
  if (!this->scars() || !(speed > 0.0))
  {
    return 0.0;
  }
  const double kiloNewtons = 1e-3 * this->modulus / softness;
  return this->depthFactor * std::cbrt(mass) * std::pow(kiloNewtons, -0.4) * std::pow(speed, 0.8);
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
  for (const YieldingField& field : yieldingFields())
  {
    const double value = this->*field.member;
    if (field.noneIsInfinite ? !(value > 0.0) : !(value >= 0.0 && std::isfinite(value)))
    {
      throw ParameterError(std::string(field.property) + " is " + numberText(value / field.scale) +
        (*field.unit ? std::string(" ") + field.unit : "") +
        ", it must be a finite number, not negative" +
        (field.noneIsInfinite ? " (0: hard ground)" : ""));
    }
  }
  if (this->modulus < kLeastGroundModulus)
  {
    throw ParameterError("GroundModulus is " + numberText(this->modulus / 1e6) +
      " MN/m², it must be 0 (hard ground) or at least 0.001");
  }
  if (this->deviation > 0.0 && !(this->deviationLength > 0.0))
  {
    throw ParameterError("GroundDeviationLength is " + numberText(this->deviationLength) +
      " m, it must be above 0 where GroundDeviation is " + numberText(this->deviation));
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
  };
  return fields;
}

} // namespace rockfall
