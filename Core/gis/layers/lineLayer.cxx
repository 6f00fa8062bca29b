#include "gis/layers/lineLayer.h"

#include "base/errors.h"
#include "gis/base/crs.h"
#include "gis/base/gdal.h"
#include "gis/layers/FeatureRow.h"
#include "gis/layers/LayerFile.h"
#include "gis/layers/barrierUnits.h"
#include "gis/layers/lines.h"
#include "gis/trust/heights.h"
#include "gis/trust/unitDoubt.h"

#include <ogrsf_frmts.h>

#include <cmath>

namespace rockfall
{

using namespace gis;

namespace
{

/// Every trajectory is held against every line.
constexpr std::size_t mostLines = 10'000;

class LineReader
{
public:
  LineReader(const std::string& fileName, OGRLayer& layer, const LayerHeights& heights,
    const std::string& targetCrs, const FileUnits& slope, std::vector<std::string>& notes)
    : fileName_(fileName)
    , columns_(columnsOf(*layer.GetLayerDefn()))
    , plane_(heights.plane)
    , from_(heights.horizontal)
    , doubt_(heights, slope)
  {
    if (!targetCrs.empty() && from_)
    {
      to_ = crsFromText(targetCrs);
      change_ = layerChange(fileName, from_, to_, notes);
    }
  }

  void read(const OGRFeature& feature, std::int64_t number, const Messages& messages)
  {
    LayerLine line;
    line.feature = number;
    const FeatureRow row(fileName_, columns_, feature, number);
    row.refuseLostText(messages);
    line.name = row.text("name").value_or("");
    line.height = row.notNegative("height");
    line.capacity = row.notNegative("capacity");
    refuseOtherUnits(row, line.height, line.capacity);
    for (const OGRLineString* part : linesIn(row, &outlines))
    {
      this->add(row, *part, line);
    }
  }

  std::vector<LayerLine> lines;
  std::int64_t outlines = 0; ///< Of polygons, among the lines.
  void tellDoubt(std::vector<std::string>& notes) const { doubt_.tell(notes); }

private:
  void add(const FeatureRow& row, const OGRLineString& part, LayerLine line)
  {
    for (int k = 0; k < part.getNumPoints(); ++k)
    {
      Eigen::Vector2d place(part.getX(k), part.getY(k));
      const Eigen::Vector2d written = place;
      doubt_.place(row, place.x(), place.y());
      place *= plane_;
      if (!place.allFinite() || !change_.forth(1, &place.x(), &place.y()))
      {
        row.fail("the point " + gis::number(written.x()) + ", " + gis::number(written.y()) +
          " cannot be brought to the coordinates of the trajectories");
      }
      if (line.points.empty() || line.points.back() != place)
      {
        line.points.push_back(place);
      }
    }
    if (line.points.size() < 2)
    {
      row.fail("is a line of one place only");
    }
    lines.push_back(std::move(line));
  }

  const std::string& fileName_;
  Columns columns_;
  double plane_;
  CrsPtr from_, to_;
  CrsChange change_;
  UnitDoubt doubt_;
};

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
  const LayerHeights heights = heightsOf(file.dataset(), layer, fileName, told);
  if (!heights.doubt.empty())
  {
    told.push_back(heights.doubt);
  }
  file.refuseDegrees(heights.horizontal, targetCrs);
  LineReader reader(fileName, layer, heights, targetCrs, slope, told);
  while (const OGRFeatureUniquePtr feature = file.next())
  {
    reader.read(*feature, file.number(), messages);
    if (reader.lines.size() > mostLines)
    {
      throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has more than " +
        std::to_string(mostLines) + " lines; leave out those that no rock can reach");
    }
  }
  if (reader.lines.empty())
  {
    throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has no line");
  }
  for (LayerLine& line : reader.lines)
  {
    line.layer = layer.GetName();
  }
  if (notes)
  {
    file.tell(*notes, true);
    reader.tellDoubt(*notes);
    notes->insert(notes->end(), told.begin(), told.end());
    if (reader.outlines > 0)
    {
      notes->push_back(fileName + ": " + std::to_string(reader.outlines) +
        (reader.outlines == 1 ? " polygon is taken as its outline"
                              : " polygons are taken as their outlines") +
        ": a rock that comes in passes, and passes again as it goes out; one that is released "
        "inside "
        "passes as it leaves");
    }
  }
  return std::move(reader.lines);
}

} // namespace rockfall
