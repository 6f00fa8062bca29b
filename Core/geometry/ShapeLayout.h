#pragma once

/// @file
/// A polyhedron as loops over all of its vertices or faces want it.

#include "base/types.h"

#include <span>
#include <vector>

namespace rockfall
{

/// Coordinate by coordinate, in fours that are reckoned side by side, the last vertex and face
/// repeated to fill them up; the loops of the faces one behind the other.
struct ShapeLayout
{
  using Four = Eigen::Array4d;
  /// Three coordinates of four, and for faces their offsets behind them.
  static constexpr int kOfVertices = 12, kOfFaces = 16;

  ShapeLayout() = default;
  ShapeLayout(std::span<const Vec3> vertices, std::span<const std::vector<int>> faces,
    std::span<const Vec3> normals, std::span<const double> offsets);

  int vertices = 0, vertexFours = 0, faces = 0, faceFours = 0;
  /// Per four vertices x, y, z, then per four faces the normals' x, y, z and the offsets.
  std::vector<double> data;
  std::vector<int> corners; ///< Of all faces, in the order of their loops.
  std::vector<int> starts;  ///< By face, where its corners begin; one more at the end.
  double inside = 0.0;      ///< Least offset, m.

  std::span<const int> loop(int face) const
  {
    const int start = starts[std::size_t(face)];
    return { corners.data() + start, std::size_t(starts[std::size_t(face) + 1] - start) };
  }
};

} // namespace rockfall
