#pragma once

/// @file
/// Places at which a rock over the grid of the slope may be lowest.

#include "contact/ground/candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace rockfall
{

/// std::floor of what an int holds: that is a call where the processor may be any.
inline int wholePart(double v)
{
  const int towardsZero = int(v);
  return towardsZero - int(v < towardsZero);
}

/// The part of the rock at a low place.
struct LowFeature
{
  int face = -1;   ///< Over the window's node (row, column).
  int edge = -1;   ///< Over its grid line of a family (along y, along x, falling, rising cuts).
  int family = -1; ///< Neither: a vertex.
  int row = 0, column = 0;
};

/// Whether a cell of the window has this cut.
inline bool isCutAlong(const HeightWindow& window, bool rising, int row, int column)
{
  return row >= 0 && column >= 0 && row + 1 < window.rows() && column + 1 < window.columns() &&
    window.isRising(row, column) == rising;
}

/// The nodes at the ends of a line of the grid; a rising cut begins in the south-west.
struct GridLine
{
  int row0, column0, row1, column1;
};
inline GridLine gridLine(int family, int row, int column)
{
  return { row + (family == 3), column, row + (family == 0 || family == 2),
    column + (family != 0) };
}

/// How much higher the middle of a line of the grid is than that between the nodes on its two
/// sides, m: > 0 on a ridge. NaN where the window ends.
double bend(const HeightWindow& window, int family, int row, int column);

/// Lines of the grid at which a visitor's rule changes: rows and columns of nodes.
struct GridBorder
{
  int west = -1, east = -1, north = -1, south = -1;
  bool has(int row, int column) const
  {
    return row == north || row == south || column == west || column == east;
  }
};

/// The places of a rock's surface where its gap along the vertical, less what closes it, can be
/// least: visit(place, gap, feature), but where the gap is no less than far(), which visits may make
/// smaller. Over one CFE the gap is linear and what closes it convex, so that corners are enough:
/// vertices, edges over lines of the grid, nodes under faces. Of these only ridges matter, and nodes
/// that are higher than what is between their neighbours along both axes: across a dip, and along an
/// axis that such a node is not on top of, the difference is concave, so that some place on one of
/// the two sides is as low; and of the lowest places the one farthest to the east, then north, has
/// none. On `border` all are visited, as that holds on each side of it for itself.
template <class Far, class Visit>
class LowPlaces
{
  static constexpr double kAtNode = 1e-9; ///< cells

public:
  LowPlaces(const PlacedBlock& rock, const HeightWindow& window, const GridBorder& border,
    const Far& far, const Visit& visit)
    : rock_(rock)
    , window_(window)
    , border_(border)
    , far_(far)
    , visit_(visit)
    , relief_(window.whole() ? window.relief() : std::numeric_limits<double>::infinity())
  {
  }

  void visitAll()
  {
    std::vector<Corner>& corners = cornerSpace();
    if (!this->visitVertices(corners))
    {
      return;
    }
    std::vector<double>& rises = riseSpace();
    const Vec3 up = rock_.rotation().row(2).transpose();
    rises.clear();
    for (const Vec3& n : rock_.block().shape().normals())
    {
      rises.push_back(n.dot(up));
    }
    this->visitNodes(rises);
    this->visitEdges(corners, rises);
  }

private:
  /// A vertex over the grid.
  struct Corner
  {
    double rise; ///< Height over the window's tilt through the origin, m.
    double gap;  ///< No more than that over the ground, m.
  };
  static std::vector<Corner>& cornerSpace()
  {
    thread_local std::vector<Corner> corners;
    return corners;
  }
  /// How much each face of the rock looks up, −1 … 1.
  static std::vector<double>& riseSpace()
  {
    thread_local std::vector<double> rises;
    return rises;
  }

  /// Whether there is more to look at.
  bool visitVertices(std::vector<Corner>& corners)
  {
    const std::vector<Vec3>& vertices = rock_.vertices();
    corners.resize(vertices.size());
    least_ = std::numeric_limits<double>::infinity();
    std::size_t lowest = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      const Vec3& p = vertices[i];
      corners[i].rise = p.z() - window_.tilt().dot(p.head<2>());
      corners[i].gap = corners[i].rise - window_.highest();
      if (corners[i].gap < least_)
      {
        least_ = corners[i].gap;
        lowest = i;
      }
    }
    if (!(least_ < far_()))
    {
      return false;
    }
    this->visitVertex(corners[lowest], vertices[lowest]); // most likely the first to touch
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      if (corners[i].gap < far_() && i != lowest)
      {
        this->visitVertex(corners[i], vertices[i]);
      }
    }
    return true;
  }
  void visitVertex(Corner& corner, const Vec3& p)
  {
    const double gap = p.z() - window_.elevation(p.x(), p.y());
    visit_(p, gap, LowFeature());
    corner.gap = gap > corner.gap ? gap : corner.gap; // NaN is not
  }

  /// Height over a node at which the vertical through it enters the rock from below, m; ∞ if it
  /// misses it, or if that is no less than far(). `face`: through which.
  double entersAt(const Vec3& node, const std::vector<double>& rises, int& face) const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Polyhedron& shape = rock_.block().shape();
    const Vec3 x = rock_.materialPoint(node);
    const double far = far_();
    double low = -infinity, high = infinity;
    for (std::size_t f = 0; f < rises.size(); ++f)
    {
      const double rise = rises[f], room = shape.offsets()[f] - shape.normals()[f].dot(x);
      if (rise == 0.0)
      {
        if (room < 0.0)
        {
          return infinity;
        }
        continue;
      }
      const double at = room / rise;
      if (rise > 0.0)
      {
        high = std::min(high, at);
      }
      else if (at > low)
      {
        face = int(f);
        low = at;
      }
      if (low > high || low >= far)
      {
        return infinity;
      }
    }
    return low;
  }
  void visitNodes(const std::vector<double>& rises)
  {
    const double inverse = window_.inverseCellSize();
    const auto index = [&](double v, int count) { return std::clamp(wholePart(v), -1, count); };
    const int columns = window_.columns(), rows = window_.rows();
    const int column0 = index((rock_.lower().x() - window_.west()) * inverse, columns) + 1;
    const int column1 = index((rock_.upper().x() - window_.west()) * inverse, columns - 1);
    const int row0 = index((window_.north() - rock_.upper().y()) * inverse, rows) + 1;
    const int row1 = index((window_.north() - rock_.lower().y()) * inverse, rows - 1);
    for (int row = row0; row <= row1; ++row)
    {
      for (int column = column0; column <= column1; ++column)
      {
        const Vec3 node(window_.x(column), window_.y(row), window_.z(row, column));
        // The lowest point of the rock is `least_` + tilt on the way.
        if (least_ + window_.highest() + window_.tilt().dot(node.head<2>()) - node.z() < far_() &&
          (border_.has(row, column) || this->isOnTop(row, column)))
        {
          int face = -1;
          const double gap = this->entersAt(node, rises, face);
          if (gap < far_())
          {
            visit_(Vec3(node.x(), node.y(), node.z() + gap), gap,
              LowFeature{ face, -1, -1, row, column });
          }
        }
      }
    }
  }
  /// Whether a node may be higher than the lines between its neighbours along both axes.
  bool isOnTop(int row, int column) const
  {
    if (row == 0 || column == 0 || row + 1 == window_.rows() || column + 1 == window_.columns())
    {
      return true;
    }
    const double twice = 2.0 * window_.z(row, column);
    return !(twice <= window_.z(row, column - 1) + window_.z(row, column + 1)) &&
      !(twice <= window_.z(row - 1, column) + window_.z(row + 1, column));
  }

  void visitEdges(const std::vector<Corner>& corners, const std::vector<double>& rises)
  {
    const std::vector<Polyhedron::Edge>& edges = rock_.block().shape().edges();
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      const auto& [ends, faces] = edges[i];
      const Corner &start = corners[std::size_t(ends[0])], &end = corners[std::size_t(ends[1])];
      const double low = std::min(start.rise, end.rise) - window_.highest();
      if (low < far_() &&
        (rises[std::size_t(faces[0])] <= 0.0 || rises[std::size_t(faces[1])] <= 0.0))
      {
        this->visitEdge(int(i), start, end);
      }
    }
  }
  /// Places of an edge over lines of the grid.
  void visitEdge(int edge, const Corner& start, const Corner& end)
  {
    const auto& ends = rock_.block().shape().edges()[std::size_t(edge)].vertices;
    const Vec3& p = rock_.vertices()[std::size_t(ends[0])];
    const Vec3 along = rock_.vertices()[std::size_t(ends[1])] - p;
    // Shares of the way along it where the gap may be less than far(): that over the plane is not
    // to be, nor that from either end, from where the ground rises over its tilt by `relief`.
    const double relief = relief_ * along.head<2>().norm(), higher = end.rise - start.rise;
    double begin = 0.0, until = 1.0;
    const auto keep = [&](double room, double rate) // room + rate · share < 0
    {
      if (rate > 0.0)
      {
        until = std::min(until, -room / rate);
      }
      else if (rate < 0.0)
      {
        begin = std::max(begin, -room / rate);
      }
    };
    const double far = far_();
    keep(start.rise - window_.highest() - far, higher);
    if (higher > relief)
    {
      keep(start.gap - far, higher - relief);
    }
    else if (-higher > relief)
    {
      keep(end.gap - far - higher - relief, higher + relief);
    }
    if (!(begin < until))
    {
      return;
    }
    const double inverse = window_.inverseCellSize();
    const double x0 = (p.x() - window_.west()) * inverse, dx = along.x() * inverse;
    const double y0 = (window_.north() - p.y()) * inverse, dy = -along.y() * inverse;
    const auto visitFamily = [&](int family, double from, double by, int first, int last)
    {
      const double low = from + begin * by, high = from + until * by;
      const int k0 = std::max(-wholePart(-std::min(low, high)), first);
      const int k1 = std::min(wholePart(std::max(low, high)), last);
      for (int k = k0; k <= k1; ++k)
      {
        const double share = std::clamp((k - from) / by, 0.0, 1.0);
        this->visitCrossing(edge, family, k, x0 + share * dx, y0 + share * dy, p + share * along);
      }
    };
    const auto isOver = [&](double from, double by)
    { return by != 0.0 && wholePart(from + begin * by) != wholePart(from + until * by); };
    const int columns = window_.columns(), rows = window_.rows();
    if (isOver(x0, dx))
    {
      visitFamily(0, x0, dx, 0, columns - 1);
    }
    if (isOver(y0, dy))
    {
      visitFamily(1, y0, dy, 0, rows - 1);
    }
    if (window_.anyIs(false) && isOver(x0 - y0, dx - dy))
    {
      visitFamily(2, x0 - y0, dx - dy, 1 - rows, columns - 1);
    }
    if (window_.anyIs(true) && isOver(x0 + y0, dx + dy))
    {
      visitFamily(3, x0 + y0, dx + dy, 0, columns + rows - 2);
    }
  }
  /// A place over line k of a family: column x, row y, in cells.
  void visitCrossing(int edge, int family, int k, double x, double y, const Vec3& place)
  {
    if (!(x >= 0.0 && y >= 0.0 && x <= window_.columns() - 1 && y <= window_.rows() - 1))
    {
      return; // beyond the window
    }
    const int down = family == 1 ? k : std::min(wholePart(y), window_.rows() - 2);
    const int column = family == 0 ? k
      : family == 1                ? std::min(wholePart(x), window_.columns() - 2)
      : family == 2                ? down + k
                                   : k - down - 1;
    if (family >= 2 && !isCutAlong(window_, family == 3, down, column))
    {
      return;
    }
    const GridLine line = gridLine(family, down, column);
    const double beside = family == 0 ? y - down : x - column;
    const double from = window_.z(line.row0, line.column0);
    const double to = window_.z(line.row1, line.column1);
    const double gap = place.z() - (from + beside * (to - from));
    const auto isSettled = [&] // by the two sides of the line
    {
      return beside > kAtNode && beside < 1.0 - kAtNode &&
        !border_.has(family == 1 ? k : -2, family == 0 ? k : -2) &&
        bend(window_, family, down, column) <= 0.0;
    };
    if (gap < far_() && !isSettled())
    {
      visit_(place, gap, LowFeature{ -1, edge, family, down, column });
    }
  }

  const PlacedBlock& rock_;
  const HeightWindow& window_;
  const GridBorder border_;
  const Far& far_;
  const Visit& visit_;
  const double relief_; ///< ∞ where no bound over the ground between two places is known.
  double least_ = 0.0;
};

template <class Far, class Visit>
void visitLowPlaces(const PlacedBlock& rock, const HeightWindow& window, const Far& far,
  const Visit& visit, const GridBorder& border = {})
{
  LowPlaces<Far, Visit>(rock, window, border, far, visit).visitAll();
}

} // namespace rockfall
