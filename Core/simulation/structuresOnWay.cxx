// What a rock meets besides the slope: obstacles in flight, trees that break, barriers.

#include "block/flight.h"
#include "simulation/RockSimulator.h"

#include <algorithm>
#include <cmath>

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

/// Barriers are at one place if they are met within this share of a flight.
constexpr double kSamePlace = 1e-9;

/// Takes kinetic energy: all velocities become smaller by the same factor.
void slowDown(BlockState& state, double energy, double taken)
{
  const double factor = energy > 0.0 ? std::sqrt(std::max(0.0, 1.0 - taken / energy)) : 0.0;
  state.velocity *= factor;
  state.spin *= factor;
}

} // namespace

double RockSimulator::freeOfObstacles(double duration)
{
  const double sure = std::min(duration, freeUntil_ - state_.time);
  const double free = timeToObstacle(placed_, state_, block_, *obstacles_, goneTrees_,
    parameters_.gravity, this->impactStep(), duration);
  return std::max(sure, free);
}

void RockSimulator::forgetPatch()
{
  patch_.xMax = patch_.xMin - 1.0;
  candidates_.distance = -1.0;
}

void RockSimulator::clearTrees()
{
  const double r = block_.radius();
  const Vec3& p = state_.position;
  placed_.place(block_, state_);
  SurfacePatch stem;
  obstacles_->visitTrees(p.x() - r, p.x() + r, p.y() - r, p.y() + r,
    [&](int k)
    {
      stem.nodes.clear();
      stem.triangles.clear();
      stem.ridges.clear();
      obstacles_->append({}, std::span<const int>(&k, 1), stem);
      const double distance = clearance(placed_, state_, stem, 0.0, 0.0).distance;
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

int RockSimulator::treeOf(const Contact& contact) const
{
  return contact.cfe >= obstacles_->firstCfe() ? obstacles_->treeOf(contact.cfe) : -1;
}

bool RockSimulator::undoAtTrees(double h)
{
  const double energy = rigidKineticEnergy(block_, before_);
  std::vector<int> hit;
  for (std::size_t i = 0; i < contactsBefore_.size(); ++i)
  {
    const Contact& c = contacts_[i];
    const int tree = this->treeOf(c);
    if (tree >= 0 && c.closed() && !contactsBefore_[i].closed() &&
      energy > obstacles_->structures().trees[std::size_t(tree)].capacity)
    {
      hit.push_back(tree);
    }
  }
  if (hit.empty())
  {
    return false;
  }
  state_ = before_;
  contacts_ = contactsBefore_;
  return this->breakTrees(h, hit);
}

bool RockSimulator::breakTrees(double h, std::span<const int> hit)
{
  bool any = false;
  const Vec3 spin = state_.angularVelocity();
  for (const Contact& c : contacts_)
  {
    const int tree = this->treeOf(c);
    if (tree < 0 || std::binary_search(goneTrees_.begin(), goneTrees_.end(), tree))
    {
      continue;
    }
    const Tree& stem = obstacles_->structures().trees[std::size_t(tree)];
    const double energy = rigidKineticEnergy(block_, state_);
    const double approach = -c.normal.dot(state_.velocity + spin.cross(c.point - state_.position));
    const bool meets =
      c.closed() ? approach > restingSpeed_ : approach > 0.0 && c.gap() < approach * h;
    if (energy <= stem.capacity || !(meets || std::find(hit.begin(), hit.end(), tree) != hit.end()))
    {
      continue;
    }
    StructureEvent event;
    event.outcome = StructureOutcome::TreeBroken;
    event.feature = stem.feature;
    event.time = state_.time;
    event.position = state_.position;
    event.velocity = state_.velocity;
    event.kineticEnergy = energy;
    event.heightOverGround =
      state_.position.z() - surface_.elevation(state_.position.x(), state_.position.y());
    event.energyTaken = stem.capacity;
    recorder_.trajectory().structures.push_back(event);
    slowDown(state_, energy, stem.capacity);
    energy_.structures += energy - rigidKineticEnergy(block_, state_);
    goneTrees_.insert(std::lower_bound(goneTrees_.begin(), goneTrees_.end(), tree), tree);
    any = true;
  }
  if (any)
  {
    std::erase_if(contacts_,
      [&](const Contact& c)
      {
        const int tree = this->treeOf(c);
        return tree >= 0 && std::binary_search(goneTrees_.begin(), goneTrees_.end(), tree);
      });
    acceleration_.setZero();
    spinAcceleration_.setZero();
    this->forgetPatch();
  }
  return any;
}

void RockSimulator::findBarriers(
  const BlockState& from, const BlockState& to, bool flight, BarrierHit met)
{
  hit_ = {};
  // The rest of a flight is flown anew; what stands at the same place would then be behind.
  const bool again = flight && met.barrier >= 0;
  const double duration = to.time - from.time;
  const Vec3 &p = from.position, &q = to.position;
  // In a step of contact the cubic may go a little beyond its ends.
  const double room = flight ? 0.0 : 0.15 * duration * (from.velocity.norm() + to.velocity.norm());
  struct Way
  {
    double fraction;
    int barrier;
  };
  std::vector<Way> ways;
  obstacles_->visitBarriers(std::min(p.x(), q.x()) - room, std::max(p.x(), q.x()) + room,
    std::min(p.y(), q.y()) - room, std::max(p.y(), q.y()) + room,
    [&](const Obstacles::Piece& piece)
    {
      const Eigen::Vector2d along = piece.to - piece.from;
      const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
      const auto side = [&](const Vec3& x) { return normal.dot(x.head<2>() - piece.from); };
      const double before = side(p), after = side(q);
      if ((before < 0.0) == (after < 0.0) ||
        std::find(brokenBarriers_.begin(), brokenBarriers_.end(), piece.barrier) !=
          brokenBarriers_.end())
      {
        return;
      }
      double s = before / (before - after);
      Vec3 at = p + s * (q - p);
      if (!flight)
      {
        double low = 0.0, high = 1.0;
        for (int k = 0; k < 60; ++k)
        {
          s = 0.5 * (low + high);
          at = between(from, to, s).position;
          ((side(at) < 0.0) == (before < 0.0) ? low : high) = s;
        }
      }
      const double reached = along.dot(at.head<2>() - piece.from) / along.squaredNorm();
      if (reached >= -1e-9 && reached <= 1.0 + 1e-9)
      {
        ways.push_back({ s, piece.barrier });
      }
    });
  std::sort(ways.begin(), ways.end(),
    [](const Way& a, const Way& b)
    { return a.fraction != b.fraction ? a.fraction < b.fraction : a.barrier < b.barrier; });
  for (std::size_t k = 0; k < ways.size(); ++k)
  {
    const auto [fraction, number] = ways[k];
    if (k > 0 && ways[k - 1].barrier == number && fraction - ways[k - 1].fraction < 1e-9)
    {
      continue; // where two pieces meet
    }
    if (fraction < met.fraction || (fraction == met.fraction && number <= met.barrier))
    {
      continue; // before it
    }
    if (again && fraction > met.fraction + kSamePlace)
    {
      return;
    }
    const BlockState at = flight ? fly(block_, from, parameters_.gravity, fraction * duration)
                                 : between(from, to, fraction);
    const Barrier& barrier = obstacles_->structures().barriers[std::size_t(number)];
    const double height = at.position.z() - surface_.elevation(at.position.x(), at.position.y());
    if (!(height < barrier.height))
    {
      continue; // over it, or where there is no ground to stand on
    }
    if (again && barrier.records)
    {
      continue;
    }
    // What the ground holds in a touch it gives back in a moment.
    const double stored =
      flight ? 0.0 : (1.0 - fraction) * springEnergyBefore_ + fraction * springEnergy_;
    if (!barrier.records)
    {
      hit_ = { number, fraction, height, stored };
      return;
    }
    StructureEvent event;
    event.outcome = StructureOutcome::BarrierRecorded;
    event.feature = barrier.feature;
    event.time = at.time;
    event.position = at.position;
    event.velocity = at.velocity;
    event.kineticEnergy = rigidKineticEnergy(block_, at) + stored;
    event.heightOverGround = height;
    recorder_.trajectory().structures.push_back(event);
  }
}

void RockSimulator::meetBarrier()
{
  const Barrier& barrier = obstacles_->structures().barriers[std::size_t(hit_.barrier)];
  const double kinetic = rigidKineticEnergy(block_, state_), energy = kinetic + hit_.stored;
  const bool holds = energy <= barrier.capacity;
  const double taken = holds ? energy : barrier.absorbs ? barrier.capacity : 0.0;
  StructureEvent event;
  event.outcome = holds ? StructureOutcome::BarrierStopped : StructureOutcome::BarrierBroken;
  event.feature = barrier.feature;
  event.time = state_.time;
  event.position = state_.position;
  event.velocity = state_.velocity;
  event.kineticEnergy = energy;
  event.heightOverGround = hit_.heightOverGround;
  event.energyTaken = taken;
  TrajectorySummary& summary = recorder_.trajectory().summary;
  recorder_.trajectory().structures.push_back(event);
  recorder_.knot(state_, false);
  this->auditSamples(state_);
  slowDown(state_, kinetic, std::min(taken, kinetic));
  energy_.structures += kinetic - rigidKineticEnergy(block_, state_);
  if (holds)
  {
    summary.fate = Fate::Caught;
    contacts_.clear();
    impact_.pending = false;
    done_ = true;
    return;
  }
  brokenBarriers_.push_back(hit_.barrier);
  freeUntil_ = 0.0;
  state_.time += kInstant;
  recorder_.knot(state_, false);
  this->auditSamples(state_);
}

double RockSimulator::endStepAtBarrier(const BlockState& end, double taken, bool touching)
{
  const Barrier& barrier = obstacles_->structures().barriers[std::size_t(hit_.barrier)];
  BlockState at = between(before_, end, hit_.fraction);
  const double came = rigidKineticEnergy(block_, at);
  slowDown(at, came, std::min(taken, came));
  const double energy = rigidKineticEnergy(block_, at) + hit_.stored;
  if (energy <= barrier.capacity)
  {
    // The rest of the step did not happen; what it booked did. The barrier takes what makes it up.
    recorder_.recordBetween(before_, at, touching);
    energy_.structures += kineticEnergy(block_, state_) - kineticEnergy(block_, at) +
      block_.mass() * parameters_.gravity * (end.position.z() - at.position.z()) + springEnergy_;
    state_ = at;
    springEnergy_ = normalEnergy_ = 0.0;
    recorder_.follow(state_);
    this->meetBarrier();
    return 0.0;
  }
  StructureEvent event;
  event.outcome = StructureOutcome::BarrierBroken;
  event.feature = barrier.feature;
  event.time = at.time;
  event.position = at.position;
  event.velocity = at.velocity;
  event.kineticEnergy = energy;
  event.heightOverGround = hit_.heightOverGround;
  const double left = rigidKineticEnergy(block_, state_);
  slowDown(state_, left, barrier.absorbs ? std::min(barrier.capacity, left) : 0.0);
  event.energyTaken = left - rigidKineticEnergy(block_, state_);
  energy_.structures += event.energyTaken;
  recorder_.trajectory().structures.push_back(event);
  brokenBarriers_.push_back(hit_.barrier);
  return event.energyTaken;
}

} // namespace rockfall
