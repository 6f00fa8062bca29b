#include "rock/fall/SingleRock.h"

#include "block/flight.h"
#include "contact/ground/detection.h"
#include "rock/fall/atStructures.h"
#include "rock/fall/contactPhase.h"
#include "rock/fall/endOfFall.h"
#include "rock/fall/flightPhase.h"
#include "rock/placement.h"
#include "terrain/walls.h"

#include <algorithm>
#include <utility>

namespace rockfall
{

SingleRock::SingleRock(const Surface& surface, const Rock& rock, const Block& block,
  const SimulationParameters& p, std::uint32_t number)
  : rock_(rock)
  , fall_(surface, rock, block, p, number)
{
}

Trajectory SingleRock::run(double enough)
{
  this->liftOntoGround();
  this->begin();
  this->advance(fall_.parameters.endTime, enough);
  return this->finish();
}

void SingleRock::liftOntoGround()
{
  // The placement was checked on the slope as surveyed; roughness can raise the ground into the
  // rock. By steps, so it ends a hair over the ground.
  RockBody& body = fall_.body;
  const double r = body.block.radius();
  const double step = 0.01 * r;
  body.placed.place(body.block, body.state);
  if (fall_.structures.solid())
  {
    fall_.structures.clearTrees(body.placed, body.state);
    fall_.ground.forgetPatch();
  }
  fall_.ground.ensurePatch(body, fall_.structures, step);
  const SurfacePatch& patch = fall_.ground.patch();
  double depth = penetration(body.placed, patch);
  // A rock that starts in the ground by rounding alone is set onto it by what follows.
  const double worldZ = body.state.position.z() + fall_.surface.terrain().geometry().origin().z();
  const double least = std::max(1e-6 * r, startRounding(worldZ, r));
  for (int k = 0; k < 1000 && depth > least; ++k)
  {
    body.state.position.z() += std::max(depth, step);
    body.placed.place(body.block, body.state);
    depth = penetration(body.placed, patch);
  }
  // Edges across each other are not seen by that, and embankments may be upright walls.
  body.state.position.z() += liftOut(body.placed, patch);
  body.placed.place(body.block, body.state);
}

void SingleRock::begin()
{
  TrajectorySummary& summary = this->trajectory().summary;
  summary.blockId = rock_.blockId;
  summary.mass = fall_.body.block.mass();
  summary.volume = fall_.body.block.volume();
  fall_.recorder.begin(fall_.body);
  checkEnd(fall_, 0.0);
}

void SingleRock::beginAsPiece(const Vec3& whole)
{
  RockBody& body = fall_.body;
  const BlockState born = body.state;
  BlockState from = born;
  from.position = whole;
  const Way way{ from, born, 0.0, false };
  double taken = 0.0;
  const auto meets = [&] { return passBarriers(fall_, way, taken); };
  const auto line = [&] { return between(from, born, fall_.structures.hit().fraction).position; };
  if (fall_.structures.hasBarriers())
  {
    fall_.structures.findBarriers(way, fall_.parameters.gravity, body.block.radius());
  }
  bool met = fall_.structures.hasBarriers() && meets();
  body.state.position = met && holdsAtBarrier(fall_) ? line() : born.position;
  this->begin();
  while (met && !body.done)
  {
    meetBarrier(fall_);
    taken += this->trajectory().structures.back().energyTaken;
    met = !body.done && meets();
    if (met && holdsAtBarrier(fall_))
    {
      // The way to where it was born did not happen.
      body.energy.structures +=
        body.block.mass() * fall_.parameters.gravity * (body.state.position - line()).z();
      body.state.position = line();
    }
  }
}

bool SingleRock::hasSampleAt(double enough) const
{
  // A knot that is the last sample may still be replaced.
  const std::vector<Sample>& samples = this->trajectory().samples;
  const std::size_t last = samples.size() - 1;
  return samples[last].kind != SampleKind::Knot ? samples[last].time >= enough
                                                : last > 0 && samples[last - 1].time >= enough;
}

void SingleRock::advance(double until, double enough)
{
  RockBody& body = fall_.body;
  if (body.inIsland)
  {
    body.inIsland = false;
    fall_.springs.part(body);
    fall_.freeUntil = 0.0;
    fall_.pressed = true;
    // Flight goes by them, and would hang on how the island was looked at.
    fall_.ground.forgetCandidates();
  }
  fall_.horizon = std::min(until, fall_.parameters.endTime);
  while (!body.done && !fall_.arrived() && !this->hasSampleAt(enough))
  {
    if (!fall_.inContact)
    {
      flyUntilNear(fall_);
      if (body.done || fall_.arrived())
      {
        return;
      }
      beginContact(fall_);
    }
    stayInContact(fall_);
  }
}

void SingleRock::wake(double time)
{
  fall_.body.done = false;
  fall_.body.quietTime = 0.0;
  fall_.body.state.time = time;
  this->trajectory().summary.fate = Fate::Moving;
  fall_.recorder.resume(fall_.body);
}

Trajectory SingleRock::finish()
{
  const bool touching = anyClosed(fall_.body.contacts);
  fall_.impact.finish(fall_.body, fall_.recorder, false);
  fall_.recorder.end(fall_.body, touching);
  return std::move(this->trajectory());
}

} // namespace rockfall
