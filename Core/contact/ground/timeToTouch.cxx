#include "contact/ground/timeToTouch.h"
#include "contact/ground/motion.h"
#include "contact/ground/roundContact.h"
#include "law/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// The bound while it is made smaller place by place. A material point q of the rock over a slope
/// with gradient a ± s closes its gap by no more than c t + ½ c₂ t² + j t³/6: with its velocity w,
/// c = a·w − w_z + s |w|, c₂ ≥ 0 likewise with its acceleration, and j from the largest third
/// derivative of a turning body. Between two places of the rock's surface over one CFE the gap is
/// linear and these rates are convex: the places where either has a corner are enough.
class FirstTouch
{
public:
  FirstTouch(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
    double gravity, double horizon)
    : position_(rock.position())
    , velocity_(state.velocity)
    , spin_(rock.rotation() * state.spin)
    , tilt_(window.tilt())
    , relief_(window.relief())
    , gravity_(gravity)
    , time_(horizon)
  {
    const Block& block = rock.block();
    const double rim = block.largestRimSpeed(state.spin);
    const double kappa = std::sqrt(1.0 + tilt_.squaredNorm()) + relief_;
    double fastest = spin_.norm(), derivatives = 1.0;
    if (!block.isotropic())
    {
      // |ω̇| ≤ |ω|², as no moment of inertia is more than the sum of the others; so |ω̈| ≤ 2 |ω|³ and
      // the third derivative of a point is at most (2 + 2 + 1 + 1) |ω|³ r.
      fastest = block.largestSpin(state.spin).norm();
      derivatives = 6.0;
      const Vec3 momentum = block.inertia() * state.spin;
      spinRate_ = rock.rotation() * (block.inverseInertia() * momentum.cross(state.spin));
    }
    const double turning = fastest * fastest * block.radius();
    third_ = kappa * derivatives * turning * fastest / 6.0;
    fastest_ = this->rate(velocity_) + kappa * rim;
    acceleration_ = gravity + (block.isotropic() ? 1.0 : 2.0) * kappa * turning;
    this->updateFar();
  }

  double time() const { return time_; }
  /// Gaps beyond this do not matter any more, m.
  double far() const { return far_; }

  void visit(const Vec3& point, double gap)
  {
    if (!(gap < far_)) // nor where there is no ground
    {
      return;
    }
    if (gap <= 0.0)
    {
      time_ = 0.0;
      far_ = 0.0;
      return;
    }
    const Vec3 lever = point - position_;
    const Vec3 turning = spin_.cross(lever);
    const double c = this->rate(velocity_ + turning);
    const Vec3 bend = spinRate_.cross(lever) + spin_.cross(turning);
    const double c2 = 0.5 * std::max(0.0, this->rate(bend) + gravity_);
    const auto closed = [&](double t) { return ((third_ * t + c2) * t + c) * t - gap; };
    double after = time_, over = closed(after);
    if (over <= 0.0)
    {
      return; // convex, and not closed by then: not sooner
    }
    // From both sides of the root: tangents from the right, secants from the left.
    after = std::min(after, timeToCover(gap, c, 2.0 * c2));
    over = std::max(closed(after), 1e-300);
    double before = 0.0, under = -gap;
    for (int k = 0; k < 8 && before < 0.98 * after; ++k)
    {
      after -= over / ((3.0 * third_ * after + 2.0 * c2) * after + c);
      over = std::max(closed(after), 1e-300);
      before += (after - before) * under / (under - over);
      under = std::min(closed(before), -1e-300);
    }
    time_ = before;
    this->updateFar();
  }

  /// A gap of no place of the rock in particular.
  void visitAny(double gap)
  {
    time_ = std::min(time_, timeToCover(gap, fastest_, acceleration_));
    this->updateFar();
  }

private:
  double rate(const Vec3& w) const
  {
    return tilt_.x() * w.x() + tilt_.y() * w.y() - w.z() +
      relief_ * std::sqrt(w.x() * w.x() + w.y() * w.y());
  }
  void updateFar() { far_ = std::max(0.0, fastest_ * time_) + 0.5 * acceleration_ * time_ * time_; }

  Vec3 position_, velocity_, spin_;
  Vec3 spinRate_ = Vec3::Zero();
  Eigen::Vector2d tilt_;
  double relief_;
  double gravity_;
  double time_;
  double third_ = 0.0; ///< j/6
  double acceleration_ = 0.0;
  double fastest_ = 0.0;
  double far_ = 0.0;
};

/// Where a vertical line through a world point enters the rock from below, over that point, m; ∞ if
/// it misses it. `face`: through which. `rises`: how much each face of the rock looks up, −1 … 1;
/// empty for the first of its lines.
double entersAt(const PlacedBlock& rock, const Vec3& world, std::vector<double>& rises, int& face)
{
  const Polyhedron& shape = rock.block().shape();
  if (rises.empty())
  {
    const Vec3 up = rock.rotation().row(2).transpose();
    for (const Vec3& n : shape.normals())
    {
      rises.push_back(n.dot(up));
    }
  }
  const Vec3 x = rock.materialPoint(world);
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t f = 0; f < rises.size(); ++f)
  {
    const double rise = rises[f], room = shape.offsets()[f] - shape.normals()[f].dot(x);
    if (rise < 0.0)
    {
      face = room / rise > low ? int(f) : face;
      low = std::max(low, room / rise);
    }
    else if (rise > 0.0)
    {
      high = std::min(high, room / rise);
    }
    else if (room < 0.0)
    {
      return high;
    }
  }
  return low <= high ? low : std::numeric_limits<double>::infinity();
}

} // namespace

double timeToNear(const BlockState& state, double radius, const HeightWindow& window,
  double gravity, double horizon)
{
  const Eigen::Vector2d& tilt = window.tilt();
  const double up = state.position.z() - tilt.dot(state.position.head<2>()) - window.highest();
  const double room = up - radius * std::sqrt(1.0 + tilt.squaredNorm());
  const double rate = tilt.dot(state.velocity.head<2>()) - state.velocity.z();
  return std::min(horizon, timeToCover(room, rate, gravity));
}

namespace
{

/// What of the rock is at a low place.
struct LowFeature
{
  int face = -1;   ///< Over the window's node (row, column).
  int edge = -1;   ///< Over its grid line of a family (along y, along x, falling, rising cuts).
  int family = -1; ///< Neither: a vertex.
  int row = 0, column = 0;
};

/// Whether a cell of the window has this cut.
bool isCutAlong(const HeightWindow& window, bool rising, int row, int column)
{
  return row >= 0 && column >= 0 && row + 1 < window.rows() && column + 1 < window.columns() &&
    window.isRising(row, column) == rising;
}

/// visit(place, gap, feature) of every place where the gap along the vertical can be least, but for
/// those where it is no less than far(), which visits may make smaller.
template <class Far, class Visit>
void visitLowPlaces(
  const PlacedBlock& rock, const HeightWindow& window, const Far& far, const Visit& visit)
{
  const auto over = [&](const Vec3& p, const LowFeature& feature)
  { visit(p, p.z() - window.elevation(p.x(), p.y()), feature); };
  // Height over the plane that no node is above: a gap is at least that.
  const auto room = [&](const Vec3& p)
  { return p.z() - window.tilt().dot(p.head<2>()) - window.highest(); };
  const std::vector<Vec3>& vertices = rock.vertices();
  thread_local std::vector<double> rooms; // of the vertices: every edge asks for two
  rooms.resize(vertices.size());
  double least = std::numeric_limits<double>::infinity();
  std::size_t lowest = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    rooms[i] = room(vertices[i]);
    if (rooms[i] < least)
    {
      least = rooms[i];
      lowest = i;
    }
  }
  if (least >= far())
  {
    return;
  }
  over(vertices[lowest], {}); // most likely the first to touch: the rest is soon too far
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    if (rooms[i] < far() && i != lowest)
    {
      over(vertices[i], {});
    }
  }
  const double inverse = window.inverseCellSize(), west = window.west(), north = window.north();
  const auto index = [&](double v, int count) { return std::clamp(int(std::floor(v)), -1, count); };
  const int column0 = index((rock.lower().x() - west) * inverse, window.columns()) + 1;
  const int column1 = index((rock.upper().x() - west) * inverse, window.columns() - 1);
  const int row0 = index((north - rock.upper().y()) * inverse, window.rows()) + 1;
  const int row1 = index((north - rock.lower().y()) * inverse, window.rows() - 1);
  // Nodes of the slope under the rock. The lowest point of the rock is lowest + tilt on the way.
  thread_local std::vector<double> rises;
  rises.clear();
  for (int row = row0; row <= row1; ++row)
  {
    for (int column = column0; column <= column1; ++column)
    {
      const Vec3 node(window.x(column), window.y(row), window.z(row, column));
      if (least + window.highest() + window.tilt().dot(node.head<2>()) - node.z() < far())
      {
        int face = -1;
        const double gap = entersAt(rock, node, rises, face);
        if (gap < far())
        {
          visit(Vec3(node.x(), node.y(), node.z() + gap), gap, { face, -1, -1, row, column });
        }
      }
    }
  }
  // Edges of the rock where they pass over edges of the slope: grid lines and cuts of cells.
  const Polyhedron& shape = rock.block().shape();
  const Vec3 up = rock.rotation().row(2).transpose();
  for (std::size_t edge = 0; edge < shape.edges().size(); ++edge)
  {
    const Polyhedron::Edge& e = shape.edges()[edge];
    const auto start = std::size_t(e.vertices[0]), end = std::size_t(e.vertices[1]);
    if (std::min(rooms[start], rooms[end]) >= far() ||
      (up.dot(shape.normals()[e.faces[0]]) > 0.0 && up.dot(shape.normals()[e.faces[1]]) > 0.0))
    {
      continue;
    }
    const Vec3 &p = vertices[start], &q = vertices[end];
    const double x0 = (p.x() - west) * inverse, x1 = (q.x() - west) * inverse;
    const double y0 = (north - p.y()) * inverse, y1 = (north - q.y()) * inverse;
    const double from[4] = { x0, y0, x0 - y0, x0 + y0 }, to[4] = { x1, y1, x1 - y1, x1 + y1 };
    const int most[4] = { window.columns() - 1, window.rows() - 1, window.columns() - 1,
      window.columns() + window.rows() - 2 };
    const int first[4] = { 0, 0, 1 - window.rows(), 0 };
    const Vec3 along = q - p;
    for (int family = 0; family < 4; ++family)
    {
      const bool cut = family >= 2, rising = family == 3;
      if (cut && !window.anyIs(rising))
      {
        continue;
      }
      const double a = std::min(from[family], to[family]), b = std::max(from[family], to[family]);
      const int k0 = int(std::ceil(std::max(a, double(first[family]))));
      const int k1 = int(std::floor(std::min(b, double(most[family]))));
      if (k0 > k1 || a == b)
      {
        continue;
      }
      const double scale = 1.0 / (to[family] - from[family]);
      for (int k = k0; k <= k1; ++k)
      {
        const Vec3 x = p + std::clamp((k - from[family]) * scale, 0.0, 1.0) * along;
        if (room(x) < far())
        {
          const double share = (k - from[family]) * scale;
          const int across = family == 1 ? int(std::floor(x0 + share * (x1 - x0))) : k;
          const int down = int(std::floor(y0 + share * (y1 - y0)));
          const int row = family == 1 ? k : down;
          const int column = family == 2 ? down + k : rising ? k - down - 1 : across;
          if (!cut || isCutAlong(window, rising, row, column))
          {
            over(x, { -1, int(edge), family, row, column });
          }
        }
      }
    }
  }
}

} // namespace

namespace
{

/// The least gap of a round body along the vertical, m; ∞ if there is no ground under it.
double roundGap(const PlacedBlock& rock, const HeightWindow& window)
{
  const Mat3 axes = roundAxes(rock);
  double gap = std::numeric_limits<double>::infinity();
  const auto index = [&](double v, int count)
  { return std::clamp(int(std::floor(v * window.inverseCellSize())), 0, count - 2); };
  const int column0 = index(rock.lower().x() - window.west(), window.columns());
  const int column1 = index(rock.upper().x() - window.west(), window.columns());
  const int row0 = index(window.north() - rock.upper().y(), window.rows());
  const int row1 = index(window.north() - rock.lower().y(), window.rows());
  for (int row = row0; row <= row1; ++row)
  {
    for (int column = column0; column <= column1; ++column)
    {
      const auto corner = [&](int r, int c)
      { return Vec3(window.x(column + c), window.y(row + r), window.z(row + r, column + c)); };
      const Vec3 nw = corner(0, 0), ne = corner(0, 1), sw = corner(1, 0), se = corner(1, 1);
      const double top = std::max({ nw.z(), ne.z(), sw.z(), se.z() });
      if (!(rock.lower().z() - top < gap)) // nor where there is no ground
      {
        continue;
      }
      const bool rising = window.isRising(row, column);
      for (const auto& [a, b, c] :
        { std::array{ nw, sw, rising ? ne : se }, std::array{ rising ? sw : nw, se, ne } })
      {
        gap = std::min(gap, roundDrop(axes, rock.position(), a, b, c));
      }
    }
  }
  return gap;
}

} // namespace

double timeToTouch(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  double gravity, double horizon)
{
  if (isRound(rock))
  {
    BlockState still = state; // a sphere does not come nearer by turning
    still.spin = rock.block().isotropic() ? Vec3(Vec3::Zero()) : state.spin;
    FirstTouch any(rock, still, window, gravity, horizon);
    any.visitAny(roundGap(rock, window));
    return any.time();
  }
  FirstTouch touch(rock, state, window, gravity, horizon);
  visitLowPlaces(
    rock, window, [&] { return touch.far(); },
    [&](const Vec3& place, double gap, const LowFeature&) { touch.visit(place, gap); });
  return touch.time();
}

double heightOver(const PlacedBlock& rock, const HeightWindow& window, double least)
{
  if (isRound(rock))
  {
    return roundGap(rock, window);
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double height = infinity;
  visitLowPlaces(
    rock, window, [&] { return height > least ? height : -infinity; },
    [&](const Vec3&, double gap, const LowFeature&)
    { height = gap < height ? gap : height; }); // NaN is not
  return height;
}

namespace
{

/// Of the CFE at a place in the window.
Eigen::Vector2d gradientAt(const HeightWindow& window, const Vec3& place)
{
  const double inverse = window.inverseCellSize();
  const double c = (place.x() - window.west()) * inverse,
               r = (window.north() - place.y()) * inverse;
  const int column = std::clamp(int(c), 0, window.columns() - 2);
  const int row = std::clamp(int(r), 0, window.rows() - 2);
  const bool rising = window.isRising(row, column);
  const bool lower = isInLower(rising, c - column, r - row);
  const auto z = [&](int down, int right) { return window.z(row + down, column + right); };
  const int side = lower == rising; // west: 0
  return { inverse * (lower ? z(1, 1) - z(1, 0) : z(0, 1) - z(0, 0)),
    inverse * (z(0, side) - z(1, side)) };
}

/// How much higher the middle of a line of the grid is than that between the nodes on its two
/// sides, m: > 0 on a ridge. NaN where the window ends.
double bend(const HeightWindow& window, int family, int row, int column)
{
  const auto z = [&](int r, int c)
  {
    return r >= 0 && c >= 0 && r < window.rows() && c < window.columns()
      ? window.z(r, c)
      : std::numeric_limits<double>::quiet_NaN();
  };
  const auto rises = [&](int r, int c) { return isCutAlong(window, true, r, c); };
  switch (family)
  {
    case 0: // between the cells in the west and in the east: rows of their wings
    {
      const int west = rises(row, column - 1) ? row + 1 : row;
      const int east = rises(row, column) ? row : row + 1;
      return 0.5 * (z(west, column) + z(east, column) - z(west, column - 1) - z(east, column + 1));
    }
    case 1: // in the north and in the south: columns
    {
      const int north = rises(row - 1, column) ? column + 1 : column;
      const int south = rises(row, column) ? column : column + 1;
      return 0.5 * (z(row, north) + z(row, south) - z(row - 1, north) - z(row + 1, south));
    }
    default:
    {
      const double twice =
        z(row, column) + z(row + 1, column + 1) - z(row + 1, column) - z(row, column + 1);
      return isCutAlong(window, family == 3, row, column)
        ? (family == 3 ? -0.5 : 0.5) * twice
        : std::numeric_limits<double>::quiet_NaN();
    }
  }
}

} // namespace

void findTouches(const PlacedBlock& rock, const HeightWindow& window, double within,
  std::vector<GroundPlace>& places)
{
  places.clear();
  const double flat = kFlatBend * window.cellSize();
  const Polyhedron& shape = rock.block().shape();
  visitLowPlaces(
    rock, window, [&] { return within; },
    [&](const Vec3& place, double gap, const LowFeature& low)
    {
      if (!(gap < within))
      {
        return;
      }
      Vec3 normal;
      if (low.face >= 0)
      {
        bool peak = false;
        for (const auto& [family, row, column] :
          { std::array{ 0, low.row, low.column }, { 0, low.row - 1, low.column },
            { 1, low.row, low.column }, { 1, low.row, low.column - 1 }, { 2, low.row, low.column },
            { 2, low.row - 1, low.column - 1 }, { 3, low.row - 1, low.column },
            { 3, low.row, low.column - 1 } })
        {
          peak = peak || bend(window, family, row, column) > flat;
        }
        normal = -rock.normal(low.face);
        if (!peak)
        {
          return;
        }
      }
      else if (low.edge >= 0)
      {
        if (!(bend(window, low.family, low.row, low.column) > flat))
        {
          return;
        }
        const int start = low.row + (low.family == 3); // a rising cut begins in the south-west
        const int row = low.row + (low.family == 0 || low.family == 2);
        const int column = low.column + (low.family != 0);
        const Vec3 line(window.x(column) - window.x(low.column), window.y(row) - window.y(start),
          window.z(row, column) - window.z(start, low.column));
        const auto& ends = shape.edges()[std::size_t(low.edge)].vertices;
        const Vec3 along = rock.vertices()[ends[1]] - rock.vertices()[ends[0]];
        normal = line.cross(along);
        const double size2 = normal.squaredNorm();
        if (size2 <= 1e-12 * line.squaredNorm() * along.squaredNorm())
        {
          return; // along each other
        }
        normal *= (normal.z() < 0.0 ? -1.0 : 1.0) / std::sqrt(size2);
      }
      else
      {
        const Eigen::Vector2d rise = gradientAt(window, place);
        normal = Vec3(-rise.x(), -rise.y(), 1.0).normalized();
      }
      places.push_back({ place, normal });
    });
}

} // namespace rockfall
