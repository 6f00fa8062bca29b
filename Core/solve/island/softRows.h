#pragma once

/// @file
/// The rows of an island: their order, where they stand in the middle of the step, what they weigh.
/// In order they stand by strip, pairs before the slope, those of the same two rocks side by side.

#include "base/parallel.h"
#include "solve/island/softMovers.h"

#include <vector>

namespace rockfall::soft
{

class Rows
{
public:
  Rows(const Step& step, const Movers& movers)
    : step_(step)
    , movers_(movers)
  {
  }

  std::vector<ContactRow> rows;
  std::vector<ContactRowCold> starts; ///< By row.
  std::vector<Result> results;        ///< By row.
  std::vector<std::size_t> rowOf;     ///< By contact.
  std::vector<double> gap0;           ///< By contact, m.
  std::vector<Manifold> manifolds;
  int strips = 1;
  std::vector<std::size_t> firstOfStrip; ///< Among manifolds.

  /// Strips across the island: contacts belong to the lower one of their two rocks, and those of
  /// every second strip share no rock.
  void findStrips();
  void arrange();
  void prepare(std::size_t contact, ContactRow& row, ContactRowCold& start) const;
  void start(); ///< Where the step begins, with the impulses of the last one.

  void weigh(std::size_t row); ///< Effective masses where its rocks are now.
  /// The arm of its second rock now. Returns whether its rocks have turned, or slid past each
  /// other, so far that it weighs otherwise.
  bool place(ContactRow& row) const;
  double gapOf(const ContactRow& row, const ContactRowCold& start) const;
  double gapOf(std::size_t row) const { return this->gapOf(rows[row], starts[row]); }
  double gapOfContact(std::size_t contact) const;

  /// visit(strip), by the calling thread alone if there are only few rows to go over.
  template <class Visit>
  void forStrips(Visit&& visit, std::size_t count = kRowGrain) const;
  /// visit(row's number) of those that are not idle.
  template <class Visit>
  void forRows(const Manifold& manifold, Visit&& visit) const;

private:
  int stripOf(const IslandContact& contact) const;
  void prepareImpulses(std::size_t row, const IslandContact& contact);

  const Step& step_;
  const Movers& movers_;
  std::vector<int> stripOfBody_;
};

inline bool Rows::place(ContactRow& r) const
{
  const Mover& a = movers_[r.a];
  if (r.b < 0)
  {
    return a.turned;
  }
  const Mover& b = movers_[r.b];
  const Vec3 slide = a.displacement - b.displacement;
  r.leverB = r.lever + ((a.start - b.start) + slide);
  return a.turned || b.turned || slide.squaredNorm() > r.slide2;
}

inline double Rows::gapOf(const ContactRow& r, const ContactRowCold& start) const
{
  const Mover& a = movers_[r.a];
  Vec3 motion = a.displacement + a.turn.cross(r.lever);
  if (r.b >= 0)
  {
    const Mover& b = movers_[r.b];
    motion -= b.displacement + b.turn.cross(r.lever + (a.start - b.start));
  }
  return start.gap0 + r.normal.dot(motion);
}

template <class Visit>
void Rows::forStrips(Visit&& visit, std::size_t count) const
{
  for (const int first : { 0, 1 })
  {
    const std::size_t half = std::size_t(strips - first + 1) / 2;
    forEach(half, count < kRowGrain ? half : 1,
      [&](std::size_t k) { visit(std::size_t(first) + 2 * k); });
  }
}

template <class Visit>
void Rows::forRows(const Manifold& manifold, Visit&& visit) const
{
  for (std::size_t k = manifold.first; k < manifold.end; ++k)
  {
    if (!rows[k].idle)
    {
      visit(k);
    }
  }
}

} // namespace rockfall::soft
