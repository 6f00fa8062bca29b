#include "vtkTrajectoryCollector.h"

#include "base/errors.h"
#include "base/numberText.h"
#include "collectorOutputs.h"
#include "failure.h"
#include "geometry/shell.h"
#include "gis/lineLayer.h"
#include "pieces.h"
#include "ranks.h"
#include "rockPaths.h"
#include "terrainFieldData.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <optional>

vtkStandardNewMacro(vtkTrajectoryCollector);

namespace
{

using rockfall::CollectorLine;
using rockfall::Vec3;

enum InputPorts
{
  TRAJECTORIES = 0,
  LINES = 1,
  TERRAIN = 2
};

void checkSize(double value, const char* name)
{
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    throw rockfall::ParameterError(std::string(name) + " is " + rockfall::numberText(value) +
      ", it must be finite and not negative");
  }
}

/// Lines that are farther from the trajectories than this, m, and than ten times their extent, are
/// those of another place. Where all rocks stop before a nearer one, none has passed it.
constexpr double kElsewhere = 1000.0;

using Box2 = Eigen::AlignedBox2d;

/// In plan, world coordinates.
Box2 boxOf(vtkPolyData* data)
{
  double b[6];
  data->GetBounds(b);
  return { Eigen::Vector2d(b[0], b[2]), Eigen::Vector2d(b[1], b[3]) };
}

void requireNear(const Box2& lines, const Box2& rocks, const std::string& whose)
{
  if (lines.exteriorDistance(rocks) > std::max(kElsewhere, 10.0 * rocks.diagonal().norm()))
  {
    const auto text = [](const Box2& box)
    {
      using rockfall::numberText;
      return "x " + numberText(box.min().x()) + " to " + numberText(box.max().x()) + ", y " +
        numberText(box.min().y()) + " to " + numberText(box.max().y());
    };
    throw rockfall::DataError(
      whose + " (" + text(lines) + ") are far from the trajectories (" + text(rocks) + ")");
  }
}

/// The lines of a file, which must be where the trajectories are. What they do not say of their
/// barrier is `barrier`'s.
std::vector<CollectorLine> readLines(const std::string& fileName, vtkPolyData* trajectories,
  const Vec3& origin, const CollectorLine& barrier)
{
  const std::string crs = rockfall::filters::readCrs(trajectories->GetFieldData());
  Box2 all;
  std::vector<CollectorLine> lines;
  std::vector<std::string> notes;
  std::vector<rockfall::LayerLine> layer = rockfall::readLineLayer(fileName, crs, &notes);
  for (const std::string& note : notes)
  {
    rockfall::filters::showNote(note);
  }
  for (rockfall::LayerLine& read : layer)
  {
    CollectorLine& line = lines.emplace_back();
    line.name = read.name.empty() ? "feature " + std::to_string(read.feature) : read.name;
    line.barrierHeight = read.height.value_or(barrier.barrierHeight);
    line.barrierCapacity = read.capacity ? *read.capacity * 1000.0 : barrier.barrierCapacity;
    for (const Eigen::Vector2d& place : read.points)
    {
      all.extend(place);
      line.points.push_back(place - origin.head<2>());
    }
  }
  requireNear(all, boxOf(trajectories), fileName + ": its lines");
  return lines;
}

} // namespace

//------------------------------------------------------------------------------
vtkTrajectoryCollector::vtkTrajectoryCollector()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(3);
}

//------------------------------------------------------------------------------
vtkTrajectoryCollector::~vtkTrajectoryCollector() = default;

//------------------------------------------------------------------------------
int vtkTrajectoryCollector::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  if (port != TRAJECTORIES)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkTrajectoryCollector::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkPolyData" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkTrajectoryCollector::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  namespace filters = rockfall::filters;
  try
  {
    vtkPolyData* trajectories = vtkPolyData::GetData(inputVector[TRAJECTORIES]);
    vtkPolyData* drawn = vtkPolyData::GetData(inputVector[LINES]);
    vtkPolyData* mesh = vtkPolyData::GetData(inputVector[TERRAIN]);
    const std::string spread = filters::spreadOf(trajectories);
    if (!spread.empty())
    {
      return filters::failTogether(this, spread);
    }
    if (!trajectories)
    {
      throw rockfall::DataError("The Input is missing");
    }
    for (vtkPolyData* input : { trajectories, drawn, mesh })
    {
      if (input && filters::inheritFailure(input, this))
      {
        return 1;
      }
    }
    if (trajectories->GetNumberOfLines() == 0)
    {
      if (filters::isFurtherPiece(outputVector))
      {
        return 1;
      }
      throw rockfall::DataError(
        "The Input has no lines; the trajectories of Rockfall Simulation are wanted");
    }
    checkSize(this->BarrierHeight, "BarrierHeight");
    checkSize(this->BarrierCapacity, "BarrierCapacity");
    std::optional<rockfall::Terrain> terrain;
    const Box2 rocks = boxOf(trajectories);
    Vec3 origin(std::floor(rocks.min().x()), std::floor(rocks.min().y()), 0.0);
    if (mesh)
    {
      terrain.emplace(filters::readTerrain(mesh));
      filters::checkSameCrs(
        trajectories->GetFieldData(), "The trajectories of the Input are", mesh->GetFieldData());
      origin = terrain->geometry().origin();
      const Eigen::Vector2d corner = origin.head<2>();
      const Eigen::Vector2d size(terrain->width(), terrain->height());
      if (!rocks.intersects(Box2(corner, corner + size)))
      {
        throw rockfall::DataError(
          "No trajectory of the Input is over the Terrain: they do not belong together");
      }
    }
    CollectorLine barrier;
    barrier.barrierHeight = this->BarrierHeight;
    barrier.barrierCapacity = this->BarrierCapacity * 1000.0;
    std::vector<CollectorLine> lines;
    if (drawn)
    {
      if (drawn->GetNumberOfPoints() > 0)
      {
        requireNear(boxOf(drawn), rocks, "The lines of the Lines input");
      }
      lines = filters::linesOf(drawn, origin, barrier);
    }
    if (!this->FileName.empty())
    {
      for (CollectorLine& line : readLines(this->FileName, trajectories, origin, barrier))
      {
        lines.push_back(std::move(line));
      }
    }
    else if (!drawn)
    {
      throw rockfall::ParameterError(
        "There is no line: connect some to the Lines input or give a FileName");
    }
    std::vector<filters::CollectedCrossing> crossings;
    std::vector<rockfall::Crossing> all, found;
    filters::ReleasedRocks released;
    filters::forEachPath(trajectories, origin,
      [&](const rockfall::RockPath& path, std::int64_t cell)
      {
        released.push_back({ path.iteration, path.rock });
        for (std::size_t k = 0; k < lines.size(); ++k)
        {
          found.clear();
          rockfall::appendCrossings(path, lines[k], int(k), terrain ? &*terrain : nullptr, found);
          for (const rockfall::Crossing& crossing : found)
          {
            crossings.push_back({ crossing, cell });
            all.push_back(crossing);
          }
        }
      });
    filters::checkReleased(released);
    std::vector<rockfall::LineSummary> summaries;
    for (std::size_t k = 0; k < lines.size(); ++k)
    {
      summaries.push_back(
        rockfall::summarizeLine(lines[k], int(k), all, std::int64_t(released.size())));
    }

    vtkNew<vtkPolyData> points;
    filters::writeCrossings(crossings, lines, released, origin, trajectories, points);
    vtkNew<vtkTable> table, exceedance;
    filters::writeLines(summaries, lines, table);
    filters::writeExceedance(summaries, std::int64_t(released.size()), exceedance);
    for (vtkDataObject* made : { static_cast<vtkDataObject*>(points),
           static_cast<vtkDataObject*>(table), static_cast<vtkDataObject*>(exceedance) })
    {
      filters::copyCoordinateSystem(trajectories->GetFieldData(), made->GetFieldData());
    }
    vtkPolyData::GetData(outputVector, 0)->ShallowCopy(points);
    vtkTable::GetData(outputVector, 1)->ShallowCopy(table);
    vtkTable::GetData(outputVector, 2)->ShallowCopy(exceedance);
    return 1;
  }
  catch (const rockfall::Error& error)
  {
    return rockfall::filters::fail(this, error.what());
  }
}

//------------------------------------------------------------------------------
void vtkTrajectoryCollector::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "BarrierHeight: " << this->BarrierHeight << "\n";
  os << indent << "BarrierCapacity: " << this->BarrierCapacity << "\n";
}
