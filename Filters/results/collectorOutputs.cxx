#include "results/collectorOutputs.h"

#include "base/Tally.h"
#include "base/abort.h"
#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/polyline.h"
#include "shared/cells.h"
#include "shared/columns.h"
#include "shared/inputContent.h"
#include "shared/terrainFieldData.h"
#include "statistics/design.h"
#include "terrain/HeightGrid.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace rockfall::filters
{

std::vector<CollectorLine> linesOf(
  vtkPolyData* input, const Vec3& origin, const CollectorLine& barrier)
{
  std::vector<CollectorLine> lines;
  const auto add = [&](std::span<const vtkIdType> ids, bool closed)
  {
    CollectorLine& line = lines.emplace_back(barrier);
    line.name = "line " + std::to_string(lines.size());
    for (const vtkIdType id : ids)
    {
      Vec3 point;
      input->GetPoint(id, point.data());
      const Eigen::Vector2d place = (point - origin).head<2>();
      if (line.points.empty() || line.points.back() != place)
      {
        line.points.push_back(place);
      }
    }
    if (line.points.size() < 2)
    {
      throw DataError(
        "The Lines input's " + line.name + " has no two different places in the plane");
    }
    if (closed && line.points.front() != line.points.back())
    {
      line.points.push_back(line.points.front());
    }
  };
  forEachLine(input, [&](vtkIdType, auto ids) { add(ids, false); });
  forEachCell(input->GetPolys(), 0, [&](vtkIdType, auto ids) { add(ids, true); });
  if (lines.empty())
  {
    throw DataError("The Lines input has no lines");
  }
  return lines;
}

namespace
{

auto keyOf(const CollectedRock& rock)
{
  return std::tie(rock.iteration, rock.rock, rock.blockId);
}

} // namespace

ReleasedRocks releasedIn(vtkPolyData* trajectories)
{
  ReleasedRocks rocks;
  vtkFieldData* cells = trajectories->GetCellData();
  vtkDataArray *iteration = cells->GetArray("Iteration"), *rock = cells->GetArray("RockId"),
               *block = cells->GetArray("BlockId"), *piece = cells->GetArray("Piece");
  // Polydata's cells begin with its vertices: the points at which rocks stopped.
  const vtkIdType first = trajectories->GetNumberOfVerts();
  for (vtkIdType k = first; iteration && rock && block && k < iteration->GetNumberOfTuples(); ++k)
  {
    if (!piece || piece->GetTuple1(k) == 0.0)
    {
      rocks.push_back({ int(iteration->GetTuple1(k)), int(rock->GetTuple1(k)),
        std::int64_t(block->GetTuple1(k)), Loss::None, 0.0 });
    }
  }
  return rocks;
}

void addPath(const RockPath& path, Loss loss, double frequency, ReleasedRocks& rocks)
{
  const double end = path.points.empty() ? 0.0 : path.points.back().time;
  const CollectedRock added{ path.iteration, path.rock, path.blockId, loss, end, frequency };
  if (path.piece == 0)
  {
    rocks.push_back(added);
  }
  else if (!rocks.empty() && keyOf(rocks.back()) == keyOf(added) && rocks.back().loss == Loss::None)
  {
    rocks.back() = added;
  }
}

void checkReleased(ReleasedRocks& rocks)
{
  std::sort(rocks.begin(), rocks.end(),
    [](const CollectedRock& a, const CollectedRock& b) { return keyOf(a) < keyOf(b); });
  const auto twice = std::adjacent_find(rocks.begin(), rocks.end(),
    [](const CollectedRock& a, const CollectedRock& b) { return keyOf(a) == keyOf(b); });
  if (twice != rocks.end())
  {
    throw DataError("Rock " + std::to_string(twice->rock) + " of iteration " +
      std::to_string(twice->iteration) + " (block " + std::to_string(twice->blockId) +
      ") is there twice: a run was given twice, or two runs have "
      "the same iterations and block ids");
  }
}

bool isReleased(const ReleasedRocks& rocks, const Crossing& crossing)
{
  CollectedRock rock{};
  rock.iteration = crossing.iteration;
  rock.rock = crossing.rock;
  rock.blockId = crossing.blockId;
  return std::binary_search(rocks.begin(), rocks.end(), rock,
    [](const CollectedRock& a, const CollectedRock& b) { return keyOf(a) < keyOf(b); });
}

std::vector<LostRocks> lostBefore(std::size_t lines, std::span<const Crossing> crossings,
  const ReleasedRocks& released,
  const std::function<void(std::size_t line, const CollectedRock& rock)>& use)
{
  std::set<std::tuple<int, int, int, std::int64_t>> passed;
  for (const Crossing& c : crossings)
  {
    passed.emplace(c.line, c.iteration, c.rock, c.blockId);
  }
  std::vector<LostRocks> lost(lines);
  for (std::size_t line = 0; line < lines; ++line)
  {
    for (const CollectedRock& rock : released)
    {
      const bool before = !passed.contains({ int(line), rock.iteration, rock.rock, rock.blockId });
      lost[line].add(before ? rock.loss : Loss::None, rock.endTime, kLeastWay);
      if (use && before && rock.loss != Loss::None)
      {
        use(line, rock);
      }
    }
  }
  return lost;
}

std::vector<std::string> lostBeforeNotes(std::span<const LostRocks> lost)
{
  const auto most = std::ranges::max_element(lost, {}, &LostRocks::lost);
  return most == lost.end()
    ? std::vector<std::string>()
    : lostNotes(
        *most, lost.size() == 1 ? " before they passed the line" : " before they passed a line");
}

void askAfterGroundUnder(
  std::span<const CollectorLine> lines, const HeightGrid& slope, std::vector<std::string>& notes)
{
  Tally beyond;
  for (const CollectorLine& line : lines)
  {
    const double without = lengthWithoutGround(slope, line.points);
    beyond.look(without > 2.0 * slope.geometry().cellSize,
      [&]
      {
        return "\"" + line.name + "\" on " + numberText(std::round(without)) + " of " +
          numberText(std::round(lengthOf(line.points))) + " m";
      });
  }
  beyond.tell(notes, "",
    " of " + std::to_string(lines.size()) + " lines go on where the slope has no ground, first ",
    ": nothing comes there that could be counted");
}

bool liesAcross(const RockPath& path, const CollectorLine& line)
{
  return path.rested && !path.points.empty() &&
    distanceTo(line.points, path.points.back().position.head<2>()) < 0.5 * path.width;
}

std::vector<std::string> lineNotes(std::span<const LineSummary> summaries,
  std::span<const CollectorLine> lines, std::span<const LostRocks> lost,
  const FrequencyRange& weights, std::span<const std::int64_t> across)
{
  constexpr std::size_t kMostNames = 5; // in a note
  std::vector<std::string> notes;
  const auto named = [&](const std::vector<std::size_t>& which)
  {
    if (lines.size() == 1)
    {
      return "line \"" + lines[0].name + "\"";
    }
    std::string text =
      std::to_string(which.size()) + " of " + std::to_string(lines.size()) + " lines (";
    for (std::size_t k = 0; k < std::min(which.size(), kMostNames); ++k)
    {
      text += (k > 0 ? ", \"" : "\"") + lines[which[k]].name + "\"";
    }
    return text + (which.size() > kMostNames ? ", …)" : ")");
  };
  std::vector<std::size_t> missed;
  std::map<int, std::vector<std::size_t>> few; // by the highest quantile that they can give
  LostRocks most;                              // of the line that misses most
  FrequencyRange differing;                    // of lines on which frequencies differ
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    most = k == 0 || lost[k].lost() > most.lost() ? lost[k] : most;
    if (summaries[k].frequencies.differs())
    {
      differing.add(summaries[k].frequencies);
    }
    if (summaries[k].rocks == 0)
    {
      missed.push_back(k);
    }
    else if (summaries[k].highestQuantile < 99)
    {
      few[summaries[k].highestQuantile].push_back(k);
    }
  }
  const bool look = most.moving > 0 && most.endTime < kLeastRun; // a run of the first moment only
  if (!missed.empty() && !look)
  {
    notes.push_back("No rock reached " + named(missed));
  }
  Tally lying;
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    lying.look(k < across.size() && across[k] > 0,
      [&] { return "\"" + lines[k].name + "\" by " + std::to_string(across[k]); });
  }
  lying.tell(notes, "On ",
    " of " + std::to_string(lines.size()) +
      " lines rocks lie whose centre has not passed it, first ",
    ": they do not count. Draw a line half a rock before what it stands for");
  std::ranges::move(lostBeforeNotes(lost), std::back_inserter(notes));
  for (const auto& [highest, of] : few)
  {
    if (!look)
    {
      notes.push_back("Too few rocks passed " + named(of) + " for " + quantilesMissed(highest));
    }
  }
  std::ranges::move(differing.notes(), std::back_inserter(notes));
  std::ranges::move(weights.notesOnShares(), std::back_inserter(notes));
  return notes;
}

void writeReleased(const ReleasedRocks& released, std::size_t crossings, vtkFieldData* field)
{
  addArray<vtkIdTypeArray>(field, kCollectorCrossings)->InsertNextValue(vtkIdType(crossings));
  addArray<vtkIdTypeArray>(field, "CollectorReleased")->InsertNextValue(vtkIdType(released.size()));
  const auto rocks = addArray<vtkIntArray>(field, "CollectorRocks", 2);
  const auto blocks = addArray<vtkIdTypeArray>(field, "CollectorBlocks");
  const auto losses = addArray<vtkIntArray>(field, "CollectorLosses");
  const auto ends = addArray<vtkDoubleArray>(field, "CollectorEnds");
  const auto frequencies = addArray<vtkDoubleArray>(field, kCollectorFrequencies);
  for (const CollectedRock& rock : released)
  {
    rocks->InsertNextTuple2(rock.iteration, rock.rock);
    blocks->InsertNextValue(vtkIdType(rock.blockId));
    losses->InsertNextValue(int(rock.loss));
    ends->InsertNextValue(rock.endTime);
    frequencies->InsertNextValue(rock.frequency);
  }
}

void writeCrossings(std::span<const CollectedCrossing> crossings,
  std::span<const CollectorLine> lines, const ReleasedRocks& released, const Vec3& origin,
  vtkPolyData* trajectories, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  vtkPointData* data = output->GetPointData();
  // First those of the trajectory: BlockId, RockId, Iteration, Shape, …
  data->CopyAllOn();
  data->CopyAllocate(trajectories->GetCellData(), vtkIdType(crossings.size()));
  using C = const CollectedCrossing&;
  Columns<CollectedCrossing> columns(data);
  columns.add("Line", [](C c) { return c.crossing.line; });
  columns.add("LineName", [&](C c) { return lines[std::size_t(c.crossing.line)].name; });
  columns.add("Passing", [](C c) { return c.crossing.number; });
  columns.add("Direction", [](C c) { return c.crossing.direction; });
  columns.add("Velocity", [](C c) { return c.crossing.velocity; });
  columns.add("RotationRate", [](C c) { return c.crossing.rotationRate; });
  columns.add("Time", [](C c) { return c.crossing.time; });
  columns.add("Distance", [](C c) { return c.crossing.distance; });
  columns.add("Speed", [](C c) { return c.crossing.velocity.norm(); });
  columns.add("KineticEnergy", [](C c) { return c.crossing.kineticEnergy; });
  columns.add("TranslationalEnergy", [](C c) { return c.crossing.translationalEnergy; });
  columns.add("RotationalEnergy",
    [](C c) { return c.crossing.kineticEnergy - c.crossing.translationalEnergy; });
  columns.add("HeightOverGround", [](C c) { return c.crossing.heightOverGround; });
  columns.add("HorizontalAngle", [](C c) { return degrees(c.crossing.horizontalAngle); });
  columns.add("VerticalAngle", [](C c) { return degrees(c.crossing.verticalAngle); });
  columns.add("TopHeight", [](C c) { return c.crossing.top; });
  for (const CollectedCrossing& collected : crossings)
  {
    stayWanted();
    const Vec3 world = collected.crossing.position + origin;
    const vtkIdType id = points->InsertNextPoint(world.data());
    vertices->InsertNextCell(1, &id);
    data->CopyData(trajectories->GetCellData(), collected.cell, id);
    columns.append(collected);
  }
  output->SetPoints(points);
  output->SetVerts(vertices);
  vtkFieldData* field = output->GetFieldData();
  writeReleased(released, crossings.size(), field);
  const auto lineNames = addArray<vtkStringArray>(field, "CollectorLineName");
  const auto barriers = addArray<vtkDoubleArray>(field, "CollectorBarrier", 2);
  const auto offsets = addArray<vtkDoubleArray>(field, "CollectorOffset");
  for (const CollectorLine& of : lines)
  {
    lineNames->InsertNextValue(of.name);
    barriers->InsertNextTuple2(of.barrierHeight, of.barrierCapacity / 1000.0);
    offsets->InsertNextValue(of.offset);
  }
  const RunOrigin run = runOf(trajectories);
  if (run.slope != 0)
  {
    char key[17];
    std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(run.slope));
    addArray<vtkStringArray>(field, kCollectorSlope)->InsertNextValue(key);
  }
  if (!run.properties.empty())
  {
    addArray<vtkStringArray>(field, kCollectorRun)->InsertNextValue(run.properties);
  }
}

void writeLines(std::span<const LineSummary> summaries, std::span<const CollectorLine> lines,
  std::span<const LostRocks> lost, vtkTable* output)
{
  vtkFieldData* data = output->GetRowData();
  struct Row
  {
    int number;
    const LineSummary& of;
    const CollectorLine& line;
    const LostRocks& lost;
  };
  using R = const Row&;
  Columns<Row> columns(data);
  columns.add("Line", [](R r) { return r.number; });
  columns.add("LineName", [](R r) { return r.line.name; });
  columns.add("Rocks", [](R r) { return r.of.rocks; });
  columns.add("Passings", [](R r) { return r.of.crossings; });
  columns.add("Caught", [](R r) { return r.of.caught; });
  columns.add("MovingBefore", [](R r) { return std::int64_t(r.lost.moving); });
  columns.add("OverEdgeBefore", [](R r) { return std::int64_t(r.lost.overEdge); });
  columns.add("InNodataBefore", [](R r) { return std::int64_t(r.lost.inNodata); });
  columns.add("HighestQuantile", [](R r) { return r.of.highestQuantile; });
  columns.add("Offset", [](R r) { return r.line.offset; });
  columns.add("Share", [](R r) { return r.of.share; });
  // Rocks that were lost before may pass a line that none was seen to pass.
  columns.add("ShareError",
    [](R r)
    {
      return r.of.rocks == 0 && r.lost.lost() > 0 ? shareAtMost(r.lost.lost(), r.lost.rocks)
                                                  : r.of.shareError;
    });
  columns.add("BarrierHeight", [](R r) { return r.line.barrierHeight; });
  columns.add("BarrierCapacity", [](R r) { return r.line.barrierCapacity / 1000.0; });
  columns.add("CaughtShare", [](R r) { return r.of.caughtShare; });
  columns.add("CaughtShareError", [](R r) { return r.of.caughtShareError; });
  const std::pair<const char*, SampleStatistics LineSummary::*> quantities[] = {
    { "KineticEnergy", &LineSummary::energy },
    { "HeightOverGround", &LineSummary::height },
    { "Speed", &LineSummary::speed },
  };
  for (const auto& [quantity, of] : quantities)
  {
    const std::string start = quantity;
    columns.add(start + "Mean", [of = of](R r) { return (r.of.*of).mean; });
    columns.add(start + "Deviation", [of = of](R r) { return (r.of.*of).deviation; });
    columns.add(start + "Maximum", [of = of](R r) { return (r.of.*of).maximum; });
    const char* const names[] = { "50", "90", "95", "99" };
    for (std::size_t q = 0; q < hazardQuantiles.size(); ++q)
    {
      columns.add(start + names[q], [of = of, q](R r) { return (r.of.*of).quantiles[q]; });
    }
  }
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    columns.append({ int(k), summaries[k], lines[k], lost[k] });
  }
}

void writeExceedance(
  std::span<const LineSummary> summaries, std::int64_t released, vtkTable* output)
{
  vtkFieldData* data = output->GetRowData();
  const auto line = addArray<vtkIntArray>(data, "Line");
  const auto energy = addArray<vtkDoubleArray>(data, "KineticEnergy");
  const auto kilojoules = addArray<vtkDoubleArray>(data, "EnergyInKilojoules");
  const auto height = addArray<vtkDoubleArray>(data, "HeightOverGround");
  const auto ofPassing = addArray<vtkDoubleArray>(data, "ShareOfPassing");
  const auto ofReleased = addArray<vtkDoubleArray>(data, "ShareOfReleased");
  for (std::size_t k = 0; k < summaries.size(); ++k)
  {
    const LineSummary& summary = summaries[k];
    const auto descending = [](const std::vector<double>& ascending, std::size_t rank)
    {
      return rank < ascending.size() ? ascending[ascending.size() - 1 - rank]
                                     : std::numeric_limits<double>::quiet_NaN();
    };
    const auto add = [&](double joules, double metres, std::size_t rocks)
    {
      line->InsertNextValue(int(k));
      energy->InsertNextValue(joules);
      kilojoules->InsertNextValue(1e-3 * joules);
      height->InsertNextValue(metres);
      ofPassing->InsertNextValue(double(rocks) / double(summary.rocks));
      ofReleased->InsertNextValue(double(rocks) / double(released));
    };
    const std::size_t rocks = summary.energies.size();
    for (std::size_t rank = 0; rank < rocks; ++rank)
    {
      add(descending(summary.energies, rank), descending(summary.heights, rank), rank + 1);
    }
    if (rocks > 0)
    {
      // All have at least nothing: where the curve begins, and what makes one of a single rock.
      const bool all = summary.heights.size() == rocks;
      add(0.0,
        all ? std::min(0.0, summary.heights.front()) : std::numeric_limits<double>::quiet_NaN(),
        rocks);
    }
  }
}

} // namespace rockfall::filters
