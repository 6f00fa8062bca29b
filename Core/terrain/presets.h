#pragma once

/// @file
/// Common kinds of ground, each with every parameter of the law and what supports it. Their sources:
/// docs/materials.md, Presets.

#include "terrain/material.h"
#include "terrain/roughness.h"
#include "terrain/scatter.h"

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rockfall
{

/// Support of a preset's numbers.
enum class PresetSupport
{
  FieldData,  ///< Chosen on field data; parts held out in turn agree (docs/validation.md).
  Assumption, ///< Chosen here, between kinds that are supported.
  Memory,     ///< Quoted from publications that were not at hand.
};
/// As panels say it: "field data", "assumed", "from memory".
const char* supportName(PresetSupport support);

/// A kind of ground.
struct GroundPreset
{
  const char* name;                ///< Lower case, as in tables.
  const char* label;               ///< As in the panel, without its support.
  double normalRestitution;        ///< Rn
  double tangentialRestitution;    ///< Rt; 1 where slip-dependent friction acts.
  double restitutionDeviation;     ///< Of Rn.
  double frictionAngleDegrees;     ///< φ; without effect where slip-dependent friction acts.
  double frictionDeviationDegrees; ///< Of φ.
  YieldingGround yielding;
  PresetSupport support; ///< Of the weakest of its numbers that matter.
  /// Never node by node: whatever the cells, rocks meet the same ground.
  Roughness roughness;
  const char* errs;              ///< Where the preset is known to err, for the note of a slope.
  double restitutionSpeed = 0.0; ///< K of the speed-dependent model, m/s; 0: Rn at every speed.

  SurfaceMaterial material() const;
  /// As panels and views say it: "Meadow (field data)".
  std::string title() const;
  /// What a slope says of it, once: adds its warning to notes that do not have it.
  void warn(std::vector<std::string>& notes) const;
  /// Ground that yields scatters from impact to impact; the others' deviations are of a whole
  /// slope.
  DeviationPer deviationPer() const
  {
    return yielding.scars() ? DeviationPer::Impact : DeviationPer::Iteration;
  }
};

/// All presets, in the order of the enumeration of the DEM source's property.
std::span<const GroundPreset> groundPresets();
/// By name, not case-sensitive, with or without what panels say in brackets. Throws DataError that
/// lists the names.
const GroundPreset& groundPreset(std::string_view name);

/// Properties of DEM to CFE Mesh and what a preset, from 1, makes of them, in the panel's units.
/// Nothing for 0, no preset.
std::vector<std::pair<std::string, double>> presetValues(int preset);

/// Number, from 1, of the preset that a slope has in a window until another is chosen: the one that
/// field data support.
int usualPreset();

/// Ground of a slope in words, for the view. `preset`: number, 0 for none. What is neither a preset
/// nor yields is bare rock, as in published DDA.
std::string groundTitle(
  int preset, const SurfaceMaterial& material, const MaterialClasses& classes);

} // namespace rockfall
