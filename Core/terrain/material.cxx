#include "terrain/material.h"

#include "base/require.h"
#include "law/settings.h"

#include <algorithm>

namespace rockfall
{

namespace
{

void requireRange(
  double value, double low, double high, const char* field, const std::string& range)
{
  require(value >= low && value <= high, field, value, "", range);
}

} // namespace

void SurfaceMaterial::validate() const
{
  requireRange(this->restitution, 0.0, 1.0, "RestitutionCoefficient", "0 to 1");
  requireRange(this->restitutionDeviation, 0.0, 1.0, "RestitutionDeviation", "0 to 1");
  const int model = int(this->restitutionModel);
  if (model < int(RestitutionModel::Velocity) || model > int(RestitutionModel::SpeedDependent))
  {
    throw ParameterError("RestitutionModel is " + std::to_string(model) +
      ", it must be 0 (whole velocity), 1 (normal and tangential) or 2 (speed-dependent)");
  }
  requireRange(this->tangentialRestitution, 0.0, 1.0, "TangentialRestitution", "0 to 1");
  require(this->restitutionSpeed > 0.0 && this->restitutionSpeed <= kMostRestitutionSpeed,
    "RestitutionSpeed", this->restitutionSpeed, "",
    "a positive number of metres per second, at most " + numberText(kMostRestitutionSpeed));
  require(this->frictionAngle >= 0.0 && this->frictionAngle <= radians(kSteepestFriction),
    "FrictionAngle", degrees(this->frictionAngle), " degrees", "0 to 89");
  require(this->frictionAngleDeviation >= 0.0 &&
      this->frictionAngleDeviation <= radians(kSteepestFriction),
    "FrictionAngleDeviation", degrees(this->frictionAngleDeviation), " degrees", "0 to 89");
  requireRange(this->cohesion, 0.0, kMostCohesion, "Cohesion",
    "a number of newtons, not negative, at most " + numberText(kMostCohesion));
  this->yielding.validate();
}

void MaterialClasses::validate(std::int64_t cellCount, const char* kind) const
{
  const std::string what = std::string(kind) + " classes";
  if (names.size() != materials.size() || this->count() > largest)
  {
    throw DataError("there are " + std::to_string(materials.size()) + " materials and " +
      std::to_string(names.size()) + " names of " + what + "; at most " + std::to_string(largest) +
      " are possible");
  }
  if (!roughness.empty() && roughness.size() != materials.size())
  {
    throw DataError("there are " + std::to_string(roughness.size()) + " roughnesses for " +
      std::to_string(materials.size()) + " " + what);
  }
  if (!cells.empty() && std::int64_t(cells.size()) != cellCount)
  {
    throw DataError("there are " + what + " for " + std::to_string(cells.size()) +
      " cells, the slope has " + std::to_string(cellCount));
  }
  const auto highest = std::max_element(cells.begin(), cells.end());
  if (highest != cells.end() && int(*highest) > this->count())
  {
    throw DataError("a cell has number " + std::to_string(int(*highest)) + " of the " + what +
      ", there are " + std::to_string(this->count()));
  }
  for (std::size_t k = 0; k < materials.size(); ++k)
  {
    try
    {
      materials[k].validate();
      if (!roughness.empty())
      {
        roughness[k].validate();
      }
    }
    catch (const ParameterError& error)
    {
      throw ParameterError(
        std::string(kind) + " class \"" + names[k] + "\": " + std::string(error.what()));
    }
  }
}

} // namespace rockfall
