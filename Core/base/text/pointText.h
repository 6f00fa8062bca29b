#pragma once

#include "base/types.h"

#include <Eigen/Geometry>

#include <string>

namespace rockfall
{

/// A place or a vector for a message: (x, y, z), each as `numberText` writes it.
std::string pointText(const Vec3& point);

/// Bounds in plan for a message: "x 1 to 2, y 3 to 4".
std::string boundsText(const Eigen::AlignedBox2d& box, int digits = 9);

} // namespace rockfall
