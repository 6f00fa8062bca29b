/// Polyhedra from faces and as hulls: topology, oracles, transformations, large coordinates.

#include "base/errors.h"
#include "cubeFaces.h"
#include "geometry/shapes.h"
#include "geometry/simplexIntegration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

// Some hundred products and sums of numbers near 1.
constexpr double rounding = 1e-13;
const Vec3 utm(5e5, 4e6, 1024.0); // m
// Doubles near 4e6 are 2⁻³¹ m apart.
constexpr double utmRounding = 0x1p-31;

Faces triangulated(const Faces& faces)
{
  Faces result;
  for (const std::vector<int>& loop : faces)
  {
    for (std::size_t i = 2; i < loop.size(); ++i)
    {
      result.push_back({ loop[0], loop[i - 1], loop[i] });
    }
  }
  return result;
}

std::vector<Vec3> randomPoints(int count, unsigned seed, bool onSphere = false)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Vec3> points;
  while (int(points.size()) < count)
  {
    const Vec3 p(uniform(generator), uniform(generator), uniform(generator));
    if (p.norm() <= 1.0 && p.norm() > 0.1)
    {
      points.push_back(onSphere ? p.normalized() : p);
    }
  }
  return points;
}

/// What must hold of every polyhedron.
void expectSound(const Polyhedron& body)
{
  EXPECT_EQ(int(body.vertices().size()) - int(body.edges().size()) + int(body.faces().size()), 2);
  const double tolerance = 2e-6 * body.radius(); // the plane tolerance is 1e-6 of the extent
  std::set<std::pair<int, int>> directed;
  for (std::size_t f = 0; f < body.faces().size(); ++f)
  {
    const std::vector<int>& loop = body.faces()[f];
    EXPECT_NEAR(body.normals()[f].norm(), 1.0, rounding);
    EXPECT_LT(body.normals()[f].dot(body.integrals().centroid), body.offsets()[f]);
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      directed.emplace(loop[i], loop[(i + 1) % loop.size()]);
      EXPECT_NEAR(body.normals()[f].dot(body.vertices()[loop[i]]), body.offsets()[f], tolerance);
    }
  }
  EXPECT_EQ(directed.size(), 2 * body.edges().size());
  std::vector<std::set<int>> neighbours(body.vertices().size());
  for (const Polyhedron::Edge& edge : body.edges())
  {
    const auto [a, b] = edge.vertices;
    EXPECT_TRUE(directed.count({ a, b }) && directed.count({ b, a }));
    const std::vector<int>& loop = body.faces()[edge.faces[0]];
    const auto place = std::find(loop.begin(), loop.end(), a);
    ASSERT_NE(place, loop.end());
    EXPECT_EQ(place + 1 == loop.end() ? loop.front() : place[1], b);
    const Vec3 turn = body.normals()[edge.faces[0]].cross(body.normals()[edge.faces[1]]);
    EXPECT_GT(turn.dot(body.vertices()[b] - body.vertices()[a]), 0.0) << "not a convex edge";
    neighbours[a].insert(b);
    neighbours[b].insert(a);
  }
  for (std::size_t v = 0; v < neighbours.size(); ++v)
  {
    const std::vector<int>& listed = body.neighbours(int(v));
    EXPECT_EQ(std::set<int>(listed.begin(), listed.end()), neighbours[v]);
    EXPECT_GE(listed.size(), 3u);
  }
}

} // namespace

TEST(Polyhedron, CubeKeepsItsFacesAsGiven)
{
  const Polyhedron cube = Polyhedron::fromFaces(cubePoints(), cubeFaces);
  expectSound(cube);
  EXPECT_EQ(cube.faces(), cubeFaces);
  EXPECT_EQ(cube.vertices(), cubePoints());
  EXPECT_EQ(cube.normals()[1], Vec3(Vec3::UnitX()));
  EXPECT_EQ(cube.offsets()[1], 1.0);
  EXPECT_NEAR(cube.integrals().volume, 1.0, rounding);
}

TEST(Polyhedron, TriangulatedCubeHasSixFaces)
{
  // Single precision, turned: the triangles of a side differ by some 1e-7.
  const Quat turn = Quat(0.3, 0.4, -0.5, 0.6).normalized();
  std::vector<Vec3> points;
  for (const Vec3& p : cubePoints())
  {
    points.push_back((turn * p).cast<float>().cast<double>());
  }
  for (const Polyhedron& cube :
    { Polyhedron::fromFaces(points, triangulated(cubeFaces)), Polyhedron::convexHull(points) })
  {
    expectSound(cube);
    EXPECT_EQ(cube.vertices().size(), 8u);
    EXPECT_EQ(cube.edges().size(), 12u);
    EXPECT_EQ(cube.faces().size(), 6u);
    EXPECT_NEAR(cube.integrals().volume, 1.0, 1e-6); // single precision
  }
}

TEST(Polyhedron, DuplicatePointsAreWelded)
{
  // As in an STL file: every triangle has its own points. One of them is 1e-10 off.
  const std::vector<Vec3> corners = cubePoints();
  std::vector<Vec3> points;
  Faces faces;
  for (const std::vector<int>& loop : triangulated(cubeFaces))
  {
    faces.emplace_back();
    for (const int id : loop)
    {
      faces.back().push_back(int(points.size()));
      points.push_back(corners[id]);
    }
  }
  points[17].x() += 1e-10;
  const Polyhedron cube = Polyhedron::fromFaces(points, faces);
  expectSound(cube);
  EXPECT_EQ(cube.vertices().size(), 8u);
  EXPECT_EQ(cube.faces().size(), 6u);
}

TEST(Polyhedron, CollinearVerticesAndSliversVanish)
{
  // The middle of the edge 0–1 is a vertex of both its faces; a triangle of no area (0, 8, 1) fills
  // the seam to the bottom, which does not know it.
  std::vector<Vec3> points = cubePoints();
  points.emplace_back(0.5, 0.0, 0.0);
  Faces faces = cubeFaces;
  faces[2] = { 0, 8, 1, 5, 4 };
  Faces seam = faces;
  faces[4] = { 0, 2, 3, 1, 8 };
  seam.push_back({ 0, 1, 8 });
  for (const Faces& list : { faces, seam })
  {
    const Polyhedron cube = Polyhedron::fromFaces(points, list);
    expectSound(cube);
    EXPECT_EQ(cube.vertices().size(), 8u);
    EXPECT_EQ(cube.faces().size(), 6u);
    EXPECT_NEAR(cube.integrals().volume, 1.0, rounding);
  }
}

TEST(Polyhedron, HullAgainstAllTriples)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    const std::vector<Vec3> points = randomPoints(30, seed);
    Vec3 inside = Vec3::Zero();
    for (const Vec3& p : points)
    {
      inside += p / double(points.size());
    }
    double volume = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      for (std::size_t j = i + 1; j < points.size(); ++j)
      {
        for (std::size_t k = j + 1; k < points.size(); ++k)
        {
          const Vec3 normal = (points[j] - points[i]).cross(points[k] - points[i]);
          const auto above = std::count_if(points.begin(), points.end(),
            [&](const Vec3& p) { return normal.dot(p - points[i]) > 1e-12; });
          const auto below = std::count_if(points.begin(), points.end(),
            [&](const Vec3& p) { return normal.dot(p - points[i]) < -1e-12; });
          if (above == 0 || below == 0)
          {
            volume += std::abs(normal.dot(inside - points[i])) / 6.0;
            ++count;
          }
        }
      }
    }
    const Polyhedron hull = Polyhedron::convexHull(points);
    expectSound(hull);
    EXPECT_EQ(hull.faces().size(), count) << seed;
    EXPECT_NEAR(hull.integrals().volume, volume, rounding) << seed;
  }
}

TEST(Polyhedron, HullIntegralsAgainstMonteCarlo)
{
  const Polyhedron hull = Polyhedron::convexHull(randomPoints(40, 99));
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr int draws = 200000;
  const double weight = 8.0 / draws; // m³ per draw
  double volume = 0.0;
  Mat3 second = Mat3::Zero();
  for (int i = 0; i < draws; ++i)
  {
    const Vec3 p(uniform(generator), uniform(generator), uniform(generator));
    bool inside = true;
    for (std::size_t f = 0; inside && f < hull.faces().size(); ++f)
    {
      inside = hull.normals()[f].dot(p) <= hull.offsets()[f];
    }
    if (inside)
    {
      const Vec3 arm = p - hull.integrals().centroid;
      volume += weight;
      second += weight * arm * arm.transpose();
    }
  }
  // Four standard deviations of a count, 8 √(p (1 − p) / draws) ≤ 0.009 m³; those of the moments
  // are less, their integrands being below 1 m².
  EXPECT_NEAR(hull.integrals().volume, volume, 0.036);
  EXPECT_LT((hull.integrals().second - second).cwiseAbs().maxCoeff(), 0.036);
}

TEST(Polyhedron, HullOfTenThousandPoints)
{
  const std::vector<Vec3> points = randomPoints(10000, 3, true);
  const Polyhedron hull = Polyhedron::convexHull(points);
  EXPECT_EQ(int(hull.vertices().size()) - int(hull.edges().size()) + int(hull.faces().size()), 2);
  // Expected of n random points on the unit sphere, 4π/3 (n−1)(n−2)(n−3) / ((n+1)(n+2)(n+3)), exact
  // for n = 4 (4π/105); falls short of the sphere by 5e-3 m³, and scatters by a small part of that.
  const double n = double(points.size());
  const double share = (n - 1) * (n - 2) * (n - 3) / ((n + 1) * (n + 2) * (n + 3));
  const VolumeIntegrals mesh = integrateSimplices(hull.vertices(), hull.faces());
  EXPECT_NEAR(mesh.volume, 4.0 / 3.0 * std::numbers::pi * share, 3e-4);
  // So fine a mesh is taken as the sphere that it stands for.
  EXPECT_NEAR(hull.integrals().volume, 4.0 / 3.0 * std::numbers::pi, 1e-9);

  std::mt19937_64 generator(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i)
  {
    const Vec3 direction =
      Vec3(normal(generator), normal(generator), normal(generator)).normalized();
    const auto support = [&](const std::vector<Vec3>& set)
    {
      double largest = -1.0;
      for (const Vec3& p : set)
      {
        largest = std::max(largest, direction.dot(p));
      }
      return largest;
    };
    // Nearly coplanar faces merge within 1e-6 of the extent of 2 m.
    EXPECT_NEAR(support(hull.vertices()), support(points), 2e-6);
  }
}

TEST(Polyhedron, HullOfPointsOnTheSidesOfACube)
{
  std::vector<Vec3> points;
  const Quat turn = Quat(0.9, 0.2, -0.3, 0.1).normalized();
  for (int i = 0; i <= 8; ++i)
  {
    for (int j = 0; j <= 8; ++j)
    {
      for (int k = 0; k <= 8; ++k)
      {
        points.push_back(turn * Vec3(i, j, k) / 8.0 + utm);
      }
    }
  }
  const Polyhedron cube = Polyhedron::convexHull(points);
  expectSound(cube);
  EXPECT_EQ(cube.vertices().size(), 8u);
  EXPECT_EQ(cube.faces().size(), 6u);
  EXPECT_NEAR(cube.integrals().volume, 1.0, 20 * utmRounding); // 8 corners, each rounded thrice
}

TEST(Polyhedron, HullIsShiftInvariant)
{
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    std::vector<Vec3> near = randomPoints(100, seed), far;
    for (Vec3& p : near)
    {
      p = (p * 1024.0).array().round() / 1024.0; // exact at both places
      far.push_back(p + utm);
    }
    const Polyhedron here = Polyhedron::convexHull(near);
    const Polyhedron there = Polyhedron::convexHull(far);
    ASSERT_EQ(here.faces().size(), there.faces().size());
    ASSERT_EQ(here.vertices().size(), there.vertices().size());
    EXPECT_NEAR(here.integrals().volume, there.integrals().volume, rounding);
    EXPECT_LT((here.integrals().second - there.integrals().second).norm(), rounding);
    EXPECT_NEAR(here.radius(), there.radius(), 2 * utmRounding);

    const Polyhedron a = here.centred(), b = there.centred();
    const VolumeIntegrals again = integrateSimplices(b.vertices(), b.faces());
    EXPECT_LT(again.centroid.norm(), rounding);
    EXPECT_NEAR(a.radius(), b.radius(), rounding);
  }
}

TEST(Polyhedron, HullIsSilent)
{
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Polyhedron::convexHull(randomPoints(500, 8, true));
  Polyhedron::convexHull(cubePoints());
  EXPECT_THROW(Polyhedron::convexHull(std::vector<Vec3>(10, Vec3::Zero())), GeometryError);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Polyhedron, Transformed)
{
  const Polyhedron body = Polyhedron::convexHull(randomPoints(20, 17));
  const Quat turn = Quat(0.1, 0.7, -0.2, 0.4).normalized();
  const Vec3 shift(3.0, -2.0, 7.0);
  const Polyhedron moved = body.transformed(1.5, turn, shift);
  expectSound(moved);
  EXPECT_EQ(moved.faces(), body.faces());
  const Vec3 expected = 1.5 * (turn * body.vertices()[3]) + shift;
  EXPECT_LT((moved.vertices()[3] - expected).norm(), rounding);
  const VolumeIntegrals exact = integrateSimplices(moved.vertices(), moved.faces());
  EXPECT_NEAR(moved.integrals().volume, exact.volume, 100 * rounding); // of some 10 m³
  EXPECT_LT((moved.integrals().centroid - exact.centroid).norm(), 100 * rounding);
  EXPECT_LT((moved.integrals().second - exact.second).norm(), 100 * rounding);
  EXPECT_NEAR(moved.radius(), 1.5 * body.radius(), 10 * rounding);
  // A quaternion that is not of unit length turns all the same and does not scale.
  const Polyhedron twice = body.transformed(1.5, Quat(2.0 * turn.coeffs()), shift);
  EXPECT_LT((twice.vertices()[3] - expected).norm(), rounding);

  const double infinite = std::numeric_limits<double>::infinity();
  for (const double scale : { 0.0, -1.0, infinite, double(NAN) })
  {
    EXPECT_THROW(body.transformed(scale, turn, shift), ParameterError) << scale;
  }
  EXPECT_THROW(body.transformed(1.0, Quat(0, 0, 0, 0), shift), ParameterError);
  EXPECT_THROW(body.transformed(1.0, turn, { 0, NAN, 0 }), ParameterError);
}

TEST(Polyhedron, CentredAndWithVolume)
{
  std::vector<Vec3> points;
  for (const Vec3& p : randomPoints(30, 23))
  {
    points.push_back(p + utm);
  }
  const Polyhedron body = Polyhedron::convexHull(points);
  const Polyhedron centred = body.centred();
  EXPECT_EQ(centred.integrals().centroid, Vec3(Vec3::Zero()));
  const Polyhedron large = body.withVolume(27.0);
  EXPECT_NEAR(integrateSimplices(large.vertices(), large.faces()).volume, 27.0,
    1e3 * utmRounding); // 27 m³ of 3 m blocks whose corners are rounded: area × rounding
  EXPECT_LT((large.integrals().centroid - body.integrals().centroid).norm(), 4 * utmRounding);
  const Polyhedron small = centred.withVolume(1e-3);
  EXPECT_NEAR(integrateSimplices(small.vertices(), small.faces()).volume, 1e-3, 1e-3 * rounding);
  expectSound(small);

  EXPECT_THROW(body.withVolume(0.0), ParameterError);
  EXPECT_THROW(body.withVolume(-1.0), ParameterError);
  EXPECT_THROW(body.withVolume(NAN), ParameterError);
  EXPECT_THROW(Polyhedron().withVolume(1.0), GeometryError);
}

} // namespace rockfall
