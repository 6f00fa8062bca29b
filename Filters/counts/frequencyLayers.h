#pragma once

/// @file
/// Arrays of annual frequencies and intensity classes of a map of hazards; the releases of rocks.

#include "statistics/frequency.h"
#include "statistics/rockReleases.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <functional>
#include <vector>

class vtkFloatArray;
class vtkImageData;
class vtkIntArray;
class vtkPolyData;

namespace rockfall::filters
{

/// Thresholds and periods are Switzerland's: FOEN (2016), Protection against mass movement hazards.
struct FrequencyOptions
{
  double annualFrequency = 0.0; ///< Of all releases together, 1/a; 0 = by the array Frequency.
  std::vector<double> energyThresholds = { 30.0, 300.0 };     ///< kJ
  std::vector<double> returnPeriods = { 30.0, 100.0, 300.0 }; ///< a
};

/// Throws ParameterError that names the property and its value.
void checkFrequencies(const FrequencyOptions& options);

/// Rocks by the cell arrays of trajectories that are asked for, Frequency and SourceId; empty
/// without them. Throws DataError for a bad one.
RockReleases rocksOf(vtkPolyData* trajectories, bool frequencies, bool sources);

/// The arrays of a map; none where frequencies are not known.
class FrequencyLayers
{
public:
  /// Adds them to the cells of `image`. `released`: rocks × iterations. `rocks` is kept. A cell for
  /// which `isLeftOut` stays empty.
  FrequencyLayers(const FrequencyOptions& options, double released, const RockReleases& rocks,
    std::function<bool(std::uint32_t)> isLeftOut, vtkImageData* image);

  /// Passages in their order.
  void add(const Passage& passage)
  {
    if (known_)
    {
      summarizer_.add(passage);
    }
  }
  void finish() { summarizer_.finish(); }
  /// Of the rocks of cells in which frequencies differ.
  const FrequencyRange& differing() const { return summarizer_.differing(); }

private:
  void set(const CellFrequency& cell);

  bool known_;
  double released_;
  std::vector<double> periods_;
  std::function<bool(std::uint32_t)> isLeftOut_;
  std::vector<vtkSmartPointer<vtkFloatArray>> exceedances_, frequencies_, probabilities_;
  vtkSmartPointer<vtkFloatArray> period_;
  std::vector<vtkSmartPointer<vtkIntArray>> intensities_;
  FrequencySummarizer summarizer_;
};

} // namespace rockfall::filters
