#include "shared/inputs.h"

#include "base/errors.h"

#include "vtkAlgorithm.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace rockfall::filters
{

void acceptPolyData(vtkInformation* port)
{
  port->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  port->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  port->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
}

vtkMTimeType timeOf(vtkDataObject* data)
{
  vtkMTimeType time = data->GetMTime();
  if (auto* parts = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto part = vtk::TakeSmartPointer(parts->NewIterator());
    for (part->InitTraversal(); !part->IsDoneWithTraversal(); part->GoToNextItem())
    {
      time = std::max(time, part->GetCurrentDataObject()->GetMTime());
    }
  }
  return time;
}

std::string Input::name() const
{
  switch (kind_)
  {
    case InputKind::Terrain:
      return "The Terrain input";
    case InputKind::Rocks:
      return "The Rocks input";
    case InputKind::Lines:
      return "The Lines input";
    case InputKind::Shape:
      return kShapeInput;
    case InputKind::Trajectories:
    case InputKind::Crossings:
    case InputKind::Any:
      break;
  }
  return number_ > 0 ? "The Input's part " + std::to_string(number_) : "The Input";
}

vtkPolyData* Input::take(vtkInformationVector* connections, int connection)
{
  return this->take(vtkDataObject::GetData(connections, connection));
}

vtkPolyData* Input::take(vtkDataObject* data)
{
  const vtkMTimeType time = data ? timeOf(data) : 0;
  if (data && data == data_ && time == time_)
  {
    return made_ ? made_.Get() : vtkPolyData::SafeDownCast(data);
  }
  data_ = data;
  time_ = time;
  made_ = nullptr;
  problem_.clear();
  if (!data)
  {
    return nullptr;
  }
  try
  {
    const vtkSmartPointer<vtkPolyData> one = onePolyData(data, kind_, this->name());
    if (!one->GetFieldData()->GetAbstractArray("Error"))
    {
      checkPolyData(one, kind_, this->name());
    }
    if (one == data)
    {
      return one; // its owner keeps it
    }
    made_ = one;
  }
  catch (const Error& error)
  {
    problem_ = error.what();
    made_ = vtkSmartPointer<vtkPolyData>::New();
  }
  return made_;
}

void requireFew(std::size_t values, const char* property)
{
  constexpr std::size_t most = 100;
  if (values > most)
  {
    throw ParameterError(std::string(property) + " has " + std::to_string(values) +
      " values, it may have " + std::to_string(most));
  }
}

std::vector<std::array<double, 3>> drawnPoints(const std::vector<double>& coordinates)
{
  if (coordinates.size() % 3 != 0)
  {
    throw ParameterError("Points has " + std::to_string(coordinates.size()) +
      " numbers, each point needs three: x, y, z");
  }
  std::vector<std::array<double, 3>> points;
  for (std::size_t k = 0; k < coordinates.size(); k += 3)
  {
    points.push_back({ coordinates[k], coordinates[k + 1], coordinates[k + 2] });
  }
  return points;
}

void Input::require() const
{
  if (!problem_.empty())
  {
    throw DataError(problem_);
  }
}

} // namespace rockfall::filters
