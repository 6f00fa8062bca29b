#include "fall/MassFall.h"

#include "base/abort.h"
#include "base/parallel.h"
#include "fall/IslandStepper.h"
#include "fall/Meetings.h"
#include "fall/pairImpacts.h"
#include "fall/raising.h"
#include "fall/sleep.h"
#include "law/settings.h"

#include <algorithm>
#include <numeric>

namespace rockfall
{

MassFall::MassFall(const Surface& surface, std::span<const Rock> rocks,
  std::span<const Block> blocks, const SimulationParameters& parameters)
  : fall_(surface, rocks, parameters)
{
  fall_.rocks.reserve(rocks.size());
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    fall_.rocks.add(surface, rocks[i], blocks[i], parameters, std::uint32_t(i))
      .sim.letStrainFollow();
  }
  meetings_ = std::make_unique<Meetings>(fall_);
}

MassFall::~MassFall() = default;

std::vector<const RockPair*> MassFall::pairs() const
{
  std::vector<const RockPair*> pairs;
  meetings_->forPairs([&](const RockPair& pair) { pairs.push_back(&pair); });
  return pairs;
}

void MassFall::release()
{
  std::vector<RaisedRock> raised;
  raised.reserve(fall_.rocks.size());
  std::vector<double> lifts; // of each by itself, m
  for (FallingRock& rock : fall_.rocks)
  {
    stayWanted();
    const BlockState given = rock.sim.state();
    rock.sim.liftOntoGround();
    raised.push_back(
      { &rock.body().block, given, rock.sim.state().position.z() - given.position.z() });
    lifts.push_back(raised.back().lift);
  }
  raiseOthers(raised);
  for (std::size_t i = 0; i < fall_.rocks.size(); ++i)
  {
    FallingRock& rock = fall_.rocks[i];
    if (raised[i].lift > lifts[i])
    {
      RockBody& body = rock.body();
      body.state.position.z() = raised[i].state.position.z() + raised[i].lift;
      body.placed.place(body.block, body.state);
    }
    rock.sim.begin();
  }
}

std::vector<Trajectory> MassFall::run(const std::function<bool(double)>& goOn)
{
  this->release();
  while (this->advance() && (!goOn || goOn(fall_.time)))
  {
  }
  meetings_->forPairs([this](RockPair& pair) { closePairBooks(fall_, pair); });
  std::vector<Trajectory> trajectories;
  trajectories.reserve(fall_.rocks.size());
  for (FallingRock& rock : fall_.rocks)
  {
    trajectories.push_back(rock.sim.finish());
  }
  return trajectories;
}

void MassFall::tellBroken()
{
  if (!fall_.surface.terrain().obstacles())
  {
    return;
  }
  RockSimulator::Broken all;
  for (FallingRock& rock : fall_.rocks)
  {
    const RockSimulator::Broken one = rock.sim.takeBroken();
    all.trees.insert(all.trees.end(), one.trees.begin(), one.trees.end());
    all.barriers.insert(all.barriers.end(), one.barriers.begin(), one.barriers.end());
  }
  if (all.trees.empty() && all.barriers.empty())
  {
    return;
  }
  for (FallingRock& rock : fall_.rocks)
  {
    if (rock.sim.hearOf(all) && rock.asleep)
    {
      wake(rock, fall_.time);
    }
  }
}

bool MassFall::advance()
{
  constexpr std::size_t kRocksPerThread = 32; // fewer are not worth a thread of their own
  bool moving = false;
  standBy(int(fall_.rocks.size() / kRocksPerThread), [&] { moving = this->advanceAll(); });
  return moving;
}

bool MassFall::advanceAll()
{
  const double before = fall_.time;
  const double until = std::min(before + fall_.parameters.timeStep, fall_.parameters.endTime);
  meetings_->find(kStruckEarly * (until - before));
  const std::vector<Island>& islands = meetings_->islands();
  const std::vector<int>& alone = meetings_->alone();
  // The largest first: they take longest.
  order_.resize(islands.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(),
    [&](int a, int b)
    { return islands[std::size_t(a)].members.size() > islands[std::size_t(b)].members.size(); });
  const auto advanceOne = [&](std::size_t k)
  {
    if (k < islands.size())
    {
      IslandStepper(fall_, islands[std::size_t(order_[k])]).advance(until);
      return;
    }
    FallingRock& rock = fall_.rocks[std::size_t(alone[k - islands.size()])];
    rock.advanceAlone(until);
    isStill(fall_, rock); // to know when it comes back to an island
  };
  forEach(islands.size() + alone.size(), 1, advanceOne);
  fall_.time = until;
  this->tellBroken();
  if (!awake)
  {
    for (const Island& island : islands)
    {
      settleIsland(fall_, island, before);
    }
  }
  const bool moving = std::any_of(fall_.rocks.begin(), fall_.rocks.end(),
    [](const FallingRock& rock) { return !rock.sim.done(); });
  return moving && fall_.time < fall_.parameters.endTime - 1e-9;
}

} // namespace rockfall
