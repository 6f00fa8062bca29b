// A raster of classes.
#include "gis/raster/groundCells.h"

#include "base/errors.h"
#include "gis/base/gdal.h"
#include "gis/base/progress.h"
#include "gis/raster/rasterPlace.h"
#include "gis/raster/resample.h"
#include "gis/trust/unitDoubt.h"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <unordered_map>

namespace rockfall::gis
{

namespace
{

/// Centres this near to the edge of a class's cell are on it, in cells of the terrain.
constexpr double edge = 1e-6;

/// The first band with its mask or transparency, and no other one: what these hold would count as
/// data of the first where that has none. At `place`, which GDAL may have found otherwise.
DatasetPtr firstBandOf(GDALDataset& source, const RasterPlace& place, const std::string& fileName,
  const Messages& messages)
{
  CPLStringList options;
  for (const char* word : { "-of", "VRT", "-nogcp", "-b", "1" })
  {
    options.AddString(word);
  }
  for (int band = 2; band <= source.GetRasterCount(); ++band)
  {
    if (source.GetRasterBand(band)->GetColorInterpretation() == GCI_AlphaBand)
    {
      options.AddString("-b");
      options.AddString(std::to_string(band).c_str());
    }
  }
  const std::unique_ptr<GDALTranslateOptions, void (*)(GDALTranslateOptions*)> how(
    GDALTranslateOptionsNew(options.List(), nullptr), GDALTranslateOptionsFree);
  DatasetPtr first(
    GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(&source), how.get(), nullptr)));
  std::array<double, 6> affine = place.affine;
  if (!first || first->SetGeoTransform(affine.data()) != CE_None ||
    (place.crs && first->SetSpatialRef(place.crs.get()) != CE_None))
  {
    throw FileError(fileName + ": cannot be read: " + messages.failure());
  }
  return first;
}

/// Coordinates in no known unit beside a slope in feet.
void noteUnits(GDALDataset& source, const RasterPlace& place, const Cells& cells,
  const std::string& fileName, std::vector<std::string>& notes)
{
  LayerHeights said;
  said.planeDeclared = source.GetSpatialRef() != nullptr || place.metres != 1.0;
  UnitDoubt doubt(said, cells.terrain.geometry().fileUnits);
  doubt.place(fileName, place.affine[0], place.affine[3]);
  doubt.tell(notes);
}

} // namespace

std::vector<std::uint8_t> fromRaster(const GroundFiles& files, const std::string& raster,
  const GroundTable& table, const Cells& cells, std::vector<std::string>& notes)
{
  Messages messages;
  const DatasetPtr source = openRaster(raster, messages);
  if (source->GetRasterCount() == 0)
  {
    throw FileError(files.layer + ": has no raster band");
  }
  const RasterPlace place = placeOfCells(*source, files.layer, notes);
  const CrsPtr& from = place.crs;
  noteCrs(from, cells, files.layer, notes);
  noteUnits(*source, place, cells, files.layer, notes);
  layerChange(files.layer, from, cells.crs, notes); // or there is no way
  SourceGrid grid;
  grid.columns = source->GetRasterXSize();
  grid.rows = source->GetRasterYSize();
  grid.affine = place.affine;
  // extent() is that of the centres.
  Box box = extent(grid);
  const double half = 0.5 * std::max(grid.columnStep(), grid.rowStep());
  box = { box.xMin - half, box.xMax + half, box.yMin - half, box.yMax + half };

  CPLStringList options;
  const auto add = [&](std::initializer_list<std::string> words)
  {
    for (const std::string& word : words)
    {
      options.AddString(word.c_str());
    }
  };
  const auto digits = [](double value) { return CPLString().Printf("%.17g", value); };
  // A centre on the edge between two of the layer's cells is in the eastern one, in the southern
  // one, in whichever order they are stored.
  const double size = cells.terrain.geometry().cellSize, aside = edge * size;
  // Overviews of classes may hold means of their numbers.
  add({ "-of", "VRT", "-r", "near", "-ovr", "NONE", "-dstalpha", "-te",
    digits(cells.box.xMin + aside), digits(cells.box.yMin - aside), digits(cells.box.xMax + aside),
    digits(cells.box.yMax - aside), "-ts", std::to_string(cells.columns),
    std::to_string(cells.rows) });
  if (from && cells.crs)
  {
    add({ "-t_srs", crsWkt(*cells.crs) }); // classes are no heights: no vertical part
  }
  const std::unique_ptr<GDALWarpAppOptions, void (*)(GDALWarpAppOptions*)> how(
    GDALWarpAppOptionsNew(options.List(), nullptr), GDALWarpAppOptionsFree);
  std::array<double, 6> written{};
  const bool elsewhere =
    source->GetGeoTransform(written.data()) != CE_None || written != place.affine;
  const DatasetPtr single = elsewhere || source->GetRasterCount() > 1
    ? firstBandOf(*source, place, files.layer, messages)
    : DatasetPtr();
  GDALDatasetH sources[] = { GDALDataset::ToHandle(single ? single.get() : source.get()) };
  messages.clear();
  const DatasetPtr warped(
    GDALDataset::FromHandle(GDALWarp("", nullptr, 1, sources, how.get(), nullptr)));
  if (!warped)
  {
    failOverlap(files.layer,
      extentText(box, from, cells) +
        (messages.failure().empty() ? "" : " (" + messages.failure() + ")"),
      cells);
  }
  GDALRasterBand* values = warped->GetRasterBand(1);
  GDALRasterBand* covered = warped->GetRasterBand(warped->GetRasterCount());
  char** categories = source->GetRasterBand(1)->GetCategoryNames();

  std::vector<std::uint8_t> classes(std::size_t(cells.columns) * cells.rows, 0);
  std::unordered_map<double, int> rowOf;
  bool any = false;
  const int step = 64; // rows at once
  std::vector<double> value(std::size_t(step) * cells.columns);
  std::vector<std::uint8_t> alpha(value.size());
  for (int first = 0; first < cells.rows; first += step)
  {
    const int count = std::min(step, cells.rows - first);
    messages.clear();
    if (!readRows(*values, first, count, GDT_Float64, value.data()) ||
      !readRows(*covered, first, count, GDT_Byte, alpha.data()))
    {
      throw FileError(files.layer + ": cannot be read: " + messages.failure());
    }
    for (std::size_t i = 0; i < std::size_t(count) * cells.columns; ++i)
    {
      if (alpha[i] == 0 || std::isnan(value[i]))
      {
        continue;
      }
      any = true;
      const std::int64_t cell = std::int64_t(first) * cells.columns + std::int64_t(i);
      auto known = rowOf.find(value[i]);
      if (known == rowOf.end())
      {
        if (!cells.hasGround(cell))
        {
          continue;
        }
        int row = table.rowOf(exactly(value[i]));
        if (row == 0 && categories && value[i] >= 0.0 && value[i] < CSLCount(categories))
        {
          row = table.rowOf(categories[int(value[i])]);
        }
        if (row == 0)
        {
          failClass(files.layer,
            "class " + exactly(value[i]) + " (in the cell at " + cells.place(cell) + ")",
            files.table, table);
        }
        known = rowOf.emplace(value[i], row).first;
      }
      classes[std::size_t(cell)] = std::uint8_t(known->second);
    }
  }
  if (!any)
  {
    failOverlap(files.layer, extentText(box, from, cells), cells);
  }
  return classes;
}

} // namespace rockfall::gis
