#include "gis/layers/lineLayer.h"

#include "base/errors.h"
#include "gis/base/FeatureRow.h"
#include "gis/base/gdal.h"
#include "gis/layers/LayerFile.h"
#include "gis/layers/barrierUnits.h"
#include "gis/layers/layerPlaces.h"
#include "gis/layers/lines.h"
#include "gis/trust/heights.h"

#include <ogrsf_frmts.h>

namespace rockfall
{

using namespace gis;

namespace
{

/// Every trajectory is held against every line.
constexpr std::size_t mostLines = 10'000;

} // namespace

std::vector<LayerLine> readLineLayer(const std::string& fileName, const std::string& targetCrs,
  const std::string& layerName, std::vector<std::string>* notes, const FileUnits& slope)
{
  std::vector<std::string> told;
  Messages messages;
  LayerWish wish{ fileName, layerName };
  wish.what = "layer of lines";
  wish.kinds = kLines | kPolygons;
  wish.better = kLines;
  LayerFile file(wish, messages);
  OGRLayer& layer = file.layer();
  refuseNearMisses(file.definition(), fileName, { "height", "capacity" }, { "name" });
  tellUnread(file.definition(), fileName, { "height", "capacity" },
    { "name", "length", "width", "slope" }, told);
  const LayerHeights heights = heightsOf(file.dataset(), layer, fileName, told);
  if (!heights.doubt.empty())
  {
    told.push_back(heights.doubt);
  }
  file.refuseForeignAxes(heights.horizontal, targetCrs);
  LayerPlaces places(fileName, heights, targetCrs, slope, "the trajectories", told);
  const Columns columns = columnsOf(file.definition());
  std::vector<LayerLine> lines;
  std::int64_t outlines = 0; // of polygons, among the lines
  while (const OGRFeatureUniquePtr feature = file.next())
  {
    const FeatureRow row(fileName, columns, *feature, file.number());
    row.refuseLostText(messages);
    LayerLine line;
    line.feature = file.number();
    line.layer = layer.GetName();
    line.name = row.text("name").value_or("");
    line.height = row.notNegative("height");
    line.capacity = row.notNegative("capacity");
    refuseOtherUnits(row, line.height, line.capacity);
    for (const OGRLineString* part : linesIn(row, &outlines))
    {
      line.points = places.line(row, *part);
      lines.push_back(line);
    }
    if (lines.size() > mostLines)
    {
      throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has more than " +
        std::to_string(mostLines) + " lines; leave out those that no rock can reach");
    }
  }
  if (lines.empty())
  {
    throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has no line");
  }
  if (notes)
  {
    file.tell(*notes, true);
    places.doubt.tell(*notes);
    notes->insert(notes->end(), told.begin(), told.end());
    if (outlines > 0)
    {
      notes->push_back(fileName + ": " + std::to_string(outlines) +
        (outlines == 1 ? " polygon is taken as its outline"
                       : " polygons are taken as their outlines") +
        ": a rock that comes in passes, and passes again as it goes out; one that is released "
        "inside passes as it leaves");
    }
  }
  return lines;
}

} // namespace rockfall
