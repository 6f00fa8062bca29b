#include "terrain/Surface.h"

#include "base/random.h"
#include "terrain/Obstacles.h"
#include "terrain/walls.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// A number for a node or cell, also for those of the apron.
constexpr std::int64_t gridKey(int row, int column)
{
  constexpr std::int64_t apron = 1 << 20;
  return ((row + apron) << 32) + column + apron;
}

/// The mean, or the number of a realisation if there is one to draw it for.
struct Realisation
{
  std::uint64_t seed;
  std::uint32_t iteration;
  bool drawn;

  double restitution(const SurfaceMaterial& m, int number) const
  {
    if (!drawn || !(m.restitutionDeviation > 0.0))
    {
      return m.restitution;
    }
    const double deviate = normalDeviate(seed, iteration, Draw::Restitution, std::uint64_t(number));
    return std::clamp(m.restitution + m.restitutionDeviation * deviate, 0.0, 1.0);
  }
  double friction(const SurfaceMaterial& m, int number) const
  {
    if (!drawn || !(m.frictionAngleDeviation > 0.0))
    {
      return std::tan(m.frictionAngle);
    }
    const double deviate =
      normalDeviate(seed, iteration, Draw::FrictionAngle, std::uint64_t(number));
    const double angle = m.frictionAngle + m.frictionAngleDeviation * deviate;
    return std::tan(std::clamp(angle, 0.0, radians(89.0)));
  }
};

} // namespace

Surface::Surface(const Terrain& terrain)
  : terrain_(&terrain)
{
  this->drawMaterials(false);
}

Surface Surface::asSurveyed(const Terrain& terrain)
{
  return Surface(terrain);
}

Surface::Surface(const Terrain& terrain, std::uint64_t seed, int iteration)
  : terrain_(&terrain)
  , seed_(seed)
  , iteration_(std::uint32_t(iteration))
{
  const Roughness& r = terrain.roughness();
  rough_ = r.any();
  roughnessBound_ = rough_ ? std::max(0.0, r.mean + largestDeviate * r.deviation) : 0.0;
  this->drawMaterials(true);
}

void Surface::drawMaterials(bool drawn)
{
  const Realisation realisation{ seed_, iteration_, drawn };
  restitution_ = realisation.restitution(terrain_->material(), 0);
  friction_ = realisation.friction(terrain_->material(), 0);
  const Obstacles* const obstacles = terrain_->obstacles();
  const int built = obstacles ? int(obstacles->structures().materials.size()) : 0;
  for (int k = 1; k <= terrain_->restitutionClasses().count() + built; ++k)
  {
    restitutions_.push_back(realisation.restitution(terrain_->restitutionMaterial(k), k));
  }
  for (int k = 1; k <= terrain_->jointClasses().count() + built; ++k)
  {
    frictions_.push_back(realisation.friction(terrain_->jointMaterial(k), k));
  }
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

void SurfacePatch::findTop()
{
  // As steep as between its corners.
  const auto z = [&](int row, int column)
  { return nodes[std::size_t(row) * nodeColumns + column].position.z(); };
  const int r = nodeRows - 1, c = nodeColumns - 1;
  tilt.x() = 0.5 * (z(0, c) + z(r, c) - z(0, 0) - z(r, 0)) / (c * cellSize);
  tilt.y() = 0.5 * (z(0, 0) + z(0, c) - z(r, 0) - z(r, c)) / (r * cellSize);
  if (!tilt.allFinite())
  {
    tilt.setZero();
  }
  highest = -std::numeric_limits<double>::infinity();
  for (const Node& node : nodes)
  {
    const double height = node.position.z() - tilt.dot(node.position.head<2>());
    highest = height > highest ? height : highest; // not over holes
  }
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
  const auto cell = [&](double v) { return int(std::floor(std::clamp(v * inverse, -1e6, 2e9))); };
  const int wantColumn0 = cell(xMin), wantColumn1 = cell(xMax);
  const int wantRow0 = cell(north - yMax), wantRow1 = cell(north - yMin);
  patch.xMin = wantColumn0 * g.cellSize;
  patch.xMax = (wantColumn1 + 1) * g.cellSize;
  patch.yMax = north - wantRow0 * g.cellSize;
  patch.yMin = north - (wantRow1 + 1) * g.cellSize;
  patch.nodeColumns = patch.nodeRows = 0;
  patch.row0 = patch.column0 = 0;
  patch.row1 = patch.column1 = -1;
  patch.slopeNodes = patch.slopeTriangles = patch.slopeRidges = patch.wallTriangles = 0;
  if (wantColumn1 < 0 || wantColumn0 > g.columns - 2 || wantRow1 < 0 || wantRow0 > g.rows - 2)
  {
    return;
  }
  // The ring makes the neighbours of every edge and node under the rock known. Beyond its edge the
  // slope goes on as an apron, so that a rock that stands half over the edge is carried as on
  // ground, and slides on where it slid; it has left when its centroid has.
  const int column0 = wantColumn0 - 1, column1 = wantColumn1 + 1;
  const int row0 = wantRow0 - 1, row1 = wantRow1 + 1;
  patch.row0 = row0, patch.row1 = row1, patch.column0 = column0, patch.column1 = column1;
  const int nodeColumns = column1 - column0 + 2;
  const int nodeRows = row1 - row0 + 2;
  patch.nodeColumns = nodeColumns;
  patch.nodeRows = nodeRows;
  patch.west = column0 * g.cellSize;
  patch.north = (g.rows - 1 - row0) * g.cellSize;
  patch.cellSize = g.cellSize;
  patch.nodes.resize(std::size_t(nodeColumns) * nodeRows);
  for (int r = 0; r < nodeRows; ++r)
  {
    const int row = row0 + r;
    SurfacePatch::Node* node = &patch.nodes[std::size_t(r) * nodeColumns];
    for (int c = 0; c < nodeColumns; ++c, ++node)
    {
      const int column = column0 + c;
      node->position = { column * g.cellSize, (g.rows - 1 - row) * g.cellSize,
        surface.apronHeight(row, column) };
      node->key = gridKey(row, column);
      node->cfe = 0;
      node->peak = false;
    }
  }
  patch.findTop();
  const int cellColumns = column1 - column0 + 1;
  const int cellRows = row1 - row0 + 1;
  const int below = 2 * cellColumns;
  // Two slots per cell; a slot whose triangle touches nodata is marked by cfe = 0.
  patch.triangles.resize(2 * std::size_t(cellColumns) * cellRows);
  for (int r = 0; r < cellRows; ++r)
  {
    for (int c = 0; c < cellColumns; ++c)
    {
      const int upperLeft = r * nodeColumns + c;
      const int lowerLeft = upperLeft + nodeColumns;
      const int lower = 2 * (r * cellColumns + c);
      const int row = std::clamp(row0 + r, 0, g.rows - 2);
      const int column = std::clamp(column0 + c, 0, g.columns - 2);
      const std::int64_t id = 2 * (std::int64_t(row) * (g.columns - 1) + column) + 1;
      const std::int64_t key = 2 * gridKey(row0 + r, column0 + c);
      // Edges of the lower triangle: west, south, diagonal; of the upper: diagonal, east, north.
      SurfacePatch::Triangle* t = &patch.triangles[lower];
      t[0].nodes = { upperLeft, lowerLeft, lowerLeft + 1 };
      t[0].neighbours = { c > 0 ? lower - 1 : -1, r + 1 < cellRows ? lower + below + 1 : -1,
        lower + 1 };
      t[1].nodes = { upperLeft, lowerLeft + 1, upperLeft + 1 };
      t[1].neighbours = { lower, c + 1 < cellColumns ? lower + 2 : -1, r > 0 ? lower - below : -1 };
      const double zUpperLeft = patch.nodes[upperLeft].position.z();
      const double zLowerLeft = patch.nodes[lowerLeft].position.z();
      const double zUpperRight = patch.nodes[upperLeft + 1].position.z();
      const double zLowerRight = patch.nodes[lowerLeft + 1].position.z();
      const Vec3 up[2] = {
        { zLowerLeft - zLowerRight, zLowerLeft - zUpperLeft, g.cellSize },
        { zUpperLeft - zUpperRight, zLowerRight - zUpperRight, g.cellSize },
      };
      for (int k = 0; k < 2; ++k)
      {
        t[k].normal = up[k] * (1.0 / std::sqrt(up[k].squaredNorm()));
        t[k].offset = t[k].normal.dot(patch.nodes[upperLeft].position);
        t[k].cfe = std::isnan(t[k].offset) ? 0 : id + k;
        t[k].key = key + k;
        t[k].bends.fill(0);
        t[k].ridges.fill(-1);
        for (int n : t[k].nodes)
        {
          patch.nodes[n].cfe = std::max(patch.nodes[n].cfe, t[k].cfe);
        }
      }
    }
  }
  std::vector<Rim> rims;
  // Bends and ridges. Every inner edge is a side of one lower triangle (odd number): `back` is the
  // same edge in the upper triangle beyond it.
  constexpr int back[3] = { 1, 2, 0 };
  for (int i = 0; i < int(patch.triangles.size()); i += 2)
  {
    SurfacePatch::Triangle& t = patch.triangles[i];
    for (int k = 0; k < 3; ++k)
    {
      const int j = t.neighbours[k];
      if (j < 0)
      {
        continue;
      }
      SurfacePatch::Triangle& other = patch.triangles[j];
      if (t.cfe == 0 || other.cfe == 0)
      {
        t.neighbours[k] = -1;
        other.neighbours[back[k]] = -1;
        if (t.cfe != 0 || other.cfe != 0)
        {
          rims.push_back(t.cfe != 0 ? Rim{ i, k } : Rim{ j, back[k] });
        }
        continue;
      }
      const int wing = other.nodes[(back[k] + 2) % 3];
      // Depth of the other triangle's wing below this plane, per its distance.
      const Vec3 arm = patch.nodes[wing].position - patch.nodes[t.nodes[k]].position;
      const double drop = -t.normal.dot(arm);
      const bool flat = drop * drop <= flatBend * flatBend * arm.squaredNorm();
      const signed char sign = flat ? 0 : (drop > 0.0 ? 1 : -1);
      t.bends[k] = sign;
      other.bends[back[k]] = sign;
      if (sign > 0)
      {
        // Three edges belong to a lower triangle: that and the side make the key.
        t.ridges[k] = int(patch.ridges.size());
        patch.ridges.push_back({ { t.nodes[k], t.nodes[(k + 1) % 3] }, { i, j },
          { t.nodes[(k + 2) % 3], wing }, 3 * t.key + k });
      }
    }
  }
  // Upper triangles beside holes, over the edges of the patch.
  for (int i = 1; i < int(patch.triangles.size()); i += 2)
  {
    SurfacePatch::Triangle& t = patch.triangles[i];
    if (t.cfe == 0)
    {
      t.neighbours.fill(-1);
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
  patch.slopeNodes = int(patch.nodes.size());
  patch.slopeTriangles = int(patch.triangles.size());
  patch.slopeRidges = int(patch.ridges.size());
  addWalls(rims, patch);
}

} // namespace rockfall
