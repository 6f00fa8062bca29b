#pragma once

/// @file
/// Rocks near each other, by the map that finds the slope under a rock (paper 2.3.2), in
/// space: cells no smaller than the rocks that stand in them.

#include "base/types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rockfall
{

/// A sphere that holds a rock during a step.
struct BroadBox
{
  Vec3 center = Vec3::Zero(); ///< m
  double radius = 0.0;        ///< m
  bool present = true;
  bool moves = true; ///< Two that don't move are no pair.
};

/// Rocks of very different size stand in maps of different cells, each about twice as wide as the
/// last, so that the cost does not grow with the ratio of their sizes.
class BroadPhase
{
public:
  void place(std::span<const BroadBox> boxes);

  /// All pairs whose spheres overlap, smaller index first, in ascending order; until the next call.
  std::span<const std::array<int, 2>> pairs();

  /// Rocks whose spheres overlap a ball, whether they move or not, in ascending order.
  void within(const Vec3& center, double radius, std::vector<int>& found) const;

private:
  struct Entry
  {
    Vec3 center;
    double radius;
    std::int64_t cell; ///< By z, then y, then x.
    int index;
    bool moves;
  };
  /// Rocks of about one size: entries from `first` to `last` − 1, in the order of their cells.
  struct Map
  {
    std::size_t first, last;
    double size;          ///< Of a cell, m; no rock of the map has a larger diameter.
    double largestRadius; ///< m
  };
  using Found = std::vector<std::array<int, 2>>;
  std::array<std::int64_t, 3> cellOf(const Map& map, const Vec3& x) const;
  const Entry* atOrAfter(const Map& map, std::int64_t cell) const;
  void searchOwn(const Map& map, std::size_t first, std::size_t last, Found& found) const;
  void searchLarger(const Map& map, std::size_t first, std::size_t last, Found& found) const;

  Vec3 lower_ = Vec3::Zero(); ///< Corner of all maps, m.
  std::size_t count_ = 0;
  std::vector<Entry> entries_;
  std::vector<Map> maps_; ///< From small rocks to large ones.
  std::vector<std::array<std::int64_t, 3>> order_;
  std::vector<Found> parts_;
  std::vector<std::size_t> firsts_;
  Found pairs_;
};

/// All pairs whose spheres overlap, smaller index first, in ascending order.
std::vector<std::array<int, 2>> findNear(std::span<const BroadBox> boxes);

} // namespace rockfall
