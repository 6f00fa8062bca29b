// The islands that rocks are that may meet within the step, once it is known which do.

#include "simulation/massFallMeet.h"

#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace rockfall
{

/// Lists pairs that are linked, and parts those that no longer are. Of two that have touched lately
/// one may have carried the other, which has hardly begun to fall: however long it has been still,
/// it has to come to rest anew.
void MassFall::Meetings::settle(MassFall& fall)
{
  parted_.assign(movers.size(), 0);
  const auto part = [&](Near& n)
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
    if (n.wasLinked && fall.heldLately(*n.pair))
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
  linked_.resize(std::max(near.size(), linked_.size()));
  linkedCounts_.resize((near.size() + kNearPart - 1) / kNearPart);
  const auto settlePart = [&](std::size_t of)
  {
    const std::size_t first = of * kNearPart, last = std::min(near.size(), first + kNearPart);
    Linked* linked = linked_.data() + first;
    for (std::size_t k = first; k < last; ++k)
    {
      if (states_[k] == Sight::Apart)
      {
        continue; // nothing lasts of them
      }
      Near& n = near[k];
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
      fall.restAnew(int(i));
    }
  }
}

/// Islands are what is linked: a island may have fallen apart.
void MassFall::Meetings::unite()
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
      const int a = headOf(heads_, l.first), b = headOf(heads_, l.second);
      heads[std::max(a, b)] = std::min(a, b);
    }
  };
  this->forLinked(uniteTwo);
  for (int& head : heads_)
  {
    head = heads[head]; // that of a head before it
  }
}

void MassFall::findIslands(double duration)
{
  Meetings& meet = *meetings_;
  meet.follow(*this, duration);
  meet.findNear(*this);
  meet.link(*this);
  std::vector<int>& place = islandOf_;
  place.assign(members_.size(), -1);
  // Memory of the last step's islands serves again.
  std::vector<Island> old = std::move(islands_);
  islands_.clear();
  alone_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i)
  {
    Mover& m = meet.movers[i];
    m.crowd = -1;
    if (!m.present || m.asleep)
    {
      continue;
    }
    if (meet.isAlone(int(i)))
    {
      alone_.push_back(int(i));
      continue;
    }
    const std::size_t head = std::size_t(meet.head(int(i)));
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
  meet.forLinked([&](const auto& l)
    { islands_[std::size_t(place[std::size_t(l.first)])].pairs.push_back(l.pair); });
  for (std::size_t g = 0; g < islands_.size(); ++g)
  {
    Island& island = islands_[g];
    island.crowd = this->isCrowd(island);
    for (const int i : island.members)
    {
      meet.movers[std::size_t(i)].crowd = island.crowd ? int(g) : -1;
    }
  }
}

} // namespace rockfall
