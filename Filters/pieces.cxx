#include "pieces.h"

#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
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

} // namespace rockfall::filters
