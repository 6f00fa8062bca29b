#pragma once

/// @file
/// Arrays of annual frequencies and intensity classes of a map of hazards.

#include <vector>

class vtkImageData;
class vtkPolyData;

namespace rockfall
{
class HazardRaster;
}

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

/// Adds the arrays to the cells of `image`, the map of `raster`, which is of `trajectories`.
/// Without frequencies it adds nothing. Throws DataError for a bad cell array Frequency.
void addFrequencies(HazardRaster& raster, vtkPolyData* trajectories,
  const FrequencyOptions& options, vtkImageData* image);

} // namespace rockfall::filters
