#pragma once

/// @file
/// Sweeps over the manifolds that push, and over those whose rocks a sweep has moved.

#include "solve/island/softRows.h"

#include <algorithm>
#include <atomic>
#include <vector>

namespace rockfall::soft
{

class Sweeps
{
public:
  explicit Sweeps(const Rows& rows)
    : rows_(rows)
  {
  }

  std::vector<std::vector<std::size_t>> busyOf; ///< By strip, manifolds.
  std::vector<int> stamp;                       ///< By mover, the sweep that last moved it.
  int tick = 0;                                 ///< Number of the sweep.

  void begin(std::size_t movers)
  {
    stamp.assign(movers, -1);
    tick = 0;
  }
  void setStrips()
  {
    busyOf.resize(std::size_t(rows_.strips));
    stampOfStrip_.assign(std::size_t(rows_.strips), -1);
  }
  /// Whether a mover (< 0: the slope) has been moved by this sweep or the last one.
  bool moves(int i) const { return i >= 0 && stamp[std::size_t(i)] >= tick - 1; }

  /// visit(row's number) of those that are not idle, strip by strip.
  template <class Visit>
  void forBusy(Visit&& visit) const;
  /// Sweeps over the busy rows, so many times; then over those of rocks that the last sweep has
  /// moved, until no row has changed by more.
  template <class Sweep>
  void sweep(int least, Sweep&& sweepManifold);

private:
  bool stripMoves(std::size_t strip) const; ///< Whether one of its rows' rocks may have been.
  void noteMoved(const Manifold& manifold);

  const Rows& rows_;
  std::vector<int> stampOfStrip_; ///< The sweep that last moved a rock of its rows.
};

template <class Visit>
void Sweeps::forBusy(Visit&& visit) const
{
  rows_.forStrips(
    [&](std::size_t strip)
    {
      for (const std::size_t m : busyOf[strip])
      {
        rows_.forRows(rows_.manifolds[m], visit);
      }
    });
}

inline bool Sweeps::stripMoves(std::size_t strip) const
{
  const std::size_t first = strip == 0 ? 0 : strip - 1;
  const std::size_t end = std::min(strip + 2, std::size_t(rows_.strips));
  return std::any_of(stampOfStrip_.begin() + std::ptrdiff_t(first),
    stampOfStrip_.begin() + std::ptrdiff_t(end), [this](int last) { return last >= tick - 1; });
}

inline void Sweeps::noteMoved(const Manifold& manifold)
{
  stamp[std::size_t(manifold.a)] = tick;
  if (manifold.b >= 0)
  {
    stamp[std::size_t(manifold.b)] = tick;
  }
}

template <class Sweep>
void Sweeps::sweep(int least, Sweep&& sweepManifold)
{
  tick += 2;
  std::size_t rows = kRowGrain; // of rocks that have moved, about
  for (int sweep = 0; sweep < least || (rows > 0 && sweep < kMostSweeps); ++sweep, ++tick)
  {
    std::atomic<std::size_t> moving = 0;
    const auto sweepStrip = [&](std::size_t strip)
    {
      if (sweep >= least && !this->stripMoves(strip))
      {
        return;
      }
      for (const std::size_t m : busyOf[strip])
      {
        const Manifold& manifold = rows_.manifolds[m];
        if (sweep >= least && !this->moves(manifold.a) && !this->moves(manifold.b))
        {
          continue;
        }
        if (sweepManifold(m))
        {
          this->noteMoved(manifold);
          stampOfStrip_[strip] = tick;
          moving.fetch_add(manifold.end - manifold.first, std::memory_order_relaxed);
        }
      }
    };
    rows_.forStrips(sweepStrip, sweep < least ? kRowGrain : rows);
    rows = moving;
  }
}

} // namespace rockfall::soft
