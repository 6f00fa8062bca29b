// A raster of classes.
#include "gis/raster/groundCells.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "gis/base/gdal.h"
#include "gis/base/progress.h"
#include "gis/raster/rasterPlace.h"
#include "gis/raster/resample.h"
#include "gis/trust/bandScale.h"
#include "gis/trust/unitDoubt.h"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
  said.planeDeclared = definedCrs(source.GetSpatialRef()) != nullptr || place.metres != 1.0;
  UnitDoubt doubt(said, cells.terrain.geometry().fileUnits);
  doubt.place(fileName, place.affine[0], place.affine[3]);
  doubt.tell(notes);
}

/// Samples of a class layer in one of the terrain's cells, a side, and of all cells, at most.
constexpr int finest = 8;
constexpr double mostSamples = 2e8;
/// Share of cells whose centre may speak for less than half of them: borders of wide classes have
/// less.
constexpr double fewCells = 0.1;

/// The values of a class layer over the terrain, so many to a side of a cell.
class ClassSamples
{
public:
  ClassSamples(GDALDataset& warped, const std::string& fileName, Messages& messages)
    : values_(warped.GetRasterBand(1))
    , covered_(warped.GetRasterBand(warped.GetRasterCount()))
    , fileName_(fileName)
    , messages_(messages)
  {
  }

  /// NaN where there is none.
  const std::vector<double>& rows(int first, int count)
  {
    const std::size_t size = std::size_t(count) * values_->GetXSize();
    value_.resize(size);
    alpha_.resize(size);
    messages_.clear();
    if (!readRows(*values_, first, count, GDT_Float64, value_.data()) ||
      !readRows(*covered_, first, count, GDT_Byte, alpha_.data()))
    {
      throw FileError(fileName_ + ": cannot be read: " + messages_.failure());
    }
    for (std::size_t i = 0; i < size; ++i)
    {
      value_[i] = alpha_[i] == 0 ? std::numeric_limits<double>::quiet_NaN() : value_[i];
    }
    return value_;
  }

private:
  GDALRasterBand *values_, *covered_;
  const std::string& fileName_;
  Messages& messages_;
  std::vector<double> value_;
  std::vector<std::uint8_t> alpha_;
};

/// A note if classes of the layer are in no cell, or if many cells are mostly of another one than
/// at their centre. `rowOf`: the row of a value, 0 for none.
template <class RowOf>
void noteFine(ClassSamples& samples, int perSide, double layerCell, const GroundTable& table,
  const Cells& cells, const std::vector<std::uint8_t>& classes, const std::string& fileName,
  RowOf&& rowOf, std::vector<std::string>& notes)
{
  std::vector<bool> inLayer(table.names.size() + 1), inCells(inLayer.size());
  std::int64_t other = 0, all = 0;
  std::vector<int> same(std::size_t(cells.columns));
  for (int row = 0; row < cells.rows; ++row)
  {
    const std::uint8_t* const own = classes.data() + std::size_t(row) * cells.columns;
    const std::vector<double>& value = samples.rows(row * perSide, perSide);
    std::fill(same.begin(), same.end(), 0);
    for (std::size_t i = 0; i < value.size(); ++i)
    {
      const std::size_t column = i % (std::size_t(cells.columns) * perSide) / perSide;
      const int of = std::isnan(value[i]) ? 0 : rowOf(value[i]);
      inLayer[std::size_t(of)] = true;
      same[column] += of == own[column];
    }
    for (int column = 0; column < cells.columns; ++column)
    {
      inCells[own[column]] = true;
      all += own[column] > 0;
      other += own[column] > 0 && 2 * same[std::size_t(column)] < perSide * perSide;
    }
  }
  std::string lost;
  for (std::size_t k = 1; k < inLayer.size(); ++k)
  {
    lost +=
      inLayer[k] && !inCells[k] ? (lost.empty() ? "\"" : ", \"") + table.names[k - 1] + "\"" : "";
  }
  if (!lost.empty() || double(other) > fewCells * double(all))
  {
    notes.push_back(fileName + ": has cells of " + numberText(layerCell, 3) + " m, the slope of " +
      number(cells.terrain.geometry().cellSize) +
      " m, whose centre decides: " + std::to_string(other) + " of " + std::to_string(all) +
      " are mostly of another class" + (lost.empty() ? "" : ", and in none is " + lost) +
      ". Take a smaller CellSize, or wider classes.");
  }
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

  const auto digits = [](double value) { return CPLString().Printf("%.17g", value); };
  // A centre on the edge between two of the layer's cells is in the eastern one, in the southern
  // one, in whichever order they are stored.
  const double size = cells.terrain.geometry().cellSize, aside = edge * size;
  std::array<double, 6> written{};
  const bool elsewhere =
    source->GetGeoTransform(written.data()) != CE_None || written != place.affine;
  const DatasetPtr single = elsewhere || source->GetRasterCount() > 1
    ? firstBandOf(*source, place, files.layer, messages)
    : DatasetPtr();
  const auto warpedTo = [&](int perSide)
  {
    // Overviews of classes may hold means of their numbers.
    std::vector<std::string> words = { "-of", "VRT", "-r", "near", "-ovr", "NONE", "-dstalpha",
      "-te", digits(cells.box.xMin + aside), digits(cells.box.yMin - aside),
      digits(cells.box.xMax + aside), digits(cells.box.yMax - aside), "-ts",
      std::to_string(cells.columns * perSide), std::to_string(cells.rows * perSide) };
    if (from && cells.crs)
    {
      words.insert(words.end(), { "-t_srs", crsWkt(*cells.crs) }); // no heights, no vertical part
    }
    CPLStringList options;
    for (const std::string& word : words)
    {
      options.AddString(word.c_str());
    }
    const std::unique_ptr<GDALWarpAppOptions, void (*)(GDALWarpAppOptions*)> how(
      GDALWarpAppOptionsNew(options.List(), nullptr), GDALWarpAppOptionsFree);
    GDALDatasetH sources[] = { GDALDataset::ToHandle(single ? single.get() : source.get()) };
    messages.clear();
    return DatasetPtr(
      GDALDataset::FromHandle(GDALWarp("", nullptr, 1, sources, how.get(), nullptr)));
  };
  const DatasetPtr warped = warpedTo(1);
  if (!warped)
  {
    failOverlap(files.layer,
      extentText(box, from, cells) +
        (messages.failure().empty() ? "" : " (" + messages.failure() + ")"),
      cells);
  }
  const BandScale scale = bandScale(*source->GetRasterBand(1), files.layer);
  if (scale.changes())
  {
    notes.push_back(files.layer + ": the band's " + scale.text() + " were applied to its classes.");
  }
  const char* const* categories = source->GetRasterBand(1)->GetCategoryNames();

  std::vector<std::uint8_t> classes(std::size_t(cells.columns) * cells.rows, 0);
  std::unordered_map<double, int> known;
  // The class of a number that is changed is a whole number but for the rounding of 0.1.
  const auto classOf = [&](double value)
  {
    const double of = scale.of(value), whole = std::round(of);
    return scale.changes() && std::abs(of - whole) <= 1e-9 * std::max(1.0, std::abs(of)) ? whole
                                                                                         : of;
  };
  const auto rowOf = [&](double value)
  {
    const auto found = known.find(value);
    if (found != known.end())
    {
      return found->second;
    }
    const double number = classOf(value);
    int row = scale.changes() && number != std::round(number) ? 0 : table.rowOf(exactly(number));
    if (row == 0 && categories && value >= 0.0 && value < CSLCount(categories))
    {
      row = table.rowOf(categories[int(value)]);
    }
    return known.emplace(value, row).first->second;
  };
  bool any = false;
  const int step = 64; // rows at once
  ClassSamples samples(*warped, files.layer, messages);
  for (int first = 0; first < cells.rows; first += step)
  {
    const std::vector<double>& value = samples.rows(first, std::min(step, cells.rows - first));
    for (std::size_t i = 0; i < value.size(); ++i)
    {
      if (std::isnan(value[i]))
      {
        continue;
      }
      any = true;
      const std::int64_t cell = std::int64_t(first) * cells.columns + std::int64_t(i);
      const int row = rowOf(value[i]);
      if (row == 0 && cells.hasGround(cell))
      {
        const double number = classOf(value[i]);
        if (scale.changes() && number != std::round(number))
        {
          throw DataError(files.layer + ": class " + exactly(value[i]) + " (in the cell at " +
            cells.place(cell) + ") with " + scale.text() + " is " + gis::number(number) +
            ", it must be a whole number");
        }
        failClass(files.layer,
          "class " + exactly(number) + " (in the cell at " + cells.place(cell) + ")", files.table,
          table);
      }
      classes[std::size_t(cell)] = std::uint8_t(row);
    }
  }
  if (!any)
  {
    failOverlap(files.layer, extentText(box, from, cells), cells);
  }
  const auto steps =
    centreSteps(grid, from && cells.crs ? CrsChange(from, cells.crs) : CrsChange());
  const double layerCell = std::sqrt(steps[0] * steps[1]);
  const int perSide = int(std::min({ std::ceil(size / layerCell - 0.01), double(finest),
    std::floor(std::sqrt(mostSamples / double(classes.size()))) }));
  if (const DatasetPtr fine = perSide > 1 ? warpedTo(perSide) : DatasetPtr())
  {
    ClassSamples within(*fine, files.layer, messages);
    noteFine(within, perSide, layerCell, table, cells, classes, files.layer, rowOf, notes);
  }
  return classes;
}

} // namespace rockfall::gis
