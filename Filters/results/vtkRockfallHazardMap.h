/**
 * @class   vtkRockfallHazardMap
 * @brief   maps what passes: how many rocks, how fast, how high, with what energy
 *
 * Input port 0 has one polyline per trajectory, as port 1 of vtkRockfallSimulation; port 1 is the
 * terrain of vtkDEMToCFESource, optional: trajectories bring the slope that they fell on. Output
 * port 0 is a vtkImageData in world coordinates with cell data; port 1 has those of its cells that
 * anything passed as polydata on the slope. A path is cut exactly at the borders of the cells,
 * along the cubic curve between its points.
 *
 * Cell arrays: Passages, Rocks, StoppingPoints, ReachProbability,
 * ReachProbabilityError, ReachProbabilityErrorOfIterations, and of
 * KineticEnergy (J), Speed (m/s), HeightOverGround (m) and RotationRate (rad/s)
 * the chosen Statistics over the rocks, such as SpeedMean and Speed95. Counts
 * are 0 and the others NaN where nothing passed, probabilities 0; their errors
 * are then the limits of a share of 0. HighestQuantile says which quantile the
 * rocks of a cell can give. EnergyLineAngleMinimum and EnergyLineAngleMean are of the lines from
 * where rocks leave the cell, or stop, up to their release, degrees.
 *
 * Where frequencies are known, by AnnualFrequency or the trajectories' cell array Frequency (1/a,
 * of the rock), also AnnualFrequency (1/a), ReturnPeriod (a), for each of the EnergyThresholds such
 * as ExceedanceProbability30kJ and AnnualFrequency30kJ, and for each of the ReturnPeriods
 * PassageProbability100a, of a passage in that time, and Intensity100a: how many of reach and the thresholds have at least that annual frequency.
 *
 * How large the image is depends on the data, and a pipeline wants to know it before: the inputs
 * are brought up to date when information is asked for.
 */
#ifndef vtkRockfallHazardMap_h
#define vtkRockfallHazardMap_h

#include "RockfallFiltersModule.h"
#include "vtkHazardMapAlgorithm.h"

#include <memory> // for the result
#include <string> // for an error

class ROCKFALLFILTERS_EXPORT vtkRockfallHazardMap : public vtkHazardMapAlgorithm
{
public:
  static vtkRockfallHazardMap* New();
  vtkTypeMacro(vtkRockfallHazardMap, vtkHazardMapAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Edge of the cells in metres, not negative. 0 (the default): the terrain's cells.
   */
  vtkSetMacro(CellSize, double);
  vtkGetMacro(CellSize, double);
  ///@}

  ///@{
  /**
   * Whether the map ends where the trajectories do instead of covering the whole terrain. Its cells
   * are the same. On by default; without a slope it always does.
   */
  vtkSetMacro(CropToTrajectories, bool);
  vtkGetMacro(CropToTrajectories, bool);
  vtkBooleanMacro(CropToTrajectories, bool);
  ///@}

  ///@{
  /**
   * Whether a rock that is wider than a cell touches every cell under the disc
   * of its Width, and not only that of its centre. On by default; needs the
   * cell array Width of the trajectories.
   */
  vtkSetMacro(RockWidth, bool);
  vtkGetMacro(RockWidth, bool);
  vtkBooleanMacro(RockWidth, bool);
  ///@}

  vtkRockfallHazardMap(const vtkRockfallHazardMap&) = delete;
  void operator=(const vtkRockfallHazardMap&) = delete;

protected:
  vtkRockfallHazardMap();
  ~vtkRockfallHazardMap() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  void Prepare(vtkInformationVector** inputVector);

  double CellSize = 0.0;
  bool CropToTrajectories = true;
  bool RockWidth = true;
  std::string Spread; // why trajectories on several ranks make no map
  struct Result;
  struct Inputs;
  std::unique_ptr<Result> Made;
  std::unique_ptr<Inputs> Taken;
};

#endif
