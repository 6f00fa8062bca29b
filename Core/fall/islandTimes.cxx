// How long a step of an island may be.

#include "fall/IslandStepper.h"

#include "contact/motion.h"
#include "contact/timeToTouch.h"

#include <algorithm>

namespace rockfall
{

double IslandStepper::freeOfSlope(RockSimulator& sim, double most) const
{
  sim.body().placed.placeVertices();
  if (sim.body().crowded)
  {
    sim.ensureCandidates(0.0, true); // what is high over the ground had no need yet
  }
  const double room = sim.candidates().room(sim.body().state, sim.body().block.radius(), 0.0);
  const double speed =
    sim.body().state.velocity.norm() + sim.body().block.largestRimSpeed(sim.body().state.spin);
  const double free = std::min(most, timeToCover(room, speed, fall_.parameters.gravity));
  return timeToClose(sim.body().placed, sim.body().state, sim.patch(), sim.candidates(),
    fall_.parameters.gravity, free);
}

double IslandStepper::freeOfEachOther(const RockPair& pair, double gravity) const
{
  // Along the axis that tells them apart they come no nearer than this.
  const RockBody &a = fall_.rocks[pair.first].body(), &b = fall_.rocks[pair.second].body();
  const double closing = -pair.axis.normal.dot(a.state.velocity - b.state.velocity) +
    a.block.largestRimSpeed(a.state.spin) + b.block.largestRimSpeed(b.state.spin);
  return timeToCover(pair.axis.distance, closing, gravity);
}

double IslandStepper::freeTime(double most) const
{
  double free = most;
  for (int i : island_.members)
  {
    RockSimulator& sim = fall_.rocks[i].sim;
    free = sim.body().done ? free : this->freeOfSlope(sim, free);
  }
  for (const RockPair* pair : island_.pairs)
  {
    if (!fall_.rocks[pair->first].body().done && !fall_.rocks[pair->second].body().done)
    {
      free = std::min(free, this->freeOfEachOther(*pair, 0.0)); // both fall alike
    }
  }
  return free;
}

} // namespace rockfall
