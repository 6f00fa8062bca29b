#include "gis/raster/tin.h"

#include "base/detachedCall.h"
#include "base/errors.h"
#include "gis/base/gdal.h"

#include <gdal_alg.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace rockfall::gis
{

namespace
{

/// A node this near to the outside of a triangle (in barycentric coordinates) is in it: rounding
/// must not open gaps between neighbours.
constexpr double onEdge = 1e-9;
constexpr double atVertex = 1e-6;
/// Points of one height that are farther apart than this many cells are no neighbours on a contour:
/// an edge between them is a chord, across a valley or a ridge.
constexpr double chordLength = 1.5;

/// Whether all points lie on one line, to rounding: Qhull would say so on the terminal.
bool areCollinear(const TinPoints& points)
{
  const std::size_t count = points.x.size();
  const auto farthestFrom = [&](double x, double y)
  {
    std::size_t best = 0;
    double most = -1.0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const double d = std::hypot(points.x[i] - x, points.y[i] - y);
      best = d > most ? i : best;
      most = std::max(most, d);
    }
    return best;
  };
  if (count < 3)
  {
    return true;
  }
  const std::size_t a = farthestFrom(points.x[0], points.y[0]);
  const std::size_t b = farthestFrom(points.x[a], points.y[a]);
  const double dx = points.x[b] - points.x[a], dy = points.y[b] - points.y[a];
  const double length = std::hypot(dx, dy);
  double off = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    off =
      std::max(off, std::abs(dx * (points.y[i] - points.y[a]) - dy * (points.x[i] - points.x[a])));
  }
  return off <= 1e-9 * length * length;
}

struct Freed
{
  void operator()(GDALTriangulation* triangulation) const { GDALTriangulationFree(triangulation); }
};

} // namespace

TinNodes interpolateTin(TinPoints given, const GridGeometry& target, double west, double south,
  const std::string& fileName)
{
  Messages messages;
  const auto held = std::make_shared<const TinPoints>(std::move(given));
  const TinPoints& points = *held;
  if (areCollinear(points))
  {
    throw DataError(fileName + ": its " + std::to_string(points.x.size()) +
      " vertices lie on one straight line and have no triangulation");
  }
  const auto tin = detachedCall(
    [held]
    {
      Messages silent;
      return std::unique_ptr<GDALTriangulation, Freed>(
        GDALTriangulationCreateDelaunay(int(held->x.size()), held->x.data(), held->y.data()));
    });
  if (!tin || tin->nFacets == 0)
  {
    throw DataError(
      fileName + ": its " + std::to_string(points.x.size()) + " vertices have no triangulation");
  }
  TinNodes nodes;
  nodes.heights.assign(std::size_t(target.nodeCount()), std::numeric_limits<double>::quiet_NaN());
  nodes.flat.assign(std::size_t(target.nodeCount()), 1);
  const double inverse = 1.0 / target.cellSize;
  const double chord = chordLength * target.cellSize;
  const double north = south + (target.rows - 1) * target.cellSize;
  for (int k = 0; k < tin->nFacets; ++k)
  {
    stayWanted();
    double x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i)
    {
      const int vertex = tin->pasFacets[k].anVertexIdx[i];
      x[i] = points.x[vertex];
      y[i] = points.y[vertex];
      z[i] = points.z[vertex];
    }
    const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    const auto [xMin, xMax] = std::minmax({ x[0], x[1], x[2] });
    const auto [yMin, yMax] = std::minmax({ y[0], y[1], y[2] });
    const double across = std::max(xMax - xMin, yMax - yMin);
    if (std::abs(area) <= 1e-12 * across * across)
    {
      continue; // no inside; its neighbours have what is on it
    }
    const bool level = z[0] == z[1] && z[1] == z[2];
    bool flat = level;
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      flat = flat || (z[i] == z[j] && std::hypot(x[j] - x[i], y[j] - y[i]) > chord);
    }
    const auto first = [&](double low) { return int(std::max(0.0, std::ceil(low - 1e-6))); };
    const int column0 = first((xMin - west) * inverse), row0 = first((north - yMax) * inverse);
    const int column1 = std::min(target.columns - 1, int((xMax - west) * inverse + 1e-6));
    const int row1 = std::min(target.rows - 1, int((north - yMin) * inverse + 1e-6));
    for (int row = row0; row <= row1; ++row)
    {
      const double py = north - row * target.cellSize;
      for (int column = column0; column <= column1; ++column)
      {
        const double px = west + column * target.cellSize;
        const double b = ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) / area;
        const double c = ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) / area;
        if (b < -onEdge || c < -onEdge || b + c > 1.0 + onEdge)
        {
          continue;
        }
        const std::size_t node = std::size_t(row) * target.columns + column;
        // A node on a vertex has the contour's own height, whatever is around it.
        const double most = std::max({ b, c, 1.0 - b - c });
        const bool free = flat && most < 1.0 - atVertex;
        // On an edge between a sloping and a flat triangle the height is the same, and known.
        if (!flat || nodes.flat[node])
        {
          nodes.heights[node] = level ? z[0] : z[0] + b * (z[1] - z[0]) + c * (z[2] - z[0]);
        }
        nodes.flat[node] = nodes.flat[node] && free;
      }
    }
  }
  for (std::size_t node = 0; node < nodes.heights.size(); ++node)
  {
    nodes.flat[node] = nodes.flat[node] && !std::isnan(nodes.heights[node]);
  }
  return nodes;
}

} // namespace rockfall::gis
