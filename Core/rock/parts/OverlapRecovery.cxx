#include "rock/parts/OverlapRecovery.h"

#include "law/settings.h"

#include <algorithm>

namespace rockfall
{

bool isDeep(const RockBody& body, double loose)
{
  return std::any_of(body.contacts.begin(), body.contacts.end(),
    [&](const Contact& c) { return c.offset < -loose; });
}

void recoverLooseOverlaps(RockBody& body, double h, double gravity, double normalPenalty)
{
  // No more per step than half the weight's compression, or a stiff spring would throw the rock
  // off.
  const double way = std::min(kRecover * h, 0.5 * body.block.mass() * gravity / normalPenalty);
  const double loose = kFirm * body.block.radius();
  for (Contact& c : body.contacts)
  {
    if (c.offset < -loose || c.offset == 0.0)
    {
      continue;
    }
    const double held = c.springEnergy();
    c.offset = c.offset < 0.0 ? std::min(0.0, c.offset + way) : std::max(0.0, c.offset - way);
    // Energy that the springs gain by it comes from nowhere, and stays numerical.
    const double lost = std::max(0.0, held - c.springEnergy());
    body.energy.damping += lost;
    body.springEnergy -= lost;
  }
}

} // namespace rockfall
