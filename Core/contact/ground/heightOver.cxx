#include "contact/ground/heightOver.h"
#include "contact/ground/lowPlaces.h"
#include "contact/ground/roundContact.h"
#include "law/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rockfall
{

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

/// Gradient of the CFE at a place in the window.
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
        const auto [row0, column0, row1, column1] = gridLine(low.family, low.row, low.column);
        const Vec3 line(window.x(column1) - window.x(column0), window.y(row1) - window.y(row0),
          window.z(row1, column1) - window.z(row0, column0));
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
