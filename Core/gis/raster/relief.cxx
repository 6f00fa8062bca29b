#include "gis/raster/relief.h"

#include "base/text/numberText.h"
#include "gis/base/gdal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rockfall::gis
{

namespace
{

/// Half of a site is hardly ever steeper than this; a talus of 35° with its heights in feet is at
/// 66°.
constexpr double steepSite = 60.0;
/// Heights in km make of a wall of 60° a plain that rises by 1.7 in a thousand.
constexpr double flatSite = 2e-3;
/// Spacing of heights, m: cliffs that rocks fall over are lower than this, and are no step any more.
constexpr double coarseSite = 25.0;

/// Share of the cells that are steeper than `tangent`, of those that have heights.
double shareSteeper(const RasterSurface& surface, double tangent)
{
  const GridGeometry& g = surface.geometry;
  const double limit = tangent * tangent * 4.0 * g.cellSize * g.cellSize;
  std::int64_t steep = 0, cells = 0;
  for (int row = 1; row < g.rows; ++row)
  {
    const double* above = surface.heights.data() + std::size_t(row - 1) * std::size_t(g.columns);
    const double* below = above + g.columns;
    for (int column = 1; column < g.columns; ++column)
    {
      // Twice the mean rise over a cell along x and along y.
      const double a = above[column] - below[column - 1], b = above[column - 1] - below[column];
      const double squared = (a - b) * (a - b) + (a + b) * (a + b);
      cells += !std::isnan(squared);
      steep += squared > limit;
    }
  }
  return cells > 0 ? double(steep) / double(cells) : 0.0;
}

} // namespace

void noteRelief(RasterSurface& surface, double spacing)
{
  if (spacing > coarseSite)
  {
    surface.notes.push_back("Its heights are some " + numberText(spacing, 2) +
      " m apart: cliffs and gullies between them are not on the slope, and rocks may be slower and "
      "stop sooner than in nature. Take a survey of 1 to 10 m");
  }
  const double steep = shareSteeper(surface, std::tan(radians(steepSite)));
  if (steep > 0.5)
  {
    surface.notes.push_back(number(std::round(100.0 * steep)) + " % of the slope is steeper than " +
      number(steepSite) + " degrees: are its heights in metres?");
  }
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double height : surface.heights)
  {
    low = std::isnan(height) ? low : std::min(low, height);
    high = std::isnan(height) ? high : std::max(high, height);
  }
  const GridGeometry& g = surface.geometry;
  const double across = (std::min(g.columns, g.rows) - 1) * g.cellSize;
  if (high > low && high - low < flatSite * across)
  {
    surface.notes.push_back("All heights are within " + number(high - low) + " m, on " +
      number(across) + " m and more: are they in metres?");
  }
  if (high == low)
  {
    surface.notes.push_back("All heights are " + number(low) + " m: is it the right band?");
  }
  if (low < 0.0 && high <= 0.0)
  {
    surface.notes.push_back("All heights are at 0 m or below, down to " + number(low) +
      " m: are they depths, which count downwards?");
  }
}

} // namespace rockfall::gis
