#include "world/WorldState.h"

#include "contact/ground/motion.h"

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

void FallingRock::advanceAlone(double until)
{
  sim.advance(until);
  asleep = sim.done() && sim.trajectory().summary.fate == Fate::Rested;
}

} // namespace rockfall
