#pragma once

/// @file
/// The ground, and how it is simulated, by names that a command line or a search gives.

#include "rock/parameters.h"
#include "terrain/Terrain.h"
#include "terrain/material.h"

#include <string>
#include <vector>

namespace rockfall::calibration
{

/// A user's mistake: the text says which argument.
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Settings of a run beside the data.
struct GroundSettings
{
  SurfaceMaterial material;
  Roughness roughness;
  DeviationPer deviationPer = DeviationPer::Iteration;
  SimulationParameters simulation;
  double cellSize = 0.5;       ///< Of the nodes that the data's grid is resampled to, m.
  double density = 2700.0;     ///< Of the rocks where the data has none, kg/m³.
  double placeDeviation = 0.1; ///< Of the place of a single impact, each way, m.

  /// A preset as the panel sets it, roughness and scatter with it; or "hard": the hard ground that
  /// docs/validation.md holds beside it. Throws DataError that lists the names.
  void setGround(const std::string& name);
  /// Sets the parameter of this name. Throws UsageError that lists the names, or ParameterError.
  void set(const std::string& name, double value);
  /// From "name=value".
  void set(const std::string& assignment);
};

/// A slope of these nodes with the ground on it.
Terrain makeTerrain(
  const GroundSettings& settings, GridGeometry geometry, std::vector<double> heights);

/// The names, in order, with unit.
std::vector<std::string> settingNames();

/// The command line `program FOLDER [--ground NAME] [--set name=value]… [--iterations N] [--seed N]
/// [--threads N]` and switches of the program's own. What comes later changes what came before.
struct Arguments
{
  std::string folder;
  std::string output; ///< After --output; empty: none.
  std::string stops;  ///< After --stops; empty: none.
  std::vector<std::string> switches;
  GroundSettings settings;

  bool has(const std::string& name) const;
};
/// Throws UsageError. Without data there is no folder.
Arguments parseArguments(int count, char** words, GroundSettings defaults,
  const std::vector<std::string>& switches, bool data = true);

/// The return value of a program's main: an exception is its message on standard error, and 1.
int runProgram(int (*run)(int, char**), int count, char** words);

} // namespace rockfall::calibration
