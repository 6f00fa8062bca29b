#include "GroundSettings.h"

#include "base/text/numberText.h"
#include "terrain/presets.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace rockfall::calibration
{

namespace
{

/// A parameter that has a name: the place of its number, in the unit that is given.
struct Setting
{
  const char* name;
  const char* unit;
  void (*set)(GroundSettings&, double);
};

/// Fields that are plain numbers in the unit of the command line.
#define ROCKFALL_MATERIAL(field, unit)                                                             \
  Setting                                                                                          \
  {                                                                                                \
#field, unit, [](GroundSettings & s, double v) { s.material.field = v; }                       \
  }

const std::vector<Setting>& settings()
{
  static const std::vector<Setting> all = {
    { "restitutionModel", "0 velocity, 1 normal and tangential, 2 speed-dependent",
      [](GroundSettings& s, double v) { s.material.restitutionModel = RestitutionModel(int(v)); } },
    ROCKFALL_MATERIAL(restitution, ""),
    ROCKFALL_MATERIAL(restitutionDeviation, ""),
    ROCKFALL_MATERIAL(tangentialRestitution, ""),
    ROCKFALL_MATERIAL(restitutionSpeed, "m/s"),
    { "frictionAngle", "degrees",
      [](GroundSettings& s, double v) { s.material.frictionAngle = radians(v); } },
    { "frictionAngleDeviation", "degrees",
      [](GroundSettings& s, double v) { s.material.frictionAngleDeviation = radians(v); } },
    ROCKFALL_MATERIAL(cohesion, "N"),
    { "roughnessMean", "m", [](GroundSettings& s, double v) { s.roughness.mean = v; } },
    { "roughnessDeviation", "m", [](GroundSettings& s, double v) { s.roughness.deviation = v; } },
    { "roughnessLength", "m, 0: of the nodes",
      [](GroundSettings& s, double v) { s.roughness.length = v; } },
    { "obstacles70", "m", [](GroundSettings& s, double v) { s.roughness.obstacles[0] = v; } },
    { "obstacles20", "m", [](GroundSettings& s, double v) { s.roughness.obstacles[1] = v; } },
    { "obstacles10", "m", [](GroundSettings& s, double v) { s.roughness.obstacles[2] = v; } },
    { "deviationPer", "0 iteration, 1 impact, 2 place",
      [](GroundSettings& s, double v) { s.deviationPer = deviationPerFrom(v); } },
    { "cellSize", "m", [](GroundSettings& s, double v) { s.cellSize = v; } },
    { "density", "kg/m³", [](GroundSettings& s, double v) { s.density = v; } },
    { "placeDeviation", "m", [](GroundSettings& s, double v) { s.placeDeviation = v; } },
    { "normalPenalty", "N/m, 0: by mass",
      [](GroundSettings& s, double v) { s.simulation.normalPenalty = v; } },
    { "timeStep", "s", [](GroundSettings& s, double v) { s.simulation.timeStep = v; } },
    { "endTime", "s", [](GroundSettings& s, double v) { s.simulation.endTime = v; } },
  };
  return all;
}

double number(const std::string& text, const std::string& argument)
{
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
  {
    throw UsageError("\"" + argument + "\": \"" + text + "\" is not a number");
  }
  return value;
}

int count(const std::string& text, const std::string& argument, int least)
{
  const double value = number(text, argument);
  if (value < least || value > 1e9 || value != std::floor(value))
  {
    throw UsageError("\"" + argument + " " + text + "\": must be a whole number of at least " +
      std::to_string(least));
  }
  return int(value);
}

} // namespace

Terrain makeTerrain(
  const GroundSettings& settings, GridGeometry geometry, std::vector<double> heights)
{
  Terrain terrain(std::move(geometry), std::move(heights), settings.material, settings.roughness);
  terrain.setDeviationPer(settings.deviationPer);
  return terrain;
}

std::vector<std::string> settingNames()
{
  std::vector<std::string> names;
  for (const Setting& s : settings())
  {
    names.push_back(s.name + (*s.unit ? " (" + std::string(s.unit) + ")" : std::string()));
  }
  for (const YieldingField& f : yieldingFields())
  {
    names.push_back(f.property + (*f.unit ? " (" + std::string(f.unit) + ")" : std::string()));
  }
  return names;
}

void GroundSettings::setGround(const std::string& name)
{
  if (name == "hard")
  {
    // Found on 18 of the runs of Tschamut 2014.
    material = {};
    material.restitutionModel = RestitutionModel::NormalTangential;
    material.restitution = 0.3;
    material.tangentialRestitution = 0.875;
    material.frictionAngle = radians(46.0);
    roughness = {};
    deviationPer = DeviationPer::Iteration;
    return;
  }
  const GroundPreset& preset = groundPreset(name);
  material = preset.material();
  roughness = preset.roughness;
  deviationPer = preset.deviationPer();
}

void GroundSettings::set(const std::string& name, double value)
{
  const auto yielding = std::ranges::find_if(
    yieldingFields(), [&](const YieldingField& field) { return field.property == name; });
  if (yielding != yieldingFields().end())
  {
    yielding->set(material.yielding, value);
    material.validate();
    return;
  }
  const auto found =
    std::ranges::find_if(settings(), [&](const Setting& s) { return s.name == name; });
  if (found == settings().end())
  {
    std::string list;
    for (const std::string& known : settingNames())
    {
      list += (list.empty() ? "" : ", ") + known;
    }
    throw UsageError("there is no parameter \"" + name + "\"; there are " + list);
  }
  found->set(*this, value);
  material.validate();
  roughness.validate();
}

void GroundSettings::set(const std::string& assignment)
{
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos)
  {
    throw UsageError("\"" + assignment + "\" must be name=value");
  }
  this->set(assignment.substr(0, equals), number(assignment.substr(equals + 1), assignment));
}

bool Arguments::has(const std::string& name) const
{
  return std::ranges::find(switches, name) != switches.end();
}

Arguments parseArguments(int argumentCount, char** words, GroundSettings defaults,
  const std::vector<std::string>& switches, bool data)
{
  Arguments result;
  result.settings = std::move(defaults);
  SimulationParameters& p = result.settings.simulation;
  for (int k = 1; k < argumentCount; ++k)
  {
    const std::string word = words[k];
    const auto next = [&]
    {
      if (++k == argumentCount)
      {
        throw UsageError("\"" + word + "\" needs a value");
      }
      return std::string(words[k]);
    };
    if (word == "--ground")
    {
      result.settings.setGround(next());
    }
    else if (word == "--set")
    {
      result.settings.set(next());
    }
    else if (word == "--iterations")
    {
      p.iterations = count(next(), word, 2);
    }
    else if (word == "--seed")
    {
      p.seed = std::uint64_t(count(next(), word, 0));
    }
    else if (word == "--threads")
    {
      p.threads = count(next(), word, 0);
    }
    else if (word == "--output")
    {
      result.output = next();
    }
    else if (word == "--stops")
    {
      result.stops = next();
    }
    else if (std::ranges::find(switches, word) != switches.end())
    {
      result.switches.push_back(word);
    }
    else if (word.starts_with("--") || !data || !result.folder.empty())
    {
      throw UsageError("\"" + word + "\" is not understood");
    }
    else
    {
      result.folder = word;
    }
  }
  if (data && result.folder.empty())
  {
    throw UsageError("the folder of the field data is missing");
  }
  return result;
}

int runProgram(int (*run)(int, char**), int count, char** words)
{
  try
  {
    return run(count, words);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

} // namespace rockfall::calibration
