/**
 * @class   vtkTrajectoryProfile
 * @brief   speed, energy and height of one trajectory along its way, for a chart
 *
 * The input has one polyline per trajectory, as port 1 of vtkRockfallSimulation. Output port 0 is
 * a table with a row for each point of one of them: Time (s), Distance (m, horizontal, along the
 * way), Elevation (m), Speed (m/s), EnergyInKilojoules (kJ) and HeightOverGround (m). Field arrays
 * BlockId, RockId and Iteration tell which rock it is. Output port 1 is its
 * path, a polyline, to mark it among the others.
 */
#ifndef vtkTrajectoryProfile_h
#define vtkTrajectoryProfile_h

#include "RockfallFiltersModule.h"
#include "vtkTableAlgorithm.h"

class ROCKFALLFILTERS_EXPORT vtkTrajectoryProfile : public vtkTableAlgorithm
{
public:
  static vtkTrajectoryProfile* New();
  vtkTypeMacro(vtkTrajectoryProfile, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Number of the trajectory in the input, from 0. Default 0.
   */
  vtkSetMacro(Trajectory, int);
  vtkGetMacro(Trajectory, int);
  ///@}

  vtkTrajectoryProfile(const vtkTrajectoryProfile&) = delete;
  void operator=(const vtkTrajectoryProfile&) = delete;

protected:
  vtkTrajectoryProfile();
  ~vtkTrajectoryProfile() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  int Trajectory = 0;
};

#endif
