#pragma once

/// @file
/// The map of hazards as an image.

#include "base/types.h"

#include <string>

class vtkImageData;
class vtkPolyData;

namespace rockfall
{
class PassageFiles;
}

namespace rockfall::filters
{

struct HazardMapOptions
{
  double cellSize = 0.0; ///< m; 0 = the terrain's.
  bool crop = false;     ///< To what the trajectories reach.
};

/// Fills `image`: see vtkRockfallHazardMap. `terrain` may be null. Throws rockfall::Error.
void makeHazardImage(vtkPolyData* trajectories, vtkPolyData* terrain,
  const HazardMapOptions& options, vtkImageData* image);

/// The same of files of passages, without the heights of the slope.
void makeHazardImage(const PassageFiles& files, vtkImageData* image);

/// Writes the passages that the map of the whole terrain would be made of; `cellSize` as above.
/// Throws rockfall::Error.
void writeHazardPassages(
  vtkPolyData* trajectories, vtkPolyData* terrain, double cellSize, const std::string& fileName);

/// Marks an empty image as a map: ranks without data must find the writer of maps as the first one
/// does.
void markEmptyMap(vtkImageData* image);

} // namespace rockfall::filters
