#include "terrain/HeightGrid.h"

#include "base/errors.h"
#include "base/text/numberText.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rockfall
{

CellDiagonal cellDiagonalFrom(double number)
{
  if (number != 0.0 && number != 1.0)
  {
    throw ParameterError("CellDiagonal is " + numberText(number) +
      ", it must be 0 (shorter fold) or 1 (from upper left)");
  }
  return CellDiagonal(int(number));
}

HeightGrid::HeightGrid(
  GridGeometry geometry, std::span<const double> heights, std::shared_ptr<const void> owner)
  : geometry_(std::move(geometry))
  , heights_(heights)
  , owner_(std::move(owner))
{
  if (geometry_.rows < 2 || geometry_.columns < 2)
  {
    throw DataError("the raster has " + std::to_string(geometry_.columns) + " columns and " +
      std::to_string(geometry_.rows) + " rows; a slope needs at least 2 of each");
  }
  if (!(geometry_.cellSize > 0.0) || !std::isfinite(geometry_.cellSize))
  {
    throw DataError(
      "the cell size is " + numberText(geometry_.cellSize) + " m; it must be positive and finite");
  }
  if (std::int64_t(heights_.size()) != geometry_.nodeCount())
  {
    throw DataError("the raster has " + std::to_string(heights_.size()) + " heights for " +
      std::to_string(geometry_.nodeCount()) + " nodes");
  }
  this->buildPyramid();
}

void HeightGrid::buildPyramid()
{
  // Level 0 stands for blocks of 4×4 cells, so that it costs 1/32 of the heights' memory.
  auto levels = std::make_shared<std::vector<Level>>();
  const int cellColumns = geometry_.columns - 1;
  const int cellRows = geometry_.rows - 1;
  Level base;
  base.columns = (cellColumns + 3) / 4;
  base.rows = (cellRows + 3) / 4;
  base.maximum.assign(
    std::size_t(base.columns) * base.rows, -std::numeric_limits<float>::infinity());
  bool any = false;
  lowest_ = std::numeric_limits<double>::infinity();
  for (int row = 0; row < geometry_.rows; ++row)
  {
    for (int column = 0; column < geometry_.columns; ++column)
    {
      const double z = this->nodeHeight(row, column);
      if (std::isinf(z))
      {
        throw DataError("the height of row " + std::to_string(row + 1) + ", column " +
          std::to_string(column + 1) + " is infinite");
      }
      if (std::isnan(z))
      {
        continue;
      }
      lowest_ = std::min(lowest_, z);
      const float up = std::nextafter(float(z), std::numeric_limits<float>::infinity());
      // A node bounds the cells on all its sides.
      for (int r = std::max(row - 1, 0) / 4; r <= std::min(row, cellRows - 1) / 4; ++r)
      {
        for (int c = std::max(column - 1, 0) / 4; c <= std::min(column, cellColumns - 1) / 4; ++c)
        {
          float& m = base.maximum[std::size_t(r) * base.columns + c];
          m = std::max(m, up);
        }
      }
    }
  }
  for (std::int64_t id = 1; id <= this->cfeCapacity() && !any; ++id)
  {
    any = this->hasCfe(id);
  }
  if (!any)
  {
    throw DataError("the raster has no cell whose nodes all have a height: nothing but nodata");
  }
  levels->push_back(std::move(base));
  while (levels->back().columns > 1 || levels->back().rows > 1)
  {
    const Level& fine = levels->back();
    Level coarse;
    coarse.columns = (fine.columns + 1) / 2;
    coarse.rows = (fine.rows + 1) / 2;
    coarse.maximum.assign(
      std::size_t(coarse.columns) * coarse.rows, -std::numeric_limits<float>::infinity());
    for (int r = 0; r < fine.rows; ++r)
    {
      for (int c = 0; c < fine.columns; ++c)
      {
        float& m = coarse.maximum[std::size_t(r / 2) * coarse.columns + c / 2];
        m = std::max(m, fine.maximum[std::size_t(r) * fine.columns + c]);
      }
    }
    levels->push_back(std::move(coarse));
  }
  pyramid_ = std::move(levels);
}

double HeightGrid::maxHeight(double xMin, double xMax, double yMin, double yMax) const
{
  const double none = -std::numeric_limits<double>::infinity();
  if (xMax < 0.0 || yMax < 0.0 || xMin > this->width() || yMin > this->height())
  {
    return none;
  }
  const double inverse = 1.0 / geometry_.cellSize;
  const int cellColumns = geometry_.columns - 1;
  const int cellRows = geometry_.rows - 1;
  const auto clampCell = [](double v, int n) { return int(std::clamp(v, 0.0, double(n - 1))); };
  int c0 = clampCell(std::floor(xMin * inverse), cellColumns) / 4;
  int c1 = clampCell(std::floor(xMax * inverse), cellColumns) / 4;
  // Rows run south, y runs north.
  int r0 = clampCell(std::floor((this->height() - yMax) * inverse), cellRows) / 4;
  int r1 = clampCell(std::floor((this->height() - yMin) * inverse), cellRows) / 4;
  std::size_t level = 0;
  while ((c1 - c0 > 1 || r1 - r0 > 1) && level + 1 < pyramid_->size())
  {
    c0 /= 2, c1 /= 2, r0 /= 2, r1 /= 2;
    ++level;
  }
  const Level& l = (*pyramid_)[level];
  double highest = none;
  for (int r = r0; r <= r1; ++r)
  {
    for (int c = c0; c <= c1; ++c)
    {
      highest = std::max(highest, double(l.maximum[std::size_t(r) * l.columns + c]));
    }
  }
  return highest;
}

std::array<std::int64_t, 3> HeightGrid::cfeNodes(std::int64_t id) const
{
  const std::int64_t cell = (id - 1) / 2;
  const std::int64_t row = cell / (geometry_.columns - 1);
  const std::int64_t column = cell % (geometry_.columns - 1);
  const std::int64_t upperLeft = row * geometry_.columns + column;
  const std::int64_t lowerRight = upperLeft + geometry_.columns + 1;
  const bool lower = id % 2 == 1;
  if (this->isRising(int(row), int(column)))
  {
    return lower ? std::array{ lowerRight - 1, lowerRight, upperLeft + 1 }
                 : std::array{ upperLeft, lowerRight - 1, upperLeft + 1 };
  }
  return lower ? std::array{ upperLeft, lowerRight - 1, lowerRight }
               : std::array{ upperLeft, lowerRight, upperLeft + 1 };
}

bool HeightGrid::hasCfe(std::int64_t id) const
{
  if (id < 1 || id > this->cfeCapacity())
  {
    return false;
  }
  for (std::int64_t n : this->cfeNodes(id))
  {
    if (std::isnan(heights_[std::size_t(n)]))
    {
      return false;
    }
  }
  return true;
}

namespace
{

/// A CFE by its cell; row −1: none.
struct CellHalf
{
  int row = -1, column = 0;
  bool lower = false; ///< Triangle of the cell.
};

CellHalf cellHalfAt(const HeightGrid& grid, double x, double y)
{
  const GridGeometry& geometry = grid.geometry();
  const double width = (geometry.columns - 1) * geometry.cellSize;
  const double height = (geometry.rows - 1) * geometry.cellSize;
  if (!(x >= 0.0 && y >= 0.0 && x <= width && y <= height))
  {
    return {};
  }
  const double s = x / geometry.cellSize;
  const double t = (height - y) / geometry.cellSize; // grows with the row
  const int column = std::clamp(int(s), 0, geometry.columns - 2);
  const int row = std::clamp(int(t), 0, geometry.rows - 2);
  return { row, column, isInLower(grid.isRising(row, column), s - column, t - row) };
}

Cfe cfeOf(const HeightGrid& grid, const CellHalf& half)
{
  const auto [row, column, lower] = half;
  const bool rising = grid.isRising(row, column);
  Cfe result;
  result.nodes[0] = grid.node(rising && lower ? row + 1 : row, column);
  result.nodes[1] = grid.node(row + 1, lower == rising ? column + 1 : column);
  result.nodes[2] = grid.node(lower && !rising ? row + 1 : row, column + 1);
  result.normal =
    (result.nodes[1] - result.nodes[0]).cross(result.nodes[2] - result.nodes[0]).normalized();
  return result;
}

} // namespace

Cfe HeightGrid::cfe(std::int64_t id) const
{
  const std::int64_t cell = (id - 1) / 2, columns = geometry_.columns - 1;
  return cfeOf(*this, { int(cell / columns), int(cell % columns), id % 2 == 1 });
}

std::int64_t HeightGrid::cfeAt(double x, double y) const
{
  const CellHalf half = cellHalfAt(*this, x, y);
  const std::int64_t lower = 2 * (std::int64_t(half.row) * (geometry_.columns - 1) + half.column);
  const std::int64_t id = half.row < 0 ? 0 : half.lower ? lower + 1 : lower + 2;
  return this->hasCfe(id) ? id : 0;
}

bool HeightGrid::isHole(double x, double y) const
{
  const auto onMap = [this](double px, double py)
  { return px >= 0.0 && py >= 0.0 && px <= this->width() && py <= this->height(); };
  if (!onMap(x, y) || this->cfeAt(x, y) != 0)
  {
    return false;
  }
  const auto hasGround = [&](double dx, double dy)
  {
    const double step = geometry_.cellSize;
    double px = x, py = y;
    do
    {
      px += step * dx;
      py += step * dy;
    } while (onMap(px, py) && this->cfeAt(px, py) == 0);
    return onMap(px, py);
  };
  // Along a row, a column and the diagonals.
  constexpr std::array<std::array<double, 2>, 4> axes{ { { 1, 0 }, { 0, 1 }, { 1, 1 },
    { 1, -1 } } };
  return std::any_of(axes.begin(), axes.end(),
    [&](const std::array<double, 2>& axis)
    { return hasGround(axis[0], axis[1]) && hasGround(-axis[0], -axis[1]); });
}

double HeightGrid::elevation(double x, double y) const
{
  // Without a division for a number: rocks ask for the height under each corner.
  const CellHalf half = cellHalfAt(*this, x, y);
  if (half.row < 0)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Cfe face = cfeOf(*this, half); // NaN if one of its nodes is
  const Vec3& n = face.normal;
  const Vec3& a = face.nodes[0];
  return a.z() - (n.x() * (x - a.x()) + n.y() * (y - a.y())) / n.z();
}

double lengthWithoutGround(const HeightGrid& grid, std::span<const Eigen::Vector2d> line)
{
  double without = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k)
  {
    const Eigen::Vector2d way = line[k] - line[k - 1];
    const int steps =
      int(std::clamp(std::ceil(2.0 * way.norm() / grid.geometry().cellSize), 1.0, 1e5));
    for (int i = 0; i < steps; ++i)
    {
      const Eigen::Vector2d place = line[k - 1] + (i + 0.5) / steps * way;
      without += grid.cfeAt(place.x(), place.y()) != 0 ? 0.0 : way.norm() / steps;
    }
  }
  return without;
}

} // namespace rockfall
