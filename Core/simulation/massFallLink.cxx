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

double MassFall::Meetings::gap(const Near& n) const
{
  const Mover &a = movers[std::size_t(n.first)], &b = movers[std::size_t(n.second)];
  return n.offset + n.normal.dot(a.position - b.position) - a.turned - b.turned;
}

/// How fast the gap may close along its normal, m/s.
double MassFall::Meetings::closing(const Near& n) const
{
  const std::size_t i = std::size_t(n.first), j = std::size_t(n.second);
  const Company& first = companies_[std::size_t(roots_[i])];
  const Company& second = companies_[std::size_t(roots_[j])];
  const double towards =
    first.size > 1 ? most(first, -n.normal) : movers[i].spread - n.normal.dot(movers[i].middle);
  const double against =
    second.size > 1 ? most(second, n.normal) : movers[j].spread + n.normal.dot(movers[j].middle);
  return std::max(0.0, towards + against);
}

/// A light rock that a heavy one strikes goes on faster than it, by this factor.
double MassFall::Meetings::thrown(std::size_t rock) const
{
  const Company& c = companies_[std::size_t(roots_[rock])];
  return std::max(1.0, (1.0 + bounciest_) * c.heaviest / (c.heaviest + movers[rock].mass));
}

/// How far the two may come towards each other, m.
double MassFall::Meetings::ways(const Near& n) const
{
  const std::size_t i = std::size_t(n.first), j = std::size_t(n.second);
  return movers[i].thrown * movers[i].way + movers[j].thrown * movers[j].way;
}

/// The widest gap over which the two may meet.
double MassFall::Meetings::reach(const Near& n) const
{
  const double faster =
    std::max(movers[std::size_t(n.first)].thrown, movers[std::size_t(n.second)].thrown);
  const double speed = n.offset > kNoAxis ? faster * this->closing(n) : -kNoAxis;
  return std::min(this->ways(n), speed * duration_) + fall_;
}

bool MassFall::Meetings::isWithin(const Near& n, double reach) const
{
  if (this->gap(n) > reach)
  {
    return false;
  }
  const Mover &a = movers[std::size_t(n.first)], &b = movers[std::size_t(n.second)];
  const double most = a.radius + b.radius + reach;
  return (a.position - b.position).squaredNorm() <= most * most;
}

bool MassFall::Meetings::mayMeet(const Near& n) const
{
  // By their ways alone first: that tells most of them apart.
  return this->isWithin(n, this->ways(n) + fall_) && this->isWithin(n, this->reach(n));
}

bool MassFall::Meetings::isAsleep(const Near& n) const
{
  return movers[std::size_t(n.first)].asleep && movers[std::size_t(n.second)].asleep;
}

/// Whether two rocks that stand may meet; finds their axis as far as that needs it.
bool MassFall::Meetings::meet(const MassFall& fall, Near& n)
{
  RockPair& pair = *n.pair;
  for (;;)
  {
    const double reach = this->reach(n);
    const bool exact = n.looked >= 0.0 && pair.axis.distance <= n.looked;
    if (exact || n.looked >= reach)
    {
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

/// Looks at all that are near each other; returns whether more of them may meet.
bool MassFall::Meetings::sweep(MassFall& fall)
{
  for (std::size_t i = 0; i < roots_.size(); ++i)
  {
    roots_[i] = this->root(int(i));
  }
  const auto goesFurther = [&](std::size_t i)
  {
    Mover& m = movers[i];
    m.thrown = this->thrown(i);
    return m.present && !m.asleep && companies_[std::size_t(roots_[i])].size > 1 &&
      m.thrown * m.way + fall_ > m.known;
  };
  forThose(movers.size(), kNearGrain, asks_, goesFurther,
    [&](std::size_t i) { this->addNeighbours(int(i)); });
  const auto meets = [&](std::size_t k)
  {
    const Near& n = near[k];
    return !n.linked && !this->isAsleep(n) && this->mayMeet(n);
  };
  bool any = false;
  asked_.clear();
  placed_.clear();
  const auto ask = [&](std::size_t k)
  {
    Near& n = near[k];
    if (n.pair && n.looked < 0.0 && this->root(n.first) == this->root(n.second))
    {
      // Of one company they are: how far apart is looked at when their contacts are.
      this->join(fall, k, false);
      any = true;
      return;
    }
    n.pair = n.pair ? n.pair : this->newPair(fall, n.first, n.second);
    asked_.push_back(k);
    for (const int i : { n.first, n.second })
    {
      if (!marks_[std::size_t(i)])
      {
        marks_[std::size_t(i)] = 1;
        placed_.push_back(i);
      }
    }
  };
  forThose(near.size(), kNearGrain, asks_, meets, ask);
  forEach(placed_.size(), kLookGrain,
    [&](std::size_t k) { fall.members_[std::size_t(placed_[k])]->stand(); });
  forEach(asked_.size(), kLookGrain,
    [&](std::size_t k) { asks_[asked_[k]] = this->meet(fall, near[asked_[k]]); });
  for (const int i : placed_)
  {
    marks_[std::size_t(i)] = 0;
  }
  for (const std::size_t k : asked_)
  {
    if (asks_[k])
    {
      this->join(fall, k, true);
      any = true;
    }
  }
  return any;
}

/// Links two; `known`: their axis has been found for where they stand.
void MassFall::Meetings::join(MassFall& fall, std::size_t k, bool known)
{
  Near& n = near[k];
  nextLink_[k] = { std::exchange(firstLink_[std::size_t(n.first)], int(k)),
    std::exchange(firstLink_[std::size_t(n.second)], int(k)) };
  n.linked = n.holds = true;
  n.known = known;
  for (const int i : { n.first, n.second })
  {
    Mover& m = movers[std::size_t(i)];
    if (m.asleep)
    {
      fall.wake(*fall.members_[std::size_t(i)]);
      m.asleep = false;
      --sleepers_;
    }
    if (!m.queued)
    {
      m.queued = true;
      queue_.push_back(i);
    }
  }
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
    if (!n.linked && other.asleep && this->mayMeet(n))
    {
      n.pair = n.pair ? n.pair : this->newPair(fall, n.first, n.second);
      fall.members_[std::size_t(n.first)]->stand();
      fall.members_[std::size_t(n.second)]->stand();
      if (this->meet(fall, n))
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
  const double way = movers[std::size_t(rock)].way;
  for (int k = firstLink_[std::size_t(rock)]; k >= 0;)
  {
    const Near& n = near[std::size_t(k)];
    const bool first = n.first == rock;
    const int next = nextLink_[std::size_t(k)][first ? 0 : 1];
    Mover& other = movers[std::size_t(first ? n.second : n.first)];
    if (way > other.way * kNoMore)
    {
      // The gap must be crossed first, by both together.
      const double left =
        way - std::max(0.0, this->gap(n)) * way / std::max(way + other.own, 1e-12);
      if (left > other.way * kNoMore)
      {
        other.way = left;
        other.queued = true;
        queue_.push_back(first ? n.second : n.first);
      }
    }
    k = next;
  }
}

/// Carries on what each rock that has been joined may do to those that it may meet: the longest way
/// first, so that none has its turn twice.
void MassFall::Meetings::tell(MassFall& fall)
{
  // In one number that orders them: the way, rounded, and the rock.
  const auto turnOf = [this](int i)
  {
    const auto way = std::bit_cast<std::uint32_t>(float(movers[std::size_t(i)].way));
    return (std::uint64_t(way) << 32) + ~std::uint32_t(i);
  };
  turns_.clear();
  for (std::size_t taken = 0;;)
  {
    for (; taken < queue_.size(); ++taken)
    {
      turns_.push_back(turnOf(queue_[taken]));
      std::push_heap(turns_.begin(), turns_.end());
    }
    if (turns_.empty())
    {
      break;
    }
    const std::uint64_t turn = turns_.front();
    std::pop_heap(turns_.begin(), turns_.end());
    turns_.pop_back();
    const int i = int(~std::uint32_t(turn));
    Mover& m = movers[std::size_t(i)];
    if (!m.queued || turn != turnOf(i))
    {
      continue; // has had its turn, or has a longer way since
    }
    m.queued = false;
    roots_[std::size_t(i)] = this->root(i);
    m.thrown = this->thrown(std::size_t(i));
    if (sleepers_ > 0)
    {
      this->wakeAbout(fall, i);
    }
    this->passOn(i);
  }
  queue_.clear();
}

void MassFall::Meetings::link(MassFall& fall)
{
  // What overlaps is known already.
  firstLink_.assign(movers.size(), -1);
  nextLink_.resize(near.size());
  const auto overlap = [&](std::size_t k)
  {
    Near& n = near[k];
    const bool seen = n.pair && n.pair->seen; // found where they stand
    if (seen)
    {
      this->lookAlong(n);
    }
    return seen && n.pair->axis.distance <= 0.0 && !this->isAsleep(n);
  };
  forThose(
    near.size(), kNearGrain, asks_, overlap, [&](std::size_t k) { this->join(fall, k, false); });
  this->tell(fall);
  while (this->sweep(fall))
  {
    this->tell(fall);
  }
  const auto behind = near.begin() + std::ptrdiff_t(sorted_);
  std::sort(behind, near.end());
  std::inplace_merge(near.begin(), behind, near.end());
  const auto settle = [&](std::size_t k)
  {
    Near& n = near[k];
    if (n.linked)
    {
      n.pair->linked = true;
      n.pair->known = n.known;
      return;
    }
    if (!(n.holds || n.wasLinked || n.looked >= 0.0))
    {
      return;
    }
    const bool asleep = this->isAsleep(n);
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
  forEach(near.size(), kNearGrain, settle);
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
      continue;
    }
    if (place[root] < 0)
    {
      place[root] = int(groups_.size());
      groups_.emplace_back();
    }
    groups_[std::size_t(place[root])].members.push_back(int(i));
  }
  for (const Near& n : meet.near)
  {
    if (n.linked)
    {
      groups_[std::size_t(place[std::size_t(meet.root(n.first))])].pairs.push_back(n.pair);
    }
  }
  for (Group& group : groups_)
  {
    group.crowd = this->isCrowd(group);
  }
}

} // namespace rockfall
