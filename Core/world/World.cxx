#include "world/World.h"

#include "base/abort.h"
#include "base/parallel.h"
#include "law/settings.h"
#include "rock/fall/atStructures.h"
#include "terrain/Obstacles.h"
#include "world/IslandFinder.h"
#include "world/IslandStepper.h"
#include "world/pairImpacts.h"
#include "world/raising.h"
#include "world/sleep.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rockfall
{

World::World(const Surface& surface, std::span<const Rock> rocks, std::span<const Block> blocks,
  const SimulationParameters& parameters, int number, bool sleeps)
  : world_(surface, rocks, parameters)
  , sleeps_(sleeps)
{
  world_.rocks.reserve(rocks.size());
  if (const Obstacles* obstacles = surface.terrain().obstacles())
  {
    world_.barrierLoads.resize(obstacles->structures().barriers.size());
  }
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    FallingRock& rock = world_.rocks.add(
      surface, rocks[i], blocks[i], parameters, std::uint32_t(number) + std::uint32_t(i));
    if (parameters.rockRockContact)
    {
      rock.body().letStrainFollow();
      rock.fall().structures.setBarrierLoads(&world_.barrierLoads);
    }
  }
  if (parameters.rockRockContact)
  {
    islandFinder_ = std::make_unique<IslandFinder>(world_);
  }
}

World::~World() = default;

std::vector<const RockPair*> World::pairs() const
{
  std::vector<const RockPair*> pairs;
  islandFinder_->forPairs([&](const RockPair& pair) { pairs.push_back(&pair); });
  return pairs;
}

void World::release()
{
  std::vector<RaisedRock> raised;
  raised.reserve(world_.rocks.size());
  std::vector<double> lifts; // of each by itself, m
  for (FallingRock& rock : world_.rocks)
  {
    stayWanted();
    const BlockState given = rock.sim.state();
    rock.sim.liftOntoGround();
    raised.push_back(
      { &rock.body().block, given, rock.sim.state().position.z() - given.position.z() });
    lifts.push_back(raised.back().lift);
  }
  raiseOthers(raised);
  for (std::size_t i = 0; i < world_.rocks.size(); ++i)
  {
    FallingRock& rock = world_.rocks[i];
    if (raised[i].lift > lifts[i])
    {
      RockBody& body = rock.body();
      body.state.position.z() = raised[i].state.position.z() + raised[i].lift;
      body.placed.place(body.block, body.state);
    }
    rock.sim.begin();
  }
}

std::vector<Trajectory> World::run(const std::function<bool(double)>& goOn, double enough)
{
  std::vector<Trajectory> trajectories;
  trajectories.reserve(world_.rocks.size());
  if (!islandFinder_)
  {
    for (FallingRock& rock : world_.rocks)
    {
      trajectories.push_back(rock.sim.run(enough));
    }
    return trajectories;
  }
  this->release();
  while (this->advance() && world_.time < enough && (!goOn || goOn(world_.time)))
  {
  }
  islandFinder_->forPairs([this](RockPair& pair) { closePairBooks(world_, pair); });
  for (FallingRock& rock : world_.rocks)
  {
    trajectories.push_back(rock.sim.finish());
  }
  return trajectories;
}

void World::shareBroken()
{
  if (!world_.surface.terrain().obstacles())
  {
    return;
  }
  StructuresOnWay::Broken all;
  for (FallingRock& rock : world_.rocks)
  {
    world_.shareBarriers(rock);
    const StructuresOnWay::Broken now = rock.fall().structures.drainBroken();
    all.trees.insert(all.trees.end(), now.trees.begin(), now.trees.end());
    for (const auto& [tree, energy] : now.driven)
    {
      world_.driven[tree] += energy;
    }
  }
  if (all.trees.empty())
  {
    return;
  }
  for (FallingRock& rock : world_.rocks)
  {
    if (applyBroken(rock.fall(), all) && rock.asleep)
    {
      wake(rock, world_.time);
    }
  }
}

bool World::advance()
{
  const SimulationParameters& p = world_.parameters;
  const double until = std::min(world_.time + p.timeStep, p.endTime);
  this->step(until);
  const bool moving = std::any_of(world_.rocks.begin(), world_.rocks.end(),
    [](const FallingRock& rock) { return !rock.sim.done(); });
  return moving && world_.time < p.endTime - kTooShort;
}

void World::step(double until)
{
  const double before = world_.time;
  islandFinder_->find(kStruckEarly * (until - before));
  this->advanceAll(until);
  world_.time = until;
  this->shareBroken();
  this->settle(before);
}

void World::advanceAll(double until)
{
  // The largest first: they take longest.
  const std::vector<Island>& islands = islandFinder_->islands();
  order_.resize(islands.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(),
    [&](int a, int b)
    { return islands[std::size_t(a)].members.size() > islands[std::size_t(b)].members.size(); });
  this->findAtBarriers(until - world_.time);
  forEach(waits_.size(), 1,
    [&](std::size_t k)
    {
      if (!waits_[k])
      {
        this->advanceOne(k, until);
      }
    });
  // What one of them leaves of a barrier the next one meets.
  for (const auto& [time, k] : atBarriers_)
  {
    this->advanceOne(k, until);
  }
}

std::span<const int> World::unit(std::size_t k) const
{
  const std::vector<Island>& islands = islandFinder_->islands();
  return k < islands.size()
    ? std::span<const int>(islands[std::size_t(order_[k])].members)
    : std::span<const int>(islandFinder_->alone()).subspan(k - islands.size(), 1);
}

void World::advanceOne(std::size_t k, double until)
{
  const std::vector<Island>& islands = islandFinder_->islands();
  if (k < islands.size())
  {
    IslandStepper(world_, islands[std::size_t(order_[k])]).advance(until, waits_[k] != 0);
    return;
  }
  FallingRock& rock = world_.rocks[std::size_t(this->unit(k).front())];
  rock.advanceAlone(until);
  isStill(world_, rock); // to know when it comes back to an island
  if (waits_[k])
  {
    world_.shareBarriers(rock);
  }
}

void World::findAtBarriers(double duration)
{
  waits_.assign(islandFinder_->islands().size() + islandFinder_->alone().size(), 0);
  atBarriers_.clear();
  if (world_.barrierLoads.empty())
  {
    return;
  }
  for (std::size_t k = 0; k < waits_.size(); ++k)
  {
    const std::vector<double> times = world_.timesToBarriers(this->unit(k), duration);
    const double soonest = *std::min_element(times.begin(), times.end());
    waits_[k] = std::isfinite(soonest);
    if (waits_[k])
    {
      atBarriers_.emplace_back(soonest, k);
    }
  }
  std::sort(atBarriers_.begin(), atBarriers_.end());
}

void World::settle(double before)
{
  if (!sleeps_)
  {
    return;
  }
  for (const Island& island : islandFinder_->islands())
  {
    settleIsland(world_, island, before);
  }
}

} // namespace rockfall
