/**
 * @class   vtkHazardPassageReader
 * @brief   makes one hazard map of the passages of many runs
 *
 * Reads files of vtkHazardPassageWriter and makes the map that vtkRockfallHazardMap would make of
 * all their trajectories at once, bit for bit, whatever these are shared out over files. No file is
 * in memory as a whole. The point array Elevation is missing: the files know nothing of the slope.
 */
#ifndef vtkHazardPassageReader_h
#define vtkHazardPassageReader_h

#include "RockfallFiltersModule.h"
#include "vtkImageAlgorithm.h"

#include <string> // for FileNames
#include <vector> // for lists of numbers and names

class ROCKFALLFILTERS_EXPORT vtkHazardPassageReader : public vtkImageAlgorithm
{
public:
  static vtkHazardPassageReader* New();
  vtkTypeMacro(vtkHazardPassageReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The files, of one grid and coordinate system.
   */
  void AddFileName(const char* fileName);
  void RemoveAllFileNames();
  ///@}

  ///@{
  /**
   * As of vtkRockfallHazardMap.
   */
  void AddStatistic(int statistic);
  void RemoveAllStatistics();
  ///@}

  ///@{
  /**
   * How often a rock of all these releases falls, 1/a, not negative. 0 (the default): by the frequencies
   * that the files have of their rocks, if they have any.
   */
  vtkSetMacro(AnnualFrequency, double);
  vtkGetMacro(AnnualFrequency, double);
  ///@}

  ///@{
  /**
   * Energies that part the classes of intensity, in kJ, positive, in any order. 30 and 300 by
   * default.
   */
  void AddEnergyThreshold(double threshold);
  void RemoveAllEnergyThresholds();
  ///@}

  ///@{
  /**
   * Return periods of the scenarios, in years, positive, in any order. 30, 100 and 300 by default.
   */
  void AddReturnPeriod(double period);
  void RemoveAllReturnPeriods();
  ///@}

  ///@{
  /**
   * Cells that a smaller share of the rocks reaches (0 to 1), or whose smallest energy-line angle is
   * smaller (0 to 90 degrees), are left empty, and the map says so. 0 by default.
   */
  vtkSetMacro(LeastReach, double);
  vtkGetMacro(LeastReach, double);
  vtkSetMacro(LeastAngle, double);
  vtkGetMacro(LeastAngle, double);
  ///@}

  /// 1 if the file is whole and one of passages, else 0.
  static int CanReadFile(const char* fileName);

  vtkHazardPassageReader(const vtkHazardPassageReader&) = delete;
  void operator=(const vtkHazardPassageReader&) = delete;

protected:
  vtkHazardPassageReader();
  ~vtkHazardPassageReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  std::vector<std::string> FileNames;
  std::vector<int> Statistics;
  double AnnualFrequency = 0.0;
  std::vector<double> EnergyThresholds, ReturnPeriods;
  double LeastReach = 0.0;
  double LeastAngle = 0.0;
};

#endif
