/// Every way in which a polyhedron can fail to be made, and what the message says.

#include "base/errors.h"
#include "cubeFaces.h"
#include "geometry/Polyhedron.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

/// Runs a maker that must throw GeometryError with these words.
template <typename Maker>
void expectFault(const Maker& maker, const std::vector<std::string>& words)
{
  try
  {
    maker();
    ADD_FAILURE() << "made: " << words.front();
  }
  catch (const GeometryError& error)
  {
    const std::string text = error.what();
    EXPECT_EQ(text.rfind("rock 7: ", 0), 0u) << text;
    for (const std::string& word : words)
    {
      EXPECT_NE(text.find(word), std::string::npos) << text;
    }
  }
}

void expectFacesFault(
  const std::vector<Vec3>& points, const Faces& faces, const std::vector<std::string>& words)
{
  expectFault([&] { Polyhedron::fromFaces(points, faces, "rock 7"); }, words);
}

void expectHullFault(const std::vector<Vec3>& points, const std::vector<std::string>& words)
{
  expectFault([&] { Polyhedron::convexHull(points, "rock 7"); }, words);
}

} // namespace

TEST(PolyhedronErrors, Points)
{
  std::vector<Vec3> points = cubePoints();
  points[5].y() = NAN;
  expectFacesFault(points, cubeFaces, { "point 5", "nan", "finite" });
  expectHullFault(points, { "point 5", "nan", "finite" });
  points[5].y() = std::numeric_limits<double>::infinity();
  expectFacesFault(points, cubeFaces, { "point 5", "inf" });
  expectHullFault({}, { "0 points", "at least 4" });
  expectHullFault({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { "3 points" });
  expectHullFault({ 5, Vec3(1, 2, 3) }, { "extend over 0 m" });
  expectHullFault({ { -1e300, 0, 0 }, { 1e300, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { "inf m" });
  expectHullFault({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 1, 1e-12 } }, { "3 of its 4" });
  expectHullFault({ { 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 }, { 3, 3, 3 } }, { "one plane" });
  expectHullFault({ { 0, 0, 5 }, { 1, 0, 5 }, { 0, 1, 5 }, { 1, 1, 5 }, { 0.3, 0.2, 5 } },
    { "5 points", "plane" });
  expectHullFault({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.3, 2e-5 } }, { "degenerate" });
}

TEST(PolyhedronErrors, Loops)
{
  const std::vector<Vec3> points = cubePoints();
  Faces faces = cubeFaces;
  faces[3] = { 2, 6 };
  expectFacesFault(points, faces, { "face 3", "2 points" });
  faces[3] = { 2, 6, 8, 3 };
  expectFacesFault(points, faces, { "face 3", "point 8", "8 points" });
  faces[3] = { 2, 6, -1, 3 };
  expectFacesFault(points, faces, { "face 3", "point -1" });
  faces[3] = { 2, 6, 7, 6, 3 };
  expectFacesFault(points, faces, { "face 3", "point 6 twice" });
  expectFacesFault(points, {}, { "0 faces" });
}

TEST(PolyhedronErrors, Planarity)
{
  std::vector<Vec3> points = cubePoints();
  points[7] += Vec3(0.1, 0.0, 0.0);
  expectFacesFault(points, cubeFaces, { "face 1 is not planar", "m off its plane" });
}

TEST(PolyhedronErrors, Closedness)
{
  Faces faces(cubeFaces.begin(), cubeFaces.end() - 1); // the lid is off
  expectFacesFault(cubePoints(), faces, { "open", "4 edges have", "face 0", "points 4 and 6" });
  Faces tetrahedron = { { 0, 1, 2 } };
  expectFacesFault(cubePoints(), tetrahedron, { "open", "3 edges" });

  // A fin along an edge, both sides of it: four faces at the edge 0–1.
  faces = cubeFaces;
  faces.push_back({ 0, 1, 8 });
  faces.push_back({ 1, 0, 8 });
  std::vector<Vec3> points = cubePoints();
  points.emplace_back(0.5, -1.0, -1.0);
  expectFacesFault(points, faces, { "4 faces meet", "points 0 and 1" });
}

TEST(PolyhedronErrors, Orientation)
{
  Faces faces = cubeFaces;
  std::reverse(faces[5].begin(), faces[5].end());
  expectFacesFault(cubePoints(), faces, { "face 5 points inwards" });
  faces = cubeFaces;
  std::reverse(faces[0].begin(), faces[0].end());
  expectFacesFault(cubePoints(), faces, { "face 0 points inwards" });
  for (std::size_t f = 1; f < faces.size(); ++f)
  {
    std::reverse(faces[f].begin(), faces[f].end());
  }
  expectFacesFault(cubePoints(), faces, { "the faces point inwards", "-1 m³" });
}

TEST(PolyhedronErrors, Convexity)
{
  // A cube whose lid is a pit: a pyramid pointing down.
  std::vector<Vec3> points = cubePoints();
  points.emplace_back(0.5, 0.5, 0.6);
  Faces faces(cubeFaces.begin(), cubeFaces.end() - 1);
  for (const auto& [a, b] : { std::pair(4, 5), std::pair(5, 7), std::pair(7, 6), std::pair(6, 4) })
  {
    faces.push_back({ a, b, 8 });
  }
  expectFacesFault(points, faces, { "not convex", "outside face 5" });

  // Two bodies in one list.
  points = cubePoints();
  faces = cubeFaces;
  for (int i = 0; i < 8; ++i)
  {
    points.push_back(points[i] + Vec3(3.0, 0.0, 0.0));
  }
  for (const std::vector<int>& loop : cubeFaces)
  {
    faces.push_back({ loop[0] + 8, loop[1] + 8, loop[2] + 8, loop[3] + 8 });
  }
  expectFacesFault(points, faces, { "not convex", "m outside face 1" });
}

TEST(PolyhedronErrors, Slivers)
{
  std::vector<Vec3> points = cubePoints();
  for (Vec3& p : points)
  {
    p.z() *= 3e-5;
  }
  expectFacesFault(points, cubeFaces, { "degenerate" });
  for (Vec3& p : points)
  {
    p.z() = 0.0;
  }
  expectFacesFault(points, { { 0, 1, 3, 2 }, { 0, 2, 3, 1 } }, { "2 faces", "at least 4" });
}

} // namespace rockfall
