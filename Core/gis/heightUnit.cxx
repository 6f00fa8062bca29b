#include "gis/heightUnit.h"

#include <cpl_port.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace rockfall::gis
{

namespace
{

constexpr double foot = 0.3048;                // m, international
constexpr double surveyFoot = 1200.0 / 3937.0; // m, United States

} // namespace

std::optional<double> metresPer(const std::string& unit)
{
  const auto is = [&unit](std::initializer_list<const char*> names)
  {
    return std::any_of(
      names.begin(), names.end(), [&unit](const char* name) { return EQUAL(unit.c_str(), name); });
  };
  if (is({ "m", "[m]", "metre", "metres", "meter", "meters" }))
  {
    return 1.0;
  }
  if (is({ "ft", "foot", "feet", "[ft]", "international foot", "international feet",
        "foot (international)", "feet (international)" }))
  {
    return foot;
  }
  if (is({ "us survey foot", "us survey feet", "us_survey_foot", "us-ft", "ftus", "sft", "foot_us",
        "us foot", "u.s. survey foot", "survey foot", "foot (us)", "feet (us)", "ft us", "usft",
        "ft (us)", "foot (us survey)", "us survey foot (ftus)" }))
  {
    return surveyFoot;
  }
  if (is({ "cm", "centimetre", "centimeter", "centimetres", "centimeters" }))
  {
    return 0.01;
  }
  if (is({ "dm", "decimetre", "decimeter", "decimetres", "decimeters" }))
  {
    return 0.1;
  }
  if (is({ "mm", "millimetre", "millimeter" }))
  {
    return 0.001;
  }
  if (is({ "km", "kilometre", "kilometer", "kilometres", "kilometers" }))
  {
    return 1000.0;
  }
  return std::nullopt;
}

bool isInFeet(const OGRSpatialReference& crs)
{
  const double metres = crs.IsProjected() ? crs.GetLinearUnits() : 1.0;
  return std::abs(metres - foot) < 1e-3 * foot;
}

} // namespace rockfall::gis
