// The mesh of an embankment: stations along its line, at each the two corners of the crest and the
// two feet, strips of two triangles per piece between them, and an upright end on either side.

#include "base/errors.h"
#include "geometry/shell.h"
#include "terrain/Obstacles.h"
#include "terrain/Terrain.h"

#include <cmath>
#include <functional>

namespace rockfall
{

namespace
{

using Vec2 = Eigen::Vector2d;

/// How deep under the ground a foot goes, m, beyond what roughness may lower the ground by.
constexpr double kFootDepth = 0.5;
/// How far below its crest a side must have come to the ground, m.
constexpr double kLongestSide = 200.0;
/// A crest that is to follow the ground gets a station where it would be off by more than this part
/// of its height.
constexpr double kCrestTolerance = 0.05;
/// A mitre longer than this many widths folds.
constexpr double kLongestMitre = 5.0;

struct Station
{
  Vec2 place;
  double crest = 0.0;             ///< Elevation, m.
  bool drawn = true;              ///< A point of the line itself.
  Vec3 corner[2];                 ///< Left and right end of the crest.
  Vec2 out[2];                    ///< Way of the side per metre down.
  double depth[2] = { 0.0, 0.0 }; ///< Of the foot below the corner, m.

  Vec3 foot(int side) const
  {
    return corner[side] + depth[side] * Vec3(out[side].x(), out[side].y(), -1.0);
  }
};

class Builder
{
public:
  Builder(const Embankment& embankment, const Terrain& terrain)
    : it_(embankment)
    , terrain_(terrain)
  {
    const Roughness& r = terrain.roughness();
    margin_ = kFootDepth + std::max(0.0, -(r.mean - 9.0 * r.deviation));
    this->placeStations();
    this->chooseSides();
    // Stations that were added are dropped again where the sides of a bend need the room.
    for (int folded = this->shape(); folded >= 0; folded = this->shape())
    {
      const std::size_t i = std::size_t(folded);
      if (!stations_[i].drawn)
      {
        stations_.erase(stations_.begin() + folded);
      }
      else if (!stations_[i + 1].drawn)
      {
        stations_.erase(stations_.begin() + folded + 1);
      }
      else
      {
        this->fail(stations_[i].place,
          "bends so sharply, for the length of its pieces, that its sides fold over themselves; "
          "draw a gentler bend or two lines");
      }
    }
  }

  void append(ObstacleMesh& mesh) const
  {
    const std::size_t firstTriangle = mesh.triangles.size();
    const int first = int(mesh.nodes.size());
    for (const Station& s : stations_)
    {
      for (const Vec3& p : { s.foot(0), s.corner[0], s.corner[1], s.foot(1) })
      {
        mesh.nodes.emplace_back();
        mesh.nodes.back().position = p;
      }
    }
    const auto add = [&](int a, int b, int c)
    {
      mesh.triangles.emplace_back();
      mesh.triangles.back().nodes = { first + a, first + b, first + c };
    };
    const int last = 4 * (int(stations_.size()) - 1);
    for (int i = 0; i < last; i += 4)
    {
      for (int k = 0; k < 3; ++k)
      {
        add(i + k, i + k + 1, i + k + 5);
        add(i + k, i + k + 5, i + k + 4);
      }
    }
    add(1, 0, 3);
    add(1, 3, 2);
    add(last + 1, last + 3, last);
    add(last + 1, last + 2, last + 3);
    mesh.connect(firstTriangle);
  }

private:
  [[noreturn]] void fail(const Vec2& place, const std::string& what) const
  {
    const GridGeometry& g = terrain_.geometry();
    throw DataError("feature " + std::to_string(it_.feature) + ": the embankment, at " +
      numberText(place.x() + g.xOrigin) + ", " + numberText(place.y() + g.yOrigin) + ", " + what);
  }

  double groundAt(const Vec2& p) const { return terrain_.elevation(p.x(), p.y()); }

  void placeStations()
  {
    const bool follows = std::isnan(it_.elevation);
    const auto station = [&](const Vec2& p, bool drawn)
    {
      Station s;
      s.place = p;
      s.drawn = drawn;
      const double ground = this->groundAt(p);
      if (std::isnan(ground))
      {
        this->fail(p, "runs where the terrain has no ground");
      }
      s.crest = follows ? ground + it_.height : it_.elevation;
      buried_ = buried_ && s.crest <= ground;
      return s;
    };
    for (std::size_t k = 0; k < it_.points.size(); ++k)
    {
      if (k > 0)
      {
        const Vec2 a = it_.points[k - 1], way = it_.points[k] - a;
        const int n = std::max(1, int(std::ceil(2.0 * way.norm() / terrain_.geometry().cellSize)));
        std::vector<Station> profile;
        for (int i = 0; i <= n; ++i)
        {
          profile.push_back(station(a + (double(i) / n) * way, i == 0 || i == n));
        }
        std::vector<std::uint8_t> kept(profile.size(), 0);
        const std::function<void(int, int)> split = [&](int i, int j)
        {
          int worst = -1;
          double most = kCrestTolerance * it_.height;
          for (int m = i + 1; m < j; ++m)
          {
            const double f = double(m - i) / (j - i);
            const double off =
              std::abs(profile[m].crest - (1.0 - f) * profile[i].crest - f * profile[j].crest);
            if (off > most)
            {
              most = off;
              worst = m;
            }
          }
          if (worst > 0)
          {
            kept[std::size_t(worst)] = 1;
            split(i, worst);
            split(worst, j);
          }
        };
        if (follows)
        {
          split(0, n);
        }
        for (int i = 1; i < n; ++i)
        {
          if (kept[std::size_t(i)])
          {
            stations_.push_back(profile[std::size_t(i)]);
          }
        }
      }
      stations_.push_back(station(it_.points[k], true));
    }
    if (buried_)
    {
      this->fail(it_.points.front(),
        "has its crest at " + numberText(it_.elevation) + " m, under the ground all along");
    }
  }

  /// The mountain is where the ground is higher, a little way off the crest.
  void chooseSides()
  {
    const double off = 0.5 * it_.crestWidth + 2.0 * terrain_.geometry().cellSize;
    double balance = 0.0;
    for (std::size_t i = 0; i + 1 < stations_.size(); ++i)
    {
      const Vec2 way = stations_[i + 1].place - stations_[i].place;
      const Vec2 middle = stations_[i].place + 0.5 * way;
      const Vec2 normal = Vec2(-way.y(), way.x()).normalized();
      const double rise =
        this->groundAt(middle + off * normal) - this->groundAt(middle - off * normal);
      balance += std::isnan(rise) ? 0.0 : way.norm() * rise;
    }
    const bool left = balance >= 0.0;
    slope_[0] = left ? it_.mountainSlope : it_.valleySlope;
    slope_[1] = left ? it_.valleySlope : it_.mountainSlope;
  }

  /// Where two lines meet: a · x = p, b · x = q. False if they are parallel.
  static bool meet(const Vec2& a, double p, const Vec2& b, double q, Vec2& x)
  {
    const double d = a.x() * b.y() - a.y() * b.x();
    if (std::abs(d) < 1e-9 * a.norm() * b.norm())
    {
      return false;
    }
    x = Vec2(p * b.y() - q * a.y(), a.x() * q - b.x() * p) / d;
    return true;
  }

  /// Corners and feet of all stations. Number of the first piece that folds, −1 if none does.
  int shape()
  {
    const int count = int(stations_.size());
    std::vector<Vec2> along(std::size_t(count) - 1);
    for (int i = 0; i + 1 < count; ++i)
    {
      along[i] = (stations_[i + 1].place - stations_[i].place).normalized();
    }
    const auto left = [](const Vec2& t) { return Vec2(-t.y(), t.x()); };
    for (int side = 0; side < 2; ++side)
    {
      const double sign = side == 0 ? 1.0 : -1.0, half = 0.5 * it_.crestWidth;
      for (int i = 0; i < count; ++i)
      {
        const Vec2 a = sign * left(along[std::max(i - 1, 0)]);
        const Vec2 b = sign * left(along[std::min(i, count - 2)]);
        Vec2 off;
        if (!meet(a, half, b, half, off))
        {
          off = half * a;
        }
        if (off.norm() > kLongestMitre * half || a.dot(b) < -0.99)
        {
          this->fail(stations_[i].place, "turns back on itself");
        }
        const Vec2 p = stations_[i].place + off;
        stations_[i].corner[side] = Vec3(p.x(), p.y(), stations_[i].crest);
      }
      // Each side is a plane: it holds the edge of the crest and falls at its slope across it. Two
      // planes meet along the way of the station between them.
      const double r = slope_[side];
      const auto plane = [&](int i)
      {
        const Vec3 edge = stations_[i + 1].corner[side] - stations_[i].corner[side];
        const double rise = edge.z() / std::max(edge.head<2>().norm(), 1e-9);
        return Vec2(sign * left(along[i]) - rise * r * along[i]);
      };
      for (int i = 0; i < count; ++i)
      {
        const int before = std::max(i - 1, 0), after = std::min(i, count - 2);
        Vec2& out = stations_[i].out[side];
        if (!meet(plane(before), r, plane(after), r, out))
        {
          out = sign * r * left(along[after]);
        }
        if (out.norm() > kLongestMitre * r)
        {
          this->fail(stations_[i].place, "turns back on itself");
        }
        stations_[i].depth[side] = 0.0;
      }
      for (int i = 0; i + 1 < count; ++i)
      {
        const double deep = this->depthOfPiece(i, side);
        for (Station* s : { &stations_[i], &stations_[i + 1] })
        {
          s->depth[side] = std::max(s->depth[side], deep);
        }
      }
    }
    for (int i = 0; i + 1 < count; ++i)
    {
      for (int side = 0; side < 2; ++side)
      {
        const Vec3 crest = stations_[i + 1].corner[side] - stations_[i].corner[side];
        const Vec3 foot = stations_[i + 1].foot(side) - stations_[i].foot(side);
        if (crest.head<2>().dot(along[i]) <= 0.0 || foot.head<2>().dot(along[i]) <= 0.0)
        {
          return i;
        }
      }
    }
    return -1;
  }

  /// How far below the crest the side of a piece is safely under the ground, m.
  double depthOfPiece(int piece, int side) const
  {
    const Station &a = stations_[piece], &b = stations_[piece + 1];
    const double cell = terrain_.geometry().cellSize;
    const int n =
      std::max(1, int(std::ceil(2.0 * (b.corner[side] - a.corner[side]).head<2>().norm() / cell)));
    const double step = std::min(0.5, 0.25 * cell / std::max(slope_[side], 0.1));
    double deepest = 0.0;
    for (int k = 0; k <= n; ++k)
    {
      const double f = double(k) / n;
      const Vec3 corner = (1.0 - f) * a.corner[side] + f * b.corner[side];
      const Vec2 out = (1.0 - f) * a.out[side] + f * b.out[side];
      double down = 0.0;
      for (;; down += step)
      {
        const double ground = this->groundAt(corner.head<2>() + down * out);
        if (corner.z() - down <= ground - margin_)
        {
          break;
        }
        if (std::isnan(ground))
        {
          this->fail(corner.head<2>(),
            "has a side that comes to the edge of the terrain, or to a hole in it, before it is at "
            "the ground");
        }
        if (down > kLongestSide)
        {
          this->fail(corner.head<2>(),
            "has a side of " + numberText(slope_[side]) +
              " m across per m down that is not at the ground " + numberText(kLongestSide) +
              " m below its crest: the slope falls as steeply as the side, or the crest is too "
              "high");
        }
      }
      deepest = std::max(deepest, down + margin_);
    }
    return deepest;
  }

  const Embankment& it_;
  const Terrain& terrain_;
  double margin_ = 0.0;
  bool buried_ = true;
  double slope_[2] = { 0.0, 0.0 }; ///< Left and right.
  std::vector<Station> stations_;
};

} // namespace

void addEmbankment(const Embankment& embankment, const Terrain& terrain, ObstacleMesh& mesh)
{
  Builder(embankment, terrain).append(mesh);
}

} // namespace rockfall
