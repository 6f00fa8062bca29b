#include "terrain/presets.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/types.h"
#include "terrain/yieldingGround.h"

#include <algorithm>

namespace rockfall
{

namespace
{

/// Scars and slip-dependent friction of Lu et al. (2019).
constexpr YieldingGround yields(
  double modulus, double compaction, double frictionLeast, double rollingResistance)
{
  YieldingGround ground;
  ground.modulus = modulus;
  ground.depthFactor = 0.125; // the scars that they computed are deeper than their equation
  ground.compaction = compaction;
  ground.frictionLeast = frictionLeast;
  ground.frictionMost = 2.0;
  ground.frictionGrowth = 3.0;
  ground.frictionDecay = 185.0;
  ground.rollingResistance = rollingResistance;
  return ground;
}

/// The same, softer here and firmer there by this deviation of ln S over 30 m.
constexpr YieldingGround deviates(YieldingGround ground, double deviation)
{
  ground.deviation = deviation;
  ground.deviationLength = 30.0;
  return ground;
}

/// The same, with scars that are shallower for their size the larger a rock is; rocks of 1 m³ dig as
/// they do without.
constexpr YieldingGround sized(YieldingGround ground)
{
  ground.scarRadius = 0.62; // m, of the sphere of 1 m³
  return ground;
}

/// Hard ground on which rocks do not roll on for ever.
constexpr YieldingGround holds(double rollingResistance)
{
  YieldingGround ground;
  ground.rollingResistance = rollingResistance;
  return ground;
}

/// Smooth beyond its survey.
constexpr Roughness smooth;

/// Stones that lie on the ground, one in each square: heights of 70, 20 and 10 % of them.
constexpr Roughness stones(double distance, double small, double medium, double large)
{
  Roughness roughness;
  roughness.length = distance;
  roughness.obstacles = { small, medium, large };
  return roughness;
}

/// Humps and hollows.
constexpr Roughness waves(double deviation, double length)
{
  Roughness roughness;
  roughness.deviation = deviation;
  roughness.length = length;
  return roughness;
}

using enum PresetSupport;

constexpr const char* brakesTwice =
  "stops rocks too soon: its Rt holds losses that friction takes once more";
constexpr const char* shortOfSteep =
  "stops rocks too soon below short steep slopes: the farthest 1 % below 150 m of drop at 40° have "
  "a reach angle of 34°, in field surveys 27.5° to 32°; and it is too fast there: up to 32 m/s "
  "(95 %), in field surveys 30 m/s at most";

/// The deviations of φ are choices, and those of Hoek's Rn those of a uniform spread of ±10 %.
constexpr GroundPreset presets[] = {
  { "rock", "Rock", 0.53, 0.99, 0.031, 30.0, 2.5, holds(0.1), Memory, waves(0.05, 2.0),
    brakesTwice },
  { "asphalt", "Asphalt", 0.40, 0.90, 0.023, 33.0, 2.5, holds(0.05), Memory, smooth, brakesTwice },
  // On its rolling resistance rocks rest on 17°.
  { "bedrock with boulders", "Bedrock with boulders", 0.35, 1.0, 0.020, 35.0, 2.5, holds(0.3),
    Memory, stones(2.0, 0.05, 0.2, 0.4),
    "is quoted from memory: on 450 m of 35° rocks reach 47 m/s, in field surveys 30 m/s at most" },
  { "talus", "Talus", 0.6, 1.0, 0.3, 37.0, 2.0, sized(yields(10e6, 1.25, 0.6, 0.08)), Assumption,
    stones(2.0, 0.05, 0.1, 0.2), shortOfSteep, 4.0 },
  { "talus with vegetation", "Talus with vegetation", 0.6, 1.0, 0.3, 37.0, 2.0,
    sized(yields(10e6, 1.4, 0.6, 0.1)), Assumption, stones(2.0, 0.05, 0.1, 0.2), shortOfSteep,
    4.0 },
  // On less roughness rocks walk on for minutes.
  { "soil", "Soil", 0.3, 1.0, 0.15, 30.0, 3.0, sized(yields(10e6, 1.25, 0.6, 0.36)), Assumption,
    waves(0.15, 2.0),
    "stops rocks too soon: the farthest 1 % below 150 m of drop at 40° have a reach angle of 36°, "
    "in field surveys 27.5° to 32°" },
  { "meadow", "Meadow", 0.73, 1.0, 0.34, 30.0, 3.0, deviates(yields(13e6, 0.45, 0.98, 0.18), 0.1),
    FieldData, waves(0.1, 2.0),
    "is too fast on long slopes: 37 m/s (95 %) on 450 m of 35°, in field surveys 30 m/s at most; "
    "and blocks of 10 m³ go no farther than those of 0.1 m³, in nature they do",
    7.0 },
};

} // namespace

const char* supportName(PresetSupport support)
{
  switch (support)
  {
    case FieldData:
      return "field data";
    case Assumption:
      return "assumed";
    case Memory:
      return "from memory";
  }
  return "";
}

SurfaceMaterial GroundPreset::material() const
{
  SurfaceMaterial material;
  material.restitutionModel = RestitutionModel::NormalTangential;
  if (this->restitutionSpeed > 0.0)
  {
    material.restitutionModel = RestitutionModel::SpeedDependent;
    material.restitutionSpeed = this->restitutionSpeed;
  }
  material.restitution = this->normalRestitution;
  material.tangentialRestitution = this->tangentialRestitution;
  material.restitutionDeviation = this->restitutionDeviation;
  material.frictionAngle = radians(this->frictionAngleDegrees);
  material.frictionAngleDeviation = radians(this->frictionDeviationDegrees);
  material.yielding = this->yielding;
  return material;
}

std::string GroundPreset::title() const
{
  return std::string(this->label) + " (" + supportName(this->support) + ")";
}

void GroundPreset::warn(std::vector<std::string>& notes) const
{
  const std::string note = "The preset " + std::string(this->label) + " " + this->errs;
  if (std::ranges::find(notes, note) == notes.end())
  {
    notes.push_back(note);
  }
}

std::span<const GroundPreset> groundPresets()
{
  return presets;
}

const GroundPreset& groundPreset(std::string_view name)
{
  // Panels say behind it what it rests on: Meadow (field data).
  const std::string wanted = nameKey(name.substr(0, name.find('(')));
  std::string names;
  for (const GroundPreset& preset : presets)
  {
    if (wanted == preset.name)
    {
      return preset;
    }
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  throw DataError("\"" + std::string(name) + "\" is no preset; there are " + names);
}

int usualPreset()
{
  return int(&groundPreset("meadow") - presets) + 1;
}

std::string groundTitle(int preset, const SurfaceMaterial& material, const MaterialClasses& classes)
{
  std::string title = preset > 0 ? presets[preset - 1].title()
    : material.yielding.yields() ? "typed numbers"
                                 : "hard, for comparison with published DDA";
  if (classes.count() == 0)
  {
    return title;
  }
  constexpr std::size_t most = 4; // fit into a view
  std::string names;
  for (std::size_t k = 0; k < std::min(classes.names.size(), most); ++k)
  {
    names += classes.names[k] + ", ";
  }
  return "classes " + names + (classes.names.size() > most ? "..., " : "") + "elsewhere " + title;
}

std::vector<std::pair<std::string, double>> presetValues(int preset)
{
  if (preset < 1 || preset > int(std::size(presets)))
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

} // namespace rockfall
