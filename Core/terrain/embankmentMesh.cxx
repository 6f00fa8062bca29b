// The mesh of an embankment: stations along its axis, and seven strings of nodes along them: the
// lower end of a skirt, a foot, an edge of the crest, the axis, and the other edge, foot and skirt,
// with two triangles per piece between two strings and an upright end on either side. On the inner
// side of a bend the strings of edge and foot are shorter than the axis: the stations there have one
// node of them in common. Skirts keep rocks in scars beside the feet out: going on as gentle as they
// are, the sides would spread too far. On ground that does not yield there are none.

#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/shell.h"
#include "law/settings.h"
#include "terrain/Obstacles.h"
#include "terrain/Terrain.h"

#include <cmath>
#include <functional>

namespace rockfall
{

namespace
{

using Vec2 = Eigen::Vector2d;

struct Station
{
  Vec2 place;
  double crest = 0.0; ///< Elevation, m.
  bool drawn = true;  ///< A point of the line itself.
};

/// Stations that have a node of a string in common, mostly one.
struct Bunch
{
  int first, last;
  double depth = 0.0; ///< Of its foot below its edge of the crest, m.
  double crest = 0.0; ///< Elevation of its edge of the crest, m.
};
using Bunches = std::vector<Bunch>;

class Builder
{
public:
  /// Nodes of a station: lower end of a skirt, foot, edge of the crest, its middle, and back.
  static constexpr int kStrings = 7, kCrest = 3;

  Builder(const Embankment& embankment, const Terrain& terrain)
    : it_(embankment)
    , terrain_(terrain)
    , margin_(kFootDepth + terrain.roughnessDepth())
    , skirt_(terrain.yields() ? kScarBesideWall : 0.0)
  {
    this->placeStations();
    this->chooseSides();
    for (std::size_t i = 0; i + 1 < stations_.size(); ++i)
    {
      along_.push_back((stations_[i + 1].place - stations_[i].place).normalized());
    }
    for (int side = 0; side < 2; ++side)
    {
      this->shape(side);
    }
  }

  void append(ObstacleMesh& mesh) const
  {
    const std::size_t firstTriangle = mesh.triangles.size();
    const int count = int(stations_.size());
    std::array<std::vector<int>, kStrings> strings; // nodes by station
    const auto node = [&](const Vec3& p)
    {
      mesh.nodes.emplace_back();
      mesh.nodes.back().position = p;
      return int(mesh.nodes.size()) - 1;
    };
    for (int side = 0; side < 2; ++side)
    {
      const auto insert = [&](int string, const Bunch& b, int number)
      {
        std::vector<int>& nodes = strings[side == 0 ? string : kStrings - 1 - string];
        nodes.insert(nodes.end(), std::size_t(b.last - b.first) + 1, number);
      };
      for (const Bunch& b : edges_[side])
      {
        insert(2, b, node(this->at(b, side, 0.0)));
      }
      for (const Bunch& b : feet_[side])
      {
        const Vec3 foot = this->at(b, side, b.depth);
        const int above = node(foot);
        insert(1, b, above);
        insert(0, b, skirt_ > 0.0 ? node(foot - skirt_ * Vec3::UnitZ()) : above);
      }
    }
    for (const Station& s : stations_)
    {
      strings[kCrest].push_back(node(Vec3(s.place.x(), s.place.y(), s.crest)));
    }
    const auto add = [&](int a, int b, int c)
    {
      if (a != b && b != c && c != a)
      {
        mesh.triangles.emplace_back();
        mesh.triangles.back().nodes = { a, b, c };
      }
    };
    for (int i = 0; i + 1 < count; ++i)
    {
      for (int k = 0; k + 1 < kStrings; ++k)
      {
        const auto &left = strings[k], &right = strings[k + 1];
        add(left[i], right[i], right[i + 1]);
        add(left[i], right[i + 1], left[i + 1]);
      }
    }
    // From the middle of the crest: an edge down to its skirt, the other skirt up to its edge.
    constexpr std::array round = { 2, 1, 0, 6, 5, 4 };
    for (std::size_t k = 0; k + 1 < round.size(); ++k)
    {
      const auto &from = strings[std::size_t(round[k])], &to = strings[std::size_t(round[k + 1])];
      add(strings[kCrest].front(), from.front(), to.front());
      add(strings[kCrest].back(), to.back(), from.back());
    }
    mesh.connect(firstTriangle);
    for (std::size_t k = firstTriangle; k < mesh.triangles.size(); ++k)
    {
      if (mesh.triangles[k].normal.z() < -1e-9)
      {
        this->failFolded(mesh.nodes[std::size_t(mesh.triangles[k].nodes[0])].position.head<2>());
      }
    }
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
        const int n = std::max(1, int(std::ceil(4.0 * way.norm() / terrain_.geometry().cellSize)));
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

  Vec2 outward(int piece, int side) const
  {
    const Vec2& t = along_[std::size_t(piece)];
    return side == 0 ? Vec2(-t.y(), t.x()) : Vec2(t.y(), -t.x());
  }

  /// A point on the side of a bunch, `down` metres below its edge of the crest. The sides of the
  /// pieces before and after the bunch meet there, as if the crest were level.
  Vec3 at(const Bunch& b, int side, double down) const
  {
    const int before = std::max(b.first - 1, 0);
    const int after = std::min(b.last, int(along_.size()) - 1);
    const double off = 0.5 * it_.crestWidth + slope_[side] * down;
    const Vec2 m = this->outward(before, side), n = this->outward(after, side);
    const Vec2 &p = stations_[std::size_t(b.first)].place,
               &q = stations_[std::size_t(b.last)].place;
    Vec2 way; // from p
    if (!meet(m, off, n, n.dot(q - p) + off, way))
    {
      way = 0.5 * (q - p) + off * m;
    }
    const Vec2 x = p + way;
    return Vec3(x.x(), x.y(), b.crest - down);
  }

  const Bunch& edgeOf(int station, int side) const
  {
    return *std::find_if(
      edges_[side].begin(), edges_[side].end(), [&](const Bunch& b) { return station <= b.last; });
  }

  /// Whether the side between two bunches of feet folds, seen from above.
  bool folds(const Bunch& a, const Bunch& b, int side) const
  {
    const Vec3 corners[] = { this->at(a, side, a.depth),
      this->at(this->edgeOf(a.last, side), side, 0.0),
      this->at(this->edgeOf(b.first, side), side, 0.0), this->at(b, side, b.depth) };
    const auto along = [&](int from, int to)
    { return (corners[to] - corners[from]).head<2>().dot(along_[std::size_t(a.last)]); };
    bool folded = along(0, 3) <= 1e-6;
    for (int k = 0; k < 4; ++k)
    {
      const Vec3 in = corners[(k + 1) % 4] - corners[k],
                 out = corners[(k + 2) % 4] - corners[(k + 1) % 4];
      const double turn = in.x() * out.y() - in.y() * out.x();
      folded = folded || (side == 0 ? turn : -turn) < -1e-9;
    }
    return folded;
  }

  /// Two bunches become one where the side between them folds. False if there are none.
  bool gather(Bunches& bunches, int side) const
  {
    for (std::size_t k = 0; k + 1 < bunches.size(); ++k)
    {
      Bunch &a = bunches[k], &b = bunches[k + 1];
      if (!this->folds(a, b, side))
      {
        continue;
      }
      if (a.first == 0 || b.last + 1 == int(stations_.size()))
      {
        this->failFolded(stations_[std::size_t(a.first == 0 ? b.first : a.last)].place);
      }
      a = this->bunch(a.first, b.last);
      bunches.erase(bunches.begin() + std::ptrdiff_t(k) + 1);
      return true;
    }
    return false;
  }

  Bunch bunch(int first, int last) const
  {
    Bunch b{ first, last };
    for (int i = first; i <= last; ++i)
    {
      b.crest += stations_[std::size_t(i)].crest / (last - first + 1);
    }
    return b;
  }

  [[noreturn]] void failFolded(const Vec2& place) const
  {
    this->fail(place,
      "bends so sharply, for the length of its pieces, that its sides fold over themselves; "
      "draw a gentler bend or two lines");
  }

  /// Edge of the crest and feet on one side.
  void shape(int side)
  {
    Bunches& edges = edges_[side];
    for (int i = 0; i < int(stations_.size()); ++i)
    {
      edges.push_back(this->bunch(i, i));
      const Vec2 off =
        this->at(edges.back(), side, 0.0).head<2>() - stations_[std::size_t(i)].place;
      const Vec2 a = this->outward(std::max(i - 1, 0), side);
      const Vec2 b = this->outward(std::min(i, int(along_.size()) - 1), side);
      if (off.norm() > kLongestMitre * 0.5 * it_.crestWidth || a.dot(b) < -0.99)
      {
        this->fail(stations_[std::size_t(i)].place, "turns back on itself");
      }
    }
    while (this->gather(edges, side))
    {
    }
    Bunches& feet = feet_[side] = edges;
    do
    {
      for (Bunch& b : feet)
      {
        b.depth = 0.0;
      }
      for (std::size_t k = 0; k < feet.size(); ++k)
      {
        const Bunch &a = feet[k], &b = feet[std::min(k + 1, feet.size() - 1)];
        const double deep = this->depthBetween(a, b, side);
        for (Bunch* one : { &feet[k], &feet[std::min(k + 1, feet.size() - 1)] })
        {
          one->depth = std::max(one->depth, deep);
        }
      }
    } while (this->gather(feet, side));
    this->checkFans(side);
  }

  /// In a bend of several points the sides between them go down to one point, which may be far from
  /// the planes of the slope that was asked for.
  void checkFans(int side) const
  {
    for (const Bunch& b : feet_[side])
    {
      const auto drawn = [](const Station& s) { return s.drawn; };
      if (std::count_if(&stations_[b.first], &stations_[b.last] + 1, drawn) < 2)
      {
        continue;
      }
      const Vec3 foot = this->at(b, side, b.depth);
      for (int i = b.first; i < b.last; ++i)
      {
        const Station &s = stations_[std::size_t(i)], &t = stations_[std::size_t(i) + 1];
        const double across = (foot.head<2>() - s.place).dot(this->outward(i, side));
        const double down = 0.5 * (s.crest + t.crest) - foot.z();
        const double slope = (across - 0.5 * it_.crestWidth) / down;
        if (!(std::abs(slope - slope_[side]) <= kFanTolerance * std::max(slope_[side], 0.2)))
        {
          this->failFolded(s.place);
        }
      }
    }
  }

  /// How far below the crest the side between two bunches is safely under the ground, m.
  double depthBetween(const Bunch& a, const Bunch& b, int side) const
  {
    const double cell = terrain_.geometry().cellSize;
    const double length = (this->at(b, side, 0.0) - this->at(a, side, 0.0)).head<2>().norm();
    const int n = std::max(1, int(std::ceil(2.0 * length / cell)));
    const double step = std::min(0.5, 0.25 * cell / std::max(slope_[side], 0.1));
    double deepest = 0.0;
    for (int k = 0; k <= n; ++k)
    {
      const double f = double(k) / n;
      const auto place = [&](double down)
      { return Vec3((1.0 - f) * this->at(a, side, down) + f * this->at(b, side, down)); };
      for (double down = 0.0;; down += step)
      {
        const Vec3 p = place(down);
        const double ground = this->groundAt(p.head<2>());
        if (p.z() <= ground - margin_)
        {
          deepest = std::max(deepest, down + margin_);
          break;
        }
        if (std::isnan(ground))
        {
          this->fail(place(0.0).head<2>(),
            "has a side that comes to the edge of the terrain, or to a hole in it, before it is at "
            "the ground");
        }
        if (down > kLongestSide)
        {
          this->fail(place(0.0).head<2>(),
            "has a side of " + numberText(slope_[side]) +
              " m across per m down that is not at the ground " + numberText(kLongestSide) +
              " m below its crest: the slope falls as steeply as the side, or the crest is too "
              "high");
        }
      }
    }
    return deepest;
  }

  const Embankment& it_;
  const Terrain& terrain_;
  double margin_; ///< By how much the feet are under the ground, m.
  double skirt_;  ///< Height of what goes on upright below them, m.
  bool buried_ = true;
  double slope_[2] = { 0.0, 0.0 }; ///< Left and right.
  std::vector<Station> stations_;
  std::vector<Vec2> along_;    ///< The way of each piece, unit.
  Bunches edges_[2], feet_[2]; ///< Left and right.
};

} // namespace

void addEmbankment(const Embankment& embankment, const Terrain& terrain, ObstacleMesh& mesh)
{
  Builder(embankment, terrain).append(mesh);
}

} // namespace rockfall
