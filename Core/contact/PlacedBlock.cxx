#include "contact/PlacedBlock.h"

#include "geometry/roundBody.h"

#include <Eigen/LU>

#include <limits>

namespace rockfall
{

void PlacedBlock::place(const Block& block, const BlockState& state)
{
  this->placeFrame(block, state);
  this->placeVertices();
}

void PlacedBlock::placeFrame(const Block& block, const BlockState& state)
{
  block_ = &block;
  position_ = state.position;
  orientation_ = state.orientation;
  strain_ = state.strain;
  rotation_ = state.orientation.toRotationMatrix();
  map_ = rotation_;
  undeform_.setIdentity();
  if (!state.strain.isZero(0.0))
  {
    const Mat3 deform = Mat3::Identity() + strainTensor(state.strain);
    undeform_ = deform.inverse();
    map_ = rotation_ * deform;
  }
  placed_ = false;
}

void PlacedBlock::move(const Block& block, const BlockState& state)
{
  if (block_ != &block || position_ != state.position ||
    orientation_.coeffs() != state.orientation.coeffs() || strain_ != state.strain)
  {
    this->placeFrame(block, state);
  }
  this->placeVertices();
}

void PlacedBlock::placeVertices()
{
  if (placed_)
  {
    return;
  }
  const std::vector<Vec3>& reference = block_->shape().vertices();
  vertices_.resize(reference.size());
  const Mat3 map = map_;
  const Vec3 center = position_; // all this in registers
  Vec3 lower = Vec3::Constant(1e300), upper = Vec3::Constant(-1e300);
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    const Vec3 v = center + map * reference[i];
    vertices_[i] = v;
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  if (isRound(*this))
  {
    const Vec3 reach = roundAxes(*this).rowwise().norm();
    lower = center - reach;
    upper = center + reach;
  }
  lower_ = lower;
  upper_ = upper;
  placed_ = true;
}

int PlacedBlock::outermostFace(const Vec3& world, double beyond) const
{
  const Polyhedron& shape = block_->shape();
  const Vec3 x = this->materialPoint(world);
  int face = 0;
  double farthest = -std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < shape.normals().size(); ++f)
  {
    const double distance = shape.normals()[f].dot(x) - shape.offsets()[f];
    if (distance > beyond)
    {
      return -1;
    }
    if (distance > farthest)
    {
      farthest = distance;
      face = int(f);
    }
  }
  return face;
}

bool isRound(const PlacedBlock& rock)
{
  return isRound(rock.block().shape().layout());
}

Mat3 roundAxes(const PlacedBlock& rock)
{
  return rock.map() * roundAxes(rock.block().shape().layout());
}

} // namespace rockfall
