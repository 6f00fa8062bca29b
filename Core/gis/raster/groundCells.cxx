#include "gis/raster/groundCells.h"

#include "base/errors.h"
#include "gis/base/gdal.h"

#include <algorithm>

namespace rockfall::gis
{

void failOverlap(const std::string& fileName, const std::string& extent, const Cells& cells)
{
  throw DataError(fileName + ": does not overlap the slope: its extent is " + extent +
    ", the slope's " + boxText(cells.box) +
    (cells.crs ? " in " + crsLabel(*cells.crs) : std::string()));
}

void failClass(const std::string& layer, const std::string& what, const std::string& table,
  const GroundTable& rows)
{
  throw DataError(layer + ": " + what + " has no row in " + table + ", which has " + rows.keys());
}

void noteCrs(const CrsPtr& from, const Cells& cells, const std::string& fileName,
  std::vector<std::string>& notes)
{
  if (!from && cells.crs)
  {
    notes.push_back(fileName + " has no CRS; its coordinates were taken as those of the slope.");
  }
  else if (from && !cells.crs)
  {
    notes.push_back(
      "The slope has no CRS; the coordinates of " + fileName + " were taken as the slope's.");
  }
}

std::string extentText(Box box, const CrsPtr& from, const Cells& cells)
{
  if (from && cells.crs)
  {
    double x[4] = { box.xMin, box.xMax, box.xMin, box.xMax };
    double y[4] = { box.yMin, box.yMin, box.yMax, box.yMax };
    if (!CrsChange(from, cells.crs).forth(4, x, y))
    {
      return boxText(box) + " in " + crsLabel(*from);
    }
    const auto [x0, x1] = std::minmax_element(x, x + 4);
    const auto [y0, y1] = std::minmax_element(y, y + 4);
    box = { *x0, *x1, *y0, *y1 };
  }
  return boxText(box);
}

} // namespace rockfall::gis
