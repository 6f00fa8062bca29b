#include "counts/hazardImage.h"

#include "base/abort.h"
#include "base/require.h"
#include "base/text/numberText.h"
#include "counts/lostRocks.h"
#include "geometry/shell.h"
#include "shared/arrays.h"
#include "shared/errorReport.h"
#include "shared/inputContent.h"
#include "shared/rockPaths.h"
#include "shared/slopeReference.h"
#include "shared/terrainFieldData.h"
#include "statistics/HazardRaster.h"
#include "statistics/copies.h"
#include "statistics/passageFile.h"
#include "statistics/sourceReach.h"
#include "terrain/plausible.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <optional>
#include <string>

namespace rockfall::filters
{

namespace
{

/// At 84 bytes each the usual map takes 4 GB.
constexpr std::int64_t mostCells = 50'000'000;

struct Bounds
{
  double xMin, xMax, yMin, yMax;
};

Bounds boundsOf(vtkPolyData* trajectories, const Vec3& origin, double margin = 0.0)
{
  double b[6];
  trajectories->GetBounds(b);
  return { b[0] - origin.x() - margin, b[1] - origin.x() + margin, b[2] - origin.y() - margin,
    b[3] - origin.y() + margin };
}

/// By how much the widest rock reaches beyond its path, m; 0 if all are
/// narrower than a cell.
double reachBeside(vtkPolyData* trajectories, double cell, bool rockWidth)
{
  vtkDataArray* width = trajectories->GetCellData()->GetArray("Width");
  const double most = rockWidth && width ? width->GetRange()[1] : 0.0;
  return most > cell ? 0.5 * most : 0.0;
}

/// The cells from `first` to `last` along one axis, counted from the corner of
/// the whole grid.
struct Range
{
  double first, last;
};

Range rangeOf(double low, double high, double start, double cell)
{
  return { std::floor((low - start) / cell), std::floor((high - start) / cell) };
}

void checkSize(double columns, double rows, double cell)
{
  if (!(columns * rows <= double(mostCells)))
  {
    throw ParameterError("A map of " + numberText(columns) + " x " + numberText(rows) +
      " cells of " + numberText(cell) + " m has more than " + std::to_string(mostCells) +
      ": give a larger CellSize, or switch CropToTrajectories on");
  }
}

/// The grid in the local frame.
CellGrid gridOf(vtkPolyData* trajectories, const Terrain* terrain, const HazardMapOptions& options,
  const Vec3& origin)
{
  require(options.cellSize >= 0.0 && std::isfinite(options.cellSize), "CellSize", options.cellSize,
    "", "finite and not negative");
  constexpr double widestCell = 1e6; // m
  if (options.cellSize > widestCell)
  {
    throw ParameterError("CellSize is " + numberText(options.cellSize) + " m, it must be at most " +
      numberText(widestCell));
  }
  if (options.cellSize == 0.0 && !terrain)
  {
    throw ParameterError(
      "CellSize is 0, which takes the cells of the slope, but none came with the "
      "trajectories: give a CellSize or connect the Terrain");
  }
  CellGrid grid;
  grid.cellSize = options.cellSize > 0.0 ? options.cellSize : terrain->geometry().cellSize;
  const double cell = grid.cellSize;
  const Bounds b =
    boundsOf(trajectories, origin, reachBeside(trajectories, cell, options.rockWidth));
  Range columns = rangeOf(b.xMin, b.xMax, 0.0, cell), rows = rangeOf(b.yMin, b.yMax, 0.0, cell);
  if (terrain)
  {
    // A last cell may reach beyond the slope; not for the sake of rounding, though.
    const Range all{ 0.0, std::ceil(terrain->width() / cell - 1e-9) - 1.0 };
    const Range allRows{ 0.0, std::ceil(terrain->height() / cell - 1e-9) - 1.0 };
    const auto within = [](const Range& part, const Range& whole) {
      return Range{ std::max(part.first, whole.first), std::min(part.last, whole.last) };
    };
    columns = within(columns, all);
    rows = within(rows, allRows);
    if (columns.last < columns.first || rows.last < rows.first)
    {
      throw DataError(
        "No trajectory of the Input is over the Terrain: they do not belong together");
    }
    if (!options.crop)
    {
      columns = all;
      rows = allRows;
    }
  }
  const double width = columns.last - columns.first + 1.0, depth = rows.last - rows.first + 1.0;
  checkSize(width, depth, cell);
  grid.columns = int(width);
  grid.rows = int(depth);
  grid.west = columns.first * cell;
  grid.south = rows.first * cell;
  return grid;
}

void checkStatistics(const ChosenStatistics& chosen)
{
  for (const int number : chosen)
  {
    if (number < 0 || number >= int(std::size(mapStatistics)))
    {
      throw ParameterError("Statistics has " + std::to_string(number) + ", they are 0 to " +
        std::to_string(std::size(mapStatistics) - 1));
    }
  }
}

/// Of all iterations.
std::int64_t releasedIn(const Releases& releases)
{
  std::int64_t all = 0;
  for (const auto& [iteration, count] : releases)
  {
    all += count;
  }
  return all;
}

/// The cell arrays.
class Layers
{
public:
  Layers(vtkImageData* image, const HazardMapOptions& options, const Releases& releases)
    : options_(options)
  {
    const ChosenStatistics& chosen = options.statistics;
    vtkFieldData* data = image->GetCellData();
    const vtkIdType cells = image->GetNumberOfCells();
    const auto count = [&](const char* name)
    { return addFilledArray<vtkIntArray>(data, name, cells, 0); };
    const auto number = [&](const std::string& name, float empty)
    { return addFilledArray<vtkFloatArray>(data, name, cells, empty); };
    passages_ = count("Passages");
    rocks_ = count("Rocks");
    stops_ = count("StoppingPoints");
    reach_ = number("ReachProbability", 0.0F);
    // Where nothing came the errors say how probable it may be all the same.
    const auto iterations = double(releases.size());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    reachError_ =
      number("ReachProbabilityError", float(binomialError(0.0, double(releasedIn(releases)))));
    reachScatter_ = number(
      "ReachProbabilityErrorOfIterations", iterations > 1.0 ? float(shareLimit(iterations)) : nan);
    angleLeast_ = number("EnergyLineAngleMinimum", nan);
    angleMean_ = number("EnergyLineAngleMean", nan);
    for (std::size_t k = 0; k < std::size(mapStatistics); ++k)
    {
      if (std::find(chosen.begin(), chosen.end(), int(k)) != chosen.end())
      {
        chosen_.push_back(&mapStatistics[k]); // each once, in this order
        highest_ = std::max(highest_, mapStatistics[k].quantile);
      }
    }
    for (int h = 0; h < hazardCount; ++h)
    {
      for (const MapStatistic* statistic : chosen_)
      {
        statistics_.push_back(number(hazardName(Hazard(h)) + statistic->name, nan));
      }
    }
    if (highest_ > 0.0)
    {
      quantile_ = count("HighestQuantile");
    }
  }

  /// Whether the cell that was set last was left empty.
  bool isLeftOut() const { return isLeftOut_; }

  /// Whether a passage is dropped by its angle. Those of a cell are asked for before it is set.
  bool drops(const Passage& passage)
  {
    const bool dropped = passage.degrees() < options_.leastAngle;
    if (dropped)
    {
      ++dropped_;
      this->leaveOut(passage.cell); // unless another one of it is kept
    }
    return dropped;
  }

  /// `reach`: the share that LeastReach is asked of.
  void set(const CellSummary& cell, double reach)
  {
    const vtkIdType id = cell.cell;
    isLeftOut_ = reach < options_.leastReach;
    if (isLeftOut_)
    {
      this->leaveOut(id);
      return;
    }
    leftOut_ -= std::isnan(reachError_->GetValue(id));
    angleLeast_->SetValue(id, float(cell.angleLeast));
    angleMean_->SetValue(id, float(cell.angleMean));
    passages_->SetValue(id, cell.passages);
    rocks_->SetValue(id, cell.rocks);
    stops_->SetValue(id, cell.stops);
    reach_->SetValue(id, float(cell.reach));
    reachError_->SetValue(id, float(cell.reachError));
    reachScatter_->SetValue(id, float(cell.reachErrorOfIterations));
    most_ = std::max(most_, cell.rocks);
    if (quantile_)
    {
      quantile_->SetValue(id, highestQuantile(std::size_t(cell.rocks)));
    }
    auto array = statistics_.begin();
    for (const SampleStatistics& of : cell.statistics)
    {
      for (const MapStatistic* statistic : chosen_)
      {
        (*array++)->SetValue(id, float(statistic->value(of)));
      }
    }
  }

  bool hasQuantiles() const { return highest_ > 0.0; }

  /// Notes on cells that were left empty, and where no cell has the rocks that the highest quantile
  /// of the map needs.
  std::vector<std::string> notes() const
  {
    std::vector<std::string> notes = this->quantileNotes();
    if (options_.frequency.annualFrequency > 0.0)
    {
      askAfterFrequency(options_.frequency.annualFrequency, notes);
    }
    const std::string angle = "LeastAngle, " + numberText(options_.leastAngle) + " degrees";
    if (dropped_ > 0)
    {
      notes.push_back(std::to_string(dropped_) +
        " passages of rocks through cells are dropped: their energy-line angle is below " + angle);
    }
    if (leftOut_ > 0)
    {
      notes.push_back(std::to_string(leftOut_) +
        " cells that rocks passed are left empty: of no source comes LeastReach, " +
        numberText(options_.leastReach) + ", of its rocks, or all energy-line angles are below " +
        angle);
    }
    return notes;
  }

  /// Statements of the map on what is left empty.
  void tellLeftOut(vtkFieldData* data) const
  {
    if (options_.leastReach > 0.0 || options_.leastAngle > 0.0)
    {
      addArray<vtkDoubleArray>(data, "LeastReach")->InsertNextValue(options_.leastReach);
      addArray<vtkDoubleArray>(data, "LeastAngle")->InsertNextValue(options_.leastAngle);
      addArray<vtkIdTypeArray>(data, "CellsLeftEmpty")->InsertNextValue(vtkIdType(leftOut_));
    }
  }

private:
  /// The limits of a cell where nothing came would be too low here.
  void leaveOut(vtkIdType id)
  {
    leftOut_ += !std::isnan(reachError_->GetValue(id));
    reachError_->SetValue(id, std::numeric_limits<float>::quiet_NaN());
    reachScatter_->SetValue(id, std::numeric_limits<float>::quiet_NaN());
  }

  std::vector<std::string> quantileNotes() const
  {
    const int least = highest_ > 0.0 ? leastForQuantile(highest_) : 0;
    if (most_ == 0 || most_ >= least)
    {
      return {};
    }
    return { "No cell has more than " + std::to_string(most_) + " rocks, too few for a " +
      numberText(100.0 * highest_) + " % quantile, which takes " + std::to_string(least) +
      ": HighestQuantile says of each cell which one it can give" };
  }

  const HazardMapOptions& options_;
  bool isLeftOut_ = false;
  std::int64_t leftOut_ = 0; ///< Cells.
  std::int64_t dropped_ = 0; ///< Passages.
  double highest_ = 0.0;     ///< Of the quantiles that are chosen.
  int most_ = 0;             ///< Rocks in a cell.
  vtkSmartPointer<vtkIntArray> quantile_;
  vtkSmartPointer<vtkIntArray> passages_, rocks_, stops_;
  vtkSmartPointer<vtkFloatArray> reach_, reachError_, reachScatter_, angleLeast_, angleMean_;
  std::vector<const MapStatistic*> chosen_;
  std::vector<vtkSmartPointer<vtkFloatArray>> statistics_;
};

/// Heights of the slope at the corners of the cells, to drape the map over it. Returns whether the
/// slope has one at each.
bool addElevation(const Terrain& terrain, const CellGrid& grid, vtkImageData* image)
{
  bool whole = true;
  writeDiagonal(terrain.geometry().diagonal, image->GetFieldData());
  const auto elevation = addArray<vtkFloatArray>(image->GetPointData(), "Elevation");
  elevation->SetNumberOfTuples(image->GetNumberOfPoints());
  vtkIdType id = 0;
  for (int row = 0; row <= grid.rows; ++row)
  {
    for (int column = 0; column <= grid.columns; ++column, ++id)
    {
      const double height =
        terrain.elevation(std::min(grid.west + column * grid.cellSize, terrain.width()),
          std::min(grid.south + row * grid.cellSize, terrain.height()));
      elevation->SetValue(id, float(std::isnan(height) ? terrain.lowest() : height));
      whole = whole && !std::isnan(height);
    }
  }
  return whole;
}

void addMarker(vtkImageData* image, std::initializer_list<double> numbers)
{
  addArray<vtkDoubleArray>(image->GetFieldData(), "HazardMap", 7)->InsertNextTuple(numbers.begin());
}

} // namespace

void markEmptyMap(vtkImageData* image)
{
  addMarker(image, { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 });
}

namespace
{

/// Finds copies among the rocks of several runs by their passages, if any.
class CopiesOfRuns
{
public:
  explicit CopiesOfRuns(const RockReleases& rocks)
    : runs_(rocks.runs())
  {
  }

  void add(const Passage& passage)
  {
    const float speed = passage.maxima[std::size_t(Hazard::Speed)];
    if (speed > 0.0F && runs_.hasSeveral(passage.rock)) // rocks that lie still are alike by chance
    {
      const Maxima& m = passage.maxima;
      copies_.add(passage.iteration, passage.rock, passage.blockId,
        std::array{ double(passage.cell), double(passage.entries), double(passage.angle),
          double(m[0]), double(m[1]), double(m[2]), double(m[3]) });
    }
  }
  std::vector<std::string> notes() const { return copyNotes(copies_.count()); }

private:
  RockRuns runs_;
  Copies copies_;
};

/// The map but for its heights and coordinate system. `corner`: the
/// south-western one, in the world. `copies`, if given, are told.
void fillImage(const CellGrid& grid, const Vec3& corner, const Releases& releases, bool withTerrain,
  const LostRocks& lost, const HazardMapOptions& options, const RockReleases& rocks,
  std::vector<std::string> notes,
  const std::function<void(const std::function<void(const Passage&)>&)>& forEach,
  CopiesOfRuns* copies, vtkImageData* image)
{
  image->Initialize();
  image->SetExtent(0, grid.columns, 0, grid.rows, 0, 0);
  image->SetOrigin(corner.x(), corner.y(), 0.0);
  image->SetSpacing(grid.cellSize, grid.cellSize, grid.cellSize);
  const auto released = double(releasedIn(releases));
  Layers layers(image, options, releases);
  // A cell's summary comes before its frequencies.
  FrequencyLayers frequencyLayers(
    options.frequency, released, rocks, [&layers](std::uint32_t) { return layers.isLeftOut(); },
    image);
  std::optional<SourceReach> reach;
  if (options.leastReach > 0.0 && rocks.haveSources())
  {
    reach.emplace(rocks);
  }
  const UseCell set = [&](const CellSummary& cell)
  { layers.set(cell, reach ? reach->take() : cell.reach); };
  CellSummarizer summarizer(releases, set);
  forEach(
    [&](const Passage& passage)
    {
      if (copies)
      {
        copies->add(passage);
      }
      if (!layers.drops(passage))
      {
        summarizer.add(passage);
        frequencyLayers.add(passage);
        if (reach)
        {
          reach->add(passage); // behind the summary of the cell before
        }
      }
    });
  summarizer.finish();
  frequencyLayers.finish();
  image->GetCellData()->SetActiveScalars("ReachProbability"); // what a viewer begins with
  addMarker(image,
    { double(grid.columns), double(grid.rows), grid.cellSize, corner.x(), corner.y(), released,
      withTerrain ? 1.0 : 0.0 });
  layers.tellLeftOut(image->GetFieldData());
  if (copies)
  {
    std::ranges::move(copies->notes(), std::back_inserter(notes));
  }
  std::ranges::move(layers.notes(), std::back_inserter(notes));
  if (layers.hasQuantiles())
  {
    std::ranges::move(frequencyLayers.differing().notes(), std::back_inserter(notes));
  }
  tellLost(lost, image->GetFieldData(), notes);
}

void checkOptions(const HazardMapOptions& options)
{
  checkStatistics(options.statistics);
  checkFrequencies(options.frequency);
  require(options.leastReach >= 0.0 && options.leastReach <= 1.0, "LeastReach", options.leastReach,
    "", "0 to 1");
  require(options.leastAngle >= 0.0 && options.leastAngle <= 90.0, "LeastAngle", options.leastAngle,
    " degrees", "0 to 90");
}

void addPaths(vtkPolyData* trajectories, const Vec3& origin, bool rockWidth, HazardRaster& raster)
{
  // A rock and its pieces stay together. Polydata's cells begin with its vertices.
  std::vector<std::int64_t> starts;
  vtkDataArray* piece = trajectories->GetCellData()->GetArray("Piece");
  const vtkIdType lines = trajectories->GetNumberOfLines();
  for (vtkIdType k = 0; piece && k < lines; ++k)
  {
    if (k == 0 || piece->GetComponent(trajectories->GetNumberOfVerts() + k, 0) == 0.0)
    {
      starts.push_back(k);
    }
  }
  starts.push_back(lines);
  raster.addAll(piece ? std::int64_t(starts.size()) - 1 : lines,
    [&](std::int64_t first, std::int64_t count, const std::function<void(const RockPath&)>& use)
    {
      if (piece)
      {
        count = starts[std::size_t(first + count)] - starts[std::size_t(first)];
        first = starts[std::size_t(first)];
      }
      forPaths(trajectories, origin, first, count,
        [&](const RockPath& path, std::int64_t)
        {
          RockPath added = path;
          added.width = rockWidth ? path.width : 0.0;
          use(added);
        });
    });
}

void checkLines(vtkPolyData* trajectories)
{
  if (trajectories->GetNumberOfLines() == 0)
  {
    throw DataError("The Input has no lines; the trajectories of Rockfall Simulation are wanted");
  }
}

} // namespace

void makeHazardImage(vtkPolyData* trajectories, vtkPolyData* terrainMesh,
  const HazardMapOptions& options, vtkImageData* image)
{
  checkLines(trajectories);
  checkOptions(options);
  const std::optional<Terrain> terrain = slopeUnder(trajectories, terrainMesh);
  Vec3 origin = Vec3::Zero();
  if (terrain)
  {
    origin = terrain->geometry().origin();
  }
  else
  {
    // Of maps of one cell size the cells are the same everywhere: multiples of it in the world.
    const Bounds b = boundsOf(trajectories, origin);
    const double cell = options.cellSize;
    if (cell > 0.0 && std::isfinite(cell))
    {
      origin = Vec3(std::floor(b.xMin / cell) * cell, std::floor(b.yMin / cell) * cell, 0.0);
    }
  }
  const Terrain* ground = terrain ? &*terrain : nullptr;
  const CellGrid grid = gridOf(trajectories, ground, options, origin);
  HazardRaster raster(grid, ground);
  addPaths(trajectories, origin, options.rockWidth, raster);
  std::vector<std::string> notes = doubtsOn(trajectories, terrainMesh);
  if (options.frequency.annualFrequency > 0.0 && trajectories->GetCellData()->GetArray("Frequency"))
  {
    notes.push_back(ownNotUsed(options.frequency.annualFrequency));
  }
  fillImage(
    grid, origin + Vec3(grid.west, grid.south, 0.0), raster.releases(), terrain.has_value(),
    lostOf(trajectories), options,
    rocksOf(trajectories, options.frequency.annualFrequency <= 0.0, options.leastReach > 0.0),
    std::move(notes),
    [&raster](const std::function<void(const Passage&)>& use)
    {
      for (const Passage& passage : raster.sorted())
      {
        stayWanted();
        use(passage);
      }
    },
    nullptr, image);
  if (terrain && !addElevation(*terrain, grid, image) && !terrainMesh &&
    !hasTerrain(trajectories->GetFieldData()))
  {
    showNote(
      "The trajectories bring the heights under their paths only, as those of a file do; "
      "Elevation is the lowest of them elsewhere: connect the slope as Terrain if it matters");
  }
  copyCoordinateSystem(trajectories->GetFieldData(), image->GetFieldData());
}

void makeHazardImage(
  const PassageFiles& files, const HazardMapOptions& options, vtkImageData* image)
{
  checkOptions(options);
  const CellGrid& grid = files.grid();
  checkSize(grid.columns, grid.rows, grid.cellSize);
  std::vector<std::string> notes = files.notes();
  if (options.frequency.annualFrequency > 0.0 && files.rocks().haveFrequencies())
  {
    notes.push_back(ownNotUsed(options.frequency.annualFrequency));
  }
  CopiesOfRuns copies(files.rocks());
  fillImage(
    grid, Vec3(grid.west, grid.south, 0.0), files.releases(), true, files.lost(), options,
    files.rocks(), std::move(notes),
    [&files](const std::function<void(const Passage&)>& use) { files.forEach(use); }, &copies,
    image);
  writeCoordinateSystem(files.crs(), files.origin(), image->GetFieldData());
}

void writeHazardPassages(vtkPolyData* trajectories, vtkPolyData* terrainMesh,
  const HazardMapOptions& options, const std::string& fileName)
{
  checkLines(trajectories);
  const Terrain terrain = readTerrain(terrainMesh);
  checkSameCrs(
    trajectories->GetFieldData(), "The trajectories of the Input are", terrainMesh->GetFieldData());
  const Vec3 origin = terrain.geometry().origin();
  HazardMapOptions whole = options;
  whole.crop = false;
  HazardRaster raster(gridOf(trajectories, &terrain, whole, origin), &terrain);
  addPaths(trajectories, origin, options.rockWidth, raster);
  for (const std::string& note : doubtsOn(trajectories, terrainMesh))
  {
    showNote(note);
  }
  writePassages(raster, origin, readCrs(trajectories->GetFieldData()), fileName,
    lostOf(trajectories), rocksOf(trajectories, true, true), runOf(trajectories));
}

} // namespace rockfall::filters
