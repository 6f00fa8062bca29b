#include "gis/base/crs.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "gis/base/planAccuracy.h"

#include <cpl_conv.h>
#include <gdal_alg.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace rockfall::gis
{

namespace
{

OGRSpatialReferenceH handle(const CrsPtr& crs)
{
  // The C interface knows no const; the transformer makes its own copy.
  return OGRSpatialReference::ToHandle(const_cast<OGRSpatialReference*>(crs.get()));
}

std::shared_ptr<OGRSpatialReference> empty()
{
  auto crs = std::make_shared<OGRSpatialReference>();
  crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

} // namespace

const OGRSpatialReference* definedCrs(const OGRSpatialReference* crs)
{
  const char* const name = crs ? crs->GetName() : nullptr;
  return name && nameKey(name).starts_with("undefined") ? nullptr : crs;
}

CrsPtr horizontalCrs(const OGRSpatialReference* given)
{
  const OGRSpatialReference* const crs = definedCrs(given);
  if (!crs || crs->IsEmpty())
  {
    return nullptr;
  }
  auto copy = std::make_shared<OGRSpatialReference>(*crs);
  if (copy->IsCompound())
  {
    copy->StripVertical();
  }
  if (copy->IsVertical())
  {
    return nullptr; // heights alone
  }
  if (copy->GetAxesCount() == 3 && !copy->IsGeocentric())
  {
    copy->DemoteTo2D(nullptr);
  }
  copy->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return copy;
}

CrsPtr crsFromEpsg(int code)
{
  auto crs = empty();
  if (crs->importFromEPSG(code) != OGRERR_NONE)
  {
    throw DataError("PROJ's database does not know EPSG:" + std::to_string(code));
  }
  return crs;
}

CrsPtr crsFromText(const std::string& text)
{
  auto crs = empty();
  // No names of files, no addresses.
  if (crs->SetFromUserInput(
        text.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) != OGRERR_NONE)
  {
    throw DataError("\"" + text + "\" is not a coordinate reference system that PROJ knows");
  }
  return horizontalCrs(crs.get());
}

std::string crsLabel(const OGRSpatialReference& crs)
{
  const char* name = crs.GetName();
  std::string text = name && *name ? name : "unnamed CRS";
  const char* authority = crs.GetAuthorityName(nullptr);
  const char* code = crs.GetAuthorityCode(nullptr);
  if (authority && code)
  {
    return std::string(authority) + ":" + code + " (" + text + ")";
  }
  return text;
}

std::string crsWkt(const OGRSpatialReference& crs)
{
  const char* const options[] = { "FORMAT=WKT2_2019", "MULTILINE=NO", nullptr };
  char* text = nullptr;
  crs.exportToWkt(&text, options);
  std::string result = text ? text : "";
  CPLFree(text);
  return result;
}

std::string backwardAxes(const OGRSpatialReference& crs)
{
  OGRAxisOrientation axes[2] = { OAO_Other, OAO_Other };
  for (int k = 0; k < 2; ++k)
  {
    crs.GetAxis(nullptr, k, &axes[k]);
  }
  std::string text;
  for (const OGRAxisOrientation axis : axes)
  {
    if (!crs.IsGeographic() && axes[0] != axes[1] && (axis == OAO_West || axis == OAO_South))
    {
      text += (text.empty() ? "" : " and ") + std::string(axis == OAO_West ? "west" : "south");
    }
  }
  return text;
}

int utmCode(double longitude, double latitude)
{
  if (latitude > 84.0)
  {
    return 32661;
  }
  if (latitude < -80.0)
  {
    return 32761;
  }
  const double wrapped = longitude - 360.0 * std::floor((longitude + 180.0) / 360.0); // [−180, 180)
  int zone = std::clamp(int(std::floor((wrapped + 180.0) / 6.0)) + 1, 1, 60);
  if (latitude >= 56.0 && latitude < 64.0 && wrapped >= 3.0 && wrapped < 12.0)
  {
    zone = 32; // south-western Norway
  }
  else if (latitude >= 72.0 && wrapped >= 0.0 && wrapped < 42.0)
  {
    zone = wrapped < 9.0 ? 31 : wrapped < 21.0 ? 33 : wrapped < 33.0 ? 35 : 37; // Svalbard
  }
  return (latitude < 0.0 ? 32700 : 32600) + zone;
}

CrsChange::CrsChange(const CrsPtr& from, const CrsPtr& to, double tolerance)
{
  if (!from || !to || from == to || from->IsSame(to.get()))
  {
    return;
  }
  exact_.reset(GDALCreateReprojectionTransformerEx(handle(from), handle(to), nullptr),
    [](void* transformer)
    {
      if (transformer)
      {
        GDALDestroyReprojectionTransformer(transformer);
      }
    });
  if (!exact_)
  {
    throw DataError("there is no way from " + crsLabel(*from) + " to " + crsLabel(*to));
  }
  if (tolerance > 0.0)
  {
    interpolated_.reset(
      GDALCreateApproxTransformer(GDALReprojectionTransform, exact_.get(), tolerance),
      GDALDestroyApproxTransformer);
  }
}

bool CrsChange::apply(bool inverse, int count, double* x, double* y) const
{
  if (!exact_)
  {
    return true;
  }
  std::vector<double> z(std::size_t(count), 0.0);
  std::vector<int> done(std::size_t(count), 0);
  // The interpolation's error is counted in the units of what comes out: good for the way back
  // only.
  if (inverse && interpolated_)
  {
    GDALApproxTransform(interpolated_.get(), 1, count, x, y, z.data(), done.data());
  }
  else
  {
    GDALReprojectionTransform(exact_.get(), inverse, count, x, y, z.data(), done.data());
  }
  bool all = true;
  for (int i = 0; i < count; ++i)
  {
    if (!done[i] || !std::isfinite(x[i]) || !std::isfinite(y[i]))
    {
      x[i] = y[i] = std::numeric_limits<double>::quiet_NaN();
      all = false;
    }
  }
  return all;
}

CrsChange layerChange(const std::string& fileName, const CrsPtr& from, const CrsPtr& to,
  std::vector<std::string>& notes)
{
  try
  {
    CrsChange change(from, to);
    noteRoughWay(fileName, from, to, notes);
    return change;
  }
  catch (const DataError& error)
  {
    throw DataError(fileName + ": " + error.what());
  }
}

} // namespace rockfall::gis
