/**
 * @class   vtkGrowingPaths
 * @brief   trajectories as far as they have come at the time of the animation
 *
 * The input has one polyline per trajectory with a point array Time (s), as port 1 of
 * vtkRockfallSimulation. The output has the same lines in the same order, each up to the requested
 * time: its points until then and a last one between two of them, with all point arrays in
 * proportion. A line that has not begun is two points at its start. Without a requested time the
 * lines are whole. Cell and field arrays go along.
 */
#ifndef vtkGrowingPaths_h
#define vtkGrowingPaths_h

#include "RockfallFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

class ROCKFALLFILTERS_EXPORT vtkGrowingPaths : public vtkPolyDataAlgorithm
{
public:
  static vtkGrowingPaths* New();
  vtkTypeMacro(vtkGrowingPaths, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkGrowingPaths(const vtkGrowingPaths&) = delete;
  void operator=(const vtkGrowingPaths&) = delete;

protected:
  vtkGrowingPaths();
  ~vtkGrowingPaths() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
