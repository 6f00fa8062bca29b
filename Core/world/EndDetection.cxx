#include "world/EndDetection.h"

#include "base/parallel.h"
#include "contact/ground/detection.h"
#include "contact/ground/motion.h"
#include "law/settings.h"
#include "rock/fall/contactPhase.h"
#include "rock/fall/islandOfOne.h"
#include "world/StepTrees.h"
#include "world/stepContacts.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

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

EndDetection::EndDetection(
  WorldState& world, const Island& island, IslandWork& work, double duration)
  : world_(world)
  , island_(island)
  , work_(work)
  , h_(duration)
{
}

EndDetectionOutcome EndDetection::detect()
{
  forEach(island_.members.size(), kRockGrain, [this](std::size_t m) { this->placeRock(m); });
  EndDetectionOutcome seen;
  seen.passed = this->deepestPassed();
  seen.missed = this->detectAtPairs();
  seen.missed = std::max(seen.missed, this->detectOnSlope());
  seen.again = StepTrees(world_, island_, work_).look(h_);
  return seen;
}

void EndDetection::placeRock(std::size_t m)
{
  FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
  const RockBody& body = rock.body();
  if (body.done)
  {
    return;
  }
  const std::size_t place = std::size_t(rock.place);
  IslandWork::Motion& motion = work_.motions[place];
  motion.moved = work_.solver.moved(place);
  if (motion.moved)
  {
    const BlockState end = work_.solver.end(place);
    rock.end.placeFrame(body.block, end);
    rock.endHull.update(rock.end);
    motion.displacement = end.position - body.state.position;
    motion.rimTravel = rimTravel(body.state.orientation, end.orientation, body.block.radius());
    motion.low = rock.fall().structures.solid() ||
      !rock.fall().ground.isClearAt(rock.body(), end.position, 0.0);
  }
}

double EndDetection::deepestPassed() const
{
  double most = 0.0;
  for (std::size_t k = 0; k < work_.added.size(); ++k)
  {
    const IslandWork::Added& added = work_.addedTo[k];
    const double offset = work_.added[k].offset;
    if (added.onSlope || offset >= 0.0)
    {
      continue;
    }
    const RockPair& pair = *island_.pairs[added.of];
    const double before = std::min(0.0, pair.axis.distance);
    const double deeper = before - (work_.solver.gap(work_.firsts.back() + k) + offset);
    most = std::max(most, deeper / work_.smallerRadius(pair));
  }
  return most;
}

double EndDetection::overlapAt(std::size_t contact) const
{
  return work_.solver.gap(contact) + work_.contacts[contact].contact->offset;
}

double EndDetection::deepestOf(std::size_t pair) const
{
  double least = 0.0;
  for (std::size_t k = work_.firsts[pair]; k < work_.firsts[pair + 1]; ++k)
  {
    least = std::min(least, this->overlapAt(k));
  }
  return least;
}

double EndDetection::detectAtPairs()
{
  constexpr std::size_t kMissedGrain = 4;
  work_.missed.clear();
  forThose(
    island_.pairs.size(), kPairGrain, work_.flags,
    [this](std::size_t p) { return this->isMissed(p); },
    [this](std::size_t p) { work_.missed.push_back(p); });
  work_.found.resize(std::max(work_.found.size(), work_.missed.size()));
  const auto findTouchesOf = [this](std::size_t m)
  {
    RockPair& pair = *island_.pairs[work_.missed[m]];
    const double limit = this->deepestOf(work_.missed[m]) - kMissed * work_.smallerRadius(pair);
    findTouches(world_.rocks[std::size_t(pair.first)].endHull,
      world_.rocks[std::size_t(pair.second)].endHull, pair.end, 0.0, work_.found[m], limit);
  };
  forEach(work_.missed.size(), kMissedGrain, findTouchesOf);
  double most = 0.0;
  for (std::size_t m = 0; m < work_.missed.size(); ++m)
  {
    if (!work_.found[m].empty())
    {
      most = std::max(most, this->addMissed(m));
    }
  }
  return most;
}

bool EndDetection::isMissed(std::size_t p)
{
  RockPair& pair = *island_.pairs[p];
  const std::array<int, 2>& places = work_.places[p];
  if (places[0] < 0 || places[1] < 0)
  {
    return false;
  }
  const IslandWork::Motion& first = work_.motions[std::size_t(places[0])];
  const IslandWork::Motion& second = work_.motions[std::size_t(places[1])];
  if (!first.moved && !second.moved)
  {
    return false;
  }
  bool touches = false;
  const IslandContact* const end = work_.contacts.data() + work_.firsts[p + 1];
  for (const IslandContact* k = work_.contacts.data() + work_.firsts[p]; k != end && !touches; ++k)
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
  pair.end = findAxis(world_.rocks[std::size_t(pair.first)].endHull,
    world_.rocks[std::size_t(pair.second)].endHull, pair.axis, 0.0);
  const double deep = -kMissed * work_.smallerRadius(pair);
  if (pair.end.kind == PairAxis::Kind::None || !(pair.end.distance < deep))
  {
    return false;
  }
  // Mostly one of the contacts is as deep.
  std::size_t k = work_.firsts[p];
  while (k < work_.firsts[p + 1] && pair.end.distance < this->overlapAt(k) + deep)
  {
    ++k;
  }
  return k == work_.firsts[p + 1];
}

std::size_t EndDetection::find(std::size_t p, const Contact& touch) const
{
  const auto isSame = [&](std::size_t k)
  {
    const Contact& old = *work_.contacts[k].contact;
    return old.kind == touch.kind && old.rockFeature == touch.rockFeature &&
      old.surfaceFeature == touch.surfaceFeature;
  };
  for (std::size_t k = work_.firsts[p]; k < work_.firsts[p + 1]; ++k)
  {
    if (isSame(k))
    {
      return k;
    }
  }
  const std::size_t firstAdded = work_.firsts.back();
  for (std::size_t k = firstAdded; k < work_.contacts.size(); ++k)
  {
    const IslandWork::Added& added = work_.addedTo[k - firstAdded];
    if (!added.onSlope && added.of == p && isSame(k))
    {
      return k;
    }
  }
  return work_.contacts.size();
}

double EndDetection::addMissed(std::size_t m)
{
  double most = 0.0;
  const std::size_t p = work_.missed[m];
  RockPair& pair = *island_.pairs[p];
  const FallingRock& a = world_.rocks[std::size_t(pair.first)];
  const FallingRock& b = world_.rocks[std::size_t(pair.second)];
  const PairMotion motion = work_.motionOf(pair);
  const double smaller = work_.smallerRadius(pair);
  for (Contact& c : work_.found[m])
  {
    const std::size_t known = this->find(p, c);
    if (known < work_.contacts.size())
    {
      // A contact that is there already was reckoned wrong.
      const double gap = c.distance - work_.contacts[known].contact->offset;
      const double wrong = std::abs(work_.solver.gap(known) - gap) / smaller;
      most = work_.solver.setGap(known, gap) ? std::max(most, wrong) : most;
      continue;
    }
    most = std::max(most, (this->deepestOf(p) - c.distance) / smaller);
    carryBack(a.end, b.end, a.body().placed, b.body().placed, c);
    setSprings(world_, pair, c);
    work_.added.push_back(c);
    work_.addedTo.push_back({ false, p, c });
    work_.contacts.push_back(touchOfPair(world_, pair, motion, work_.added.back(), work_));
  }
  return most;
}

const CandidatePairs& EndDetection::candidatesOf(std::size_t m)
{
  FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
  const std::size_t place = std::size_t(rock.place);
  rock.body().placed.placeVertices();
  rock.end.placeVertices();
  Fall& fall = rock.fall();
  return fall.ground.candidatesAt(
    fall.body, fall.structures, work_.solver.end(place), this->cameFrom(rock).way);
}

CameFrom EndDetection::cameFrom(const FallingRock& rock) const
{
  const IslandWork::Motion& motion = work_.motions[std::size_t(rock.place)];
  return { rock.body().state.position, motion.displacement.norm() + motion.rimTravel };
}

std::size_t EndDetection::touchesOnSlope(
  std::size_t m, const CandidatePairs& near, std::vector<Contact>& touches) const
{
  const FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
  const Fall& fall = rock.fall();
  touches.clear();
  double pressed = 0.0;
  const auto addReckoned = [&](std::size_t k)
  {
    Contact c = *work_.contacts[k].contact;
    const double gap = work_.solver.gap(k);
    pressed = std::max(pressed, -gap);
    c.distance = gap + c.offset;
    touches.push_back(c);
  };
  for (std::size_t k = 0; k < rock.body().contacts.size(); ++k)
  {
    addReckoned(work_.slopeFirsts[m] + k);
  }
  for (std::size_t k = 0; k < work_.addedTo.size(); ++k)
  {
    if (work_.addedTo[k].onSlope && work_.addedTo[k].of == m)
    {
      addReckoned(work_.firsts.back() + k);
    }
  }
  const std::size_t known = touches.size();
  guardPenetration(rock.end, fall.ground.patch(), near,
    kLooseOverlap * rock.body().block.radius() + 2.0 * pressed, this->cameFrom(rock), touches);
  // Trees that nobody reckoned with are met in the next step.
  const auto behind = touches.begin() + std::ptrdiff_t(known);
  touches.erase(
    std::remove_if(behind, touches.end(),
      [&](const Contact& c) { return fall.structures.solid() && fall.structures.treeOf(c) >= 0; }),
    touches.end());
  return known;
}

bool EndDetection::isMissedOnSlope(std::size_t m)
{
  const std::size_t rock = std::size_t(island_.members[m]);
  const int place = work_.placeOf[rock];
  if (place < 0 || !work_.motions[std::size_t(place)].moved ||
    !work_.motions[std::size_t(place)].low)
  {
    return false;
  }
  const FallingRock& member = world_.rocks[rock];
  const CandidatePairs& near = this->candidatesOf(m);
  const double loose = kLooseOverlap * member.body().block.radius();
  if (!overlaps(member.end, member.fall().ground.patch(), near, loose, this->cameFrom(member)))
  {
    return false;
  }
  thread_local std::vector<Contact> touches;
  const std::size_t known = this->touchesOnSlope(m, near, touches);
  return touches.size() > known;
}

double EndDetection::detectOnSlope()
{
  double deepest = 0.0;
  work_.missed.clear();
  forThose(
    island_.members.size(), kRockGrain, work_.flags,
    [this](std::size_t m) { return this->isMissedOnSlope(m); },
    [this](std::size_t m) { work_.missed.push_back(m); });
  work_.found.resize(std::max<std::size_t>(1, work_.found.size()));
  std::vector<Contact>& touches = work_.found.front();
  for (const std::size_t m : work_.missed)
  {
    FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
    for (std::size_t k = this->touchesOnSlope(m, this->candidatesOf(m), touches);
         k < touches.size(); ++k)
    {
      Contact& c = touches[k];
      deepest = std::max(deepest, -c.distance / rock.body().block.radius());
      const PlacedBlock slope;
      carryBack(rock.end, slope, rock.body().placed, slope, c);
      c.offset = 0.0;
      setSprings(rock.fall(), c);
      work_.added.push_back(c);
      work_.addedTo.push_back({ true, m, c });
      work_.contacts.push_back(touchOnSlope(rock.fall(), rock.place, work_.added.back()));
    }
  }
  return deepest;
}

} // namespace rockfall
