#include "base/RockMaterial.h"

#include "base/errors.h"
#include "base/text/nameKey.h"

namespace rockfall
{

namespace
{

constexpr RockMaterial materials[] = {
  { "granite", 2640.0, 5.86e10, 0.26 },
  { "gneiss", 2800.0, 7.99e10, 0.24 },
  { "basalt", 2990.0, 6.10e10, 0.19 },
  { "limestone", 2550.0, 5.39e10, 0.32 },
  { "dolomite", 2700.0, 5.17e10, 0.29 },
  { "sandstone", 2350.0, 2.99e10, 0.31 },
  { "shale", 2400.0, 2.19e10, 0.38 },
};

} // namespace

std::span<const RockMaterial> rockMaterials()
{
  return materials;
}

const RockMaterial& rockMaterialFromName(const std::string& name)
{
  const std::string wanted = nameKey(name);
  std::string choices;
  for (const RockMaterial& material : materials)
  {
    if (wanted == material.name)
    {
      return material;
    }
    choices += (choices.empty() ? "" : ", ") + std::string(material.name);
  }
  throw ParameterError("Material is \"" + name + "\", it must be one of " + choices);
}

} // namespace rockfall
