#include "geometry/Polyhedron.h"

#include "base/require.h"
#include "base/text/numberText.h"
#include "geometry/roundBody.h"
#include "geometry/shell.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Largest distance of a point from the plane through three points that lie far apart.
double thickness(const std::vector<Vec3>& points)
{
  const auto farthest = [&](const auto& distance) -> const Vec3&
  {
    return *std::max_element(points.begin(), points.end(),
      [&](const Vec3& a, const Vec3& b) { return distance(a) < distance(b); });
  };
  const Vec3& a = farthest([](const Vec3& p) { return p.squaredNorm(); });
  const Vec3& b = farthest([&](const Vec3& p) { return (p - a).squaredNorm(); });
  const Vec3 along = (b - a).normalized();
  const auto across = [&](const Vec3& p) -> Vec3 { return (p - a) - along * along.dot(p - a); };
  const Vec3& c = farthest([&](const Vec3& p) { return across(p).squaredNorm(); });
  const Vec3 normal = along.cross(across(c)).normalized();
  const auto height = [&](const Vec3& p) { return std::abs(normal.dot(p - a)); };
  return height(farthest(height));
}

/// Merges as coarsely as leaves a valid polyhedron. The finest tolerance merges what is coplanar
/// but for the rounding of doubles.
Shell mergedShell(const Shell& shell, const std::string& name)
{
  std::string fault = "its coplanar faces do not merge into simple polygons";
  for (const double tolerance : { planeTolerance, 1e-9, 1e-12 })
  {
    if (std::optional<Shell> merged = mergeCoplanar(shell, tolerance * shell.extent))
    {
      fault = convexityFault(*merged);
      if (fault.empty())
      {
        return std::move(*merged);
      }
    }
  }
  throw GeometryError(name + ": " + fault);
}

} // namespace

Polyhedron Polyhedron::fromFaces(
  std::span<const Vec3> points, std::span<const std::vector<int>> faces, const std::string& name)
{
  const Shell shell = weldShell(points, faces, name);
  checkPlanar(shell, name);
  checkClosed(shell, name);
  checkVolume(shell, name);
  // Before the merging too, which of a body that is not convex makes loops that say little.
  const std::string fault = convexityFault(shell);
  if (!fault.empty())
  {
    throw GeometryError(name + ": " + fault);
  }
  return Polyhedron::fromShell(mergedShell(shell, name), points, name);
}

Polyhedron Polyhedron::convexHull(std::span<const Vec3> points, const std::string& name)
{
  Shell shell = weldShell(points, {}, name);
  if (shell.points.size() < 4)
  {
    throw GeometryError(name + ": only " + std::to_string(shell.points.size()) + " of its " +
      std::to_string(points.size()) + " points are distinct; a convex hull needs at least 4");
  }
  if (!(thickness(shell.points) > planeTolerance * shell.extent))
  {
    throw GeometryError(name + ": its " + std::to_string(points.size()) +
      " points lie in one plane, within " + numberText(planeTolerance * shell.extent) +
      " m; a convex hull needs a volume");
  }

  // Qhull's thresholds are met at unit size as they were tried; a scale changes no topology.
  std::vector<Vec3> unit(shell.points.size());
  std::transform(shell.points.begin(), shell.points.end(), unit.begin(),
    [&](const Vec3& p) -> Vec3 { return p / shell.extent; });
  shell.faces = hullFaces(unit, name);

  // Points inside the hull are left behind here: the checks need not look at them.
  Shell surface;
  surface.extent = shell.extent;
  surface.faces = std::move(shell.faces);
  std::vector<int> newIds(shell.points.size(), -1);
  for (std::vector<int>& loop : surface.faces)
  {
    surface.faceIds.push_back(int(surface.faceIds.size()));
    for (int& id : loop)
    {
      if (newIds[id] < 0)
      {
        newIds[id] = int(surface.points.size());
        surface.points.push_back(shell.points[id]);
        surface.pointIds.push_back(shell.pointIds[id]);
      }
      id = newIds[id];
    }
  }
  checkVolume(surface, name);
  return Polyhedron::fromShell(mergedShell(surface, name), points, name);
}

Polyhedron Polyhedron::fromShell(
  const Shell& shell, std::span<const Vec3> points, const std::string& name)
{
  Parts result;
  for (const int id : shell.pointIds)
  {
    result.vertices.push_back(points[id]); // as given, to the last digit
  }
  result.faces = shell.faces;
  const DirectedEdges sides(shell.faces);
  result.neighbours.resize(result.vertices.size());
  for (std::size_t f = 0; f < shell.faces.size(); ++f)
  {
    const std::vector<int>& loop = shell.faces[f];
    result.normals.push_back(facePlane(shell.points, loop).normal);
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      const int other = sides.face(b, a);
      if (int(f) < other)
      {
        result.edges.push_back({ { a, b }, { int(f), other } });
        result.neighbours[a].push_back(b);
        result.neighbours[b].push_back(a);
      }
    }
  }
  const int euler =
    int(result.vertices.size()) - int(result.edges.size()) + int(result.faces.size());
  if (euler != 2)
  {
    throw GeometryError(name +
      ": is not one simple body: vertices − edges + faces = " + std::to_string(euler) + ", not 2");
  }
  result.integrals = integrateSimplices(result.vertices, result.faces);
  result.updateDistances();
  if (isRound(result.layout))
  {
    result.integrals = roundBodyOf(result.vertices, result.normals, result.offsets)->integrals();
    result.updateDistances();
  }
  return Polyhedron(std::move(result));
}

Polyhedron::Polyhedron(Parts parts)
  : parts_(std::make_shared<const Parts>(std::move(parts)))
{
}

const std::shared_ptr<const Polyhedron::Parts>& Polyhedron::nothing()
{
  static const std::shared_ptr<const Parts> parts = std::make_shared<const Parts>();
  return parts;
}

void Polyhedron::Parts::updateDistances()
{
  offsets.resize(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    double sum = 0.0;
    for (const int id : faces[f])
    {
      sum += normals[f].dot(vertices[id]);
    }
    offsets[f] = sum / double(faces[f].size());
  }
  radius = 0.0;
  for (const Vec3& vertex : vertices)
  {
    radius = std::max(radius, (vertex - integrals.centroid).norm());
  }
  layout = ShapeLayout(vertices, faces, normals, offsets);
  if (isRound(layout))
  {
    radius = std::max(radius, roundAxes(layout).operatorNorm());
  }
}

Polyhedron Polyhedron::transformed(double scale, const Quat& rotation, const Vec3& shift) const
{
  require(scale > 0.0 && std::isfinite(scale), "the scale of a polyhedron", scale, "",
    "positive and finite");
  if (!rotation.coeffs().allFinite() || !(rotation.norm() > 0.0) || !shift.allFinite())
  {
    throw ParameterError("the rotation and the shift of a polyhedron must be finite, the rotation "
                         "not zero");
  }
  const Mat3 turn = rotation.normalized().toRotationMatrix();
  Parts result = *parts_;
  for (Vec3& vertex : result.vertices)
  {
    vertex = scale * (turn * vertex) + shift;
  }
  for (Vec3& normal : result.normals)
  {
    normal = (turn * normal).normalized();
  }
  const double cubed = scale * scale * scale;
  result.integrals.volume = cubed * result.integrals.volume;
  result.integrals.centroid = scale * (turn * result.integrals.centroid) + shift;
  result.integrals.second =
    cubed * scale * scale * (turn * result.integrals.second * turn.transpose());
  // From the new vertices, not from the old offsets: a shift to the origin wins digits back.
  result.updateDistances();
  return Polyhedron(std::move(result));
}

Polyhedron Polyhedron::centred() const
{
  // Twice, because the centroid of a body far from the origin is itself rounded.
  Parts once = *this->transformed(1.0, Quat::Identity(), -this->integrals().centroid).parts_;
  once.integrals = isRound(once.layout)
    ? roundBodyOf(once.vertices, once.normals, once.offsets)->integrals()
    : integrateSimplices(once.vertices, once.faces);
  const Vec3 rest = once.integrals.centroid;
  return Polyhedron(std::move(once)).transformed(1.0, Quat::Identity(), -rest);
}

Polyhedron Polyhedron::withVolume(double volume) const
{
  require(volume > 0.0 && std::isfinite(volume), "Volume", volume, " m³", "positive and finite");
  if (!(this->integrals().volume > 0.0))
  {
    throw GeometryError("polyhedron: has no faces yet, so no volume can be given to it");
  }
  const double scale = std::cbrt(volume / this->integrals().volume);
  return this->centred().transformed(scale, Quat::Identity(), this->integrals().centroid);
}

} // namespace rockfall
