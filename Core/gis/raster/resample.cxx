#include "gis/raster/resample.h"

#include "base/abort.h"
#include "base/errors.h"
#include "gis/base/gdal.h"

#include <cpl_vsi.h>
#include <gdal.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall::gis
{

namespace
{

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// A node this near (in cells) to a source node is that node: rounding of coordinates must not let
/// the neighbours, nodata among them, have a say.
constexpr double sameNode = 1e-6;

double snapped(double index)
{
  const double nearest = std::round(index);
  return std::abs(index - nearest) < sameNode ? nearest : index;
}

double bilinear(const SourceGrid& source, double row, double column)
{
  row = snapped(row);
  column = snapped(column);
  if (!(row >= 0.0 && column >= 0.0 && row <= source.rows - 1 && column <= source.columns - 1))
  {
    return missing;
  }
  const int r = std::min(int(row), source.rows - 2);
  const int c = std::min(int(column), source.columns - 2);
  const double south = row - r;
  const double east = column - c;
  const double* upper = source.heights.data() + std::size_t(r) * source.columns + c;
  const double* lower = upper + source.columns;
  // A weight of 0 is left out rather than multiplied: 0 · NaN is NaN.
  const auto along = [east](const double* pair) {
    return east == 0.0 ? pair[0] : east == 1.0 ? pair[1] : (1.0 - east) * pair[0] + east * pair[1];
  };
  return south == 0.0 ? along(upper)
    : south == 1.0    ? along(lower)
                      : (1.0 - south) * along(upper) + south * along(lower);
}

} // namespace

double SourceGrid::columnStep() const
{
  return std::hypot(affine[1], affine[4]);
}

double SourceGrid::rowStep() const
{
  return std::hypot(affine[2], affine[5]);
}

std::array<double, 2> SourceGrid::place(double row, double column) const
{
  return { affine[0] + (column + 0.5) * affine[1] + (row + 0.5) * affine[2],
    affine[3] + (column + 0.5) * affine[4] + (row + 0.5) * affine[5] };
}

bool SourceGrid::isNorthUp() const
{
  const double slack = 0.01 * std::min(this->columnStep(), this->rowStep());
  return affine[1] > 0.0 && affine[5] < 0.0 && std::abs(affine[2]) * rows < slack &&
    std::abs(affine[4]) * columns < slack;
}

bool SourceGrid::isSquare() const
{
  const double difference = std::abs(this->columnStep() - this->rowStep());
  return difference * std::max(rows, columns) < 0.01 * this->columnStep();
}

void requireMemory(double nodes, const std::string& fileName)
{
  const double needed = nodes * sizeof(double);
  const double available = double(CPLGetUsablePhysicalRAM());
  if (available > 0.0 && needed > available)
  {
    throw DataError(fileName + ": " + number(nodes) + " nodes need " + number(needed / 1e9) +
      " GB of memory, this machine has " + number(available / 1e9) + " GB");
  }
}

void setNodes(
  GridGeometry& grid, double columns, double rows, std::size_t others, const std::string& fileName)
{
  const std::string what = fileName + ": a cell size of " + number(grid.cellSize) + " m ";
  const std::string nodes = number(columns) + " x " + number(rows) + " nodes";
  if (!(columns >= 2.0 && rows >= 2.0))
  {
    throw DataError(what + "leaves " + nodes + ", at least 2 x 2 are needed");
  }
  requireMemory(columns * rows + double(others), fileName);
  if (std::max(columns, rows) > std::numeric_limits<int>::max())
  {
    throw DataError(what + "gives " + nodes);
  }
  grid.columns = int(columns);
  grid.rows = int(rows);
}

GridGeometry layOut(const SourceGrid& source, const CrsChange& change, const Resampling& how,
  const std::string& fileName)
{
  std::vector<double> x, y;
  const auto add = [&](int row, int column)
  {
    const auto place = source.place(row, column);
    x.push_back(place[0]);
    y.push_back(place[1]);
  };
  for (int column = 0; column < source.columns; ++column)
  {
    add(0, column);
    add(source.rows - 1, column);
  }
  for (int row = 0; row < source.rows; ++row)
  {
    add(row, 0);
    add(row, source.columns - 1);
  }
  if (!change.forth(int(x.size()), x.data(), y.data()))
  {
    throw DataError(fileName + ": its extent cannot be brought to a metric CRS");
  }

  // The outermost sample of a cell stands this far from its node.
  const double margin = how.cellSize * (how.samples - 1) / (2.0 * how.samples);
  const auto along = [&](const std::vector<double>& values, double& first)
  {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    first = *low + margin;
    if (how.snap)
    {
      first = std::ceil(first / how.cellSize - sameNode) * how.cellSize;
    }
    return std::floor((*high - margin - first) / how.cellSize + sameNode) + 1.0;
  };
  GridGeometry target;
  target.cellSize = how.cellSize;
  const double columns = std::max(0.0, along(x, target.xOrigin));
  const double rows = std::max(0.0, along(y, target.yOrigin));
  // The source's nodes stay until the target's are made.
  setNodes(target, columns, rows, source.heights.size(), fileName);
  return target;
}

std::vector<double> resample(const SourceGrid& source, const CrsChange& change,
  const Resampling& how, const GridGeometry& target)
{
  double forward[6], inverse[6];
  std::copy(source.affine.begin(), source.affine.end(), forward);
  if (!GDALInvGeoTransform(forward, inverse))
  {
    throw DataError("The raster's cells have no area");
  }
  const double centreX = source.place(0.5 * (source.rows - 1), 0.5 * (source.columns - 1))[0];

  const int samples = how.samples;
  const double step = how.cellSize / samples;
  const int count = target.columns * samples;
  const double first = target.xOrigin - 0.5 * (samples - 1) * step;
  std::vector<double> x(std::size_t(count), 0.0), y(x), heights(std::size_t(target.nodeCount()));
  for (int row = 0; row < target.rows; ++row)
  {
    stayWanted();
    const double nodeY = target.yOrigin + (target.rows - 1 - row) * how.cellSize;
    double* nodes = heights.data() + std::size_t(row) * target.columns;
    for (int line = 0; line < samples; ++line)
    {
      for (int i = 0; i < count; ++i)
      {
        x[i] = first + i * step;
        y[i] = nodeY + (line - 0.5 * (samples - 1)) * step;
      }
      change.back(count, x.data(), y.data());
      for (int i = 0; i < count; ++i)
      {
        if (source.period > 0.0)
        {
          x[i] += source.period * std::round((centreX - x[i]) / source.period);
        }
        const double u = inverse[0] + x[i] * inverse[1] + y[i] * inverse[2] - 0.5;
        const double v = inverse[3] + x[i] * inverse[4] + y[i] * inverse[5] - 0.5;
        nodes[i / samples] += bilinear(source, v, u);
      }
    }
    if (samples > 1)
    {
      std::for_each(nodes, nodes + target.columns,
        [samples](double& height) { height /= double(samples) * samples; });
    }
  }
  return heights;
}

} // namespace rockfall::gis
