#include "terrain/walls.h"

#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Keys of the slope's features are below, those of obstacles above.
constexpr std::int64_t firstWallKey = std::int64_t(1) << 58;

/// The side at which a fan of triangles around the end of `rim` ends in the next rim; its triangle
/// is −1 if that is not in the patch.
Rim nextRim(const SurfacePatch& patch, Rim rim)
{
  const int node = patch.triangles[rim.triangle].nodes[(rim.side + 1) % 3];
  for (int turn = 0; turn < 8; ++turn)
  {
    rim.side = (rim.side + 1) % 3;
    const int beyond = patch.triangles[rim.triangle].neighbours[rim.side];
    if (beyond < 0)
    {
      return { -1, 0 };
    }
    if (beyond >= patch.slopeTriangles)
    {
      return rim;
    }
    rim.triangle = beyond;
    const std::array<int, 3>& nodes = patch.triangles[beyond].nodes;
    rim.side = int(std::find(nodes.begin(), nodes.end(), node) - nodes.begin() + 2) % 3;
  }
  return { -1, 0 };
}

/// Makes a node of a rim a peak, if all around it is in the patch.
void makePeak(int n, int bottom, SurfacePatch& patch)
{
  const int columns = patch.nodeColumns, r = n / columns, c = n % columns;
  SurfacePatch::Node& node = patch.nodes[n];
  if (r == 0 || c == 0 || r + 1 == patch.nodeRows || c + 1 == columns)
  {
    return;
  }
  // At least one of those around has no height. Where there are fewer, the bottom again.
  node.peak = true;
  node.neighbours.fill(bottom);
  int count = 0;
  const int cell = 2 * (r * (columns - 1) + c), above = cell - 2 * (columns - 1);
  for (const int i : { cell, cell + 1, cell - 1, cell - 2, above, above + 1, above - 1, above - 2 })
  {
    const SurfacePatch::Triangle& t = patch.triangles[i];
    if (std::find(t.nodes.begin(), t.nodes.end(), n) == t.nodes.end())
    {
      continue; // its cell's other half is here
    }
    for (const int m : t.nodes)
    {
      const auto end = node.neighbours.begin() + count;
      if (t.cfe != 0 && m != n && std::find(node.neighbours.begin(), end, m) == end)
      {
        node.neighbours[count++] = m;
      }
    }
  }
}

} // namespace

void addWalls(std::span<const Rim> rims, SurfacePatch& patch)
{
  if (rims.empty())
  {
    return;
  }
  // A wall is cut into two triangles, of which the first has the rim.
  std::vector<int> bottoms(patch.nodes.size(), -1);
  const auto bottomOf = [&](int n)
  {
    if (bottoms[n] < 0)
    {
      bottoms[n] = int(patch.nodes.size());
      const SurfacePatch::Node& top = patch.nodes[n];
      SurfacePatch::Node bottom{};
      bottom.position = top.position - kWallDepth * Vec3::UnitZ();
      bottom.key = firstWallKey + top.key;
      patch.nodes.push_back(bottom);
    }
    return bottoms[n];
  };
  for (const Rim& rim : rims)
  {
    SurfacePatch::Triangle& t = patch.triangles[rim.triangle];
    const int a = t.nodes[rim.side], b = t.nodes[(rim.side + 1) % 3];
    const int underA = bottomOf(a), underB = bottomOf(b);
    const int i = int(patch.triangles.size());
    const std::int64_t side = SurfacePatch::sideKey(t, rim.side);
    t.neighbours[rim.side] = i;
    t.bends[rim.side] = 1;
    const Vec3 along = patch.nodes[b].position - patch.nodes[a].position;
    SurfacePatch::Triangle wall;
    wall.normal = Vec3(along.y(), -along.x(), 0.0).normalized();
    wall.offset = wall.normal.dot(patch.nodes[a].position);
    wall.cfe = t.cfe;
    wall.key = firstWallKey + 2 * side;
    wall.ridges.fill(-1);
    wall.nodes = { a, underA, b };
    wall.neighbours = { -1, i + 1, rim.triangle };
    wall.bends = { 0, 0, 1 };
    const int wing = t.nodes[(rim.side + 2) % 3];
    patch.triangles.push_back(wall);
    ++wall.key;
    wall.nodes = { b, underA, underB };
    wall.neighbours = { i, -1, -1 };
    wall.bends.fill(0);
    patch.triangles.push_back(wall);
    patch.ridges.push_back({ { a, b }, { rim.triangle, i }, { wing, underA }, side });
  }
  patch.wallTriangles = int(patch.triangles.size()) - patch.slopeTriangles;
  // Upright edges between walls.
  for (const Rim& rim : rims)
  {
    const SurfacePatch::Triangle& t = patch.triangles[rim.triangle];
    const int a = t.nodes[rim.side], b = t.nodes[(rim.side + 1) % 3];
    const Rim next = nextRim(patch, rim);
    for (const int n : { a, b })
    {
      if (!patch.nodes[n].peak)
      {
        makePeak(n, bottoms[n], patch);
      }
    }
    if (next.triangle < 0)
    {
      continue;
    }
    const SurfacePatch::Triangle& t1 = patch.triangles[next.triangle];
    const int c = t1.nodes[(next.side + 1) % 3];
    const int i = t.neighbours[rim.side] + 1, j = t1.neighbours[next.side];
    SurfacePatch::Triangle& one = patch.triangles[i];
    SurfacePatch::Triangle& other = patch.triangles[j];
    one.neighbours[2] = j;
    other.neighbours[0] = i;
    one.bends[2] = other.bends[0] =
      SurfacePatch::bendOf(one.normal, patch.nodes[c].position - patch.nodes[b].position);
    if (one.bends[2] > 0)
    {
      patch.ridges.push_back({ { b, bottoms[b] }, { i, j }, { a, c },
        firstWallKey + SurfacePatch::sideKey(t, rim.side) });
    }
  }
}

double lowestNode(const Surface& surface, double x0, double x1, double y0, double y1)
{
  const Surface::Grid& g = surface.grid();
  const auto within = [&](double cells, int last)
  { return int(std::clamp(cells, 0.0, double(last))); };
  const int column0 = within(std::floor(x0 / g.cellSize), g.columns - 1);
  const int column1 = within(std::ceil(x1 / g.cellSize), g.columns - 1);
  const int row0 = g.rows - 1 - within(std::ceil(y1 / g.cellSize), g.rows - 1);
  const int row1 = g.rows - 1 - within(std::floor(y0 / g.cellSize), g.rows - 1);
  double lowest = std::numeric_limits<double>::quiet_NaN();
  for (int row = row0; row <= row1; ++row)
  {
    for (int column = column0; column <= column1; ++column)
    {
      lowest = std::fmin(lowest, surface.nodeHeight(row, column));
    }
  }
  return lowest;
}

} // namespace rockfall
