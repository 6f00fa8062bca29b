/**
 * @class   vtkMergeCollectors
 * @brief   makes one collector of those of several runs
 *
 * The input takes any number of crossings, port 0 of vtkTrajectoryCollector, each of the same lines
 * and of other rocks or iterations. The three outputs are those of one collector of all the
 * trajectories, bit for bit, with the crossings in the order of iteration, rock and line.
 */
#ifndef vtkMergeCollectors_h
#define vtkMergeCollectors_h

#include "RockfallFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

class ROCKFALLFILTERS_EXPORT vtkMergeCollectors : public vtkPolyDataAlgorithm
{
public:
  static vtkMergeCollectors* New();
  vtkTypeMacro(vtkMergeCollectors, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkMergeCollectors(const vtkMergeCollectors&) = delete;
  void operator=(const vtkMergeCollectors&) = delete;

protected:
  vtkMergeCollectors();
  ~vtkMergeCollectors() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
