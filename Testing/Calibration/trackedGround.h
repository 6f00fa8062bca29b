#pragma once

/// @file
/// The part of a field test's ground that its rocks have seen. Beyond it the grid is a guess, and a
/// run-out there says no more than "at least as far as the edge".

#include <array>
#include <span>
#include <vector>

namespace rockfall::calibration
{

using Place = std::array<double, 2>; ///< m

/// The convex hull of places, widened.
class TrackedGround
{
public:
  /// `margin`, m, ≥ 0: outward from each side of the hull. Throws DataError unless there are three
  /// places that are not on one line.
  TrackedGround(std::span<const Place> places, double margin);

  bool holds(const Place& place) const;
  /// `to`, or where the straight way to it from a place inside comes to the edge.
  Place cut(const Place& from, const Place& to) const;

private:
  /// A side: what is inside has outward · place ≤ offset.
  struct Side
  {
    Place outward;
    double offset; ///< m
  };
  std::vector<Side> sides_;
};

} // namespace rockfall::calibration
