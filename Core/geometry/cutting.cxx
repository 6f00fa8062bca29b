#include "geometry/cutting.h"

#include "base/errors.h"
#include "geometry/shell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace rockfall
{

namespace
{

/// Where the plane meets an edge; a function of the unordered pair of ends.
Vec3 meeting(const Vec3& a, double heightA, const Vec3& b, double heightB)
{
  if (std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3))
  {
    return meeting(b, heightB, a, heightA);
  }
  return a + heightA / (heightA - heightB) * (b - a);
}

/// One of the two halves: faces of the points of both, to be closed by the cut.
class Half
{
public:
  void add(const std::vector<int>& loop)
  {
    if (loop.size() >= 3)
    {
      faces_.push_back(loop);
    }
  }

  /// Closes it along the points in the plane, and leaves out those that it has none of.
  void close(const std::vector<Vec3>& points, const std::vector<char>& inPlane, ConvexPiece& piece)
  {
    // Edges with a face on one side only are the rim of the cut.
    std::set<std::array<int, 2>> sides;
    for (const std::vector<int>& loop : faces_)
    {
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        const int a = loop[i], b = loop[(i + 1) % loop.size()];
        if (inPlane[std::size_t(a)] && inPlane[std::size_t(b)])
        {
          sides.insert({ a, b });
        }
      }
    }
    std::map<int, int> next;
    bool simple = true;
    for (const auto& [a, b] : sides)
    {
      if (!sides.contains({ b, a }))
      {
        simple = next.emplace(b, a).second && simple;
      }
    }
    std::vector<int> cut;
    if (!next.empty())
    {
      int at = next.begin()->first;
      do
      {
        cut.push_back(at);
        const auto found = next.find(at);
        at = found == next.end() ? -1 : found->second;
      } while (at >= 0 && at != cut.front() && cut.size() <= next.size());
      simple = simple && at == cut.front();
    }
    if (!simple || cut.size() < 3 || cut.size() != next.size())
    {
      throw GeometryError("the cut of a plane through a block is not a simple polygon");
    }
    faces_.push_back(cut);
    piece = {};
    std::vector<int> numbers(points.size(), -1);
    for (std::vector<int>& loop : faces_)
    {
      for (int& id : loop)
      {
        int& number = numbers[std::size_t(id)];
        if (number < 0)
        {
          number = int(piece.points.size());
          piece.points.push_back(points[std::size_t(id)]);
        }
        id = number;
      }
    }
    piece.faces = std::move(faces_);
  }

private:
  std::vector<std::vector<int>> faces_;
};

} // namespace

bool cutPiece(const ConvexPiece& piece, const CuttingPlane& plane, double tolerance,
  ConvexPiece& below, ConvexPiece& above)
{
  std::vector<double> heights;
  heights.reserve(piece.points.size());
  bool isBelow = false, isAbove = false;
  for (const Vec3& p : piece.points)
  {
    double height = plane.normal.dot(p) - plane.offset;
    height = std::abs(height) <= tolerance ? 0.0 : height;
    isBelow = isBelow || height < 0.0;
    isAbove = isAbove || height > 0.0;
    heights.push_back(height);
  }
  if (!isBelow || !isAbove)
  {
    return false;
  }
  std::vector<Vec3> points = piece.points;
  std::vector<char> inPlane;
  for (const double height : heights)
  {
    inPlane.push_back(height == 0.0);
  }
  std::map<std::array<int, 2>, int> cuts; ///< Of edges, by their ends.
  Half lower, upper;
  std::vector<int> low, high;
  for (const std::vector<int>& loop : piece.faces)
  {
    low.clear();
    high.clear();
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      const double heightA = heights[std::size_t(a)], heightB = heights[std::size_t(b)];
      if (heightA <= 0.0)
      {
        low.push_back(a);
      }
      if (heightA >= 0.0)
      {
        high.push_back(a);
      }
      if (heightA * heightB < 0.0)
      {
        const auto [found, isNew] =
          cuts.emplace(std::array<int, 2>{ std::min(a, b), std::max(a, b) }, int(points.size()));
        if (isNew)
        {
          points.push_back(
            meeting(piece.points[std::size_t(a)], heightA, piece.points[std::size_t(b)], heightB));
          inPlane.push_back(1);
        }
        low.push_back(found->second);
        high.push_back(found->second);
      }
    }
    // A face that only ends in the plane belongs to one side.
    const auto within = [&](const std::vector<int>& part)
    {
      return std::all_of(
        part.begin(), part.end(), [&](int id) { return inPlane[std::size_t(id)] != 0; });
    };
    if (!within(low))
    {
      lower.add(low);
    }
    if (!within(high))
    {
      upper.add(high);
    }
  }
  lower.close(points, inPlane, below);
  upper.close(points, inPlane, above);
  return true;
}

double thicknessOf(const ConvexPiece& piece)
{
  double least = std::numeric_limits<double>::infinity();
  double extent = 0.0;
  for (const Vec3& p : piece.points)
  {
    extent = std::max(extent, (p - piece.points.front()).norm());
  }
  for (const std::vector<int>& loop : piece.faces)
  {
    const FacePlane face = facePlane(piece.points, loop);
    if (!(face.width > weldTolerance * extent))
    {
      continue; // no plane of its own
    }
    double deepest = 0.0;
    for (const Vec3& p : piece.points)
    {
      deepest = std::max(deepest, face.offset - face.normal.dot(p));
    }
    least = std::min(least, deepest);
  }
  return std::isfinite(least) ? least : 0.0;
}

} // namespace rockfall
