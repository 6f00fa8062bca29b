/**
 * @class   vtkHazardMapAlgorithm
 * @brief   what a map of passages has of each cell, whatever the passages are read from
 *
 * Superclass of vtkRockfallHazardMap, of trajectories, and vtkHazardPassageReader, of files.
 */
#ifndef vtkHazardMapAlgorithm_h
#define vtkHazardMapAlgorithm_h

#include "RockfallFiltersModule.h"
#include "listProperty.h"
#include "vtkImageAlgorithm.h"

#include <vector> // for lists of numbers

namespace rockfall
{
namespace filters
{
struct HazardMapOptions;
}
}

class ROCKFALLFILTERS_EXPORT vtkHazardMapAlgorithm : public vtkImageAlgorithm
{
public:
  vtkTypeMacro(vtkHazardMapAlgorithm, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The statistics over the rocks of a cell that the map has of each quantity: 0 the mean, 1 the
   * maximum, 2 to 5 the 50, 90, 95 and 99 % quantiles. Mean, maximum and 95 % by default. Each takes
   * 16 bytes a cell.
   */
  rockfallListPropertyMacro(Statistics, int, AddStatistic, RemoveAllStatistics);
  ///@}

  ///@{
  /**
   * How often a rock of all these releases falls, 1/a, not negative. 0 (the default): by the
   * frequencies of the rocks, if they are known.
   */
  vtkSetMacro(AnnualFrequency, double);
  vtkGetMacro(AnnualFrequency, double);
  ///@}

  ///@{
  /**
   * Energies that part the classes of intensity, in kJ, positive, in any order. 30 and 300 by
   * default.
   */
  rockfallListPropertyMacro(
    EnergyThresholds, double, AddEnergyThreshold, RemoveAllEnergyThresholds);
  ///@}

  ///@{
  /**
   * Return periods of the scenarios, in years, positive, in any order. 30, 100 and 300 by default.
   */
  rockfallListPropertyMacro(ReturnPeriods, double, AddReturnPeriod, RemoveAllReturnPeriods);
  ///@}

  ///@{
  /**
   * Cells that a smaller share of the rocks of every source reaches (0 to 1) are left empty, and rocks do not count
   * in cells where their energy-line angle is smaller (0 to 90 degrees); the map says so. 0 by
   * default.
   */
  vtkSetMacro(LeastReach, double);
  vtkGetMacro(LeastReach, double);
  vtkSetMacro(LeastAngle, double);
  vtkGetMacro(LeastAngle, double);
  ///@}

  vtkHazardMapAlgorithm(const vtkHazardMapAlgorithm&) = delete;
  void operator=(const vtkHazardMapAlgorithm&) = delete;

protected:
  vtkHazardMapAlgorithm();
  ~vtkHazardMapAlgorithm() override;

  /// Of these properties; cells are the terrain's.
  rockfall::filters::HazardMapOptions MapOptions() const;

private:
  std::vector<int> Statistics;
  double AnnualFrequency = 0.0;
  std::vector<double> EnergyThresholds, ReturnPeriods;
  double LeastReach = 0.0;
  double LeastAngle = 0.0;
};

#endif
