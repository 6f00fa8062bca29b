#include "gis/FeatureRow.h"

#include "base/errors.h"
#include "gis/gdal.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace rockfall::gis
{

namespace
{

/// All of the text, with a decimal point in every locale; nothing if any of it is no number.
std::optional<double> parsed(const std::string& text)
{
  const char* first = text.data() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
  const char* const last = text.data() + text.size();
  double value = 0.0;
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last ? std::optional(value) : std::nullopt;
}

} // namespace

Columns columnsOf(const OGRFeatureDefn& definition)
{
  Columns columns;
  for (int i = 0; i < definition.GetFieldCount(); ++i)
  {
    std::string name = trimmed(definition.GetFieldDefn(i)->GetNameRef());
    // ASCII only, on purpose: tolower would ask the locale.
    std::transform(name.begin(), name.end(), name.begin(),
      [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    columns.emplace(name, i); // the first of two that differ in case only
  }
  return columns;
}

std::string trimmed(const std::string& text)
{
  const char* const blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  return first == std::string::npos ? std::string()
                                    : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

void FeatureRow::fail(const std::string& what) const
{
  throw DataError(fileName_ + ", row " + std::to_string(number_) + ": " + what);
}

void FeatureRow::failField(const std::string& name, const std::string& what) const
{
  this->fail("field \"" + name + "\"" + what);
}

std::optional<std::string> FeatureRow::text(const std::string& name) const
{
  const auto column = columns_.find(name);
  if (column == columns_.end() || !feature_.IsFieldSetAndNotNull(column->second))
  {
    return std::nullopt;
  }
  const std::string value = trimmed(feature_.GetFieldAsString(column->second));
  return value.empty() ? std::nullopt : std::optional(value);
}

std::optional<double> FeatureRow::number(const std::string& name) const
{
  const auto written = this->text(name);
  if (!written)
  {
    return std::nullopt;
  }
  const int column = columns_.at(name);
  const OGRFieldType type = feature_.GetFieldDefnRef(column)->GetType();
  // A field of numbers is taken as such: its text is rounded.
  const auto value = type == OFTReal || type == OFTInteger || type == OFTInteger64
    ? std::optional(feature_.GetFieldAsDouble(column))
    : parsed(*written);
  if (!value)
  {
    const bool comma = written->find(',') != std::string::npos;
    this->failField(name,
      ": \"" + *written + "\" is not a number" + (comma ? " (the decimal sign is a point)" : ""));
  }
  if (!std::isfinite(*value))
  {
    this->failField(name, " is " + *written + ", it must be finite");
  }
  return value;
}

std::optional<double> FeatureRow::positive(const std::string& name) const
{
  const auto value = this->number(name);
  if (value && !(*value > 0.0))
  {
    this->failField(name, " is " + gis::number(*value) + ", it must be above 0");
  }
  return value;
}

std::optional<double> FeatureRow::notNegative(const std::string& name) const
{
  const auto value = this->number(name);
  if (value && !(*value >= 0.0))
  {
    this->failField(name, " is " + gis::number(*value) + ", it must be at least 0");
  }
  return value;
}

std::optional<std::int64_t> FeatureRow::count(const std::string& name) const
{
  const auto value = this->notNegative(name);
  if (value && (*value != std::floor(*value) || *value > 0x1p53))
  {
    this->failField(name, " is " + gis::number(*value) + ", it must be a whole number");
  }
  return value ? std::optional(std::int64_t(*value)) : std::nullopt;
}

double FeatureRow::needed(const std::string& name) const
{
  const auto value = this->number(name);
  if (!value)
  {
    this->failField(name,
      std::string(" is ") + (this->has(name) ? "empty" : "missing: the layer has no such column") +
        ", and the row has no " + (name == "z" ? "elevation" : "point") + " of its own");
  }
  return *value;
}

std::optional<Vec3> FeatureRow::vector(const std::array<const char*, 3>& names) const
{
  std::optional<Vec3> result;
  for (int i = 0; i < 3; ++i)
  {
    if (const auto value = this->number(names[i]))
    {
      result = result.value_or(Vec3::Zero());
      (*result)[i] = *value;
    }
  }
  return result;
}

std::optional<Vec3> FeatureRow::lengths() const
{
  const auto x = this->positive("lx"), y = this->positive("ly"), z = this->positive("lz");
  if (!x && !y && !z)
  {
    return std::nullopt;
  }
  if (!x || !y || !z)
  {
    this->failField(!x ? "lx" : !y ? "ly" : "lz", " is empty; a box needs all of lx, ly and lz");
  }
  return Vec3(*x, *y, *z);
}

const OGRGeometry* FeatureRow::geometry() const
{
  const OGRGeometry* geometry = feature_.GetGeometryRef();
  if (geometry && geometry->hasCurveGeometry())
  {
    straight_.reset(geometry->getLinearGeometry());
    geometry = straight_.get();
  }
  return geometry && !geometry->IsEmpty() ? geometry : nullptr;
}

} // namespace rockfall::gis
