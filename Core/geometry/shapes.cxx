#include "geometry/shapes.h"

#include "base/require.h"
#include "base/text/numberText.h"
#include "base/text/placeOfName.h"
#include "geometry/shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace rockfall
{

namespace
{

/// Longest axis to shortest: a longer mesh shows no ellipsoid, and rolls and stands as no rock does.
constexpr double kLongestEllipsoid = 5.0;

/// Names in the order of Shape.
constexpr std::array<const char*, kShapes> names = { "cube", "tetrahedron", "octahedron",
  "dodecahedron", "icosahedron", "box", "eota111", "eota221", "file", "sphere", "ellipsoid" };

/// All sign changes of the non-zero coordinates, in the three cyclic orders of the axes.
void addCyclic(std::vector<Vec3>& points, const Vec3& point)
{
  for (int turn = 0; turn < 3; ++turn)
  {
    for (int signs = 0; signs < 8; ++signs)
    {
      Vec3 p;
      bool wanted = true;
      for (int k = 0; k < 3; ++k)
      {
        const bool negative = signs >> k & 1;
        wanted = wanted && !(negative && point[k] == 0.0);
        p[(k + turn) % 3] = negative ? -point[k] : point[k];
      }
      if (wanted)
      {
        points.push_back(p);
      }
    }
  }
}

/// The vertices, about the origin, at any size.
std::vector<Vec3> corners(Shape shape)
{
  const double golden = std::numbers::phi;
  std::vector<Vec3> points;
  switch (shape)
  {
    case Shape::Tetrahedron: // every other corner of a cube
      return { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } };
    case Shape::Octahedron:
      addCyclic(points, { 1, 0, 0 });
      break;
    case Shape::Dodecahedron: // a cube with a roof on each face
      for (int signs = 0; signs < 8; ++signs)
      {
        points.emplace_back(signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1);
      }
      addCyclic(points, { 0, 1 / golden, golden });
      break;
    case Shape::Icosahedron: // three golden rectangles
      addCyclic(points, { 0, 1, golden });
      break;
    case Shape::Eota111: // METHOD 11 with L = 2
    case Shape::Eota221:
      addCyclic(points, { 1, 0.5, 0.5 });
      for (Vec3& point : points)
      {
        point.z() *= shape == Shape::Eota221 ? 0.5 : 1.0;
      }
      break;
    default:
      break;
  }
  return points;
}

/// The unit sphere as 20 · 4³ triangles: an icosahedron, each side halved three times.
struct RoundMesh
{
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;

  RoundMesh()
  {
    const Polyhedron start = Polyhedron::convexHull(corners(Shape::Icosahedron), "sphere");
    for (const Vec3& p : start.vertices())
    {
      points.push_back(p.normalized());
    }
    faces = start.faces();
    for (int k = 0; k < 3; ++k)
    {
      std::map<std::pair<int, int>, int> middles;
      const auto middle = [&](int a, int b)
      {
        const auto [at, isNew] = middles.try_emplace(std::minmax(a, b), int(points.size()));
        if (isNew)
        {
          points.push_back((points[std::size_t(a)] + points[std::size_t(b)]).normalized());
        }
        return at->second;
      };
      std::vector<std::vector<int>> finer;
      for (const std::vector<int>& f : faces)
      {
        const int a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
        finer.insert(finer.end(), { { f[0], a, c }, { a, f[1], b }, { c, b, f[2] }, { a, b, c } });
      }
      faces = std::move(finer);
    }
  }
};

Polyhedron roundShape(const Vec3& semiAxes, const std::string& name)
{
  static const RoundMesh mesh;
  std::vector<Vec3> points;
  for (const Vec3& p : mesh.points)
  {
    points.push_back(p.cwiseProduct(semiAxes));
  }
  return Polyhedron::fromFaces(points, mesh.faces, name).centred();
}

void requireLengths(const Vec3& lengths, const std::string& name)
{
  for (int k = 0; k < 3; ++k)
  {
    require(lengths[k] > 0.0 && std::isfinite(lengths[k]),
      std::string("Lengths: the ") + "xyz"[k] + " length of the " + name, lengths[k], " m",
      "positive and finite");
  }
}

} // namespace

Polyhedron makeShape(Shape shape, double volume)
{
  const std::string name = shapeName(shape);
  require(volume > 0.0 && std::isfinite(volume), "Volume of the " + name, volume, " m³",
    "positive and finite");
  if (shape == Shape::Cube)
  {
    return makeBox(Vec3::Constant(std::cbrt(volume)));
  }
  if (shape == Shape::Box || shape == Shape::Ellipsoid || shape == Shape::File)
  {
    throw ParameterError("Shape " + name +
      " is not made from a volume alone: a box and an ellipsoid need their lengths, a file its "
      "name");
  }
  if (shape == Shape::Sphere)
  {
    return roundShape(Vec3::Ones(), name).withVolume(volume);
  }
  return Polyhedron::convexHull(corners(shape), name).centred().withVolume(volume);
}

Polyhedron makeBox(const Vec3& lengths)
{
  requireLengths(lengths, "box");
  // Corner i has the bits of i for its sides: 1 = east, 2 = north, 4 = up.
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
  {
    points.emplace_back(0.5 * lengths.x() * (i & 1 ? 1 : -1), 0.5 * lengths.y() * (i & 2 ? 1 : -1),
      0.5 * lengths.z() * (i & 4 ? 1 : -1));
  }
  const std::vector<std::vector<int>> faces = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 },
    { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };
  try
  {
    return Polyhedron::fromFaces(points, faces, "box");
  }
  catch (const GeometryError& error)
  {
    // Errors of the faces say little of the three numbers.
    throw ParameterError("Lengths are " + numberText(lengths.x()) + ", " + numberText(lengths.y()) +
      " and " + numberText(lengths.z()) + " m, of which no box can be made (" + error.what() + ")");
  }
}

Polyhedron makeEllipsoid(const Vec3& lengths)
{
  requireLengths(lengths, "ellipsoid");
  if (lengths.maxCoeff() > kLongestEllipsoid * lengths.minCoeff())
  {
    throw ParameterError("Lengths are " + numberText(lengths.x()) + ", " + numberText(lengths.y()) +
      " and " + numberText(lengths.z()) + " m, of an ellipsoid none may be more than " +
      numberText(kLongestEllipsoid) + " times another one");
  }
  return roundShape(0.5 * lengths, "ellipsoid");
}

std::string shapeName(Shape shape)
{
  if (int(shape) < 0 || int(shape) >= kShapes)
  {
    throw ParameterError("Shape is " + std::to_string(int(shape)) + ", it must be 0 to " +
      std::to_string(kShapes - 1));
  }
  return names[std::size_t(shape)];
}

Shape shapeFromName(const std::string& name)
{
  return Shape(placeOfName(names, name, "Shape"));
}

} // namespace rockfall
