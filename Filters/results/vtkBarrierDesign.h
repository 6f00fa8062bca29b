/**
 * @class   vtkBarrierDesign
 * @brief   what a barrier at a line has to hold: design table, classes of net, sources
 *
 * The input is the crossings of lines, port 0 of vtkTrajectoryCollector or vtkMergeCollectors. A
 * rock counts as it passes a line for the first time.
 *
 * Output port 0 has a row per line and level (50, 90, 95, 98, 99 % and the largest): energy (kJ),
 * speed (m/s) and height of the rock's top (m) with their limits, design values by partial factors,
 * the smallest sufficient class of EAD 340059-00-0106. Port 1 has a row per line and barrier: what
 * the one on the line and those of levels 0 to 7 would catch, with annual frequencies. Port 2 has a
 * row per line and source of the rocks, port 3 a row per line: along a family of parallels the
 * place where a barrier has the least to hold.
 */
#ifndef vtkBarrierDesign_h
#define vtkBarrierDesign_h

#include "RockfallFiltersModule.h"
#include "vtkTableAlgorithm.h"

class ROCKFALLFILTERS_EXPORT vtkBarrierDesign : public vtkTableAlgorithm
{
public:
  static vtkBarrierDesign* New();
  vtkTypeMacro(vtkBarrierDesign, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What the three factors of surveys and trajectories are.
  enum FactorSets
  {
    TYPED = 0,
    UNI_GOOD = 1, ///< UNI 11211-4:2018, good surveys and back analysis: 1.02 each.
    UNI_POOR = 2  ///< UNI 11211-4:2018, poor surveys, values from literature: 1.10 each.
  };

  ///@{
  /**
   * How often a rock of all releases together falls, 1/a, not negative. 0 (the default): by the
   * array Frequency of the crossings, if they have one.
   */
  vtkSetMacro(AnnualFrequency, double);
  vtkGetMacro(AnnualFrequency, double);
  ///@}

  ///@{
  /**
   * Of which set SlopeSurveyFactor, TrajectoryFactor and BlockSurveyFactor are; typed by default.
   */
  vtkSetMacro(FactorSet, int);
  vtkGetMacro(FactorSet, int);
  ///@}

  ///@{
  /**
   * Partial factors, 1 or more, 1 by default: of speed and height for the survey of the slope and
   * for the trajectories, of mass for the survey of the block and for the unit weight, of energy
   * for the risk; the last divides the energy of a barrier.
   */
  vtkSetMacro(SlopeSurveyFactor, double);
  vtkGetMacro(SlopeSurveyFactor, double);
  vtkSetMacro(TrajectoryFactor, double);
  vtkGetMacro(TrajectoryFactor, double);
  vtkSetMacro(BlockSurveyFactor, double);
  vtkGetMacro(BlockSurveyFactor, double);
  vtkSetMacro(UnitWeightFactor, double);
  vtkGetMacro(UnitWeightFactor, double);
  vtkSetMacro(RiskFactor, double);
  vtkGetMacro(RiskFactor, double);
  vtkSetMacro(BarrierFactor, double);
  vtkGetMacro(BarrierFactor, double);
  ///@}

  ///@{
  /**
   * Height of a barrier above the design height, m, not negative. Default 0.5.
   */
  vtkSetMacro(Freeboard, double);
  vtkGetMacro(Freeboard, double);
  ///@}

  ///@{
  /**
   * Mass of the design block in kg, not negative: the design energy is then that of its translation
   * at the speed of the level. 0 (the default): of the energies that were simulated.
   */
  vtkSetMacro(DesignMass, double);
  vtkGetMacro(DesignMass, double);
  ///@}

  vtkBarrierDesign(const vtkBarrierDesign&) = delete;
  void operator=(const vtkBarrierDesign&) = delete;

protected:
  vtkBarrierDesign();
  ~vtkBarrierDesign() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  double AnnualFrequency = 0.0;
  int FactorSet = TYPED;
  double SlopeSurveyFactor = 1.0;
  double TrajectoryFactor = 1.0;
  double BlockSurveyFactor = 1.0;
  double UnitWeightFactor = 1.0;
  double RiskFactor = 1.0;
  double BarrierFactor = 1.0;
  double Freeboard = 0.5;
  double DesignMass = 0.0;
};

#endif
