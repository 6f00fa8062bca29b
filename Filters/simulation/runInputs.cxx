#include "simulation/runInputs.h"

#include "base/text/numberText.h"
#include "shared/errorReport.h"
#include "shared/ranks.h"

#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall::filters
{

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

/// The time of the data that came last from here or, before any did, from where it gets them; NaN
/// if nothing has come yet.
double timeShown(vtkAlgorithmOutput* from)
{
  while (from)
  {
    vtkAlgorithm* producer = from->GetProducer();
    vtkInformation* info = producer->GetOutputInformation(from->GetIndex());
    vtkDataObject* data = info ? info->Get(vtkDataObject::DATA_OBJECT()) : nullptr;
    if (data && data->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()))
    {
      return data->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
    }
    const bool more =
      producer->GetNumberOfInputPorts() > 0 && producer->GetNumberOfInputConnections(0) > 0;
    from = more ? producer->GetInputConnection(0, 0) : nullptr;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

} // namespace

double RunInputs::timeOfRocks(
  vtkAlgorithmOutput* from, vtkInformation* info, vtkInformationVector* outputs)
{
  if (rocksFrom == from)
  {
    return rocksShown;
  }
  rocksFrom = from;
  double time = timeShown(from);
  for (int port = 0; std::isnan(time) && port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* asked = outputs->GetInformationObject(port);
    if (asked->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      time = asked->Get(Pipeline::UPDATE_TIME_STEP());
    }
  }
  const double* range = info->Get(Pipeline::TIME_RANGE());
  rocksShown =
    std::isnan(time) ? range[0] : std::clamp(time, range[0], std::max(range[0], range[1]));
  if (rocksShown > range[0] && Ranks().rank() == 0)
  {
    showNote("Rockfall Simulation: the Rocks move, and are taken as they are "
             "shown, at " +
      numberText(rocksShown) + " s; Force Time before them sets another time");
  }
  return rocksShown;
}

} // namespace rockfall::filters
