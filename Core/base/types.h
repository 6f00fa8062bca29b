#pragma once

/// @file
/// The few mathematical types that every part of the Core speaks of. SI units throughout.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <numbers>

namespace rockfall
{

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond; ///< Rotates body axes into world axes.
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// Degrees are met only where a person types or reads; this is the one way in.
constexpr double radians(double degrees)
{
  return degrees * (std::numbers::pi / 180.0);
}

/// The one way out.
constexpr double degrees(double radians)
{
  return radians * (180.0 / std::numbers::pi);
}

} // namespace rockfall
