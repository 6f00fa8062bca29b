#include "sources/drawnSource.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "run/releasePlaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace rockfall::filters
{

namespace
{

/// Nodes along each side, about, among which the steep places of a slope are looked for, over
/// distances of one of these steps: a single rough cell is no steep place.
constexpr int kNodesAcross = 200;
/// Places with at least this share of the steepest gradient are steep.
constexpr double kSteep = 0.9;
/// Half a line's length, in cells, and as a share of the slope's shorter side at most.
constexpr double kHalfLength = 10.0, kMostOfSide = 0.1;
/// Room below and beside a line, as a share of the slope's shorter side: rocks that fall at its border
/// leave it before they say how far they go.
constexpr double kRoom = 0.3;

struct SlopePlace
{
  Vec3 position = Vec3::Zero(); ///< Local frame.
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
};

/// Places at nodes that are a step from the border and have no nodata around them.
std::vector<SlopePlace> look(const Terrain& terrain)
{
  const GridGeometry& grid = terrain.geometry();
  const int step = std::max(1, std::min(grid.columns, grid.rows) / kNodesAcross);
  std::vector<SlopePlace> places;
  for (int row = step; row + step < grid.rows; row += step)
  {
    for (int column = step; column + step < grid.columns; column += step)
    {
      const double way = 2.0 * step * grid.cellSize;
      const Eigen::Vector2d gradient(
        (terrain.nodeHeight(row, column + step) - terrain.nodeHeight(row, column - step)) / way,
        (terrain.nodeHeight(row - step, column) - terrain.nodeHeight(row + step, column)) / way);
      const Vec3 position = terrain.node(row, column);
      if (gradient.allFinite() && position.allFinite())
      {
        places.push_back({ position, gradient });
      }
    }
  }
  return places;
}

double shorterSide(const Terrain& terrain)
{
  return std::min(terrain.width(), terrain.height());
}

/// Whether rocks find the slope below a place and beside it. Downhill is that of the ground at large:
/// a rough cell's points anywhere.
bool hasRoom(const Terrain& terrain, const Eigen::Vector2d& place)
{
  const double room = kRoom * shorterSide(terrain);
  const auto heightBeside = [&](double x, double y)
  {
    const double cell = terrain.geometry().cellSize;
    const double ground = terrain.elevation(std::clamp(place.x() + x, cell, terrain.width() - cell),
      std::clamp(place.y() + y, cell, terrain.height() - cell));
    return std::isnan(ground) ? terrain.elevation(place.x(), place.y()) : ground;
  };
  const Eigen::Vector2d down(heightBeside(-room, 0.0) - heightBeside(room, 0.0),
    heightBeside(0.0, -room) - heightBeside(0.0, room));
  const Eigen::Vector2d way = room * down.normalized();
  const Eigen::Vector2d aside(-way.y(), way.x());
  const auto isOn = [&](const Eigen::Vector2d& at) { return terrain.cfeAt(at.x(), at.y()) != 0; };
  return isOn(place + way) && isOn(place + aside) && isOn(place - aside);
}

/// A line through a place, local frame, square to a gradient, as far as the slope goes.
std::array<double, 6> levelLine(
  const Terrain& terrain, const Eigen::Vector2d& middle, const Eigen::Vector2d& gradient)
{
  const double half =
    std::min(kHalfLength * terrain.geometry().cellSize, kMostOfSide * shorterSide(terrain));
  const Eigen::Vector2d along = gradient.norm() > 0.0
    ? Eigen::Vector2d(-gradient.y(), gradient.x()).normalized()
    : Eigen::Vector2d(1.0, 0.0);
  const Vec3 origin = terrain.geometry().origin();
  std::array<double, 6> line;
  for (int end = 0; end < 2; ++end)
  {
    Eigen::Vector2d place = middle;
    // Shorter where it would leave the slope.
    for (double reach = half; reach > 1e-3 * half; reach *= 0.5)
    {
      const Eigen::Vector2d tried = middle + along * (end == 0 ? -reach : reach);
      if (terrain.cfeAt(tried.x(), tried.y()) != 0)
      {
        place = tried;
        break;
      }
    }
    const double ground = terrain.elevation(place.x(), place.y());
    const Vec3 world = origin + Vec3(place.x(), place.y(), std::isnan(ground) ? 0.0 : ground);
    std::copy(world.data(), world.data() + 3, line.begin() + 3 * end);
  }
  return line;
}

} // namespace

std::vector<SourceRow> drawnRows(
  SourceGeometry geometry, const std::vector<std::array<double, 3>>& points, const Terrain* terrain)
{
  const std::size_t least = geometry == SourceGeometry::Point ? 1
    : geometry == SourceGeometry::Line                        ? 2
                                                              : 3;
  if (points.size() < least)
  {
    throw ParameterError("Points has " + std::to_string(points.size()) + " points, a drawn " +
      (least == 2 ? "line" : "area") + " needs " + std::to_string(least) + " at least");
  }
  std::vector<SourceRow> rows;
  std::vector<Vec3> corners;
  for (const auto& [x, y, z] : points)
  {
    if (!(std::isfinite(x) && std::isfinite(y) && std::isfinite(z)))
    {
      throw ParameterError("Points: " + numberText(x) + ", " + numberText(y) + ", " +
        numberText(z) + " must be finite");
    }
    if (terrain)
    {
      const Vec3 local = Vec3(x, y, z) - terrain->geometry().origin();
      if (terrain->cfeAt(local.x(), local.y()) == 0)
      {
        throw ParameterError("Points: the drawn point " + numberText(x) + ", " + numberText(y) +
          whyNoGround(*terrain, x, y));
      }
    }
    corners.emplace_back(x, y, terrain ? std::numeric_limits<double>::quiet_NaN() : z);
    if (geometry == SourceGeometry::Point)
    {
      SourceRow& row = rows.emplace_back();
      row.row = std::int64_t(rows.size());
      row.position = corners.back();
    }
  }
  if (geometry != SourceGeometry::Point)
  {
    if (geometry == SourceGeometry::Polygon && corners.front() != corners.back())
    {
      corners.push_back(corners.front());
    }
    if (geometry == SourceGeometry::Polygon)
    {
      requireValidOutline(corners, "Points: the drawn area is a POLYGON");
    }
    SourceRow& row = rows.emplace_back();
    row.row = 1;
    row.geometry = geometry;
    row.parts.push_back(std::move(corners));
  }
  return rows;
}

std::array<double, 6> steepLine(const Terrain& terrain)
{
  std::vector<SlopePlace> places = look(terrain);
  const auto roomy = std::stable_partition(places.begin(), places.end(),
    [&](const SlopePlace& place) { return hasRoom(terrain, place.position.head<2>()); });
  if (roomy != places.begin())
  {
    places.erase(roomy, places.end());
  }
  double steepest = 0.0;
  for (const SlopePlace& place : places)
  {
    steepest = std::max(steepest, place.gradient.norm());
  }
  // Of places of one height the one in the middle: even slopes have many.
  const Eigen::Vector2d middle(0.5 * terrain.width(), 0.5 * terrain.height());
  const auto rank = [&](const SlopePlace& place)
  { return std::pair(place.position.z(), -(place.position.head<2>() - middle).norm()); };
  const SlopePlace* best = nullptr;
  for (const SlopePlace& place : places)
  {
    if (place.gradient.norm() >= kSteep * steepest && (!best || rank(place) > rank(*best)))
    {
      best = &place;
    }
  }
  return best ? levelLine(terrain, best->position.head<2>(), best->gradient)
              : levelLine(terrain, middle, Eigen::Vector2d::Zero()); // too small to look at
}

std::optional<Vec3> placeByDefault(const Terrain& terrain, const double* center,
  const std::string& what, std::vector<std::string>& notes)
{
  const Vec3 local = Vec3(center[0], center[1], center[2]) - terrain.geometry().origin();
  if (!std::equal(kDefaultCenter.begin(), kDefaultCenter.end(), center) ||
    terrain.cfeAt(local.x(), local.y()) != 0)
  {
    return std::nullopt;
  }
  const std::array<double, 6> line = steepLine(terrain);
  const Vec3 place(
    0.5 * (line[0] + line[3]), 0.5 * (line[1] + line[4]), std::numeric_limits<double>::quiet_NaN());
  notes.push_back("Center was left as it is, which is not on this slope: " + what +
    " is released at " + numberText(place.x()) + ", " + numberText(place.y()) +
    ", the highest of its steep places");
  return place;
}

std::array<double, 6> middleLine(const Terrain& terrain)
{
  // The mean gradient: of the places that can be looked at.
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  for (const SlopePlace& place : look(terrain))
  {
    gradient += place.gradient;
  }
  return levelLine(
    terrain, Eigen::Vector2d(0.5 * terrain.width(), 0.5 * terrain.height()), gradient);
}

} // namespace rockfall::filters
