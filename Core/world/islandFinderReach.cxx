// Velocities of their island and rest of their displacements, which rocks that may meet pass on to
// each other.

#include "world/IslandFinder.h"

#include "base/joined.h"
#include "law/settings.h"
#include "world/sleep.h"

#include <algorithm>
#include <utility>

namespace rockfall
{

int IslandFinder::root(int i)
{
  return headOf(parents_, i);
}

double IslandFinder::massRatioGain(std::size_t rock) const
{
  return bounds_[std::size_t(roots_[rock])].massRatioGain(rocks_.velocities[rock].mass, bounciest_);
}

/// Links two; `known`: their axis has been found for where they stand.
void IslandFinder::join(std::size_t k, bool known)
{
  NearPair& n = near_[k];
  n.linked = n.holds = true;
  states_[k] = PairState::Linked;
  n.pair->linked = true;
  n.pair->known = known;
  const auto linkTo = [&](int i, int other)
  {
    const int next = std::exchange(firstLink_[std::size_t(i)], int(links_.size()));
    links_.push_back({ aparts_[k], other, next });
    BodyBounds& m = rocks_.bodies[std::size_t(i)];
    if (m.asleep)
    {
      wake(world_.rocks[std::size_t(i)], world_.time);
      m.asleep = false;
      --sleepers_;
    }
    queue_.add(i, m.displacement);
  };
  linkTo(n.first, n.second);
  linkTo(n.second, n.first);
  const int a = this->root(n.first), b = this->root(n.second);
  if (a != b)
  {
    parents_[std::size_t(std::max(a, b))] = std::min(a, b);
    bounds_[std::size_t(std::min(a, b))].add(bounds_[std::size_t(std::max(a, b))]);
  }
}

/// All that lies on each other wakes at once; others have their turn in the next sweep.
void IslandFinder::wakeAbout(int rock)
{
  const auto visit = [&](std::size_t k)
  {
    NearPair& n = near_[k];
    const BodyBounds& other = rocks_.bodies[std::size_t(n.first == rock ? n.second : n.first)];
    if (k >= states_.size() || n.linked || !other.asleep || !other.present)
    {
      return;
    }
    aparts_[k] = this->apart(n);
    if (this->mayMeet(this->undecidedOf(k)))
    {
      near_.keep(n);
      world_.rocks[std::size_t(n.first)].updatePose();
      world_.rocks[std::size_t(n.second)].updatePose();
      if (this->meet(k))
      {
        this->join(k, true);
      }
    }
  };
  near_.forNeighbours(rock, visit);
}

/// Passes the rest of a rock's displacement on to those that it is linked with.
void IslandFinder::propagateFrom(int rock)
{
  BodyBounds* const rocks = rocks_.bodies.data();
  const double displacement = rocks[rock].displacement;
  const Link* const links = links_.data();
  for (int l = firstLink_[std::size_t(rock)]; l >= 0; l = links[l].next)
  {
    BodyBounds& other = rocks[links[l].other];
    if (displacement > other.displacement * kNoMore)
    {
      // The gap must be crossed first, by both together.
      const double own = rocks_.velocities[std::size_t(links[l].other)].own;
      const double left = displacement -
        std::max(0.0, links[l].gap) * displacement / std::max(displacement + own, 1e-12);
      if (left > other.displacement * kNoMore)
      {
        other.displacement = left;
        queue_.add(links[l].other, left);
      }
    }
  }
}

/// Carries on what each rock that has been joined may do to those that it may meet: the longest
/// displacement first, so that few have their turn twice.
void IslandFinder::propagate()
{
  for (int i = queue_.next(); i >= 0; i = queue_.next())
  {
    const std::size_t rock = std::size_t(i);
    roots_[rock] = this->root(i);
    massRatioGains_[rock] = this->massRatioGain(rock);
    fars_[rock] = massRatioGains_[rock] * rocks_.bodies[rock].displacement;
    if (sleepers_ > 0)
    {
      this->wakeAbout(i);
    }
    this->propagateFrom(i);
  }
}

} // namespace rockfall
