#include "contact/pairs.h"

#include <array>

namespace rockfall
{

namespace
{

using Two = Eigen::Array2d;

inline Two take(const double* from)
{
  return Eigen::Map<const Two>(from);
}

inline void put(const Two& of, double* to)
{
  Eigen::Map<Two>{ to } = of;
}

/// Two vectors of a layout, with sums in the order in which a matrix times a vector has them.
inline std::array<Two, 3> turned(const Mat3& map, const double* from)
{
  const Two x = take(from), y = take(from + 4), z = take(from + 8);
  return { map(0, 0) * x + map(0, 1) * y + map(0, 2) * z,
    map(1, 0) * x + map(1, 1) * y + map(1, 2) * z,
    map(2, 0) * x + (map(2, 1) * y + map(2, 2) * z) };
}

} // namespace

void PairBody::update(const PlacedBlock& block)
{
  const Polyhedron& shape = block.block().shape();
  shape_ = &shape.layout();
  edges = shape.edges();
  radius = shape.radius();
  inside = shape_->inside;
  position = block.position();
  rotation = block.rotation();
  vertexFours_ = shape_->vertexFours;
  faceFours_ = shape_->faceFours;
  data_.resize(shape_->data.size());
  const double* from = shape_->data.data();
  double* to = data_.data();
  const Vec3 center = position;
  const Mat3 map = block.map(), turn = rotation;
  // Two at a time, which is what a register takes on any x86-64.
  for (int i = 0; i < 2 * vertexFours_; ++i)
  {
    const auto of = turned(map, from);
    for (int k = 0; k < 3; ++k)
    {
      put(center[k] + of[k], to + 4 * k);
    }
    from += i % 2 ? ShapeLayout::kOfVertices - 2 : 2;
    to += i % 2 ? ShapeLayout::kOfVertices - 2 : 2;
  }
  for (int i = 0; i < 2 * faceFours_; ++i)
  {
    const auto n = turned(turn, from);
    for (int k = 0; k < 3; ++k)
    {
      put(n[k], to + 4 * k);
    }
    const Two offset = take(from + 12);
    put(offset + (n[0] * center.x() + n[1] * center.y() + n[2] * center.z()), to + 12);
    from += i % 2 ? ShapeLayout::kOfFaces - 2 : 2;
    to += i % 2 ? ShapeLayout::kOfFaces - 2 : 2;
  }
}

} // namespace rockfall
