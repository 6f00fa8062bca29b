#pragma once

/// @file
/// A tilted box of 1.3 m × 0.9 m × 0.7 m where a national grid has it, and its files.

#include "base/types.h"

#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace meshTexts
{

using rockfall::Mat3;
using rockfall::Vec3;

constexpr double boxVolume = 0.819; // m³
const Vec3 farAway(500123.0, 5200456.0, 812.0);

inline std::vector<Vec3> corners(const Vec3& middle = farAway)
{
  const Mat3 turn = (Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * Eigen::AngleAxisd(0.54, Vec3::UnitX()))
                      .toRotationMatrix();
  std::vector<Vec3> points;
  for (int k = 0; k < 8; ++k)
  {
    const Vec3 corner(k & 1 ? 0.65 : -0.65, k & 2 ? 0.45 : -0.45, k & 4 ? 0.35 : -0.35);
    points.push_back(middle + turn * corner);
  }
  return points;
}

constexpr int triangles[12][3] = { { 0, 3, 1 }, { 0, 2, 3 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 },
  { 0, 5, 4 }, { 1, 3, 7 }, { 1, 7, 5 }, { 3, 2, 6 }, { 3, 6, 7 }, { 2, 0, 4 }, { 2, 4, 6 } };

/// Like printf.
template <typename... Values>
std::string print(const char* format, Values... values)
{
  char text[300];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

inline std::string pointLine(const char* format, const Vec3& p)
{
  return print(format, p.x(), p.y(), p.z());
}

/// A number's bytes in either order.
template <typename T>
std::string bytesOf(T value, bool big = false)
{
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

inline std::string objText(
  const std::vector<Vec3>& points, const char* format = "v %.5f %.5f %.5f\n")
{
  std::string text;
  for (const Vec3& p : points)
  {
    text += pointLine(format, p);
  }
  for (const auto& t : triangles)
  {
    text += print("f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

inline std::string stlText(const std::vector<Vec3>& points)
{
  std::string text = "solid r\n";
  for (const auto& t : triangles)
  {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int k : t)
    {
      text += pointLine("vertex %.5f %.5f %.5f\n", points[std::size_t(k)]);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid r\n";
}

inline std::string stlBytes(const std::vector<Vec3>& points)
{
  std::string bytes = "solid in spite of its bytes";
  bytes.resize(80, '\0');
  bytes += bytesOf(std::uint32_t(12));
  for (const auto& t : triangles)
  {
    bytes.append(12, '\0');
    for (int k : t)
    {
      for (const double coordinate : points[std::size_t(k)])
      {
        bytes += bytesOf(float(coordinate));
      }
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

/// Of `format` ascii, binary_little_endian or binary_big_endian, with more than is needed in it.
inline std::string ply(
  const std::vector<Vec3>& points, const std::string& format, const std::string& type = "double")
{
  std::string bytes = "ply\nformat " + format + " 1.0\ncomment a box\nelement vertex 8\nproperty " +
    type + " x\nproperty " + type + " y\nproperty " + type +
    " z\nproperty uchar red\nelement face 12\n"
    "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n";
  const bool text = format == "ascii", big = format == "binary_big_endian";
  for (const Vec3& p : points)
  {
    if (text)
    {
      bytes += pointLine("%.5f %.5f %.5f 255\n", p);
      continue;
    }
    for (const double coordinate : p)
    {
      bytes += type == "double" ? bytesOf(coordinate, big) : bytesOf(float(coordinate), big);
    }
    bytes += '\xFF';
  }
  for (const auto& t : triangles)
  {
    if (text)
    {
      bytes += print("3 %d %d %d 0\n", t[0], t[1], t[2]);
      continue;
    }
    bytes += '\x03';
    for (int k : t)
    {
      bytes += bytesOf(std::int32_t(k), big);
    }
    bytes += '\0';
  }
  return bytes;
}

} // namespace meshTexts
