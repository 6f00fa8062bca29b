#include "base/text/numberText.h"
#include "geometry/shell.h"

#include "base/errors.h"
#include "geometry/simplexIntegration.h"

#include <cmath>

namespace rockfall
{

namespace
{

std::string faceText(const Shell& shell, int face)
{
  return "face " + std::to_string(shell.faceIds[face]);
}

std::string edgeText(const Shell& shell, int a, int b)
{
  return "between points " + std::to_string(shell.pointIds[a]) + " and " +
    std::to_string(shell.pointIds[b]);
}

Vec3 middle(const Shell& shell, const std::vector<int>& loop)
{
  Vec3 sum = Vec3::Zero();
  for (const int id : loop)
  {
    sum += shell.points[id];
  }
  return sum / double(loop.size());
}

/// An undirected edge and the faces along it.
struct EdgeUse
{
  int a = 0, b = 0; ///< As in the loop of the first face.
  std::vector<int> forward, backward;
};

std::vector<EdgeUse> edgeUses(const Shell& shell)
{
  std::vector<EdgeUse> uses;
  std::unordered_map<std::uint64_t, std::size_t> index;
  for (std::size_t f = 0; f < shell.faces.size(); ++f)
  {
    const std::vector<int>& loop = shell.faces[f];
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      const std::uint64_t key = std::uint64_t(std::min(a, b)) << 32 | std::uint32_t(std::max(a, b));
      const auto place = index.emplace(key, uses.size());
      if (place.second)
      {
        uses.push_back({ a, b, {}, {} });
      }
      EdgeUse& use = uses[place.first->second];
      (use.a == a ? use.forward : use.backward).push_back(int(f));
    }
  }
  return uses;
}

} // namespace

void checkPlanar(const Shell& shell, const std::string& name)
{
  for (std::size_t f = 0; f < shell.faces.size(); ++f)
  {
    const FacePlane plane = facePlane(shell.points, shell.faces[f]);
    if (plane.deviation > planeTolerance * shell.extent)
    {
      throw GeometryError(name + ": " + faceText(shell, int(f)) + " is not planar: point " +
        std::to_string(shell.pointIds[plane.farthest]) + " is " + numberText(plane.deviation) +
        " m off its plane");
    }
  }
}

void checkClosed(const Shell& shell, const std::string& name)
{
  const std::vector<EdgeUse> uses = edgeUses(shell);
  int open = 0;
  const EdgeUse* firstOpen = nullptr;
  for (const EdgeUse& use : uses)
  {
    if (use.forward.size() + use.backward.size() == 1)
    {
      ++open;
      firstOpen = firstOpen ? firstOpen : &use;
    }
  }
  if (shell.faces.size() < 4 && !firstOpen)
  {
    throw GeometryError(
      name + ": has " + std::to_string(shell.faces.size()) + " faces; a polyhedron has at least 4");
  }
  if (firstOpen)
  {
    throw GeometryError(name + ": the surface is open: " + std::to_string(open) +
      (open == 1 ? " edge has" : " edges have") + " a face on one side only, such as that of " +
      faceText(shell, firstOpen->forward.front()) + " " +
      edgeText(shell, firstOpen->a, firstOpen->b));
  }

  Vec3 centre = Vec3::Zero();
  for (const std::vector<int>& loop : shell.faces)
  {
    centre += middle(shell, loop) / double(shell.faces.size());
  }
  for (const EdgeUse& use : uses)
  {
    const std::size_t count = use.forward.size() + use.backward.size();
    if (count > 2)
    {
      throw GeometryError(name + ": " + std::to_string(count) + " faces meet at the edge " +
        edgeText(shell, use.a, use.b) + " (" + faceText(shell, use.forward.front()) +
        " is one of them); 2 may");
    }
    if (use.forward.size() == 2)
    {
      int inward = use.forward[0], other = use.forward[1];
      const Vec3 arm = middle(shell, shell.faces[inward]) - centre;
      if (facePlane(shell.points, shell.faces[inward]).normal.dot(arm) > 0.0)
      {
        std::swap(inward, other);
      }
      throw GeometryError(name + ": " + faceText(shell, inward) +
        " points inwards: it is wound against " + faceText(shell, other) + " at the edge " +
        edgeText(shell, use.a, use.b));
    }
  }
}

void checkVolume(const Shell& shell, const std::string& name)
{
  double area = 0.0;
  for (const std::vector<int>& loop : shell.faces)
  {
    area += facePlane(shell.points, loop).area;
  }
  const double volume = integrateSimplices(shell.points, shell.faces).volume;
  if (!(3.0 * std::abs(volume) > leastDepth * shell.extent * area))
  {
    throw GeometryError(name + ": is degenerate: it encloses " + numberText(volume) +
      " m³ within " + numberText(area) + " m² of faces and an extent of " +
      numberText(shell.extent) + " m");
  }
  if (volume < 0.0)
  {
    throw GeometryError(name + ": the faces point inwards (signed volume " + numberText(volume) +
      " m³); their points must run counter-clockwise seen from outside");
  }
}

std::string convexityFault(const Shell& shell)
{
  const double tolerance = planeTolerance * shell.extent;
  for (std::size_t f = 0; f < shell.faces.size(); ++f)
  {
    const FacePlane plane = facePlane(shell.points, shell.faces[f]);
    if (!(plane.width > weldTolerance * shell.extent))
    {
      continue; // no plane of its own; lies in a neighbour's, or the merging does not end well
    }
    const Vec3& first = shell.points[shell.faces[f].front()];
    int worst = -1;
    double worstExcess = 0.0;
    for (std::size_t v = 0; v < shell.points.size(); ++v)
    {
      const double height = plane.normal.dot(shell.points[v]) - plane.offset;
      if (height <= tolerance)
      {
        continue;
      }
      // A narrow face, its points off by the tolerance, holds its plane loosely at a distance.
      const double reach = (shell.points[v] - first).norm() / plane.width;
      const double excess = height - tolerance * (1.0 + reach);
      if (excess > worstExcess)
      {
        worst = int(v);
        worstExcess = excess;
      }
    }
    if (worst >= 0)
    {
      return "is not convex: point " + std::to_string(shell.pointIds[worst]) + " stands " +
        numberText(plane.normal.dot(shell.points[worst]) - plane.offset) + " m outside " +
        faceText(shell, int(f));
    }
  }
  return {};
}

} // namespace rockfall
