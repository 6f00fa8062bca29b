#include "simulation/MassFall.h"

#include "contact/motion.h"
#include "system/broadPhase.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rockfall
{

namespace
{

/// A group sleeps when for this long, s, each of its rocks has gone no further than it would at a
/// speed of this share of √(g r). Not the speeds decide: in a pile that lies some rock always
/// trembles, by less than its springs are compressed.
constexpr double kStillTime = 0.5;
constexpr double kStillSpeed = 1e-3;
/// So it does when for this long, s, each has kept within this share of its radius: contacts are
/// points without a moment, and a rock that is wedged between two may swing about them for ever.
constexpr double kLingerTime = 3.0;
constexpr double kLingerWay = 0.03;

} // namespace

MassFall::MassFall(const Surface& surface, std::span<const Rock> rocks,
  std::span<const Block> blocks, const SimulationParameters& parameters)
  : surface_(surface)
  , parameters_(parameters)
  , contacts_(rocks, parameters)
{
  members_.reserve(rocks.size());
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    members_.push_back(std::make_unique<Member>(surface, rocks[i], blocks[i], parameters));
    members_.back()->sim.stiff_ = true; // strain follows the contacts of a group as at rest
    members_.back()->sim.ringing_ = 0.0;
  }
}

void MassFall::Member::stand()
{
  const BlockState& s = sim.state_;
  const Mat3 rotation = s.orientation.toRotationMatrix();
  const bool placed = sim.placed_.position() == s.position && sim.placed_.rotation() == rotation;
  if (!placed)
  {
    sim.placed_.place(sim.block_, s);
  }
  if (!placed || body.position != s.position || body.rotation != rotation)
  {
    body.update(sim.placed_);
  }
}

bool MassFall::Member::arrive()
{
  const BlockState& s = sim.state_;
  const bool there =
    endBody.position == s.position && endBody.rotation == s.orientation.toRotationMatrix();
  if (there)
  {
    std::swap(sim.placed_, end);
    std::swap(body, endBody);
    body.placed = &sim.placed_;
    endBody.placed = &end;
  }
  return there;
}

void MassFall::release()
{
  for (const auto& member : members_)
  {
    member->sim.release();
  }
}

std::vector<Trajectory> MassFall::run(const std::function<bool(double)>& goOn)
{
  this->release();
  while (this->advance() && (!goOn || goOn(time_)))
  {
  }
  std::vector<Trajectory> trajectories;
  trajectories.reserve(members_.size());
  for (RockPair& pair : pairs_)
  {
    this->finishPairImpact(pair);
  }
  for (const auto& member : members_)
  {
    trajectories.push_back(member->sim.finish());
  }
  return trajectories;
}

void MassFall::wake(Member& member)
{
  RockSimulator& sim = member.sim;
  member.asleep = false;
  sim.done_ = false;
  sim.quietTime_ = 0.0;
  sim.state_.time = time_;
  member.stayed = member.lingered = sim.state_;
  sim.recorder_.trajectory().summary.fate = Fate::Moving;
  sim.recorder_.resume(sim.state_);
  sim.auditSamples(sim.state_);
}

void MassFall::putToSleep(Member& member)
{
  member.asleep = true;
  member.sim.done_ = true;
  member.sim.recorder_.trajectory().summary.fate = Fate::Rested;
  member.sim.state_.velocity.setZero();
  member.sim.state_.spin.setZero();
  member.sim.acceleration_.setZero();
  member.sim.spinAcceleration_.setZero();
}

bool MassFall::stays(Member& member) const
{
  const RockSimulator& sim = member.sim;
  if (sim.done_)
  {
    return true;
  }
  const double r = sim.block_.radius();
  const auto wayFrom = [&](const BlockState& place)
  {
    return (sim.state_.position - place.position).norm() +
      r * sim.state_.orientation.angularDistance(place.orientation);
  };
  const double speed = kStillSpeed * std::sqrt(std::max(parameters_.gravity, 1e-3) * r);
  if (wayFrom(member.stayed) > speed * kStillTime)
  {
    member.stayed = sim.state_;
  }
  if (wayFrom(member.lingered) > kLingerWay * r)
  {
    member.lingered = sim.state_;
  }
  return time_ - member.stayed.time >= kStillTime || time_ - member.lingered.time >= kLingerTime;
}

void MassFall::findPairs(double duration)
{
  std::vector<BroadBox> boxes(members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i)
  {
    Member& m = *members_[i];
    BroadBox& box = boxes[i];
    box.present = !m.sim.done_ || m.asleep;
    if (!box.present)
    {
      continue;
    }
    const BlockState& s = m.sim.state_;
    box.center = s.position;
    box.moves = !m.asleep;
    // In the step it covers no more than this; the longest way of all decides who meets whom.
    const double speed = s.velocity.norm() + parameters_.gravity * duration;
    box.radius = m.sim.block_.radius() + (m.asleep ? 0.0 : speed * duration);
  }
  const std::vector<std::array<int, 2>> near = findNear(boxes);
  // What lasts of the pairs that are still near, and those of sleepers, which are not looked for.
  nextPairs_.clear();
  nextPairs_.reserve(std::max(near.size(), pairs_.size()));
  std::size_t old = 0;
  const auto leave = [&](RockPair& pair)
  {
    if (members_[pair.first]->asleep && members_[pair.second]->asleep)
    {
      nextPairs_.push_back(std::move(pair));
    }
    else
    {
      this->finishPairImpact(pair);
    }
  };
  for (const std::array<int, 2>& ij : near)
  {
    const auto before = [&](const RockPair& p)
    { return p.first < ij[0] || (p.first == ij[0] && p.second < ij[1]); };
    for (; old < pairs_.size() && before(pairs_[old]); ++old)
    {
      leave(pairs_[old]);
    }
    if (old < pairs_.size() && pairs_[old].first == ij[0] && pairs_[old].second == ij[1])
    {
      nextPairs_.push_back(std::move(pairs_[old++]));
      continue;
    }
    nextPairs_.emplace_back();
    nextPairs_.back().first = ij[0];
    nextPairs_.back().second = ij[1];
    nextPairs_.back().law = contacts_.between(ij[0], ij[1]);
  }
  for (; old < pairs_.size(); ++old)
  {
    leave(pairs_[old]);
  }
  pairs_.swap(nextPairs_);
}

void MassFall::findGroups(double duration)
{
  // Which pairs may touch within the step.
  tbb::parallel_for(std::size_t(0), members_.size(),
    [&](std::size_t i)
    {
      Member& m = *members_[i];
      if (!m.sim.done_ || m.asleep)
      {
        m.stand();
      }
    });
  tbb::parallel_for(std::size_t(0), pairs_.size(),
    [&](std::size_t k)
    {
      RockPair& pair = pairs_[k];
      const Member &a = *members_[pair.first], &b = *members_[pair.second];
      pair.linked = pair.known = false;
      if (a.asleep && b.asleep)
      {
        return; // unless one of them wakes
      }
      const BlockState &s = a.sim.state_, &t = b.sim.state_;
      const double speed = (s.velocity - t.velocity).norm() + a.sim.block_.largestRimSpeed(s.spin) +
        b.sim.block_.largestRimSpeed(t.spin) +
        parameters_.gravity * duration; // one of them may be held
      const double reach = speed * duration;
      if (!pair.seen)
      {
        pair.before = pair.axis;
      }
      if (!pair.seen || (pair.axis.distance > 0.0 && pair.axis.distance <= reach))
      {
        pair.axis = findAxis(a.body, b.body, pair.axis, reach);
      }
      pair.seen = false;
      pair.linked = pair.known = pair.axis.distance <= reach;
      if (!pair.linked)
      {
        pair.contacts.clear();
        pair.touched = false;
      }
    });
  std::vector<int> parent(members_.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i)
  {
    while (parent[i] != i)
    {
      i = parent[i] = parent[parent[i]];
    }
    return i;
  };
  const auto join = [&](const RockPair& pair)
  {
    const int a = root(pair.first), b = root(pair.second);
    parent[std::max(a, b)] = std::min(a, b);
  };
  const auto link = [&](RockPair& pair)
  {
    for (int i : { pair.first, pair.second })
    {
      if (members_[i]->asleep)
      {
        this->wake(*members_[i]);
      }
    }
    pair.linked = true;
    join(pair);
  };
  for (RockPair& pair : pairs_)
  {
    if (pair.linked)
    {
      link(pair);
    }
  }
  // What a fast rock strikes may go on at its speed and reach another one within the step. So may
  // what it strikes in its sleep: with it wakes all that it may touch.
  std::vector<double> fastest(members_.size());
  for (bool changed = true; changed;)
  {
    changed = false;
    std::fill(fastest.begin(), fastest.end(), 0.0);
    for (std::size_t i = 0; i < members_.size(); ++i)
    {
      const RockSimulator& sim = members_[i]->sim;
      double& speed = fastest[std::size_t(root(int(i)))];
      speed = std::max(speed, sim.done_ ? 0.0 : sim.state_.velocity.norm());
    }
    for (RockPair& pair : pairs_)
    {
      const Member &a = *members_[pair.first], &b = *members_[pair.second];
      if (pair.linked || (a.sim.done_ && b.sim.done_))
      {
        continue;
      }
      const double speed = parameters_.gravity * duration +
        std::max(fastest[std::size_t(root(pair.first))], fastest[std::size_t(root(pair.second))]);
      const double reach = speed * duration;
      if (!pair.known && pair.axis.distance <= reach)
      {
        pair.before = pair.seen ? pair.before : pair.axis;
        pair.axis = findAxis(a.body, b.body, pair.axis, reach);
        pair.seen = false;
        pair.known = pair.axis.distance <= reach;
      }
      if (pair.axis.distance <= reach)
      {
        link(pair);
        changed = true;
      }
    }
  }
  for (RockPair& pair : pairs_)
  {
    // Who is awake and not linked moves by himself, away from where the axis was found.
    const bool asleep = members_[pair.first]->asleep && members_[pair.second]->asleep;
    pair.seen = pair.seen && asleep;
  }
  std::vector<int> size(members_.size(), 0), place(members_.size(), -1);
  for (std::size_t i = 0; i < members_.size(); ++i)
  {
    ++size[root(int(i))];
  }
  groups_.clear();
  alone_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i)
  {
    const Member& m = *members_[i];
    if (m.sim.done_)
    {
      continue;
    }
    const int r = root(int(i));
    if (size[r] == 1)
    {
      alone_.push_back(int(i));
      continue;
    }
    if (place[r] < 0)
    {
      place[r] = int(groups_.size());
      groups_.emplace_back();
    }
    groups_[place[r]].members.push_back(int(i));
  }
  for (RockPair& pair : pairs_)
  {
    if (pair.linked)
    {
      groups_[place[root(pair.first)]].pairs.push_back(&pair);
    }
  }
}

bool MassFall::advance()
{
  const double until = std::min(time_ + parameters_.timeStep, parameters_.endTime);
  this->findPairs(until - time_);
  this->findGroups(until - time_);
  tbb::parallel_for(std::size_t(0), alone_.size(),
    [&](std::size_t k)
    {
      Member& m = *members_[alone_[k]];
      m.touchesOthers = false;
      m.sim.advance(until);
      this->stays(m); // to know when it comes back to a group
      m.asleep = m.sim.done_ && m.sim.recorder_.trajectory().summary.fate == Fate::Rested;
    });
  tbb::parallel_for(
    std::size_t(0), groups_.size(), [&](std::size_t k) { this->advanceGroup(groups_[k], until); });
  time_ = until;
  if (!awake)
  {
    for (const Group& group : groups_)
    {
      bool still = true;
      for (int i : group.members)
      {
        still = this->stays(*members_[i]) && still;
      }
      for (int i : group.members)
      {
        if (still && !members_[i]->sim.done_)
        {
          this->putToSleep(*members_[i]);
        }
      }
    }
  }
  const bool moving =
    std::any_of(members_.begin(), members_.end(), [](const auto& m) { return !m->sim.done_; });
  return moving && time_ < parameters_.endTime - 1e-9;
}

} // namespace rockfall
