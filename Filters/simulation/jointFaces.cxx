#include "simulation/jointFaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rockfall::filters
{

namespace
{

/// Middles of faces in one cube of this edge are one, m.
constexpr double kCell = 1e-4;
/// Of the cosine of two normals that are opposite.
constexpr double kOpposite = -0.999;

struct PlacedFace
{
  std::array<double, 3> cell{}; ///< Of the middle, whole numbers.
  Vec3 normal = Vec3::UnitZ();  ///< Outward.
  std::size_t rock = 0;
};

std::vector<PlacedFace> placedFaces(std::span<const Rock> rocks)
{
  std::vector<PlacedFace> all;
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    const Polyhedron& shape = rocks[i].shape;
    const Quat turn = rocks[i].orientation.normalized();
    for (std::size_t f = 0; f < shape.faces().size(); ++f)
    {
      Vec3 middle = Vec3::Zero();
      for (const int v : shape.faces()[f])
      {
        middle += shape.vertices()[std::size_t(v)] / double(shape.faces()[f].size());
      }
      const Vec3 cell = (turn * middle + rocks[i].position) / kCell;
      all.push_back({ { std::round(cell.x()), std::round(cell.y()), std::round(cell.z()) },
        turn * shape.normals()[f], i });
    }
  }
  return all;
}

} // namespace

std::int64_t countFaceOnFace(std::span<const Rock> rocks)
{
  std::vector<PlacedFace> faces = placedFaces(rocks);
  std::stable_sort(faces.begin(), faces.end(),
    [](const PlacedFace& a, const PlacedFace& b) { return a.cell < b.cell; });
  // Each against the first in its cell: any number of rocks may stand at one place.
  std::vector<char> joined(rocks.size(), 0);
  std::size_t first = 0;
  for (std::size_t k = 1; k < faces.size(); ++k)
  {
    if (faces[k].cell != faces[first].cell)
    {
      first = k;
    }
    else if (faces[k].normal.dot(faces[first].normal) < kOpposite)
    {
      joined[faces[k].rock] = joined[faces[first].rock] = 1;
    }
  }
  return std::count(joined.begin(), joined.end(), 1);
}

} // namespace rockfall::filters
