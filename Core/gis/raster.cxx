#include "gis/raster.h"

#include "base/errors.h"
#include "gis/crs.h"
#include "gis/gdal.h"
#include "gis/rasterFile.h"
#include "gis/resample.h"

#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

using namespace gis;

/// A projected CRS whose map metre differs by more than this from a metre on the ground is not used
/// as it is: slopes would be wrong by as much. UTM stays within 0.001, national grids within 0.01;
/// Web Mercator is at 0.4 in the Alps.
constexpr double largestDistortion = 0.02;

/// An extent wider than this is no site for rockfall, and UTM is not made for it.
constexpr double largestExtent = 1e6; // m

struct Box
{
  double xMin, xMax, yMin, yMax;
};

Box extent(const SourceGrid& grid)
{
  const double last[2] = { grid.rows - 1.0, grid.columns - 1.0 };
  const auto first = grid.place(0.0, 0.0);
  Box box{ first[0], first[0], first[1], first[1] };
  for (const auto& p :
    { grid.place(0.0, last[1]), grid.place(last[0], 0.0), grid.place(last[0], last[1]) })
  {
    box = { std::min(box.xMin, p[0]), std::max(box.xMax, p[0]), std::min(box.yMin, p[1]),
      std::max(box.yMax, p[1]) };
  }
  return box;
}

bool fitsTheGlobe(const Box& box)
{
  return box.xMin >= -360.0 && box.xMax <= 360.0 && box.yMin >= -90.0 && box.yMax <= 90.0;
}

std::string boxText(const Box& box)
{
  return number(box.xMin) + " ... " + number(box.xMax) + ", " + number(box.yMin) + " ... " +
    number(box.yMax);
}

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

/// Without a CRS nothing says what the coordinates are; degrees taken as metres would make cliffs
/// of every slope. Meant to catch those and to let small local slopes pass.
void refuseUnlabelledDegrees(const SourceGrid& grid, const std::string& fileName)
{
  const Box box = extent(grid);
  constexpr double smallestCell = 0.01; // m; no survey is finer, every raster in degrees is
  constexpr double steepest = 20.0;     // 87°, on average
  if (!fitsTheGlobe(box) || (grid.columnStep() >= smallestCell && meanSteepness(grid) <= steepest))
  {
    return;
  }
  throw DataError(fileName + ": has no CRS, and its extent " + boxText(box) + " with cells of " +
    number(grid.columnStep()) +
    " looks like degrees; assign the CRS, e.g. gdal_edit.py -a_srs "
    "EPSG:4326 " +
    fileName);
}

/// Lengths (target units) of one step along a row and one along a column at the raster's centre.
std::array<double, 2> centreSteps(const SourceGrid& grid, const CrsChange& change)
{
  const double row = 0.5 * (grid.rows - 1), column = 0.5 * (grid.columns - 1);
  // Half a cell to each side: the centre itself has no direction.
  const std::array<std::array<double, 2>, 4> ends = { grid.place(row, column - 0.5),
    grid.place(row, column + 0.5), grid.place(row - 0.5, column), grid.place(row + 0.5, column) };
  double x[4], y[4];
  for (int i = 0; i < 4; ++i)
  {
    x[i] = ends[i][0];
    y[i] = ends[i][1];
  }
  change.forth(4, x, y);
  return { std::hypot(x[1] - x[0], y[1] - y[0]), std::hypot(x[3] - x[2], y[3] - y[2]) };
}

/// Where the raster is to go, and why; no `target` if it can stay where it is.
struct Destination
{
  CrsPtr target;
  std::string reason;
};

CrsPtr utmOf(const SourceGrid& grid, const CrsPtr& crs, const std::string& fileName)
{
  const auto centre = grid.place(0.5 * (grid.rows - 1), 0.5 * (grid.columns - 1));
  double longitude = centre[0], latitude = centre[1];
  if (!CrsChange(crs, crsFromEpsg(4326)).forth(1, &longitude, &latitude))
  {
    throw DataError(fileName + ": the centre " + number(centre[0]) + ", " + number(centre[1]) +
      " is no place on earth in its CRS " + crsLabel(*crs));
  }
  return crsFromEpsg(utmCode(longitude, latitude));
}

Destination destination(const SourceGrid& grid, const CrsPtr& crs, const std::string& fileName)
{
  if (!crs)
  {
    return {};
  }
  if (crs->IsGeographic())
  {
    const Box box = extent(grid);
    const double inDegrees = crs->GetAngularUnits() * 180.0 / std::numbers::pi;
    if (!fitsTheGlobe({ box.xMin * inDegrees, box.xMax * inDegrees, box.yMin * inDegrees,
          box.yMax * inDegrees }))
    {
      throw DataError(fileName + ": its CRS " + crsLabel(*crs) + " is geographic, but its extent " +
        boxText(box) + " is no longitude and latitude");
    }
    return { utmOf(grid, crs, fileName), "its coordinates are angles" };
  }
  const char* unit = nullptr;
  if (std::abs(crs->GetLinearUnits(&unit) - 1.0) > 1e-9)
  {
    return { utmOf(grid, crs, fileName),
      "its unit is not the metre but the " + std::string(unit ? unit : "unnamed unit") };
  }
  try
  {
    Destination there{ utmOf(grid, crs, fileName), "" };
    const auto steps = centreSteps(grid, CrsChange(crs, there.target));
    const double along = grid.columnStep() / steps[0], across = grid.rowStep() / steps[1];
    const double worst = std::abs(along - 1.0) > std::abs(across - 1.0) ? along : across;
    if (std::abs(worst - 1.0) > largestDistortion)
    {
      there.reason = number(worst) + " of its metres are one on the ground";
      return there;
    }
  }
  catch (const DataError&)
  {
    // A projection whose place on earth is not known cannot be checked, but it can be used.
  }
  return {};
}

double threeDigits(double value)
{
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return unit < 1.0 ? std::round(value / unit) / std::round(1.0 / unit)
                    : std::round(value / unit) * unit;
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
  result.geometry.crs = crsWkt(*to.target);

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
    because("the file's rows do not run from west to east, from north to south (turned by " +
      number(degrees(std::atan2(grid.affine[4], grid.affine[1]))) + " degrees)");
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
  if (!(wanted >= 0.0) || !std::isfinite(wanted))
  {
    throw ParameterError("CellSize is " + number(wanted) +
      ", it must be a positive number of metres, or 0 for the file's own");
  }
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
    refuseUnlabelledDegrees(grid, fileName);
    result.notes.push_back("The file has no CRS; its coordinates were taken as metres.");
  }

  const Destination to = destination(grid, file.crs(), fileName);
  if (to.target)
  {
    reproject(grid, file.crs(), to, wanted, fileName, result);
  }
  else
  {
    result.geometry.crs = file.crs() ? crsWkt(*file.crs()) : "";
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

  const auto nodata = std::count_if(
    result.heights.begin(), result.heights.end(), [](double height) { return std::isnan(height); });
  if (nodata == std::ptrdiff_t(result.heights.size()))
  {
    throw DataError(fileName + ": no node is left with a height; all " +
      sizeText(result.geometry.columns, result.geometry.rows) + " touch nodata or lie outside");
  }
  if (nodata > 0)
  {
    result.notes.push_back(std::to_string(nodata) + " of " + std::to_string(result.heights.size()) +
      " nodes have no data.");
  }
  return result;
}

} // namespace rockfall
