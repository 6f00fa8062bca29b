#include "gis/trust/heightReference.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "gis/base/gdal.h"

#include <ogr_spatialref.h>

#include <cmath>

namespace rockfall::gis
{

namespace
{

std::string key(const char* name)
{
  return letterKey(name ? name : "");
}

/// Datum of the heights; empty if it is not said.
std::string datumOf(const OGRSpatialReference& crs)
{
  const CrsPtr flat = horizontalCrs(&crs);
  std::string datum = key(crs.IsCompound() ? crs.GetAttrValue("COMPD_CS|VERT_CS|VERT_DATUM")
      : flat                               ? flat->GetAttrValue("DATUM")
                                           : nullptr);
  for (const char* nothing : { "unknown", "unnamed", "unspecified", "notspecified" })
  {
    if (datum.starts_with(nothing))
    {
      return {};
    }
  }
  return datum;
}

/// The vertical part alone.
OGRSpatialReference verticalPart(const OGRSpatialReference& crs)
{
  OGRSpatialReference part;
  const OGR_SRSNode* node = crs.GetAttrNode("COMPD_CS|VERT_CS");
  char* text = nullptr;
  if (node && node->exportToWkt(&text) == OGRERR_NONE)
  {
    const char* input = text;
    part.importFromWkt(&input);
  }
  CPLFree(text);
  return part;
}

bool isMetresUp(const OGRSpatialReference& crs)
{
  const auto axis = verticalAxis(&crs);
  return axis && !axis->down && std::abs(axis->metres - 1.0) < 1e-12;
}

} // namespace

std::optional<VerticalAxis> verticalAxis(const OGRSpatialReference* crs)
{
  if (!crs || crs->IsEmpty() || crs->IsGeocentric() || crs->GetAxesCount() != 3)
  {
    return std::nullopt;
  }
  OGRAxisOrientation direction = OAO_Other;
  double metres = 0.0;
  crs->GetAxis(nullptr, 2, &direction, &metres);
  if ((direction != OAO_Up && direction != OAO_Down) || !(metres > 0.0) || !std::isfinite(metres))
  {
    return std::nullopt;
  }
  return VerticalAxis{ metres, direction == OAO_Down };
}

CrsPtr heightCrs(const OGRSpatialReference* crs)
{
  if (!verticalAxis(crs) || crs->IsLocal() || datumOf(*crs).empty())
  {
    return nullptr;
  }
  auto copy = std::make_shared<OGRSpatialReference>(*crs);
  copy->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return copy;
}

CrsPtr heightCrsFromText(const std::string& text)
{
  OGRSpatialReference crs;
  return !text.empty() &&
      crs.SetFromUserInput(
        text.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) == OGRERR_NONE
    ? heightCrs(&crs)
    : nullptr;
}

std::string referenceLabel(const OGRSpatialReference& crs)
{
  const auto orUnnamed = [](const char* name)
  { return std::string(name && *name ? name : "an unnamed reference"); };
  if (!crs.IsCompound())
  {
    const CrsPtr flat = horizontalCrs(&crs);
    const char* base = flat->GetAttrValue("GEOGCS");
    return "the ellipsoid of " + orUnnamed(base ? base : crs.GetName());
  }
  const char* code = crs.GetAuthorityCode("COMPD_CS|VERT_CS");
  return orUnnamed(crs.GetAttrValue("COMPD_CS|VERT_CS")) +
    (code ? std::string(" (EPSG:") + code + ")" : std::string());
}

bool sameReference(const OGRSpatialReference& one, const OGRSpatialReference& other)
{
  return one.IsCompound() == other.IsCompound() && datumOf(one) == datumOf(other);
}

std::string crsWkt(const CrsPtr& horizontal, const CrsPtr& heights)
{
  if (!horizontal || !heights)
  {
    return horizontal ? crsWkt(*horizontal) : std::string();
  }
  OGRSpatialReference whole(*horizontal);
  if (!heights->IsCompound())
  {
    whole.PromoteTo3D(nullptr);
    return crsWkt(whole);
  }
  OGRSpatialReference part = verticalPart(*heights);
  std::string name = part.GetName() ? part.GetName() : "height";
  if (!isMetresUp(*heights))
  {
    const char* datum = heights->GetAttrValue("COMPD_CS|VERT_CS|VERT_DATUM");
    name = std::string(datum ? datum : "unknown") + " height";
    part.Clear();
    part.SetVertCS(name.c_str(), datum);
  }
  const std::string both = std::string(whole.GetName() ? whole.GetName() : "") + " + " + name;
  OGRSpatialReference compound;
  if (compound.SetCompoundCS(both.c_str(), &whole, &part) != OGRERR_NONE)
  {
    return crsWkt(*horizontal);
  }
  return crsWkt(compound);
}

struct HeightChange::Way
{
  std::string fileName;
  std::string from, to; // labels
  double unit = 1.0;    // m upwards per unit of the layer's axis
  std::unique_ptr<OGRCoordinateTransformation> change;

  [[noreturn]] void fail() const
  {
    throw DataError(fileName + ": its heights refer to " + from + ", those of the slope to " + to +
      ", and PROJ has no way from the one to the other here (a grid that is not installed?); bring "
      "them to the slope's first, or leave them out and say the \"height\" over ground");
  }
};

HeightChange::HeightChange(const std::string& fileName, const CrsPtr& from, const std::string& to,
  bool implied, std::vector<std::string>& notes)
{
  if (!from)
  {
    return;
  }
  const CrsPtr target = heightCrsFromText(to);
  if (!target && implied)
  {
    return;
  }
  if (!target)
  {
    notes.push_back(fileName + ": its heights refer to " + referenceLabel(*from) +
      "; nothing says what those of the slope refer to. They were taken to be the same.");
    return;
  }
  if (sameReference(*from, *target))
  {
    return;
  }
  auto way = std::make_shared<Way>();
  way->fileName = fileName;
  way->from = referenceLabel(*from);
  way->to = referenceLabel(*target);
  const VerticalAxis axis = *verticalAxis(from.get());
  way->unit = axis.down ? -axis.metres : axis.metres;
  OGRCoordinateTransformationOptions options;
  options.SetBallparkAllowed(false); // which would leave the heights as they are
  way->change.reset(OGRCreateCoordinateTransformation(from.get(), target.get(), options));
  if (!way->change && implied)
  {
    notes.push_back(fileName + ": its heights refer to " + way->from + ", those of the slope to " +
      way->to + ", and PROJ has no way from the one to the other. They were taken as they are.");
    return;
  }
  if (!way->change)
  {
    way->fail();
  }
  notes.push_back(fileName + ": its heights were brought from " + way->from + " to " + way->to +
    ", to which those of the slope refer.");
  way_ = std::move(way);
}

double HeightChange::operator()(double x, double y, double height) const
{
  if (!way_ || std::isnan(height))
  {
    return height;
  }
  double z = height / way_->unit;
  int done = 0;
  if (!way_->change->Transform(1, &x, &y, &z, &done) || !done || !std::isfinite(z))
  {
    way_->fail();
  }
  return z;
}

} // namespace rockfall::gis
