// The islands that rocks are that may meet within the step, once it is known which do.

#include "world/IslandFinder.h"

#include "base/joined.h"
#include "base/parallel.h"
#include "law/settings.h"
#include "world/sleep.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace rockfall
{

IslandFinder::IslandFinder(WorldState& world)
  : world_(world)
  , bounciest_(world.contacts.largestRestitution())
{
  const std::size_t count = world.rocks.size();
  bodies_.resize(count);
  velocityBounds_.resize(count);
  bounds_.resize(count);
  parents_.resize(count);
  roots_.resize(count);
  boxes_.resize(count);
  fars_.resize(count);
  massRatioGains_.resize(count);
  heads_.resize(count);
  inIsland_.resize(count);
  later_.resize(count);
  marks_.resize(count, 0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const Block& block = world.rocks[i].body().block;
    bodies_[i].radius = block.radius();
    velocityBounds_[i].mass = block.mass();
  }
}

/// Lists pairs that are linked, and parts those that no longer are. Of two that have touched lately
/// one may have carried the other, which has hardly begun to fall: however long it has been still,
/// it has to come to rest anew.
void IslandFinder::settle()
{
  parted_.assign(bodies_.size(), 0);
  const auto part = [&](NearPair& n)
  {
    if (!(n.holds || n.wasLinked))
    {
      return;
    }
    const bool asleep = this->isAsleep(n.first, n.second);
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
      n.pair->contacts.clear();
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
        *linked++ = { n.first, n.second, n.pair };
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

void IslandFinder::find(double duration)
{
  this->follow(duration);
  this->findNear();
  this->link();
  this->listIslands();
}

void IslandFinder::listIslands()
{
  std::vector<int>& place = islandOf_;
  place.assign(bodies_.size(), -1);
  // Memory of the last step's islands serves again.
  std::vector<Island> old = std::move(islands_);
  islands_.clear();
  alone_.clear();
  for (std::size_t i = 0; i < bodies_.size(); ++i)
  {
    const BodyBounds& m = bodies_[i];
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
