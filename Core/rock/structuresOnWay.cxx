// Structures that a rock meets: obstacles in flight, trees that break, barriers.

#include "block/flight.h"
#include "contact/ground/clearance.h"
#include "contact/ground/roundContact.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/SingleRock.h"
#include "terrain/stemHit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>

namespace rockfall
{

namespace
{

/// Within a step of contact: cubic in place, linear in velocity.
BlockState between(const BlockState& from, const BlockState& to, double s)
{
  const double h = to.time - from.time, s2 = s * s, s3 = s2 * s;
  BlockState at = to;
  at.time = from.time + s * h;
  at.position = (2 * s3 - 3 * s2 + 1) * from.position + (s3 - 2 * s2 + s) * h * from.velocity +
    (3 * s2 - 2 * s3) * to.position + (s3 - s2) * h * to.velocity;
  at.velocity = (1.0 - s) * from.velocity + s * to.velocity;
  at.spin = (1.0 - s) * from.spin + s * to.spin;
  at.orientation = from.orientation.slerp(s, to.orientation);
  return at;
}

/// Takes kinetic energy: all velocities become smaller by the same factor.
void slowDown(BlockState& state, double energy, double taken)
{
  const double factor = energy > 0.0 ? std::sqrt(std::max(0.0, 1.0 - taken / energy)) : 0.0;
  state.velocity *= factor;
  state.spin *= factor;
}

/// A hit on a stem, in plan.
struct StemHit
{
  double offset = 0.0;       ///< See terrain/stemHit.h.
  Vec3 away = Vec3::Zero();  ///< Of the stem's push on the rock; zero if the rock moves upright.
  Vec3 along = Vec3::Zero(); ///< Of the rock that slips past the stem.
};

StemHit hitOn(const Tree& stem, const Block& block, const BlockState& state)
{
  const double speed = state.velocity.head<2>().norm();
  if (!(speed > 0.0))
  {
    return {};
  }
  const Vec3 along(state.velocity.x() / speed, state.velocity.y() / speed, 0.0);
  Vec3 side(-along.y(), along.x(), 0.0); // on which the rock passes
  double distance = side.head<2>().dot(state.position.head<2>() - stem.position);
  if (distance < 0.0)
  {
    side = -side;
    distance = -distance;
  }
  PlacedBlock placed;
  placed.place(block, state);
  double reach = isRound(placed) ? roundReach(roundAxes(placed), side) : 0.0;
  for (const Vec3& vertex : placed.vertices())
  {
    reach = std::max(reach, side.dot(state.position - vertex));
  }
  const double offset = std::min(1.0, distance / (reach + 0.5 * stem.diameter));
  const double towards = std::sqrt(1.0 - offset * offset);
  return { offset, offset * side - towards * along, towards * side + offset * along };
}

/// Takes kinetic energy (J) by a push: it turns the velocity and leaves the spin. What a push that
/// way cannot take slows all down.
void pushAway(BlockState& state, const Block& block, const Vec3& away, double taken)
{
  if (!(taken > 0.0))
  {
    return;
  }
  const double energy = rigidKineticEnergy(block, state);
  const double towards = std::max(0.0, -away.dot(state.velocity));
  const double left = std::sqrt(std::max(0.0, towards * towards - 2.0 * taken / block.mass()));
  state.velocity += (towards - left) * away;
  const double rest = rigidKineticEnergy(block, state);
  const double more = taken - (energy - rest);
  if (more > 1e-12 * energy)
  {
    slowDown(state, rest, more);
  }
}

/// Takes kinetic energy (J) and turns the velocity in plan to this direction; spin is left. What
/// the velocity in plan does not have slows all down.
void slipPast(BlockState& state, const Block& block, const Vec3& along, double taken)
{
  const double energy = rigidKineticEnergy(block, state);
  const double inPlan = state.velocity.head<2>().squaredNorm();
  state.velocity.head<2>() =
    std::sqrt(std::max(0.0, inPlan - 2.0 * taken / block.mass())) * along.head<2>();
  const double rest = rigidKineticEnergy(block, state);
  const double more = taken - (energy - rest);
  if (more > 1e-12 * energy)
  {
    slowDown(state, rest, more);
  }
}

/// Outcome for a structure where the rock is `at`, with this energy (J) and its centre this high
/// over the slope (m); nothing is taken of it.
StructureEvent eventAt(StructureOutcome outcome, std::int64_t feature, const BlockState& at,
  double energy, double height)
{
  StructureEvent event;
  event.outcome = outcome;
  event.feature = feature;
  event.time = at.time;
  event.position = at.position;
  event.velocity = at.velocity;
  event.kineticEnergy = energy;
  event.heightOverGround = height;
  return event;
}

void noteLoad(StructureEvent& event, const BarrierLoad& before, const BarrierState& barrier)
{
  event.heldBefore = before.energy;
  event.usefulHeight = std::max(0.0, barrier.rope - barrier.fill);
}

} // namespace

double SingleRock::freeOfObstacles(double duration)
{
  const double sure = std::min(duration, freeUntil_ - body_.state.time);
  const double free = timeToObstacle(body_.placed, body_.state, body_.block, *obstacles_,
    goneTrees_, parameters_.gravity, this->impactStep(), duration);
  return std::max(sure, free);
}

void SingleRock::forgetPatch()
{
  patch_.xMax = patch_.xMin - 1.0;
  candidates_.distance = -1.0;
}

void SingleRock::clearTrees()
{
  const double r = body_.block.radius();
  const Vec3& p = body_.state.position;
  body_.placed.place(body_.block, body_.state);
  SurfacePatch stem;
  obstacles_->visitTrees(p.x() - r, p.x() + r, p.y() - r, p.y() + r,
    [&](int k)
    {
      stem.nodes.clear();
      stem.triangles.clear();
      stem.ridges.clear();
      obstacles_->append({}, std::span<const int>(&k, 1), stem);
      const double distance = clearance(body_.placed, body_.state, stem, 0.0, 0.0).distance;
      const Eigen::Vector2d off =
        p.head<2>() - obstacles_->structures().trees[std::size_t(k)].position;
      const bool inside = off.norm() < obstacles_->treeRadius(k) && p.z() < obstacles_->treeTop(k);
      if (distance <= 0.0 || inside)
      {
        goneTrees_.push_back(k);
      }
    });
  std::sort(goneTrees_.begin(), goneTrees_.end());
  this->forgetPatch();
}

int SingleRock::treeOf(const Contact& contact) const
{
  return contact.cfe >= obstacles_->firstCfe() ? obstacles_->treeOf(contact.cfe) : -1;
}

bool SingleRock::stemHolds(
  int tree, const BlockState& state, std::span<const Contact> contacts) const
{
  const Tree& stem = obstacles_->structures().trees[std::size_t(tree)];
  const double energy = rigidKineticEnergy(body_.block, state);
  if (energy > stem.capacity)
  {
    return false;
  }
  const bool presses = std::any_of(contacts.begin(), contacts.end(),
    [&](const Contact& c) { return c.closed() && this->treeOf(c) == tree; });
  return presses || energy <= stemShare(hitOn(stem, body_.block, state).offset) * stem.capacity;
}

bool SingleRock::undoAtTrees(double h)
{
  std::vector<int> hit;
  for (std::size_t i = 0; i < body_.contactsBefore.size(); ++i)
  {
    const Contact& c = body_.contacts[i];
    const int tree = this->treeOf(c);
    if (tree >= 0 && c.closed() && !body_.contactsBefore[i].closed() &&
      !this->stemHolds(tree, body_.before, body_.contactsBefore))
    {
      hit.push_back(tree);
    }
  }
  if (hit.empty())
  {
    return false;
  }
  body_.state = body_.before;
  body_.contacts = body_.contactsBefore;
  return this->breakTrees(h, hit);
}

bool SingleRock::breakTrees(double h, std::span<const int> hit)
{
  bool any = false;
  const Vec3 spin = body_.state.angularVelocity();
  for (const Contact& c : body_.contacts)
  {
    const int tree = this->treeOf(c);
    if (tree < 0 || this->isGone(tree))
    {
      continue;
    }
    const double approach =
      -c.normal.dot(body_.state.velocity + spin.cross(c.point - body_.state.position));
    const bool meets =
      c.closed() ? approach > body_.restingSpeed : approach > 0.0 && c.gap() < approach * h;
    if (!(meets || std::find(hit.begin(), hit.end(), tree) != hit.end()) ||
      this->stemHolds(tree, body_.state, body_.contacts))
    {
      continue;
    }
    // Energy of the springs against the stem is not given back.
    double held = 0.0;
    for (const Contact& other : body_.contacts)
    {
      held += this->treeOf(other) == tree ? other.springEnergy() : 0.0;
    }
    this->passTree(tree, held);
    body_.springEnergy = std::max(0.0, body_.springEnergy - held);
    any = true;
  }
  if (any)
  {
    this->forgetTrees();
  }
  return any;
}

void SingleRock::passTree(int tree, double held)
{
  const Tree& stem = obstacles_->structures().trees[std::size_t(tree)];
  const double energy = rigidKineticEnergy(body_.block, body_.state);
  const double height = body_.state.position.z() -
    surface_.elevation(body_.state.position.x(), body_.state.position.y());
  const StemHit hit = hitOn(stem, body_.block, body_.state);
  const bool stands = (1.0 - hit.offset * hit.offset) * energy <= stem.capacity;
  StructureEvent event =
    eventAt(stands ? StructureOutcome::TreePassed : StructureOutcome::TreeBroken, stem.feature,
      body_.state, energy, height);
  const double taken = stemShare(hit.offset) * stem.capacity;
  event.energyTaken = std::max(held, taken);
  recorder_.trajectory().structures.push_back(event);
  if (stands)
  {
    slipPast(body_.state, body_.block, hit.along, std::max(0.0, taken - held));
  }
  else
  {
    pushAway(body_.state, body_.block, hit.away, taken - held);
    broke_.trees.push_back(tree);
  }
  body_.energy.structures += held + energy - rigidKineticEnergy(body_.block, body_.state);
  goneTrees_.insert(std::lower_bound(goneTrees_.begin(), goneTrees_.end(), tree), tree);
}

bool SingleRock::isGone(int tree) const
{
  return std::binary_search(goneTrees_.begin(), goneTrees_.end(), tree);
}

void SingleRock::forgetTrees(bool touched)
{
  std::erase_if(body_.contacts, [&](const Contact& c) { return this->isGone(this->treeOf(c)); });
  if (touched)
  {
    body_.acceleration.setZero();
    body_.spinAcceleration.setZero();
  }
  this->forgetPatch();
}

SingleRock::Broken SingleRock::drainBroken()
{
  return std::exchange(broke_, {});
}

bool SingleRock::applyBroken(const Broken& broken)
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
    const Eigen::Vector2d& place = obstacles_->structures().trees[std::size_t(tree)].position;
    const double r = obstacles_->treeRadius(tree);
    near = near ||
      (place.x() + r >= patch_.xMin && place.x() - r <= patch_.xMax &&
        place.y() + r >= patch_.yMin && place.y() - r <= patch_.yMax);
  }
  if (!near)
  {
    return false;
  }
  // Energy of the springs against a stem goes with it.
  double held = 0.0;
  bool touched = false;
  for (const Contact& c : body_.contacts)
  {
    if (this->isGone(this->treeOf(c)))
    {
      held += c.springEnergy();
      touched = touched || c.closed();
    }
  }
  body_.springEnergy = std::max(0.0, body_.springEnergy - held);
  body_.energy.structures += held;
  this->forgetTrees(touched);
  return touched;
}

void SingleRock::findBarriers(const PathPiece& way)
{
  hit_ = {};
  passages_.clear();
  passed_ = 0;
  const Vec3 &p = way.from.position, &q = way.to.position;
  // In a step of contact the cubic may go a little beyond its ends.
  const double room =
    way.flight ? 0.0 : 0.15 * way.duration * (way.from.velocity.norm() + way.to.velocity.norm());
  const double radius = body_.block.radius(), around = room + radius;
  obstacles_->visitBarriers(std::min(p.x(), q.x()) - around, std::max(p.x(), q.x()) + around,
    std::min(p.y(), q.y()) - around, std::max(p.y(), q.y()) + around,
    [&](const Obstacles::Piece& piece)
    {
      const Eigen::Vector2d along = piece.to - piece.from;
      const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
      const auto side = [&](const Vec3& x) { return normal.dot(x.head<2>() - piece.from); };
      const double before = side(p), after = side(q);
      if ((before < 0.0) == (after < 0.0))
      {
        return;
      }
      // Passed is only what the next way, which may begin there, finds behind it.
      const auto placeAt = [&](double s)
      {
        return way.flight ? placeInFlight(way.from, parameters_.gravity, s * way.duration)
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
      if (reached >= -(piece.begins ? beside : kPieceEnd) &&
        reached <= 1.0 + (piece.ends ? beside : kPieceEnd))
      {
        passages_.push_back({ s, piece.barrier, int(&piece - obstacles_->barrierPieces().data()) });
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

void SingleRock::passBarriers(const PathPiece& way, double taken)
{
  const bool again = hit_.barrier >= 0;
  const double place = hit_.fraction;
  hit_ = {};
  while (passed_ < passages_.size())
  {
    const auto [fraction, number, piece] = passages_[passed_];
    if (way.flight && again && fraction > place)
    {
      return;
    }
    ++passed_;
    if (std::find(brokenBarriers_.begin(), brokenBarriers_.end(), number) != brokenBarriers_.end())
    {
      continue;
    }
    BlockState at = way.flight
      ? fly(body_.block, way.from, parameters_.gravity, fraction * way.duration)
      : between(way.from, way.to, fraction);
    const Barrier& barrier = obstacles_->structures().barriers[std::size_t(number)];
    const double foot = std::max(surface_.elevation(at.position.x(), at.position.y()),
      obstacles_->embankmentTop(at.position.x(), at.position.y()));
    const double height = at.position.z() - foot;
    if (!holdsOutline(*obstacles_, piece, stateOf(barrier, this->loadOf(number)), brokenBarriers_,
          body_.block, at, height))
    {
      continue;
    }
    // Energy that the ground holds in a touch it gives back in a moment.
    const double stored = way.flight
      ? 0.0
      : (1.0 - fraction) * body_.springEnergyBefore + fraction * body_.springEnergy;
    if (!barrier.records)
    {
      hit_ = { number, fraction, height, stored };
      return;
    }
    const double came = rigidKineticEnergy(body_.block, at);
    slowDown(at, came, std::min(taken, came));
    recorder_.trajectory().structures.push_back(eventAt(StructureOutcome::BarrierRecorded,
      barrier.feature, at, rigidKineticEnergy(body_.block, at) + stored, height));
  }
}

BarrierLoad SingleRock::loadOf(int barrier) const
{
  return barrierLoads_ ? (*barrierLoads_)[std::size_t(barrier)] : BarrierLoad();
}

void SingleRock::meetBarrier()
{
  const Barrier& barrier = obstacles_->structures().barriers[std::size_t(hit_.barrier)];
  const double kinetic = rigidKineticEnergy(body_.block, body_.state),
               energy = kinetic + hit_.stored;
  const BarrierLoad load = this->loadOf(hit_.barrier);
  const BarrierState net = stateOf(barrier, load);
  const bool holds = energy <= net.capacity;
  const double taken = holds ? energy : barrier.absorbs ? net.capacity : 0.0;
  StructureEvent event =
    eventAt(holds ? StructureOutcome::BarrierStopped : StructureOutcome::BarrierBroken,
      barrier.feature, body_.state, energy, hit_.heightOverGround);
  event.energyTaken = taken;
  noteLoad(event, load, net);
  TrajectorySummary& summary = recorder_.trajectory().summary;
  if (holds)
  {
    this->finishImpact(false); // the barrier takes what it would have left
    event.brakingDistance = brakingDistance(barrier, load, energy);
    if (isLoaded(barrier))
    {
      broke_.held.push_back({ hit_.barrier, { energy, body_.block.volume() } });
    }
  }
  recorder_.trajectory().structures.push_back(event);
  recorder_.knot(body_.state, false);
  this->auditSamples(body_.state);
  slowDown(body_.state, kinetic, std::min(taken, kinetic));
  body_.energy.structures += kinetic - rigidKineticEnergy(body_.block, body_.state);
  if (holds)
  {
    summary.fate = Fate::Caught;
    body_.contacts.clear();
    body_.done = true;
    return;
  }
  brokenBarriers_.push_back(hit_.barrier);
  broke_.barriers.push_back(hit_.barrier);
  freeUntil_ = 0.0;
  body_.state.time += kInstant;
  recorder_.knot(body_.state, false);
  this->auditSamples(body_.state);
}

double SingleRock::endStepAtBarrier(const BlockState& end, double taken, bool touching)
{
  const Barrier& barrier = obstacles_->structures().barriers[std::size_t(hit_.barrier)];
  BlockState at = between(body_.before, end, hit_.fraction);
  const double came = rigidKineticEnergy(body_.block, at);
  slowDown(at, came, std::min(taken, came));
  const double energy = rigidKineticEnergy(body_.block, at) + hit_.stored;
  const BarrierLoad load = this->loadOf(hit_.barrier);
  const BarrierState net = stateOf(barrier, load);
  if (energy <= net.capacity)
  {
    // The rest of the step did not happen; what it booked did. The barrier takes what makes it up.
    recorder_.recordBetween(body_.before, at, touching);
    body_.energy.structures += kineticEnergy(body_.block, body_.state) -
      kineticEnergy(body_.block, at) +
      body_.block.mass() * parameters_.gravity * (end.position.z() - at.position.z()) +
      body_.springEnergy;
    body_.state = at;
    body_.springEnergy = body_.normalEnergy = 0.0;
    recorder_.follow(body_.state);
    this->meetBarrier();
    return 0.0;
  }
  StructureEvent event =
    eventAt(StructureOutcome::BarrierBroken, barrier.feature, at, energy, hit_.heightOverGround);
  const double left = rigidKineticEnergy(body_.block, body_.state);
  slowDown(body_.state, left, barrier.absorbs ? std::min(net.capacity, left) : 0.0);
  noteLoad(event, load, net);
  event.energyTaken = left - rigidKineticEnergy(body_.block, body_.state);
  body_.energy.structures += event.energyTaken;
  recorder_.trajectory().structures.push_back(event);
  brokenBarriers_.push_back(hit_.barrier);
  broke_.barriers.push_back(hit_.barrier);
  return event.energyTaken;
}

} // namespace rockfall
