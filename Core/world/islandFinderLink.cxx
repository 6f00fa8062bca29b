// Links between rocks near each other that may meet.
//
// Two rocks may meet if their gap can close within the step. How fast it closes follows from what
// their velocities can become: those of a rock that flies are known; what touches the slope may be
// stopped or thrown back; and what belongs to an island of rocks that may touch each other may get
// any velocity that is among theirs, by impacts from rock to rock. On the other hand no rock goes
// further than its own displacement, or than what is left of the displacement of the one that
// strikes it, less the gaps that had to be crossed before. The smaller of the two bounds holds.

#include "world/IslandFinder.h"

#include "base/parallel.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

constexpr std::size_t kLookGrain = 16;

} // namespace

/// From now on the gap is bounded along the pair's axis.
void IslandFinder::lookAlong(NearPair& n) const
{
  const BodyBounds &a = rocks_.bodies[std::size_t(n.first)],
                   &b = rocks_.bodies[std::size_t(n.second)];
  n.normal = n.pair->axis.normal;
  n.offset =
    n.pair->axis.distance - n.normal.dot(a.position - b.position) + a.rimTravel + b.rimTravel;
}

double IslandFinder::gap(const NearPair& n) const
{
  const BodyBounds &a = rocks_.bodies[std::size_t(n.first)],
                   &b = rocks_.bodies[std::size_t(n.second)];
  return n.offset + n.normal.dot(a.position - b.position) - a.rimTravel - b.rimTravel;
}

/// Least distance of the two, along the axis and by their bounding spheres, m.
double IslandFinder::apart(const NearPair& n) const
{
  const BodyBounds &a = rocks_.bodies[std::size_t(n.first)],
                   &b = rocks_.bodies[std::size_t(n.second)];
  return std::max(this->gap(n), (a.position - b.position).norm() - a.radius - b.radius);
}

/// Speed at which the gap may close along its normal, m/s.
inline double IslandFinder::closing(const NearPair& n) const
{
  const std::size_t i = std::size_t(n.first), j = std::size_t(n.second);
  return closingSpeed(bounds_[std::size_t(roots_[i])], rocks_.velocities[i],
    bounds_[std::size_t(roots_[j])], rocks_.velocities[j], n.normal);
}

/// The widest gap over which the two may meet.
inline double IslandFinder::reach(const NearPair& n) const
{
  const std::size_t i = std::size_t(n.first), j = std::size_t(n.second);
  const double faster = std::max(massRatioGains_[i], massRatioGains_[j]);
  const double speed = n.offset > kNoAxis ? faster * this->closing(n) : -kNoAxis;
  return std::min(fars_[i] + fars_[j], speed * rocks_.duration) + sag_;
}

bool IslandFinder::mayMeet(const UndecidedPair& o) const
{
  // By their displacements alone first: that tells most of them apart.
  return o.apart <= fars_[std::size_t(o.first)] + fars_[std::size_t(o.second)] + sag_ &&
    o.apart <= this->reach(near_[std::size_t(o.near)]);
}

/// Whether two rocks that stand may meet; finds their axis as far as that needs it.
bool IslandFinder::meet(std::size_t k)
{
  NearPair& n = near_[k];
  RockPair& pair = *n.pair;
  for (;;)
  {
    const double reach = this->reach(n);
    const bool exact = n.looked >= 0.0 && pair.axis.distance <= n.looked;
    if (exact || n.looked >= reach)
    {
      aparts_[k] = this->apart(n);
      return exact && this->gap(n) <= reach;
    }
    const bool stands =
      n.looked < 0.0 && pair.seen && (pair.axis.distance <= 0.0 || pair.axis.distance > reach);
    if (n.looked < 0.0 && !pair.seen)
    {
      pair.before = pair.axis;
    }
    if (!stands)
    {
      pair.axis = findAxis(world_.rocks[std::size_t(n.first)].hull,
        world_.rocks[std::size_t(n.second)].hull, pair.axis, reach);
    }
    pair.seen = false;
    n.looked = reach;
    this->lookAlong(n);
    // Along this axis the velocities may tell more, or less: then once more.
  }
}

/// Looks at all pairs near each other before the first of them are linked.
void IslandFinder::look()
{
  const std::size_t count = near_.size(), parts = (count + kNearPart - 1) / kNearPart;
  states_.resize(count);
  aparts_.resize(count);
  undecidedByPart_.resize(std::max(count, undecidedByPart_.size()));
  others_.resize(std::max(count, others_.size()));
  left_.resize(parts);
  const auto lookAtPart = [this, count, nears = near_.data(), rocks = rocks_.bodies.data(),
                            aparts = aparts_.data(), states = states_.data()](std::size_t part)
  {
    const std::size_t first = part * kNearPart, last = std::min(count, first + kNearPart);
    UndecidedPair* open = undecidedByPart_.data() + first;
    std::size_t* other = others_.data() + first;
    for (std::size_t k = first; k < last; ++k)
    {
      NearPair& n = nears[k];
      const BodyBounds &a = rocks[std::size_t(n.first)], &b = rocks[std::size_t(n.second)];
      const Vec3 between = a.position - b.position;
      const double distance2 = between.squaredNorm();
      const double known = a.known + b.known, radii = a.radius + b.radius;
      const bool asleep = a.asleep && b.asleep;
      if ((!asleep && distance2 > (radii + known) * (radii + known)) || !a.present || !b.present)
      {
        // Without a pair there is nothing to forget.
        states[k] = PairState::Apart;
        *other = k;
        other += n.pair != nullptr;
        continue;
      }
      n.wasLinked = n.linked;
      n.linked = false;
      n.looked = -1.0;
      const double rimTravel = a.rimTravel + b.rimTravel;
      bool overlap = false;
      if (n.holds && n.pair->seen) // found where they stand
      {
        const PairAxis& axis = n.pair->axis;
        n.normal = axis.normal;
        n.offset = axis.distance - n.normal.dot(between) + rimTravel;
        overlap = axis.distance <= 0.0;
      }
      const double apart =
        std::max(n.offset + n.normal.dot(between) - rimTravel, std::sqrt(distance2) - radii);
      aparts[k] = apart;
      if (asleep || (!overlap && apart > known))
      {
        states[k] = asleep || n.holds || n.wasLinked ? PairState::Separate : PairState::Apart;
        continue;
      }
      states[k] = overlap ? PairState::Overlaps : PairState::Undecided;
      *open = { apart, n.first, n.second, int(k) };
      open += !overlap;
      *other = k;
      other += overlap;
    }
    left_[part] = { std::size_t(open - undecidedByPart_.data()) - first,
      std::size_t(other - others_.data()) - first };
  };
  forEach(parts, 1, lookAtPart);
  undecided_.clear();
  for (std::size_t part = 0; part < parts; ++part)
  {
    const UndecidedPair* const from = undecidedByPart_.data() + part * kNearPart;
    undecided_.insert(undecided_.end(), from, from + left_[part].open);
    const std::size_t* const other = others_.data() + part * kNearPart;
    for (std::size_t k = 0; k < left_[part].others; ++k)
    {
      if (states_[other[k]] == PairState::Overlaps)
      {
        this->join(other[k], false);
      }
      else
      {
        near_.drop(near_[other[k]]);
      }
    }
  }
}

IslandFinder::UndecidedPair IslandFinder::undecidedOf(std::size_t k) const
{
  return { aparts_[k], near_[k].first, near_[k].second, int(k) };
}

/// Takes up those about rocks whose displacements have outgrown what was known.
void IslandFinder::widen()
{
  for (std::size_t k = states_.size(); k < near_.size(); ++k)
  {
    states_.push_back(PairState::Separate);
    aparts_.push_back(this->apart(near_[k]));
  }
  for (const int rock : wider_)
  {
    const auto take = [&](std::size_t k)
    {
      const BodyBounds &a = rocks_.bodies[std::size_t(near_[k].first)],
                       &b = rocks_.bodies[std::size_t(near_[k].second)];
      if (states_[k] != PairState::Separate && states_[k] != PairState::Apart)
      {
        return;
      }
      aparts_[k] = a.present && b.present ? this->apart(near_[k]) : -kNoAxis;
      if (aparts_[k] <= a.known + b.known)
      {
        states_[k] = PairState::Undecided;
        undecided_.push_back(this->undecidedOf(k));
      }
    };
    near_.forNeighbours(rock, take);
  }
}

/// Displacements of rocks as their islands have grown.
void IslandFinder::widenIslands()
{
  wider_.clear();
  for (std::size_t i = 0; i < rocks_.bodies.size(); ++i)
  {
    // Parents come before their children.
    roots_[i] = parents_[i] = roots_[std::size_t(parents_[i])];
    BodyBounds& m = rocks_.bodies[i];
    if (bounds_[std::size_t(roots_[i])].size == 1)
    {
      continue;
    }
    massRatioGains_[i] = this->massRatioGain(i);
    fars_[i] = massRatioGains_[i] * m.displacement;
    if (fars_[i] + sag_ > m.known && m.present && !m.asleep)
    {
      m.known = kWider * (fars_[i] + sag_);
      wider_.push_back(int(i));
      if (!near_.isCovered(rocks_, i))
      {
        near_.cover(rocks_, int(i));
      }
    }
  }
  if (!wider_.empty())
  {
    this->widen();
  }
}

/// Of the pairs that are open, those that may meet.
void IslandFinder::choose()
{
  chosen_.clear();
  UndecidedPair* const first = undecided_.data();
  UndecidedPair* to = first;
  const double* const fars = fars_.data();
  for (const UndecidedPair *o = first, *end = first + undecided_.size(); o != end; ++o)
  {
    if (o->apart <= fars[o->first] + fars[o->second] + sag_)
    {
      if (near_[std::size_t(o->near)].linked)
      {
        continue;
      }
      if (!rocks_.areAsleep(o->first, o->second) && this->mayMeet(*o))
      {
        chosen_.push_back(std::size_t(to - first));
      }
    }
    *to++ = *o;
  }
  undecided_.resize(std::size_t(to - first));
}

/// Looks at all that are open; returns whether others have to be told of what it has shown.
bool IslandFinder::sweep()
{
  this->widenIslands();
  this->choose();
  bool any = false;
  asked_.clear();
  placed_.clear();
  for (const std::size_t o : chosen_)
  {
    const std::size_t k = std::size_t(undecided_[o].near);
    NearPair& n = near_[k];
    if (n.pair && n.looked < 0.0 && this->root(n.first) == this->root(n.second))
    {
      // Of one island they are: how far apart is looked at when their contacts are.
      this->join(k, false);
      any = true;
      continue;
    }
    near_.keep(n);
    asked_.push_back(o);
    for (const int i : { n.first, n.second })
    {
      if (!marks_[std::size_t(i)])
      {
        marks_[std::size_t(i)] = 1;
        placed_.push_back(i);
      }
    }
  }
  forEach(placed_.size(), kLookGrain,
    [&](std::size_t k) { world_.rocks[std::size_t(placed_[k])].updatePose(); });
  answers_.resize(std::max(answers_.size(), asked_.size()));
  forEach(asked_.size(), kLookGrain,
    [&](std::size_t k) { answers_[k] = this->meet(std::size_t(undecided_[asked_[k]].near)); });
  for (const int i : placed_)
  {
    marks_[std::size_t(i)] = 0;
  }
  for (std::size_t a = 0; a < asked_.size(); ++a)
  {
    UndecidedPair& o = undecided_[asked_[a]];
    o.apart = aparts_[std::size_t(o.near)];
    if (answers_[a])
    {
      this->join(std::size_t(o.near), true);
      any = true;
    }
  }
  return any;
}

void IslandFinder::link()
{
  firstLink_.assign(rocks_.bodies.size(), -1);
  links_.clear();
  links_.reserve(near_.size());
  queue_.reset(rocks_.bodies.size(), longest_);
  this->look();
  this->propagate();
  while (this->sweep())
  {
    this->propagate();
  }
  this->settle();
  this->unite();
}

} // namespace rockfall
