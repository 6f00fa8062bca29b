#include "world/VelocityBounds.h"

#include <cmath>

namespace rockfall
{

void boundVelocities(
  const WorldState& world, const SingleRock& sim, double duration, VelocityBounds& velocities)
{
  const BlockState& s = sim.body().state;
  const double speed = s.velocity.norm(), rim = sim.body().block.largestRimSpeed(s.spin);
  // Springs give back what they hold in the middle of an impact.
  const double held = std::sqrt(2.0 * sim.body().springEnergy * sim.body().block.largestMobility());
  velocities.own = (speed + rim + held) * duration + world.parameters.gravity * duration * duration;
  // Structures farther off than it may come have no say.
  const double displacement = sim.body().block.radius() + velocities.own;
  const Vec3& p = s.position;
  const Obstacles* obstacles = world.surface.terrain().obstacles();
  const bool obstructed = obstacles &&
    obstacles->anyIn(
      p.x() - displacement, p.x() + displacement, p.y() - displacement, p.y() + displacement);
  // Closed contacts only: the open ones that are kept hang on how the slope was searched.
  const bool flies = !obstructed && !anyClosed(sim.body().contacts) &&
    sim.fall().ground.clearFor(sim.body(), duration);
  // Velocities that an impact on the slope leaves, with any normal.
  const double e = obstructed ? 1.0 : world.surface.largestRestitution();
  velocities.middle = flies ? s.velocity : Vec3(0.5 * (1.0 - e) * s.velocity);
  velocities.spread = rim + held + (flies ? 0.0 : 0.5 * (1.0 + e) * speed);
}

} // namespace rockfall
