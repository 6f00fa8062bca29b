#pragma once

/// @file
/// Materials of rocks, by name.

#include <span>
#include <string>

namespace rockfall
{

/// Density, stiffness and Poisson's ratio of intact rock.
struct RockMaterial
{
  const char* name;
  double density;      ///< kg/m³
  double youngModulus; ///< Pa
  double poissonRatio; ///< Dimensionless.
};

/// Typical values of intact rock. Densities: averages of Telford, Geldart & Sheriff (1990), Applied
/// Geophysics, 2nd ed., table 2.1. Elastic constants: Wyllie (1999), Foundations on Rock, 2nd ed.,
/// table 3.1.
std::span<const RockMaterial> rockMaterials();

/// Ignores case; throws ParameterError naming the word and the choices.
const RockMaterial& rockMaterialFromName(const std::string& name);

} // namespace rockfall
