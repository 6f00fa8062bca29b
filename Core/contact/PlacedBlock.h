#pragma once

/// @file
/// The geometry of a rock as it stands.

#include "block/Block.h"

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

  const Block& block() const { return *block_; }
  const Vec3& position() const { return position_; }
  const Mat3& rotation() const { return rotation_; }
  /// Of the reference shape, strained, to world axes.
  const Mat3& map() const { return map_; }
  // Found when they are asked for first, by whoever has the block: not by several threads at once.
  const std::vector<Vec3>& vertices() const ///< World, m.
  {
    this->findVertices();
    return vertices_;
  }
  Vec3 lower() const ///< Corner of the bounding box, m.
  {
    this->findVertices();
    return lower_;
  }
  Vec3 upper() const
  {
    this->findVertices();
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
  /// The face over which a world point is farthest out, or least deep if it is inside.
  int outermostFace(const Vec3& world) const;
  /// The undeformed body coordinates of a world point.
  Vec3 materialPoint(const Vec3& world) const
  {
    return undeform_ * (rotation_.transpose() * (world - position_));
  }

private:
  void findVertices() const
  {
    if (!found_)
    {
      this->placeVertices();
    }
  }
  void placeVertices() const;

  const Block* block_ = nullptr;
  Vec3 position_ = Vec3::Zero();
  Quat orientation_ = Quat::Identity();
  Eigen::Matrix<double, 6, 1> strain_ = Eigen::Matrix<double, 6, 1>::Zero();
  Mat3 rotation_ = Mat3::Identity();
  Mat3 map_ = Mat3::Identity();
  Mat3 undeform_ = Mat3::Identity(); ///< (I + ε)⁻¹
  mutable bool found_ = true;        ///< The members that follow are.
  mutable std::vector<Vec3> vertices_;
  mutable Vec3 lower_ = Vec3::Zero();
  mutable Vec3 upper_ = Vec3::Zero();
};

} // namespace rockfall
