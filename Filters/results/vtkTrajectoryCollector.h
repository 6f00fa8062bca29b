/**
 * @class   vtkTrajectoryCollector
 * @brief   collects what passes lines, such as a road or a planned barrier
 *
 * Input port 0 has one polyline per trajectory, as port 1 of vtkRockfallSimulation; port 1 has
 * lines as polydata, optional, further lines come from Points and FileName; port 2 is the terrain
 * of vtkDEMToCFESource, optional: trajectories bring the slope that they fell on. Without any line
 * there is one across the middle of the trajectories. A line stands for the vertical planes through
 * its segments. A passing is found exactly, along the cubic curve between two points of a
 * trajectory.
 *
 * Output port 0 has a vertex for every passing, with what the rock does there and the cell arrays
 * of its trajectory. Port 1 is a table with a row for each line: how many rocks passed, mean,
 * deviation, maximum and quantiles of their energy, height over ground and speed, and the share
 * that a barrier of BarrierHeight and BarrierCapacity would catch. Port 2 is a table of exceedance
 * curves. Port 3 has the walls that stand on the lines, as high as their barriers.
 */
#ifndef vtkTrajectoryCollector_h
#define vtkTrajectoryCollector_h

#include "RockfallFiltersModule.h"
#include "listProperty.h"
#include "vtkPolyDataAlgorithm.h"

#include <string> // for FileName
#include <vector> // for points

class ROCKFALLFILTERS_EXPORT vtkTrajectoryCollector : public vtkPolyDataAlgorithm
{
public:
  static vtkTrajectoryCollector* New();
  vtkTypeMacro(vtkTrajectoryCollector, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Name of the layer of a file with several. Empty (the default): the one layer of lines; if
   * there are several, that is an error which lists them.
   */
  vtkSetStdStringFromCharMacro(LayerName);
  vtkGetCharFromStdStringMacro(LayerName);
  ///@}

  ///@{
  /**
   * File of lines: anything OGR opens. Brought to the CRS of the trajectories. Empty by default.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether files may name network addresses and other files of the machine: virtual rasters and
   * layers that are made of files elsewhere, services, lists of tiles. Off by default, because a
   * file that came from somebody else could have any file read, or an address called. Virtual
   * rasters of files beside them need no leave.
   */
  vtkSetMacro(AllowReferences, int);
  vtkGetMacro(AllowReferences, int);
  vtkBooleanMacro(AllowReferences, int);
  ///@}

  ///@{
  /**
   * Whether notes on lines are told; the outputs' field array Notes has them in any case. Default
   * on.
   */
  vtkSetMacro(PrintNotes, bool);
  vtkGetMacro(PrintNotes, bool);
  vtkBooleanMacro(PrintNotes, bool);
  ///@}

  ///@{
  /**
   * Points of a line that is drawn, in world coordinates; their z does not count. None by default.
   */
  void AddPoint(double x, double y, double z)
  {
    this->Points.insert(this->Points.end(), { x, y, z });
    this->Modified();
  }
  /// Numbers one by one, three of them a point: a list whose length is no multiple of three is an
  /// error of the run.
  rockfallListPropertyMacro(Points, double, AddCoordinate, ClearPoints);
  ///@}

  /**
   * Ends of the line that the last run took because none was given, on the ground.
   */
  vtkGetVector6Macro(PlacedLine, double);

  ///@{
  /**
   * Height of a barrier in metres, not negative. Lines of the file that have a number in the column
   * "height" have their own. Default 4.
   */
  vtkSetMacro(BarrierHeight, double);
  vtkGetMacro(BarrierHeight, double);
  ///@}

  ///@{
  /**
   * Energy that a barrier can take, in kJ, not negative. Lines of the file that have a number in
   * the column "capacity" have their own. Default 1000.
   */
  vtkSetMacro(BarrierCapacity, double);
  vtkGetMacro(BarrierCapacity, double);
  ///@}

  ///@{
  /**
   * How many parallels each line has, 0 (the default) to 1000 lines in all, and how far they are
   * apart in metres: to the left of the line if that is positive, else to its right. Default 10.
   */
  vtkSetMacro(ParallelLines, int);
  vtkGetMacro(ParallelLines, int);
  vtkSetMacro(ParallelSpacing, double);
  vtkGetMacro(ParallelSpacing, double);
  ///@}

  vtkTrajectoryCollector(const vtkTrajectoryCollector&) = delete;
  void operator=(const vtkTrajectoryCollector&) = delete;

protected:
  vtkTrajectoryCollector();
  ~vtkTrajectoryCollector() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  /// Notes on properties that have no effect. Whether a line has the height and the capacity.
  std::vector<std::string> IdleNotes(bool height, bool capacity) const;

  std::string FileName;
  int AllowReferences = 0;
  bool PrintNotes = true;
  std::string LayerName;
  std::vector<double> Points; ///< x, y, z of each in turn.
  double PlacedLine[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double BarrierHeight = 4.0;
  double BarrierCapacity = 1000.0;
  int ParallelLines = 0;
  double ParallelSpacing = 10.0;
};

#endif
