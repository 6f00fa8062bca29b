#include "block/flight.h"

#include "block/FreeRotation.h"

#include <algorithm>
#include <utility>

namespace rockfall
{

Vec3 placeInFlight(const BlockState& state, double gravity, double duration)
{
  Vec3 place = state.position + duration * state.velocity;
  place.z() -= 0.5 * gravity * duration * duration;
  return place;
}

double flightLength(double duration, const Vec3& from, const Vec3& to)
{
  // The mean of the speed √(c² + u²), u growing evenly, by Gauss's rule of four points. Where it is
  // slowest a steep throw turns within a point's distance: there it is cut. Square roots have the
  // same bits on all machines, the closed form's logarithm has not.
  constexpr double points[4] = { 0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
    0.9305681557970262 };
  constexpr double weights[4] = { 0.17392742256872692, 0.3260725774312731, 0.3260725774312731,
    0.17392742256872692 };
  const Vec3 gained = to - from;
  const double size2 = gained.squaredNorm();
  const double slowest = size2 > 0.0 ? std::clamp(-from.dot(gained) / size2, 0.0, 1.0) : 0.0;
  double mean = 0.0;
  for (const auto& [begin, share] : { std::pair{ 0.0, slowest }, { slowest, 1.0 - slowest } })
  {
    for (int k = 0; share > 0.0 && k < 4; ++k)
    {
      mean += share * weights[k] * (from + (begin + share * points[k]) * gained).norm();
    }
  }
  return duration * mean;
}

BlockState between(const BlockState& from, const BlockState& to, double s)
{
  const double h = to.time - from.time, s2 = s * s, s3 = s2 * s;
  BlockState at = to;
  at.time = from.time + s * h;
  at.position = (2 * s3 - 3 * s2 + 1) * from.position + (s3 - 2 * s2 + s) * h * from.velocity +
    (3 * s2 - 2 * s3) * to.position + (s3 - s2) * h * to.velocity;
  at.velocity = (1.0 - s) * from.velocity + s * to.velocity;
  at.spin = (1.0 - s) * from.spin + s * to.spin;
  at.orientation = from.orientation.slerp(s, to.orientation);
  return at;
}

BlockState fly(const Block& block, const BlockState& state, double gravity, double duration)
{
  return fly(FreeRotation(block, state.spin), state, gravity, duration);
}

BlockState fly(
  const FreeRotation& rotation, const BlockState& state, double gravity, double duration)
{
  BlockState next = state;
  next.time = state.time + duration;
  next.position = placeInFlight(state, gravity, duration);
  next.velocity.z() -= gravity * duration;
  if (!state.spin.isZero(0.0))
  {
    const FreeRotation::Attitude turned = rotation.after(duration);
    next.orientation = (state.orientation * turned.turn).normalized();
    next.spin = turned.spin;
  }
  return next;
}

} // namespace rockfall
