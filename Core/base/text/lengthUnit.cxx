#include "base/text/lengthUnit.h"

#include <initializer_list>

namespace rockfall
{

namespace
{

struct Unit
{
  double metres;
  std::initializer_list<const char*> names; // lowered, blanks for underscores
};

} // namespace

std::optional<double> lengthUnit(std::string_view name)
{
  static const Unit units[] = {
    { 1.0, { "m", "metre", "metres", "meter", "meters" } },
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

} // namespace rockfall
