// Which rocks are near each other in a step; which of them may meet: massFallLink.cxx.
//
// Two rocks may meet if their gap can close within the step. How fast it closes follows from what
// their velocities can become: those of a rock that flies are known; what touches the slope may be
// stopped or thrown back; and what belongs to a company of rocks that may touch each other may get
// any velocity that is among theirs, by impacts from rock to rock. On the other hand no rock goes
// further than its own way, or than what is left of the way of the one that strikes it, less the
// gaps that had to be crossed before. The smaller of the two bounds holds.

#include "simulation/massFallMeet.h"

#include "base/parallel.h"
#include "contact/motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rockfall
{

namespace
{

constexpr std::size_t kRockGrain = 64, kNearGrain = 256;

/// Neighbours are looked for within this many times the way that is known, which may yet grow.
constexpr double kWider = 1.1;

} // namespace

void MassFall::Meetings::follow(MassFall& fall, double duration)
{
  const std::size_t count = fall.members_.size();
  duration_ = duration;
  fall_ = fall.parameters_.gravity * duration * duration;
  if (movers.empty())
  {
    movers.resize(count);
    companies_.resize(count);
    parents_.resize(count);
    roots_.resize(count);
    boxes_.resize(count);
    later_.resize(count);
    marks_.resize(count, 0);
    for (std::size_t i = 0; i < count; ++i)
    {
      movers[i].radius = fall.members_[i]->sim.block_.radius();
      movers[i].mass = fall.members_[i]->sim.block_.mass();
    }
    bounciest_ = fall.contacts_.largestRestitution();
  }
  double ground = fall.surface_.restitution();
  for (int k = 1; k <= fall.surface_.terrain().restitutionClasses().count(); ++k)
  {
    ground = std::max(ground, fall.surface_.restitutionOf(k));
  }
  const auto followRock = [&](std::size_t i)
  {
    Mover& m = movers[i];
    const Member& member = *fall.members_[i];
    const RockSimulator& sim = member.sim;
    const bool slept = m.asleep;
    m.asleep = member.asleep;
    m.present = !sim.done_ || m.asleep;
    m.queued = false;
    m.thrown = 1.0;
    if (!m.present || (slept && m.asleep))
    {
      m.way = m.known = 0.0;
      return;
    }
    const BlockState& s = sim.state_;
    m.position = s.position;
    m.turned +=
      wayOfTurn(m.orientation, s.orientation, m.radius) + m.radius * (s.strain - m.strain).norm();
    m.orientation = s.orientation;
    m.strain = s.strain;
    if (m.asleep)
    {
      m.middle.setZero();
      m.spread = m.own = m.way = m.known = 0.0;
      return;
    }
    const double speed = s.velocity.norm(), rim = sim.block_.largestRimSpeed(s.spin);
    m.own = (speed + rim) * duration + fall_;
    // What stands farther off than it may come has no say.
    const double way = m.radius + m.own;
    const Vec3& p = m.position;
    const bool obstructed =
      sim.obstacles_ && sim.obstacles_->anyIn(p.x() - way, p.x() + way, p.y() - way, p.y() + way);
    const bool flies = !obstructed && sim.contacts_.empty() && sim.clearFor(duration);
    // Velocities that an impact on the slope leaves, with any normal.
    const double e = obstructed ? 1.0 : ground;
    m.middle = flies ? s.velocity : Vec3(0.5 * (1.0 - e) * s.velocity);
    m.spread = rim + (flies ? 0.0 : 0.5 * (1.0 + e) * speed);
    // In a crowd it is struck by much the same ones as in the last step.
    m.known = kWider * std::max(m.own, m.way) + fall_;
    m.way = m.own;
  };
  forEach(count, kRockGrain, followRock);
  sleepers_ = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const Mover& m = movers[i];
    sleepers_ += m.present && m.asleep;
    companies_[i] = { m.middle.array() - m.spread, m.middle.array() + m.spread, m.mass, 1 };
    boxes_[i] = { m.position, m.radius + m.known, m.present, m.present && !m.asleep };
  }
  std::iota(parents_.begin(), parents_.end(), 0);
  std::iota(roots_.begin(), roots_.end(), 0);
}

/// From now on the gap is bounded along the pair's axis.
void MassFall::Meetings::lookAlong(Near& n) const
{
  const Mover &a = movers[std::size_t(n.first)], &b = movers[std::size_t(n.second)];
  n.normal = n.pair->axis.normal;
  n.offset = n.pair->axis.distance - n.normal.dot(a.position - b.position) + a.turned + b.turned;
}

RockPair* MassFall::Meetings::newPair(const MassFall& fall, int first, int second)
{
  if (spare_.empty())
  {
    spare_.push_back(&pairs_.emplace_back());
  }
  RockPair* pair = spare_.back();
  spare_.pop_back();
  pair->first = first;
  pair->second = second;
  pair->law = fall.contacts_.between(first, second);
  return pair;
}

void MassFall::Meetings::drop(MassFall& fall, Near& n)
{
  if (n.pair)
  {
    fall.closePairBooks(*n.pair);
    std::vector<Contact> contacts = std::move(n.pair->contacts);
    contacts.clear();
    *n.pair = RockPair();
    n.pair->contacts = std::move(contacts);
    spare_.push_back(n.pair);
  }
}

void MassFall::Meetings::findNear(MassFall& fall)
{
  broad_.place(boxes_);
  const std::span<const std::array<int, 2>> found = broad_.pairs();
  // What lasts of those that are still near, and of sleepers, which are not looked for.
  nextNear_.clear();
  nextNear_.reserve(std::max(found.size(), near.size()));
  auto old = near.begin();
  const auto take = [&](const Near& n)
  {
    Near& next = nextNear_.emplace_back(n);
    next.wasLinked = n.linked;
    next.linked = false;
    next.looked = -1.0;
  };
  const auto leave = [&](Near& n)
  {
    if (n.pair && this->isAsleep(n))
    {
      take(n);
    }
    else
    {
      this->drop(fall, n);
    }
  };
  for (const std::array<int, 2>& ij : found)
  {
    Near n;
    n.first = ij[0];
    n.second = ij[1];
    for (; old != near.end() && *old < n; ++old)
    {
      leave(*old);
    }
    if (old != near.end() && !(n < *old))
    {
      take(*old++);
      continue;
    }
    n.offset = kNoAxis;
    nextNear_.push_back(n);
  }
  for (; old != near.end(); ++old)
  {
    leave(*old);
  }
  near.swap(nextNear_);
  sorted_ = near.size();
  widened_ = 0.0;
  this->indexNeighbours();
}

void MassFall::Meetings::indexNeighbours()
{
  firsts_.assign(movers.size() + 1, 0);
  for (const Near& n : near)
  {
    ++firsts_[std::size_t(n.first)];
    ++firsts_[std::size_t(n.second)];
  }
  std::size_t sum = 0;
  for (std::size_t& first : firsts_)
  {
    sum += first;
    first = sum;
  }
  places_.resize(sum);
  for (std::size_t k = near.size(); k-- > 0;)
  {
    places_[--firsts_[std::size_t(near[k].first)]] = k;
    places_[--firsts_[std::size_t(near[k].second)]] = k;
  }
  for (const int i : widenedRocks_)
  {
    later_[std::size_t(i)].clear();
  }
  widenedRocks_.clear();
}

/// Those that a rock may meet which goes further than the broad phase had it.
void MassFall::Meetings::addNeighbours(int rock)
{
  Mover& m = movers[std::size_t(rock)];
  m.known = kWider * (m.thrown * m.way + fall_);
  broad_.within(m.position, m.radius + m.known + widened_, found_);
  widened_ = std::max(widened_, m.known - (boxes_[std::size_t(rock)].radius - m.radius));
  const auto other = [&](std::size_t k)
  { return std::size_t(near[k].first == rock ? near[k].second : near[k].first); };
  this->forNeighbours(rock, [&](std::size_t k) { marks_[other(k)] = 1; });
  marks_[std::size_t(rock)] = 1;
  for (const int j : found_)
  {
    const Mover& o = movers[std::size_t(j)];
    const double reach = m.radius + m.known + o.radius + o.known;
    if (!marks_[std::size_t(j)] && (m.position - o.position).squaredNorm() <= reach * reach)
    {
      Near n;
      n.first = std::min(rock, j);
      n.second = std::max(rock, j);
      n.offset = kNoAxis;
      for (const int i : { rock, j })
      {
        later_[std::size_t(i)].push_back(near.size());
        widenedRocks_.push_back(i);
      }
      near.push_back(n);
    }
  }
  nextLink_.resize(near.size());
  this->forNeighbours(rock, [&](std::size_t k) { marks_[other(k)] = 0; });
  marks_[std::size_t(rock)] = 0;
}

} // namespace rockfall
