// The reader of meshes: double precision whatever the format, and no byte that could bring it down.

#include "base/errors.h"
#include "geometry/Polyhedron.h"
#include "mesh/meshFile.h"
#include "mesh/precision.h"
#include "mesh/shapeFile.h"
#include "meshTexts.h"

#include <gtest/gtest.h>

#include <cctype>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

using namespace rockfall;
using namespace meshTexts;

namespace
{

struct MeshText
{
  std::string extension, bytes;
};

/// The box in every format.
std::vector<MeshText> allFormats(const Vec3& middle = farAway)
{
  const std::vector<Vec3> points = corners(middle);
  return { { ".obj", objText(points) }, { ".stl", stlText(points) },
    { ".ply", ply(points, "ascii") }, { ".ply", ply(points, "binary_little_endian") },
    { ".ply", ply(points, "binary_big_endian") } };
}

double volumeOf(const Mesh& mesh)
{
  return Polyhedron::fromFaces(mesh.points, mesh.faces).integrals().volume;
}

/// The message of a FileError; "" if the bytes are read. Anything else is a failure.
std::string complaint(const MeshText& sample)
{
  try
  {
    parseMesh(sample.extension, sample.bytes, "file");
  }
  catch (const FileError& error)
  {
    return error.what();
  }
  return {};
}

std::string written(const std::string& name, const std::string& bytes)
{
  const auto path = std::filesystem::temp_directory_path() / ("rockfall." + name);
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

/// The message of readShape's error.
std::string shapeError(const std::string& name, const std::string& bytes)
{
  const std::string file = written(name, bytes);
  std::vector<std::string> notes;
  std::string message;
  try
  {
    readShape(file, true, notes);
  }
  catch (const Error& error)
  {
    message = error.what();
  }
  std::filesystem::remove(file);
  return message;
}

bool has(const std::string& text, const std::string& words)
{
  return text.find(words) != std::string::npos;
}

} // namespace

TEST(MeshFiles, DoublePrecisionInEveryFormat)
{
  for (const MeshText& sample : allFormats())
  {
    SCOPED_TRACE(sample.extension + " " + sample.bytes.substr(0, 40));
    const Mesh mesh = parseMesh(sample.extension, sample.bytes, "file");
    ASSERT_EQ(mesh.points.size(), 8u);
    ASSERT_EQ(mesh.faces.size(), 12u);
    // The text has 10 µm.
    EXPECT_NEAR(volumeOf(mesh), boxVolume, 1e-4);
    EXPECT_EQ(mesh.rounding, 0.0);
  }
}

TEST(MeshFiles, SinglePrecisionFarFromTheOriginIsAnErrorWithTheRemedy)
{
  const std::vector<Vec3> away = corners();
  std::vector<Vec3> rounded = away;
  for (Vec3& p : rounded)
  {
    p = p.cast<float>().cast<double>();
  }
  std::string obj; // of a program that keeps single precision and writes all digits of it
  for (const Vec3& p : rounded)
  {
    obj += pointLine("v %.9g %.9g %.9g\n", p);
  }
  obj += objText(away).substr(objText(away).find("f "));
  const std::pair<std::string, std::string> files[] = { { "a.stl", stlBytes(away) },
    { "a.ply", ply(away, "binary_little_endian", "float") },
    { "b.ply", ply(away, "binary_big_endian", "float") },
    { "c.ply", ply(rounded, "binary_little_endian", "double") }, { "d.obj", obj },
    { "e.obj", objText(rounded, "v %.3f %.3f %.3f\n") },
    { "f.obj", objText(rounded, "v %.10e %.10e %.10e\n") } };
  for (const auto& [name, bytes] : files)
  {
    const std::string message = shapeError(name, bytes);
    EXPECT_TRUE(has(message, name) && has(message, "in single precision") &&
      has(message, "0.25 m") && has(message, "near the origin"))
      << message;
  }
  // Near the origin the same will do, and a box of round numbers is exact anywhere.
  const std::vector<Vec3> near = corners(Vec3(3.0, -2.0, 1.0));
  EXPECT_EQ(shapeError("d.stl", stlBytes(near)), "");
  EXPECT_EQ(shapeError("e.ply", ply(near, "binary_little_endian", "float")), "");
  std::vector<Vec3> round;
  for (int k = 0; k < 8; ++k)
  {
    round.emplace_back(500123 + (k & 1), 5200456 + (k & 2), 812.5 + (k & 4));
  }
  EXPECT_EQ(shapeError("f.obj", objText(round)), "");
  for (Vec3& p : round)
  {
    p += Vec3(0.5, 0.5, 0.13);
  }
  EXPECT_EQ(shapeError("f.obj", objText(round, "v %.10g %.10g %.10g\n")), "");
  EXPECT_EQ(shapeError("g.ply", ply(round, "binary_little_endian", "double")), "");
}

TEST(MeshFiles, TextOfTooFewDigitsIsAnErrorToo)
{
  const std::vector<Vec3> away = corners();
  const std::vector<Vec3> swiss = corners(Vec3(600123.0, 200456.0, 812.0));
  for (const auto& [points, format] :
    { std::pair(away, "v %g %g %g\n"), { away, "v %e %e %e\n" }, { swiss, "v %g %g %g\n" } })
  {
    const std::string message = shapeError("digits.obj", objText(points, format));
    EXPECT_TRUE(has(message, "digits, of") || has(message, "digits: rounded")) << message;
  }
  EXPECT_EQ(shapeError("digits.obj", objText(away, "v %.12e %.12e %.12e\n")), "");
  EXPECT_EQ(shapeError("digits.obj", objText(corners(Vec3(20, 30, 40)), "v %g %g %g\n")), "");
}

TEST(MeshFiles, StatementsThatSayNothingOfTheShapeArePassedOver)
{
  const std::vector<Vec3> points = corners();
  std::string obj = "# box\nmtllib a.mtl\no box\n" + objText(points);
  obj.insert(obj.find("f "), "vt 0 0\nvn 0 0 1\ng all\nusemtl rock\ns off\n");
  EXPECT_NEAR(volumeOf(parseMesh(".obj", obj, "f")), boxVolume, 1e-4);
  // Texture and normal beside the point, a face over two lines, numbers from the last point.
  std::string other = objText(points).substr(0, objText(points).find("f "));
  for (const auto& t : triangles)
  {
    other += print("f %d/1/1 \\\n %d//2 %d\n", t[0] - 8, t[1] + 1, t[2] + 1);
  }
  EXPECT_NEAR(volumeOf(parseMesh(".obj", other, "f")), boxVolume, 1e-4);
  std::string windows = stlText(points);
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
  {
    windows.replace(at, 1, "\r\n");
  }
  EXPECT_NEAR(volumeOf(parseMesh(".stl", windows, "f")), boxVolume, 1e-4);
  std::string loud = stlText(points);
  for (char& c : loud)
  {
    c = char(std::toupper(c));
  }
  EXPECT_NEAR(volumeOf(parseMesh(".stl", loud, "f")), boxVolume, 1e-4);
}

TEST(MeshFiles, StripsAreTriangles)
{
  // A tetrahedron as one strip and as a face list.
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                           "property float y\nproperty float z\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const Mesh faces = parseMesh(".ply",
    head + "element face 4\nproperty list uchar int vertex_index\nend_header\n" + points +
      "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
    "f");
  const Mesh strips = parseMesh(".ply",
    head + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + points +
      "10 0 2 1 3 -1 0 3 2 -1 -1\n",
    "f");
  EXPECT_NEAR(volumeOf(faces), 1.0 / 6.0, 1e-12);
  ASSERT_EQ(strips.faces.size(), 3u);
  EXPECT_EQ(strips.faces[1], (std::vector<int>{ 2, 3, 1 }));
}

TEST(MeshFiles, WhatLiesIsToldByNameAndPlace)
{
  const std::string plyHead = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list ";
  const std::string plyPoints = "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  const struct
  {
    MeshText sample;
    const char* words;
  } lies[] = {
    // A list of −5, and one whose length is a real number that leads back.
    { { ".ply", plyHead + "char int vertex_indices\n" + plyPoints + "-5 1 2 3\n" }, "-5 numbers" },
    { { ".ply",
        binary + "element vertex 1000000000000000000\nproperty list double char x\nend_header\n" +
          std::string(32, '\xff') },
      "line 4" },
    { { ".ply", plyHead + "int int vertex_indices\n" + plyPoints + "2000000000 1 2 3\n" },
      "2000000000 numbers" },
    { { ".ply", plyHead + "uchar float vertex_indices\n" + plyPoints + "3 0 1 2\n" }, "float" },
    { { ".ply", plyHead + "uchar int vertex_indices\n" + plyPoints + "3 0 1 7\n" }, "point 7" },
    { { ".ply", plyHead + "uchar int vertex_indices\n" + plyPoints + "2 0 1\n" }, "2 points" },
    { { ".ply", binary + "element vertex 9000000000\nproperty char x\nend_header\nabc" },
      "9000000000" },
    { { ".ply", binary + "element nothing 9000000000\nend_header\nabc" }, "nothing" },
    { { ".ply", "ply\nformat ascii 1.0\nelement vertex -3\nend_header\n" }, "line 3" },
    { { ".ply", "ply\nelement vertex 0\nend_header\n" }, "no format" },
    { { ".obj", " 0 1\nv 1 0 0 1\nfN8 9Fi vt 0 0\n f 4/1/" }, "line 1" },
    { { ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n" }, "vertex -4" },
    { { ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n" }, "\"0\"" },
    { { ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999\n" }, "point -1" },
    { { ".obj", "v 0 0\n" }, "three numbers" },
    { { ".stl", "solid a\nfacet normal 0 0 0\nouter loop\nvert loop\nvertex 0 0 0\n" },
      "\"vert\"" },
    { { ".stl", "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 zero\n" }, "\"zero\"" },
    { { ".stl", std::string(80, ' ') + bytesOf(std::uint32_t(4000000000)) + "abc" }, "4000000000" },
    { { ".stl", "s" }, "no STL" },
    { { ".obj", "" }, "empty" },
  };
  for (const auto& [sample, words] : lies)
  {
    const std::string message = complaint(sample);
    EXPECT_TRUE(has(message, "file") && has(message, words))
      << sample.extension << ", wanted " << words << ", got: " << message;
  }
}

TEST(MeshFiles, NoFileOfBytesThatWereChangedBringsItDown)
{
  std::mt19937 random(20);
  const auto start = std::chrono::steady_clock::now();
  int read = 0, refused = 0;
  for (int round = 0; round < 400; ++round)
  {
    for (MeshText sample : allFormats(Vec3(1, 2, 3)))
    {
      const int changes = 1 + int(random() % 4);
      for (int k = 0; k < changes; ++k)
      {
        const std::size_t at = random() % sample.bytes.size();
        switch (random() % 4)
        {
          case 0:
            sample.bytes[at] = char(random());
            break;
          case 1:
            sample.bytes.erase(at, random() % 40);
            break;
          case 2:
            sample.bytes.insert(at, print("%d", int(random())));
            break;
          default:
            sample.bytes.insert(at, sample.bytes.substr(random() % sample.bytes.size(), 30));
        }
        sample.bytes += ' ';
      }
      (complaint(sample).empty() ? read : refused) += 1;
    }
  }
  EXPECT_GT(read, 50);
  EXPECT_GT(refused, 1000);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 60.0);
}

TEST(MeshFiles, AFolderOrAPipeIsNoFile)
{
  EXPECT_THROW(readMesh("/tmp"), FileError);
  EXPECT_THROW(readMesh("/dev/zero.ply"), FileError);
  EXPECT_THROW(readFile("/dev/zero"), FileError);
}
