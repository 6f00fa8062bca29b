#include "contact/Contact.h"

#include <Eigen/LU>

namespace rockfall
{

void PlacedBlock::place(const Block& block, const BlockState& state)
{
  block_ = &block;
  position_ = state.position;
  rotation_ = state.orientation.toRotationMatrix();
  const Mat3 deform = Mat3::Identity() + strainTensor(state.strain);
  undeform_ = deform.inverse();
  const Mat3 map = rotation_ * deform;
  const std::vector<Vec3>& reference = block.shape().vertices();
  vertices_.resize(reference.size());
  lower_.setConstant(1e300);
  upper_.setConstant(-1e300);
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    vertices_[i] = position_ + map * reference[i];
    lower_ = lower_.cwiseMin(vertices_[i]);
    upper_ = upper_.cwiseMax(vertices_[i]);
  }
  const std::vector<Vec3>& normals = block.shape().normals();
  normals_.resize(normals.size());
  for (std::size_t f = 0; f < normals.size(); ++f)
  {
    normals_[f] = rotation_ * normals[f];
  }
}

} // namespace rockfall
