#include "base/abort.h"
#include "geometry/planeSampling.h"
#include "run/releasePlaces.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace rockfall
{

namespace
{

/// Of a convex polygon, counter-clockwise, in the terrain's local frame, m.
using Corners = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// What of it lies to the left of the line from `a` to `b`.
Corners leftOf(const Corners& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  Corners left;
  for (std::size_t k = 0; k < polygon.size(); ++k)
  {
    const Eigen::Vector2d &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double ofP = cross(b - a, p - a), ofQ = cross(b - a, q - a);
    if (ofP >= 0.0)
    {
      left.push_back(p);
    }
    if ((ofP > 0.0 && ofQ < 0.0) || (ofP < 0.0 && ofQ > 0.0))
    {
      left.push_back(p + ofP / (ofP - ofQ) * (q - p));
    }
  }
  return left;
}

Corners within(Corners polygon, const Corners& other)
{
  for (std::size_t k = 0; k < other.size() && !polygon.empty(); ++k)
  {
    polygon = leftOf(polygon, other[k], other[(k + 1) % other.size()]);
  }
  return polygon;
}

double areaOf(const Corners& polygon)
{
  double twice = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k)
  {
    twice += cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
  }
  return std::max(0.0, 0.5 * twice);
}

/// Area of a polygon within the grid's outline under which there is no CFE.
double areaOfGaps(const Corners& polygon, const Terrain& terrain)
{
  const GridGeometry& grid = terrain.geometry();
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : polygon)
  {
    box.extend(corner);
  }
  const auto cellOf = [&grid](double along, int nodes)
  { return std::clamp(int(along / grid.cellSize), 0, nodes - 2); };
  const int west = cellOf(box.min().x(), grid.columns), east = cellOf(box.max().x(), grid.columns);
  const int north = cellOf(terrain.height() - box.max().y(), grid.rows);
  const int south = cellOf(terrain.height() - box.min().y(), grid.rows);
  double area = 0.0;
  for (int row = north; row <= south; ++row)
  {
    stayWanted();
    const std::int64_t before = std::int64_t(row) * (grid.columns - 1);
    for (std::int64_t cfe = 2 * (before + west) + 1; cfe <= 2 * (before + east) + 2; ++cfe)
    {
      if (!terrain.hasCfe(cfe))
      {
        const auto nodes = terrain.cfe(cfe).nodes;
        area +=
          areaOf(within(polygon, { nodes[0].head<2>(), nodes[1].head<2>(), nodes[2].head<2>() }));
      }
    }
  }
  return area;
}

} // namespace

double areaOnTerrain(const SourceRow& polygon, const Terrain* terrain)
{
  const PolygonSampler whole(polygon.parts);
  if (!terrain)
  {
    return whole.area();
  }
  const Eigen::Vector2d origin = terrain->geometry().origin().head<2>();
  const double x = terrain->width(), y = terrain->height();
  const Corners outline = { { 0.0, 0.0 }, { x, 0.0 }, { x, y }, { 0.0, y } };
  double area = 0.0;
  for (const auto& piece : whole.pieces())
  {
    Corners local;
    for (const Eigen::Vector2d& corner : piece)
    {
      local.push_back(corner - origin);
    }
    local = within(local, outline);
    if (!local.empty())
    {
      area += std::max(0.0, areaOf(local) - areaOfGaps(local, *terrain));
    }
  }
  return area;
}

} // namespace rockfall
