#include "vtkDispersionAngle.h"

#include "base/errors.h"
#include "counts/lostRocks.h"
#include "results/collectorOutputs.h"
#include "results/pathGroups.h"
#include "results/trajectoriesInput.h"
#include "shared/arrays.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/terrainFieldData.h"
#include "statistics/dispersion.h"
#include "statistics/sample.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

vtkStandardNewMacro(vtkDispersionAngle);

namespace
{

using rockfall::Vec3;
using Paths = std::vector<std::vector<Vec3>>;

double meanEndHeight(const Paths& paths)
{
  double sum = 0.0;
  int count = 0;
  for (const std::vector<Vec3>& path : paths)
  {
    if (!path.empty())
    {
      sum += path.back().z();
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

/// Four lines from the apex and across: what W and L were measured on.
class Wedges
{
public:
  explicit Wedges(vtkPolyData* output)
    : Group(rockfall::filters::addArray<vtkIntArray>(output->GetCellData(), "Group"))
    , Theta(rockfall::filters::addArray<vtkDoubleArray>(output->GetCellData(), "Theta"))
  {
    this->Points->SetDataTypeToDouble();
    output->SetPoints(this->Points);
    output->SetLines(this->Lines);
  }

  void Append(int group, const rockfall::Dispersion& dispersion, double azimuth, double farHeight)
  {
    const Vec3 along(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Vec3 across(-along.y(), along.x(), 0.0);
    Vec3 middle = dispersion.apex + dispersion.length * along;
    middle.z() = farHeight;
    const Vec3 right = middle + dispersion.lateralMin * across;
    const Vec3 left = middle + dispersion.lateralMax * across;
    const vtkIdType first = this->Points->GetNumberOfPoints();
    for (const Vec3& point : { dispersion.apex, right, middle, left })
    {
      this->Points->InsertNextPoint(point.data());
    }
    const vtkIdType ends[4][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 3 } };
    for (const auto& line : ends)
    {
      this->Lines->InsertNextCell({ first + line[0], first + line[1] });
      this->Group->InsertNextValue(group);
      this->Theta->InsertNextValue(rockfall::degrees(dispersion.angle));
    }
  }

private:
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Lines;
  vtkSmartPointer<vtkIntArray> Group;
  vtkSmartPointer<vtkDoubleArray> Theta;
};

/// How far the trajectories of each group got, as columns of a table.
class RunOuts
{
public:
  explicit RunOuts(vtkFieldData* rows)
  {
    for (const char* name : { "RunOutMean", "RunOutDeviation", "RunOut50", "RunOut90", "RunOut95",
           "RunOut99", "RunOutMaximum" })
    {
      this->Columns.push_back(rockfall::filters::addArray<vtkDoubleArray>(rows, name));
    }
    this->Highest = rockfall::filters::addArray<vtkIntArray>(rows, "HighestQuantile");
  }

  void Append(const Paths& paths)
  {
    std::vector<double> distances;
    for (const std::vector<Vec3>& path : paths)
    {
      if (!path.empty())
      {
        distances.push_back((path.back() - path.front()).head<2>().norm());
      }
    }
    const rockfall::SampleStatistics of = rockfall::statisticsOf(distances);
    const int highest = rockfall::highestQuantile(distances.size());
    this->Highest->InsertNextValue(highest);
    if (highest < 99)
    {
      ++this->Few[highest];
    }
    const double values[] = { of.mean, of.deviation, of.quantiles[0], of.quantiles[1],
      of.quantiles[2], of.quantiles[3], of.maximum };
    for (std::size_t k = 0; k < this->Columns.size(); ++k)
    {
      this->Columns[k]->InsertNextValue(values[k]);
    }
  }

  /// A note where groups are too few for the quantiles.
  std::vector<std::string> Notes() const
  {
    std::vector<std::string> notes;
    for (const auto& [highest, count] : this->Few)
    {
      notes.push_back(std::to_string(count) + " of " +
        std::to_string(this->Highest->GetNumberOfValues()) +
        " groups have too few trajectories for " + rockfall::quantilesMissed(highest));
    }
    return notes;
  }

private:
  std::vector<vtkSmartPointer<vtkDoubleArray>> Columns;
  vtkSmartPointer<vtkIntArray> Highest;
  std::map<int, int> Few; ///< Groups by the highest quantile that they can give.
};

/// Of an angle from +x, rad, counter-clockwise: degrees clockwise from north.
double compass(double angle)
{
  const double azimuth = std::fmod(90.0 - rockfall::degrees(angle), 360.0);
  return azimuth < 0.0 ? azimuth + 360.0 : azimuth;
}

} // namespace

//------------------------------------------------------------------------------
vtkDispersionAngle::vtkDispersionAngle()
{
  this->SetNumberOfInputPorts(1);
  this->SetNumberOfOutputPorts(2);
}

//------------------------------------------------------------------------------
vtkDispersionAngle::~vtkDispersionAngle() = default;

//------------------------------------------------------------------------------
int vtkDispersionAngle::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  return 1;
}

//------------------------------------------------------------------------------
int vtkDispersionAngle::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkTable" : "vtkPolyData");
  return 1;
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkDispersionAngle::IdleNotes() const
{
  rockfall::filters::IdleProperties idle;
  const vtkNew<vtkDispersionAngle> usual;
  if (this->AutomaticDirection)
  {
    idle.add(
      "Direction", Vec3(this->Direction), Vec3(usual->Direction), "AutomaticDirection is on");
  }
  if (!this->UseGroups || this->GroupBy.empty())
  {
    idle.addTo(std::string(this->UseGroups ? "GroupBy is empty" : "UseGroups is off") +
        ", without which these have no effect",
      "ClassLimits", this->ClassLimits, usual->ClassLimits);
  }
  return idle.notes();
}

//------------------------------------------------------------------------------
int vtkDispersionAngle::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return rockfall::filters::attemptTrajectories(this, inputVector[0], outputVector,
    "The trajectories and their dispersion do not fit in memory",
    [&](vtkPolyData* input)
    {
      rockfall::filters::ReleasedRocks released = rockfall::filters::releasedIn(input);
      rockfall::filters::checkReleased(released); // twice, a rock would count for two
      const auto groups = rockfall::filters::groupPaths(
        input, this->UseGroups ? this->GroupBy : std::string(), this->ClassLimits);

      double azimuth = std::atan2(this->Direction[1], this->Direction[0]);
      if (this->AutomaticDirection)
      {
        Paths all;
        for (const auto& group : groups)
        {
          const Paths ends = rockfall::endsOfRocks(group.paths, group.rockOf);
          all.insert(all.end(), ends.begin(), ends.end());
        }
        azimuth = rockfall::meanAzimuth(all);
      }
      else if (!(std::hypot(this->Direction[0], this->Direction[1]) > 0.0))
      {
        throw rockfall::ParameterError(
          "Direction has no horizontal part, so it gives no cross-section");
      }

      using rockfall::filters::addArray;
      vtkNew<vtkTable> table;
      vtkFieldData* rows = table->GetRowData();
      const auto name = addArray<vtkStringArray>(rows, "Group");
      const auto count = addArray<vtkIntArray>(rows, "Trajectories");
      const auto length = addArray<vtkDoubleArray>(rows, "L");
      const auto width = addArray<vtkDoubleArray>(rows, "W");
      const auto theta = addArray<vtkDoubleArray>(rows, "Theta");
      const auto lateralMin = addArray<vtkDoubleArray>(rows, "LateralMin");
      const auto lateralMax = addArray<vtkDoubleArray>(rows, "LateralMax");
      const auto deviation = addArray<vtkDoubleArray>(rows, "LateralDeviation");
      const auto direction = addArray<vtkDoubleArray>(rows, "Azimuth");
      RunOuts runOuts(rows);
      int without = 0; // groups
      vtkNew<vtkPolyData> lines;
      Wedges wedges(lines);
      for (const auto& group : groups)
      {
        const rockfall::Dispersion dispersion = rockfall::measureDispersion(
          group.paths, azimuth, this->Length, this->RelativeToStart, group.rockOf);
        const Paths ends = rockfall::endsOfRocks(group.paths, group.rockOf);
        wedges.Append(int(name->GetNumberOfValues()), dispersion, azimuth, meanEndHeight(ends));
        name->InsertNextValue(group.name);
        count->InsertNextValue(dispersion.trajectories);
        length->InsertNextValue(dispersion.length);
        width->InsertNextValue(dispersion.width);
        theta->InsertNextValue(rockfall::degrees(dispersion.angle));
        lateralMin->InsertNextValue(dispersion.lateralMin);
        lateralMax->InsertNextValue(dispersion.lateralMax);
        deviation->InsertNextValue(dispersion.lateralDeviation);
        direction->InsertNextValue(compass(azimuth));
        without += std::isnan(dispersion.angle);
        runOuts.Append(ends);
      }
      for (vtkDataObject* made :
        { static_cast<vtkDataObject*>(table), static_cast<vtkDataObject*>(lines) })
      {
        rockfall::filters::copyCoordinateSystem(input->GetFieldData(), made->GetFieldData());
      }
      std::vector<std::string> notes = rockfall::filters::doubtsOn(input, nullptr);
      if (without > 0)
      {
        notes.push_back(std::to_string(without) + " of " + std::to_string(groups.size()) +
          " groups have no Theta: none of their trajectories gets anywhere along the direction");
      }
      const std::vector<std::string> reach = runOuts.Notes();
      notes.insert(notes.end(), reach.begin(), reach.end());
      std::ranges::move(this->IdleNotes(), std::back_inserter(notes));
      rockfall::filters::tellLost(rockfall::filters::lostOf(input), table->GetFieldData(), notes);
      vtkTable::GetData(outputVector, 0)->ShallowCopy(table);
      vtkPolyData::GetData(outputVector, 1)->ShallowCopy(lines);
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkDispersionAngle::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "AutomaticDirection: " << this->AutomaticDirection << "\n";
  os << indent << "Direction: " << this->Direction[0] << " " << this->Direction[1] << " "
     << this->Direction[2] << "\n";
  os << indent << "Length: " << this->Length << "\n";
  os << indent << "GroupBy: " << this->GroupBy << "\n";
  os << indent << "ClassLimits:";
  for (const double limit : this->ClassLimits)
  {
    os << " " << limit;
  }
  os << "\n";
  os << indent << "UseGroups: " << this->UseGroups << "\n";
  os << indent << "RelativeToStart: " << this->RelativeToStart << "\n";
}
