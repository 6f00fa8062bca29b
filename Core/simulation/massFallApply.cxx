// Results of an island's step: into its rocks and pairs.

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

/// A contact that others press in further than its two rocks could yields, at the force that it
/// has: energy that its spring would hold beyond is not given back.
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

/// Books a contact of a pair in a step of `h`.
void MassFall::bookContact(RockPair& pair, const IslandContact& touch, double h)
{
  const Contact& c = *touch.contact;
  RockPair::Impact& impact = pair.impact;
  if (!pair.strikes)
  {
    pair.lastingLoss += touch.work;
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
  impact.loss += touch.work;
}

void MassFall::applyToPair(
  const Island& island, std::size_t t, double h, StepKind kind, Workspace& work)
{
  std::vector<std::uint64_t>& carriers = work.carriers;
  const double end = work.bodies.front().state->time;
  work.comeToTouching(island, t);
  const std::size_t p = work.touching[t];
  RockPair& pair = *island.pairs[p];
  const std::array<int, 2>& places = work.places[p];
  std::uint64_t carry[2] = {};
  for (std::size_t k = work.firsts[p]; k < work.firsts[p + 1]; ++k)
  {
    this->findKnock(pair, work.contacts[k], h);
  }
  for (std::size_t k = work.firsts[p]; k < work.firsts[p + 1]; ++k)
  {
    const Contact& c = *work.contacts[k].contact;
    bookContact(pair, work.contacts[k], h);
    pair.touched = pair.touched || c.closed();
    if (c.closed())
    {
      carry[0] += keyOf(c) * std::uint64_t(pair.second + 2);
      carry[1] += keyOf(c) * std::uint64_t(pair.first + 2);
    }
  }
  work.flags[p] = pair.strikes;
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
  // An overlap that was found is recovered slowly.
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
}

void MassFall::applyMissed(const Island& island, double h, StepKind kind, Workspace& work)
{
  std::vector<std::uint64_t>& carriers = work.carriers;
  std::vector<char>& strike = work.flags;
  const double end = work.bodies.front().state->time;
  for (std::size_t k = 0; k < work.added.size(); ++k)
  {
    const Contact& c = work.added[k];
    const Workspace::Added& added = work.addedTo[k];
    if (added.onSlope)
    {
      RockSimulator& sim = members_[island.members[added.of]]->sim;
      sim.body().contacts.push_back(c);
      sim.body().contactsBefore.push_back(added.before);
      continue;
    }
    RockPair& pair = *island.pairs[added.of];
    this->findKnock(pair, work.contacts[work.firsts.back() + k], h);
    bookContact(pair, work.contacts[work.firsts.back() + k], h);
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
    if (strike[p] && (kind == StepKind::Lasting || !island.pairs[p]->touched))
    {
      this->finishPairImpact(*island.pairs[p]);
    }
  }
}

void MassFall::applyToRock(
  const Island& island, std::size_t k, double h, StepKind kind, Workspace& work)
{
  const std::vector<std::uint64_t>& carriers = work.carriers;
  const bool crowd = island.crowd;
  this->comeToRock(island, k);
  Member& m = *members_[island.members[k]];
  if (m.sim.body().done)
  {
    return;
  }
  const int b = m.place;
  work.arrived[std::size_t(b)] = false;
  work.count(m.sim);
  const IslandBody& body = work.bodies[b];
  StepOutcome outcome;
  outcome.frictionWork = body.frictionWork;
  outcome.dampedWork = body.dampedWork;
  outcome.springEnergy = body.springEnergy;
  outcome.normalEnergy = body.normalEnergy;
  m.sim.absorb(kind, outcome, work.energyBefore[b], body.given);
  const std::vector<Contact>& c = m.sim.body().contacts;
  const bool carried = work.touchesOthers[std::size_t(b)] ||
    std::any_of(c.begin(), c.end(), [](const Contact& touch) { return touch.closed(); });
  // In a crowd some contact opens or closes in every step, and the acceleration of one step says
  // little of the next: carried on it would keep the pile in motion for ever.
  if (carriers[b] != m.carriers || (crowd && carried))
  {
    m.sim.body().acceleration.setZero();
    m.sim.body().spinAcceleration.setZero();
    m.carriers = carriers[b];
  }
  if (m.sim.body().done)
  {
    return; // caught
  }
  this->fellTrees(island, k, work);
  m.sim.checkLeft();
  m.sim.followRest(h, carried);
  if (!m.sim.body().done && m.sim.body().state.time >= parameters_.endTime - kTooShort)
  {
    m.sim.end(Fate::Moving);
  }
  const bool arrived = work.looked && m.arrive();
  work.arrived[std::size_t(b)] = arrived;
  if (crowd && !arrived)
  {
    const BlockState &from = m.sim.body().before, &to = m.sim.body().state;
    const double r = m.sim.body().block.radius();
    Workspace::Motion& motion = work.motions[std::size_t(b)];
    motion.displacement = to.position - from.position;
    motion.rimTravel =
      rimTravel(from.orientation, to.orientation, r) + r * (to.strain - from.strain).norm();
  }
}

void MassFall::keepAxis(const Island& island, std::size_t p, const Workspace& work)
{
  comeToPair(island.pairs, p);
  RockPair& pair = *island.pairs[p];
  const auto [a, b] = work.places[p];
  const bool both = a >= 0 && b >= 0;
  pair.seen = both && work.arrived[std::size_t(a)] && work.arrived[std::size_t(b)];
  if (pair.seen)
  {
    pair.before = pair.axis;
    pair.axis = pair.end;
  }
  else if (island.crowd && both && !pair.touched && !members_[pair.first]->sim.body().done &&
    !members_[pair.second]->sim.body().done)
  {
    // The look was before the last sweeps; the two may still be apart as they were.
    const Workspace::Motion& motion = work.motions[std::size_t(a)];
    const Workspace::Motion& other = work.motions[std::size_t(b)];
    const double gap = pair.axis.distance +
      pair.axis.normal.dot(motion.displacement - other.displacement) - motion.rimTravel -
      other.rimTravel;
    pair.seen = gap > 0.0;
    if (pair.seen)
    {
      pair.before = pair.axis;
      pair.axis.distance = gap;
    }
  }
}

void MassFall::applyStep(const Island& island, double h, StepKind kind, Workspace& work)
{
  work.carriers.assign(work.bodies.size(), 0);
  work.touchesOthers.assign(work.bodies.size(), 0);
  work.flags.resize(std::max(work.flags.size(), island.pairs.size()));
  forEach(work.touching.size(), kPairGrain,
    [&](std::size_t t) { this->applyToPair(island, t, h, kind, work); });
  this->applyMissed(island, h, kind, work);
  forEach(island.members.size(), kRockGrain,
    [&](std::size_t k) { this->applyToRock(island, k, h, kind, work); });
  forEach(island.pairs.size(), kPairGrain, [&](std::size_t p) { this->keepAxis(island, p, work); });
}

} // namespace rockfall
