#include "world/WorldState.h"

#include "contact/ground/motion.h"
#include "law/settings.h"
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

double WorldState::timeToBarrier(int rock, double duration) const
{
  const SingleRock& of = rocks[std::size_t(rock)].sim;
  double soonest = std::numeric_limits<double>::infinity();
  if (of.done() || !(of.state().velocity.norm() > 0.0))
  {
    return soonest;
  }
  const Obstacles& obstacles = *surface.terrain().obstacles();
  const Eigen::Vector2d at = of.state().position.head<2>();
  const double speed = kFasterApproach * of.state().velocity.norm() + parameters.gravity * duration;
  const double around = speed * duration + of.body().block.radius(); // that far past an end, too
  obstacles.visitBarriers(at.x() - around, at.x() + around, at.y() - around, at.y() + around,
    [&](const Obstacles::Piece& piece)
    {
      if (obstacles.structures().barriers[std::size_t(piece.barrier)].records)
      {
        return;
      }
      const Eigen::Vector2d along = piece.to - piece.from;
      const double part = std::clamp(along.dot(at - piece.from) / along.squaredNorm(), 0.0, 1.0);
      const double way = (piece.from + part * along - at).norm();
      soonest = way <= around ? std::min(soonest, way / speed) : soonest;
    });
  return soonest;
}

void WorldState::shareBarriers(FallingRock& rock)
{
  const StructuresOnWay::Broken now = rock.fall().structures.drainBarriers();
  for (const auto& [barrier, held] : now.held)
  {
    BarrierLoad& load = barrierLoads[std::size_t(barrier)];
    load.energy += held.energy;
    load.volume += held.volume;
  }
  for (FallingRock& other : rocks)
  {
    if (!now.barriers.empty())
    {
      applyBroken(other.fall(), now);
    }
  }
}

void FallingRock::advanceAlone(double until)
{
  sim.advance(until);
  asleep = sim.done() && sim.trajectory().summary.fate == Fate::Rested;
}

} // namespace rockfall
