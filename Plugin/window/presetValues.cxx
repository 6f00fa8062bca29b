#include "presetValues.h"

#include "base/types.h"
#include "terrain/presets.h"
#include "terrain/yieldingGround.h"

namespace rockfall::window
{

std::vector<std::pair<std::string, double>> presetValues(int preset)
{
  const auto presets = groundPresets();
  if (preset < 1 || preset > int(presets.size()))
  {
    return {};
  }
  const GroundPreset& ground = presets[std::size_t(preset) - 1];
  const SurfaceMaterial material = ground.material();
  std::vector<std::pair<std::string, double>> values = {
    { "RestitutionModel", double(int(material.restitutionModel)) },
    { "RestitutionCoefficient", material.restitution },
    { "RestitutionDeviation", material.restitutionDeviation },
    { "TangentialRestitution", material.tangentialRestitution },
    { "RestitutionSpeed", material.restitutionSpeed },
    { "FrictionAngle", ground.frictionAngleDegrees },
    { "FrictionAngleDeviation", ground.frictionDeviationDegrees },
    { "DeviationPer", double(int(ground.deviationPer())) },
    { "RoughnessMean", ground.roughness.mean },
    { "RoughnessDeviation", ground.roughness.deviation },
    { "RoughnessLength", ground.roughness.length },
    { "ObstacleHeight70", ground.roughness.obstacles[0] },
    { "ObstacleHeight20", ground.roughness.obstacles[1] },
    { "ObstacleHeight10", ground.roughness.obstacles[2] },
  };
  for (const YieldingField& field : yieldingFields())
  {
    values.emplace_back(field.property, field.typed(material.yielding));
  }
  return values;
}

} // namespace rockfall::window
