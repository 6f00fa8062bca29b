#pragma once

/// @file
/// A run that a filter keeps: what it was made of, and its outputs.

#include "run/ensemble.h"
#include "shared/ranks.h"
#include "simulation/runSink.h"

#include "vtkFieldData.h"
#include "vtkType.h"

#include <memory>
#include <string>
#include <vector>

namespace rockfall::filters
{

/// A data object as it is now.
struct Stamp
{
  vtkDataObject* object = nullptr;
  vtkMTimeType time = 0;

  Stamp() = default;
  explicit Stamp(vtkDataObject* data)
    : object(data)
    , time(data->GetMTime())
  {
  }
  bool operator==(const Stamp&) const = default;
};

struct KeptRun : RunData
{
  SimulationParameters parameters;
  std::string contactFile;      ///< Of pairs of materials; empty: none.
  std::string contactSheet;     ///< Of the file; empty: the one that will do.
  bool allowReferences = false; ///< The file may name addresses and other files.
  KeptParts parts;
  bool printNotes = true; ///< Tell what was lost; the summary has it in any case.
  Stamp terrain, rocks;   ///< The inputs.
  /// Content of the inputs that decides the run (inputContent.h).
  std::uint64_t terrainContent = 0, rocksContent = 0;

  Terrain slope;
  RunFrame frame;
  vtkNew<vtkFieldData> coordinates;   ///< CRS and origin.
  vtkNew<vtkFieldData> ground;        ///< The slope as it came.
  std::unique_ptr<Ensemble> ensemble; ///< Of `slope` and the rocks of `frame`.

  /// What the Notes of the table say: its own, of properties that have no effect, of the inputs.
  std::vector<std::string> notes, idle, ofInputs;

  std::vector<Trajectory> whole; ///< Trajectories of `wholeIteration`, with all samples.
  int wholeIteration = -1;
  std::string stateHash; ///< Over the bits of all motion.

  /// Whether another one of these properties computes the same.
  bool hasPropertiesOf(const KeptRun& other) const;
  /// The same, of the same inputs as they are.
  bool isLike(const KeptRun& other) const
  {
    return terrain == other.terrain && rocks == other.rocks && this->hasPropertiesOf(other);
  }
  /// Whether another one of these properties and inputs would come out the same, on this rank. If
  /// so, takes over what only shows: stamps and names. Throws Error where the inputs do not hold.
  bool takesOver(
    const KeptRun& other, vtkPolyData* terrainInput, vtkPolyData* rocksInput, const Ranks& ranks);
  /// Whether all samples of one iteration may be kept beside the outputs, some 400 MB at most.
  bool wholeFits() const;

  /// Takes the inputs from the ranks that have them. Collective. Throws Error on all ranks.
  void prepare(vtkPolyData* terrainInput, vtkPolyData* rocksInput, const Ranks& ranks);
  /// Reads the pairs of materials on the first rank, for all. Collective. Throws Error on all
  /// ranks.
  void readContacts(const Ranks& ranks);
  std::string noMemory() const; ///< Text for want of memory.
  /// Cell arrays of the rocks that only show; in a parallel run none, as names are on one rank.
  std::uint64_t contentOfRocks(vtkPolyData* rocksInput, const Ranks& ranks) const;
  /// Takes what a sink was given, perhaps not all of it.
  void takeResults(RunSink& sink);
  /// Writes the notes into the table.
  void writeNotes();
  /// Adds own notes, and shows them if they are to be told.
  void tell(const std::vector<std::string>& further);
  /// Lets the outputs know in which coordinates they stand, and the trajectories their slope.
  void describe();
  /// Lets go of what only `show` needs.
  void dropInputs();
  /// Writes the blocks of an iteration (counted from the run's first one) as they are at `time`, s.
  /// False if aborted.
  bool show(int shown, double time, const Progress& progress, vtkPolyData* output);
};

} // namespace rockfall::filters
