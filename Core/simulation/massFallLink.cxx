// Which of the rocks that are near each other may meet within the step, and the groups that they
// are: massFallMeet.cxx says by what bounds.

#include "simulation/massFallMeet.h"

#include "base/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace rockfall
{

namespace
{

constexpr std::size_t kNearGrain = 256, kLookGrain = 16;

/// A way that is longer by no more than this factor is not passed on.
constexpr double kNoMore = 1.0 + 1e-6;

/// What a look at two rocks near each other has shown: they may meet if they go far, as far as is
/// known they don't, their bounding spheres tell them apart, or they overlap.
enum : char
{
  kOpen,
  kShut,
  kApart,
  kOverlaps,
};

/// Largest component along the normal of a velocity in a box.
double most(const Company& c, const Vec3& normal)
{
  return normal.cwiseProduct(c.lower).cwiseMax(normal.cwiseProduct(c.upper)).sum();
}

} // namespace

int MassFall::Meetings::root(int i)
{
  while (parents_[std::size_t(i)] != i)
  {
    i = parents_[std::size_t(i)] = parents_[std::size_t(parents_[std::size_t(i)])];
  }
  return i;
}

/// From now on the gap is bounded along the pair's axis.
void MassFall::Meetings::lookAlong(Near& n) const
{
  const Mover &a = movers[std::size_t(n.first)], &b = movers[std::size_t(n.second)];
  n.normal = n.pair->axis.normal;
  n.offset = n.pair->axis.distance - n.normal.dot(a.position - b.position) + a.turned + b.turned;
}

double MassFall::Meetings::gap(const Near& n) const
{
  const Mover &a = movers[std::size_t(n.first)], &b = movers[std::size_t(n.second)];
  return n.offset + n.normal.dot(a.position - b.position) - a.turned - b.turned;
}

/// How far apart they are at least, along the axis and by their bounding spheres, m.
double MassFall::Meetings::apart(const Near& n) const
{
  const Mover &a = movers[std::size_t(n.first)], &b = movers[std::size_t(n.second)];
  return std::max(this->gap(n), (a.position - b.position).norm() - a.radius - b.radius);
}

/// How fast the gap may close along its normal, m/s.
inline double MassFall::Meetings::closing(const Near& n) const
{
  const std::size_t i = std::size_t(n.first), j = std::size_t(n.second);
  const Company& first = companies_[std::size_t(roots_[i])];
  const Company& second = companies_[std::size_t(roots_[j])];
  if (&first == &second)
  {
    return n.normal.cwiseAbs().dot(first.upper - first.lower);
  }
  const double towards =
    first.size > 1 ? most(first, -n.normal) : paces_[i].spread - n.normal.dot(paces_[i].middle);
  const double against =
    second.size > 1 ? most(second, n.normal) : paces_[j].spread + n.normal.dot(paces_[j].middle);
  return std::max(0.0, towards + against);
}

/// A light rock that a heavy one strikes goes on faster than it, by this factor.
double MassFall::Meetings::thrown(std::size_t rock) const
{
  const double heaviest = companies_[std::size_t(roots_[rock])].heaviest;
  const double mass = paces_[rock].mass;
  return bounciest_ * heaviest > mass ? (1.0 + bounciest_) * heaviest / (heaviest + mass) : 1.0;
}

/// The widest gap over which the two may meet.
inline double MassFall::Meetings::reach(const Near& n) const
{
  const std::size_t i = std::size_t(n.first), j = std::size_t(n.second);
  const double faster = std::max(paces_[i].thrown, paces_[j].thrown);
  const double speed = n.offset > kNoAxis ? faster * this->closing(n) : -kNoAxis;
  return std::min(fars_[i] + fars_[j], speed * duration_) + fall_;
}

inline bool MassFall::Meetings::mayMeet(const Open& o) const
{
  // By their ways alone first: that tells most of them apart.
  return o.apart <= fars_[std::size_t(o.first)] + fars_[std::size_t(o.second)] + fall_ &&
    o.apart <= this->reach(near[std::size_t(o.near)]);
}

bool MassFall::Meetings::isAsleep(int first, int second) const
{
  return movers[std::size_t(first)].asleep && movers[std::size_t(second)].asleep;
}

/// Whether two rocks that stand may meet; finds their axis as far as that needs it.
bool MassFall::Meetings::meet(const MassFall& fall, std::size_t k)
{
  Near& n = near[k];
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
      pair.axis = findAxis(fall.members_[std::size_t(n.first)]->body,
        fall.members_[std::size_t(n.second)]->body, pair.axis, reach);
    }
    pair.seen = false;
    n.looked = reach;
    this->lookAlong(n);
    // Along this axis the velocities may tell more, or less: then once more.
  }
}

/// What has to be known of all that are near each other before the first of them are linked.
void MassFall::Meetings::look(MassFall& fall)
{
  states_.resize(near.size());
  aparts_.resize(near.size());
  const auto lookAt = [this, nears = near.data(), rocks = movers.data(), aparts = aparts_.data(),
                        states = states_.data()](std::size_t k)
  {
    Near& n = nears[k];
    n.wasLinked = n.linked;
    n.linked = false;
    n.looked = -1.0;
    n.seen = n.holds && n.pair->seen; // found where they stand
    const Mover &a = rocks[n.first], &b = rocks[n.second];
    const Vec3 between = a.position - b.position;
    const double spheres = between.norm() - (a.radius + b.radius);
    const double known = a.known + b.known, turned = a.turned + b.turned;
    char state = kShut;
    if (n.seen)
    {
      const PairAxis& axis = n.pair->axis;
      n.normal = axis.normal;
      n.offset = axis.distance - n.normal.dot(between) + turned;
      state = axis.distance <= 0.0 ? char(kOverlaps) : state;
    }
    const double apart = std::max(n.offset + n.normal.dot(between) - turned, spheres);
    aparts[k] = apart;
    state = state == kShut && apart <= known ? char(kOpen) : state;
    if (!a.present || !b.present)
    {
      aparts[k] = -kNoAxis;
      state = kApart;
    }
    else if (a.asleep && b.asleep)
    {
      state = kShut;
    }
    else if (spheres > known)
    {
      state = kApart;
    }
    states[k] = state;
  };
  forEach(near.size(), kNearGrain, lookAt);
  open_.resize(near.size());
  Open* to = open_.data();
  for (std::size_t k = 0; k < near.size(); ++k)
  {
    switch (states_[k])
    {
      case kApart:
        if (near[k].pair)
        {
          this->drop(fall, near[k]);
        }
        break;
      case kOverlaps:
        this->join(fall, k, false);
        break;
      case kOpen:
        *to++ = this->openOf(k);
        break;
    }
  }
  open_.resize(std::size_t(to - open_.data()));
}

MassFall::Meetings::Open MassFall::Meetings::openOf(std::size_t k) const
{
  return { aparts_[k], near[k].first, near[k].second, int(k) };
}

/// Takes up those that ways reach that have outgrown what was known.
void MassFall::Meetings::widen()
{
  for (std::size_t k = states_.size(); k < near.size(); ++k)
  {
    states_.push_back(kShut);
    aparts_.push_back(this->apart(near[k]));
  }
  for (std::size_t k = 0; k < near.size(); ++k)
  {
    const Mover &a = movers[std::size_t(near[k].first)], &b = movers[std::size_t(near[k].second)];
    if ((states_[k] == kShut || states_[k] == kApart) && aparts_[k] <= a.known + b.known)
    {
      states_[k] = kOpen;
      open_.push_back(this->openOf(k));
    }
  }
}

/// Looks at all that are open; returns whether more of them may meet.
bool MassFall::Meetings::sweep(MassFall& fall)
{
  bool wider = false;
  for (std::size_t i = 0; i < movers.size(); ++i)
  {
    // Parents come before their children.
    roots_[i] = parents_[i] = roots_[std::size_t(parents_[i])];
    Mover& m = movers[i];
    if (companies_[std::size_t(roots_[i])].size == 1)
    {
      continue;
    }
    paces_[i].thrown = this->thrown(i);
    fars_[i] = paces_[i].thrown * m.way;
    if (fars_[i] + fall_ > m.known && m.present && !m.asleep)
    {
      m.known = kWider * (fars_[i] + fall_);
      wider = true;
      if (!this->isCovered(i))
      {
        this->cover(int(i));
      }
    }
  }
  if (wider)
  {
    this->widen();
  }
  chosen_.clear();
  Open* const first = open_.data();
  Open* to = first;
  const double* const fars = fars_.data();
  for (const Open *o = first, *end = first + open_.size(); o != end; ++o)
  {
    if (o->apart <= fars[o->first] + fars[o->second] + fall_)
    {
      if (near[std::size_t(o->near)].linked)
      {
        continue;
      }
      if (!this->isAsleep(o->first, o->second) && this->mayMeet(*o))
      {
        chosen_.push_back(std::size_t(to - first));
      }
    }
    *to++ = *o;
  }
  open_.resize(std::size_t(to - first));
  bool any = false;
  asked_.clear();
  placed_.clear();
  for (const std::size_t o : chosen_)
  {
    const std::size_t k = std::size_t(open_[o].near);
    Near& n = near[k];
    if (n.pair && n.looked < 0.0 && (this->stays(n) || this->root(n.first) == this->root(n.second)))
    {
      // Of one company they are: how far apart is looked at when their contacts are.
      this->join(fall, k, false);
      any = true;
      continue;
    }
    n.pair = n.pair ? n.pair : this->newPair(fall, n.first, n.second);
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
    [&](std::size_t k) { fall.members_[std::size_t(placed_[k])]->stand(); });
  answers_.resize(std::max(answers_.size(), asked_.size()));
  forEach(asked_.size(), kLookGrain,
    [&](std::size_t k) { answers_[k] = this->meet(fall, std::size_t(open_[asked_[k]].near)); });
  for (const int i : placed_)
  {
    marks_[std::size_t(i)] = 0;
  }
  for (std::size_t a = 0; a < asked_.size(); ++a)
  {
    Open& o = open_[asked_[a]];
    o.apart = aparts_[std::size_t(o.near)];
    if (answers_[a])
    {
      this->join(fall, std::size_t(o.near), true);
      any = true;
    }
  }
  return any;
}

/// In a crowd two stay linked as long as they may meet for all that is known of them: their axis is
/// looked for when their contacts are, within a shorter reach.
bool MassFall::Meetings::stays(const Near& n) const
{
  const Mover &a = movers[std::size_t(n.first)], &b = movers[std::size_t(n.second)];
  return n.wasLinked && (n.seen || n.pair->touched) && a.crowded && b.crowded && !a.asleep &&
    !b.asleep;
}

/// Links two; `known`: their axis has been found for where they stand.
void MassFall::Meetings::join(MassFall& fall, std::size_t k, bool known)
{
  Near& n = near[k];
  n.linked = n.holds = true;
  n.pair->linked = true;
  n.pair->known = known;
  const auto linkTo = [&](int i, int other)
  {
    const int next = std::exchange(firstLink_[std::size_t(i)], int(links_.size()));
    links_.push_back({ aparts_[k], other, next });
    Mover& m = movers[std::size_t(i)];
    if (m.asleep)
    {
      fall.wake(*fall.members_[std::size_t(i)]);
      m.asleep = false;
      --sleepers_;
    }
    turns_.add(i, m.way);
  };
  linkTo(n.first, n.second);
  linkTo(n.second, n.first);
  const int a = this->root(n.first), b = this->root(n.second);
  if (a == b)
  {
    return;
  }
  Company &kept = companies_[std::size_t(std::min(a, b))],
          &other = companies_[std::size_t(std::max(a, b))];
  parents_[std::size_t(std::max(a, b))] = std::min(a, b);
  kept.lower = kept.lower.cwiseMin(other.lower);
  kept.upper = kept.upper.cwiseMax(other.upper);
  kept.heaviest = std::max(kept.heaviest, other.heaviest);
  kept.size += other.size;
}

/// All that lies on each other wakes at once; others have their turn in the next sweep.
void MassFall::Meetings::wakeAbout(MassFall& fall, int rock)
{
  const auto visit = [&](std::size_t k)
  {
    Near& n = near[k];
    const Mover& other = movers[std::size_t(n.first == rock ? n.second : n.first)];
    if (k < states_.size() && !n.linked && other.asleep && other.present &&
      this->mayMeet(this->openOf(k)))
    {
      n.pair = n.pair ? n.pair : this->newPair(fall, n.first, n.second);
      fall.members_[std::size_t(n.first)]->stand();
      fall.members_[std::size_t(n.second)]->stand();
      if (this->meet(fall, k))
      {
        this->join(fall, k, true);
      }
    }
  };
  this->forNeighbours(rock, visit);
}

/// What is left of a rock's way, to those that it is linked with.
void MassFall::Meetings::passOn(int rock)
{
  Mover* const rocks = movers.data();
  const double way = rocks[rock].way;
  const Link* const links = links_.data();
  for (int l = firstLink_[std::size_t(rock)]; l >= 0; l = links[l].next)
  {
    Mover& other = rocks[links[l].other];
    if (way > other.way * kNoMore)
    {
      // The gap must be crossed first, by both together.
      const double own = paces_[std::size_t(links[l].other)].own;
      const double left = way - std::max(0.0, links[l].gap) * way / std::max(way + own, 1e-12);
      if (left > other.way * kNoMore)
      {
        other.way = left;
        turns_.add(links[l].other, left);
      }
    }
  }
}

/// Carries on what each rock that has been joined may do to those that it may meet: the longest way
/// first, so that few have their turn twice.
void MassFall::Meetings::tell(MassFall& fall)
{
  for (int i = turns_.take(); i >= 0; i = turns_.take())
  {
    const std::size_t rock = std::size_t(i);
    roots_[rock] = this->root(i);
    paces_[rock].thrown = this->thrown(rock);
    fars_[rock] = paces_[rock].thrown * movers[rock].way;
    if (sleepers_ > 0)
    {
      this->wakeAbout(fall, i);
    }
    this->passOn(i);
  }
}

void MassFall::Meetings::link(MassFall& fall)
{
  firstLink_.assign(movers.size(), -1);
  links_.clear();
  links_.reserve(near.size());
  turns_.reset(movers.size(), longest_);
  this->look(fall);
  this->tell(fall);
  while (this->sweep(fall))
  {
    this->tell(fall);
  }
  this->settle();
}

/// Who is no longer linked.
void MassFall::Meetings::settle()
{
  const auto part = [&](std::size_t k)
  {
    Near& n = near[k];
    if (n.linked || !(n.holds || n.wasLinked))
    {
      return;
    }
    const bool asleep = this->isAsleep(n.first, n.second);
    if (asleep && !n.wasLinked)
    {
      return;
    }
    n.pair->linked = n.pair->known = false;
    if (!asleep)
    {
      // Who is awake and not linked moves by himself, away from where the axis was found.
      n.pair->seen = n.pair->touched = n.holds = false;
      n.pair->contacts.clear();
    }
  };
  forEach(near.size(), kNearGrain, part);
}

void MassFall::findGroups(double duration)
{
  Meetings& meet = *meetings_;
  meet.follow(*this, duration);
  meet.findNear(*this);
  meet.link(*this);
  std::vector<int>& place = groupOf_;
  place.assign(members_.size(), -1);
  groups_.clear();
  alone_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i)
  {
    if (!meet.movers[i].present || meet.movers[i].asleep)
    {
      continue;
    }
    const std::size_t root = std::size_t(meet.root(int(i)));
    if (meet.isAlone(root))
    {
      alone_.push_back(int(i));
      meet.movers[i].crowded = false;
      continue;
    }
    if (place[root] < 0)
    {
      place[root] = int(groups_.size());
      groups_.emplace_back();
    }
    place[i] = place[root];
    groups_[std::size_t(place[root])].members.push_back(int(i));
  }
  for (const Near& n : meet.near)
  {
    if (n.linked)
    {
      groups_[std::size_t(place[std::size_t(n.first)])].pairs.push_back(n.pair);
    }
  }
  for (Group& group : groups_)
  {
    group.crowd = this->isCrowd(group);
    for (const int i : group.members)
    {
      meet.movers[std::size_t(i)].crowded = group.crowd;
    }
  }
}

} // namespace rockfall
