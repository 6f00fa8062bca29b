#pragma once

/// @file
/// Rocks that wait for their turn, those of long displacements first.

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace rockfall
{

/// By ranges of displacements: within one of them the order is any, but the same in every run.
class RockQueue
{
public:
  /// For so many rocks, none of which has its turn, and displacements up to `most` (m).
  void reset(std::size_t count, double most)
  {
    scale_ = most > 0.0 ? double(kRanges - 1) / most : 0.0;
    places_.resize(count);
  }
  /// Once each; who waits already is moved up to where his displacement belongs.
  void add(int rock, double displacement)
  {
    const int range = std::clamp(int(displacement * scale_), 0, kRanges - 1);
    Place& place = places_[std::size_t(rock)];
    if (place.range >= 0)
    {
      if (place.range == range)
      {
        return;
      }
      this->remove(place);
    }
    Ends& ends = ends_[std::size_t(range)];
    place = { -1, ends.last, range };
    (ends.last >= 0 ? places_[std::size_t(ends.last)].next : ends.first) = rock;
    ends.last = rock;
    highest_ = std::max(highest_, range);
  }
  /// −1: none waits.
  int next()
  {
    for (; highest_ >= 0; --highest_)
    {
      const int rock = ends_[std::size_t(highest_)].first;
      if (rock >= 0)
      {
        this->remove(places_[std::size_t(rock)]);
        return rock;
      }
    }
    highest_ = 0;
    return -1;
  }

private:
  static constexpr int kRanges = 1024;
  struct Ends
  {
    int first = -1, last = -1;
  };
  struct Place
  {
    int next = -1, last = -1;
    int range = -1; ///< −1: does not wait.
  };
  void remove(Place& place)
  {
    Ends& ends = ends_[std::size_t(place.range)];
    (place.last >= 0 ? places_[std::size_t(place.last)].next : ends.first) = place.next;
    (place.next >= 0 ? places_[std::size_t(place.next)].last : ends.last) = place.last;
    place.range = -1;
  }

  double scale_ = 0.0; ///< 1/m
  int highest_ = 0;
  std::array<Ends, kRanges> ends_{};
  std::vector<Place> places_;
};

} // namespace rockfall
