#pragma once

/// @file
/// A grid over boxes in the x–y plane: what is where.

#include "base/types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace rockfall
{

/// An upright box.
struct FlatBox
{
  double xMin = 0.0, xMax = -1.0, yMin = 0.0, yMax = -1.0; ///< m
  double top = 0.0;                                        ///< m

  /// Whether the two have a place in plan in common.
  bool meets(double x0, double x1, double y0, double y1) const
  {
    return xMax >= x0 && xMin <= x1 && yMax >= y0 && yMin <= y1;
  }
};

/// Immutable; a query costs what it finds.
class BoxIndex
{
public:
  BoxIndex() = default;
  explicit BoxIndex(std::span<const FlatBox> boxes);

  /// Calls `use(number)` once for every box whose cells a box meets, in a fixed order.
  template <typename Use>
  void visit(double xMin, double xMax, double yMin, double yMax, Use&& use) const
  {
    int c0 = 0, c1 = -1, r0 = 0, r1 = -1;
    if (!this->cells(xMin, xMax, yMin, yMax, c0, c1, r0, r1))
    {
      return;
    }
    for (int r = r0; r <= r1; ++r)
    {
      for (int c = c0; c <= c1; ++c)
      {
        const std::size_t cell = std::size_t(r) * columns_ + c;
        for (std::uint32_t k = begins_[cell]; k < begins_[cell + 1]; ++k)
        {
          const std::uint32_t item = items_[k];
          // In the first of its cells that the query meets, and only there.
          if (std::max(c0, first_[item][0]) == c && std::max(r0, first_[item][1]) == r)
          {
            use(int(item));
          }
        }
      }
    }
  }
  /// Upper bound of the tops of all boxes that a box meets, m; −∞ if there is none.
  double top(double xMin, double xMax, double yMin, double yMax) const;

private:
  /// Part of the cells of this size that hold the middle of a box.
  double filledPart(std::span<const FlatBox> boxes, double size) const;
  bool cells(
    double xMin, double xMax, double yMin, double yMax, int& c0, int& c1, int& r0, int& r1) const
  {
    if (columns_ == 0 || !(xMax >= west_ && yMax >= south_ && xMin <= east_ && yMin <= north_))
    {
      return false;
    }
    const auto at = [&](double v, double from, int count)
    { return int(std::clamp((v - from) * inverse_, 0.0, double(count - 1))); };
    c0 = at(xMin, west_, columns_), c1 = at(xMax, west_, columns_);
    r0 = at(yMin, south_, rows_), r1 = at(yMax, south_, rows_);
    return true;
  }

  double west_ = 0.0, east_ = 0.0, south_ = 0.0, north_ = 0.0, inverse_ = 0.0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> begins_, items_;
  std::vector<std::array<int, 2>> first_; ///< Column and row of the first cell of each box.
  std::vector<double> tops_;              ///< Of each cell.
};

} // namespace rockfall
