#include "shared/ranks.h"

#include "base/abort.h"
#include "base/errors.h"
#include "shared/withAbort.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <functional>

#include <sched.h>
#include <unistd.h>

namespace rockfall::filters
{

namespace
{

/// MPI counts in int, so what is larger goes in slices, bytes.
constexpr std::size_t slice = std::size_t(1) << 28;
constexpr int sizeTag = 7301, bytesTag = 7302;

enum ArrayKind
{
  NONE = 0,
  NUMBERS = 1,
  TEXTS = 2
};

} // namespace

Ranks::Ranks()
  : Ranks(vtkMultiProcessController::GetGlobalController())
{
}

Ranks::Ranks(vtkMultiProcessController* controller)
  : controller_(controller)
{
  if (controller_)
  {
    count_ = controller_->GetNumberOfProcesses();
    rank_ = controller_->GetLocalProcessId();
  }
}

std::vector<int> Ranks::gather(int value) const
{
  std::vector<int> all(std::size_t(count_), value);
  if (count_ > 1)
  {
    controller_->AllGather(&value, all.data(), 1);
  }
  return all;
}

std::vector<double> Ranks::gather(double value) const
{
  std::vector<double> all(std::size_t(count_), value);
  if (count_ > 1)
  {
    controller_->AllGather(&value, all.data(), 1);
  }
  return all;
}

int Ranks::threads() const
{
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  const int own = sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const int machine = int(std::hash<std::string>()(host) & 0x7fffffff);
  const std::vector<int> machines = this->gather(machine);
  const int here = int(std::count(machines.begin(), machines.end(), machine));
  const bool bound = own < int(sysconf(_SC_NPROCESSORS_ONLN));
  return std::max(1, bound ? own : own / here);
}

void Ranks::settle(State own, const std::string& problem) const
{
  const std::vector<int> states = this->gather(int(own));
  const auto has = [&](State state) { return std::find(states.begin(), states.end(), int(state)); };
  if (has(State::GivenUp) != states.end())
  {
    throw Aborted();
  }
  if (const auto first = has(State::Failed); first != states.end())
  {
    std::string text = problem;
    this->broadcastText(text, int(first - states.begin()));
    throw Error(text);
  }
}

void Ranks::together(const std::function<void()>& work, const std::string& noMemory) const
{
  std::string problem;
  State state = State::Well;
  try
  {
    work();
  }
  catch (const Aborted&)
  {
    state = State::GivenUp;
  }
  catch (...)
  {
    problem = reasonOf(noMemory);
    state = State::Failed;
  }
  this->settle(state, problem);
}

void Ranks::broadcastBytes(void* bytes, std::size_t count, int root) const
{
  for (std::size_t at = 0; at < count; at += slice)
  {
    controller_->Broadcast(
      static_cast<char*>(bytes) + at, vtkIdType(std::min(slice, count - at)), root);
  }
}

void Ranks::broadcastText(std::string& text, int root) const
{
  if (count_ == 1)
  {
    return;
  }
  vtkTypeInt64 length = vtkTypeInt64(text.size());
  this->broadcastBytes(&length, sizeof length, root);
  text.resize(std::size_t(length));
  this->broadcastBytes(text.data(), text.size(), root);
}

vtkSmartPointer<vtkAbstractArray> Ranks::broadcast(vtkAbstractArray* array, int root) const
{
  auto* texts = vtkStringArray::SafeDownCast(array);
  auto* numbers = vtkDataArray::SafeDownCast(array);
  vtkTypeInt64 head[4] = { numbers ? NUMBERS : (texts ? TEXTS : NONE),
    array ? array->GetDataType() : 0, array ? array->GetNumberOfComponents() : 0,
    array ? array->GetNumberOfTuples() : 0 };
  this->broadcastBytes(head, sizeof head, root);
  if (head[0] == NONE)
  {
    return nullptr;
  }
  std::string name = array && array->GetName() ? array->GetName() : "";
  this->broadcastText(name, root);
  vtkSmartPointer<vtkAbstractArray> result = array;
  if (rank_ != root)
  {
    result = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(int(head[1])));
    result->SetNumberOfComponents(int(head[2]));
    result->SetNumberOfTuples(head[3]);
    result->SetName(name.empty() ? nullptr : name.c_str());
  }
  if (head[0] == NUMBERS)
  {
    this->broadcastBytes(result->GetVoidPointer(0),
      std::size_t(result->GetNumberOfValues()) * std::size_t(result->GetDataTypeSize()), root);
    return result;
  }
  auto* strings = vtkStringArray::SafeDownCast(result);
  // All at once: there may be one for each face of many rocks.
  const vtkIdType count = strings->GetNumberOfValues();
  std::vector<vtkTypeInt64> sizes(static_cast<std::size_t>(count));
  std::string all;
  for (vtkIdType k = 0; k < count && rank_ == root; ++k)
  {
    all += strings->GetValue(k);
    sizes[std::size_t(k)] = vtkTypeInt64(strings->GetValue(k).size());
  }
  this->broadcastBytes(sizes.data(), sizes.size() * sizeof(vtkTypeInt64), root);
  this->broadcastText(all, root);
  std::size_t start = 0;
  for (vtkIdType k = 0; k < count && rank_ != root; ++k)
  {
    const std::size_t size = std::size_t(sizes[std::size_t(k)]);
    strings->SetValue(k, all.substr(start, size));
    start += size;
  }
  return result;
}

void Ranks::broadcast(vtkFieldData* data, int root) const
{
  vtkTypeInt64 arrays = data->GetNumberOfArrays();
  this->broadcastBytes(&arrays, sizeof arrays, root);
  if (rank_ != root)
  {
    data->Initialize();
  }
  for (int k = 0; k < int(arrays); ++k)
  {
    const auto array = this->broadcast(rank_ == root ? data->GetAbstractArray(k) : nullptr, root);
    if (rank_ != root && array)
    {
      data->AddArray(array);
    }
  }
}

void Ranks::broadcast(vtkPolyData* data, int root) const
{
  if (count_ == 1)
  {
    return;
  }
  const bool has = rank_ == root;
  const auto points =
    this->broadcast(has && data->GetPoints() ? data->GetPoints()->GetData() : nullptr, root);
  if (!has && points)
  {
    vtkNew<vtkPoints> made;
    made->SetData(vtkDataArray::SafeDownCast(points));
    data->SetPoints(made);
  }
  using Getter = vtkCellArray* (vtkPolyData::*)();
  using Setter = void (vtkPolyData::*)(vtkCellArray*);
  const std::pair<Getter, Setter> kinds[] = { { &vtkPolyData::GetVerts, &vtkPolyData::SetVerts },
    { &vtkPolyData::GetLines, &vtkPolyData::SetLines },
    { &vtkPolyData::GetPolys, &vtkPolyData::SetPolys },
    { &vtkPolyData::GetStrips, &vtkPolyData::SetStrips } };
  for (const auto& [get, set] : kinds)
  {
    vtkCellArray* cells = has ? (data->*get)() : nullptr;
    const auto offsets = this->broadcast(cells ? cells->GetOffsetsArray() : nullptr, root);
    const auto ends = this->broadcast(cells ? cells->GetConnectivityArray() : nullptr, root);
    if (!has && offsets && ends)
    {
      vtkNew<vtkCellArray> made;
      made->SetData(vtkDataArray::SafeDownCast(offsets), vtkDataArray::SafeDownCast(ends));
      (data->*set)(made);
    }
  }
  for (vtkFieldData* fields : { static_cast<vtkFieldData*>(data->GetPointData()),
         static_cast<vtkFieldData*>(data->GetCellData()), data->GetFieldData() })
  {
    this->broadcast(fields, root);
  }
}

std::vector<std::vector<char>> Ranks::collect(
  std::vector<char>&& bytes, const std::string& noMemory) const
{
  std::vector<std::vector<char>> all;
  if (count_ == 1)
  {
    all.push_back(std::move(bytes));
    return all;
  }
  const vtkTypeInt64 size = vtkTypeInt64(bytes.size());
  if (rank_ == 0)
  {
    all.resize(std::size_t(count_));
    all[0] = std::move(bytes);
    std::vector<vtkTypeInt64> sizes(std::size_t(count_), 0);
    for (int from = 1; from < count_; ++from)
    {
      controller_->Receive(&sizes[std::size_t(from)], 1, from, sizeTag);
    }
    // Nothing is on its way before there is room for all of it.
    this->together(
      [&]
      {
        for (int from = 1; from < count_; ++from)
        {
          all[std::size_t(from)].resize(std::size_t(sizes[std::size_t(from)]));
        }
      },
      noMemory);
    for (int from = 1; from < count_; ++from)
    {
      std::vector<char>& part = all[std::size_t(from)];
      for (std::size_t at = 0; at < part.size(); at += slice)
      {
        controller_->Receive(
          part.data() + at, vtkIdType(std::min(slice, part.size() - at)), from, bytesTag);
      }
    }
    return all;
  }
  controller_->Send(&size, 1, 0, sizeTag);
  this->together([] {}, noMemory);
  for (std::size_t at = 0; at < bytes.size(); at += slice)
  {
    controller_->Send(
      bytes.data() + at, vtkIdType(std::min(slice, bytes.size() - at)), 0, bytesTag);
  }
  return all;
}

std::string spreadOf(vtkPolyData* trajectories)
{
  const std::vector<int> has =
    Ranks().gather(trajectories && trajectories->GetNumberOfLines() > 0 ? 1 : 0);
  const auto count = std::count(has.begin(), has.end(), 1);
  return count > 1 ? "The Input is spread over " + std::to_string(count) +
      " ranks, it must be on one: take the trajectories as Rockfall Simulation makes them, or open "
      "their file without MPI"
                   : std::string();
}

} // namespace rockfall::filters
