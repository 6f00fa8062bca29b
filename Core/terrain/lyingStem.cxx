// A lying stem: a straight arch over the ground between two places. Its section is the upper half of
// the octagon about the stem's circle, whose sides go down into the ground; both ends are closed.

#include "base/errors.h"
#include "base/text/numberText.h"
#include "law/settings.h"
#include "terrain/Obstacles.h"
#include "terrain/Terrain.h"
#include "terrain/doubt.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

constexpr int kArch = 6; ///< Corners of a section: foot, side, top, top, side, foot.

Vec3 placed(const LyingStem& stem, const Vec3& unit)
{
  const Vec3 way = stem.to - stem.from;
  const Eigen::Vector2d left = Eigen::Vector2d(-way.y(), way.x()).normalized();
  Vec3 place = stem.from + unit.x() * way;
  place.head<2>() += unit.y() * stem.radius * left;
  place.z() += unit.z() < 0.0 ? -stem.depth : unit.z() * stem.rise;
  return place;
}

} // namespace

const ObstacleMesh& Obstacles::lyingShape()
{
  static const ObstacleMesh shape = []
  {
    ObstacleMesh mesh;
    constexpr double t = std::numbers::sqrt2 - 1.0; // half a side of the octagon
    for (const double x : { 0.0, 1.0 })
    {
      const double section[kArch][2] = { { -1, -1 }, { -1, t }, { -t, 1 }, { t, 1 }, { 1, t },
        { 1, -1 } };
      for (const auto& [y, z] : section)
      {
        mesh.nodes.emplace_back();
        mesh.nodes.back().position = Vec3(x, y, z);
      }
    }
    const auto add = [&](int a, int b, int c)
    {
      mesh.triangles.emplace_back();
      mesh.triangles.back().nodes = { a, b, c };
    };
    for (int k = 0; k + 1 < kArch; ++k)
    {
      add(k, kArch + k, kArch + k + 1);
      add(k, kArch + k + 1, k + 1);
    }
    for (int k = 1; k + 1 < kArch; ++k)
    {
      add(0, k, k + 1);
      add(kArch, kArch + k + 1, kArch + k);
    }
    mesh.connect();
    return mesh;
  }();
  return shape;
}

LyingStem Obstacles::lay(const Tree& tree, const Terrain& terrain)
{
  const auto ground = [&](const Eigen::Vector2d& p) { return terrain.elevation(p.x(), p.y()); };
  const Eigen::Vector2d way = tree.end - tree.position;
  const double length = way.norm();
  if (!(length > 0.0 && length <= kLongestStem))
  {
    throw ParameterError("feature " + std::to_string(tree.feature) +
      ": the length of the lying stem is " + numberText(length) +
      " m, it must be above 0 and at "
      "most " +
      numberText(kLongestStem) + " m");
  }
  for (const Eigen::Vector2d& p : { tree.position, tree.end })
  {
    if (std::isnan(ground(p)))
    {
      const GridGeometry& g = terrain.geometry();
      throw DataError("feature " + std::to_string(tree.feature) + ": the lying stem ends at " +
        numberText(p.x() + g.xOrigin) + ", " + numberText(p.y() + g.yOrigin) +
        ", where the terrain has no ground");
    }
  }
  // A cylinder that touches a plane has its axis r / cos θ over it.
  const double cell = terrain.geometry().cellSize;
  const Eigen::Vector2d middle = tree.position + 0.5 * way,
                        left = Eigen::Vector2d(-way.y(), way.x()) / length;
  double across = (ground(middle + 0.5 * cell * left) - ground(middle - 0.5 * cell * left)) / cell;
  across = std::isnan(across) ? 0.0 : across;
  const double along = (ground(tree.end) - ground(tree.position)) / length;
  const double r = 0.5 * tree.diameter;
  const double lift = r * std::sqrt(1.0 + along * along + across * across);
  LyingStem stem;
  stem.radius = r;
  stem.rise = r * std::sqrt(1.0 + along * along);
  stem.from = { tree.position.x(), tree.position.y(), ground(tree.position) + lift };
  stem.to = { tree.end.x(), tree.end.y(), ground(tree.end) + lift };
  const int pieces = std::max(1, int(std::ceil(4.0 * length / cell)));
  for (int k = 0; k <= pieces; ++k)
  {
    const Vec3 axis = stem.from + (double(k) / pieces) * (stem.to - stem.from);
    const double clear = axis.z() - ground(axis.head<2>());
    if (!std::isnan(clear))
    {
      stem.hollow = std::max(stem.hollow, clear - lift);
      stem.buried = std::max(stem.buried, -clear - stem.rise);
    }
    for (const double side : { -r, 0.0, r })
    {
      const double under = axis.z() - ground(axis.head<2>() + side * left);
      stem.depth = std::isnan(under) ? stem.depth : std::max(stem.depth, under);
    }
  }
  stem.depth += kFootDepth + terrain.roughnessDepth();
  return stem;
}

Vec3 Obstacles::lyingCorner(const LyingStem& stem, int corner)
{
  return placed(stem, lyingShape().nodes[std::size_t(corner)].position);
}

void Obstacles::askAfterLying(std::vector<std::string>& notes) const
{
  Doubt hollow("stems that lie",
    "Under a stem that bridges a hollow rocks pass; here it is a wall down to the ground: "
    "end the line where the stem leaves the ground");
  Doubt buried("stems that lie",
    "The stem is straight from end to end: give the line points where the ground rises");
  for (std::size_t k = 0; k < lyingNumbers_.size(); ++k)
  {
    if (const LyingStem* stem = this->lyingOf(int(k)))
    {
      const std::string name = featureText(structures_.trees[k].feature);
      hollow.look(stem->hollow <= 2.0 * stem->radius, name,
        [&] { return ", up to " + numberText(stem->hollow, 2) + " m over the ground"; });
      buried.look(stem->buried <= 0.0, name,
        [&] { return ", up to " + numberText(stem->buried, 2) + " m under it"; });
    }
  }
  tellAll(notes, hollow, buried);
}

bool Obstacles::isIn(const LyingStem& stem, const Vec3& place)
{
  const Vec3 way = stem.to - stem.from;
  const Eigen::Vector2d level = way.head<2>(), off = (place - stem.from).head<2>();
  const double s = off.dot(level) / level.squaredNorm();
  const double beside = std::abs(level.x() * off.y() - level.y() * off.x()) / level.norm();
  return s >= 0.0 && s <= 1.0 && beside < stem.radius &&
    place.z() < stem.from.z() + s * way.z() + stem.rise;
}

} // namespace rockfall
