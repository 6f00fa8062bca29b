// Rocks that are near each other in a step; those of them that may meet: islandFinderLink.cxx.
//
// Neighbours are looked for in balls about the rocks, wide enough for a few steps, and again when a
// rock may come out of its own: for this one alone, or, if there are many such, for all.
//
// Two rocks may meet if their gap can close within the step. How fast it closes follows from what
// their velocities can become: those of a rock that flies are known; what touches the slope may be
// stopped or thrown back; and what belongs to an island of rocks that may touch each other may get
// any velocity that is among theirs, by impacts from rock to rock. On the other hand no rock goes
// further than its own displacement, or than what is left of the displacement of the one that
// strikes it, less the gaps that had to be crossed before. The smaller of the two bounds holds.

#include "world/IslandFinder.h"

#include "base/parallel.h"
#include "contact/ground/motion.h"
#include "law/settings.h"
#include "world/pairImpacts.h"
#include "world/sleep.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

constexpr std::size_t kFollowGrain = 64;

/// All are looked for anew when this share of them have come out of their balls.
constexpr std::size_t kMostOut = 4;

} // namespace

void IslandFinder::follow(double duration)
{
  const std::size_t count = world_.rocks.size();
  duration_ = duration;
  sag_ = world_.parameters.gravity * duration * duration;
  const auto followRock = [&](std::size_t i)
  {
    BodyBounds& m = bodies_[i];
    VelocityBounds& velocities = velocityBounds_[i];
    const FallingRock& member = world_.rocks[i];
    const SingleRock& sim = member.sim;
    const bool slept = m.asleep;
    m.asleep = member.asleep;
    m.present = !sim.body().done || m.asleep;
    massRatioGains_[i] = 1.0;
    fars_[i] = 0.0;
    if (!m.present || (slept && m.asleep))
    {
      m.displacement = m.known = 0.0;
      return;
    }
    const BlockState& s = sim.body().state;
    m.position = s.position;
    m.rimTravel += rimTravel(velocities.orientation, s.orientation, m.radius) +
      m.radius * (s.strain - velocities.strain).norm();
    velocities.orientation = s.orientation;
    velocities.strain = s.strain;
    if (m.asleep)
    {
      velocities.middle.setZero();
      velocities.velocity.setZero();
      velocities.spread = velocities.own = m.displacement = m.known = 0.0;
      return;
    }
    velocities.velocity = s.velocity;
    boundVelocities(world_, sim, duration, velocities);
    // Much the same rocks strike it as in the last step.
    m.known = kWider * std::max(velocities.own, m.displacement) + sag_;
    m.displacement = fars_[i] = velocities.own;
  };
  forEach(count, kFollowGrain, followRock);
  sleepers_ = 0;
  int present = 0;
  drift_.setZero();
  longest_ = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const BodyBounds& m = bodies_[i];
    const VelocityBounds& velocities = velocityBounds_[i];
    longest_ = std::max(longest_, m.displacement);
    sleepers_ += m.present && m.asleep;
    bounds_[i] = { velocities.middle.array() - velocities.spread,
      velocities.middle.array() + velocities.spread, velocities.mass, 1 };
    parents_[i] = roots_[i] = int(i);
    if (m.present)
    {
      drift_ += m.position - velocities.covered;
      ++present;
    }
  }
  drift_ /= std::max(1, present);
  if (sleepers_ > 0)
  {
    drift_.setZero(); // who sleeps does not go on with the others
  }
}

RockPair* IslandFinder::newPair(int first, int second)
{
  if (spare_.empty())
  {
    spare_.push_back(&pairs_.emplace_back());
  }
  RockPair* pair = spare_.back();
  spare_.pop_back();
  pair->first = first;
  pair->second = second;
  pair->law = world_.contacts.between(first, second);
  return pair;
}

void IslandFinder::drop(NearPair& n)
{
  if (n.pair)
  {
    closePairBooks(world_, *n.pair);
    if (touchedLately(*n.pair, world_.time))
    {
      restAnew(world_.rocks[n.first]);
      restAnew(world_.rocks[n.second]);
    }
    std::vector<Contact> contacts = std::move(n.pair->contacts);
    contacts.clear();
    *n.pair = RockPair();
    n.pair->contacts = std::move(contacts);
    spare_.push_back(n.pair);
  }
  NearPair fresh;
  fresh.first = n.first;
  fresh.second = n.second;
  n = fresh;
}

/// Whether all that it is near_, wherever it may go in the step, are among its neighbours.
bool IslandFinder::isCovered(std::size_t i) const
{
  const BodyBounds& m = bodies_[i];
  const VelocityBounds& velocities = velocityBounds_[i];
  const double room = velocities.cover - m.radius - m.known;
  return !m.present ||
    ((m.asleep || !velocities.slept) && room >= 0.0 &&
      (m.position - drift_ - velocities.covered).squaredNorm() <= room * room);
}

void IslandFinder::findNear()
{
  chosen_.clear();
  forThose(
    bodies_.size(), kFollowGrain, answers_, [&](std::size_t i) { return !this->isCovered(i); },
    [&](std::size_t i) { chosen_.push_back(i); });
  out_ += chosen_.size();
  if (!searched_ || out_ * kMostOut > bodies_.size())
  {
    this->search();
    out_ = 0;
    return;
  }
  for (const std::size_t i : chosen_)
  {
    this->cover(int(i));
  }
}

/// How much wider a rock's ball is than it need be in the step, m.
double IslandFinder::spare(int rock) const
{
  return kBallSteps * duration_ * (velocityBounds_[std::size_t(rock)].velocity - mean_).norm() +
    kBallOtherwise * bodies_[std::size_t(rock)].known;
}

/// For all, from where they stand.
void IslandFinder::search()
{
  searched_ = true;
  mean_.setZero();
  int present = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
  {
    if (bodies_[i].present)
    {
      mean_ += velocityBounds_[i].velocity;
      ++present;
    }
  }
  mean_ /= std::max(1, present);
  drift_.setZero();
  for (std::size_t i = 0; i < bodies_.size(); ++i)
  {
    const BodyBounds& m = bodies_[i];
    VelocityBounds& velocities = velocityBounds_[i];
    velocities.covered = m.position;
    velocities.cover = m.radius + m.known + this->spare(int(i));
    velocities.slept = m.asleep;
    boxes_[i] = { m.position, velocities.cover, m.present, m.present && !m.asleep };
  }
  broad_.place(boxes_);
  const std::span<const std::array<int, 2>> found = broad_.pairs();
  const auto behind = near_.begin() + std::ptrdiff_t(sorted_);
  std::sort(behind, near_.end());
  // Not in place: the room that it would take for it knows nothing of their alignment.
  nextNear_.resize(near_.size());
  std::merge(near_.begin(), behind, behind, near_.end(), nextNear_.begin());
  near_.swap(nextNear_);
  // Pairs that are still near stay, and pairs of sleepers, which are not looked for.
  nextNear_.clear();
  nextNear_.reserve(std::max(found.size(), near_.size()));
  auto old = near_.begin();
  const auto leave = [&](NearPair& n)
  {
    if (n.pair && this->isAsleep(n.first, n.second))
    {
      nextNear_.push_back(n);
    }
    else
    {
      this->drop(n);
    }
  };
  for (const std::array<int, 2>& ij : found)
  {
    NearPair n;
    n.first = ij[0];
    n.second = ij[1];
    for (; old != near_.end() && *old < n; ++old)
    {
      leave(*old);
    }
    const bool there = old != near_.end() && !(n < *old);
    nextNear_.push_back(there ? *old++ : n);
  }
  for (; old != near_.end(); ++old)
  {
    leave(*old);
  }
  near_.swap(nextNear_);
  sorted_ = near_.size();
  widened_ = 0.0;
  this->indexNeighbours();
}

void IslandFinder::indexNeighbours()
{
  firsts_.assign(bodies_.size() + 1, 0);
  for (const NearPair& n : near_)
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
  for (std::size_t k = near_.size(); k-- > 0;)
  {
    places_[--firsts_[std::size_t(near_[k].first)]] = k;
    places_[--firsts_[std::size_t(near_[k].second)]] = k;
  }
  for (const int i : widenedRocks_)
  {
    later_[std::size_t(i)].clear();
  }
  widenedRocks_.clear();
}

/// Looks for those about a rock that comes out of its ball.
void IslandFinder::cover(int rock)
{
  const BodyBounds& m = bodies_[std::size_t(rock)];
  VelocityBounds& velocities = velocityBounds_[std::size_t(rock)];
  const BroadBox& searched = boxes_[std::size_t(rock)];
  velocities.covered = m.position - drift_;
  velocities.cover = m.radius + m.known + this->spare(rock);
  velocities.slept = false;
  broad_.within(velocities.covered, velocities.cover + widened_, found_);
  widened_ = std::max(
    widened_, velocities.cover + (velocities.covered - searched.center).norm() - searched.radius);
  const auto other = [&](std::size_t k)
  { return std::size_t(near_[k].first == rock ? near_[k].second : near_[k].first); };
  this->forNeighbours(rock, [&](std::size_t k) { marks_[other(k)] = 1; });
  marks_[std::size_t(rock)] = 1;
  for (const int j : found_)
  {
    const VelocityBounds& o = velocityBounds_[std::size_t(j)];
    const double reach = velocities.cover + o.cover;
    if (!marks_[std::size_t(j)] && bodies_[std::size_t(j)].present &&
      (velocities.covered - o.covered).squaredNorm() <= reach * reach)
    {
      NearPair n;
      n.first = std::min(rock, j);
      n.second = std::max(rock, j);
      for (const int i : { rock, j })
      {
        later_[std::size_t(i)].push_back(near_.size());
        widenedRocks_.push_back(i);
      }
      near_.push_back(n);
    }
  }
  this->forNeighbours(rock, [&](std::size_t k) { marks_[other(k)] = 0; });
  marks_[std::size_t(rock)] = 0;
}

} // namespace rockfall
