// The islands that rocks are that may meet within the step, once it is known which do.

#include "world/IslandFinder.h"

#include "base/joined.h"
#include "base/parallel.h"
#include "contact/ground/motion.h"
#include "law/settings.h"
#include "world/sleep.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace rockfall
{

namespace
{

constexpr std::size_t kFollowGrain = 64;

/// How a rock may move within a duration (s) if no other strikes it.
void boundVelocities(
  const WorldState& world, const SingleRock& sim, double duration, VelocityBounds& velocities)
{
  const BlockState& s = sim.body().state;
  const double speed = s.velocity.norm(), rim = sim.body().block.largestRimSpeed(s.spin);
  // Springs give back what they hold in the middle of an impact.
  const double held = std::sqrt(2.0 * sim.body().springEnergy * sim.body().block.largestMobility());
  velocities.own = (speed + rim + held) * duration + world.parameters.gravity * duration * duration;
  // Structures farther off than it may come have no say.
  const double displacement = sim.body().block.radius() + velocities.own;
  const Vec3& p = s.position;
  const Obstacles* obstacles = world.surface.terrain().obstacles();
  const bool obstructed = obstacles &&
    obstacles->anyIn(
      p.x() - displacement, p.x() + displacement, p.y() - displacement, p.y() + displacement);
  // Closed contacts only: the open ones that are kept hang on how the slope was searched.
  const bool flies = !obstructed && !anyClosed(sim.body().contacts) &&
    sim.fall().ground.clearFor(sim.body(), duration);
  // Velocities that an impact on the slope leaves, with any normal.
  const double e = obstructed ? 1.0 : world.surface.largestRestitution();
  velocities.middle = flies ? s.velocity : Vec3(0.5 * (1.0 - e) * s.velocity);
  velocities.spread = rim + held + (flies ? 0.0 : 0.5 * (1.0 + e) * speed);
}

} // namespace

IslandFinder::IslandFinder(WorldState& world)
  : world_(world)
  , near_(world)
  , bounciest_(world.contacts.largestRestitution())
{
  const std::size_t count = world.rocks.size();
  rocks_.bodies.resize(count);
  rocks_.velocities.resize(count);
  bounds_.resize(count);
  parents_.resize(count);
  roots_.resize(count);
  fars_.resize(count);
  massRatioGains_.resize(count);
  heads_.resize(count);
  inIsland_.resize(count);
  marks_.resize(count, 0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const Block& block = world.rocks[i].body().block;
    rocks_.bodies[i].radius = block.radius();
    rocks_.velocities[i].mass = block.mass();
  }
}

/// Lists pairs that are linked, and parts those that no longer are. Of two that have touched lately
/// one may have carried the other, which has hardly begun to fall: however long it has been still,
/// it has to come to rest anew.
void IslandFinder::settle()
{
  parted_.assign(rocks_.bodies.size(), 0);
  const auto part = [&](NearPair& n)
  {
    if (!(n.holds || n.wasLinked))
    {
      return;
    }
    const bool asleep = rocks_.areAsleep(n.first, n.second);
    if (asleep && !n.wasLinked)
    {
      return;
    }
    if (n.wasLinked && touchedLately(*n.pair, world_.time))
    {
      for (const int i : { n.first, n.second })
      {
        std::atomic_ref(parted_[std::size_t(i)]).store(1, std::memory_order_relaxed);
      }
    }
    n.pair->linked = n.pair->known = false;
    if (!asleep)
    {
      // A rock that is awake and not linked moves by itself, away from where the axis was found.
      n.pair->seen = n.pair->touched = n.holds = false;
      n.pair->keep({});
    }
  };
  linked_.resize(std::max(near_.size(), linked_.size()));
  linkedCounts_.resize((near_.size() + kNearPart - 1) / kNearPart);
  const auto settlePart = [&](std::size_t of)
  {
    const std::size_t first = of * kNearPart, last = std::min(near_.size(), first + kNearPart);
    Linked* linked = linked_.data() + first;
    for (std::size_t k = first; k < last; ++k)
    {
      if (states_[k] == PairState::Apart)
      {
        continue; // nothing lasts of them
      }
      NearPair& n = near_[k];
      if (n.linked)
      {
        *linked++ = { n.first, n.second, n.pair.get() };
      }
      else
      {
        part(n);
      }
    }
    linkedCounts_[of] = std::size_t(linked - linked_.data()) - first;
  };
  forEach(linkedCounts_.size(), 1, settlePart);
  for (std::size_t i = 0; i < parted_.size(); ++i)
  {
    if (parted_[i])
    {
      restAnew(world_.rocks[int(i)]);
    }
  }
}

/// Islands are what is linked: an island may have fallen apart.
void IslandFinder::unite()
{
  std::iota(heads_.begin(), heads_.end(), 0);
  std::fill(inIsland_.begin(), inIsland_.end(), char(0));
  int* const heads = heads_.data();
  char* const inIsland = inIsland_.data();
  const auto uniteTwo = [&](const Linked& l)
  {
    inIsland[l.first] = inIsland[l.second] = 1;
    if (heads[l.first] != heads[l.second])
    {
      joinTwo(heads_, l.first, l.second);
    }
  };
  this->forLinked(uniteTwo);
  for (int& head : heads_)
  {
    head = heads[head]; // that of a head before it
  }
}

void IslandFinder::follow(double duration)
{
  const std::size_t count = world_.rocks.size();
  rocks_.duration = duration;
  sag_ = world_.parameters.gravity * duration * duration;
  const auto followRock = [&](std::size_t i)
  {
    BodyBounds& m = rocks_.bodies[i];
    VelocityBounds& velocities = rocks_.velocities[i];
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
  longest_ = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const BodyBounds& m = rocks_.bodies[i];
    const VelocityBounds& velocities = rocks_.velocities[i];
    longest_ = std::max(longest_, m.displacement);
    sleepers_ += m.present && m.asleep;
    bounds_[i] = { velocities.middle.array() - velocities.spread,
      velocities.middle.array() + velocities.spread, velocities.mass, 1 };
    parents_[i] = roots_[i] = int(i);
  }
}

void IslandFinder::find(double duration)
{
  this->follow(duration);
  near_.find(rocks_);
  this->link();
  this->listIslands();
}

void IslandFinder::listIslands()
{
  std::vector<int>& place = islandOf_;
  place.assign(rocks_.bodies.size(), -1);
  // Memory of the last step's islands serves again.
  std::vector<Island> old = std::move(islands_);
  islands_.clear();
  alone_.clear();
  for (std::size_t i = 0; i < rocks_.bodies.size(); ++i)
  {
    const BodyBounds& m = rocks_.bodies[i];
    if (!m.present || m.asleep)
    {
      continue;
    }
    if (!inIsland_[i])
    {
      alone_.push_back(int(i));
      continue;
    }
    const std::size_t head = std::size_t(heads_[i]);
    if (place[head] < 0)
    {
      place[head] = int(islands_.size());
      islands_.push_back(islands_.size() < old.size() ? std::move(old[islands_.size()]) : Island());
      islands_.back().members.clear();
      islands_.back().pairs.clear();
    }
    place[i] = place[head];
    islands_[std::size_t(place[head])].members.push_back(int(i));
  }
  this->forLinked([&](const Linked& l)
    { islands_[std::size_t(place[std::size_t(l.first)])].pairs.push_back(l.pair); });
}

} // namespace rockfall
