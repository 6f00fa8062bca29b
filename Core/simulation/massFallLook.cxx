// The second look of a crowd's step: contacts that show only where the rocks would end.
//
// A step takes the points of touch along the axis on which two rocks are farthest apart when it
// begins, and what may reach the slope as the rocks move then. Rocks that meet fast, turn, or are
// pushed by others on the way may come to touch elsewhere, and would be found as deep in each other
// or in the slope as they go in a step.

#include "simulation/massFallWork.h"

#include "base/parallel.h"
#include "contact/detection.h"
#include "contact/motion.h"
#include "law/settings.h"
#include "simulation/pressOut.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

constexpr std::size_t kMissedGrain = 4;

/// A contact that is found at the end of a step, with its points and normal as they were at the
/// start.
void carryBack(const PlacedBlock& firstEnd, const PlacedBlock& secondEnd,
  const PlacedBlock& firstStart, const PlacedBlock& secondStart, Contact& contact)
{
  const auto direction = [](const PlacedBlock& end, const PlacedBlock& start, const Vec3& x) -> Vec3
  { return start.rotation() * (end.rotation().transpose() * x); };
  const auto point = [&](const PlacedBlock& end, const PlacedBlock& start, const Vec3& x) -> Vec3
  { return start.position() + direction(end, start, x - end.position()); };
  switch (contact.kind)
  {
    case ContactKind::VertexFace:
      contact.point = point(firstEnd, firstStart, contact.point);
      contact.normal = direction(secondEnd, secondStart, contact.normal);
      break;
    case ContactKind::FaceVertex:
      contact.point = point(secondEnd, secondStart, contact.point);
      contact.normal = direction(firstEnd, firstStart, contact.normal);
      break;
    case ContactKind::EdgeEdge:
      contact.point = point(firstEnd, firstStart, contact.point);
      contact.ridge = { point(secondEnd, secondStart, contact.ridge[0]),
        direction(secondEnd, secondStart, contact.ridge[1]) };
      break;
  }
}

} // namespace

LookOutcome MassFall::lookAgain(const Island& island, double h, bool bounces, Workspace& work)
{
  const auto place = [&](std::size_t k)
  {
    this->comeToRock(island, k);
    Member& m = *members_[island.members[k]];
    if (m.sim.body().done)
    {
      return;
    }
    const std::size_t at = std::size_t(m.place);
    Workspace::Motion& motion = work.motions[at];
    motion.moved = work.solver.moved(at);
    if (motion.moved)
    {
      const BlockState end = work.solver.end(work.bodies, at);
      m.end.placeFrame(m.sim.body().block, end);
      m.endBody.update(m.end);
      motion.displacement = end.position - m.sim.body().state.position;
      motion.rimTravel =
        rimTravel(m.sim.body().state.orientation, end.orientation, m.sim.body().block.radius());
      motion.low = m.sim.meetsSolids() || !m.sim.isHighAt(end.position, 0.0);
    }
  };
  forEach(island.members.size(), kRockGrain, place);
  work.looked = true;
  LookOutcome seen;
  seen.passed = this->lookAtPassed(island, work);
  seen.missed = this->lookAtPairs(island, h, bounces, work);
  // Steps that resolve impacts are so short that all they may reach is known.
  if (island.crowd)
  {
    seen.missed = std::max(seen.missed, this->lookAtSlope(island, h, bounces, work));
  }
  seen.again = this->lookAtTrees(island, h, work);
  return seen;
}

void MassFall::add(IslandContact touch, bool bounces, Workspace& work) const
{
  if (bounces)
  {
    meet(work.partners, touch);
    touch.bounce = mayBounce(work.partners, touch) ? touch.bounce : -1.0;
  }
  work.contacts.push_back(touch);
}

std::size_t MassFall::touchesOnSlope(const Island& island, std::size_t m,
  const CandidatePairs& near, Workspace& work, std::vector<Contact>& touches) const
{
  const Member& member = *members_[island.members[m]];
  const RockSimulator& sim = member.sim;
  touches.clear();
  double pressed = 0.0;
  const auto reckoned = [&](std::size_t k)
  {
    Contact c = *work.contacts[k].contact;
    const double gap = work.solver.gap(k);
    pressed = std::max(pressed, -gap);
    c.distance = gap + c.offset;
    touches.push_back(c);
  };
  for (std::size_t k = 0; k < sim.body().contacts.size(); ++k)
  {
    reckoned(work.slopeFirsts[m] + k);
  }
  for (std::size_t k = 0; k < work.addedTo.size(); ++k)
  {
    if (work.addedTo[k].onSlope && work.addedTo[k].of == m)
    {
      reckoned(work.firsts.back() + k);
    }
  }
  const std::size_t known = touches.size();
  holdOverlap(member.end, sim.patch(), near,
    kLooseOverlap * sim.body().block.radius() + 2.0 * pressed, touches);
  // Trees that nobody reckoned with are met in the next step.
  const auto behind = touches.begin() + std::ptrdiff_t(known);
  touches.erase(std::remove_if(behind, touches.end(),
                  [&](const Contact& c) { return sim.meetsSolids() && sim.treeOf(c) >= 0; }),
    touches.end());
  return known;
}

double MassFall::lookAtSlope(const Island& island, double h, bool bounces, Workspace& work)
{
  const auto candidatesOf = [&](std::size_t m) -> const CandidatePairs&
  {
    Member& member = *members_[island.members[m]];
    const std::size_t place = std::size_t(member.place);
    const Workspace::Motion& motion = work.motions[place];
    member.sim.body().placed.placeVertices();
    member.end.placeVertices();
    return member.sim.candidatesAt(work.solver.end(work.bodies, place), member.end, member.endBody,
      motion.displacement.norm() + motion.rimTravel,
      kLooseOverlap * member.sim.body().block.radius());
  };
  const auto isMissed = [&](std::size_t m)
  {
    const int place = work.placeOf[std::size_t(island.members[m])];
    if (place < 0 || !work.motions[std::size_t(place)].moved ||
      !work.motions[std::size_t(place)].low)
    {
      return false;
    }
    const Member& member = *members_[island.members[m]];
    const RockSimulator& sim = member.sim;
    const CandidatePairs& near = candidatesOf(m);
    if (!overlaps(member.end, sim.patch(), near, kLooseOverlap * sim.body().block.radius()))
    {
      return false;
    }
    thread_local std::vector<Contact> touches;
    const std::size_t known = this->touchesOnSlope(island, m, near, work, touches);
    return touches.size() > known;
  };
  double deepest = 0.0;
  work.missed.clear();
  forThose(island.members.size(), kRockGrain, work.flags, isMissed,
    [&](std::size_t m) { work.missed.push_back(m); });
  work.found.resize(std::max<std::size_t>(1, work.found.size()));
  std::vector<Contact>& touches = work.found.front();
  for (const std::size_t m : work.missed)
  {
    Member& member = *members_[island.members[m]];
    for (std::size_t k = this->touchesOnSlope(island, m, candidatesOf(m), work, touches);
         k < touches.size(); ++k)
    {
      Contact& c = touches[k];
      deepest = std::max(deepest, -c.distance / member.sim.body().block.radius());
      const PlacedBlock slope;
      carryBack(member.end, slope, member.sim.body().placed, slope, c);
      c.offset = 0.0;
      member.sim.armContact(c);
      work.added.push_back(c);
      work.addedTo.push_back({ true, m, c });
      this->add(this->islandContact(member, work.added.back(), h, bounces), bounces, work);
    }
  }
  return deepest;
}

double MassFall::lookAtPassed(const Island& island, const Workspace& work) const
{
  double most = 0.0;
  for (std::size_t k = 0; k < work.added.size(); ++k)
  {
    const Workspace::Added& added = work.addedTo[k];
    const double offset = work.added[k].offset;
    if (added.onSlope || offset >= 0.0)
    {
      continue;
    }
    const RockPair& pair = *island.pairs[added.of];
    const double smaller = std::min(
      work.sides[std::size_t(pair.first)].radius, work.sides[std::size_t(pair.second)].radius);
    const double before = std::min(0.0, pair.axis.distance);
    const double deeper = before - (work.solver.gap(work.firsts.back() + k) + offset);
    most = std::max(most, deeper / smaller);
  }
  return most;
}

double MassFall::smallerRadius(const RockPair& pair, const Workspace& work)
{
  return std::min(
    work.sides[std::size_t(pair.first)].radius, work.sides[std::size_t(pair.second)].radius);
}

double MassFall::overlapAt(std::size_t contact, const Workspace& work)
{
  return work.solver.gap(contact) + work.contacts[contact].contact->offset;
}

double MassFall::deepestOf(std::size_t pair, const Workspace& work)
{
  double least = 0.0;
  for (std::size_t k = work.firsts[pair]; k < work.firsts[pair + 1]; ++k)
  {
    least = std::min(least, overlapAt(k, work));
  }
  return least;
}

bool MassFall::findMissed(const Island& island, std::size_t p, const Workspace& work)
{
  comeToPair(island.pairs, p);
  RockPair& pair = *island.pairs[p];
  const std::array<int, 2>& places = work.places[p];
  if (places[0] < 0 || places[1] < 0)
  {
    return false;
  }
  const Workspace::Motion& first = work.motions[std::size_t(places[0])];
  const Workspace::Motion& second = work.motions[std::size_t(places[1])];
  if (!first.moved && !second.moved)
  {
    return false;
  }
  bool touches = false;
  const IslandContact* const end = work.contacts.data() + work.firsts[p + 1];
  for (const IslandContact* k = work.contacts.data() + work.firsts[p]; k != end && !touches; ++k)
  {
    touches = k->closed;
  }
  if (!touches)
  {
    // Along the axis where the step began they may still be apart.
    const double gap = pair.axis.distance +
      pair.axis.normal.dot(first.displacement - second.displacement) - first.rimTravel -
      second.rimTravel;
    if (gap > 0.0)
    {
      pair.end = pair.axis;
      pair.end.distance = gap;
      return false;
    }
  }
  pair.end =
    findAxis(members_[pair.first]->endBody, members_[pair.second]->endBody, pair.axis, 0.0);
  const double deep = -kMissed * smallerRadius(pair, work);
  if (pair.end.kind == PairAxis::Kind::None || !(pair.end.distance < deep))
  {
    return false;
  }
  // Mostly one of the contacts is as deep.
  std::size_t k = work.firsts[p];
  while (k < work.firsts[p + 1] && pair.end.distance < overlapAt(k, work) + deep)
  {
    ++k;
  }
  return k == work.firsts[p + 1];
}

double MassFall::addMissed(
  const Island& island, std::size_t m, double h, bool bounces, Workspace& work)
{
  double most = 0.0;
  const std::size_t firstAdded = work.firsts.back();
  const auto isAddedTo = [&](std::size_t k, std::size_t p)
  { return !work.addedTo[k].onSlope && work.addedTo[k].of == p; };
  const std::size_t p = work.missed[m];
  RockPair& pair = *island.pairs[p];
  const Member &a = *members_[pair.first], &b = *members_[pair.second];
  const PairMotion motion = work.motionOf(pair);
  for (Contact& c : work.found[m])
  {
    // A contact that is there already was reckoned wrong.
    const auto same = [&](std::size_t k)
    {
      const Contact& old = *work.contacts[k].contact;
      return old.kind == c.kind && old.rockFeature == c.rockFeature &&
        old.surfaceFeature == c.surfaceFeature;
    };
    std::size_t known = work.firsts[p];
    while (known < work.firsts[p + 1] && !same(known))
    {
      ++known;
    }
    if (known == work.firsts[p + 1])
    {
      known = firstAdded;
      while (known < work.contacts.size() && !(isAddedTo(known - firstAdded, p) && same(known)))
      {
        ++known;
      }
    }
    if (known < work.contacts.size())
    {
      const double gap = c.distance - work.contacts[known].contact->offset;
      const double wrong = std::abs(work.solver.gap(known) - gap) / smallerRadius(pair, work);
      most = work.solver.setGap(known, gap) ? std::max(most, wrong) : most;
      continue;
    }
    most = std::max(most, (deepestOf(p, work) - c.distance) / smallerRadius(pair, work));
    carryBack(a.end, b.end, a.sim.body().placed, b.sim.body().placed, c);
    this->setSprings(pair, c);
    work.added.push_back(c);
    work.addedTo.push_back({ false, p, c });
    this->add(
      this->islandContact(pair, motion, work.added.back(), h, bounces, work), bounces, work);
  }
  return most;
}

double MassFall::lookAtPairs(const Island& island, double h, bool bounces, Workspace& work)
{
  work.missed.clear();
  forThose(
    island.pairs.size(), kPairGrain, work.flags,
    [&](std::size_t p) { return this->findMissed(island, p, work); },
    [&](std::size_t p) { work.missed.push_back(p); });
  work.found.resize(std::max(work.found.size(), work.missed.size()));
  const auto findThem = [&](std::size_t m)
  {
    RockPair& pair = *island.pairs[work.missed[m]];
    const Member &a = *members_[pair.first], &b = *members_[pair.second];
    const double limit = deepestOf(work.missed[m], work) - kMissed * smallerRadius(pair, work);
    findTouches(a.endBody, b.endBody, pair.end, 0.0, work.found[m], limit);
  };
  forEach(work.missed.size(), kMissedGrain, findThem);
  double most = 0.0;
  for (std::size_t m = 0; m < work.missed.size(); ++m)
  {
    if (!work.found[m].empty())
    {
      most = std::max(most, this->addMissed(island, m, h, bounces, work));
    }
  }
  return most;
}

} // namespace rockfall
