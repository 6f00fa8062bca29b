#include "vtkHazardPassageWriter.h"

#include "base/errors.h"
#include "counts/hazardImage.h"
#include "shared/inputs.h"
#include "shared/ranks.h"
#include "shared/streamingPieces.h"
#include "shared/withAbort.h"

#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkHazardPassageWriter);

//------------------------------------------------------------------------------
vtkHazardPassageWriter::vtkHazardPassageWriter()
{
  this->SetNumberOfInputPorts(2);
}

//------------------------------------------------------------------------------
vtkHazardPassageWriter::~vtkHazardPassageWriter() = default;

//------------------------------------------------------------------------------
int vtkHazardPassageWriter::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkHazardPassageWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  rockfall::filters::requestOwnPieces(request, inputs, 2);
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

//------------------------------------------------------------------------------
void vtkHazardPassageWriter::WriteData()
{
  rockfall::filters::Input taken(rockfall::filters::InputKind::Trajectories);
  rockfall::filters::Input takenTerrain(rockfall::filters::InputKind::Terrain);
  vtkPolyData* trajectories = taken.take(this->GetInputDataObject(0, 0));
  vtkPolyData* terrain = takenTerrain.take(this->GetInputDataObject(1, 0));
  const std::string spread = rockfall::filters::spreadOf(trajectories);
  if (!spread.empty())
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    if (!rockfall::filters::isFurtherRank())
    {
      vtkErrorMacro(<< spread);
    }
    return;
  }
  if (!trajectories || !terrain ||
    (trajectories->GetNumberOfLines() == 0 && taken.problem().empty() &&
      rockfall::filters::isFurtherRank()))
  {
    return; // the first rank has it all
  }
  for (vtkPolyData* input : { trajectories, terrain })
  {
    if (input->GetFieldData()->GetAbstractArray("Error"))
    {
      this->SetErrorCode(vtkErrorCode::UserError);
      return; // has been said
    }
  }
  try
  {
    taken.require();
    takenTerrain.require();
    rockfall::filters::writeHazardPassages(
      trajectories, terrain, { this->CellSize, false, this->RockWidth, {} }, this->FileName);
  }
  catch (...)
  {
    this->SetErrorCode(vtkErrorCode::FileFormatError);
    vtkErrorMacro(<< rockfall::filters::reasonOf(
                    this->FileName + ": there is not enough memory to write it"));
  }
}

//------------------------------------------------------------------------------
void vtkHazardPassageWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "CellSize: " << this->CellSize << "\n";
  os << indent << "RockWidth: " << this->RockWidth << "\n";
}
