#include "gis/layers/FeatureRow.h"

#include "gis/base/gdal.h"

#include <cmath>

namespace rockfall::gis
{

void FeatureRow::failField(const std::string& name, const std::string& what) const
{
  this->fail("field \"" + name + "\"" + what);
}

std::optional<std::string> FeatureRow::text(const std::string& name) const
{
  return Fields::text({ name.c_str() });
}

std::optional<double> FeatureRow::number(const std::string& name) const
{
  return Fields::number({ name.c_str() });
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
