#include "base/RockMaterial.h"

#include "base/text/placeOfName.h"

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
  return materials[placeOfName(materials, name, "Material", &RockMaterial::name)];
}

} // namespace rockfall
