#include "rock/results.h"

#include "base/Mixer.h"
#include "base/grow.h"

namespace rockfall
{

std::string fateName(Fate fate)
{
  switch (fate)
  {
    case Fate::Rested:
      return "rested";
    case Fate::LeftDomain:
      return "left the domain";
    case Fate::Caught:
      return "caught";
    case Fate::LostInNodata:
      return "lost in nodata";
    case Fate::Moving:
      break;
  }
  return "moving";
}

void noteImpact(Trajectory& trajectory, const ImpactEvent& event, bool keep)
{
  Mixer mixer;
  mixer.add(event.time);
  mixer.add(event.position);
  mixer.add(event.normal);
  mixer.add(event.cfe);
  mixer.add(event.impulse);
  mixer.add(event.approachSpeed);
  mixer.add(event.velocityBefore);
  mixer.add(event.velocityAfter);
  mixer.add(event.energyLoss);
  mixer.add(event.restitution);
  mixer.add(event.otherRock);
  ++trajectory.summary.impacts;
  trajectory.summary.impactBits += mixer.value();
  if (keep)
  {
    append(trajectory.impacts, event);
  }
}

} // namespace rockfall
