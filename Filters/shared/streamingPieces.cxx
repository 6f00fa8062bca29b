#include "shared/streamingPieces.h"

#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkStreamingDemandDrivenPipeline.h"

namespace rockfall::filters
{

bool isFurtherPiece(vtkInformationVector* outputs)
{
  // A request comes through one port; the others may not know of the piece.
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    vtkInformationIntegerKey* piece = vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER();
    if (info->Has(piece) && info->Get(piece) > 0)
    {
      return true;
    }
  }
  return false;
}

bool isFurtherRank()
{
  auto* controller = vtkMultiProcessController::GetGlobalController();
  return controller && controller->GetLocalProcessId() > 0;
}

void requestOwnPiece(vtkInformation* input)
{
  if (auto* controller = vtkMultiProcessController::GetGlobalController())
  {
    input->Set(
      vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER(), controller->GetLocalProcessId());
    input->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(),
      controller->GetNumberOfProcesses());
  }
}

} // namespace rockfall::filters
