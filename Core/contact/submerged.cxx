#include "contact/submerged.h"

#include <cmath>
#include <vector>

namespace rockfall
{

double submergedArea(const PlacedBlock& rock, const Plane& plane, const Vec3& direction)
{
  const std::vector<Vec3>& vertices = rock.vertices();
  thread_local std::vector<double> heights; // over the plane, m
  heights.resize(vertices.size());
  bool any = false;
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    heights[v] = plane.normal.dot(vertices[v]) - plane.offset;
    any = any || heights[v] < 0.0;
  }
  if (!any)
  {
    return 0.0;
  }
  // Twice the areas, as seen along the direction. The lid that the plane cuts closes the body.
  double sum = 0.0, lid = 0.0;
  const ShapeLayout& layout = rock.block().shape().layout();
  for (int f = 0; f < layout.faces; ++f)
  {
    const std::span<const int> loop = layout.loop(f);
    Vec3 area = Vec3::Zero(), first = Vec3::Zero(), last = Vec3::Zero();
    int corners = 0;
    const auto add = [&](const Vec3& p)
    {
      if (corners == 0)
      {
        first = p;
      }
      else if (corners > 1)
      {
        area += (last - first).cross(p - first);
      }
      last = p;
      ++corners;
    };
    for (std::size_t k = 0; k < loop.size(); ++k)
    {
      const std::size_t a = std::size_t(loop[k]);
      const std::size_t b = std::size_t(loop[k + 1 < loop.size() ? k + 1 : 0]);
      if (heights[a] < 0.0)
      {
        add(vertices[a]);
      }
      if ((heights[a] < 0.0) != (heights[b] < 0.0))
      {
        const double t = heights[a] / (heights[a] - heights[b]);
        add(vertices[a] + t * (vertices[b] - vertices[a]));
      }
    }
    const double seen = area.dot(direction);
    sum += std::abs(seen);
    lid -= seen;
  }
  return 0.25 * (sum + std::abs(lid));
}

} // namespace rockfall
