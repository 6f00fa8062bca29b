#pragma once

/// @file
/// Passages through the cells of a grid, rock by rock, and their statistics in each cell.

#include "statistics/sample.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace rockfall
{

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

/// A cell that something passed.
struct CellSummary
{
  std::int64_t cell = 0; ///< row · columns + column, rows from the south.
  int passages = 0;      ///< How often a rock came in, or was released there.
  int rocks = 0;         ///< Rocks (iteration × rock) that were there.
  int stops = 0;         ///< Rocks that came to rest there.
  double reach = 0.0;    ///< rocks / all rocks × iterations released.
  /// binomialError of p: √(p (1 − p) / n) of n released rocks × iterations: as
  /// if every release were an independent trial of one kind. Where sources
  /// differ the true error for these sources is smaller, as Σ pₖ (1 − pₖ) / n ≤
  /// p (1 − p).
  double reachError = 0.0;
  /// From the scatter of the share between iterations: also right where rocks
  /// of one iteration are not independent, as they share its realisation of the
  /// slope. NaN for one iteration. Where all came, shareLimit of the
  /// iterations.
  double reachErrorOfIterations = 0.0;
  /// Of the line from where a rock is as it leaves the cell, or stops, up to where it was released,
  /// degrees over the horizontal: over the rocks, each with its smallest.
  double angleLeast = 0.0, angleMean = 0.0;
  /// Over the rocks; a rock's value is its largest on the way through the cell.
  std::array<SampleStatistics, hazardCount> statistics;
};

/// Largest values of the quantities; −∞ where there is none. As precise as maps give them.
using Maxima = std::array<float, hazardCount>;
/// Takes in the values of another stay.
void raise(Maxima& maxima, const Maxima& other);

/// A rock in one iteration in one cell.
struct Passage
{
  static constexpr int kMostEntries = 32767; ///< More are not counted.
  static constexpr int kAngleSteps = 65535;  ///< Of a right angle: 0.0014° each.

  std::uint32_t cell = 0;
  std::uint32_t entries : 15 = 1;
  std::uint32_t stopped : 1 = 0; ///< Came to rest there.
  std::uint32_t angle : 16 = 0;  ///< The smallest energy-line angle, in kAngleSteps of 90°.
  std::int32_t iteration = 0;
  std::int32_t rock = 0;
  std::int64_t blockId = 0; ///< Tells the rocks of two runs from each other.
  Maxima maxima{};          ///< On the way through the cell.

  double degrees() const { return 90.0 / kAngleSteps * angle; }
  void enter(unsigned times) { entries = std::min<unsigned>(entries + times, kMostEntries); }
  /// Takes in another stay of the rock, which has entered `times`.
  void join(const Passage& other, unsigned times);
};

/// The order in which passages are summed: by cell, iteration, rock and block.
bool operator<(const Passage& a, const Passage& b);

/// How many rocks were released in each iteration.
using Releases = std::map<int, std::int64_t>;

using UseCell = std::function<void(const CellSummary&)>;

/// Makes summaries of passages that come in their order, so that it needs no more memory than one
/// cell's. The results are the same bits wherever the passages come from.
class CellSummarizer
{
public:
  /// Keeps a reference to `use`.
  CellSummarizer(const Releases& releases, const UseCell& use);

  /// Throws DataError if a rock comes twice for an iteration, or a passage out of its order or of
  /// an iteration without releases.
  void add(const Passage& passage);
  void finish(); ///< Hands on the last cell.

private:
  struct Count
  {
    double rocks, released;
  };
  void begin(std::uint32_t cell);

  const Releases& releases_;
  const UseCell& use_;
  double all_ = 0.0;         ///< Releases of all iterations.
  std::uint64_t angles_ = 0; ///< Sum over the rocks, in steps.
  std::uint32_t angleLeast_ = 0;
  double squaredReleases_ = 0.0; ///< Σ Rᵢ², Rᵢ the rocks released in iteration i
  bool any_ = false;
  Passage last_;
  CellSummary summary_;
  std::vector<Count> counts_; ///< Of the iterations that came here.
  std::array<std::vector<double>, hazardCount> values_;
};

} // namespace rockfall
