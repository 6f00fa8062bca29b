#include "geometry/ShapeLayout.h"

#include "geometry/roundBody.h"

#include <algorithm>
#include <limits>

namespace rockfall
{

ShapeLayout::ShapeLayout(std::span<const Vec3> points, std::span<const std::vector<int>> loops,
  std::span<const Vec3> normals, std::span<const double> offsets)
  : vertices(int(points.size()))
  , vertexFours((vertices + 3) / 4)
  , faces(int(loops.size()))
  , faceFours((faces + 3) / 4)
  , data(std::size_t(kOfVertices * vertexFours + kOfFaces * faceFours))
{
  for (int i = 0; i < 4 * vertexFours; ++i)
  {
    const Vec3& v = points[std::size_t(std::min(i, vertices - 1))];
    double* at = data.data() + kOfVertices * (i >> 2) + (i & 3);
    at[0] = v.x();
    at[4] = v.y();
    at[8] = v.z();
  }
  inside = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 4 * faceFours; ++i)
  {
    const std::size_t f = std::size_t(std::min(i, faces - 1));
    double* at = data.data() + kOfVertices * vertexFours + kOfFaces * (i >> 2) + (i & 3);
    at[0] = normals[f].x();
    at[4] = normals[f].y();
    at[8] = normals[f].z();
    at[12] = offsets[f];
    inside = std::min(inside, offsets[f]);
  }
  starts.push_back(0);
  for (const std::vector<int>& loop : loops)
  {
    corners.insert(corners.end(), loop.begin(), loop.end());
    starts.push_back(int(corners.size()));
  }
  if (const std::optional<RoundBody> round = roundBodyOf(points, normals, offsets))
  {
    inside = round->least;
    data.insert(data.end(), round->axes.data(), round->axes.data() + 9);
  }
}

} // namespace rockfall
