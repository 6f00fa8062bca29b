#include "terrain/Surface.h"

#include "law/settings.h"
#include "terrain/walls.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

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

/// Rows and columns of nodes that a thread remembers, powers of two: 200 kB. Fewer: a rock's way
/// and the ground under it push each other out.
constexpr int kKnownRows = 64, kKnownColumns = 128;

/// A node's height, and of which surface; 0: of none.
struct KnownNode
{
  std::uint64_t surface = 0, node = 0;
  double height = 0.0; ///< m
};

/// The one place in this thread's table where a node may stand: neighbours never share one.
KnownNode& placeOf(int row, int column)
{
  thread_local std::vector<KnownNode> table(std::size_t(kKnownRows) * kKnownColumns);
  return table[std::size_t(row & (kKnownRows - 1)) * kKnownColumns +
    std::size_t(column & (kKnownColumns - 1))];
}

/// Height of a node of a refined grid before its field, m. `surveyed(row, column)` is that of a
/// node of the terrain.
template <typename Surveyed>
double drawnHeight(
  const Surface::Grid& grid, CellDiagonal rule, int row, int column, const Surveyed& surveyed)
{
  // On the triangle of the survey that the node is in; a corner that has no share in it may be
  // nodata. On a side of the cell the cut does not matter.
  const int p = grid.parts, r = row / p, c = column / p, t = row % p, s = column % p;
  if (s == 0 && t == 0)
  {
    return surveyed(r, c);
  }
  const auto share = [&](int weight, int down, int right)
  { return weight == 0 ? 0.0 : double(weight) / p * surveyed(r + down, c + right); };
  if (s > 0 && t > 0 &&
    isCutRising(
      rule, surveyed(r, c), surveyed(r, c + 1), surveyed(r + 1, c), surveyed(r + 1, c + 1)))
  {
    const int over = p - s - t; // of the cut
    return over > 0 ? share(over, 0, 0) + share(t, 1, 0) + share(s, 0, 1)
                    : share(-over, 1, 1) + share(p - s, 1, 0) + share(p - t, 0, 1);
  }
  const bool upper = s > t;
  return share(p - std::max(s, t), 0, 0) + share(std::min(s, t), 1, 1) +
    (upper ? share(s - t, 0, 1) : share(t - s, 1, 0));
}

} // namespace

Surface::Surface(const Terrain& terrain)
  : terrain_(&terrain)
  , grid_{ terrain.geometry().columns, terrain.geometry().rows, terrain.geometry().cellSize, 1 }
{
  this->drawMaterials();
}

std::uint64_t Surface::nextNumber()
{
  static std::atomic<std::uint64_t> made{ 0 };
  return made.fetch_add(1, std::memory_order_relaxed) + 1;
}

Surface Surface::asSurveyed(const Terrain& terrain)
{
  return Surface(terrain);
}

Surface::Surface(const Terrain& terrain, std::uint64_t seed, int iteration)
  : terrain_(&terrain)
  , seed_(seed)
  , iteration_(std::uint32_t(iteration))
  , drawn_(true)
{
  roughnessBound_ = terrain.roughnessHeight();
  const GridGeometry& g = terrain.geometry();
  const int parts = terrain.refinement();
  grid_ = { (g.columns - 1) * parts + 1, (g.rows - 1) * parts + 1, g.cellSize / parts, parts };
  for (int k = 0; k <= terrain.restitutionClasses().count(); ++k)
  {
    const Roughness& r = roughness_.emplace_back(terrain.roughnessOf(k).onNodes(grid_.cellSize));
    rough_ = rough_ || (r.any() && !r.isField());
    field_ = field_ || r.isField();
  }
  this->drawMaterials();
}

const Roughness& Surface::roughnessIn(int row, int column) const
{
  const GridGeometry& g = terrain_->geometry();
  const MaterialClasses& classes = terrain_->restitutionClasses();
  if (classes.roughness.empty() || classes.cells.empty())
  {
    return roughness_.front();
  }
  // A node on a border is of the cell to its south-east.
  const std::size_t cell = std::size_t(std::min(row, g.rows - 2)) * std::size_t(g.columns - 1) +
    std::size_t(std::min(column, g.columns - 2));
  return roughness_[classes.cells[cell]];
}

double Surface::surveyedNode(int row, int column) const
{
  double z = terrain_->nodeHeight(row, column);
  if (rough_)
  {
    const Roughness& r = this->roughnessIn(row, column);
    if (!(r.length > 0.0))
    {
      const std::uint64_t index = std::uint64_t(row) * terrain_->geometry().columns + column;
      z += r.mean + r.deviation * normalDeviate(seed_, iteration_, Draw::Roughness, index);
    }
  }
  return z;
}

double Surface::nodeHeight(int row, int column) const
{
  if (!rough_ && !field_ && grid_.parts == 1)
  {
    return terrain_->nodeHeight(row, column); // nothing to remember
  }
  // A rock asks for the same nodes at every look, and each costs some sixteen deviates of a field
  // or nine obstacles.
  KnownNode& known = placeOf(row, column);
  const std::uint64_t node = std::uint64_t(std::uint32_t(row)) << 32 | std::uint32_t(column);
  if (known.node == node && known.surface == number_)
  {
    return known.height;
  }
  double z = drawnHeight(grid_, terrain_->geometry().diagonal, row, column,
    [this](int r, int c) { return this->surveyedNode(r, c); });
  const Roughness& rough = this->roughnessIn(row / grid_.parts, column / grid_.parts);
  if (field_ && rough.isField())
  {
    const GridGeometry& g = terrain_->geometry();
    z += RoughField{ seed_, iteration_ }.height(g.xOrigin + column * grid_.cellSize,
      g.yOrigin + (grid_.rows - 1 - row) * grid_.cellSize, rough);
  }
  known = { number_, node, z };
  return z;
}

double Surface::elevation(double x, double y) const
{
  if (!rough_ && !field_)
  {
    return terrain_->elevation(x, y);
  }
  const double s = x / grid_.cellSize, t = (grid_.height() - y) / grid_.cellSize;
  if (!(s >= 0.0 && t >= 0.0 && s <= grid_.columns - 1 && t <= grid_.rows - 1))
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const int column = std::min(int(s), grid_.columns - 2), row = std::min(int(t), grid_.rows - 2);
  const double nw = this->nodeHeight(row, column), ne = this->nodeHeight(row, column + 1),
               sw = this->nodeHeight(row + 1, column), se = this->nodeHeight(row + 1, column + 1);
  const bool rising = isCutRising(terrain_->geometry().diagonal, nw, ne, sw, se);
  const bool lower = isInLower(rising, s - column, t - row);
  // The triangle has one side along x, and one along y in the west or in the east.
  const bool west = lower != rising;
  const double alongX = lower ? se - sw : ne - nw, alongY = west ? nw - sw : ne - se;
  const double corner = lower ? (west ? sw : se) : (west ? nw : ne);
  return corner + alongX * (s - column - (west ? 0.0 : 1.0)) -
    alongY * (t - row - (lower ? 1.0 : 0.0));
}

namespace
{

/// The nodes of a patch whose rows and columns are known; beyond the edge they are an apron.
void layNodes(const Surface& surface, SurfacePatch& patch)
{
  const Surface::Grid& g = surface.grid();
  patch.nodes.resize(std::size_t(patch.nodeColumns) * patch.nodeRows);
  for (int r = 0; r < patch.nodeRows; ++r)
  {
    const int row = patch.row0 + r;
    SurfacePatch::Node* node = &patch.nodes[std::size_t(r) * patch.nodeColumns];
    for (int c = 0; c < patch.nodeColumns; ++c, ++node)
    {
      const int column = patch.column0 + c;
      node->position = { column * g.cellSize, (g.rows - 1 - row) * g.cellSize,
        surface.apronHeight(row, column) };
      node->key = gridKey(row, column);
      node->cfe = 0;
      node->peak = node->firm = false;
    }
  }
}

/// Two slots per cell; a slot whose triangle touches nodata is marked by cfe = 0.
void layTriangles(const Surface& surface, SurfacePatch& patch)
{
  const Surface::Grid& g = surface.grid();
  const CellDiagonal rule = surface.terrain().geometry().diagonal;
  const int cellColumns = patch.nodeColumns - 1, cellRows = patch.nodeRows - 1;
  const int below = 2 * cellColumns;
  patch.triangles.resize(2 * std::size_t(cellColumns) * cellRows);
  for (int r = 0; r < cellRows; ++r)
  {
    for (int c = 0; c < cellColumns; ++c)
    {
      const int upperLeft = r * patch.nodeColumns + c;
      const int lowerLeft = upperLeft + patch.nodeColumns;
      const int lower = 2 * (r * cellColumns + c);
      const int row = std::clamp(patch.row0 + r, 0, g.rows - 2);
      const int column = std::clamp(patch.column0 + c, 0, g.columns - 2);
      const std::int64_t key = 2 * gridKey(patch.row0 + r, patch.column0 + c);
      const double zUpperLeft = patch.nodes[upperLeft].position.z();
      const double zLowerLeft = patch.nodes[lowerLeft].position.z();
      const double zUpperRight = patch.nodes[upperLeft + 1].position.z();
      const double zLowerRight = patch.nodes[lowerLeft + 1].position.z();
      const bool rising = isCutRising(rule, zUpperLeft, zUpperRight, zLowerLeft, zLowerRight);
      // Edges of the lower triangle: west, south, diagonal; of the upper: diagonal, east, north.
      // Where the cut rises: diagonal, south, east; west, diagonal, north.
      SurfacePatch::Triangle* t = &patch.triangles[lower];
      const int south = r + 1 < cellRows ? lower + below + 1 : -1,
                north = r > 0 ? lower - below : -1;
      if (rising)
      {
        t[0].nodes = { upperLeft + 1, lowerLeft, lowerLeft + 1 };
        t[0].neighbours = { lower + 1, south, -1 };
        t[1].nodes = { upperLeft, lowerLeft, upperLeft + 1 };
        t[1].neighbours = { -1, lower, north };
      }
      else
      {
        t[0].nodes = { upperLeft, lowerLeft, lowerLeft + 1 };
        t[0].neighbours = { -1, south, lower + 1 };
        t[1].nodes = { upperLeft, lowerLeft + 1, upperLeft + 1 };
        t[1].neighbours = { lower, -1, north };
      }
      if (c > 0)
      {
        const bool before = t[-1].rising;
        t[rising].neighbours[0] = before ? lower - 2 : lower - 1;
        t[before ? -2 : -1].neighbours[before ? 2 : 1] = lower + rising;
      }
      const double west = zLowerLeft - zUpperLeft, east = zLowerRight - zUpperRight;
      const Vec3 up[2] = {
        { zLowerLeft - zLowerRight, rising ? east : west, g.cellSize },
        { zUpperLeft - zUpperRight, rising ? west : east, g.cellSize },
      };
      for (int k = 0; k < 2; ++k)
      {
        t[k].normal = up[k] * (1.0 / std::sqrt(up[k].squaredNorm()));
        t[k].offset = t[k].normal.dot(patch.nodes[t[k].nodes[0]].position);
        t[k].cfe = std::isnan(t[k].offset) ? 0 : surface.cfeOf(row, column, k == 1);
        t[k].key = key + k;
        t[k].rising = rising;
        t[k].firm = false;
        t[k].bends.fill(0);
        t[k].ridges.fill(-1);
        for (int n : t[k].nodes)
        {
          patch.nodes[n].cfe = std::max(patch.nodes[n].cfe, t[k].cfe);
        }
      }
    }
  }
}

/// Bends, ridges and the rims of holes.
std::vector<Rim> findRidges(SurfacePatch& patch)
{
  std::vector<Rim> rims;
  // Every inner edge is the west, the south or the diagonal of one cell: side k of its triangle i,
  // and side `back` of the triangle beyond it.
  for (int cell = 0; cell < int(patch.triangles.size()); cell += 2)
  {
    const bool rising = patch.triangles[cell].rising;
    for (int edge = 0; edge < 3; ++edge)
    {
      const int i = edge == 0 && rising ? cell + 1 : cell;
      const int k = edge == 2 && rising ? 0 : edge;
      SurfacePatch::Triangle& t = patch.triangles[i];
      const int j = t.neighbours[k];
      if (j < 0)
      {
        continue;
      }
      SurfacePatch::Triangle& other = patch.triangles[j];
      const int back = edge == 0 ? (other.rising ? 2 : 1) : edge == 1 ? 2 : (rising ? 1 : 0);
      if (t.cfe == 0 || other.cfe == 0)
      {
        t.neighbours[k] = -1;
        other.neighbours[back] = -1;
        if (t.cfe != 0 || other.cfe != 0)
        {
          rims.push_back(t.cfe != 0 ? Rim{ i, k } : Rim{ j, back });
        }
        continue;
      }
      const int wing = other.nodes[(back + 2) % 3];
      t.bends[k] = other.bends[back] = SurfacePatch::bendOf(
        t.normal, patch.nodes[wing].position - patch.nodes[t.nodes[k]].position);
      if (t.bends[k] > 0)
      {
        patch.triangles[cell].ridges[edge] = int(patch.ridges.size());
        patch.ridges.push_back({ { t.nodes[k], t.nodes[(k + 1) % 3] }, { i, j },
          { t.nodes[(k + 2) % 3], wing }, SurfacePatch::sideKey(t, k) });
      }
    }
  }
  return rims;
}

/// Nodes on a ridge that have all their neighbours, four to eight, in the patch.
void findPeaks(SurfacePatch& patch)
{
  const int nodeColumns = patch.nodeColumns, nodeRows = patch.nodeRows;
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
      const auto isRising = [&](int row, int column)
      { return patch.triangles[2 * (row * (nodeColumns - 1) + column)].rising; };
      node.neighbours.fill(n - 1);
      node.neighbours[1] = n + 1;
      node.neighbours[2] = n - nodeColumns;
      node.neighbours[3] = n + nodeColumns;
      node.neighbours[4] = isRising(r - 1, c - 1) ? n - 1 : n - nodeColumns - 1;
      node.neighbours[5] = isRising(r, c) ? n - 1 : n + nodeColumns + 1;
      node.neighbours[6] = isRising(r - 1, c) ? n - nodeColumns + 1 : n - 1;
      node.neighbours[7] = isRising(r, c - 1) ? n + nodeColumns - 1 : n - 1;
      node.peak = std::none_of(node.neighbours.begin(), node.neighbours.end(),
        [&](int m) { return std::isnan(patch.nodes[m].position.z()); });
    }
  }
}

} // namespace

void gatherPatch(
  const Surface& surface, double xMin, double xMax, double yMin, double yMax, SurfacePatch& patch)
{
  const Surface::Grid& g = surface.grid();
  patch.ridges.clear();
  const double inverse = 1.0 / g.cellSize;
  const double north = g.height();
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
    patch.nodes.clear();
    patch.triangles.clear();
    return;
  }
  // The ring makes the neighbours of every edge and node under the rock known. Beyond its edge the
  // slope goes on as an apron, so that a rock that stands half over the edge is carried as on
  // ground, and slides on where it slid; it has left when its centroid has.
  const int column0 = wantColumn0 - 1, column1 = wantColumn1 + 1;
  const int row0 = wantRow0 - 1, row1 = wantRow1 + 1;
  patch.row0 = row0, patch.row1 = row1, patch.column0 = column0, patch.column1 = column1;
  patch.nodeColumns = column1 - column0 + 2;
  patch.nodeRows = row1 - row0 + 2;
  patch.west = column0 * g.cellSize;
  patch.north = (g.rows - 1 - row0) * g.cellSize;
  patch.cellSize = g.cellSize;
  layNodes(surface, patch);
  layTriangles(surface, patch);
  const std::vector<Rim> rims = findRidges(patch);
  findPeaks(patch);
  patch.slopeNodes = int(patch.nodes.size());
  patch.slopeTriangles = int(patch.triangles.size());
  patch.slopeRidges = int(patch.ridges.size());
  addWalls(rims, patch);
}

} // namespace rockfall
