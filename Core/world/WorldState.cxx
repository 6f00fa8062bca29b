#include "world/WorldState.h"

#include "contact/ground/motion.h"
#include "rock/fall/atStructures.h"
#include "terrain/Obstacles.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace rockfall
{

void FallingRock::updatePose()
{
  RockBody& of = this->body();
  const BlockState& s = of.state;
  const Mat3 rotation = s.orientation.toRotationMatrix();
  const bool placed = of.placed.position() == s.position && of.placed.rotation() == rotation;
  if (!placed)
  {
    of.placed.placeFrame(of.block, s);
  }
  if (!placed || hull.position != s.position || hull.rotation != rotation)
  {
    hull.update(of.placed);
  }
}

bool FallingRock::adoptEnd()
{
  RockBody& of = this->body();
  const BlockState& s = of.state;
  const bool there =
    endHull.position == s.position && endHull.rotation == s.orientation.toRotationMatrix();
  if (there)
  {
    std::swap(of.placed, end);
    std::swap(hull, endHull);
  }
  return there;
}

namespace
{

/// Of a rock that may be this fast (m/s).
double timeToBarrier(const WorldState& world, const RockBody& body, double speed, double duration)
{
  const Obstacles& obstacles = *world.surface.terrain().obstacles();
  const Eigen::Vector2d at = body.state.position.head<2>();
  const Eigen::Vector2d velocity = body.state.velocity.head<2>();
  const double way = (speed + world.parameters.gravity * duration) * duration;
  const double around = way + body.block.radius(); // that far past an end, too
  double soonest = std::numeric_limits<double>::infinity();
  obstacles.visitBarriers(at.x() - around, at.x() + around, at.y() - around, at.y() + around,
    [&](const Obstacles::Piece& piece)
    {
      const Eigen::Vector2d along = piece.to - piece.from;
      const double part = std::clamp(along.dot(at - piece.from) / along.squaredNorm(), 0.0, 1.0);
      if (obstacles.structures().barriers[std::size_t(piece.barrier)].records ||
        (piece.from + part * along - at).norm() > around)
      {
        return;
      }
      const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
      const double arrival = -normal.dot(at - piece.from) / normal.dot(velocity);
      soonest = std::min(soonest, arrival >= 0.0 ? std::min(arrival, duration) : duration);
    });
  return soonest;
}

} // namespace

double WorldState::fastest(std::span<const int> members) const
{
  double most = 0.0;
  for (const int i : members)
  {
    const RockBody& body = rocks[std::size_t(i)].body();
    const double rim = body.state.spin.norm() * body.block.radius();
    most = std::max(most, body.done ? 0.0 : body.state.velocity.norm() + rim);
  }
  return most;
}

double WorldState::drivenInto(int tree) const
{
  const auto at = driven.find(tree);
  return at == driven.end() ? 0.0 : at->second;
}

std::vector<double> WorldState::timesToBarriers(std::span<const int> members, double duration) const
{
  const double most = this->fastest(members);
  std::vector<double> times;
  for (const int i : members)
  {
    // A light rock that the fastest strikes leaves at twice its speed.
    times.push_back(timeToBarrier(*this, rocks[std::size_t(i)].body(), 2.0 * most, duration));
  }
  return times;
}

void WorldState::shareBarriers(FallingRock& rock)
{
  const StructuresOnWay::Broken now = rock.fall().structures.drainBarriers();
  now.addTo(barrierLoads);
  if (now.barriers.empty())
  {
    return;
  }
  for (FallingRock& other : rocks)
  {
    applyBroken(other.fall(), now);
  }
}

void FallingRock::advanceAlone(double until)
{
  sim.advance(until);
  asleep = sim.done() && sim.trajectory().summary.fate == Fate::Rested;
}

} // namespace rockfall
