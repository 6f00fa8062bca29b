#include "gis/raster/raster.h"

#include "base/require.h"
#include "gis/base/crs.h"
#include "gis/base/gdal.h"
#include "gis/base/planAccuracy.h"
#include "gis/raster/metric.h"
#include "gis/raster/rasterFile.h"
#include "gis/raster/relief.h"
#include "gis/raster/resample.h"
#include "gis/trust/heightReference.h"

#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

using namespace gis;

/// Mean over neighbours in rows of |Δz| / cell: a tangent, if both are in the same unit.
double meanSteepness(const SourceGrid& grid)
{
  double sum = 0.0;
  std::int64_t pairs = 0;
  for (std::size_t i = 1; i < grid.heights.size(); ++i)
  {
    const double rise = std::abs(grid.heights[i] - grid.heights[i - 1]);
    if (i % grid.columns != 0 && !std::isnan(rise))
    {
      sum += rise;
      ++pairs;
    }
  }
  return pairs > 0 ? sum / double(pairs) / grid.columnStep() : 0.0;
}

std::string cellText(const SourceGrid& grid, const std::string& unit)
{
  const std::string column = number(grid.columnStep());
  return (grid.isSquare() ? column : column + " x " + number(grid.rowStep())) + " " + unit;
}

std::string methodText(const Resampling& how)
{
  if (how.samples == 1)
  {
    return "bilinear";
  }
  return "each the mean of " + sizeText(how.samples, how.samples) + " bilinear heights in its cell";
}

bool sameCell(double a, double b)
{
  return std::abs(a - b) <= 1e-9 * std::abs(b);
}

int samplesFor(double cellSize, double sourceCell)
{
  return int(std::clamp(std::round(cellSize / sourceCell), 1.0, 1e6));
}

/// To another CRS, in nodes at whole multiples of the cell size.
void reproject(SourceGrid& grid, const CrsPtr& crs, const Destination& to, double wanted,
  const std::string& fileName, RasterSurface& result)
{
  const double sourceCell =
    std::sqrt(std::abs(grid.affine[1] * grid.affine[5] - grid.affine[2] * grid.affine[4]));
  // 1/10000 of a cell: 3 mm for cells of 30 m.
  const CrsChange change(crs, to.target, 1e-4 * sourceCell);
  noteRoughWay(fileName, crs, to.target, result.notes);
  if (crs->IsGeographic())
  {
    grid.period = 2.0 * std::numbers::pi / crs->GetAngularUnits();
  }
  const auto steps = centreSteps(grid, change);
  const double suggested = std::sqrt(steps[0] * steps[1]); // as many nodes as the file has
  if (!(suggested > 0.0) || !std::isfinite(suggested))
  {
    throw DataError(fileName + ": its centre cannot be brought to " + crsLabel(*to.target));
  }
  Resampling how;
  how.cellSize = wanted > 0.0 ? wanted : threeDigits(suggested);
  how.samples = samplesFor(how.cellSize, suggested);
  how.snap = true;
  const double longest = std::max(steps[0] * grid.columns, steps[1] * grid.rows);
  if (longest > largestExtent)
  {
    throw DataError(fileName + ": its extent of " + number(longest / 1000.0) +
      " km is too large for " + crsLabel(*to.target) +
      "; cut out the slope first, e.g. with "
      "gdal_translate -projwin");
  }
  result.geometry = layOut(grid, change, how, fileName);
  result.heights = resample(grid, change, how, result.geometry);

  const char* unit = nullptr;
  crs->IsGeographic() ? crs->GetAngularUnits(&unit) : crs->GetLinearUnits(&unit);
  result.notes.push_back("Reprojected because " + to.reason + ": from " + crsLabel(*crs) + ", " +
    sizeText(grid.columns, grid.rows) + " nodes of " + cellText(grid, unit ? unit : "") + ", to " +
    crsLabel(*to.target) + ", " + sizeText(result.geometry.columns, result.geometry.rows) +
    " nodes of " + number(how.cellSize) + " m, " + methodText(how) +
    (wanted > 0.0 ? "."
                  : "; the cell size keeps the number of nodes per area (" + number(suggested) +
          " m), rounded to three digits."));
}

/// In the file's own CRS.
void regrid(
  const SourceGrid& grid, double wanted, const std::string& fileName, RasterSurface& result)
{
  const double sourceCell = std::min(grid.columnStep(), grid.rowStep());
  Resampling how;
  how.cellSize = wanted > 0.0 ? wanted : sourceCell;
  how.samples = samplesFor(how.cellSize, sourceCell);
  const std::string crs = std::move(result.geometry.crs);
  result.geometry = layOut(grid, {}, how, fileName);
  result.geometry.crs = crs;
  result.heights = resample(grid, {}, how, result.geometry);

  std::string reason;
  const auto because = [&reason](const std::string& text)
  { reason += (reason.empty() ? "" : " and ") + text; };
  if (!grid.isNorthUp())
  {
    const double turn = degrees(std::atan2(grid.affine[4], grid.affine[1]));
    because("the file's rows do not run from west to east, from north to south (" +
      (turn == 0.0 ? std::string("sheared)") : "turned by " + number(turn) + " degrees)"));
  }
  if (!grid.isSquare())
  {
    because("the file's cells are not square");
  }
  if (wanted > 0.0 && !(sameCell(wanted, grid.columnStep()) && grid.isSquare()))
  {
    because("a cell size of " + number(wanted) + " m was asked for");
  }
  result.notes.push_back("Resampled because " + reason + ": from " +
    sizeText(grid.columns, grid.rows) + " nodes of " + cellText(grid, "m") + " to " +
    sizeText(result.geometry.columns, result.geometry.rows) + " nodes of " + number(how.cellSize) +
    " m, " + methodText(how) + ".");
}

} // namespace

RasterSurface readRaster(const std::string& fileName, const RasterOptions& options)
{
  const double wanted = options.cellSize;
  require(wanted >= 0.0 && std::isfinite(wanted), "CellSize", wanted, "",
    "a positive number of metres, or 0 for the file's own");
  Messages messages;
  RasterSurface result;
  RasterFile file(fileName, options.band, messages, result.notes);
  SourceGrid grid = file.read();
  if (!file.georeferenced())
  {
    result.notes.push_back("The file has no georeferencing; cells of 1 m were taken.");
  }
  else if (!file.crs())
  {
    refuseUnlabelledDegrees(extent(grid), grid.columnStep(), meanSteepness(grid),
      "gdal_edit.py -a_srs EPSG:4326 " + fileName, fileName);
    result.notes.push_back("The file has no CRS; its coordinates were taken as metres.");
  }

  const Destination to = destination(grid, file.crs(), fileName);
  if (!to.doubt.empty())
  {
    result.notes.push_back(to.doubt);
  }
  const CrsPtr& reference = file.reference();
  const auto withoutHeight = [](const std::vector<double>& heights)
  {
    return std::count_if(
      heights.begin(), heights.end(), [](double height) { return std::isnan(height); });
  };
  const double surveyed = double(std::ptrdiff_t(grid.heights.size()) - withoutHeight(grid.heights));
  if (to.target)
  {
    reproject(grid, file.crs(), to, wanted, fileName, result);
    result.geometry.crs = crsWkt(to.target, reference);
  }
  else
  {
    result.geometry.crs = crsWkt(file.crs(), reference);
    if (grid.isNorthUp() && grid.isSquare() &&
      (wanted == 0.0 || sameCell(wanted, grid.columnStep())))
    {
      const auto lowerLeft = grid.place(grid.rows - 1, 0);
      result.geometry.columns = grid.columns;
      result.geometry.rows = grid.rows;
      result.geometry.cellSize = grid.columnStep();
      result.geometry.xOrigin = lowerLeft[0];
      result.geometry.yOrigin = lowerLeft[1];
      result.heights = std::move(grid.heights);
    }
    else
    {
      regrid(grid, wanted, fileName, result);
    }
  }

  const auto nodata = withoutHeight(result.heights);
  if (nodata == std::ptrdiff_t(result.heights.size()))
  {
    throw DataError(fileName + ": no node is left with a height; all " +
      sizeText(result.geometry.columns, result.geometry.rows) + " touch nodata or lie outside");
  }
  const double made = double(std::ptrdiff_t(result.heights.size()) - nodata);
  noteRelief(result, result.geometry.cellSize * std::sqrt(made / std::min(made, surveyed)));
  if (nodata > 0)
  {
    result.notes.push_back(std::to_string(nodata) + " of " + std::to_string(result.heights.size()) +
      " nodes have no data.");
  }
  result.geometry.fileUnits = file.units();
  return result;
}

} // namespace rockfall
