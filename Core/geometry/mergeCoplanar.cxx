#include "geometry/shell.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rockfall
{

namespace
{

/// Grows regions of coplanar faces, the largest face first: it holds its plane the firmest.
class Regions
{
public:
  Regions(const Shell& shell, double tolerance)
    : shell_(shell)
    , edges_(shell.faces)
    , tolerance_(tolerance)
    , ids_(shell.faces.size(), -1)
    , visited_(shell.faces.size(), -1)
  {
    std::vector<FacePlane> planes;
    for (const std::vector<int>& loop : shell.faces)
    {
      planes.push_back(facePlane(shell.points, loop));
    }
    std::vector<int> order(planes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(
      order.begin(), order.end(), [&](int a, int b) { return planes[a].area > planes[b].area; });
    for (const int seed : order)
    {
      if (ids_[seed] < 0)
      {
        std::vector<int> members = this->settle(seed, planes);
        std::sort(members.begin(), members.end());
        for (const int face : members)
        {
          ids_[face] = members.front();
        }
        members_.push_back(std::move(members));
      }
    }
    // In the order in which the faces were given, not in that of their areas.
    std::sort(members_.begin(), members_.end());
  }

  const std::vector<std::vector<int>>& members() const { return members_; }

  /// The outline of a region, empty if it is not one simple loop.
  std::vector<int> outline(const std::vector<int>& members) const
  {
    const int region = ids_[members.front()];
    std::unordered_map<int, int> next;
    int start = -1;
    for (const int face : members)
    {
      const std::vector<int>& loop = shell_.faces[face];
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        const int a = loop[i], b = loop[(i + 1) % loop.size()];
        if (ids_[edges_.face(b, a)] == region)
        {
          continue;
        }
        if (!next.emplace(a, b).second)
        {
          return {};
        }
        start = start < 0 ? a : start;
      }
    }
    if (start < 0)
    {
      return {};
    }
    std::vector<int> result = { start };
    for (int v = next.at(start); v != start; v = next.at(v))
    {
      result.push_back(v);
    }
    if (result.size() != next.size())
    {
      result.clear();
    }
    return result;
  }

private:
  /// Grows from the seed's plane, then from the plane of what has grown, until that stays the same.
  std::vector<int> settle(int seed, const std::vector<FacePlane>& planes)
  {
    std::vector<int> members = { seed };
    if (!(planes[seed].area > 0.0))
    {
      return members;
    }
    Vec3 normal = planes[seed].normal;
    double offset = planes[seed].offset;
    for (int pass = 0; pass < 4; ++pass)
    {
      std::vector<int> grown = this->grow(seed, normal, offset);
      if (grown.empty() || grown == members)
      {
        break;
      }
      members = std::move(grown);
      normal.setZero();
      for (const int face : members)
      {
        normal += planes[face].area * planes[face].normal;
      }
      normal.normalize();
      double low = INFINITY, high = -INFINITY;
      for (const int face : members)
      {
        for (const int id : shell_.faces[face])
        {
          const double height = normal.dot(shell_.points[id]);
          low = std::min(low, height);
          high = std::max(high, height);
        }
      }
      offset = 0.5 * (low + high);
    }
    return members;
  }

  /// Free faces in the plane, connected with the seed; none if the seed is not in it.
  std::vector<int> grow(int seed, const Vec3& normal, double offset)
  {
    const auto inPlane = [&](int face)
    {
      return std::all_of(shell_.faces[face].begin(), shell_.faces[face].end(),
        [&](int id) { return std::abs(normal.dot(shell_.points[id]) - offset) <= tolerance_; });
    };
    std::vector<int> members;
    ++stamp_;
    const auto visit = [&](int face)
    {
      if (ids_[face] < 0 && visited_[face] != stamp_)
      {
        visited_[face] = stamp_;
        if (inPlane(face))
        {
          members.push_back(face);
        }
      }
    };
    visit(seed);
    for (std::size_t done = 0; done < members.size(); ++done)
    {
      const std::vector<int>& loop = shell_.faces[members[done]];
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        visit(edges_.face(loop[(i + 1) % loop.size()], loop[i]));
      }
    }
    return members;
  }

  const Shell& shell_;
  DirectedEdges edges_;
  double tolerance_;
  std::vector<int> ids_;     ///< Per face its region's lowest face, -1 while it is free.
  std::vector<int> visited_; ///< Per face the last growth that has looked at it.
  int stamp_ = -1;
  std::vector<std::vector<int>> members_;
};

} // namespace

std::optional<Shell> mergeCoplanar(const Shell& shell, double tolerance)
{
  const Regions regions(shell, tolerance);
  Shell result;
  result.extent = shell.extent;
  std::vector<int> faceCount(shell.points.size(), 0);
  for (const std::vector<int>& members : regions.members())
  {
    result.faces.push_back(regions.outline(members));
    result.faceIds.push_back(shell.faceIds[members.front()]);
    if (result.faces.back().empty())
    {
      return std::nullopt;
    }
    for (const int id : result.faces.back())
    {
      ++faceCount[id];
    }
  }

  // Where two faces meet and no third, there is no corner: the point lies along their edge.
  std::vector<int> newIds(shell.points.size(), -1);
  for (std::size_t i = 0; i < shell.points.size(); ++i)
  {
    if (faceCount[i] >= 3)
    {
      newIds[i] = int(result.points.size());
      result.points.push_back(shell.points[i]);
      result.pointIds.push_back(shell.pointIds[i]);
    }
  }
  for (std::vector<int>& loop : result.faces)
  {
    std::erase_if(loop, [&](int id) { return newIds[id] < 0; });
    std::transform(loop.begin(), loop.end(), loop.begin(), [&](int id) { return newIds[id]; });
    const double least = weldTolerance * shell.extent;
    if (loop.size() < 3 || !(facePlane(result.points, loop).width > least))
    {
      return std::nullopt;
    }
  }
  if (!DirectedEdges(result.faces).closed())
  {
    return std::nullopt;
  }
  return result;
}

} // namespace rockfall
