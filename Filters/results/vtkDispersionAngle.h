/**
 * @class   vtkDispersionAngle
 * @brief   measures how far trajectories spread: the dispersion angle θ = arctan(W / 2L)
 *
 * The input has one polyline per trajectory, as port 1 of vtkRockfallSimulation. W is the
 * dispersion width, the difference of the extreme lateral deviations from the cross-section, and L
 * the falling length along it.
 *
 * Output port 0 is a table with one row per group: Group, Trajectories, L, W (m), Theta (degrees),
 * LateralMin, LateralMax, LateralDeviation (m; the standard deviation of where the trajectories
 * end), Azimuth (degrees, clockwise from north), and RunOutMean, RunOutDeviation, RunOut50,
 * RunOut90, RunOut95, RunOut99 and RunOutMaximum (m), the run-out being the horizontal distance
 * from the start to the end of a trajectory. Output port 1 shows the same as lines, a wedge per
 * group: from the mean start to both ends of the dispersion width and to its middle, and across;
 * cell arrays Group (the row) and Theta.
 */
#ifndef vtkDispersionAngle_h
#define vtkDispersionAngle_h

#include "RockfallFiltersModule.h"
#include "listProperty.h"
#include "vtkTableAlgorithm.h"

#include <string> // for GroupBy
#include <vector> // for ClassLimits

class ROCKFALLFILTERS_EXPORT vtkDispersionAngle : public vtkTableAlgorithm
{
public:
  static vtkDispersionAngle* New();
  vtkTypeMacro(vtkDispersionAngle, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the cross-section runs along the mean horizontal direction from the starts to the ends
   * of all trajectories (the default) instead of Direction.
   */
  vtkSetMacro(AutomaticDirection, bool);
  vtkGetMacro(AutomaticDirection, bool);
  vtkBooleanMacro(AutomaticDirection, bool);
  ///@}

  ///@{
  /**
   * Direction of the cross-section; its z does not count. Not zero. Default 1, 0, 0.
   */
  vtkSetVector3Macro(Direction, double);
  vtkGetVector3Macro(Direction, double);
  ///@}

  ///@{
  /**
   * Falling length L along the cross-section in metres, not negative; trajectories are cut there.
   * 0 (the default): as far as any trajectory of the group got.
   */
  vtkSetMacro(Length, double);
  vtkGetMacro(Length, double);
  ///@}

  ///@{
  /**
   * Name of the cell array whose values make the groups. Empty: all trajectories are one group.
   * Default "Shape".
   */
  vtkSetStdStringFromCharMacro(GroupBy);
  vtkGetCharFromStdStringMacro(GroupBy);
  ///@}

  ///@{
  /**
   * Limits of classes of the array's numbers, ascending: groups are the classes then, such as
   * "below 0.5", "0.5 to 1" and "1 and above". None by default: every value is a group.
   */
  rockfallListPropertyMacro(ClassLimits, double, AddClassLimit, ClearClassLimits);
  ///@}

  ///@{
  /**
   * Whether there are groups (the default), or all trajectories are taken together as with an empty
   * GroupBy.
   */
  vtkSetMacro(UseGroups, bool);
  vtkGetMacro(UseGroups, bool);
  vtkBooleanMacro(UseGroups, bool);
  ///@}

  ///@{
  /**
   * Whether lateral deviations are measured from each trajectory's own start (the default) or from
   * the mean start of the group.
   */
  vtkSetMacro(RelativeToStart, bool);
  vtkGetMacro(RelativeToStart, bool);
  vtkBooleanMacro(RelativeToStart, bool);
  ///@}

  vtkDispersionAngle(const vtkDispersionAngle&) = delete;
  void operator=(const vtkDispersionAngle&) = delete;

protected:
  vtkDispersionAngle();
  ~vtkDispersionAngle() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  std::vector<std::string> IdleNotes() const; ///< On properties that have no effect.

  bool AutomaticDirection = true;
  double Direction[3] = { 1.0, 0.0, 0.0 };
  double Length = 0.0;
  std::string GroupBy = "Shape";
  std::vector<double> ClassLimits;
  bool UseGroups = true;
  bool RelativeToStart = true;
};

#endif
