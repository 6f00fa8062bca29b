#include "vtkRockfallHazardMap.h"

#include "counts/hazardImage.h"
#include "results/drapedMap.h"
#include "results/trajectoriesInput.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/ranks.h"
#include "shared/withAbort.h"

#include "vtkAlgorithmOutput.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <string>

vtkStandardNewMacro(vtkRockfallHazardMap);

namespace
{

enum OutputPorts
{
  MAP = 0,
  DRAPED = 1
};

} // namespace

using Pipeline = vtkStreamingDemandDrivenPipeline;

/// The map, or why there is none, and of what it was made.
struct vtkRockfallHazardMap::Result
{
  vtkPolyData* trajectories = nullptr;
  vtkPolyData* terrain = nullptr;
  vtkMTimeType time = 0; ///< Of the latest change of the filter and its inputs.
  vtkNew<vtkImageData> image;
  vtkNew<vtkPolyData> draped;
  std::string error;
  bool aborted = false; ///< Nobody wanted it any more.
};

struct vtkRockfallHazardMap::Inputs
{
  rockfall::filters::Input trajectories{ rockfall::filters::InputKind::Trajectories };
  rockfall::filters::Input terrain{ rockfall::filters::InputKind::Terrain };

  const std::string& problem() const
  {
    return this->terrain.problem().empty() ? this->trajectories.problem() : this->terrain.problem();
  }
};

//------------------------------------------------------------------------------
vtkRockfallHazardMap::vtkRockfallHazardMap()
  : Taken(std::make_unique<Inputs>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

//------------------------------------------------------------------------------
vtkRockfallHazardMap::~vtkRockfallHazardMap() = default;

//------------------------------------------------------------------------------
int vtkRockfallHazardMap::FillInputPortInformation(int port, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkRockfallHazardMap::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == DRAPED ? "vtkPolyData" : "vtkImageData");
  return 1;
}

//------------------------------------------------------------------------------
void vtkRockfallHazardMap::Prepare(vtkInformationVector** inputVector)
{
  vtkPolyData* trajectories = this->Taken->trajectories.take(inputVector[0]);
  vtkPolyData* terrain = this->Taken->terrain.take(inputVector[1]);
  vtkMTimeType time = this->GetMTime();
  for (vtkPolyData* input : { trajectories, terrain })
  {
    time = std::max(time, input ? input->GetMTime() : 0);
  }
  if (this->Made && this->Made->trajectories == trajectories && this->Made->terrain == terrain &&
    this->Made->time == time)
  {
    return;
  }
  this->Made = std::make_unique<Result>();
  this->Made->trajectories = trajectories;
  this->Made->terrain = terrain;
  this->Made->time = time;
  if (!trajectories || trajectories->GetNumberOfLines() == 0)
  {
    return; // whether that is an error is for RequestData to say
  }
  try
  {
    const rockfall::filters::HeardAbort heard(this);
    rockfall::filters::HazardMapOptions options = this->MapOptions();
    options.cellSize = this->CellSize;
    options.crop = this->CropToTrajectories;
    options.rockWidth = this->RockWidth;
    rockfall::filters::makeHazardImage(trajectories, terrain, options, this->Made->image);
    rockfall::filters::drapeMap(this->Made->image, this->Made->draped);
  }
  catch (const rockfall::Aborted&)
  {
    this->Made->image->Initialize();
    this->Made->draped->Initialize();
    this->Made->aborted = true;
  }
  catch (...)
  {
    this->Made->image->Initialize();
    this->Made->draped->Initialize();
    this->Made->error =
      rockfall::filters::reasonOf("There is not enough memory for the map: give a larger CellSize, "
                                  "fewer Statistics, or switch CropToTrajectories on");
  }
}

//------------------------------------------------------------------------------
int vtkRockfallHazardMap::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  auto* controller = vtkMultiProcessController::GetGlobalController();
  for (int port = 0; port < 2; ++port)
  {
    if (this->GetNumberOfInputConnections(port) > 0)
    {
      vtkAlgorithmOutput* producer = this->GetInputConnection(port, 0);
      vtkNew<vtkInformation> request;
      request->Set(
        Pipeline::UPDATE_PIECE_NUMBER(), controller ? controller->GetLocalProcessId() : 0);
      request->Set(
        Pipeline::UPDATE_NUMBER_OF_PIECES(), controller ? controller->GetNumberOfProcesses() : 1);
      vtkNew<vtkInformationVector> requests;
      for (int of = 0; of <= producer->GetIndex(); ++of)
      {
        requests->Append(request);
      }
      producer->GetProducer()->Update(producer->GetIndex(), requests);
    }
  }
  // Every rank comes here, but one without a part of the image perhaps not to its data.
  this->Spread = rockfall::filters::spreadOf(this->Taken->trajectories.take(inputVector[0]));
  if (this->Spread.empty())
  {
    this->Prepare(inputVector);
  }
  else
  {
    this->Made = std::make_unique<Result>();
  }
  vtkInformation* info = outputVector->GetInformationObject(0);
  vtkImageData* image = this->Made->image;
  info->Set(Pipeline::WHOLE_EXTENT(), image->GetExtent(), 6);
  info->Set(vtkDataObject::ORIGIN(), image->GetOrigin(), 3);
  info->Set(vtkDataObject::SPACING(), image->GetSpacing(), 3);
  info->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkRockfallHazardMap::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector**, vtkInformationVector*)
{
  return 1; // the inputs are no images, and whole
}

//------------------------------------------------------------------------------
int vtkRockfallHazardMap::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* trajectories = this->Taken->trajectories.take(inputVector[0]);
  vtkPolyData* terrain = this->Taken->terrain.take(inputVector[1]);
  if (!trajectories)
  {
    return rockfall::filters::fail(this, "The Input is missing");
  }
  if (!this->Spread.empty())
  {
    return rockfall::filters::failTogether(this, this->Spread);
  }
  if (rockfall::filters::inheritFailure(trajectories, this) ||
    (terrain && rockfall::filters::inheritFailure(terrain, this)))
  {
    return 1;
  }
  if (!this->Taken->problem().empty())
  {
    return rockfall::filters::fail(this, this->Taken->problem());
  }
  if (rockfall::filters::noneYet(trajectories, outputVector))
  {
    rockfall::filters::markEmptyMap(vtkImageData::GetData(outputVector, MAP));
    return 1;
  }
  if (trajectories->GetNumberOfLines() == 0)
  {
    return rockfall::filters::fail(
      this, "The Input has no lines; the trajectories of Rockfall Simulation are wanted");
  }
  this->Prepare(inputVector);
  if (this->Made->aborted)
  {
    this->Made = std::make_unique<Result>();
    this->Modified(); // the extent as well is to be found anew
    return rockfall::filters::giveUp(this);
  }
  if (!this->Made->error.empty())
  {
    return rockfall::filters::fail(this, this->Made->error);
  }
  vtkImageData::GetData(outputVector, MAP)->ShallowCopy(this->Made->image);
  vtkPolyData::GetData(outputVector, DRAPED)->ShallowCopy(this->Made->draped);
  return 1;
}

//------------------------------------------------------------------------------
void vtkRockfallHazardMap::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CellSize: " << this->CellSize << "\n";
  os << indent << "CropToTrajectories: " << this->CropToTrajectories << "\n";
  os << indent << "RockWidth: " << this->RockWidth << "\n";
}
