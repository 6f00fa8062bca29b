#pragma once

/// @file
/// The map of hazards as an image.

#include "base/types.h"
#include "counts/frequencyLayers.h"
#include "statistics/sample.h"

#include <string>
#include <vector>

class vtkImageData;
class vtkPolyData;

namespace rockfall
{
class PassageFiles;
}

namespace rockfall::filters
{

/// A statistic over the rocks of a cell, of each quantity that is mapped: the end of an array's
/// name.
struct MapStatistic
{
  const char* name;
  double quantile; ///< 0: it is none.
  double (*value)(const SampleStatistics& of);
};
inline constexpr MapStatistic mapStatistics[] = {
  { "Mean", 0.0, [](const SampleStatistics& of) { return of.mean; } },
  { "Maximum", 0.0, [](const SampleStatistics& of) { return of.maximum; } },
  { "50", 0.5, [](const SampleStatistics& of) { return of.quantiles[0]; } },
  { "90", 0.9, [](const SampleStatistics& of) { return of.quantiles[1]; } },
  { "95", 0.95, [](const SampleStatistics& of) { return of.quantiles[2]; } },
  { "99", 0.99, [](const SampleStatistics& of) { return of.quantiles[3]; } },
};

/// Numbers of mapStatistics. Each costs an array of four bytes a cell for each quantity; a map of
/// 10⁷ cells with all of them takes 1.2 GB.
using ChosenStatistics = std::vector<int>;
inline const ChosenStatistics usualStatistics = { 0, 1, 4 }; ///< Mean, maximum, 95 %.

struct HazardMapOptions
{
  double cellSize = 0.0; ///< m; 0 = the terrain's.
  bool crop = false;     ///< To what the trajectories reach.
  bool rockWidth = true; ///< Rocks wider than a cell touch every cell under them.
  ChosenStatistics statistics = usualStatistics;
  FrequencyOptions frequency = {};
  double leastReach = 0.0; ///< Cells that no source reaches with such a share are left empty.
  double leastAngle = 0.0; ///< Passages with a smaller energy-line angle are dropped, degrees.
};

/// Fills `image`: see vtkRockfallHazardMap. `terrain` may be null. Throws rockfall::Error.
void makeHazardImage(vtkPolyData* trajectories, vtkPolyData* terrain,
  const HazardMapOptions& options, vtkImageData* image);

/// The same of files of passages, without the heights of the slope. Cells and widths are those of
/// the files.
void makeHazardImage(
  const PassageFiles& files, const HazardMapOptions& options, vtkImageData* image);

/// Writes the passages that the map of the whole terrain would be made of; cell
/// size and width of rocks as `options` has them. Throws rockfall::Error.
void writeHazardPassages(vtkPolyData* trajectories, vtkPolyData* terrain,
  const HazardMapOptions& options, const std::string& fileName);

/// Marks an empty image as a map: ranks without data must find the writer of maps as the first one
/// does.
void markEmptyMap(vtkImageData* image);

} // namespace rockfall::filters
