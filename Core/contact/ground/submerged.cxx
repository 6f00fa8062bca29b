#include "contact/ground/submerged.h"

#include "contact/ground/roundContact.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rockfall
{

Submerged submerged(const PlacedBlock& rock, const Plane& plane, const Vec3& direction)
{
  /// A corner as seen along the direction, m.
  struct SeenCorner
  {
    double height, x, y;
  };
  // All in the rock's own axes: its corners need not be placed.
  const Vec3 across = direction.unitOrthogonal();
  Mat3 axes; // rows: up from the plane, and two across the direction
  axes.row(0) = plane.normal.transpose() * rock.map();
  axes.row(1) = across.transpose() * rock.map();
  axes.row(2) = direction.cross(across).transpose() * rock.map();
  const double offset = plane.offset - plane.normal.dot(rock.position());
  const std::vector<Vec3>& vertices = rock.block().shape().vertices();
  thread_local std::vector<SeenCorner> corners;
  corners.resize(vertices.size());
  Submerged result;
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    const Vec3 seen = axes * vertices[v];
    corners[v] = { seen[0] - offset, seen[1], seen[2] };
    result.lowest = std::min(result.lowest, corners[v].height);
  }
  if (isRound(rock))
  {
    result.lowest = -offset - roundReach(roundAxes(rock), plane.normal); // its area is the mesh's
  }
  if (!(result.lowest < 0.0))
  {
    return result;
  }
  // Twice the areas, as seen along the direction. The lid that the plane cuts closes the body.
  double sum = 0.0, lid = 0.0;
  const ShapeLayout& layout = rock.block().shape().layout();
  for (int f = 0; f < layout.faces; ++f)
  {
    const std::span<const int> loop = layout.loop(f);
    if (std::ranges::none_of(loop, [&](int v) { return corners[std::size_t(v)].height < 0.0; }))
    {
      continue; // most of a rock is over the surface
    }
    double seen = 0.0, firstX = 0.0, firstY = 0.0, lastX = 0.0, lastY = 0.0;
    bool any = false;
    const auto add = [&](double x, double y)
    {
      if (any)
      {
        seen += lastX * y - x * lastY;
      }
      else
      {
        firstX = x, firstY = y;
        any = true;
      }
      lastX = x, lastY = y;
    };
    const SeenCorner* a = &corners[std::size_t(loop.back())];
    for (const int next : loop)
    {
      const SeenCorner* b = &corners[std::size_t(next)];
      if ((a->height < 0.0) != (b->height < 0.0))
      {
        const double t = a->height / (a->height - b->height);
        add(a->x + t * (b->x - a->x), a->y + t * (b->y - a->y));
      }
      if (b->height < 0.0)
      {
        add(b->x, b->y);
      }
      a = b;
    }
    if (any)
    {
      seen += lastX * firstY - firstX * lastY;
      sum += std::abs(seen);
      lid -= seen;
    }
  }
  result.area = 0.25 * (sum + std::abs(lid));
  return result;
}

} // namespace rockfall
