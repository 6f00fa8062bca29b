#pragma once

/// @file
/// Ground of a preset that is the same everywhere.

#include "terrain/presets.h"

namespace rockfall::testing
{

inline SurfaceMaterial evenGround(const char* preset)
{
  SurfaceMaterial ground = groundPreset(preset).material();
  ground.restitutionDeviation = ground.yielding.deviation = 0.0;
  return ground;
}

} // namespace rockfall::testing
