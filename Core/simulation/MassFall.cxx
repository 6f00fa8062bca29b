#include "simulation/MassFall.h"

#include "base/abort.h"
#include "base/parallel.h"
#include "contact/motion.h"
#include "law/settings.h"
#include "simulation/massFallMeet.h"
#include "simulation/raising.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace rockfall
{

namespace
{

/// Fewer are not worth a thread of their own.
constexpr std::size_t kRocksPerThread = 32, kStayGrain = 64;

} // namespace

MassFall::MassFall(const Surface& surface, std::span<const Rock> rocks,
  std::span<const Block> blocks, const SimulationParameters& parameters)
  : surface_(surface)
  , parameters_(parameters)
  , contacts_(rocks, parameters)
  , meetings_(std::make_unique<Meetings>())
{
  members_.reserve(rocks.size());
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    RockSimulator& sim =
      members_.add(surface, rocks[i], blocks[i], parameters, std::uint32_t(i)).sim;
    sim.letStrainFollow();
  }
}

MassFall::~MassFall() = default;

std::vector<const RockPair*> MassFall::pairs() const
{
  std::vector<const RockPair*> pairs;
  for (const Near& near : meetings_->near)
  {
    if (near.pair)
    {
      pairs.push_back(near.pair);
    }
  }
  return pairs;
}

void MassFall::Member::stand()
{
  const BlockState& s = sim.body().state;
  const Mat3 rotation = s.orientation.toRotationMatrix();
  const bool placed =
    sim.body().placed.position() == s.position && sim.body().placed.rotation() == rotation;
  if (!placed)
  {
    sim.body().placed.placeFrame(sim.body().block, s);
  }
  if (!placed || body.position != s.position || body.rotation != rotation)
  {
    body.update(sim.body().placed);
  }
}

bool MassFall::Member::arrive()
{
  const BlockState& s = sim.body().state;
  const bool there =
    endBody.position == s.position && endBody.rotation == s.orientation.toRotationMatrix();
  if (there)
  {
    std::swap(sim.body().placed, end);
    std::swap(body, endBody);
  }
  return there;
}

void MassFall::release()
{
  std::vector<RaisedRock> raised;
  raised.reserve(members_.size());
  std::vector<double> lifts; // of each by itself, m
  for (Member& member : members_)
  {
    stayWanted();
    RockSimulator& sim = member.sim;
    const BlockState given = sim.body().state;
    sim.liftOntoGround();
    raised.push_back(
      { &sim.body().block, given, sim.body().state.position.z() - given.position.z() });
    lifts.push_back(raised.back().lift);
  }
  raiseOthers(raised);
  for (std::size_t i = 0; i < members_.size(); ++i)
  {
    RockSimulator& sim = members_[i]->sim;
    if (raised[i].lift > lifts[i])
    {
      sim.body().state.position.z() = raised[i].state.position.z() + raised[i].lift;
      sim.body().placed.place(sim.body().block, sim.body().state);
    }
    sim.begin();
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
  for (const Near& near : meetings_->near)
  {
    if (near.pair)
    {
      this->closePairBooks(*near.pair);
    }
  }
  for (Member& member : members_)
  {
    trajectories.push_back(member.sim.finish());
  }
  return trajectories;
}

void MassFall::wake(Member& member)
{
  member.asleep = false;
  member.sim.wake(time_);
  member.stayed = member.lingered = member.sim.state();
}

bool MassFall::heldLately(const RockPair& pair) const
{
  return pair.touchedAt > time_ - kStillTime;
}

void MassFall::restAnew(int rock)
{
  Member& member = *members_[std::size_t(rock)];
  if (!member.sim.body().done)
  {
    member.stayed = member.lingered = member.sim.body().state;
    member.sim.body().quietTime = 0.0;
  }
}

void MassFall::putToSleep(Member& member)
{
  member.asleep = true;
  member.sim.end(Fate::Rested);
  member.sim.body().state.velocity.setZero();
  member.sim.body().state.spin.setZero();
  member.sim.body().acceleration.setZero();
  member.sim.body().spinAcceleration.setZero();
}

void MassFall::tellBroken()
{
  if (!surface_.terrain().obstacles())
  {
    return;
  }
  RockSimulator::Broken all;
  for (Member& member : members_)
  {
    const RockSimulator::Broken one = member.sim.takeBroken();
    all.trees.insert(all.trees.end(), one.trees.begin(), one.trees.end());
    all.barriers.insert(all.barriers.end(), one.barriers.begin(), one.barriers.end());
  }
  if (all.trees.empty() && all.barriers.empty())
  {
    return;
  }
  for (Member& member : members_)
  {
    if (member.sim.hearOf(all) && member.asleep)
    {
      this->wake(member);
    }
  }
}

bool MassFall::stays(Member& member)
{
  const RockSimulator& sim = member.sim;
  if (sim.body().done)
  {
    return true;
  }
  const double r = sim.body().block.radius();
  const auto displacementFrom = [&](const Member::Place& place)
  { return (sim.body().state.position - place.position).norm(); };
  const auto turnFrom = [&](const Member::Place& place)
  { return r * sim.body().state.orientation.angularDistance(place.orientation); };
  const double unit = std::sqrt(std::max(parameters_.gravity, kLeastGravity) * r); // m/s
  // Most go so far that how far they turn does not matter.
  const double still = kStillSpeed * unit * kStillTime,
               displacement = displacementFrom(member.stayed);
  if (displacement > still || displacement + turnFrom(member.stayed) > still)
  {
    member.stayed = sim.body().state;
  }
  const double near = kLingerWay * r, further = displacementFrom(member.lingered);
  const auto turns = [&] { return r * sim.body().state.spin.norm() > kLingerRim * unit; };
  if (further > near || (turns() && further + turnFrom(member.lingered) > near))
  {
    member.lingered = sim.body().state;
  }
  return time_ - member.stayed.time >= kStillTime || time_ - member.lingered.time >= kLingerTime;
}

void MassFall::advanceAlone(Member& member, double until)
{
  member.sim.advance(until);
  member.asleep = member.sim.body().done && member.sim.trajectory().summary.fate == Fate::Rested;
}

bool MassFall::advance()
{
  bool moving = false;
  standBy(int(members_.size() / kRocksPerThread), [&] { moving = this->advanceAll(); });
  return moving;
}

bool MassFall::advanceAll()
{
  const double until = std::min(time_ + parameters_.timeStep, parameters_.endTime);
  const double before = time_;
  this->findIslands(until - time_);
  // The largest first: they take longest.
  order_.resize(islands_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(),
    [&](int a, int b)
    { return islands_[std::size_t(a)].members.size() > islands_[std::size_t(b)].members.size(); });
  const auto advanceOne = [&](std::size_t k)
  {
    if (k < islands_.size())
    {
      this->advanceIsland(islands_[std::size_t(order_[k])], until);
      return;
    }
    Member& m = *members_[std::size_t(alone_[k - islands_.size()])];
    this->advanceAlone(m, until);
    this->stays(m); // to know when it comes back to an island
  };
  forEach(islands_.size() + alone_.size(), 1, advanceOne);
  time_ = until;
  this->tellBroken();
  if (!awake)
  {
    for (const Island& island : islands_)
    {
      std::atomic<bool> still = true, gone = false;
      const auto look = [&](std::size_t k)
      {
        Member& m = *members_[std::size_t(island.members[k])];
        if (!this->stays(m))
        {
          still.store(false, std::memory_order_relaxed);
        }
        if (m.sim.body().done && !m.asleep && m.sim.body().state.time > before)
        {
          gone.store(true, std::memory_order_relaxed);
        }
      };
      forEach(island.members.size(), kStayGrain, look);
      if (gone)
      {
        // A rock that left the slope or was caught in this step: rocks that it carried have yet to
        // fall.
        still = false;
        for (int i : island.members)
        {
          this->restAnew(i);
        }
      }
      for (int i : island.members)
      {
        if (still && !members_[i]->sim.body().done)
        {
          this->putToSleep(*members_[i]);
        }
      }
    }
  }
  const bool moving = std::any_of(
    members_.begin(), members_.end(), [](const Member& m) { return !m.sim.body().done; });
  return moving && time_ < parameters_.endTime - 1e-9;
}

} // namespace rockfall
