#include "rock/fall/flightPhase.h"

#include "base/abort.h"
#include "block/flight.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/fall/Fall.h"
#include "rock/fall/atStructures.h"
#include "rock/fall/endOfFall.h"
#include "rock/fall/impulseImpacts.h"
#include "rock/fall/inSoil.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Time to the horizon, or to the edge of the slope, where the rock is let go, s.
double timeToEdge(const Fall& fall)
{
  const BlockState& state = fall.body.state;
  double remaining = fall.horizon - state.time;
  const double extent[2] = { fall.surface.terrain().width(), fall.surface.terrain().height() };
  for (int axis = 0; axis < 2; ++axis)
  {
    const double v = state.velocity[axis];
    const double way = v > 0.0 ? extent[axis] - state.position[axis] : state.position[axis];
    if (v != 0.0)
    {
      // A hair beyond, so that the edge is passed and not met for ever.
      remaining = std::min(
        remaining, (way + 1e-9 * fall.body.block.radius() + 1e-15 * extent[axis]) / std::abs(v));
    }
  }
  return remaining;
}

/// Soil brakes: where the rock has passed a barrier is known when it is there, as of a step of
/// contact.
void advanceInSoil(Fall& fall, double duration)
{
  RockBody& body = fall.body;
  body.before = body.state;
  body.springEnergyBefore = body.springEnergy;
  flyThroughSoil(fall, duration);
  body.state.time = body.before.time + duration;
  if (fall.structures.hasBarriers() && !passBarriersInStep(fall, false))
  {
    return;
  }
  fall.recorder.recordBetween(body, body.before, body.state, false);
  fall.recorder.follow(body.state);
  fall.soil.forgetSlip(duration);
}

} // namespace

void advanceInFlight(Fall& fall, double duration)
{
  if (fall.soil.scar().open())
  {
    advanceInSoil(fall, duration);
    return;
  }
  RockBody& body = fall.body;
  const BlockState start = body.state;
  BlockState reached = start;
  const Way way{ start, reached, duration, true };
  if (fall.structures.hasBarriers())
  {
    reached.position = placeInFlight(start, fall.parameters.gravity, duration);
    fall.structures.findBarriers(way, fall.parameters.gravity, body.block.radius());
    duration = passBarriers(fall, way, 0.0) ? fall.structures.hit().fraction * duration : duration;
  }
  const double end = start.time + duration;
  BlockState at = start;
  while (fall.recorder.nextTime() <= end)
  {
    at = fly(
      body.block, at, fall.parameters.gravity, std::max(0.0, fall.recorder.nextTime() - at.time));
    fall.recorder.record(body, at, false);
  }
  body.state = fly(body.block, start, fall.parameters.gravity, duration);
  body.state.time = end;
  fall.recorder.followFlight(start, body.state);
  fall.soil.forgetSlip(duration);
  while (fall.structures.hasBarriers() && !body.done && fall.structures.hit().barrier >= 0)
  {
    meetBarrier(fall);
    passBarriers(fall, way, 0.0);
  }
}

void flyFree(Fall& fall, double duration)
{
  RockBody& body = fall.body;
  body.contacts.clear();
  fall.impact.finish(body, fall.recorder);
  const double end = body.state.time + duration;
  advanceInFlight(fall, duration);
  while (fall.structures.hasBarriers() && !body.done && body.state.time < end)
  {
    advanceInFlight(fall, end - body.state.time); // through a barrier that broke
  }
  if (!body.done)
  {
    checkLeft(fall);
  }
  body.quietTime = 0.0;
}

void flyUntilNear(Fall& fall)
{
  RockBody& body = fall.body;
  while (!body.done && !fall.arrived() && !fall.soil.scar().open())
  {
    stayWanted();
    double duration = std::min(kLongFlight, timeToEdge(fall));
    if (!fall.ground.clearFor(body, duration))
    {
      // A window over some of the way: nearer than its plane only the rock itself is looked at.
      const double across = body.state.velocity.head<2>().norm();
      const double way =
        kHeightWindow * std::max(body.block.radius(), fall.surface.grid().cellSize);
      duration = std::min(duration, across * duration > way ? way / across : duration);
      fall.ground.ensureWindow(body, duration);
      const double near = timeToNear(
        body.state, body.block.radius(), fall.ground.window(), fall.parameters.gravity, duration);
      if (near > fall.springs.impactStep(body))
      {
        duration = near;
      }
      else
      {
        const double sure = std::max(0.0, fall.freeUntil - body.state.time);
        if (fall.impulses && !fall.structures.solid() && sure == 0.0 &&
          fall.ground.window().whole())
        {
          if (!hop(fall, duration))
          {
            return;
          }
          checkEnd(fall, 0.0);
          continue;
        }
        body.placed.place(body.block, body.state);
        const double touch = std::max(sure, fall.ground.timeToGround(body, duration));
        // So near that the pairs that can touch tell more.
        const double speed =
          body.state.velocity.norm() + body.block.largestRimSpeed(body.state.spin);
        const double close = 0.5 * kCandidateSlack * body.block.radius() / std::max(speed, 1e-9);
        if (sure == 0.0 &&
          touch < std::min(duration, std::max(close, fall.springs.impactStep(body))))
        {
          return;
        }
        duration = std::min(duration, touch);
      }
    }
    if (fall.structures.solid())
    {
      const double free = freeOfObstacles(fall, duration);
      if (free < std::min(duration, fall.springs.impactStep(body)))
      {
        return;
      }
      duration = free;
    }
    advanceInFlight(fall, duration);
    checkEnd(fall, 0.0);
  }
}

} // namespace rockfall
