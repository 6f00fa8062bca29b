#include "results/trajectoriesInput.h"

#include "base/errors.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/ranks.h"
#include "shared/rockPaths.h"
#include "shared/streamingPieces.h"
#include "shared/withAbort.h"

#include "vtkInformationVector.h"
#include "vtkPolyData.h"

namespace rockfall::filters
{

bool noneYet(vtkPolyData* trajectories, vtkInformationVector* outputs)
{
  return trajectories->GetNumberOfLines() == 0 &&
    (isFurtherPiece(outputs) || isRunning(trajectories->GetFieldData()));
}

int attemptTrajectories(vtkAlgorithm* algorithm, vtkInformationVector* connections,
  vtkInformationVector* outputs, const std::string& noMemory,
  const std::function<int(vtkPolyData*)>& work)
{
  return withAbort(algorithm, noMemory,
    [&]
    {
      Input taken(InputKind::Trajectories);
      vtkPolyData* trajectories = taken.take(connections);
      const std::string spread = spreadOf(trajectories); // every rank asks, whatever it has
      if (!spread.empty())
      {
        return failTogether(algorithm, spread);
      }
      if (!trajectories)
      {
        throw DataError("The Input is missing");
      }
      taken.require();
      if (inheritFailure(trajectories, algorithm) || noneYet(trajectories, outputs))
      {
        return 1;
      }
      return work(trajectories);
    });
}

} // namespace rockfall::filters
