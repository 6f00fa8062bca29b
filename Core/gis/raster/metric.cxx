#include "gis/raster/metric.h"

#include "base/errors.h"
#include "gis/base/gdal.h"

#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall::gis
{

namespace
{

/// A projected CRS whose map metre differs by more than this from a metre on the ground is not used
/// as it is: slopes would be wrong by as much. UTM stays within 0.001, national grids within 0.01;
/// Web Mercator is at 0.4 in the Alps.
constexpr double largestDistortion = 0.02;

/// Degrees beyond the area that a CRS is made for, in which neighbours use it as well.
constexpr double beside = 5.0;

/// Longitude and latitude of the centre.
std::array<double, 2> centreOnEarth(
  const SourceGrid& grid, const CrsPtr& crs, const std::string& fileName)
{
  const auto centre = grid.place(0.5 * (grid.rows - 1), 0.5 * (grid.columns - 1));
  double longitude = centre[0], latitude = centre[1];
  if (!CrsChange(crs, crsFromEpsg(4326)).forth(1, &longitude, &latitude))
  {
    throw DataError(fileName + ": the centre " + number(centre[0]) + ", " + number(centre[1]) +
      " is no place on earth in its CRS " + crsLabel(*crs));
  }
  return { longitude, latitude };
}

/// A note if a CRS is not made for a place; empty if it is, or if nobody knows.
std::string awayFrom(const OGRSpatialReference& crs, const std::array<double, 2>& place)
{
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
  const char* name = nullptr;
  if (!crs.GetAreaOfUse(&west, &south, &east, &north, &name) || west < -180.0)
  {
    return {};
  }
  east += east < west ? 360.0 : 0.0; // over the date line
  const double middle = 0.5 * (west + east);
  const double off = std::abs(std::remainder(place[0] - middle, 360.0)) - 0.5 * (east - west);
  if (off <= beside && place[1] >= south - beside && place[1] <= north + beside)
  {
    return {};
  }
  return "Its place, longitude " + number(std::round(100.0 * place[0]) / 100.0) + ", latitude " +
    number(std::round(100.0 * place[1]) / 100.0) + ", is far from where its CRS " + crsLabel(crs) +
    " is used, " + boxText({ west, east, south, north }) +
    " degrees: are the CRS and the order and signs of the coordinates right?";
}

} // namespace

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

SourceGrid gridOf(const Box& box)
{
  const double dx = box.xMax - box.xMin, dy = box.yMax - box.yMin;
  SourceGrid grid;
  grid.columns = grid.rows = 2;
  grid.affine = { box.xMin - 0.5 * dx, dx, 0.0, box.yMax + 0.5 * dy, 0.0, -dy };
  return grid;
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

void refuseUnlabelledDegrees(
  const Box& box, double near, double steep, const std::string& remedy, const std::string& fileName)
{
  constexpr double nearest = 0.01;  // m; no survey is finer, every layer in degrees is
  constexpr double steepest = 20.0; // 87°, on average
  if (!fitsTheGlobe(box) || (near >= nearest && steep <= steepest))
  {
    return;
  }
  throw DataError(fileName + ": has no CRS, and its extent " + boxText(box) + " with cells of " +
    number(near) + " looks like degrees; assign the CRS, e.g. " + remedy);
}

std::array<double, 3> centreSteps(const SourceGrid& grid, const CrsChange& change)
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
  const double along = std::hypot(x[1] - x[0], y[1] - y[0]);
  const double across = std::hypot(x[3] - x[2], y[3] - y[2]);
  const double dot = (x[1] - x[0]) * (x[3] - x[2]) + (y[1] - y[0]) * (y[3] - y[2]);
  return { along, across, dot / (along * across) };
}

Destination destination(const SourceGrid& grid, const CrsPtr& crs, const std::string& fileName)
{
  if (!crs)
  {
    return {};
  }
  const auto toUtm = [&](const std::string& reason)
  {
    const auto place = centreOnEarth(grid, crs, fileName);
    return Destination{ crsFromEpsg(utmCode(place[0], place[1])), reason, awayFrom(*crs, place) };
  };
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
    return toUtm("its coordinates are angles");
  }
  const char* unit = nullptr;
  if (std::abs(crs->GetLinearUnits(&unit) - 1.0) > 1e-9)
  {
    return toUtm("its unit is not the metre but the " + std::string(unit ? unit : "unnamed unit"));
  }
  if (const std::string axes = backwardAxes(*crs); !axes.empty())
  {
    return toUtm("its coordinates count to the " + axes);
  }
  Destination there;
  try
  {
    there = toUtm({});
    const auto steps = centreSteps(grid, CrsChange(crs, there.target));
    const double along = grid.columnStep() / steps[0], across = grid.rowStep() / steps[1];
    const double worst = std::abs(along - 1.0) > std::abs(across - 1.0) ? along : across;
    if (std::abs(worst - 1.0) > largestDistortion)
    {
      there.reason = number(worst) + " of its metres are one on the ground";
      return there;
    }
    // A shear leaves both lengths alone.
    const auto& a = grid.affine;
    const double right = (a[1] * a[2] + a[4] * a[5]) / (grid.columnStep() * grid.rowStep());
    if (std::abs(steps[2] - right) > largestDistortion)
    {
      there.reason = "its axes are not square on the ground";
      return there;
    }
  }
  catch (const DataError&)
  {
    // A projection whose place on earth is not known cannot be checked, but it can be used.
  }
  return { nullptr, {}, there.doubt };
}

double threeDigits(double value)
{
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return unit < 1.0 ? std::round(value / unit) / std::round(1.0 / unit)
                    : std::round(value / unit) * unit;
}

} // namespace rockfall::gis
