#include "vtkHazardPassageReader.h"

#include "counts/hazardImage.h"
#include "shared/errorReport.h"
#include "shared/streamingPieces.h"
#include "shared/withAbort.h"
#include "statistics/passageFile.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

vtkStandardNewMacro(vtkHazardPassageReader);

//------------------------------------------------------------------------------
vtkHazardPassageReader::vtkHazardPassageReader()
{
  this->SetNumberOfInputPorts(0);
}

//------------------------------------------------------------------------------
vtkHazardPassageReader::~vtkHazardPassageReader() = default;

//------------------------------------------------------------------------------
void vtkHazardPassageReader::AddFileName(const char* fileName)
{
  if (fileName && *fileName)
  {
    this->FileNames.emplace_back(fileName);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkHazardPassageReader::RemoveAllFileNames()
{
  if (!this->FileNames.empty())
  {
    this->FileNames.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkHazardPassageReader::CanReadFile(const char* fileName)
{
  try
  {
    rockfall::readPassageFile(fileName);
    return 1;
  }
  catch (...)
  {
    return 0;
  }
}

//------------------------------------------------------------------------------
int vtkHazardPassageReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  double origin[3] = { 0.0, 0.0, 0.0 }, spacing[3] = { 1.0, 1.0, 1.0 };
  try
  {
    if (!this->FileNames.empty() && !rockfall::filters::isFurtherRank())
    {
      const rockfall::CellGrid grid = rockfall::readPassageFile(this->FileNames.front()).grid;
      extent[1] = grid.columns;
      extent[3] = grid.rows;
      extent[5] = 0;
      origin[0] = grid.west;
      origin[1] = grid.south;
      spacing[0] = spacing[1] = spacing[2] = grid.cellSize;
    }
  }
  catch (...)
  {
    // RequestData says so, once.
  }
  vtkInformation* info = outputVector->GetInformationObject(0);
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  info->Set(vtkDataObject::ORIGIN(), origin, 3);
  info->Set(vtkDataObject::SPACING(), spacing, 3);
  info->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkHazardPassageReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkImageData* image = vtkImageData::GetData(outputVector, 0);
  if (rockfall::filters::isFurtherPiece(outputVector))
  {
    image->Initialize();
    rockfall::filters::markEmptyMap(image);
    return 1;
  }
  return rockfall::filters::withAbort(this,
    "There is not enough memory for the map: choose fewer Statistics",
    [&]
    {
      rockfall::filters::makeHazardImage(
        rockfall::PassageFiles(this->FileNames), this->MapOptions(), image);
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkHazardPassageReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileNames:";
  for (const std::string& name : this->FileNames)
  {
    os << " " << name;
  }
  os << "\n";
}
