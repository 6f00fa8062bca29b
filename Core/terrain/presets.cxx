#include "terrain/presets.h"

#include "base/errors.h"

#include <algorithm>

namespace rockfall
{

namespace
{

/// E. Hoek (1987), Rockfall: a program in BASIC for the analysis of rockfalls from slopes,
/// University of Toronto; the table is said to be in Hoek, Practical Rock Engineering, chapter
/// Analysis of rockfall hazards. It has no deviations. The numbers are those that are commonly
/// quoted of it: neither the table nor a text that quotes it was at hand to check them.
constexpr const char* hoek = "Hoek (1987)";
/// Basic friction angles of fresh rock, 23° (gneiss, wet) to 38° (basalt, dry): N. Barton & V.
/// Choubey (1977), The shear strength of rock joints in theory and practice, Rock Mechanics 10,
/// 1–54; checked as reprinted in Mechanics of Asphalt: Microstructure and Micromechanics,
/// table 2.5.
constexpr const char* barton = "Barton & Choubey (1977)";
/// Loose angular rock rests at 35° to 39°: M.A. Carson (1977), Angles of repose, angles of shearing
/// resistance and angles of talus slopes, Earth Surface Processes 2, 363–380. From memory, not
/// checked; works of reference give talus 30° to 40°, coarse scree 32° to 36°.
constexpr const char* carson = "Carson (1977)";
/// No published value for rocks on such ground was found.
constexpr const char* assumed = "assumed";

/// The deviation of Rn is that of a uniform spread of ±10 % of it: Rn · 0.1/√3, at three decimals.
/// This and the deviations of φ are choices, not published values.
constexpr GroundPreset presets[] = {
  { "rock", 0.53, 0.99, 0.031, 30.0, 2.5, hoek, barton },
  { "asphalt", 0.40, 0.90, 0.023, 33.0, 2.5, hoek, assumed },
  { "bedrock with boulders", 0.35, 0.85, 0.020, 35.0, 2.5, hoek, assumed },
  { "talus", 0.32, 0.82, 0.018, 37.0, 2.0, hoek, carson },
  { "talus with vegetation", 0.32, 0.80, 0.018, 37.0, 2.0, hoek, carson },
  { "soil", 0.30, 0.80, 0.017, 30.0, 3.0, hoek, assumed },
  { "meadow", 0.30, 0.80, 0.017, 30.0, 3.0, "assumed, as soil", assumed },
};

} // namespace

SurfaceMaterial GroundPreset::material() const
{
  SurfaceMaterial material;
  material.restitutionModel = RestitutionModel::NormalTangential;
  material.restitution = this->normalRestitution;
  material.tangentialRestitution = this->tangentialRestitution;
  material.restitutionDeviation = this->restitutionDeviation;
  material.frictionAngle = radians(this->frictionAngleDegrees);
  material.frictionAngleDeviation = radians(this->frictionDeviationDegrees);
  return material;
}

std::span<const GroundPreset> groundPresets()
{
  return presets;
}

const GroundPreset& groundPreset(const std::string& name)
{
  std::string wanted = name, names;
  std::transform(wanted.begin(), wanted.end(), wanted.begin(),
    [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  for (const GroundPreset& preset : presets)
  {
    if (wanted == preset.name)
    {
      return preset;
    }
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  throw DataError("\"" + name + "\" is no preset; there are " + names);
}

} // namespace rockfall
