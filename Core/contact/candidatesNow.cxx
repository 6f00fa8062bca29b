// The pairs of a rock and the slope that are near each other now.
//
// A rock of a crowd goes so far in a step that candidates gathered for several would be many and
// soon be gathered again. So what is near is found in each step: by the heights of all vertices
// over a plane side by side, and by where they are straight over the cells.

#include "contact/features.h"
#include "contact/pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Slack of what is told before it is looked at closely, in cells.
constexpr double kLoosely = 1e-6;
/// How far beyond a corner between two concave edges planes serve, in reaches, seen from above: the
/// corners have 45° at least. Another half is what the plane leans.
constexpr double kBeyondCorner = 3.0;

using Four = PairBody::Four;

std::uint64_t bit(int vertex)
{
  return std::uint64_t(1) << (vertex & 63);
}

/// The cells that a box meets.
struct CellRange
{
  int row0, row1, column0, column1;

  CellRange(const SurfacePatch& patch, const Vec3& lower, const Vec3& upper, double wide)
  {
    const double inverse = 1.0 / patch.cellSize;
    const auto index = [&](double v, int cells)
    { return int(std::clamp(v * inverse, 0.0, double(cells - 1))); };
    column0 = index(lower.x() - wide - patch.west, patch.nodeColumns - 1);
    column1 = index(upper.x() + wide - patch.west, patch.nodeColumns - 1);
    row0 = index(patch.north - upper.y() - wide, patch.nodeRows - 1);
    row1 = index(patch.north - lower.y() + wide, patch.nodeRows - 1);
  }
};

/// A cell of the patch with its north-west node at the origin and sides of one; y goes south.
class CellFrame
{
public:
  CellFrame(const SurfacePatch& patch, int row, int column)
    : inverse_(1.0 / patch.cellSize)
    , west_(patch.west + column * patch.cellSize)
    , north_(patch.north - row * patch.cellSize)
  {
  }
  /// Whether a place may be in one of the triangles (0: the lower one), or beyond edge k by no more
  /// than `slack[k]` cells.
  bool holds(int triangle, double x, double y, const std::array<double, 3>& slack) const
  {
    const double s = (x - west_) * inverse_, t = (north_ - y) * inverse_;
    return triangle == 0
      ? s >= -slack[0] && t <= 1.0 + slack[1] && s - t <= std::numbers::sqrt2 * slack[2]
      : t - s <= std::numbers::sqrt2 * slack[0] && s <= 1.0 + slack[1] && t >= -slack[2];
  }

private:
  double inverse_, west_, north_;
};

bool boxesMeet(
  const Vec3& lower, const Vec3& upper, const Vec3& least, const Vec3& most, double distance)
{
  return least.x() <= upper.x() + distance && most.x() >= lower.x() - distance &&
    least.y() <= upper.y() + distance && most.y() >= lower.y() - distance &&
    least.z() <= upper.z() + distance && most.z() >= lower.z() - distance;
}

/// The edges of the rock that cross a ridge within reach of both of its sides.
void gatherCrossings(const PlacedBlock& rock, const SurfacePatch& patch, int ridge, double distance,
  CandidatePairs& candidates)
{
  const SurfacePatch::Ridge& g = patch.ridges[ridge];
  const std::uint64_t under[2] = { candidates.under[g.triangles[0]],
    candidates.under[g.triangles[1]] };
  if (under[0] == 0 || under[1] == 0)
  {
    return;
  }
  const Vec3& q0 = patch.nodes[g.nodes[0]].position;
  const Vec3& q1 = patch.nodes[g.nodes[1]].position;
  const Vec3 least = q0.cwiseMin(q1), most = q0.cwiseMax(q1);
  if (!boxesMeet(rock.lower(), rock.upper(), least, most, distance))
  {
    return;
  }
  const std::vector<Vec3>& vertices = rock.vertices();
  const std::vector<Polyhedron::Edge>& edges = rock.block().shape().edges();
  for (int e = 0; e < int(edges.size()); ++e)
  {
    const std::array<int, 2>& v = edges[e].vertices;
    const std::uint64_t ends = bit(v[0]) | bit(v[1]);
    if ((ends & under[0]) == 0 || (ends & under[1]) == 0)
    {
      continue;
    }
    const Vec3 &p0 = vertices[v[0]], &p1 = vertices[v[1]];
    double s, t;
    constexpr double kLeast = -1e-9, kMost = 1.0 + 1e-9;
    if (boxesMeet(least, most, p0.cwiseMin(p1), p0.cwiseMax(p1), distance) &&
      closestOnLines(p0, p1 - p0, q0, q1 - q0, s, t) && s >= kLeast && s <= kMost && t >= kLeast &&
      t <= kMost)
    {
      candidates.edgeEdge.push_back({ e, ridge });
    }
  }
}

} // namespace

void gatherNow(const PlacedBlock& rock, const PairBody& body, const SurfacePatch& patch,
  double reach, CandidatePairs& candidates)
{
  candidates.vertexFace.clear();
  candidates.edgeEdge.clear();
  candidates.peaks.clear();
  if (patch.nodeRows < 2)
  {
    return;
  }
  const Vec3 lower = rock.lower(), upper = rock.upper();
  const double depth = 0.1 * rock.block().radius(); // what is deeper is no entrance
  const CellRange cells(patch, lower, upper, kBeyondCorner * reach);
  const double inverse = 1.0 / patch.cellSize;
  const int cellColumns = patch.nodeColumns - 1;
  const int vertices = body.vertices();
  std::vector<std::uint64_t>& under = candidates.under;
  under.assign(patch.triangles.size(), 0);
  for (int row = cells.row0; row <= cells.row1; ++row)
  {
    for (int column = cells.column0; column <= cells.column1; ++column)
    {
      const CellFrame cell(patch, row, column);
      for (int k = 0; k < 2; ++k)
      {
        const int i = 2 * (row * cellColumns + column) + k;
        const SurfacePatch::Triangle& t = patch.triangles[i];
        if (t.cfe == 0)
        {
          continue;
        }
        std::uint64_t below = 0;
        const Vec3 n = t.normal;
        for (int four = 0; four < body.vertexFours(); ++four)
        {
          const Four heights = body.alongVertices(n, four) - t.offset;
          if (heights.minCoeff() > reach)
          {
            continue;
          }
          const std::array<double, 3> slack = { kLoosely + (t.bends[0] < 0 ? reach * inverse : 0.0),
            kLoosely + (t.bends[1] < 0 ? reach * inverse : 0.0),
            kLoosely + (t.bends[2] < 0 ? reach * inverse : 0.0) };
          for (int lane = 0; lane < std::min(4, vertices - 4 * four); ++lane)
          {
            const double height = heights[lane];
            if (height > reach)
            {
              continue;
            }
            const int v = 4 * four + lane;
            below |= bit(v);
            const Vec3 p = body.vertex(v);
            // What has slipped under the slope must be found however deep it is (holdOverlap).
            constexpr std::array<double, 3> kNone = { kLoosely, kLoosely, kLoosely };
            if ((height >= -1.01 * depth &&
                  cell.holds(k, p.x() - height * n.x(), p.y() - height * n.y(), slack)) ||
              (height < 0.0 && cell.holds(k, p.x(), p.y(), kNone)))
            {
              candidates.vertexFace.push_back({ v, i });
            }
          }
        }
        under[i] = below;
      }
    }
  }
  const double near = std::max(reach, 1.01 * depth);
  for (int row = cells.row0; row <= cells.row1 + 1; ++row)
  {
    for (int column = cells.column0; column <= cells.column1 + 1; ++column)
    {
      const int i = row * patch.nodeColumns + column;
      const SurfacePatch::Node& q = patch.nodes[i];
      if (q.peak && boxesMeet(lower, upper, q.position, q.position, reach) &&
        rock.faceDistance(rock.outermostFace(q.position), q.position) <= reach)
      {
        candidates.peaks.push_back(i);
      }
    }
  }
  // The ridges of the cells, and those that the next column and the row above count as theirs.
  for (int row = std::max(cells.row0 - 1, 0); row <= cells.row1; ++row)
  {
    for (int column = cells.column0; column <= std::min(cells.column1 + 1, cellColumns - 1);
         ++column)
    {
      for (int ridge : patch.triangles[2 * (row * cellColumns + column)].ridges)
      {
        if (ridge >= 0)
        {
          gatherCrossings(rock, patch, ridge, near, candidates);
        }
      }
    }
  }
}

void gatherUnder(const PlacedBlock& rock, const PairBody& body, const SurfacePatch& patch,
  double allowed, CandidatePairs& candidates)
{
  candidates.vertexFace.clear();
  candidates.edgeEdge.clear();
  candidates.peaks.clear();
  if (patch.nodeRows < 2)
  {
    return;
  }
  Vec3 lower = body.vertex(0), upper = lower;
  for (int v = 0; v < body.vertices(); ++v)
  {
    const Vec3 p = body.vertex(v);
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
    const int i = patch.triangleAt(p.x(), p.y());
    if (i >= 0 && patch.triangles[i].normal.dot(p) - patch.triangles[i].offset < -allowed)
    {
      candidates.vertexFace.push_back({ v, i });
    }
  }
  // In the order in which other searches come to them.
  std::sort(candidates.vertexFace.begin(), candidates.vertexFace.end(),
    [](const CandidatePairs::Pair& a, const CandidatePairs::Pair& b)
    { return a.patch != b.patch ? a.patch < b.patch : a.rock < b.rock; });
  const CellRange cells(patch, lower, upper, 0.0);
  for (int row = cells.row0; row <= cells.row1 + 1; ++row)
  {
    for (int column = cells.column0; column <= cells.column1 + 1; ++column)
    {
      const int i = row * patch.nodeColumns + column;
      const SurfacePatch::Node& q = patch.nodes[i];
      if (q.peak && boxesMeet(lower, upper, q.position, q.position, 0.0) &&
        rock.faceDistance(rock.outermostFace(q.position), q.position) < -allowed)
      {
        candidates.peaks.push_back(i);
      }
    }
  }
}

} // namespace rockfall
