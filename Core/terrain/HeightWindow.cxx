#include "terrain/Surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

void HeightWindow::cut(CellDiagonal rule)
{
  anyRising_ = anyFalling_ = false;
  rising_.resize(std::size_t(rows_ - 1) * (columns_ - 1));
  unsigned char* cell = rising_.data();
  for (int r = 0; r + 1 < rows_; ++r)
  {
    const double* upper = &z_[std::size_t(r) * columns_];
    const double* lower = upper + columns_;
    for (int c = 0; c + 1 < columns_; ++c, ++cell)
    {
      const bool rising = isCutRising(rule, upper[c], upper[c + 1], lower[c], lower[c + 1]);
      *cell = rising;
      anyRising_ = anyRising_ || rising;
      anyFalling_ = anyFalling_ || !rising;
    }
  }
}

void HeightWindow::gather(
  const Surface& surface, double xMin, double xMax, double yMin, double yMax)
{
  const Surface::Grid& g = surface.grid();
  cellSize_ = g.cellSize;
  inverse_ = 1.0 / g.cellSize;
  const double north = g.height();
  const auto cell = [&](double v) { return int(std::floor(std::clamp(v * inverse_, -1e6, 2e9))); };
  const int wantColumn0 = cell(xMin), wantColumn1 = cell(xMax);
  const int wantRow0 = cell(north - yMax), wantRow1 = cell(north - yMin);
  xMin_ = wantColumn0 * cellSize_;
  xMax_ = (wantColumn1 + 1) * cellSize_;
  yMax_ = north - wantRow0 * cellSize_;
  yMin_ = north - (wantRow1 + 1) * cellSize_;
  const int column0 = wantColumn0, column1 = wantColumn1, row0 = wantRow0, row1 = wantRow1;
  west_ = column0 * cellSize_;
  north_ = north - row0 * cellSize_;
  columns_ = column1 - column0 + 2;
  rows_ = row1 - row0 + 2;
  tilt_.setZero();
  relief_ = 0.0;
  highest_ = -std::numeric_limits<double>::infinity();
  whole_ = false;
  if (column1 < 0 || column0 > g.columns - 2 || row1 < 0 || row0 > g.rows - 2)
  {
    // Beyond the edge: a window in which there is nothing.
    columns_ = rows_ = 2;
    z_.assign(4, std::numeric_limits<double>::quiet_NaN());
    this->cut(CellDiagonal::FromUpperLeft);
    return;
  }
  z_.resize(std::size_t(rows_) * columns_);
  bool whole = true;
  for (int r = 0; r < rows_; ++r)
  {
    double* row = &z_[std::size_t(r) * columns_];
    for (int c = 0; c < columns_; ++c)
    {
      row[c] = surface.apronHeight(row0 + r, column0 + c);
      whole = whole && !std::isnan(row[c]);
    }
  }
  whole_ = whole;
  this->cut(surface.terrain().geometry().diagonal);
  // Gradients of the CFEs: their mean, then the farthest from it.
  const auto visit = [&](auto&& use) { this->visitGradients(0, rows_ - 2, 0, columns_ - 2, use); };
  double dx = 0.0, dy = 0.0;
  int known = 0;
  visit(
    [&](double x, double y)
    {
      if (whole || !(std::isnan(x) || std::isnan(y)))
      {
        dx += x;
        dy += y;
        ++known;
      }
    });
  dx /= std::max(known, 1);
  dy /= std::max(known, 1);
  double most = 0.0;
  visit(
    [&](double x, double y)
    {
      const double off = (x - dx) * (x - dx) + (y - dy) * (y - dy);
      most = off > most ? off : most; // NaN is not
    });
  tilt_ = Eigen::Vector2d(dx, dy) * inverse_;
  relief_ = std::sqrt(most) * inverse_;
  for (int r = 0; r < rows_; ++r)
  {
    double* row = &z_[std::size_t(r) * columns_];
    const double plane = tilt_.y() * this->y(r) + tilt_.x() * west_;
    for (int c = 0; c < columns_; ++c)
    {
      const double over = row[c] - plane - dx * c;
      highest_ = over > highest_ ? over : highest_; // NaN is not
    }
  }
}

HeightWindow::Gradients HeightWindow::gradients(int row0, int row1, int column0, int column1) const
{
  Gradients of;
  int count = 0;
  this->visitGradients(row0, row1, column0, column1,
    [&](double x, double y)
    {
      of.tilt += Eigen::Vector2d(x, y);
      ++count;
    });
  of.tilt /= count;
  double most = 0.0;
  this->visitGradients(row0, row1, column0, column1,
    [&](double x, double y)
    { most = std::max(most, (Eigen::Vector2d(x, y) - of.tilt).squaredNorm()); });
  of.tilt *= inverse_;
  of.relief = std::sqrt(most) * inverse_;
  return of;
}

GroundHeightBound::GroundHeightBound(const HeightWindow& window)
  : tilt_(window.tilt_)
  , slant_(std::sqrt(1.0 + tilt_.squaredNorm()))
  , xMin_(window.xMin_)
  , xMax_(window.xMax_)
  , yMin_(window.yMin_)
  , yMax_(window.yMax_)
{
  if (window.whole_)
  {
    highest_ = window.highest_; // at rims rocks may go down beside the ground
  }
}

} // namespace rockfall
