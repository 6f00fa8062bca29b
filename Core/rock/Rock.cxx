#include "rock/Rock.h"

#include "base/require.h"
#include "base/text/numberText.h"
#include "base/text/pointText.h"
#include "law/settings.h"

#include <cmath>

namespace rockfall
{

void Rock::validate() const
{
  const std::string name = "block " + std::to_string(this->blockId) + ": ";
  const auto positive =
    [&](double value, double least, double most, const char* field, const char* unit)
  {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      throw ParameterError(name + field + " is " + numberText(value) +
        ", it must be a positive, finite number of " + unit);
    }
    if (value > most)
    {
      throw ParameterError(name + field + " is " + numberText(value) + " " + unit +
        ", no rock has more than " + numberText(most));
    }
    if (value < least)
    {
      throw ParameterError(name + field + " is " + numberText(value) + " " + unit +
        ", no rock has less than " + numberText(least));
    }
  };
  positive(this->density, kLeastDensity, kMostDensity, "Density", "kg/m³");
  positive(this->youngModulus, kLeastModulus, kMostModulus, "YoungModulus", "Pa");
  require(this->poissonRatio >= 0.0 && this->poissonRatio <= 0.49, name + "PoissonRatio",
    this->poissonRatio, "", "0 to 0.49");
  positive(this->shape.integrals().volume, kLeastVolume, kMostVolume, "Volume", "m³");
  const auto finite = [&](const Vec3& value, const char* field)
  {
    if (!value.allFinite())
    {
      throw ParameterError(name + field + " is " + pointText(value) + ", it must be finite");
    }
  };
  finite(this->position, "Center");
  finite(this->velocity, "Velocity");
  finite(this->angularVelocity, "AngularVelocity");
  const auto atMost = [&](double value, double most, const char* what, const char* unit)
  {
    if (value > most)
    {
      throw ParameterError(name + what + " is " + numberText(value) + " " + unit +
        ", no rock has more than " + numberText(most));
    }
  };
  const double spin = this->angularVelocity.stableNorm();
  atMost(this->velocity.stableNorm(), kMostSpeed, "Velocity", "m/s");
  atMost(spin, kMostSpin, "AngularVelocity", "rad/s");
  atMost(spin * this->shape.radius(), kMostSpeed,
    "AngularVelocity times the radius, the speed of its outermost point,", "m/s");
  if (!this->orientation.coeffs().allFinite() || this->orientation.norm() < 1e-6)
  {
    throw ParameterError(name + "Orientation is not a rotation");
  }
  try
  {
    this->uncertainty.validate();
  }
  catch (const ParameterError& error)
  {
    throw ParameterError(name + error.what());
  }
}

Block blockOf(const Rock& rock)
{
  return Block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
}

} // namespace rockfall
