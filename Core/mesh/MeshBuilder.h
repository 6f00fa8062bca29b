#pragma once

/// @file
/// Points and faces of a file in the making, within what a rock's shape may have.

#include "base/errors.h"
#include "mesh/Mesh.h"
#include "mesh/precision.h"

#include <algorithm>
#include <span>

namespace rockfall
{

class MeshBuilder
{
public:
  explicit MeshBuilder(std::string name)
    : name_(std::move(name))
  {
  }

  std::int64_t points() const { return std::int64_t(mesh_.points.size()); }

  void addPoint(const Vec3& point)
  {
    this->limit(mesh_.points.size(), "points");
    mesh_.points.push_back(point);
  }
  /// Numbers beyond an int become −1, which no point has.
  void addFace(std::span<const std::int64_t> ids)
  {
    this->limit(mesh_.faces.size(), "faces");
    std::vector<int>& face = mesh_.faces.emplace_back();
    face.reserve(ids.size());
    for (const std::int64_t id : ids)
    {
      face.push_back(id >= 0 && id < kMostMeshPoints ? int(id) : -1);
    }
  }
  /// The triangles of a strip, wound alike.
  void addStrip(std::span<const std::int64_t> ids)
  {
    for (std::size_t k = 2; k < ids.size(); ++k)
    {
      const bool odd = k % 2 == 1;
      const std::int64_t triangle[] = { ids[k - 2], ids[odd ? k : k - 1], ids[odd ? k - 1 : k] };
      // A strip that turns a corner repeats a point.
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
      {
        this->addFace(triangle);
      }
    }
  }
  void note(std::string text) { mesh_.notes.push_back(std::move(text)); }

  /// `single`: the file has its coordinates in single precision. `digits`: of those of a text.
  Mesh finish(bool single, const WrittenDigits& digits = {})
  {
    const double bySingle =
      single || (digits.any() ? digits.lookSingle() : rockfall::lookSingle(mesh_.points))
      ? singleRounding(largestCoordinate(mesh_.points))
      : 0.0;
    const double byDigits = digits.rounding();
    mesh_.rounding = std::max(bySingle, byDigits);
    mesh_.stored = byDigits > bySingle ? digits.describe() : "in single precision";
    return std::move(mesh_);
  }

private:
  void limit(std::size_t count, const char* of) const
  {
    if (std::int64_t(count) >= kMostMeshPoints)
    {
      throw FileError(name_ + ": has more than " + std::to_string(kMostMeshPoints) + " " + of +
        ", which no shape of a rock needs: thin it out");
    }
  }

  std::string name_;
  Mesh mesh_;
};

} // namespace rockfall
