#include "vtkTrajectoryCollector.h"

#include "base/require.h"
#include "base/text/numberText.h"
#include "counts/lostRocks.h"
#include "geometry/shell.h"
#include "gis/base/externalReferences.h"
#include "gis/layers/lineLayer.h"
#include "mesh/precision.h"
#include "results/collectorOutputs.h"
#include "results/lineWalls.h"
#include "results/rockWeights.h"
#include "results/trajectoriesInput.h"
#include "shared/arrays.h"
#include "shared/errorReport.h"
#include "shared/inputContent.h"
#include "shared/inputs.h"
#include "shared/rockPaths.h"
#include "shared/terrainFieldData.h"
#include "statistics/familyOfLines.h"
#include "terrain/plausible.h"

#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>

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

enum OutputPorts
{
  CROSSINGS = 0,
  SUMMARIES = 1,
  EXCEEDANCE = 2,
  WALLS = 3
};

void checkSize(double value, const char* name)
{
  rockfall::require(
    value >= 0.0 && std::isfinite(value), name, value, "", "finite and not negative");
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

/// ParaView's sources of lines make single precision.
void tellRounding(vtkPolyData* lines)
{
  double b[6];
  lines->GetBounds(b);
  const double rounding = rockfall::singleRounding(
    std::max({ std::abs(b[0]), std::abs(b[1]), std::abs(b[2]), std::abs(b[3]) }));
  if (lines->GetPoints() && lines->GetPoints()->GetDataType() == VTK_FLOAT && rounding > 0.1)
  {
    rockfall::filters::showNote("The Lines input is in single precision, so its points are rounded "
                                "by up to " +
      rockfall::numberText(rounding, 3) + " m; a line of a file is not");
  }
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

/// Lines that have the barrier of the properties.
struct ByProperties
{
  bool height = false, capacity = false;
};

/// The lines of a file, which must be where the trajectories are. What they do not say of their
/// barrier is `barrier`'s.
std::vector<CollectorLine> readLines(const std::string& fileName, const std::string& layerName,
  vtkPolyData* trajectories, const Box2& site, const Vec3& origin, const CollectorLine& barrier,
  ByProperties& by, std::vector<std::string>& notes)
{
  const std::string crs = rockfall::filters::readCrs(trajectories->GetFieldData());
  const rockfall::FileUnits units = rockfall::filters::readFileUnits(trajectories->GetFieldData());
  Box2 all;
  std::string layer;
  std::vector<CollectorLine> lines;
  for (rockfall::LayerLine& read : rockfall::readLineLayer(fileName, crs, layerName, &notes, units))
  {
    layer = read.layer;
    CollectorLine& line = lines.emplace_back();
    line.name = read.name.empty() ? "feature " + std::to_string(read.feature) : read.name;
    by.height |= !read.height;
    by.capacity |= !read.capacity;
    line.barrierHeight = read.height.value_or(barrier.barrierHeight);
    line.barrierCapacity = read.capacity ? *read.capacity * 1000.0 : barrier.barrierCapacity;
    for (const Eigen::Vector2d& place : read.points)
    {
      all.extend(place);
      line.points.push_back(place - origin.head<2>());
    }
  }
  requireNear(all, site, fileName + ": its lines of layer \"" + layer + "\"");
  return lines;
}

/// Notes on barriers that are better, or less, than any that is built.
void lookAtBarriers(const std::vector<CollectorLine>& lines, std::vector<std::string>& notes)
{
  rockfall::Structures nets;
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const CollectorLine& line = lines[k];
    // 0: what would be caught is not asked. Infinite: all.
    if (line.barrierHeight > 0.0 && line.barrierCapacity > 0.0)
    {
      rockfall::Barrier& net = nets.barriers.emplace_back();
      net.feature = std::int64_t(k) + 1;
      net.height =
        std::isinf(line.barrierHeight) ? rockfall::plausible::kNetHeight.least : line.barrierHeight;
      net.capacity = std::isinf(line.barrierCapacity) ? rockfall::plausible::kNetCapacity.least
                                                      : line.barrierCapacity;
    }
  }
  rockfall::askAfterNumbers(nets, notes);
}

/// Reports and curves go by names: a line with that of another one gets a number.
void nameApart(std::vector<CollectorLine>& lines, std::vector<std::string>& notes)
{
  std::set<std::string> taken;
  std::map<std::string, int> numbers;
  std::int64_t count = 0;
  std::string first;
  for (CollectorLine& line : lines)
  {
    const std::string given = line.name;
    for (int& k = numbers.try_emplace(given, 1).first->second; !taken.insert(line.name).second;)
    {
      line.name = given + " (" + std::to_string(++k) + ")";
    }
    if (line.name != given && ++count == 1)
    {
      first = line.name;
    }
  }
  if (count > 0)
  {
    notes.push_back(std::to_string(count) + " of " + std::to_string(lines.size()) +
      " lines have the name of another one and get a number, first \"" + first + "\"");
  }
}

/// The line through drawn points, which must be where the trajectories are.
CollectorLine lineThrough(const std::vector<std::array<double, 3>>& points, const Box2& rocks,
  const Vec3& origin, const CollectorLine& barrier)
{
  CollectorLine line = barrier;
  line.name = "drawn line";
  Box2 box;
  for (const auto& [x, y, z] : points)
  {
    const Eigen::Vector2d place(x, y);
    if (!place.allFinite())
    {
      throw rockfall::ParameterError("Points: a point of the drawn line is " +
        rockfall::numberText(x) + ", " + rockfall::numberText(y) + ", it must be finite");
    }
    box.extend(place);
    if (line.points.empty() || line.points.back() != Eigen::Vector2d(place - origin.head<2>()))
    {
      line.points.push_back(place - origin.head<2>());
    }
  }
  if (line.points.size() < 2)
  {
    throw rockfall::ParameterError(
      "Points: the drawn line has no two different places in the plane, it must have two at least");
  }
  requireNear(box, rocks, "Points: the drawn line");
  return line;
}

/// Where lines may be, in world coordinates, and the origin to reckon from.
struct Site
{
  Box2 box;
  Vec3 origin = Vec3::Zero();
};

/// The place of the trajectories and of the slope under them. Throws DataError if they have none
/// in common.
Site siteOf(const Box2& rocks, const rockfall::Terrain* terrain)
{
  Site site{ rocks, { std::floor(rocks.min().x()), std::floor(rocks.min().y()), 0.0 } };
  if (terrain)
  {
    site.origin = terrain->geometry().origin();
    const Eigen::Vector2d corner = site.origin.head<2>();
    const Box2 slope(corner, corner + Eigen::Vector2d(terrain->width(), terrain->height()));
    if (!rocks.intersects(slope))
    {
      throw rockfall::DataError(
        "No trajectory of the Input is over the Terrain: they do not belong together");
    }
    site.box.extend(slope);
  }
  return site;
}

struct Collected
{
  std::vector<rockfall::filters::CollectedCrossing> crossings;
  rockfall::filters::ReleasedRocks released;
  std::vector<rockfall::LineSummary> summaries; ///< Of each line.
  std::vector<rockfall::LostRocks> lost;        ///< Likewise, before they passed it.
  std::vector<std::int64_t> across;             ///< Rocks and pieces that lie across it.
  rockfall::FrequencyRange weights;             ///< Of all rocks that were released.
};

/// All crossings of all lines.
Collected collect(vtkPolyData* trajectories, const std::vector<CollectorLine>& lines,
  const Vec3& origin, const rockfall::Terrain* terrain)
{
  Collected collected;
  collected.across.resize(lines.size());
  std::vector<rockfall::Crossing> all, found;
  vtkDataArray* frequency = trajectories->GetCellData()->GetArray("Frequency");
  vtkDataArray* fate = trajectories->GetCellData()->GetArray("Fate"); // forEachPath asks for it
  rockfall::filters::forEachPath(trajectories, origin,
    [&](const rockfall::RockPath& path, std::int64_t cell)
    {
      const double often =
        frequency ? frequency->GetTuple1(cell) : std::numeric_limits<double>::quiet_NaN();
      rockfall::filters::addPath(
        path, rockfall::filters::lossOf(fate->GetTuple1(cell)), often, collected.released);
      for (std::size_t k = 0; k < lines.size(); ++k)
      {
        found.clear();
        rockfall::appendCrossings(path, lines[k], int(k), terrain, found);
        const bool lies = found.empty() && lines[k].offset == 0.0;
        collected.across[k] += lies && rockfall::filters::liesAcross(path, lines[k]) ? 1 : 0;
        for (rockfall::Crossing& crossing : found)
        {
          crossing.frequency = often;
          collected.crossings.push_back({ crossing, cell });
          all.push_back(crossing);
        }
      }
    });
  rockfall::filters::checkReleased(collected.released);
  const rockfall::RockReleases releases = rockfall::filters::releasesOf(collected.released, all);
  rockfall::filters::weigh(releases, all);
  collected.weights = releases.weights();
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    collected.summaries.push_back(
      rockfall::summarizeLine(lines[k], int(k), all, std::int64_t(collected.released.size())));
  }
  collected.lost = rockfall::filters::lostBefore(lines.size(), all, collected.released);
  return collected;
}

} // namespace

//------------------------------------------------------------------------------
vtkTrajectoryCollector::vtkTrajectoryCollector()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(4);
}

//------------------------------------------------------------------------------
vtkTrajectoryCollector::~vtkTrajectoryCollector() = default;

//------------------------------------------------------------------------------
int vtkTrajectoryCollector::FillInputPortInformation(int port, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  if (port != TRAJECTORIES)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkTrajectoryCollector::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(),
    port == CROSSINGS || port == WALLS ? "vtkPolyData" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkTrajectoryCollector::IdleNotes(bool height, bool capacity) const
{
  rockfall::filters::IdleProperties idle;
  const vtkNew<vtkTrajectoryCollector> usual;
  if (this->ParallelLines == 0)
  {
    idle.add(
      "ParallelSpacing", this->ParallelSpacing, usual->ParallelSpacing, "ParallelLines is 0", " m");
  }
  if (this->FileName.empty())
  {
    idle.add("AllowReferences", this->AllowReferences != 0, false, "there is no FileName");
  }
  const char* cause = "All lines of FileName have their own of what these properties say";
  if (!height)
  {
    idle.addTo(cause, "BarrierHeight", this->BarrierHeight, usual->BarrierHeight);
  }
  if (!capacity)
  {
    idle.addTo(cause, "BarrierCapacity", this->BarrierCapacity, usual->BarrierCapacity);
  }
  return idle.notes();
}

//------------------------------------------------------------------------------
int vtkTrajectoryCollector::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  namespace filters = rockfall::filters;
  return filters::attemptTrajectories(this, inputVector[TRAJECTORIES], outputVector,
    "The crossings do not fit in memory",
    [&](vtkPolyData* trajectories)
    {
      filters::Input takenLines(filters::InputKind::Lines);
      filters::Input takenTerrain(filters::InputKind::Terrain);
      vtkPolyData* drawn = takenLines.take(inputVector[LINES]);
      vtkPolyData* mesh = takenTerrain.take(inputVector[TERRAIN]);
      takenLines.require();
      takenTerrain.require();
      if ((drawn && filters::inheritFailure(drawn, this)) ||
        (mesh && filters::inheritFailure(mesh, this)))
      {
        return 1;
      }
      if (trajectories->GetNumberOfLines() == 0)
      {
        throw rockfall::DataError(
          "The Input has no lines; the trajectories of Rockfall Simulation are wanted");
      }
      checkSize(this->BarrierHeight, "BarrierHeight");
      checkSize(this->BarrierCapacity, "BarrierCapacity");
      const std::optional<rockfall::Terrain> terrain = filters::slopeUnder(trajectories, mesh);
      const rockfall::Terrain* slope = terrain ? &*terrain : nullptr;
      const Box2 rocks = boxOf(trajectories);
      const Site site = siteOf(rocks, slope);
      const Vec3& origin = site.origin;
      CollectorLine barrier;
      barrier.barrierHeight = this->BarrierHeight;
      barrier.barrierCapacity = this->BarrierCapacity * 1000.0;
      std::vector<CollectorLine> lines;
      ByProperties by;
      const std::vector<std::string> doubts = filters::doubtsOn(trajectories, mesh);
      std::vector<std::string> notes = doubts;
      if (drawn)
      {
        if (drawn->GetNumberOfPoints() > 0)
        {
          requireNear(boxOf(drawn), site.box, "The lines of the Lines input");
          tellRounding(drawn);
        }
        lines = filters::linesOf(drawn, origin, barrier);
        by = { true, true };
      }
      if (this->FileName.empty() && !this->LayerName.empty())
      {
        throw rockfall::ParameterError(
          "LayerName is \"" + this->LayerName + "\", but FileName names no file to read it from");
      }
      if (!this->FileName.empty())
      {
        const rockfall::AllowReferences references(this->AllowReferences != 0);
        for (CollectorLine& line : readLines(
               this->FileName, this->LayerName, trajectories, site.box, origin, barrier, by, notes))
        {
          lines.push_back(std::move(line));
        }
      }
      std::vector<std::array<double, 3>> points = filters::drawnPoints(this->Points);
      if (points.empty() && lines.empty())
      {
        const std::array<double, 6> placed = filters::lineAcross(trajectories, slope, origin);
        std::copy(placed.begin(), placed.end(), this->PlacedLine);
        points = { { placed[0], placed[1], placed[2] }, { placed[3], placed[4], placed[5] } };
      }
      if (!points.empty())
      {
        lines.push_back(lineThrough(points, rocks, origin, barrier));
        by = { true, true };
      }
      nameApart(lines, notes);
      if (slope)
      {
        filters::askAfterGroundUnder(lines, *slope, notes);
      }
      lookAtBarriers(lines, notes);
      std::ranges::move(this->IdleNotes(by.height, by.capacity), std::back_inserter(notes));
      rockfall::addParallels(lines, this->ParallelLines, this->ParallelSpacing);
      const Collected collected = collect(trajectories, lines, origin, slope);
      const auto released = std::int64_t(collected.released.size());

      vtkNew<vtkPolyData> passings, walls;
      filters::addTexts(passings->GetFieldData(), filters::kRunDoubts, doubts);
      filters::writeCrossings(
        collected.crossings, lines, collected.released, origin, trajectories, passings);
      filters::writeWalls(lines, collected.summaries, slope,
        trajectories->GetBounds()[4] - origin.z(), origin, walls);
      vtkNew<vtkTable> table, exceedance;
      filters::writeLines(collected.summaries, lines, collected.lost, table);
      if (filters::isRunning(trajectories->GetFieldData()))
      {
        filters::markRunning(exceedance->GetFieldData());
      }
      else
      {
        std::ranges::move(filters::lineNotes(collected.summaries, lines, collected.lost,
                            collected.weights, collected.across),
          std::back_inserter(notes));
      }
      vtkFieldData* const told[] = { table->GetFieldData(), passings->GetFieldData() };
      filters::tellOn(told, notes, this->PrintNotes);
      filters::writeExceedance(collected.summaries, released, exceedance);
      for (vtkDataObject* made :
        { static_cast<vtkDataObject*>(passings), static_cast<vtkDataObject*>(walls),
          static_cast<vtkDataObject*>(table), static_cast<vtkDataObject*>(exceedance) })
      {
        filters::copyCoordinateSystem(trajectories->GetFieldData(), made->GetFieldData());
      }
      vtkPolyData::GetData(outputVector, CROSSINGS)->ShallowCopy(passings);
      vtkTable::GetData(outputVector, SUMMARIES)->ShallowCopy(table);
      vtkTable::GetData(outputVector, EXCEEDANCE)->ShallowCopy(exceedance);
      vtkPolyData::GetData(outputVector, WALLS)->ShallowCopy(walls);
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkTrajectoryCollector::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "AllowReferences: " << this->AllowReferences << "\n";
  os << indent << "PrintNotes: " << this->PrintNotes << "\n";
  os << indent << "LayerName: " << this->LayerName << "\n";
  os << indent << "Points: " << this->Points.size() / 3 << "\n";
  os << indent << "PlacedLine:";
  for (const double number : this->PlacedLine)
  {
    os << " " << number;
  }
  os << "\n";
  os << indent << "BarrierHeight: " << this->BarrierHeight << "\n";
  os << indent << "BarrierCapacity: " << this->BarrierCapacity << "\n";
  os << indent << "ParallelLines: " << this->ParallelLines << "\n";
  os << indent << "ParallelSpacing: " << this->ParallelSpacing << "\n";
}
