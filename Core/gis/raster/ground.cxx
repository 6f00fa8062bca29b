#include "gis/raster/ground.h"

#include "base/errors.h"
#include "gis/base/gdal.h"
#include "gis/layers/LayerFile.h"
#include "gis/layers/fileContent.h"
#include "gis/raster/groundCells.h"

#include <cmath>
#include <memory>

namespace rockfall
{

namespace
{

using namespace gis;

/// How much of the slope is of which class.
void noteShares(const GroundFiles& files, const GroundTable& table, const Cells& cells,
  const std::vector<std::uint8_t>& classes, std::vector<std::string>& notes)
{
  std::vector<std::int64_t> used(table.names.size() + 1, 0);
  std::int64_t total = 0;
  for (std::size_t cell = 0; cell < classes.size(); ++cell)
  {
    if (cells.hasGround(std::int64_t(cell)))
    {
      ++used[classes[cell]];
      ++total;
    }
  }
  std::string shares;
  for (std::size_t k = 1; k < used.size(); ++k)
  {
    if (used[k] == 0)
    {
      notes.push_back(files.table + ": no cell uses row " + std::to_string(k) + ", \"" +
        table.names[k - 1] + "\".");
      continue;
    }
    shares += (shares.empty() ? "" : ", ") + table.names[k - 1] + " " +
      number(std::round(1000.0 * double(used[k]) / double(total)) / 10.0) + " %";
  }
  notes.push_back("Classes of " + files.layer + ": " + (shares.empty() ? "none" : shares) +
    (used[0] > 0 ? "; " + std::to_string(used[0]) + " of " + std::to_string(total) +
          " cells are not covered and have the material of the slope's own properties."
                 : "."));
}

} // namespace

MaterialClasses readGround(GroundKind kind, const GroundFiles& files, const Terrain& terrain,
  std::vector<std::string>& notes)
{
  const std::string name = kindName(kind);
  if (files.layer.empty() && files.table.empty())
  {
    return {};
  }
  if (files.layer.empty())
  {
    throw ParameterError(name + "Table is " + files.table + ", but there is no " + name +
      "Layer that says where its classes are");
  }
  if (files.table.empty())
  {
    throw ParameterError(name + "Layer is " + files.layer + ", but there is no " + name +
      "Table that says what its classes are");
  }
  const GroundTable table =
    readGroundTable(kind, files, terrain.material(), terrain.roughness(), notes);
  const Cells cells(terrain);
  const FileContent content = contentOf(polygonWish(kind, files), notes);
  auto classes = std::make_shared<std::vector<std::uint8_t>>(content.vector
      ? fromPolygons(kind, files, table, cells, notes)
      : fromRaster(files, content.raster, table, cells, notes));
  noteShares(files, table, cells, *classes, notes);
  MaterialClasses result;
  result.names = table.names;
  result.materials = table.materials;
  result.roughness = table.roughness;
  result.cells = *classes;
  result.owner = std::move(classes);
  return result;
}

} // namespace rockfall
