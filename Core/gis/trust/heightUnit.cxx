#include "gis/trust/heightUnit.h"

#include "base/text/lengthUnit.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace rockfall::gis
{

namespace
{

/// A unit of height by its name alone: one of length, or the geopotential metre.
std::optional<double> byName(const std::string& name)
{
  return name == "gpm" ? 1.0 : lengthUnit(name);
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
      return std::string(trimmed(name.substr(0, name.size() - std::string(over).size())));
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
  std::string rest(trimmed(std::string(end, name.data() + name.size())));
  rest = rest.starts_with("*") ? std::string(trimmed(rest.substr(1))) : rest;
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

std::string unitsText(double metres)
{
  return isFoot(metres) ? "feet" : "units of " + number(metres) + " m";
}

} // namespace rockfall::gis
