#pragma once

/// @file
/// Inputs of a run: the slope, and rocks that may move.

#include "shared/inputs.h"

#include "vtkWeakPointer.h"

class vtkAlgorithmOutput;

namespace rockfall::filters
{

struct RunInputs
{
  Input terrain{ InputKind::Terrain };
  Input rocks{ InputKind::Rocks };

  /// Message of what is wrong with one of them; empty if nothing is.
  const std::string& problem() const
  {
    return this->terrain.problem().empty() ? this->rocks.problem() : this->terrain.problem();
  }
  /// The time at which rocks that move are asked for: as they are shown when this is first asked.
  /// An animation that goes on, or a change of the run before, makes no run of another time.
  double timeOfRocks(
    vtkAlgorithmOutput* from, vtkInformation* rocks, vtkInformationVector* outputs);

private:
  /// Where rocks that move come from, and the time at which they were shown first.
  vtkWeakPointer<vtkAlgorithmOutput> rocksFrom;
  double rocksShown = 0.0;
};

} // namespace rockfall::filters
