#include "world/NearPairs.h"

#include "base/parallel.h"
#include "law/settings.h"
#include "world/pairImpacts.h"
#include "world/sleep.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace rockfall
{

namespace
{

constexpr std::size_t kCoverGrain = 64;

/// All are looked for anew when this share of them have come out of their balls.
constexpr std::size_t kMostOut = 4;

} // namespace

NearPairs::NearPairs(WorldState& world)
  : world_(world)
{
  const std::size_t count = world.rocks.size();
  boxes_.resize(count);
  later_.resize(count);
  marks_.resize(count, 0);
}

void NearPairs::keep(NearPair& n)
{
  if (n.pair)
  {
    return;
  }
  n.pair = std::make_unique<RockPair>();
  n.pair->first = n.first;
  n.pair->second = n.second;
  n.pair->law = world_.contacts.between(n.first, n.second);
}

void NearPairs::drop(NearPair& n)
{
  if (n.pair)
  {
    closePairBooks(world_, *n.pair);
    if (touchedLately(*n.pair, world_.time))
    {
      restAnew(world_.rocks[n.first]);
      restAnew(world_.rocks[n.second]);
    }
  }
  NearPair fresh;
  fresh.first = n.first;
  fresh.second = n.second;
  n = std::move(fresh);
}

bool NearPairs::isCovered(const RockBounds& rocks, std::size_t i) const
{
  const BodyBounds& m = rocks.bodies[i];
  const VelocityBounds& velocities = rocks.velocities[i];
  const double room = velocities.cover - m.radius - m.known;
  return !m.present ||
    ((m.asleep || !velocities.slept) && room >= 0.0 &&
      (m.position - drift_ - velocities.covered).squaredNorm() <= room * room);
}

void NearPairs::find(RockBounds& rocks)
{
  this->followDrift(rocks);
  chosen_.clear();
  forThose(
    rocks.bodies.size(), kCoverGrain, answers_,
    [&](std::size_t i) { return !this->isCovered(rocks, i); },
    [&](std::size_t i) { chosen_.push_back(i); });
  out_ += chosen_.size();
  if (!searched_ || out_ * kMostOut > rocks.bodies.size())
  {
    this->search(rocks);
    out_ = 0;
    return;
  }
  for (const std::size_t i : chosen_)
  {
    this->cover(rocks, int(i));
  }
}

double NearPairs::spare(const RockBounds& rocks, int rock) const
{
  return kBallSteps * rocks.duration *
    (rocks.velocities[std::size_t(rock)].velocity - mean_).norm() +
    kBallOtherwise * rocks.bodies[std::size_t(rock)].known;
}

void NearPairs::search(RockBounds& rocks)
{
  searched_ = true;
  mean_.setZero();
  int present = 0;
  for (std::size_t i = 0; i < rocks.bodies.size(); ++i)
  {
    if (rocks.bodies[i].present)
    {
      mean_ += rocks.velocities[i].velocity;
      ++present;
    }
  }
  mean_ /= std::max(1, present);
  drift_.setZero();
  for (std::size_t i = 0; i < rocks.bodies.size(); ++i)
  {
    const BodyBounds& m = rocks.bodies[i];
    VelocityBounds& velocities = rocks.velocities[i];
    velocities.covered = m.position;
    velocities.cover = m.radius + m.known + this->spare(rocks, int(i));
    velocities.slept = m.asleep;
    boxes_[i] = { m.position, velocities.cover, m.present, m.present && !m.asleep };
  }
  broad_.place(boxes_);
  const std::span<const std::array<int, 2>> found = broad_.pairs();
  const auto behind = near_.begin() + std::ptrdiff_t(sorted_);
  std::sort(behind, near_.end());
  // Not in place: the room that it would take for it knows nothing of their alignment.
  nextNear_.resize(near_.size());
  std::merge(std::move_iterator(near_.begin()), std::move_iterator(behind),
    std::move_iterator(behind), std::move_iterator(near_.end()), nextNear_.begin());
  near_.swap(nextNear_);
  // Pairs that are still near stay, and pairs of sleepers, which are not looked for.
  nextNear_.clear();
  nextNear_.reserve(std::max(found.size(), near_.size()));
  auto old = near_.begin();
  const auto leave = [&](NearPair& n)
  {
    if (n.pair && rocks.areAsleep(n.first, n.second))
    {
      nextNear_.push_back(std::move(n));
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
    nextNear_.push_back(std::move(there ? *old++ : n));
  }
  for (; old != near_.end(); ++old)
  {
    leave(*old);
  }
  near_.swap(nextNear_);
  sorted_ = near_.size();
  widened_ = 0.0;
  this->indexNeighbours(rocks.bodies.size());
}

void NearPairs::indexNeighbours(std::size_t rocks)
{
  firsts_.assign(rocks + 1, 0);
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

void NearPairs::cover(RockBounds& rocks, int rock)
{
  const BodyBounds& m = rocks.bodies[std::size_t(rock)];
  VelocityBounds& velocities = rocks.velocities[std::size_t(rock)];
  const BroadBox& searched = boxes_[std::size_t(rock)];
  velocities.covered = m.position - drift_;
  velocities.cover = m.radius + m.known + this->spare(rocks, rock);
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
    const VelocityBounds& o = rocks.velocities[std::size_t(j)];
    const double reach = velocities.cover + o.cover;
    if (!marks_[std::size_t(j)] && rocks.bodies[std::size_t(j)].present &&
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
      near_.push_back(std::move(n));
    }
  }
  this->forNeighbours(rock, [&](std::size_t k) { marks_[other(k)] = 0; });
  marks_[std::size_t(rock)] = 0;
}

void NearPairs::followDrift(const RockBounds& rocks)
{
  drift_.setZero();
  int present = 0;
  bool asleep = false;
  for (std::size_t i = 0; i < rocks.bodies.size(); ++i)
  {
    const BodyBounds& m = rocks.bodies[i];
    if (m.present)
    {
      drift_ += m.position - rocks.velocities[i].covered;
      ++present;
      asleep = asleep || m.asleep;
    }
  }
  drift_ /= std::max(1, present);
  if (asleep)
  {
    drift_.setZero(); // who sleeps does not go on with the others
  }
}

} // namespace rockfall
