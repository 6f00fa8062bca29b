// What comes of a group's step: into its rocks and pairs.

#include "simulation/massFallWork.h"

#include "base/parallel.h"
#include "contact/motion.h"
#include "law/settings.h"
#include "simulation/pressOut.h"
#include "simulation/pressedIn.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

namespace rockfall
{

namespace
{

/// What others press in further than the two rocks could yields, at the force that it has: what its
/// spring would hold beyond is not given back.
void yield(Contact& c, double radius, double speed, double mass)
{
  if (c.closed() && c.gap() < -kFirm * radius)
  {
    const double most = deepestBetween(radius, speed, mass, c.stiffness);
    c.offset = std::min(c.offset, c.distance + most);
  }
}

/// A number for a contact that carries.
std::uint64_t keyOf(const Contact& c)
{
  return (std::uint64_t(c.rockFeature + 1000) * 4 + std::uint64_t(c.kind) + 1) *
    0x9e3779b97f4a7c15ull;
}

} // namespace

void MassFall::absorb(const Group& group, double h, StepKind kind, Workspace& work) const
{
  std::vector<std::uint64_t>& carriers = work.carriers;
  carriers.assign(work.bodies.size(), 0);
  work.touchesOthers.assign(work.bodies.size(), 0);
  const double end = work.bodies.front().state->time;
  std::vector<char>& strike = work.flags; // by pair, of those that touch
  strike.resize(std::max(strike.size(), group.pairs.size()));
  const auto book = [&](RockPair& pair, const GroupContact& taken)
  {
    const Contact& c = *taken.contact;
    RockPair::Impact& impact = pair.impact;
    if (!pair.strikes)
    {
      pair.lastingLoss += taken.work;
      return;
    }
    if (c.normalForce > 0.0)
    {
      impact.impulse += (h * c.normalForce) * c.normal;
      if (c.normalForce > impact.largest)
      {
        impact.largest = c.normalForce;
        impact.point = c.point;
      }
    }
    impact.loss += taken.work;
  };
  const auto absorbPair = [&](std::size_t t)
  {
    work.comeToTouching(group, t);
    const std::size_t p = work.touching[t];
    RockPair& pair = *group.pairs[p];
    const std::array<int, 2>& places = work.places[p];
    std::uint64_t carry[2] = {};
    for (std::size_t k = work.firsts[p]; k < work.firsts[p + 1]; ++k)
    {
      this->findKnock(pair, work.contacts[k], h);
    }
    for (std::size_t k = work.firsts[p]; k < work.firsts[p + 1]; ++k)
    {
      const Contact& c = *work.contacts[k].contact;
      book(pair, work.contacts[k]);
      pair.touched = pair.touched || c.closed();
      if (c.closed())
      {
        carry[0] += keyOf(c) * std::uint64_t(pair.second + 2);
        carry[1] += keyOf(c) * std::uint64_t(pair.first + 2);
      }
    }
    strike[p] = pair.strikes;
    if (!pair.touched)
    {
      return;
    }
    pair.touchedAt = end;
    // Whole numbers: their sum is the same in any order.
    for (const int side : { 0, 1 })
    {
      const std::size_t place = std::size_t(places[std::size_t(side)]);
      std::atomic_ref(carriers[place]).fetch_add(carry[side], std::memory_order_relaxed);
      std::atomic_ref(work.touchesOthers[place]).store(1, std::memory_order_relaxed);
    }
    // What was found overlapping is pressed out slowly.
    const Workspace::Side& a = work.sides[std::size_t(pair.first)];
    const Workspace::Side& b = work.sides[std::size_t(pair.second)];
    const double mass = std::min(a.mass, b.mass), reduced = 1.0 / (1.0 / a.mass + 1.0 / b.mass);
    const double slow =
      std::min(kPressOut * h, 0.5 * mass * parameters_.gravity / parameters_.normalPenalty);
    const double smaller = std::min(a.radius, b.radius),
                 loose = kind == StepKind::Lasting ? kLooseOverlap * smaller
                                                   : std::numeric_limits<double>::infinity();
    const double speed = std::max(
      (a.velocity - b.velocity).norm() + a.rim + b.rim, pair.strikes ? pair.impact.approach : 0.0);
    for (Contact& c : pair.contacts)
    {
      yield(c, smaller, speed, reduced);
      pressOutLoose(c, slow, loose);
    }
  };
  forEach(work.touching.size(), kPairGrain, absorbPair);
  for (std::size_t k = 0; k < work.added.size(); ++k)
  {
    const Contact& c = work.added[k];
    const Workspace::Added& added = work.addedTo[k];
    if (added.onSlope)
    {
      RockSimulator& sim = members_[group.members[added.of]]->sim;
      sim.contacts_.push_back(c);
      sim.contactsBefore_.push_back(added.before);
      continue;
    }
    RockPair& pair = *group.pairs[added.of];
    this->findKnock(pair, work.contacts[work.firsts.back() + k], h);
    book(pair, work.contacts[work.firsts.back() + k]);
    strike[added.of] = pair.strikes;
    if (c.closed())
    {
      pair.touched = true;
      pair.touchedAt = end;
      const std::size_t first = std::size_t(work.placeOf[std::size_t(pair.first)]);
      const std::size_t second = std::size_t(work.placeOf[std::size_t(pair.second)]);
      work.touchesOthers[first] = work.touchesOthers[second] = 1;
      carriers[first] += keyOf(c) * std::uint64_t(pair.second + 2);
      carriers[second] += keyOf(c) * std::uint64_t(pair.first + 2);
    }
    pair.contacts.push_back(c);
  }
  for (const Workspace::Added& added : work.addedTo)
  {
    if (!added.onSlope && work.firsts[added.of] == work.firsts[added.of + 1])
    {
      work.touching.push_back(added.of);
    }
  }
  if (!work.addedTo.empty())
  {
    std::sort(work.touching.begin(), work.touching.end()); // one may be there twice: it ends once
  }
  for (const std::size_t p : work.touching)
  {
    if (strike[p] && (kind == StepKind::Lasting || !group.pairs[p]->touched))
    {
      this->finishPairImpact(*group.pairs[p]);
    }
  }
  const bool crowd = group.crowd;
  const auto absorbRock = [&](std::size_t k)
  {
    this->comeToRock(group, k);
    Member& m = *members_[group.members[k]];
    if (m.sim.done_)
    {
      return;
    }
    const int b = m.place;
    work.arrived[std::size_t(b)] = false;
    work.count(m.sim);
    const GroupBody& body = work.bodies[b];
    StepOutcome outcome;
    outcome.frictionWork = body.frictionWork;
    outcome.dampedWork = body.dampedWork;
    outcome.springEnergy = body.springEnergy;
    outcome.normalEnergy = body.normalEnergy;
    m.sim.absorb(kind, outcome, work.energyBefore[b], body.given);
    const std::vector<Contact>& c = m.sim.contacts_;
    const bool carried = work.touchesOthers[std::size_t(b)] ||
      std::any_of(c.begin(), c.end(), [](const Contact& touch) { return touch.closed(); });
    // In a crowd some contact opens or closes in every step, and the acceleration of one step says
    // little of the next: carried on it would keep the pile in motion for ever.
    if (carriers[b] != m.carriers || (crowd && carried))
    {
      m.sim.acceleration_.setZero();
      m.sim.spinAcceleration_.setZero();
      m.carriers = carriers[b];
    }
    if (m.sim.done_)
    {
      return; // caught
    }
    this->fellTrees(group, k, work);
    m.sim.checkLeft();
    m.sim.followRest(h, carried);
    if (!m.sim.done_ && m.sim.state_.time >= parameters_.endTime - kTooShort)
    {
      m.sim.recorder_.trajectory().summary.fate = Fate::Moving;
      m.sim.done_ = true;
    }
    const bool arrived = work.looked && m.arrive();
    work.arrived[std::size_t(b)] = arrived;
    if (crowd && !arrived)
    {
      const BlockState &from = m.sim.before_, &to = m.sim.state_;
      const double r = m.sim.block_.radius();
      Workspace::Way& way = work.ways[std::size_t(b)];
      way.way = to.position - from.position;
      way.turned =
        wayOfTurn(from.orientation, to.orientation, r) + r * (to.strain - from.strain).norm();
    }
  };
  forEach(group.members.size(), kRockGrain, absorbRock);
  const auto see = [&](std::size_t p)
  {
    comeToPair(group.pairs, p);
    RockPair& pair = *group.pairs[p];
    const auto [a, b] = work.places[p];
    const bool both = a >= 0 && b >= 0;
    pair.seen = both && work.arrived[std::size_t(a)] && work.arrived[std::size_t(b)];
    if (pair.seen)
    {
      pair.before = pair.axis;
      pair.axis = pair.end;
    }
    else if (crowd && both && !pair.touched && !members_[pair.first]->sim.done_ &&
      !members_[pair.second]->sim.done_)
    {
      // The look was before the last sweeps; but they may still be apart as they were.
      const Workspace::Way& way = work.ways[std::size_t(a)];
      const Workspace::Way& other = work.ways[std::size_t(b)];
      const double gap =
        pair.axis.distance + pair.axis.normal.dot(way.way - other.way) - way.turned - other.turned;
      pair.seen = gap > 0.0;
      if (pair.seen)
      {
        pair.before = pair.axis;
        pair.axis.distance = gap;
      }
    }
  };
  forEach(group.pairs.size(), kPairGrain, see);
}

} // namespace rockfall
