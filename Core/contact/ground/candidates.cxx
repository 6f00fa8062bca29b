#include "contact/ground/candidates.h"

#include "contact/ground/features.h"
#include "contact/ground/motion.h"
#include "contact/ground/roundContact.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Whether the boxes of two segments or points come within `distance`.
bool boxesMeet(const Vec3& lower, const Vec3& upper, const Vec3& a, const Vec3& b, double distance)
{
  return ((a.cwiseMin(b).array() <= upper.array() + distance) &&
    (a.cwiseMax(b).array() >= lower.array() - distance))
    .all();
}

/// A box as most points are told to be outside: by their first coordinate.
struct Box
{
  Vec3 lower, upper;

  bool holds(double x, double y, double z) const
  {
    return x <= upper.x() && x >= lower.x() && y <= upper.y() && y >= lower.y() && z <= upper.z() &&
      z >= lower.z();
  }
};

/// Whether an edge of the rock and a ridge, with `apart` (m) from the ridge to the edge between their
/// nearest points, are outside of the ground and of the rock: what has just gone in is apart, too, and
/// goes away.
bool isOutside(const PlacedBlock& rock, int edge, const SurfacePatch& patch,
  const SurfacePatch::Ridge& ridge, const Vec3& apart)
{
  const std::array<int, 2>& faces = rock.block().shape().edges()[edge].faces;
  const double sure = kSureTravel * rock.block().radius();
  const auto isOut = [&](const Vec3& n0, const Vec3& n1, const Vec3& way)
  { return n0.dot(way) > sure || n1.dot(way) > sure; };
  return isOut(patch.triangles[ridge.triangles[0]].normal,
           patch.triangles[ridge.triangles[1]].normal, apart) &&
    isOut(rock.normal(faces[0]), rock.normal(faces[1]), -apart);
}

} // namespace

RockTravel::RockTravel(const PlacedBlock& start)
  : position_(start.position())
  , orientation_(start.orientation())
  , strain_(start.strain())
{
}

double RockTravel::to(const PlacedBlock& rock)
{
  const double r = rock.block().radius();
  way_ += (rock.position() - position_).norm() + kSureTravel * r +
    (1.0 + rock.strain().norm()) * rimTravel(orientation_, rock.orientation(), r) +
    r * (rock.strain() - strain_).norm();
  position_ = rock.position();
  orientation_ = rock.orientation();
  strain_ = rock.strain();
  return way_;
}

double CandidatePairs::room(const BlockState& state, double radius, double reach) const
{
  const double c = orientation.dot(state.orientation);
  const double turned = 2.0 * radius * std::sqrt(std::max(0.0, 1.0 - c * c));
  const double strained = radius * (state.strain - strain).norm();
  return distance - reach - (state.position - position).norm() - turned - strained;
}

double timeToClose(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  const CandidatePairs& candidates, double gravity, double horizon)
{
  if (isRound(rock))
  {
    return roundTimeToClose(rock, state, patch, candidates, gravity, horizon);
  }
  const Block& block = rock.block();
  const Vec3 spin = rock.rotation() * state.spin;
  // |ω̇| ≤ |ω|²; a normal that turns with the rock turns on all of its velocity besides.
  const double turning = 2.0 * spin.squaredNorm() * block.radius();
  const double carried = 2.0 * (turning + spin.norm() * state.velocity.norm());
  const auto rate = [&](const Vec3& normal, const Vec3& point)
  { return -normal.dot(state.velocity + spin.cross(point - rock.position())); };
  double time = horizon;
  // What is farther over a plane is not on it by then.
  const double travelled = candidates.travel.to(rock);
  const double fastest = state.velocity.norm() + 1.1 * spin.norm() * block.radius();
  const auto isFar = [&](double over)
  { return over - travelled > (fastest + 0.5 * (gravity + carried) * time) * time; };
  for (const CandidatePairs::Pair& pair : candidates.vertexFace)
  {
    if (isFar(pair.over))
    {
      continue;
    }
    const SurfacePatch::Triangle& t = patch.triangles[pair.patch];
    const Vec3& p = rock.vertices()[pair.rock];
    const double over = t.normal.dot(p) - t.offset;
    pair.over = travelled + over;
    if (over > 0.0)
    {
      time = std::min(time, timeToCover(over, rate(t.normal, p), gravity + turning));
    }
    else if ((projectsInside(patch, pair.patch, p, 0.0, 0.0) ||
               (pair.patch < patch.slopeTriangles && isStraightOver(patch, t, p))) &&
      cameThrough(rock.position(), patch, pair.patch, p, over))
    {
      // Under the bottom of a valley it is beside both walls, seen square to them.
      return 0.0;
    }
  }
  for (int node : candidates.peaks)
  {
    const Vec3& q = patch.nodes[node].position;
    const int face = rock.outermostFace(q);
    const double distance = rock.faceDistance(face, q);
    time = std::min(time, timeToCover(distance, rate(-rock.normal(face), q), gravity + carried));
  }
  for (const CandidatePairs::Pair& pair : candidates.edgeEdge)
  {
    if (isFar(pair.over))
    {
      continue;
    }
    const std::array<int, 2>& ends = block.shape().edges()[pair.rock].vertices;
    const SurfacePatch::Ridge& g = patch.ridges[pair.patch];
    const Vec3& p = rock.vertices()[ends[0]];
    const Vec3& p1 = rock.vertices()[ends[1]];
    // Not before the edge has come to both planes of the ridge …
    double least = 0.0;
    const auto until = [&](const Vec3& normal, double level) // the nearer end, by bounds
    {
      return std::min(timeToCover(normal.dot(p) - level, rate(normal, p), gravity + turning),
        timeToCover(normal.dot(p1) - level, rate(normal, p1), gravity + turning));
    };
    for (int i : g.triangles)
    {
      const SurfacePatch::Triangle& t = patch.triangles[i];
      const double a = t.normal.dot(p) - t.offset, b = t.normal.dot(p1) - t.offset;
      if (a > 0.0 && b > 0.0)
      {
        pair.over = std::max(pair.over, travelled + std::min(a, b));
        least = std::max(least, until(t.normal, t.offset));
      }
    }
    if (least >= time)
    {
      continue;
    }
    // … nor before the two lines meet, …
    const Vec3& q = patch.nodes[g.nodes[0]].position;
    const Vec3 u = p1 - p, w = patch.nodes[g.nodes[1]].position - q;
    double s, t;
    if (closestOnLines(p, u, q, w, s, t))
    {
      const Vec3 out =
        patch.triangles[g.triangles[0]].normal + patch.triangles[g.triangles[1]].normal;
      Vec3 n = u.cross(w);
      const double sine = n.norm() / std::sqrt(u.squaredNorm() * w.squaredNorm());
      n = (n.dot(out) < 0.0 ? Vec3(-n) : n).normalized();
      const Vec3 c = p + s * u;
      const double distance = n.dot(c - q);
      if (distance <= 0.0)
      {
        const bool faced = inEdgeCones(rock, pair.rock, patch, pair.patch, n, kConeSlack);
        if (faced && s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0 &&
          cameAcross(rock, patch, pair.patch, distance))
        {
          return 0.0;
        }
        // Edges pass each other beside one of their ends, unless it is not even sure which of the
        // two is the upper one.
        if (faced || n.dot(out) > 0.2)
        {
          continue;
        }
      }
      else if (sine > 0.1)
      {
        least = std::max(least, timeToCover(distance, rate(n, c), gravity + carried / sine));
      }
    }
    // … nor before they have come to each other along the line between their nearest points.
    const Vec3 apart = betweenSegments(p, u, q, w);
    if (isOutside(rock, pair.rock, patch, g, apart))
    {
      const Vec3 n = apart.normalized();
      least = std::max(least, until(n, std::max(n.dot(q), n.dot(q + w))));
    }
    time = std::min(time, least);
  }
  return time;
}

namespace
{

std::uint64_t bitOf(int vertex)
{
  return std::uint64_t(1) << (vertex & 63);
}

/// Ends of each edge of a shape, as bits of vertices.
const std::vector<std::uint64_t>& endsOfEdges(const Polyhedron& shape)
{
  thread_local std::vector<std::uint64_t> ends;
  ends.clear();
  for (const Polyhedron::Edge& e : shape.edges())
  {
    ends.push_back(bitOf(e.vertices[0]) | bitOf(e.vertices[1]));
  }
  return ends;
}

/// The edges of the rock that can touch a ridge; `ends`: those of each.
void gatherEdges(const PlacedBlock& rock, const std::vector<std::uint64_t>& ends,
  const SurfacePatch& patch, int ridge, double distance, double turn, CandidatePairs& candidates)
{
  const SurfacePatch::Ridge& g = patch.ridges[ridge];
  // The rock, or an edge, all over one plane of the ridge cannot.
  const std::uint64_t under[2] = { candidates.under[g.triangles[0]],
    candidates.under[g.triangles[1]] };
  const Vec3& q0 = patch.nodes[g.nodes[0]].position;
  const Vec3& q1 = patch.nodes[g.nodes[1]].position;
  if (under[0] == 0 || under[1] == 0 || !boxesMeet(rock.lower(), rock.upper(), q0, q1, distance))
  {
    return;
  }
  const Vec3 least = q0.cwiseMin(q1), most = q0.cwiseMax(q1), along = q1 - q0;
  const Vec3 out = patch.triangles[g.triangles[0]].normal + patch.triangles[g.triangles[1]].normal;
  const std::vector<Polyhedron::Edge>& edges = rock.block().shape().edges();
  for (int e = 0; e < int(edges.size()); ++e)
  {
    if ((ends[std::size_t(e)] & under[0]) == 0 || (ends[std::size_t(e)] & under[1]) == 0)
    {
      continue;
    }
    const std::array<int, 2>& v = edges[e].vertices;
    const Vec3& p0 = rock.vertices()[v[0]];
    const Vec3& p1 = rock.vertices()[v[1]];
    if (!boxesMeet(least, most, p0, p1, distance))
    {
      continue;
    }
    // The normal of the crossing turns faster than the edge, the more so the nearer to parallel.
    Vec3 n = (p1 - p0).cross(along);
    const double size = n.norm();
    const double slack = turn * std::sqrt((p1 - p0).squaredNorm() * along.squaredNorm()) / size;
    n *= (n.dot(out) < 0.0 ? -1.0 : 1.0) / size;
    if (!(slack < 0.5) || inEdgeCones(rock, e, patch, ridge, n, slack))
    {
      candidates.edgeEdge.push_back({ e, ridge });
    }
  }
}

/// Cells of the slope that the box of a rock meets.
struct CellBox
{
  int row0, row1, column0, column1;

  CellBox(const PlacedBlock& rock, const SurfacePatch& patch, double wide)
  {
    const double inverse = 1.0 / patch.cellSize;
    const int cellColumns = patch.nodeColumns - 1, cellRows = patch.nodeRows - 1;
    const auto index = [&](double v, int last)
    { return int(std::floor(std::clamp(v * inverse, 0.0, double(last)))); };
    const Vec3 lower = rock.lower(), upper = rock.upper();
    column0 = index(lower.x() - wide - patch.west, cellColumns - 1);
    column1 = index(upper.x() + wide - patch.west, cellColumns - 1);
    row0 = index(patch.north - upper.y() - wide, cellRows - 1);
    row1 = index(patch.north - lower.y() + wide, cellRows - 1);
  }
};

/// Vertices over the triangles of the slope.
void gatherVertices(const PlacedBlock& rock, const SurfacePatch& patch, const CellBox& cells,
  double distance, double turn, CandidatePairs& candidates)
{
  const std::vector<Vec3>& vertices = rock.vertices();
  const Vec3 lower = rock.lower(), upper = rock.upper();
  const double wide = kBeyondConcave * distance;
  const int cellColumns = patch.nodeColumns - 1;
  for (int row = cells.row0; row <= cells.row1; ++row)
  {
    for (int i = 2 * (row * cellColumns + cells.column0);
         i < 2 * (row * cellColumns + cells.column1 + 1); ++i)
    {
      const SurfacePatch::Triangle& t = patch.triangles[i];
      // How far all of the rock is over the plane; first by the lowest corner of its box.
      const Vec3 corner = (t.normal.array() > 0.0).select(lower, upper);
      if (t.cfe == 0 || t.normal.dot(corner) - t.offset > distance)
      {
        continue;
      }
      const Vec3& a = patch.nodes[t.nodes[0]].position;
      const Vec3& b = patch.nodes[t.nodes[1]].position;
      const Vec3& c = patch.nodes[t.nodes[2]].position;
      const Vec3 least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
      const Box near{ least.array() - wide, most.array() + wide };
      std::uint64_t below = 0;
      for (int v = 0; v < int(vertices.size()); ++v)
      {
        const Vec3& p = vertices[v];
        const double height = t.normal.dot(p) - t.offset;
        if (height > distance)
        {
          continue;
        }
        below |= bitOf(v);
        // No bound below: what has slipped under the slope must be found (guardPenetration).
        if (near.holds(p.x(), p.y(), std::max(p.z(), least.z())) &&
          (height < 0.0 || inVertexCone(rock, v, t.normal, turn)))
        {
          candidates.vertexFace.push_back({ v, i, height });
        }
      }
      candidates.under[i] = below;
    }
  }
}

void gatherPeak(const PlacedBlock& rock, const SurfacePatch& patch, int node, double distance,
  CandidatePairs& candidates)
{
  const SurfacePatch::Node& q = patch.nodes[node];
  if (q.peak && boxesMeet(rock.lower(), rock.upper(), q.position, q.position, distance) &&
    rock.outermostFace(q.position, distance) >= 0)
  {
    candidates.peaks.push_back(node);
  }
}

/// Vertices over the triangles of walls and obstacles. They have a far side, whose planes are above
/// all of the rock: only what comes in from outside is a pair, and what is less deep, where the rock
/// is while they serve, than contacts ever are.
void gatherVerticesAtObstacles(const PlacedBlock& rock, const SurfacePatch& patch, double distance,
  double turn, CandidatePairs& candidates)
{
  const std::vector<Vec3>& vertices = rock.vertices();
  const Vec3 lower = rock.lower(), upper = rock.upper();
  const double wide = kBeyondConcave * distance;
  const double deepest = kDeepestEntrance * rock.block().radius() + distance;
  for (int i = patch.slopeTriangles; i < int(patch.triangles.size()); ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[i];
    const Vec3& a = patch.nodes[t.nodes[0]].position;
    const Vec3& b = patch.nodes[t.nodes[1]].position;
    const Vec3& c = patch.nodes[t.nodes[2]].position;
    const Vec3 least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
    const Vec3 corner = (t.normal.array() > 0.0).select(lower, upper);
    if (!boxesMeet(lower, upper, least, most, wide) || t.normal.dot(corner) - t.offset > distance)
    {
      continue;
    }
    for (int v = 0; v < int(vertices.size()); ++v)
    {
      const double height = t.normal.dot(vertices[v]) - t.offset;
      if (height > distance)
      {
        continue;
      }
      candidates.under[i] |= bitOf(v);
      if (height > -deepest && boxesMeet(least, most, vertices[v], vertices[v], wide) &&
        inVertexCone(rock, v, t.normal, turn))
      {
        candidates.vertexFace.push_back({ v, i });
      }
    }
  }
}

} // namespace

void gatherCandidates(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double distance, CandidatePairs& candidates)
{
  candidates.vertexFace.clear();
  candidates.edgeEdge.clear();
  candidates.peaks.clear();
  candidates.distance = distance;
  candidates.position = state.position;
  candidates.orientation = state.orientation;
  candidates.strain = state.strain;
  candidates.travel = RockTravel(rock);
  if (patch.nodeRows < 2)
  {
    return;
  }
  if (isRound(rock))
  {
    gatherRound(rock, patch, distance, candidates);
    return;
  }
  // As far as the rock may turn while the candidates serve, sine.
  const double turn = kConeSlack + distance / rock.block().radius();
  const int cellColumns = patch.nodeColumns - 1;
  const CellBox cells(rock, patch, kBeyondConcave * distance);
  candidates.under.assign(patch.triangles.size(), 0);
  gatherVertices(rock, patch, cells, distance, turn, candidates);
  const std::vector<std::uint64_t>& ends = endsOfEdges(rock.block().shape());
  for (int row = cells.row0; row <= cells.row1 + 1; ++row)
  {
    for (int column = cells.column0; column <= cells.column1 + 1; ++column)
    {
      gatherPeak(rock, patch, row * patch.nodeColumns + column, distance, candidates);
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
          gatherEdges(rock, ends, patch, ridge, distance, turn, candidates);
        }
      }
    }
  }
  gatherVerticesAtObstacles(rock, patch, distance, turn, candidates);
  for (int i = patch.slopeNodes; i < int(patch.nodes.size()); ++i)
  {
    gatherPeak(rock, patch, i, distance, candidates);
  }
  for (int i = patch.slopeRidges; i < int(patch.ridges.size()); ++i)
  {
    gatherEdges(rock, ends, patch, i, distance, turn, candidates);
  }
}

} // namespace rockfall
