#pragma once

/// @file
/// The cells under a disc that goes along a path: those that a rock wider than a cell touches.

#include "statistics/passages.h"

#include <Eigen/Core>

#include <cstdint>
#include <map>

namespace rockfall
{

class DiscSwath
{
public:
  /// `radius`, m: more than half a cell.
  DiscSwath(const CellGrid& grid, double radius)
    : grid_(grid)
    , radius_(radius)
  {
  }

  /// The disc goes straight from a to b, where the energy-line angle is `angle`.
  void add(
    const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Maxima& maxima, std::uint32_t angle);
  /// The rock came to rest with its centre in this cell.
  void stop(std::int64_t cell);

  struct Visited
  {
    Passage passage;
    std::int64_t step = 0;                       ///< The last one that touched it.
    std::uint32_t before = Passage::kAngleSteps; ///< Smallest angle of the stays before this one.
  };
  const std::map<std::int64_t, Visited>& cells() const { return cells_; }

private:
  bool touches(
    const Eigen::Vector2d& low, const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  void visit(std::int64_t cell, const Maxima& maxima, std::uint32_t angle);

  CellGrid grid_;
  double radius_;
  std::int64_t step_ = 0;
  std::map<std::int64_t, Visited> cells_;
};

} // namespace rockfall
