#include "terrain/Surface.h"

#include "base/random.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Edges that bend by less than this (sine of the angle) are flat. It is above the rounding of a
/// plane's node heights (1e-12) and below any slope that a survey can tell.
constexpr double flatBend = 1e-7;

} // namespace

Surface::Surface(const Terrain& terrain)
  : terrain_(&terrain)
  , restitution_(terrain.material().restitution)
  , friction_(std::tan(terrain.material().frictionAngle))
{
}

Surface Surface::asSurveyed(const Terrain& terrain)
{
  return Surface(terrain);
}

Surface::Surface(const Terrain& terrain, std::uint64_t seed, int iteration)
  : Surface(terrain)
{
  seed_ = seed;
  iteration_ = std::uint32_t(iteration);
  const SurfaceMaterial& m = terrain.material();
  const Roughness& r = terrain.roughness();
  rough_ = r.any();
  roughnessBound_ = rough_ ? std::max(0.0, r.mean + largestDeviate * r.deviation) : 0.0;
  if (m.restitutionDeviation > 0.0)
  {
    restitution_ += m.restitutionDeviation * normalDeviate(seed_, iteration_, Draw::Restitution, 0);
    restitution_ = std::clamp(restitution_, 0.0, 1.0);
  }
  double angle = m.frictionAngle;
  if (m.frictionAngleDeviation > 0.0)
  {
    angle += m.frictionAngleDeviation * normalDeviate(seed_, iteration_, Draw::FrictionAngle, 0);
    angle = std::clamp(angle, 0.0, radians(89.0));
  }
  friction_ = std::tan(angle);
}

double Surface::nodeHeight(int row, int column) const
{
  double z = terrain_->nodeHeight(row, column);
  if (rough_)
  {
    const std::uint64_t index = std::uint64_t(row) * terrain_->geometry().columns + column;
    const Roughness& r = terrain_->roughness();
    z += r.mean + r.deviation * normalDeviate(seed_, iteration_, Draw::Roughness, index);
  }
  return z;
}

double Surface::elevation(double x, double y) const
{
  if (!rough_)
  {
    return terrain_->elevation(x, y);
  }
  const std::int64_t id = terrain_->cfeAt(x, y);
  if (id == 0)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const int columns = terrain_->geometry().columns;
  std::array<Vec3, 3> p;
  const auto nodes = terrain_->cfeNodes(id);
  for (int k = 0; k < 3; ++k)
  {
    const int row = int(nodes[k] / columns);
    const int column = int(nodes[k] % columns);
    p[k] = terrain_->node(row, column);
    p[k].z() = this->nodeHeight(row, column);
  }
  const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]);
  return p[0].z() - (n.x() * (x - p[0].x()) + n.y() * (y - p[0].y())) / n.z();
}

void gatherPatch(
  const Surface& surface, double xMin, double xMax, double yMin, double yMax, SurfacePatch& patch)
{
  const Terrain& terrain = surface.terrain();
  const GridGeometry& g = terrain.geometry();
  patch.nodes.clear();
  patch.triangles.clear();
  patch.ridges.clear();
  const double inverse = 1.0 / g.cellSize;
  const double north = terrain.height();
  const auto cell = [&](double v) { return int(std::floor(std::clamp(v * inverse, -4.0, 2e9))); };
  const int wantColumn0 = cell(xMin), wantColumn1 = cell(xMax);
  const int wantRow0 = cell(north - yMax), wantRow1 = cell(north - yMin);
  patch.xMin = wantColumn0 * g.cellSize;
  patch.xMax = (wantColumn1 + 1) * g.cellSize;
  patch.yMax = north - wantRow0 * g.cellSize;
  patch.yMin = north - (wantRow1 + 1) * g.cellSize;
  // The ring makes the neighbours of every edge and node under the rock known.
  const int column0 = std::max(wantColumn0 - 1, 0),
            column1 = std::min(wantColumn1 + 1, g.columns - 2);
  const int row0 = std::max(wantRow0 - 1, 0), row1 = std::min(wantRow1 + 1, g.rows - 2);
  patch.row0 = row0, patch.row1 = row1, patch.column0 = column0, patch.column1 = column1;
  if (column1 < column0 || row1 < row0)
  {
    return;
  }
  const int nodeColumns = column1 - column0 + 2;
  const int nodeRows = row1 - row0 + 2;
  patch.nodes.resize(std::size_t(nodeColumns) * nodeRows);
  for (int r = 0; r < nodeRows; ++r)
  {
    for (int c = 0; c < nodeColumns; ++c)
    {
      SurfacePatch::Node& node = patch.nodes[std::size_t(r) * nodeColumns + c];
      const int row = row0 + r, column = column0 + c;
      node.position = { column * g.cellSize, (g.rows - 1 - row) * g.cellSize,
        surface.nodeHeight(row, column) };
      node.key = std::int64_t(row) * g.columns + column;
      node.cfe = 0;
      node.peak = false;
      node.neighbours.fill(-1);
    }
  }
  const int cellColumns = column1 - column0 + 1;
  const int cellRows = row1 - row0 + 1;
  patch.nodeColumns = nodeColumns;
  patch.nodeRows = nodeRows;
  patch.cellSize = g.cellSize;
  // Two slots per cell; a slot whose triangle touches nodata is marked by cfe = 0.
  patch.triangles.resize(2 * std::size_t(cellColumns) * cellRows);
  for (int r = 0; r < cellRows; ++r)
  {
    for (int c = 0; c < cellColumns; ++c)
    {
      const int upperLeft = r * nodeColumns + c;
      const int lowerLeft = upperLeft + nodeColumns;
      const int lower = 2 * (r * cellColumns + c);
      const std::int64_t id = 2 * (std::int64_t(row0 + r) * (g.columns - 1) + column0 + c) + 1;
      // Edges of the lower triangle: west, south, diagonal; of the upper: diagonal, east, north.
      SurfacePatch::Triangle* t = &patch.triangles[lower];
      t[0].nodes = { upperLeft, lowerLeft, lowerLeft + 1 };
      t[0].neighbours = { c > 0 ? lower - 1 : -1,
        r + 1 < cellRows ? lower + 2 * cellColumns + 1 : -1, lower + 1 };
      t[1].nodes = { upperLeft, lowerLeft + 1, upperLeft + 1 };
      t[1].neighbours = { lower, c + 1 < cellColumns ? lower + 2 : -1,
        r > 0 ? lower + 1 - 2 * cellColumns - 1 : -1 };
      for (int k = 0; k < 2; ++k)
      {
        const Vec3& a = patch.nodes[t[k].nodes[0]].position;
        const Vec3& b = patch.nodes[t[k].nodes[1]].position;
        const Vec3& d = patch.nodes[t[k].nodes[2]].position;
        t[k].normal = (b - a).cross(d - a).normalized();
        t[k].offset = t[k].normal.dot(a);
        t[k].cfe = std::isnan(t[k].offset) ? 0 : id + k;
        t[k].bends.fill(0);
        for (int n : t[k].nodes)
        {
          patch.nodes[n].cfe = std::max(patch.nodes[n].cfe, t[k].cfe);
        }
      }
    }
  }
  // The spread of the gradients.
  patch.highest = -std::numeric_limits<double>::infinity();
  for (const SurfacePatch::Node& node : patch.nodes)
  {
    patch.highest = std::fmax(patch.highest, node.position.z());
  }
  const auto gradient = [](const Vec3& n) { return Eigen::Vector2d(-n.head<2>() / n.z()); };
  patch.tilt.setZero();
  int known = 0;
  for (const SurfacePatch::Triangle& t : patch.triangles)
  {
    if (t.cfe != 0)
    {
      patch.tilt += gradient(t.normal);
      ++known;
    }
  }
  patch.tilt /= std::max(known, 1);
  double relief = 0.0;
  for (const SurfacePatch::Triangle& t : patch.triangles)
  {
    if (t.cfe != 0)
    {
      relief = std::max(relief, (gradient(t.normal) - patch.tilt).squaredNorm());
    }
  }
  patch.relief = std::sqrt(relief);
  // Bends and ridges; each inner edge is met twice, taken from the triangle with the smaller index.
  for (int i = 0; i < int(patch.triangles.size()); ++i)
  {
    SurfacePatch::Triangle& t = patch.triangles[i];
    for (int k = 0; k < 3; ++k)
    {
      const int j = t.neighbours[k];
      if (j >= 0 && (t.cfe == 0 || patch.triangles[j].cfe == 0))
      {
        t.neighbours[k] = -1;
      }
      if (t.neighbours[k] < 0 || j < i)
      {
        continue;
      }
      SurfacePatch::Triangle& other = patch.triangles[j];
      int back = 0;
      while (back < 2 && other.neighbours[back] != i)
      {
        ++back;
      }
      const int wing = other.nodes[(back + 2) % 3];
      const Vec3& p = patch.nodes[t.nodes[k]].position;
      // Depth of the other triangle's wing below this plane, per its distance.
      const Vec3 arm = patch.nodes[wing].position - p;
      const double bend = -t.normal.dot(arm) / arm.norm();
      const signed char sign = bend > flatBend ? 1 : (bend < -flatBend ? -1 : 0);
      t.bends[k] = sign;
      other.bends[back] = sign;
      if (sign > 0)
      {
        const int n0 = t.nodes[k], n1 = t.nodes[(k + 1) % 3];
        // Three edges belong to a cell: told apart by which triangle and side they are.
        patch.ridges.push_back(
          { { n0, n1 }, { i, j }, { t.nodes[(k + 2) % 3], wing }, 3 * t.cfe + k });
      }
    }
  }
  // Peaks: nodes on a ridge that have all their six neighbours in the patch.
  for (const SurfacePatch::Ridge& ridge : patch.ridges)
  {
    for (int n : ridge.nodes)
    {
      const int r = n / nodeColumns, c = n % nodeColumns;
      SurfacePatch::Node& node = patch.nodes[n];
      if (node.peak || r == 0 || c == 0 || r + 1 == nodeRows || c + 1 == nodeColumns)
      {
        continue;
      }
      // The diagonals run from upper left to lower right.
      node.neighbours = { n - 1, n + 1, n - nodeColumns, n + nodeColumns, n - nodeColumns - 1,
        n + nodeColumns + 1 };
      node.peak = std::none_of(node.neighbours.begin(), node.neighbours.end(),
        [&](int m) { return std::isnan(patch.nodes[m].position.z()); });
    }
  }
}

} // namespace rockfall
