#include "rock/parts/OverlapRecovery.h"

#include <utility>

namespace rockfall
{

double OverlapRecovery::looseOf(const RockBody& body)
{
  // In an island a rock may be pushed under the slope within a step; it may be alone soon after.
  return (body.inIsland ? kLooseOverlap : kFirm) * body.block.radius();
}

void OverlapRecovery::beforeStep(RockBody& body, double h)
{
  recovering_ = false;
  const double speed = deepSpeed(gravity_, body.block.radius());
  const double most =
    kRecoverDrop * body.block.mass() * std::max(gravity_, kLeastGravity) * body.block.radius();
  const double loose = looseOf(body);
  for (Contact& c : body.contacts)
  {
    // Between two walls the rock cannot go, and friction makes a throw of what the spring is given.
    const double firm = c.stiffness > 0.0 ? std::sqrt(2.0 * most / c.stiffness) : speed * h;
    recovering_ = recoverDeepOverlap(c, std::min(speed * h, firm), loose) || recovering_;
  }
}

bool OverlapRecovery::drainRecovered()
{
  return std::exchange(recovering_, false);
}

void OverlapRecovery::afterStep(RockBody& body, double h) const
{
  // No more per step than half the weight's compression, or a stiff spring would throw the rock
  // off.
  const double way = std::min(kRecover * h, 0.5 * body.block.mass() * gravity_ / normalPenalty_);
  const double loose = looseOf(body);
  for (Contact& c : body.contacts)
  {
    // What springs get by it comes from nowhere, and stays numerical.
    const double lost = std::max(0.0, recoverLooseOverlap(c, way, loose));
    body.energy.damping += lost;
    body.springEnergy -= lost;
  }
}

double OverlapRecovery::limit(RockBody& body, double loose, double settledSpeed)
{
  const bool deep = anyDeep(body.contacts, loose);
  double held = 0.0;
  for (Contact& c : body.contacts)
  {
    const double still = settledSpeed * std::sqrt(body.block.mass());
    const double normal = limitOverlap(c, still / std::sqrt(c.stiffness), loose);
    body.normalEnergy = std::max(0.0, body.normalEnergy - normal);
    held += normal + (deep ? limitSlip(c, still / std::sqrt(c.shearStiffness)) : 0.0);
  }
  const double before = body.springEnergy;
  body.springEnergy = std::max(0.0, before - held);
  return before - body.springEnergy;
}

} // namespace rockfall
