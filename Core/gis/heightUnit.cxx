#include "gis/heightUnit.h"

#include "base/nameKey.h"
#include "gis/fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>

namespace rockfall::gis
{

namespace
{

struct Unit
{
  double metres;
  std::initializer_list<const char*> names; // lowered, blanks for underscores
};

/// A length by the name of its unit alone.
std::optional<double> byName(const std::string& name)
{
  static const Unit units[] = {
    { 1.0, { "m", "metre", "metres", "meter", "meters", "gpm" } },
    { kFoot,
      { "ft", "foot", "feet", "international foot", "international feet", "foot (international)",
        "feet (international)" } },
    { kSurveyFoot,
      { "us survey foot", "us survey feet", "us-ft", "ftus", "sft", "foot us", "feet us", "us foot",
        "us feet", "u.s. survey foot", "u.s. survey feet", "survey foot", "survey feet",
        "foot (us)", "feet (us)", "ft us", "us ft", "usft", "ft (us)", "foot (us survey)",
        "us survey foot (ftus)" } },
    { 0.01, { "cm", "centimetre", "centimeter", "centimetres", "centimeters" } },
    { 0.1, { "dm", "decimetre", "decimeter", "decimetres", "decimeters" } },
    { 0.001, { "mm", "millimetre", "millimeter", "millimetres", "millimeters" } },
    { 1000.0, { "km", "kilometre", "kilometer", "kilometres", "kilometers" } },
    { 3.0 * kFoot, { "yd", "yard", "yards" } },
    { kFoot / 12.0, { "in", "inch", "inches" } },
  };
  for (const Unit& unit : units)
  {
    for (const char* known : unit.names)
    {
      if (name == known)
      {
        return unit.metres;
      }
    }
  }
  return std::nullopt;
}

/// Lowered, without brackets about it, with blanks for underscores and without what it is over.
std::string plain(const std::string& unit)
{
  std::string name = nameKey(unit);
  if (name.size() > 2 && name.front() == '[' && name.back() == ']')
  {
    name = trimmed(name.substr(1, name.size() - 2));
  }
  std::replace(name.begin(), name.end(), '_', ' ');
  for (const char* over : { " above mean sea level", " above sea level", " above msl", " a.s.l.",
         " a.s.l", " asl", " amsl" })
  {
    if (name.ends_with(over))
    {
      return trimmed(name.substr(0, name.size() - std::string(over).size()));
    }
  }
  return name;
}

} // namespace

std::optional<double> metresPer(const std::string& unit)
{
  const std::string name = plain(unit);
  if (const auto metres = byName(name))
  {
    return metres;
  }
  double factor = 0.0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), factor);
  if (error != std::errc() || !(factor > 0.0) || !std::isfinite(factor))
  {
    return std::nullopt;
  }
  std::string rest = trimmed(std::string(end, name.data() + name.size()));
  rest = rest.starts_with("*") ? trimmed(rest.substr(1)) : rest;
  const auto metres = byName(rest);
  return metres ? std::optional(factor * *metres) : std::nullopt;
}

bool isNoUnit(const std::string& unit)
{
  const std::string name = plain(unit);
  return name.empty() || name == "unknown" || name == "unspecified" || name == "none" ||
    name == "undefined" || name == "n/a";
}

bool isFoot(double metres)
{
  return std::abs(metres - kFoot) < 1e-3 * kFoot;
}

} // namespace rockfall::gis
