#include "run/releaseChecks.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "base/text/pointText.h"
#include "contact/PlacedBlock.h"
#include "law/settings.h"
#include "rock/placement.h"
#include "run/releasePlaces.h"
#include "terrain/Surface.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// How deep the rock is in the slope as surveyed, m: roughness belongs to an iteration.
double depthOf(const Terrain& terrain, const Rock& rock, const Block& block)
{
  BlockState state;
  state.position = rock.position;
  state.orientation = rock.orientation.normalized();
  PlacedBlock placed;
  placed.place(block, state);
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(terrain), placed.lower().x(), placed.upper().x(),
    placed.lower().y(), placed.upper().y(), patch);
  return liftOut(placed, patch);
}

} // namespace

void requireOnSlope(const Terrain& terrain, const Rock& rock, const Block& block)
{
  const Vec3 world = rock.position + terrain.geometry().origin();
  const std::string name = "block " + std::to_string(rock.blockId) + " at " + pointText(world);
  if (terrain.cfeAt(rock.position.x(), rock.position.y()) == 0)
  {
    throw PlacementError(name + whyNoGround(terrain, world.x(), world.y()));
  }
  const double height = rock.position.z() - terrain.elevation(rock.position.x(), rock.position.y());
  if (height > kHighestRelease)
  {
    throw PlacementError(name + " is " + numberText(height, 4) + " m over the slope, more than " +
      std::to_string(int(kHighestRelease)) +
      " m: is its height in feet, or that of another reference than the slope's?");
  }
  if (rock.uncertainty.horizontalDeviation > std::hypot(terrain.width(), terrain.height()))
  {
    throw ParameterError(name + ": HorizontalDeviation is " +
      numberText(rock.uncertainty.horizontalDeviation) + " m, more than the slope is wide");
  }
  const double depth = depthOf(terrain, rock, block);
  // A rock in it by rounding alone is set onto it when it is released.
  if (depth > startRounding(world.z(), block.radius()))
  {
    throw PlacementError(
      name + " starts inside the slope, by " + numberText(depth, 4) + " m; raise its centre");
  }
}

void requireStiff(const Rock& rock, const Block& block, const SimulationParameters& p)
{
  const double weight = block.mass() * p.gravity;
  const double most = kDeepestAtRest * block.radius();
  const double penalty = p.rockRockContact ? p.pairPenalty() : p.penaltyFor(block.mass());
  if (weight > most * penalty)
  {
    const std::string typed = p.normalPenalty > 0.0 ? "" : "0, that is ";
    throw ParameterError("NormalPenalty is " + typed + numberText(penalty) +
      " N/m, too soft for block " + std::to_string(rock.blockId) + ": at rest its " +
      numberText(block.mass()) + " kg would lie " + numberText(weight / penalty) +
      " m deep in the ground, more than " + numberText(100.0 * kDeepestAtRest) +
      " % of its radius; it needs " + numberText(weight / most) + " N/m or more");
  }
}

void setOntoSlope(const Terrain& terrain, Rock& rock, double most)
{
  if (terrain.cfeAt(rock.position.x(), rock.position.y()) == 0)
  {
    return; // the ensemble says so
  }
  // A grid of single precision is rounded; twice that much is a hair.
  const double hair = 4.0 * std::ldexp(std::max(50.0, std::abs(rock.position.z())), -24);
  const double depth = depthOf(terrain, rock, blockOf(rock));
  if (depth <= std::max(most, hair))
  {
    rock.position.z() += depth;
  }
}

} // namespace rockfall
