#include "rock/fall/inSoil.h"

#include "law/settings.h"
#include "rock/fall/Fall.h"
#include "rock/fall/endOfFall.h"
#include "rock/fall/flightPhase.h"

namespace rockfall
{

namespace
{

void raiseScar(Fall& fall, double by)
{
  fall.soil.rise(by, fall.ground);
  if (!fall.soil.scar().open())
  {
    fall.impact.finish(fall.body, fall.recorder);
  }
}

bool sinkUnder(Fall& fall, double h)
{
  RockBody& body = fall.body;
  const SoilUnderRock::Sink sink = fall.soil.sinkWithin(body, fall.structures, h);
  if (!sink.under)
  {
    return false;
  }
  if (!fall.impact.pending())
  {
    fall.impact.begin(body, body.state, body.energy.friction, body.energy.restitution);
  }
  fall.impact.noteSink(body, *sink.under);
  fall.impact.noteApproach(sink.approach);
  fall.soil.sink(sink, fall.structures, body, fall.ground);
  return true;
}

bool riseWithRock(Fall& fall)
{
  const double by = fall.soil.riseNow(fall.body, fall.structures, fall.ground);
  if (!(by > 0.0))
  {
    return false;
  }
  std::erase_if(fall.body.contacts, [&](const Contact& c) { return !fall.structures.isFirm(c); });
  raiseScar(fall, by);
  return true;
}

void noteScar(Fall& fall)
{
  fall.impact.noteScar(fall.soil.scar().deepest(), fall.soil.scar().length());
}

} // namespace

bool followScar(Fall& fall, double h)
{
  return sinkUnder(fall, h) || riseWithRock(fall);
}

void closeScar(Fall& fall)
{
  if (fall.soil.scar().open())
  {
    raiseScar(fall, fall.soil.scar().depth());
  }
}

bool flyOverScar(Fall& fall, double small)
{
  const RockBody& body = fall.body;
  if (fall.structures.solid() ||
    !(body.state.strain.isZero(0.0) && body.state.strainRate.isZero(0.0)))
  {
    return false;
  }
  double free = fall.freeUntil - body.state.time;
  if (!(free > 0.0))
  {
    fall.ground.ensurePatch(body, fall.structures, 0.0);
    if (riseWithRock(fall))
    {
      return true;
    }
    free = fall.soil.freeOverScar(body, fall.ground);
    if (!(free > small))
    {
      return false;
    }
    if (fall.soil.scar().turned() && fall.impact.age(body.state.time) > kOneImpact)
    {
      fall.impact.drawAnew();
    }
    fall.freeUntil = body.state.time + free;
  }
  advanceInFlight(fall, std::min(free, fall.horizon - body.state.time));
  checkEnd(fall, 0.0);
  return true;
}

void flyThroughSoil(Fall& fall, double duration)
{
  if (fall.soil.fly(fall.body, duration))
  {
    noteScar(fall);
  }
}

void yieldInStep(Fall& fall, double h)
{
  if (fall.soil.yieldInStep(fall.body, fall.structures, h))
  {
    noteScar(fall);
  }
}

} // namespace rockfall
