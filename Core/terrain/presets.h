#pragma once

/// @file
/// Common kinds of ground with coefficients quoted from publications. Which of them were checked
/// stands in docs/DEMtoCFEMesh.md, Presets.

#include "terrain/material.h"

#include <span>
#include <string>

namespace rockfall
{

/// A kind of ground. The restitution is normal and tangential; what it has of a
/// `SurfaceMaterial` else is as by default.
struct GroundPreset
{
  const char* name;                ///< Lower case, as in tables.
  double normalRestitution;        ///< Rn
  double tangentialRestitution;    ///< Rt
  double restitutionDeviation;     ///< Of Rn.
  double frictionAngleDegrees;     ///< φ
  double frictionDeviationDegrees; ///< Of φ.
  const char* restitutionSource;
  const char* frictionSource;

  SurfaceMaterial material() const;
};

/// All presets, in the order of the enumeration of the DEM source's property.
std::span<const GroundPreset> groundPresets();
/// By name, not case-sensitive. Throws DataError that lists the names.
const GroundPreset& groundPreset(const std::string& name);

} // namespace rockfall
