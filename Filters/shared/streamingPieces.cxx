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

void requestOwnPieces(vtkInformation* request, vtkInformationVector** inputs, int ports)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  auto* controller = vtkMultiProcessController::GetGlobalController();
  const bool asks = controller && request->Has(Pipeline::REQUEST_UPDATE_EXTENT());
  for (int port = 0; asks && port < ports; ++port)
  {
    if (vtkInformation* input = inputs[port]->GetInformationObject(0))
    {
      input->Set(Pipeline::UPDATE_PIECE_NUMBER(), controller->GetLocalProcessId());
      input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), controller->GetNumberOfProcesses());
    }
  }
}

} // namespace rockfall::filters
