#pragma once

/// @file
/// The Cayley map of a rotation (METHOD 10.4).

#include "base/types.h"

#include <cmath>

namespace rockfall
{

/// The Cayley map of a rotation vector, as a unit quaternion.
inline Quat cayley(const Vec3& r)
{
  const double scale = 1.0 / std::sqrt(1.0 + 0.25 * r.squaredNorm());
  return Quat(scale, 0.5 * scale * r.x(), 0.5 * scale * r.y(), 0.5 * scale * r.z());
}

} // namespace rockfall
