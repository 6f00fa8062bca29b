#include "block/flight.h"

#include "block/FreeRotation.h"

namespace rockfall
{

Vec3 placeInFlight(const BlockState& state, double gravity, double duration)
{
  Vec3 place = state.position + duration * state.velocity;
  place.z() -= 0.5 * gravity * duration * duration;
  return place;
}

BlockState fly(const Block& block, const BlockState& state, double gravity, double duration)
{
  BlockState next = state;
  next.time = state.time + duration;
  next.position = placeInFlight(state, gravity, duration);
  next.velocity.z() -= gravity * duration;
  if (!state.spin.isZero(0.0))
  {
    const FreeRotation::Attitude turned = FreeRotation(block, state.spin).after(duration);
    next.orientation = (state.orientation * turned.turn).normalized();
    next.spin = turned.spin;
  }
  return next;
}

} // namespace rockfall
