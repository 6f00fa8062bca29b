#include "gis/raster/contours.h"

#include "base/Tally.h"
#include "base/detachedCall.h"
#include "base/require.h"
#include "gis/layers/fileContent.h"
#include "gis/raster/contourCrossings.h"
#include "gis/raster/contourLevels.h"
#include "gis/raster/contourLines.h"
#include "gis/raster/metric.h"
#include "gis/raster/relief.h"
#include "gis/raster/tin.h"
#include "gis/trust/heightReference.h"
#include "gis/trust/heights.h"
#include "gis/trust/nodata.h"
#include "terrain/flats.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace rockfall
{

namespace
{

using namespace gis;

Box boxOf(const Contours& contours)
{
  const auto [x0, x1] = std::minmax_element(contours.x.begin(), contours.x.end());
  const auto [y0, y1] = std::minmax_element(contours.y.begin(), contours.y.end());
  return { *x0, *x1, *y0, *y1 };
}

double lengthOf(const Contours& contours)
{
  double length = 0.0;
  for (const Line& line : contours.lines)
  {
    for (std::size_t i = line.first + 1; i < line.first + line.count; ++i)
    {
      length += std::hypot(contours.x[i] - contours.x[i - 1], contours.y[i] - contours.y[i - 1]);
    }
  }
  return length;
}

/// Width over length below which a TIN of the lines is nothing but needles.
constexpr double narrowest = 1e-3;

/// To metres on the ground.
void toMetric(Contours& contours, const LayerHeights& heights, RasterSurface& result,
  const std::string& fileName)
{
  const CrsPtr& crs = heights.horizontal;
  const Box box = boxOf(contours);
  const double wide = box.xMax - box.xMin, deep = box.yMax - box.yMin;
  if (!(std::min(wide, deep) > narrowest * std::max(wide, deep)))
  {
    throw DataError(fileName + ": its lines span " + boxText(box) + ", that is no area");
  }
  if (!crs)
  {
    const auto [low, high] = std::minmax_element(contours.z.begin(), contours.z.end());
    const double across = std::hypot(box.xMax - box.xMin, box.yMax - box.yMin);
    refuseUnlabelledDegrees(
      box, across / 100.0, (*high - *low) / across, "ogr2ogr -a_srs EPSG:4326", fileName);
    result.notes.push_back("The file has no CRS; its coordinates were taken as metres.");
    return;
  }
  const Destination to = destination(gridOf(box), crs, fileName);
  if (!to.doubt.empty())
  {
    result.notes.push_back(to.doubt);
  }
  result.geometry.crs = crsWkt(to.target ? to.target : crs, heights.reference);
  if (to.target)
  {
    if (!layerChange(fileName, crs, to.target, result.notes)
           .forth(int(contours.x.size()), contours.x.data(), contours.y.data()))
    {
      throw DataError(fileName + ": its lines cannot be brought to " + crsLabel(*to.target));
    }
    result.notes.push_back("Reprojected because " + to.reason + ": from " + crsLabel(*crs) +
      " to " + crsLabel(*to.target) + ".");
  }
  const Box metric = boxOf(contours);
  const double longest = std::max(metric.xMax - metric.xMin, metric.yMax - metric.yMin);
  if (longest > largestExtent)
  {
    throw DataError(fileName + ": its extent of " + number(longest / 1000.0) +
      " km is too large; cut out the slope first, e.g. with ogr2ogr -clipsrc");
  }
}

/// All vertices, about (x0, y0), and points between those that are farther apart than `spacing`.
TinPoints pointsOf(const Contours& contours, double x0, double y0, double spacing,
  const ContourOptions& options, const std::string& fileName)
{
  if (const double most = lengthOf(contours) / spacing + double(contours.x.size());
      most > double(options.largestVertices))
  {
    refuseVertices(fileName, most, options.largestVertices,
      "with one every " + number(spacing) + " m along the lines; take a larger CellSize");
  }
  TinPoints points;
  const auto add = [&](double x, double y, double z)
  {
    points.x.push_back(x);
    points.y.push_back(y);
    points.z.push_back(z);
  };
  for (const Line& line : contours.lines)
  {
    for (std::size_t i = line.first; i < line.first + line.count; ++i)
    {
      const double x = contours.x[i] - x0, y = contours.y[i] - y0, z = contours.z[i];
      if (i > line.first)
      {
        const double px = contours.x[i - 1] - x0, py = contours.y[i - 1] - y0;
        const double pz = contours.z[i - 1];
        const int parts = std::max(1, int(std::ceil(std::hypot(x - px, y - py) / spacing)));
        for (int k = 1; k < parts; ++k)
        {
          const double s = double(k) / parts;
          add(px + s * (x - px), py + s * (y - py), pz == z ? z : pz + s * (z - pz));
        }
      }
      add(x, y, z);
    }
  }
  return points;
}

struct UnitedPoints
{
  TinPoints points;
  Tally meetings; ///< Vertices where contours of different heights meet.
};

/// One point where several stand. Contours of different heights that meet there get their mean, and
/// a note.
UnitedPoints unite(const TinPoints& points, double x0, double y0)
{
  std::vector<std::size_t> order(points.x.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    {
      return std::tie(points.x[a], points.y[a], points.z[a]) <
        std::tie(points.x[b], points.y[b], points.z[b]);
    });
  UnitedPoints result;
  TinPoints& united = result.points;
  for (std::size_t i = 0; i < order.size();)
  {
    std::size_t end = i;
    double sum = 0.0;
    for (; end < order.size() && points.x[order[end]] == points.x[order[i]] &&
         points.y[order[end]] == points.y[order[i]];
         ++end)
    {
      sum += points.z[order[end]];
    }
    const double low = points.z[order[i]], high = points.z[order[end - 1]];
    result.meetings.look(low != high,
      [&]
      {
        return number(low) + " m and " + number(high) + " m at " + number(points.x[order[i]] + x0) +
          ", " + number(points.y[order[i]] + y0);
      });
    united.x.push_back(points.x[order[i]]);
    united.y.push_back(points.y[order[i]]);
    united.z.push_back(low == high ? low : sum / double(end - i));
    i = end;
  }
  return result;
}

} // namespace

RasterSurface readSlope(const std::string& fileName, const std::string& layer,
  const RasterOptions& raster, const ContourOptions& contours)
{
  ContourOptions lines = contours;
  lines.layer = layer;
  std::vector<std::string> notes;
  const FileContent content = contentOf(contourWish(fileName, lines), notes);
  RasterSurface surface =
    content.vector ? readContours(fileName, lines) : readRaster(content.raster, raster);
  surface.notes.insert(surface.notes.begin(), notes.begin(), notes.end());
  surface.contours = content.vector;
  return surface;
}

RasterSurface readContours(const std::string& fileName, const ContourOptions& options)
{
  require(options.cellSize >= 0.0 && std::isfinite(options.cellSize), "CellSize", options.cellSize,
    "", "a positive number of metres, or 0 for half the distance between contours");
  Messages messages;
  LayerFile file(contourWish(fileName, options), messages);
  OGRLayer& layer = file.layer();
  RasterSurface result;
  LayerHeights heights = heightsOf(file.dataset(), layer, fileName, result.notes);
  const HeightField field = heightFieldOf(layer, heights, options.elevationField, fileName);
  Contours contours = readLines(file, heights, field, options, messages);
  file.tell(result.notes, false);
  leaveOutFrames(contours, file.isOfDrawing(), result.notes);
  refuseStrayZeros(contours, fileName);
  const std::string where = field.column < 0 ? "the lines' own z" : "field \"" + field.name + "\"";
  if (field.heights.scale != heights.scale)
  {
    result.notes.push_back("Heights of " + where + " were multiplied by " +
      number(field.heights.scale) + " to be metres.");
  }
  else
  {
    heights.tell(result.notes);
  }
  if (contours.clamped > 0)
  {
    result.notes.push_back(std::to_string(contours.clamped) +
      " lines are clamped to the ground by their altitudeMode, or by none, so that their altitudes "
      "are not to be used; they were taken as heights all the same.");
  }
  if (contours.empty > 0)
  {
    result.notes.push_back(std::to_string(contours.empty) + " of " +
      std::to_string(contours.features) + " features have no line.");
  }
  const auto [low, high] = std::minmax_element(contours.z.begin(), contours.z.end());
  if (*low == *high)
  {
    throw DataError(fileName + ": all " + std::to_string(contours.lines.size()) +
      " contours have the height " + number(*low) + " m (" + where + "), that is no slope");
  }
  noteMarks(contours.z, {}, "vertices of the lines",
    "leave these lines out, e.g. with ogr2ogr -where", result.notes);
  toMetric(contours, heights, result, fileName);

  const Box box = boxOf(contours);
  const double length = lengthOf(contours);
  if (!(length > 0.0))
  {
    throw DataError(
      fileName + ": its " + std::to_string(contours.lines.size()) + " lines have no length");
  }
  const double area = (box.xMax - box.xMin) * (box.yMax - box.yMin);
  GridGeometry& grid = result.geometry;
  grid.fileUnits = { field.heights.unit, heights.plane };
  grid.cellSize = options.cellSize > 0.0 ? options.cellSize : threeDigits(area / (2.0 * length));
  grid.xOrigin = box.xMin;
  grid.yOrigin = box.yMin;
  const double columns = std::floor((box.xMax - box.xMin) / grid.cellSize + 1e-6) + 1.0;
  const double rows = std::floor((box.yMax - box.yMin) / grid.cellSize + 1e-6) + 1.0;
  setNodes(grid, columns, rows, 0, fileName);

  const double x0 = 0.5 * (box.xMin + box.xMax), y0 = 0.5 * (box.yMin + box.yMax);
  UnitedPoints united =
    detachedCall([points = pointsOf(contours, x0, y0, grid.cellSize, options, fileName), x0, y0]
      { return unite(points, x0, y0); });
  united.meetings.tell(result.notes, "Contours of different heights meet at ",
    " vertices, the first of ", "; their mean was taken.");
  if (const std::string crossed = crossingsNote(contours); !crossed.empty())
  {
    result.notes.push_back(crossed);
  }
  const std::size_t pointCount = united.points.x.size();
  TinNodes nodes =
    interpolateTin(std::move(united.points), grid, box.xMin - x0, box.yMin - y0, fileName);
  noteZeros(contours, result.notes);
  const auto flat = std::count(nodes.flat.begin(), nodes.flat.end(), 1);
  const std::vector<double> levels = levelsOf(contours);
  const std::int64_t relaxed =
    options.relaxFlats ? relaxFlats(grid.columns, grid.rows, nodes.heights, nodes.flat, levels) : 0;
  const auto nodata = std::count_if(
    nodes.heights.begin(), nodes.heights.end(), [](double z) { return std::isnan(z); });
  if (nodata == std::ptrdiff_t(nodes.heights.size()))
  {
    throw DataError(fileName + ": no node lies within the hull of its contours at a cell size of " +
      number(grid.cellSize) + " m");
  }
  result.heights = std::move(nodes.heights);
  noteRelief(result);
  result.notes.push_back("Made from contours: " + std::to_string(contours.lines.size()) +
    " lines of " + std::to_string(contours.x.size()) + " vertices, heights from " + where +
    " between " + number(*low) + " m and " + number(*high) + " m; TIN of " +
    std::to_string(pointCount) + " points; " + sizeText(grid.columns, grid.rows) + " nodes of " +
    number(grid.cellSize) + " m" +
    (options.cellSize > 0.0 ? "" : ", half the mean distance between contours") + ".");
  if (flat > 0)
  {
    result.notes.push_back(std::to_string(flat) + " nodes lie in flat triangles of the TIN; " +
      (options.relaxFlats ? std::to_string(relaxed) +
            " of them were given the heights of a thin plate that joins what is around them."
                          : std::string("they were left as they are.")));
  }
  if (nodata > 0)
  {
    result.notes.push_back(std::to_string(nodata) + " of " + std::to_string(result.heights.size()) +
      " nodes have no data.");
  }
  return result;
}

} // namespace rockfall
