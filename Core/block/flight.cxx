#include "block/flight.h"

#include "block/FreeRotation.h"

namespace rockfall
{

BlockState fly(const Block& block, const BlockState& state, double gravity, double duration)
{
  BlockState next = state;
  next.time = state.time + duration;
  next.position += duration * state.velocity;
  next.position.z() -= 0.5 * gravity * duration * duration;
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
