#include "terrain/structures.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

bool isLoaded(const Barrier& barrier)
{
  return !std::isnan(barrier.residual) || std::isfinite(barrier.room);
}

BarrierState stateOf(const Barrier& barrier, const BarrierLoad& load)
{
  BarrierState state{ barrier.capacity, barrier.height, 0.0 };
  if (!std::isnan(barrier.residual) && load.energy > 0.0)
  {
    state.capacity = std::max(0.0, barrier.capacity - load.energy);
    const double used = std::min(1.0, load.energy / barrier.capacity);
    state.rope *= 1.0 - (1.0 - barrier.residual) * used;
  }
  if (load.volume > 0.0)
  {
    double length = 0.0;
    for (std::size_t k = 1; k < barrier.points.size(); ++k)
    {
      length += (barrier.points[k] - barrier.points[k - 1]).norm();
    }
    state.fill = barrier.height * std::min(1.0, load.volume / (barrier.room * length));
  }
  return state;
}

double brakingDistance(const Barrier& barrier, const BarrierLoad& before, double energy)
{
  if (barrier.braking == 0.0)
  {
    return 0.0;
  }
  const double held = std::isnan(barrier.residual) ? 0.0 : before.energy;
  return barrier.braking * std::sqrt(std::min(1.0, (held + energy) / barrier.capacity));
}

double stemCapacity(double diameter, double factor)
{
  return factor * 38.7 * std::pow(100.0 * diameter, 2.31);
}

} // namespace rockfall
