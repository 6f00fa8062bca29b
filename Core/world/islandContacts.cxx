// Contacts of an island where a step begins.

#include "world/IslandStepper.h"

#include "base/parallel.h"
#include "law/settings.h"
#include "rock/fall/atStructures.h"
#include "rock/fall/contactPhase.h"
#include "rock/fall/inSoil.h"
#include "world/stepLayout.h"

#include <algorithm>

namespace rockfall
{

void IslandStepper::gatherContacts(double h)
{
  work_.sides.resize(world_.rocks.size());
  const auto stand = [&](std::size_t k)
  {
    const std::size_t i = std::size_t(island_.members[k]);
    work_.sides[i].set(world_.rocks[i].body());
  };
  forEach(island_.members.size(), kRockGrain, stand);
  findPushes(island_, work_);
  forEach(island_.members.size(), kRockGrain, [&](std::size_t k) { this->gatherOnSlope(k, h); });
  forEach(island_.pairs.size(), kPairGrain, [&](std::size_t p) { this->gatherOfPair(p, h); });
}

double IslandStepper::reachOf(double speed, double radius, double h) const
{
  return kFasterApproach * speed * h + world_.parameters.gravity * h * h + 1e-6 * radius;
}

void IslandStepper::gatherOnSlope(std::size_t k, double h)
{
  FallingRock& rock = world_.rocks[std::size_t(island_.members[k])];
  Fall& fall = rock.fall();
  RockBody& body = rock.body();
  if (body.done)
  {
    return;
  }
  rock.updatePose();
  IslandWork::Side& side = work_.sides[std::size_t(island_.members[k])];
  const double r = body.block.radius();
  const double speed = body.state.velocity.norm() + body.state.spin.norm() * r + side.pushed;
  const double reach = this->reachOf(speed, r, h);
  if (!body.inIsland)
  {
    body.inIsland = true;
    fall.springs.join(body);
  }
  // Twice: beyond a concave edge planes serve a little further than their triangles.
  if (fall.ground.isClear(body, fall.structures, 2.0 * reach))
  {
    closeScar(fall);
    setNewSprings(fall, h);
    return;
  }
  body.placed.placeVertices();
  const auto find = [&]
  {
    fall.ground.ensureCandidates(body, fall.structures, reach, true);
    findContacts(fall, fall.ground.candidates(), reach, 0.0);
  };
  find();
  while (fall.structures.solid() && breakTrees(fall, h))
  {
    find();
  }
  while (fall.soil.yields() && followScar(fall, h))
  {
    find();
  }
  if (fall.structures.solid())
  {
    side.set(body); // what broke has taken speed
  }
  guardPenetrations(fall, fall.ground.candidates());
  const ImpactEvent* impact = fall.impact.underWay();
  fall.springs.stiffenPressed(body, impact ? impact->velocityBefore.norm() : 0.0);
  setNewSprings(fall, h);
}

void IslandStepper::gatherOfPair(std::size_t p, double h)
{
  RockPair& pair = *island_.pairs[p];
  const IslandWork::Side& a = work_.sides[std::size_t(pair.first)];
  const IslandWork::Side& b = work_.sides[std::size_t(pair.second)];
  if (a.done || b.done)
  {
    pair.keep({});
    pair.axis.distance = std::max(0.0, pair.axis.distance);
    return;
  }
  const PairMotion motion = work_.motionOf(pair);
  const double rims = a.rim + b.rim, smaller = std::min(a.radius, b.radius);
  const double reach = this->reachOf(motion.velocity.norm() + rims, smaller, h);
  const PairBody& first = world_.rocks[std::size_t(pair.first)].hull;
  const PairBody& second = world_.rocks[std::size_t(pair.second)].hull;
  // The look at the end finds the others, should they be needed; what closes is given springs then.
  const ClosingGaps closing = { motion, kFasterApproach * h,
    world_.parameters.gravity * h * h + kSurely * smaller, rims };
  updatePair(first, second, reach, pair, &closing);
}

} // namespace rockfall
