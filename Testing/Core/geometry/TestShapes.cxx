/// Every shape against its closed form: counts, volume, moments of inertia, radius.

#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace rockfall
{

namespace
{

// Some hundred products and sums of numbers near 1.
constexpr double kShapeRounding = 1e-13;

struct Expected
{
  Shape shape;
  int vertices, edges, faces;
  std::map<int, int> polygons; ///< Number of faces by number of corners.
  double edge;                 ///< Length of the edges at unit volume, m; 0 if they differ.
  double secondMoment;         ///< ∫x² dV = ∫y² dV = ∫z² dV at unit volume, m⁵.
  double radius;               ///< Of the vertices at unit volume, m.
};

/// Names of tests would have its bytes.
void PrintTo(const Expected& expected, std::ostream* out)
{
  *out << shapeName(expected.shape);
}

std::string printName(const ::testing::TestParamInfo<Expected>& info)
{
  return shapeName(info.param.shape);
}

/// Platonic solids of edge a: V = v a³, ∫x² dV = j V a² by symmetry, circumradius r a.
Expected platonic(
  Shape shape, int vertices, int edges, int faces, int corners, double v, double j, double r)
{
  const double a = 1.0 / std::cbrt(v);
  return { shape, vertices, edges, faces, { { corners, faces } }, a, j * a * a, r * a };
}

std::vector<Expected> expectations()
{
  const double s2 = std::sqrt(2.0), s5 = std::sqrt(5.0);
  const double phi = std::numbers::phi;
  return {
    platonic(Shape::Cube, 8, 12, 6, 4, 1.0, 1.0 / 12.0, std::sqrt(3.0) / 2.0),
    platonic(Shape::Tetrahedron, 4, 6, 4, 3, s2 / 12.0, 1.0 / 40.0, std::sqrt(6.0) / 4.0),
    platonic(Shape::Octahedron, 6, 12, 8, 3, s2 / 3.0, 1.0 / 20.0, s2 / 2.0),
    platonic(Shape::Dodecahedron, 20, 30, 12, 5, (15.0 + 7.0 * s5) / 4.0,
      (39.0 * phi + 28.0) / 300.0, std::sqrt(3.0) * phi / 2.0),
    platonic(Shape::Icosahedron, 12, 30, 20, 3, 5.0 * (3.0 + s5) / 12.0, phi * phi / 20.0,
      std::sqrt(phi * s5) / 2.0),
  };
}

} // namespace

class Platonic : public ::testing::TestWithParam<Expected>
{
};

TEST_P(Platonic, ClosedForm)
{
  const Expected& expected = GetParam();
  const Polyhedron body = makeShape(expected.shape, 1.0);
  EXPECT_EQ(int(body.vertices().size()), expected.vertices);
  EXPECT_EQ(int(body.edges().size()), expected.edges);
  EXPECT_EQ(int(body.faces().size()), expected.faces);
  std::map<int, int> polygons;
  for (const std::vector<int>& loop : body.faces())
  {
    ++polygons[int(loop.size())];
  }
  EXPECT_EQ(polygons, expected.polygons);
  for (const Polyhedron::Edge& edge : body.edges())
  {
    const Vec3 along = body.vertices()[edge.vertices[1]] - body.vertices()[edge.vertices[0]];
    EXPECT_NEAR(along.norm(), expected.edge, kShapeRounding);
  }
  const Mat3 second = expected.secondMoment * Mat3::Identity();
  EXPECT_LT((body.integrals().second - second).norm(), kShapeRounding);
  for (const Vec3& vertex : body.vertices())
  {
    EXPECT_NEAR(vertex.norm(), expected.radius, kShapeRounding);
  }
  EXPECT_NEAR(body.radius(), expected.radius, kShapeRounding);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Platonic, ::testing::ValuesIn(expectations()), printName);

TEST(Shapes, VolumeAndCentroidAreExact)
{
  for (const Shape shape : { Shape::Cube, Shape::Tetrahedron, Shape::Octahedron,
         Shape::Dodecahedron, Shape::Icosahedron, Shape::Eota111, Shape::Eota221 })
  {
    for (const double volume : { 1e-6, 0.3, 1.0, 500.0 }) // m³
    {
      const Polyhedron body = makeShape(shape, volume);
      const VolumeIntegrals integrals = integrateSimplices(body.vertices(), body.faces());
      EXPECT_NEAR(integrals.volume / volume, 1.0, kShapeRounding) << shapeName(shape);
      EXPECT_NEAR(body.integrals().volume / volume, 1.0, kShapeRounding) << shapeName(shape);
      EXPECT_LT(integrals.centroid.norm(), kShapeRounding * std::cbrt(volume)) << shapeName(shape);
      EXPECT_EQ(body.integrals().centroid, Vec3(Vec3::Zero())) << shapeName(shape);
    }
  }
}

TEST(Shapes, CubeHasItsEdgesAlongTheAxes)
{
  const Polyhedron cube = makeShape(Shape::Cube, 8.0);
  for (const Polyhedron::Edge& edge : cube.edges())
  {
    const Vec3 along = cube.vertices()[edge.vertices[1]] - cube.vertices()[edge.vertices[0]];
    EXPECT_NEAR(along.cwiseAbs().maxCoeff(), 2.0, kShapeRounding);
    EXPECT_EQ(along.cwiseAbs().sum(), along.cwiseAbs().maxCoeff());
  }
}

namespace
{

/// The EOTA block is { |x|, |y|, |z| ≤ 1, |x|+|y| ≤ 3/2 …, |x|+|y|+|z| ≤ 2 } · L/2. Its moments by
/// midpoint slices of one octant; the error falls as the square of the step.
Vec3 eotaByCounting(double& volume)
{
  constexpr int n = 161; // odd: no midpoint falls on the outline x + y = 3/2
  const double step = 1.0 / n;
  volume = 0.0;
  Vec3 moments = Vec3::Zero();
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      const double x = (i + 0.5) * step, y = (j + 0.5) * step;
      const double top = std::min({ 1.0, 1.5 - x, 1.5 - y, 2.0 - x - y });
      if (x + y <= 1.5)
      {
        const double column = step * step * top;
        volume += 8.0 * column;
        moments += 8.0 * Vec3(column * x * x, column * y * y, column * top * top / 3.0);
      }
    }
  }
  return moments;
}

} // namespace

TEST(Shapes, Eota111)
{
  const Polyhedron body = makeShape(Shape::Eota111, 17.0 / 24.0 * 8.0); // L = 2 m
  EXPECT_EQ(body.vertices().size(), 24u);
  EXPECT_EQ(body.edges().size(), 48u);
  // Squares of L/2 on the 6 sides, rectangles L/2 × L √2/4 over the 12 edges, triangles on the
  // corners.
  std::map<std::pair<int, int>, int> faces; // by corners and number of non-zero normal components
  for (std::size_t f = 0; f < body.faces().size(); ++f)
  {
    int components = 0;
    for (int k = 0; k < 3; ++k)
    {
      components += std::abs(body.normals()[f][k]) > 0.1;
    }
    ++faces[{ int(body.faces()[f].size()), components }];
  }
  const std::map<std::pair<int, int>, int> expected = { { { 4, 1 }, 6 }, { { 4, 2 }, 12 },
    { { 3, 3 }, 8 } };
  EXPECT_EQ(faces, expected);
  for (const Vec3& vertex : body.vertices())
  {
    Vec3 sorted = vertex.cwiseAbs();
    std::sort(sorted.begin(), sorted.end());
    EXPECT_LT((sorted - Vec3(0.5, 0.5, 1.0)).norm(), kShapeRounding);
  }
  double volume = 0.0;
  const Vec3 moments = eotaByCounting(volume);
  // Second order in the step of 1/161 m, over 8 octants: 8/161² = 3e-4.
  EXPECT_NEAR(body.integrals().volume, volume, 5e-4);
  EXPECT_LT((body.integrals().second.diagonal() - moments).norm(), 5e-4);
  EXPECT_LT(
    (body.integrals().second - Mat3(body.integrals().second.diagonal().asDiagonal())).norm(),
    kShapeRounding);
}

TEST(Shapes, Eota221IsEota111WithItsThirdAxisHalved)
{
  const Mat3 round = makeShape(Shape::Eota111, 2.0).integrals().second;
  const Polyhedron platy = makeShape(Shape::Eota221, 1.0);
  EXPECT_EQ(platy.vertices().size(), 24u);
  EXPECT_EQ(platy.faces().size(), 26u);
  const Vec3 expected(0.5 * round(0, 0), 0.5 * round(1, 1), 0.125 * round(2, 2));
  EXPECT_LT((platy.integrals().second - Mat3(expected.asDiagonal())).norm(), kShapeRounding);
}

TEST(Shapes, EotaHasThePublishedSize)
{
  const auto extent = [](const Polyhedron& body)
  {
    Vec3 largest = Vec3::Zero();
    for (const Vec3& vertex : body.vertices())
    {
      largest = largest.cwiseMax(2.0 * vertex);
    }
    return largest;
  };
  // Published in millimetres.
  EXPECT_LT(
    (extent(makeShape(Shape::Eota111, 1.0)) - Vec3::Constant(1.122)).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(
    (extent(makeShape(Shape::Eota221, 1.0)) - Vec3(1.414, 1.414, 0.707)).cwiseAbs().maxCoeff(),
    1e-3);
}

TEST(Shapes, Box)
{
  const Vec3 lengths(2.0, 1.0, 0.25); // m
  const Polyhedron box = makeBox(lengths);
  EXPECT_NEAR(box.integrals().volume, 0.5, kShapeRounding);
  EXPECT_LT(box.integrals().centroid.norm(), kShapeRounding);
  const Mat3 expected = (0.5 / 12.0 * lengths.cwiseAbs2()).asDiagonal();
  EXPECT_LT((box.integrals().second - expected).norm(), kShapeRounding);
  EXPECT_EQ(box.faces().size(), 6u);
  EXPECT_NEAR(box.radius(), 0.5 * lengths.norm(), kShapeRounding);
}

TEST(Shapes, BadVolumesAndLengths)
{
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double volume : { 0.0, -2.5, infinite, double(NAN) })
  {
    EXPECT_THROW(makeShape(Shape::Cube, volume), ParameterError) << volume;
    EXPECT_THROW(makeShape(Shape::Eota221, volume), ParameterError) << volume;
    EXPECT_THROW(makeBox({ 1.0, volume, 1.0 }), ParameterError) << volume;
  }
  try
  {
    makeShape(Shape::Octahedron, -2.5);
    FAIL();
  }
  catch (const ParameterError& error)
  {
    EXPECT_NE(std::string(error.what()).find("octahedron is -2.5 m³"), std::string::npos)
      << error.what();
  }
  try
  {
    makeBox({ 1.0, 1.0, -0.5 });
    FAIL();
  }
  catch (const ParameterError& error)
  {
    EXPECT_NE(
      std::string(error.what()).find("Lengths: the z length of the box is -0.5"), std::string::npos)
      << error.what();
  }
  for (const double thin : { 1e-6, 1e-12 }) // a sheet of paper, and one of no faces
  {
    try
    {
      makeBox({ 1.0, 1.0, thin });
      FAIL();
    }
    catch (const ParameterError& error)
    {
      EXPECT_NE(
        std::string(error.what()).find("Lengths are 1, 1 and " + numberText(thin) + " m, of which"),
        std::string::npos)
        << error.what();
    }
  }
  EXPECT_THROW(makeShape(Shape::Box, 1.0), ParameterError);
  EXPECT_THROW(makeShape(Shape::File, 1.0), ParameterError);
  EXPECT_THROW(makeShape(Shape(kShapes), 1.0), ParameterError);
  EXPECT_THROW(makeShape(Shape(-1), 1.0), ParameterError);
}

TEST(Shapes, NamesAndBack)
{
  for (int i = 0; i <= 8; ++i)
  {
    EXPECT_EQ(shapeFromName(shapeName(Shape(i))), Shape(i));
  }
  EXPECT_EQ(shapeName(Shape::Eota111), "eota111");
  EXPECT_EQ(shapeFromName("EOTA221"), Shape::Eota221);
  EXPECT_EQ(shapeFromName("Cube"), Shape::Cube);
  try
  {
    shapeFromName("boulder");
    FAIL();
  }
  catch (const ParameterError& error)
  {
    const std::string text = error.what();
    EXPECT_NE(text.find("\"boulder\""), std::string::npos) << text;
    EXPECT_NE(text.find("cube, tetrahedron"), std::string::npos) << text;
    EXPECT_NE(text.find("file"), std::string::npos) << text;
  }
  EXPECT_THROW(shapeFromName(""), ParameterError);
}

} // namespace rockfall
