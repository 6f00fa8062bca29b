// The pairs of a rock and the slope that may touch within a step.
//
// A rock of an island goes so far in a step that candidates gathered for several would be many and
// soon be gathered again. So what may close is found in each step: vertices by the cells that they
// are over, edges side by side.

#include "contact/ground/candidates.h"
#include "contact/ground/features.h"
#include "contact/pairs.h"
#include "law/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

using Four = ShapeLayout::Four;

/// The cells that a rectangle meets, given in cells from the patch's north-west node.
struct CellRange
{
  int row0, row1, column0, column1;

  CellRange(const SurfacePatch& patch, double west, double east, double north, double south)
  {
    const double columns = patch.nodeColumns - 2, rows = patch.nodeRows - 2;
    column0 = int(std::max(0.0, std::min(columns, west)));
    column1 = int(std::max(0.0, std::min(columns, east)));
    row0 = int(std::max(0.0, std::min(rows, north)));
    row1 = int(std::max(0.0, std::min(rows, south)));
  }
};

/// A box with sides along the axes.
struct RockBox
{
  Vec3 lower, upper;

  explicit RockBox(const PairBody& body)
  {
    lower = upper = body.vertex(0);
    for (int v = 1; v < body.vertices(); ++v)
    {
      const Vec3 p = body.vertex(v);
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
  }
  RockBox(const RockBox& of, double distance)
    : lower(of.lower.array() - distance)
    , upper(of.upper.array() + distance)
  {
  }
  CellRange cells(const SurfacePatch& patch, double inverse) const
  {
    return { patch, (lower.x() - patch.west) * inverse, (upper.x() - patch.west) * inverse,
      (patch.north - upper.y()) * inverse, (patch.north - lower.y()) * inverse };
  }
  bool holds(const Vec3& p) const
  {
    return p.z() >= lower.z() && p.z() <= upper.z() && p.x() >= lower.x() && p.x() <= upper.x() &&
      p.y() >= lower.y() && p.y() <= upper.y();
  }
  /// Whether it may meet a segment.
  bool meets(const Vec3& a, const Vec3& b) const
  {
    return !((a.z() > upper.z() && b.z() > upper.z()) || (a.z() < lower.z() && b.z() < lower.z()) ||
      (a.x() > upper.x() && b.x() > upper.x()) || (a.x() < lower.x() && b.x() < lower.x()) ||
      (a.y() > upper.y() && b.y() > upper.y()) || (a.y() < lower.y() && b.y() < lower.y()));
  }
};

/// Whether a place `s` cells east and `t` south of a cell's north-west node may be in one of its
/// triangles (0: the lower one), or beyond edge k by no more than `slack` cells if it is concave.
bool mayHold(int triangle, const SurfacePatch::Triangle& of, double s, double t, double slack)
{
  const auto allowed = [&](int k) { return kCoarseSlack + (of.bends[k] < 0 ? slack : 0.0); };
  if (of.rising)
  {
    return triangle == 0
      ? s + t >= 1.0 - std::numbers::sqrt2 * allowed(0) && t <= 1.0 + allowed(1) &&
        s <= 1.0 + allowed(2)
      : s >= -allowed(0) && s + t <= 1.0 + std::numbers::sqrt2 * allowed(1) && t >= -allowed(2);
  }
  return triangle == 0
    ? s >= -allowed(0) && t <= 1.0 + allowed(1) && s - t <= std::numbers::sqrt2 * allowed(2)
    : t - s <= std::numbers::sqrt2 * allowed(0) && s <= 1.0 + allowed(1) && t >= -allowed(2);
}

/// In the order in which gatherCandidates comes to them.
void sortByTriangle(std::vector<CandidatePairs::Pair>& pairs)
{
  std::sort(pairs.begin(), pairs.end(),
    [](const CandidatePairs::Pair& a, const CandidatePairs::Pair& b)
    { return a.patch != b.patch ? a.patch < b.patch : a.rock < b.rock; });
}

/// The faces of a rock, modulo 64, within `distance` (m) of whose planes a segment passes; none if
/// all of it is over one of them by more than `allowed` (m).
std::uint64_t facesAt(
  const PairBody& body, const Vec3& a, const Vec3& b, double distance, double allowed)
{
  std::uint64_t faces = 0;
  for (int i = 0; i < body.faceFours(); ++i)
  {
    const Four overA = body.overFaces(a, i), overB = body.overFaces(b, i);
    const Four low = overA.min(overB), high = overA.max(overB);
    if (low.maxCoeff() > allowed)
    {
      return 0;
    }
    const Four away = (low - distance).max(-distance - high);
    std::uint64_t passed = 0;
    for (int lane = 0; lane < 4; ++lane)
    {
      passed |= std::uint64_t(away[lane] <= 0.0) << lane;
    }
    faces |= passed << (4 * i & 63);
  }
  return faces;
}

/// Finds the pairs of a rock of an island, for one step.
class NowGatherer
{
public:
  NowGatherer(const PlacedBlock& rock, const PairBody& body, const SurfacePatch& patch,
    const SlopeReach& reach, CandidatePairs& candidates)
    : body_(body)
    , patch_(patch)
    , reach_(reach)
    , candidates_(candidates)
    , inverse_(1.0 / patch.cellSize)
    , deepest_(1.01 * kDeepestEntrance * rock.block().radius())
    , cellColumns_(patch.nodeColumns - 1)
    , box_(body)
  {
  }

  void gather()
  {
    this->findReaches();
    this->gatherVertices();
    sortByTriangle(candidates_.vertexFace);
    const RockBox ridges(box_, kOfBothSides * most_);
    const CellRange cells = ridges.cells(patch_, inverse_);
    this->gatherPeaks(cells);
    this->gatherEdges(cells, ridges);
  }

private:
  /// Gaps that may close along the normal of each triangle.
  void findReaches();
  void gatherVertices();
  void gatherPeaks(const CellRange& cells);
  void gatherEdges(const CellRange& cells, const RockBox& near);
  void gatherEdgesAt(int ridge, const RockBox& near);

  const PairBody& body_;
  const SurfacePatch& patch_;
  const SlopeReach& reach_;
  CandidatePairs& candidates_;
  double inverse_; ///< 1/m, of the size of a cell.
  double deepest_; ///< What is deeper is no entrance, m.
  int cellColumns_;
  RockBox box_;
  double* reaches_ = nullptr; ///< By triangle, m.
  double most_ = 0.0;         ///< Of them.
};

void NowGatherer::findReaches()
{
  thread_local std::vector<double> reaches;
  reaches.resize(patch_.triangles.size());
  reaches_ = reaches.data();
  const CellRange around = RockBox(box_, kBeyondCorner * reach_.most).cells(patch_, inverse_);
  for (int row = around.row0; row <= around.row1; ++row)
  {
    const int end = 2 * (row * cellColumns_ + around.column1 + 1);
    for (int i = 2 * (row * cellColumns_ + around.column0); i < end; ++i)
    {
      reaches_[i] = reach_.along(patch_.triangles[i].normal);
      most_ = std::max(most_, reaches_[i]);
    }
  }
}

void NowGatherer::gatherVertices()
{
  const double wide = kBeyondCorner * most_ * inverse_;
  const double high = kBeyondCorner * most_ * std::sqrt(1.0 + patch_.tilt.squaredNorm());
  for (int v = 0; v < body_.vertices(); ++v)
  {
    const Vec3 p = body_.vertex(v);
    if (patch_.over(p) > high)
    {
      continue;
    }
    const double east = (p.x() - patch_.west) * inverse_, south = (patch_.north - p.y()) * inverse_;
    const CellRange near(patch_, east - wide, east + wide, south - wide, south + wide);
    for (int row = near.row0; row <= near.row1; ++row)
    {
      const int end = 2 * (row * cellColumns_ + near.column1 + 1);
      for (int i = 2 * (row * cellColumns_ + near.column0); i < end; ++i)
      {
        const SurfacePatch::Triangle& of = patch_.triangles[i];
        const double height = of.normal.dot(p) - of.offset, allowed = reaches_[i];
        if (!(height <= allowed)) // nor beside a hole
        {
          continue;
        }
        // A vertex that has slipped under the slope must be found however deep it is
        // (guardPenetration).
        const double s = east - (i / 2 - row * cellColumns_), t = south - row;
        const double lean = height * inverse_;
        if ((height >= -deepest_ &&
              mayHold(i % 2, of, s - lean * of.normal.x(), t + lean * of.normal.y(),
                allowed * inverse_)) ||
          (height < 0.0 && mayHold(i % 2, of, s, t, 0.0)))
        {
          candidates_.vertexFace.push_back({ v, i });
        }
      }
    }
  }
}

void NowGatherer::gatherPeaks(const CellRange& cells)
{
  const RockBox near(box_, most_);
  for (int row = cells.row0; row <= cells.row1 + 1; ++row)
  {
    for (int column = cells.column0; column <= cells.column1 + 1; ++column)
    {
      const int i = row * patch_.nodeColumns + column;
      const SurfacePatch::Node& q = patch_.nodes[i];
      if (q.peak && near.holds(q.position) && body_.overAll(q.position) <= most_)
      {
        candidates_.peaks.push_back(i);
      }
    }
  }
}

void NowGatherer::gatherEdgesAt(int ridge, const RockBox& near)
{
  if (ridge < 0)
  {
    return;
  }
  const SurfacePatch::Ridge& g = patch_.ridges[std::size_t(ridge)];
  const Vec3 &q0 = patch_.nodes[g.nodes[0]].position, &q1 = patch_.nodes[g.nodes[1]].position;
  if (!near.meets(q0, q1))
  {
    return;
  }
  const Vec3 &a = patch_.triangles[g.triangles[0]].normal,
             &b = patch_.triangles[g.triangles[1]].normal;
  const double allowed = kOfBothSides * std::max(reach_.along(a), reach_.along(b));
  // An edge touches where the ridge is near the planes of both of its faces.
  const std::uint64_t faces = facesAt(body_, q0, q1, std::max(allowed, deepest_), allowed);
  if (faces == 0)
  {
    return;
  }
  const Vec3 w = q1 - q0;
  for (std::size_t e = 0; e < body_.edges.size(); ++e)
  {
    const std::array<int, 2>& of = body_.edges[e].faces;
    if (((faces >> (of[0] & 63)) & (faces >> (of[1] & 63)) & 1) == 0)
    {
      continue;
    }
    const Vec3 p = body_.vertex(body_.edges[e].vertices[0]),
               u = body_.vertex(body_.edges[e].vertices[1]) - p;
    double s, t;
    if (!closestOnLines(p, u, q0, w, s, t) || s < -kBeyondEnd || s > 1.0 + kBeyondEnd ||
      t < -kBeyondEnd || t > 1.0 + kBeyondEnd)
    {
      continue;
    }
    const Vec3 n = u.cross(w);
    const double gap = (n.dot(a + b) < 0.0 ? -1.0 : 1.0) * n.dot(p - q0) / n.norm();
    if (gap <= allowed && gap >= -deepest_)
    {
      candidates_.edgeEdge.push_back({ int(e), ridge });
    }
  }
}

void NowGatherer::gatherEdges(const CellRange& cells, const RockBox& near)
{
  // All edges of the cells: the northern and the eastern ones are counted as their neighbours'.
  for (int row = std::max(cells.row0 - 1, 0); row <= cells.row1; ++row)
  {
    for (int column = cells.column0; column <= cells.column1; ++column)
    {
      const std::array<int, 3>& ridges = patch_.triangles[2 * (row * cellColumns_ + column)].ridges;
      if (row >= cells.row0)
      {
        this->gatherEdgesAt(ridges[0], near);
      }
      this->gatherEdgesAt(ridges[1], near);
      if (row >= cells.row0)
      {
        this->gatherEdgesAt(ridges[2], near);
      }
    }
    if (row >= cells.row0 && cells.column1 + 1 < cellColumns_)
    {
      this->gatherEdgesAt(
        patch_.triangles[2 * (row * cellColumns_ + cells.column1 + 1)].ridges[0], near);
    }
  }
}

} // namespace

void gatherStepCandidates(const PlacedBlock& rock, const PairBody& body, const SurfacePatch& patch,
  const SlopeReach& reach, CandidatePairs& candidates)
{
  candidates.vertexFace.clear();
  candidates.edgeEdge.clear();
  candidates.peaks.clear();
  candidates.travel = RockTravel(rock);
  if (patch.nodeRows >= 2)
  {
    NowGatherer(rock, body, patch, reach, candidates).gather();
  }
}

void gatherCandidatesUnder(const PlacedBlock& rock, const PairBody& body, const SurfacePatch& patch,
  double allowed, CandidatePairs& candidates)
{
  candidates.vertexFace.clear();
  candidates.edgeEdge.clear();
  candidates.peaks.clear();
  candidates.travel = RockTravel(rock);
  if (patch.nodeRows < 2)
  {
    return;
  }
  const double inverse = 1.0 / patch.cellSize;
  for (int v = 0; v < body.vertices(); ++v)
  {
    const Vec3 p = body.vertex(v);
    if (patch.over(p) > 0.0)
    {
      continue;
    }
    const int i = patch.triangleAt(p.x(), p.y());
    if (i >= 0 && patch.triangles[i].normal.dot(p) - patch.triangles[i].offset < -allowed)
    {
      candidates.vertexFace.push_back({ v, i });
    }
  }
  sortByTriangle(candidates.vertexFace);
  const RockBox box(body);
  const CellRange cells = box.cells(patch, inverse);
  for (int row = cells.row0; row <= cells.row1 + 1; ++row)
  {
    for (int column = cells.column0; column <= cells.column1 + 1; ++column)
    {
      const int i = row * patch.nodeColumns + column;
      const SurfacePatch::Node& q = patch.nodes[i];
      if (q.peak && box.holds(q.position) && body.overAll(q.position) <= -allowed &&
        rock.faceDistance(rock.outermostFace(q.position), q.position) < -allowed)
      {
        candidates.peaks.push_back(i);
      }
    }
  }
}

} // namespace rockfall
