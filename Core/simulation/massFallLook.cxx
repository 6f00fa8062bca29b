// The second look of a crowd's step: contacts that show only where the rocks would end.
//
// A step takes the points of touch along the axis on which two rocks are farthest apart when it
// begins. Rocks that meet fast, turn, or are pushed by others on the way may come to touch
// elsewhere, and would be found as deep in each other as they go in a step.

#include "simulation/massFallWork.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// What is deeper than reckoned by more than this share of the smaller radius was missed.
constexpr double kMissed = 5e-5;

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

bool MassFall::lookAgain(const Group& group, double h, bool bounces, Workspace& work) const
{
  const auto place = [&](std::size_t k)
  {
    Member& m = *members_[group.members[k]];
    if (!m.sim.done_ && work.solver.moved(std::size_t(m.place)))
    {
      m.end.place(m.sim.block_, work.solver.end(work.bodies, std::size_t(m.place)));
      m.endBody.update(m.end);
    }
  };
  forEach(group.members.size(), kRockGrain, place);
  work.looked = true;
  const auto allowed = [&](const RockPair& pair)
  {
    return kMissed *
      std::min(
        members_[pair.first]->sim.block_.radius(), members_[pair.second]->sim.block_.radius());
  };
  const std::size_t firstAdded = work.firsts.back();
  const auto deepest = [&](std::size_t p)
  {
    double least = 0.0;
    for (std::size_t k = work.firsts[p]; k < work.firsts[p + 1]; ++k)
    {
      least = std::min(least, work.solver.gap(k) + work.contacts[k].contact->offset);
    }
    return least;
  };
  const auto compare = [&](std::size_t p)
  {
    RockPair& pair = *group.pairs[p];
    const Member &a = *members_[pair.first], &b = *members_[pair.second];
    if (a.sim.done_ || b.sim.done_ ||
      !(work.solver.moved(std::size_t(a.place)) || work.solver.moved(std::size_t(b.place))))
    {
      return false;
    }
    pair.end = findAxis(a.endBody, b.endBody, pair.axis, 0.0);
    const double deep = -allowed(pair);
    return pair.end.kind != PairAxis::Kind::None && pair.end.distance < deep &&
      pair.end.distance < deepest(p) + deep;
  };
  work.missedPairs.clear();
  forThose(group.pairs.size(), kPairGrain, work.flags, compare,
    [&](std::size_t p) { work.missedPairs.push_back(p); });
  work.found.resize(std::max(work.found.size(), work.missedPairs.size()));
  const auto findThem = [&](std::size_t m)
  {
    RockPair& pair = *group.pairs[work.missedPairs[m]];
    const Member &a = *members_[pair.first], &b = *members_[pair.second];
    findTouches(a.endBody, b.endBody, pair.end, 0.0, work.found[m]);
  };
  forEach(work.missedPairs.size(), kMissedGrain, findThem);
  bool any = false;
  for (std::size_t m = 0; m < work.missedPairs.size(); ++m)
  {
    const std::size_t p = work.missedPairs[m];
    RockPair& pair = *group.pairs[p];
    const Member &a = *members_[pair.first], &b = *members_[pair.second];
    const double limit = deepest(p) - allowed(pair);
    for (Contact& c : work.found[m])
    {
      if (c.distance >= limit)
      {
        continue;
      }
      // One that is there already was reckoned wrong.
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
        while (
          known < work.contacts.size() && !(work.addedTo[known - firstAdded] == p && same(known)))
        {
          ++known;
        }
      }
      if (known < work.contacts.size())
      {
        any = work.solver.setGap(known, c.distance - work.contacts[known].contact->offset) || any;
        continue;
      }
      any = true;
      carryBack(a.end, b.end, a.sim.placed_, b.sim.placed_, c);
      this->armContact(pair, c);
      work.added.push_back(c);
      work.addedTo.push_back(p);
      GroupContact taken = this->take(pair, work.added.back(), h, bounces);
      if (bounces)
      {
        meet(work.partners, taken);
        taken.bounce = mayBounce(work.partners, taken) ? taken.bounce : -1.0;
      }
      work.contacts.push_back(taken);
    }
  }
  return any;
}

} // namespace rockfall
