#pragma once

/// @file
/// What passes through the cells of a grid: how many rocks, how fast, how high, with what energy.

#include "statistics/path.h"
#include "statistics/sample.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace rockfall
{

class Terrain;

/// Square cells in the frame of the paths. Cell (0, 0) is the south-western one.
struct CellGrid
{
  int columns = 0;
  int rows = 0;
  double cellSize = 0.0; ///< m
  double west = 0.0;     ///< Corner of the south-western cell, m.
  double south = 0.0;

  std::int64_t cellCount() const { return std::int64_t(columns) * rows; }
};

/// The quantities that are mapped.
enum class Hazard
{
  KineticEnergy = 0,    ///< J
  Speed = 1,            ///< m/s
  HeightOverGround = 2, ///< m
  RotationRate = 3,     ///< rad/s
};
constexpr int hazardCount = 4;
std::string hazardName(Hazard hazard); ///< In PascalCase.

/// One cell that something passed.
struct CellSummary
{
  std::int64_t cell = 0; ///< row · columns + column, rows from the south.
  int passages = 0;      ///< How often a rock came in, or was released there.
  int rocks = 0;         ///< Rocks (iteration × rock) that were there.
  int stops = 0;         ///< Rocks that came to rest there.
  double reach = 0.0;    ///< rocks / all rocks × iterations released.
  /// √(p (1 − p) / n) of n released rocks × iterations: as if every release were an independent
  /// trial of one kind. Where sources differ the true error for these sources is smaller, as
  /// Σ pₖ (1 − pₖ) / n ≤ p (1 − p).
  double reachError = 0.0;
  /// From the scatter of the share between iterations: also right where rocks of one iteration are
  /// not independent, as they share its realisation of the slope. NaN for one iteration.
  double reachErrorOfIterations = 0.0;
  /// Over the rocks; a rock's value is its largest on the way through the cell.
  std::array<SampleStatistics, hazardCount> statistics;
};

/// Keeps one passage per rock, iteration and cell, so that quantiles are exact and parts can be
/// merged. The results depend on what was added, not on the order or on how it was shared out.
class HazardRaster
{
public:
  /// `terrain`, if given, is the ground between the points of a path; its local frame is then the
  /// paths'. Throws ParameterError for a grid without cells or of more than 2³² of them.
  explicit HazardRaster(const CellGrid& grid, const Terrain* terrain = nullptr);

  const CellGrid& grid() const { return grid_; }

  /// Cuts the path at the borders of the cells. What is beyond the grid counts as released, not
  /// more. Throws DataError as checkPath. Not for several threads at once: use one raster each, and
  /// merge.
  void add(const RockPath& path);
  /// Takes in what another raster of the same grid has. Throws ParameterError for another grid.
  void merge(const HazardRaster& other);

  std::int64_t released() const { return released_; }
  /// Calls `use` for each cell that anything passed, in the order of cells. Throws DataError if a
  /// rock was added twice for an iteration.
  void summarize(const std::function<void(const CellSummary&)>& use);

private:
  struct Passage
  {
    std::uint32_t cell = 0;
    std::uint32_t entries = 1;
    std::int32_t iteration = 0;
    std::int32_t rock = 0;
    std::array<double, hazardCount> maxima{}; ///< −∞ where there was none.
  };
  std::int64_t cellAt(double x, double y) const; ///< −1 beyond the grid.
  void addPiece(const PathPiece& piece, std::array<double, 2> grounds);
  void addVisit(std::int64_t cell, const std::array<double, hazardCount>& maxima);
  double maxHeight(
    const PathPiece& piece, double from, double to, std::array<double, 2> grounds) const;

  CellGrid grid_;
  const Terrain* terrain_;
  std::vector<Passage> passages_;
  std::vector<std::uint32_t> stops_;
  std::map<int, std::int64_t> releasedIn_; ///< Rocks per iteration.
  std::int64_t released_ = 0;

  // Of the path being added.
  std::vector<Passage> visits_;
  std::int64_t here_ = -1;
  std::vector<double> cuts_;
  mutable std::vector<double> groundCuts_;
};

} // namespace rockfall
