#include "rock/parts/StructuresOnWay.h"

#include "block/flight.h"
#include "contact/ground/clearance.h"
#include "contact/ground/roundContact.h"
#include "law/settings.h"
#include "rock/parts/RockBody.h"
#include "terrain/Surface.h"
#include "terrain/stemHit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace rockfall
{

void slowDown(BlockState& state, double energy, double taken)
{
  const double factor = energy > 0.0 ? std::sqrt(std::max(0.0, 1.0 - taken / energy)) : 0.0;
  state.velocity *= factor;
  state.spin *= factor;
}

namespace
{

/// How far a block reaches from its centre against a direction, m.
double reachAgainst(const Block& block, const BlockState& state, const Vec3& side)
{
  PlacedBlock placed;
  placed.place(block, state);
  double reach = isRound(placed) ? roundReach(roundAxes(placed), side) : 0.0;
  for (const Vec3& vertex : placed.vertices())
  {
    reach = std::max(reach, side.dot(state.position - vertex));
  }
  return reach;
}

} // namespace

StructureEvent eventAt(StructureOutcome outcome, std::int64_t feature, const Block& block,
  const BlockState& at, double energy, double height)
{
  StructureEvent event;
  event.outcome = outcome;
  event.feature = feature;
  event.time = at.time;
  event.position = at.position;
  event.velocity = at.velocity;
  event.kineticEnergy = energy;
  event.heightOverGround = height;
  event.topHeight = height + reachAgainst(block, at, -Vec3::UnitZ());
  return event;
}

void noteLoad(StructureEvent& event, const BarrierLoad& before, const BarrierState& barrier)
{
  event.heldBefore = before.energy;
  event.usefulHeight = std::max(0.0, barrier.rope - barrier.fill);
}

namespace
{

/// A hit on a stem: square to its axis, or against its end.
struct StemHit
{
  double offset = 0.0;       ///< See terrain/stemHit.h.
  Vec3 away = Vec3::Zero();  ///< Of the stem's push on the rock; zero if nothing moves across.
  Vec3 along = Vec3::Zero(); ///< Of the rock that slips past the stem.
  Vec3 axis = Vec3::Zero();  ///< The stem pushes square to it; zero: against its end.
};

/// A stem from end to end, against which a rock comes. A standing one has no lower end to be hit.
struct StemAxis
{
  Vec3 from, to;
  double radius; ///< m
  bool lies;
};

StemAxis axisOf(const Obstacles& obstacles, int tree)
{
  if (const LyingStem* lying = obstacles.lyingOf(tree))
  {
    return { lying->from, lying->to, lying->radius, true };
  }
  const Tree& stem = obstacles.structures().trees[std::size_t(tree)];
  const Vec3 top(stem.position.x(), stem.position.y(), obstacles.treeTop(tree));
  return { top - stem.height * Vec3::UnitZ(), top, 0.5 * stem.diameter, false };
}

/// The offset is that of the rock's way from the axis, square to both. What comes with its centre
/// beyond an end and towards it, or passes the axis of a lying stem beyond its ends, hits that end:
/// the offset is from there, and nothing of the velocity is along.
StemHit hitOn(const Obstacles& obstacles, int tree, const Block& block, const BlockState& state)
{
  const StemAxis stem = axisOf(obstacles, tree);
  const double length = (stem.to - stem.from).norm();
  const Vec3 axis = (stem.to - stem.from) / length;
  const Vec3 off = state.position - stem.from;
  const double place = axis.dot(off), forth = axis.dot(state.velocity);
  const Vec3 across = state.velocity - forth * axis;
  const bool passes = across.squaredNorm() > 0.0;
  const double time = passes ? -across.dot(off) / across.squaredNorm() : 0.0;
  const double meets = place + time * forth; // where they pass each other, along the axis
  const bool comesDown = place > length && forth < 0.0;
  const bool comesUp = place < 0.0 && forth > 0.0;
  const bool onEnd =
    comesDown || (stem.lies && (comesUp || !passes || meets < 0.0 || meets > length));
  const double nearest = stem.lies && place >= 0.0 && place <= length ? meets : place;
  const Vec3 way = onEnd ? state.velocity : across;
  const Vec3 fixed = onEnd ? Vec3::Zero() : axis;
  if (!(way.squaredNorm() > 0.0))
  {
    return { 0.0, Vec3::Zero(), Vec3::Zero(), fixed };
  }
  const Vec3 along = way.normalized();
  Vec3 side = state.position - (stem.from + std::clamp(nearest, 0.0, length) * axis);
  side -= fixed.dot(side) * fixed;
  side -= along.dot(side) * along;
  const double distance = side.norm();
  if (!(distance > 0.0))
  {
    return { 0.0, -along, along, fixed };
  }
  side /= distance;
  const double offset = std::min(1.0, distance / (reachAgainst(block, state, side) + stem.radius));
  const double towards = std::sqrt(1.0 - offset * offset);
  return { offset, offset * side - towards * along, towards * side + offset * along, fixed };
}

/// The state without its velocity along the axis of a stem, which no push of it changes.
BlockState acrossOf(const StemHit& hit, const BlockState& state)
{
  BlockState across = state;
  across.velocity -= hit.axis.dot(state.velocity) * hit.axis;
  return across;
}

/// Takes kinetic energy (J) of the velocity across the stem and of spin: both become smaller by the
/// same factor.
void slowAcross(BlockState& state, const Block& block, const StemHit& hit, double taken)
{
  BlockState across = acrossOf(hit, state);
  const Vec3 forth = state.velocity - across.velocity;
  slowDown(across, rigidKineticEnergy(block, across), taken);
  state.velocity = forth + across.velocity;
  state.spin = across.spin;
}

/// Takes kinetic energy (J) by a push: it turns the velocity and leaves the spin. What a push that
/// way cannot take slows all down that the stem can act on.
void pushAway(BlockState& state, const Block& block, const StemHit& hit, double taken)
{
  if (!(taken > 0.0))
  {
    return;
  }
  const double energy = rigidKineticEnergy(block, state);
  const double towards = std::max(0.0, -hit.away.dot(state.velocity));
  const double left = std::sqrt(std::max(0.0, towards * towards - 2.0 * taken / block.mass()));
  state.velocity += (towards - left) * hit.away;
  const double more = taken - (energy - rigidKineticEnergy(block, state));
  if (more > 1e-12 * energy)
  {
    slowAcross(state, block, hit, more);
  }
}

/// Takes kinetic energy (J) and turns the velocity across the stem to where it slips past; spin is left.
/// What that velocity does not have slows all down that the stem can act on.
void slipPast(BlockState& state, const Block& block, const StemHit& hit, double taken)
{
  const double energy = rigidKineticEnergy(block, state);
  const Vec3 across = acrossOf(hit, state).velocity, forth = state.velocity - across;
  state.velocity =
    forth + std::sqrt(std::max(0.0, across.squaredNorm() - 2.0 * taken / block.mass())) * hit.along;
  const double more = taken - (energy - rigidKineticEnergy(block, state));
  if (more > 1e-12 * energy)
  {
    slowAcross(state, block, hit, more);
  }
}

} // namespace

StructuresOnWay::StructuresOnWay(const Surface& surface)
  : surface_(&surface)
  , obstacles_(surface.terrain().obstacles())
{
  solid_ = obstacles_ && obstacles_->solid();
  barriers_ = obstacles_ && !obstacles_->structures().barriers.empty();
}

void StructuresOnWay::clearTrees(const PlacedBlock& rock, const BlockState& state)
{
  const double r = rock.block().radius();
  const Vec3& p = state.position;
  SurfacePatch stem;
  obstacles_->visitTrees(p.x() - r, p.x() + r, p.y() - r, p.y() + r,
    [&](int k)
    {
      stem.nodes.clear();
      stem.triangles.clear();
      stem.ridges.clear();
      obstacles_->append({}, std::span<const int>(&k, 1), stem);
      const double distance = clearance(rock, state, stem, 0.0, 0.0).distance;
      if (distance <= 0.0 || obstacles_->isInTree(k, p))
      {
        goneTrees_.push_back(k);
      }
    });
  std::sort(goneTrees_.begin(), goneTrees_.end());
}

int StructuresOnWay::treeOf(const Contact& contact) const
{
  return contact.cfe >= obstacles_->firstCfe() ? obstacles_->treeOf(contact.cfe) : -1;
}

bool StructuresOnWay::stemHolds(
  int tree, const RockBody& body, const BlockState& state, std::span<const Contact> contacts) const
{
  const Block& block = body.block;
  const Tree& stem = obstacles_->structures().trees[std::size_t(tree)];
  const double energy = rigidKineticEnergy(block, state);
  if (stem.lies())
  {
    return energy <= stem.capacity ||
      energyTowards(hitOn(*obstacles_, tree, block, state).offset, energy) <= stem.capacity;
  }
  if (energy > stem.capacity)
  {
    return false;
  }
  const bool presses = std::any_of(contacts.begin(), contacts.end(),
    [&](const Contact& c) { return c.closed() && this->treeOf(c) == tree; });
  const double resting = 0.5 * block.mass() * body.restingSpeed * body.restingSpeed;
  return presses || energy <= resting ||
    energy <= stemShare(hitOn(*obstacles_, tree, block, state).offset) * stem.capacity;
}

std::vector<int> StructuresOnWay::treesHit(const RockBody& body) const
{
  std::vector<int> hit;
  for (std::size_t i = 0; i < body.contactsBefore.size(); ++i)
  {
    const Contact& c = body.contacts[i];
    const int tree = this->treeOf(c);
    if (tree >= 0 && c.closed() && !body.contactsBefore[i].closed() &&
      !this->stemHolds(tree, body, body.before, body.contactsBefore))
    {
      hit.push_back(tree);
    }
  }
  return hit;
}

bool StructuresOnWay::breakTrees(
  double h, std::span<const int> hit, RockBody& body, std::vector<StructureEvent>& events)
{
  bool any = false;
  const Vec3 spin = body.state.angularVelocity();
  for (const Contact& c : body.contacts)
  {
    const int tree = this->treeOf(c);
    if (tree < 0 || this->isGone(tree))
    {
      continue;
    }
    const double approach = approachOf(body.state, spin, c.point, c.normal);
    const bool meets =
      c.closed() ? approach > body.restingSpeed : approach > 0.0 && c.gap() < approach * h;
    if (!(meets || std::find(hit.begin(), hit.end(), tree) != hit.end()) ||
      this->stemHolds(tree, body, body.state, body.contacts))
    {
      continue;
    }
    // Energy of the springs against the stem is not given back.
    double held = 0.0;
    for (const Contact& other : body.contacts)
    {
      held += this->treeOf(other) == tree ? other.springEnergy() : 0.0;
    }
    this->passTree(tree, held, false, body, events);
    body.springEnergy = std::max(0.0, body.springEnergy - held);
    any = true;
  }
  return any;
}

double StructuresOnWay::capacityOf(int tree) const
{
  return obstacles_->structures().trees[std::size_t(tree)].capacity;
}

void StructuresOnWay::passTree(
  int tree, double held, bool driven, RockBody& body, std::vector<StructureEvent>& events)
{
  const Tree& stem = obstacles_->structures().trees[std::size_t(tree)];
  const double energy = rigidKineticEnergy(body.block, body.state);
  const double height =
    body.state.position.z() - surface_->elevation(body.state.position.x(), body.state.position.y());
  const StemHit hit = hitOn(*obstacles_, tree, body.block, body.state);
  const bool stands = !driven && energyTowards(hit.offset, energy) <= stem.capacity;
  StructureEvent event =
    eventAt(stands ? StructureOutcome::TreePassed : StructureOutcome::TreeBroken, stem.feature,
      body.block, body.state, energy, height);
  // No more than its push can take, of which springs hold a part already.
  const double across = rigidKineticEnergy(body.block, acrossOf(hit, body.state));
  const double taken = std::min(stemShare(hit.offset) * stem.capacity, held + across);
  event.energyTaken = std::max(held, taken);
  events.push_back(event);
  if (stands)
  {
    slipPast(body.state, body.block, hit, std::max(0.0, taken - held));
  }
  else
  {
    pushAway(body.state, body.block, hit, taken - held);
    broke_.trees.push_back(tree);
  }
  body.energy.structures += held + energy - rigidKineticEnergy(body.block, body.state);
  goneTrees_.insert(std::lower_bound(goneTrees_.begin(), goneTrees_.end(), tree), tree);
}

double StructuresOnWay::notedDriven(int tree) const
{
  const auto at = broke_.driven.find(tree);
  return at == broke_.driven.end() ? 0.0 : at->second;
}

bool StructuresOnWay::isGone(int tree) const
{
  return std::binary_search(goneTrees_.begin(), goneTrees_.end(), tree);
}

void StructuresOnWay::Broken::addTo(std::vector<BarrierLoad>& loads) const
{
  for (const auto& [barrier, load] : held)
  {
    loads[std::size_t(barrier)].energy += load.energy;
    loads[std::size_t(barrier)].volume += load.volume;
  }
}

StructuresOnWay::Broken StructuresOnWay::drainBroken()
{
  return std::exchange(broke_, {});
}

StructuresOnWay::Broken StructuresOnWay::drainBarriers()
{
  return { {}, std::exchange(broke_.barriers, {}), std::exchange(broke_.held, {}), {} };
}

bool StructuresOnWay::apply(const Broken& broken, const SurfacePatch& patch)
{
  for (const int barrier : broken.barriers)
  {
    if (std::find(brokenBarriers_.begin(), brokenBarriers_.end(), barrier) == brokenBarriers_.end())
    {
      brokenBarriers_.push_back(barrier);
    }
  }
  bool near = false;
  for (const int tree : broken.trees)
  {
    const auto at = std::lower_bound(goneTrees_.begin(), goneTrees_.end(), tree);
    if (at != goneTrees_.end() && *at == tree)
    {
      continue;
    }
    goneTrees_.insert(at, tree);
    near = near || obstacles_->treeBox(tree).meets(patch.xMin, patch.xMax, patch.yMin, patch.yMax);
  }
  return near;
}

void StructuresOnWay::findBarriers(const Way& way, double gravity, double radius)
{
  hit_ = {};
  passages_.clear();
  passed_ = 0;
  const Vec3 &p = way.from.position, &q = way.to.position;
  // In a step of contact the cubic may go a little beyond its ends.
  const double room =
    way.flight ? 0.0 : 0.15 * way.duration * (way.from.velocity.norm() + way.to.velocity.norm());
  const double around = room + radius;
  obstacles_->visitBarriers(std::min(p.x(), q.x()) - around, std::max(p.x(), q.x()) + around,
    std::min(p.y(), q.y()) - around, std::max(p.y(), q.y()) + around,
    [&](const Obstacles::Piece& piece)
    {
      const Eigen::Vector2d along = piece.to - piece.from;
      const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
      const auto side = [&](const Vec3& x) { return normal.dot(x.head<2>() - piece.from); };
      const double before = side(p), after = side(q);
      const bool released = way.from.time == 0.0 && std::abs(before) < kSamePlace; // on the line
      if (released || (before < 0.0) == (after < 0.0))
      {
        return;
      }
      // Passed is only what the next way, which may begin there, finds behind it.
      const auto placeAt = [&](double s)
      {
        return way.flight ? placeInFlight(way.from, gravity, s * way.duration)
                          : between(way.from, way.to, s).position;
      };
      const auto behind = [&](double s) { return (side(placeAt(s)) < 0.0) == (after < 0.0); };
      double s = 1.0;
      if (way.flight)
      {
        s = before / (before - after);
        for (double more = 1e-16; s < 1.0 && !behind(s); more *= 2.0)
        {
          s = std::min(s + more, 1.0);
        }
      }
      else
      {
        double low = 0.0;
        for (int k = 0; k < 60; ++k)
        {
          const double middle = 0.5 * (low + s);
          (behind(middle) ? s : low) = middle;
        }
      }
      const Vec3 at = placeAt(s);
      const double reached = along.dot(at.head<2>() - piece.from) / along.squaredNorm();
      const double beside = std::max(kPieceEnd, radius / along.norm());
      const double pastBegin = -reached, pastEnd = reached - 1.0;
      if (pastBegin <= (piece.begins ? beside : kPieceEnd) &&
        pastEnd <= (piece.ends ? beside : kPieceEnd))
      {
        passages_.push_back({ s, piece.barrier, int(&piece - obstacles_->barrierPieces().data()),
          std::max(pastBegin, pastEnd) > kPieceEnd });
      }
    });
  if (passages_.empty())
  {
    return;
  }
  // Barriers at one place are passed at once: first all that record, then, in their order, those
  // that stop the rock or break.
  const auto earlier = [this](const BarrierPassage& a, const BarrierPassage& b)
  {
    const auto stops = [this](const BarrierPassage& x)
    { return !obstacles_->structures().barriers[std::size_t(x.barrier)].records; };
    return std::tuple(a.fraction, stops(a), a.barrier, a.piece) <
      std::tuple(b.fraction, stops(b), b.barrier, b.piece);
  };
  std::sort(passages_.begin(), passages_.end(), earlier);
  const double length = (q - p).head<2>().norm();
  for (auto first = passages_.begin(); first != passages_.end();)
  {
    const auto next = std::find_if(first, passages_.end(),
      [&](const BarrierPassage& x)
      { return (x.fraction - first->fraction) * length > kSamePlace; });
    const double last = std::prev(next)->fraction;
    std::for_each(first, next, [&](BarrierPassage& x) { x.fraction = last; });
    first = next;
  }
  std::sort(passages_.begin(), passages_.end(), earlier);
  // Two pieces of a barrier meet at one place.
  passages_.erase(std::unique(passages_.begin(), passages_.end()), passages_.end());
}

double StructuresOnWay::footOf(int piece, const Eigen::Vector2d& at) const
{
  // On the edge of a wall it stands up there, from whichever side the rock comes.
  const Obstacles::Piece& on = obstacles_->barrierPieces()[std::size_t(piece)];
  const Eigen::Vector2d along = (on.to - on.from).normalized();
  const Eigen::Vector2d across = kSamePlace * Eigen::Vector2d(-along.y(), along.x());
  const Eigen::Vector2d one = at + across, other = at - across;
  return std::max({ surface_->elevation(at.x(), at.y()),
    obstacles_->embankmentTop(one.x(), one.y()), obstacles_->embankmentTop(other.x(), other.y()) });
}

void StructuresOnWay::passBarriers(const Way& way, double taken, double gravity,
  const RockBody& body, std::vector<StructureEvent>& events)
{
  const bool again = hit_.barrier >= 0;
  const double place = hit_.fraction;
  hit_ = {};
  while (passed_ < passages_.size())
  {
    const auto [fraction, number, piece, beyond] = passages_[passed_];
    if (way.flight && again && fraction > place)
    {
      return;
    }
    ++passed_;
    BlockState at = way.flight ? fly(body.block, way.from, gravity, fraction * way.duration)
                               : between(way.from, way.to, fraction);
    const Barrier& barrier = obstacles_->structures().barriers[std::size_t(number)];
    const double height = at.position.z() - this->footOf(piece, at.position.head<2>());
    const BarrierState state = stateOf(barrier, this->loadOf(number));
    const bool gone =
      std::find(brokenBarriers_.begin(), brokenBarriers_.end(), number) != brokenBarriers_.end();
    const BarrierMeets meets = gone
      ? BarrierMeets::Nothing
      : meetsOutline(*obstacles_, piece, state, brokenBarriers_, body.block, at, height);
    if (meets == BarrierMeets::Nothing && beyond)
    {
      continue;
    }
    // Energy that the ground holds in a touch it gives back in a moment.
    const double stored =
      way.flight ? 0.0 : (1.0 - fraction) * body.springEnergyBefore + fraction * body.springEnergy;
    if (!barrier.records && meets == BarrierMeets::Holds)
    {
      hit_ = { number, fraction, height, stored };
      return;
    }
    const double came = rigidKineticEnergy(body.block, at);
    slowDown(at, came, std::min(taken, came));
    const double energy = rigidKineticEnergy(body.block, at) + stored;
    const StructureOutcome outcome = gone ? StructureOutcome::BarrierGone
      : meets == BarrierMeets::Nothing    ? StructureOutcome::BarrierPassed
      : barrier.records                   ? StructureOutcome::BarrierRecorded
                                          : StructureOutcome::BarrierStruck;
    StructureEvent event = eventAt(outcome, barrier.feature, body.block, at, energy, height);
    if (!barrier.records && !gone)
    {
      noteLoad(event, this->loadOf(number), state);
      if (meets == BarrierMeets::Strikes && energy > state.capacity)
      {
        this->breakBarrier(number); // for others: nothing is taken of the rock
      }
    }
    events.push_back(event);
  }
}

BarrierLoad StructuresOnWay::loadOf(int barrier) const
{
  return barrierLoads_ ? (*barrierLoads_)[std::size_t(barrier)] : BarrierLoad();
}

const Barrier& StructuresOnWay::barrierHit() const
{
  return obstacles_->structures().barriers[std::size_t(hit_.barrier)];
}

void StructuresOnWay::load(const BarrierLoad& held)
{
  broke_.held.push_back({ hit_.barrier, held });
}

void StructuresOnWay::breakBarrier(int barrier)
{
  brokenBarriers_.push_back(barrier);
  broke_.barriers.push_back(barrier);
}

} // namespace rockfall
