#pragma once

/// @file
/// The geometry of a rock as it stands.

#include "block/Block.h"

#include <cassert>
#include <limits>
#include <vector>

namespace rockfall
{

/// A block as it stands in the world: what contact detection reads.
class PlacedBlock
{
public:
  void place(const Block& block, const BlockState& state);
  /// The same; nothing to do where this block stands there already.
  void move(const Block& block, const BlockState& state);
  /// The same in two steps, for a rock that is mostly far from the slope: pose, map and normals
  /// first; vertices and box when they are needed, unless they are there.
  void placeFrame(const Block& block, const BlockState& state);
  void placeVertices();

  const Block& block() const { return *block_; }
  const Vec3& position() const { return position_; }
  const Quat& orientation() const { return orientation_; }
  const Eigen::Matrix<double, 6, 1>& strain() const { return strain_; }
  const Mat3& rotation() const { return rotation_; }
  /// Of the reference shape, strained, to world axes.
  const Mat3& map() const { return map_; }
  const std::vector<Vec3>& vertices() const ///< World, m.
  {
    assert(placed_);
    return vertices_;
  }
  Vec3 lower() const ///< Corner of the bounding box, m.
  {
    assert(placed_);
    return lower_;
  }
  Vec3 upper() const
  {
    assert(placed_);
    return upper_;
  }
  Vec3 normal(int face) const ///< World, outward, unit.
  {
    return rotation_ * block_->shape().normals()[face];
  }

  /// Signed distance of a world point over a face; the strain of the block is undone first.
  double faceDistance(int face, const Vec3& world) const
  {
    const Vec3 x = this->materialPoint(world);
    return block_->shape().normals()[face].dot(x) - block_->shape().offsets()[face];
  }
  /// The face over which a world point is farthest out, or least deep if it is inside. -1 as soon
  /// as it is farther out than `beyond`, m: most nodes near a rock are, over one of its first faces.
  int outermostFace(
    const Vec3& world, double beyond = std::numeric_limits<double>::infinity()) const;
  /// The undeformed body coordinates of a world point.
  Vec3 materialPoint(const Vec3& world) const
  {
    return undeform_ * (rotation_.transpose() * (world - position_));
  }

private:
  const Block* block_ = nullptr;
  Vec3 position_ = Vec3::Zero();
  Quat orientation_ = Quat::Identity();
  Eigen::Matrix<double, 6, 1> strain_ = Eigen::Matrix<double, 6, 1>::Zero();
  Mat3 rotation_ = Mat3::Identity();
  Mat3 map_ = Mat3::Identity();
  Mat3 undeform_ = Mat3::Identity(); ///< (I + ε)⁻¹
  bool placed_ = true;               ///< The members that follow are for this pose.
  std::vector<Vec3> vertices_;
  Vec3 lower_ = Vec3::Zero();
  Vec3 upper_ = Vec3::Zero();
};

/// Whether the rock is a sphere or an ellipsoid (geometry/roundBody.h).
bool isRound(const PlacedBlock& rock);
/// Matrix A of the semi-axes of a round rock as it stands, world axes, m.
Mat3 roundAxes(const PlacedBlock& rock);

} // namespace rockfall
