#include "geometry/shell.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "base/text/pointText.h"
#include "geometry/simplexIntegration.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rockfall
{

namespace
{

/// For every point the first one that it coincides with, itself if none.
std::vector<int> coincident(std::span<const Vec3> points, double distance)
{
  // Sorted along a direction that no box or lattice is square to: few points share a place on it.
  const Vec3 direction = Vec3(0.5311, 0.6173, 0.5804).normalized();
  std::vector<double> place(points.size());
  std::transform(points.begin(), points.end(), place.begin(),
    [&](const Vec3& point) { return direction.dot(point); });
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](int a, int b) { return place[a] != place[b] ? place[a] < place[b] : a < b; });

  std::vector<int> result(points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const int self = order[i];
    result[self] = self;
    for (std::size_t j = i; j-- > 0 && place[self] - place[order[j]] <= distance;)
    {
      const int other = order[j];
      if (result[other] == other && (points[self] - points[other]).norm() <= distance)
      {
        result[self] = other;
        break;
      }
    }
  }
  return result;
}

/// The loop over welded points, empty if welding has left it nothing to enclose.
std::vector<int> weldedLoop(const std::vector<int>& loop, const std::vector<int>& newIds)
{
  std::vector<int> result;
  for (const int id : loop)
  {
    if (result.empty() || result.back() != newIds[id])
    {
      result.push_back(newIds[id]);
    }
  }
  while (result.size() > 1 && result.front() == result.back())
  {
    result.pop_back();
  }
  if (result.size() < 3)
  {
    result.clear();
  }
  return result;
}

void checkLoops(
  std::span<const std::vector<int>> faces, std::size_t pointCount, const std::string& name)
{
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    const std::string face = name + ": face " + std::to_string(f);
    if (faces[f].size() < 3)
    {
      throw GeometryError(
        face + " has " + std::to_string(faces[f].size()) + " points; a face has at least 3");
    }
    for (const int id : faces[f])
    {
      if (id < 0 || std::size_t(id) >= pointCount)
      {
        throw GeometryError(face + " uses point " + std::to_string(id) + ", but there are " +
          std::to_string(pointCount) + " points, counted from 0");
      }
    }
  }
}

} // namespace

FacePlane facePlane(std::span<const Vec3> points, std::span<const int> loop)
{
  FacePlane plane{ Vec3::Zero(), 0.0, 0.0, loop[0], 0.0, 0.0 };
  const Vec3& first = points[loop[0]];
  Vec3 twiceArea = Vec3::Zero();
  double diameter = 0.0;
  for (std::size_t i = 1; i < loop.size(); ++i)
  {
    const Vec3 arm = points[loop[i]] - first;
    twiceArea += (points[loop[i - 1]] - first).cross(arm);
    diameter = std::max(diameter, arm.norm());
  }
  plane.area = 0.5 * twiceArea.norm();
  if (!(plane.area > 0.0))
  {
    return plane;
  }
  plane.width = plane.area / diameter;
  plane.normal = twiceArea / (2.0 * plane.area);
  double low = 0.0, high = 0.0; // relative to the first point
  for (const int id : loop)
  {
    const double height = plane.normal.dot(points[id] - first);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  const double middle = 0.5 * (low + high);
  plane.offset = plane.normal.dot(first) + middle;
  for (const int id : loop)
  {
    const double distance = std::abs(plane.normal.dot(points[id] - first) - middle);
    if (distance > plane.deviation)
    {
      plane.deviation = distance;
      plane.farthest = id;
    }
  }
  return plane;
}

DirectedEdges::DirectedEdges(const std::vector<std::vector<int>>& faces)
{
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    const std::vector<int>& loop = faces[f];
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      repeated_ |= !faces_.emplace(key(loop[i], loop[(i + 1) % loop.size()]), int(f)).second;
    }
  }
}

int DirectedEdges::face(int a, int b) const
{
  const auto found = faces_.find(key(a, b));
  return found == faces_.end() ? -1 : found->second;
}

bool DirectedEdges::closed() const
{
  return !repeated_ &&
    std::all_of(faces_.begin(), faces_.end(),
      [&](const auto& edge)
      { return this->face(int(edge.first & 0xffffffffu), int(edge.first >> 32)) >= 0; });
}

Shell weldShell(
  std::span<const Vec3> points, std::span<const std::vector<int>> faces, const std::string& name)
{
  if (points.size() < 4)
  {
    throw GeometryError(
      name + ": has " + std::to_string(points.size()) + " points; a polyhedron has at least 4");
  }
  Vec3 low = points.front(), high = points.front();
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!points[i].allFinite())
    {
      throw GeometryError(name + ": point " + std::to_string(i) + " is " + pointText(points[i]) +
        "; coordinates must be finite");
    }
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  checkLoops(faces, points.size(), name);

  // Differences of nearby numbers are exact: about this origin large coordinates keep their digits.
  const Vec3 origin = low + 0.5 * (high - low);
  std::vector<Vec3> local(points.size());
  std::transform(
    points.begin(), points.end(), local.begin(), [&](const Vec3& p) -> Vec3 { return p - origin; });
  Shell shell;
  shell.extent = (high - low).norm();
  if (!(shell.extent > 0.0) || !std::isfinite(shell.extent))
  {
    throw GeometryError(name + ": its points extend over " + numberText(shell.extent) +
      " m; a polyhedron has a positive, finite size");
  }

  const std::vector<int> same = coincident(local, weldTolerance * shell.extent);
  std::vector<int> newIds(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (same[i] == int(i))
    {
      newIds[i] = int(shell.points.size());
      shell.points.push_back(local[i]);
      shell.pointIds.push_back(int(i));
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    newIds[i] = newIds[same[i]];
  }
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    std::vector<int> loop = weldedLoop(faces[f], newIds);
    if (loop.empty())
    {
      continue;
    }
    std::vector<int> sorted = loop;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end())
    {
      throw GeometryError(name + ": face " + std::to_string(f) + " passes point " +
        std::to_string(shell.pointIds[*twice]) + " twice");
    }
    shell.faces.push_back(std::move(loop));
    shell.faceIds.push_back(int(f));
  }
  return shell;
}

} // namespace rockfall
