#include "rock/results.h"

#include "base/Mixer.h"
#include "base/grow.h"

#include <algorithm>
#include <cmath>
#include <iterator>

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
    case Fate::Broken:
      return "broken";
    case Fate::Moving:
      break;
  }
  return "moving";
}

namespace
{

/// What a rock had to give, J: what it released, what other rocks gave it, and a fall by its own size,
/// as what lies still has released nothing to speak of.
double energyHad(const TrajectorySummary& summary, double gravity)
{
  const EnergyAudit& e = summary.energy;
  return std::max(0.0, e.released) + std::max(0.0, -e.exchanged) +
    gravity * summary.mass * std::cbrt(summary.volume);
}

} // namespace

double gainFromNowhere(const TrajectorySummary& summary, double gravity)
{
  return summary.gained / energyHad(summary, gravity);
}

double lossToNowhere(const TrajectorySummary& summary, double gravity)
{
  return std::max(0.0, summary.energy.numerical) / energyHad(summary, gravity);
}

namespace
{

std::uint64_t impactHash(const ImpactEvent& event)
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
  return mixer.value();
}

} // namespace

void noteImpact(Trajectory& trajectory, const ImpactEvent& event, bool keep)
{
  ++trajectory.summary.impacts;
  trajectory.summary.impactBits += impactHash(event);
  if (keep)
  {
    append(trajectory.impacts, event);
  }
}

void forgetImpact(Trajectory& trajectory, const ImpactEvent& event, bool kept)
{
  --trajectory.summary.impacts;
  trajectory.summary.impactBits -= impactHash(event);
  const auto it = std::find_if(trajectory.impacts.rbegin(), trajectory.impacts.rend(),
    [&](const ImpactEvent& e) { return e.time == event.time && e.otherRock == event.otherRock; });
  if (kept && it != trajectory.impacts.rend())
  {
    trajectory.impacts.erase(std::next(it).base());
  }
}

} // namespace rockfall
