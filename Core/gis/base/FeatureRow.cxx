#include "gis/base/FeatureRow.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"

#include <cpl_json.h>

#include <cmath>

namespace rockfall::gis
{

namespace
{

bool isNumeric(const OGRFieldDefn& field)
{
  const OGRFieldType type = field.GetType();
  return type == OFTReal || type == OFTInteger || type == OFTInteger64;
}

} // namespace

FeatureRow::FeatureRow(
  const std::string& fileName, const Columns& columns, const OGRFeature& feature, std::int64_t row)
  : fileName_(fileName)
  , columns_(columns)
  , feature_(feature)
  , row_(row)
{
}

void FeatureRow::fail(const std::string& what) const
{
  throw DataError(this->where() + ": " + what);
}

void FeatureRow::failField(const std::string& name, const std::string& what) const
{
  this->fail("field \"" + name + "\"" + what);
}

void FeatureRow::failAbsent(const std::string& name, const std::string& rest, const char* of) const
{
  this->failField(name,
    (this->has(name) ? " is empty"
                     : std::string(" is missing: the ") + of + " has no such column") +
      rest);
}

void FeatureRow::refuseLostText(const Messages& messages) const
{
  if (!messages.lostText().empty())
  {
    this->fail(messages.lostText());
  }
}

std::string FeatureRow::nameOf(int column) const
{
  return feature_.GetFieldDefnRef(column)->GetNameRef();
}

bool FeatureRow::isTruth(int column) const
{
  const OGRFieldDefn& field = *feature_.GetFieldDefnRef(column);
  if (field.GetSubType() == OFSTBoolean)
  {
    return true;
  }
  const char* const json = isNumeric(field) ? feature_.GetNativeData() : nullptr;
  const double value = json ? feature_.GetFieldAsDouble(column) : 0.0;
  if (!json || (value != 0.0 && value != 1.0))
  {
    return false;
  }
  CPLJSONDocument document;
  return document.LoadMemory(json) &&
    document.GetRoot().GetObj("properties").GetObj(field.GetNameRef()).GetType() ==
    CPLJSONObject::Type::Boolean;
}

std::optional<std::string> FeatureRow::textAt(int column) const
{
  if (!feature_.IsFieldSetAndNotNull(column))
  {
    return std::nullopt;
  }
  if (this->isTruth(column))
  {
    return feature_.GetFieldAsInteger(column) ? "true" : "false";
  }
  const std::string value(trimmed(feature_.GetFieldAsString(column)));
  if (!isUtf8(value))
  {
    this->failField(this->nameOf(column),
      ": its text is not UTF-8; save the file so, or name its encoding, as windows-1252, in a "
      ".cpg file beside it");
  }
  return value.empty() ? std::nullopt : std::optional(value);
}

std::optional<double> FeatureRow::numberAt(int column) const
{
  const auto written = this->textAt(column);
  if (!written)
  {
    return std::nullopt;
  }
  // A field of numbers is taken as such: its text is rounded.
  const auto value =
    isNumeric(*feature_.GetFieldDefnRef(column)) && *written != "true" && *written != "false"
    ? std::optional(feature_.GetFieldAsDouble(column))
    : parsedNumber(*written);
  if (!value)
  {
    const bool comma = written->find(',') != std::string::npos;
    this->failField(this->nameOf(column),
      ": \"" + *written + "\" is not a number" + (comma ? " (the decimal sign is a point)" : ""));
  }
  if (!std::isfinite(*value))
  {
    this->failField(this->nameOf(column), " is " + *written + ", it must be finite");
  }
  return value;
}

std::optional<int> FeatureRow::columnOf(std::initializer_list<const char*> names) const
{
  std::optional<int> taken;
  for (const char* name : names)
  {
    const auto column = columns_.find(name);
    const auto text = column != columns_.end() ? this->textAt(column->second) : std::nullopt;
    if (!text)
    {
      continue;
    }
    if (taken && *text != *this->textAt(*taken))
    {
      this->failField(this->nameOf(*taken),
        " is " + *this->textAt(*taken) + " and field \"" + this->nameOf(column->second) +
          "\", which is the same by another name, " + *text + "; leave out one of them");
    }
    taken = taken ? taken : column->second;
  }
  return taken;
}

std::optional<std::string> FeatureRow::text(std::initializer_list<const char*> names) const
{
  const auto column = this->columnOf(names);
  return column ? this->textAt(*column) : std::nullopt;
}

std::optional<double> FeatureRow::number(std::initializer_list<const char*> names) const
{
  const auto column = this->columnOf(names);
  return column ? this->numberAt(*column) : std::nullopt;
}

std::optional<double> FeatureRow::ranged(
  std::initializer_list<const char*> names, double low, double high, const char* range) const
{
  const auto column = this->columnOf(names);
  if (!column)
  {
    return std::nullopt;
  }
  const auto value = this->numberAt(*column);
  if (!(*value >= low && *value <= high))
  {
    this->failField(this->nameOf(*column), " is " + gis::number(*value) + ", it must be " + range);
  }
  return value;
}

std::optional<double> FeatureRow::positive(const char* name) const
{
  const auto value = this->number(name);
  if (value && !(*value > 0.0))
  {
    this->failField(name, " is " + gis::number(*value) + ", it must be above 0");
  }
  return value;
}

std::optional<double> FeatureRow::notNegative(const char* name) const
{
  const auto value = this->number(name);
  if (value && !(*value >= 0.0))
  {
    this->failField(name, " is " + gis::number(*value) + ", it must be at least 0");
  }
  return value;
}

std::optional<std::int64_t> FeatureRow::count(const char* name) const
{
  const auto value = this->notNegative(name);
  if (value && (*value != std::floor(*value) || *value > 0x1p53))
  {
    this->failField(name, " is " + gis::number(*value) + ", it must be a whole number");
  }
  return value ? std::optional(std::int64_t(*value)) : std::nullopt;
}

double FeatureRow::needed(const char* name) const
{
  const auto value = this->number(name);
  if (!value)
  {
    this->failAbsent(name,
      std::string(", and the row has no ") + (*name == 'z' ? "elevation" : "point") +
        " of its own");
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
    if (!straight_) // who asked before still has it
    {
      straight_.reset(geometry->getLinearGeometry());
    }
    geometry = straight_.get();
  }
  return geometry && !geometry->IsEmpty() ? geometry : nullptr;
}

} // namespace rockfall::gis
