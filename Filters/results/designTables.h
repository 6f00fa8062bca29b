#pragma once

/// @file
/// Tables of what barriers at lines have to hold, from the crossings of a collector.

#include "results/mergedCrossings.h"
#include "statistics/design.h"

#include <string>
#include <vector>

class vtkPolyData;
class vtkTable;

namespace rockfall::filters
{

/// A line with the rocks that pass it, each as it does so for the first time, in the order of
/// iteration, rock and block.
struct DesignLine
{
  CollectorLine line; ///< Name, barrier and offset only.
  std::vector<DesignPassing> passings;
  LostRocks lost;             ///< Before they passed it.
  double lostFrequency = 0.0; ///< Of these, 1/a.
  bool known = false;         ///< Whether frequencies are.

  /// Of the barrier of the line, or of another capacity, J.
  BarrierOutcome outcome(double capacity) const;
  BarrierOutcome outcome() const { return this->outcome(line.barrierCapacity); }
};

/// Of crossings that mergeCrossings made, with `points`. `annualFrequency` (1/a) is that of all
/// releases together; 0 takes those of the rocks, NaN if there are none.
std::vector<DesignLine> designLines(
  const MergedCrossings& merged, vtkPolyData* points, double annualFrequency);

/// A row per line and level.
void writeDesign(
  const std::vector<DesignLine>& lines, const PartialFactors& factors, vtkTable* output);

/// A row per line and barrier: that of the line, then levels 0 to 7 with its height.
void writeClasses(const std::vector<DesignLine>& lines, vtkTable* output);

/// A row per line and source, by number and run.
void writeSources(const std::vector<DesignLine>& lines, vtkTable* output);

/// A row per line, for a chart over the offset. `released`: rocks × iterations.
void writePlaces(const std::vector<DesignLine>& lines, const PartialFactors& factors,
  std::int64_t released, vtkTable* output);

} // namespace rockfall::filters
