#include "gis/raster/rasterPlace.h"

#include "base/errors.h"
#include "gis/base/gdal.h"
#include "gis/trust/gridAxes.h"
#include "gis/trust/otherPlaces.h"
#include "gis/trust/rawSize.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>

namespace rockfall::gis
{

namespace
{

/// Cells from the origin of the coordinates: beyond it double precision takes them together.
constexpr double farthest = 1e12;

void multiply(std::array<double, 6>& affine, double factor)
{
  std::for_each(affine.begin(), affine.end(), [factor](double& a) { a *= factor; });
}

/// Of a raster whose file has no geotransform.
void placeOtherwise(
  GDALDataset& dataset, const GridAxes& axes, const std::string& fileName, RasterPlace& place)
{
  if (axes.place)
  {
    place.affine = axes.place->affine;
    place.crs = place.crs ? place.crs : axes.place->inDegrees ? crsFromEpsg(4326) : nullptr;
  }
  else if (dataset.GetGCPCount() > 0)
  {
    if (!GDALGCPsToGeoTransform(
          dataset.GetGCPCount(), dataset.GetGCPs(), place.affine.data(), FALSE))
    {
      throw DataError(fileName + ": its " + std::to_string(dataset.GetGCPCount()) +
        " ground control points fit no straight grid; warp it first, e.g. with gdalwarp -tps");
    }
    place.crs = horizontalCrs(dataset.GetGCPSpatialRef());
  }
  else if (dataset.GetMetadata("GEOLOCATION") || dataset.GetMetadata("RPC"))
  {
    throw DataError(fileName + ": is placed by a geolocation array or RPCs and not by a grid; " +
      "warp it first with gdalwarp");
  }
  else
  {
    place.georeferenced = false;
    place.affine = { 0.0, 1.0, 0.0, double(dataset.GetRasterYSize()), 0.0, -1.0 };
  }
}

} // namespace

TextGrid checkContent(GDALDataset& dataset, const std::string& fileName)
{
  requireSubstance(dataset, fileName);
  TextGrid text = checkTextGrid(dataset, fileName);
  checkRawSize(dataset, fileName);
  return text;
}

RasterPlace rasterPlace(GDALDataset& dataset, GDALRasterBand& band, const TextGrid& text,
  const std::string& fileName, std::vector<std::string>& notes)
{
  RasterPlace place;
  std::array<double, 6>& affine = place.affine;
  place.crs = horizontalCrs(dataset.GetSpatialRef());
  const bool placed = dataset.GetGeoTransform(affine.data()) == CE_None;
  if (placed && text.corner)
  {
    affine[0] = (*text.corner)[0];
    affine[3] = (*text.corner)[1] - dataset.GetRasterYSize() * affine[5];
    notes.emplace_back(
      "The header gives a corner along one axis and the centre of a cell along the "
      "other; each was taken as it says.");
  }
  if (placed)
  {
    noteOtherPlaces(dataset, affine, place.crs, notes);
  }
  const GridAxes axes = checkAxes(dataset, band, placed, fileName, notes);
  if (!place.crs && axes.metres != 1.0)
  {
    place.metres = axes.metres;
    if (placed)
    {
      multiply(affine, axes.metres);
    }
    notes.push_back("The coordinates in \"" + axes.unit + "\" were multiplied by " +
      number(axes.metres) + " to be metres.");
  }
  if (!placed)
  {
    placeOtherwise(dataset, axes, fileName, place);
  }
  double unused[6];
  if (!std::all_of(affine.begin(), affine.end(), [](double a) { return std::isfinite(a); }) ||
    !GDALInvGeoTransform(affine.data(), unused))
  {
    throw DataError(fileName + ": its cells have no area: geotransform " + number(affine[0]) +
      ", " + number(affine[1]) + ", " + number(affine[2]) + ", " + number(affine[3]) + ", " +
      number(affine[4]) + ", " + number(affine[5]));
  }
  const double step = std::hypot(affine[1], affine[4]);
  if (std::max(std::abs(affine[0]), std::abs(affine[3])) > farthest * step)
  {
    throw DataError(fileName + ": its cells of " + number(step) + " at " + number(affine[0]) +
      ", " + number(affine[3]) + " cannot be told apart: is its place right?");
  }
  if (place.crs && place.crs->IsGeocentric())
  {
    throw DataError(fileName + ": its CRS " + crsLabel(*place.crs) + " is geocentric, not a map");
  }
  if (place.crs && place.crs->IsLocal())
  {
    const char* unit = nullptr;
    const double metres = place.crs->GetLinearUnits(&unit);
    if (metres > 0.0 && std::abs(metres - 1.0) > 1e-9)
    {
      multiply(affine, metres);
      place.metres = metres;
      notes.push_back("The local coordinates in " + std::string(unit ? unit : "unnamed units") +
        " were multiplied by " + number(metres) + " to be metres.");
    }
    place.crs.reset();
  }
  return place;
}

RasterPlace placeOfCells(
  GDALDataset& dataset, const std::string& fileName, std::vector<std::string>& notes)
{
  const TextGrid text = checkContent(dataset, fileName);
  if (!text.nulls.empty())
  {
    throw DataError(fileName + ": has a word for nodata; give NODATA_value a number");
  }
  std::vector<std::string> told;
  const RasterPlace place = rasterPlace(dataset, *dataset.GetRasterBand(1), text, fileName, told);
  for (const std::string& note : told)
  {
    notes.push_back(fileName + ": " + note);
  }
  if (!place.georeferenced)
  {
    throw DataError(fileName + ": has no georeferencing, so nobody knows where its cells are");
  }
  return place;
}

} // namespace rockfall::gis
