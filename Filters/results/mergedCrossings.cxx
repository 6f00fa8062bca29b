#include "results/mergedCrossings.h"

#include "base/errors.h"
#include "results/collectorOutputs.h"
#include "shared/arrays.h"
#include "shared/inputContent.h"
#include "shared/terrainFieldData.h"
#include "statistics/runOrigin.h"

#include "vtkAbstractArray.h"
#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>

namespace rockfall::filters
{

namespace
{

std::string partName(std::size_t input)
{
  return "part " + std::to_string(input + 1) + " of the Input";
}

std::string numbered(std::size_t input)
{
  return "The Input's part " + std::to_string(input + 1);
}

vtkDataArray* crossingNumbers(
  vtkFieldData* data, const char* name, int components, std::size_t input)
{
  vtkDataArray* array = data->GetArray(name);
  if (!array || array->GetNumberOfComponents() != components)
  {
    throw DataError(numbered(input) + " has no array " + name + " of " +
      std::to_string(components) + (components == 1 ? " component" : " components") +
      "; the crossings of Trajectory Collector are wanted");
  }
  return array;
}

std::vector<CollectorLine> linesOf(vtkFieldData* field, std::size_t input)
{
  auto* names = vtkStringArray::SafeDownCast(field->GetAbstractArray("CollectorLineName"));
  vtkDataArray* barriers = crossingNumbers(field, "CollectorBarrier", 2, input);
  if (!names || names->GetNumberOfValues() != barriers->GetNumberOfTuples())
  {
    throw DataError(numbered(input) +
      " has no array CollectorLineName of all lines; the crossings of Trajectory Collector are "
      "wanted");
  }
  vtkDataArray* offsets = field->GetArray("CollectorOffset"); // not of earlier versions
  const bool known = offsets && offsets->GetNumberOfTuples() == names->GetNumberOfValues();
  std::vector<CollectorLine> lines;
  for (vtkIdType k = 0; k < names->GetNumberOfValues(); ++k)
  {
    CollectorLine& line = lines.emplace_back();
    line.name = names->GetValue(k);
    line.barrierHeight = barriers->GetComponent(k, 0);
    line.barrierCapacity = barriers->GetComponent(k, 1) * 1000.0;
    line.offset = known ? offsets->GetComponent(k, 0) : 0.0;
  }
  return lines;
}

bool same(const std::vector<CollectorLine>& a, const std::vector<CollectorLine>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
    [](const CollectorLine& one, const CollectorLine& other)
    {
      return std::tie(one.name, one.barrierHeight, one.barrierCapacity, one.offset) ==
        std::tie(other.name, other.barrierHeight, other.barrierCapacity, other.offset);
    });
}

RunOrigin originOf(vtkPolyData* input)
{
  const auto text = [input](const char* name)
  {
    auto* array = vtkStringArray::SafeDownCast(input->GetFieldData()->GetAbstractArray(name));
    return array && array->GetNumberOfValues() == 1 ? std::string(array->GetValue(0))
                                                    : std::string();
  };
  RunOrigin run{ 0, text(kCollectorRun) };
  const std::string slope = text(kCollectorSlope);
  std::from_chars(slope.data(), slope.data() + slope.size(), run.slope, 16);
  return run;
}

struct Place
{
  Crossing crossing;
  std::size_t input;
  vtkIdType id;
};

auto key(const Place& p)
{
  const Crossing& c = p.crossing;
  return std::tie(c.iteration, c.rock, c.blockId, c.piece, c.line, c.number);
}

void appendPlaces(vtkPolyData* data, std::size_t input, const std::vector<CollectorLine>& lines,
  std::vector<Place>& places)
{
  vtkPointData* fields = data->GetPointData();
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray("LineName"));
  const auto one = [&](const char* name) { return crossingNumbers(fields, name, 1, input); };
  vtkDataArray *line = one("Line"), *iteration = one("Iteration"), *rock = one("RockId"),
               *block = one("BlockId"), *number = one("Passing"), *energy = one("KineticEnergy"),
               *height = one("HeightOverGround"),
               *velocity = crossingNumbers(fields, "Velocity", 3, input),
               *piece = fields->GetArray("Piece"), *frequency = fields->GetArray("Frequency");
  vtkDataArray* top = fields->GetArray("TopHeight");
  if (!top)
  {
    throw DataError(numbered(input) +
      " has no array TopHeight: the crossings were made by an earlier version; make them anew");
  }
  for (vtkIdType id = 0; id < data->GetNumberOfPoints(); ++id)
  {
    Place& place = places.emplace_back();
    place.input = input;
    place.id = id;
    Crossing& c = place.crossing;
    c.line = int(line->GetTuple1(id));
    c.iteration = int(iteration->GetTuple1(id));
    c.rock = int(rock->GetTuple1(id));
    c.blockId = std::int64_t(block->GetTuple1(id));
    c.piece = piece ? int(piece->GetTuple1(id)) : 0;
    c.number = int(number->GetTuple1(id));
    c.kineticEnergy = energy->GetTuple1(id);
    c.heightOverGround = height->GetTuple1(id);
    c.top = top->GetTuple1(id);
    c.frequency = frequency ? frequency->GetTuple1(id) : c.frequency;
    velocity->GetTuple(id, c.velocity.data());
    if (c.line < 0 || std::size_t(c.line) >= lines.size())
    {
      throw DataError(numbered(input) + " has a crossing of line " + std::to_string(c.line) +
        ", but only " + std::to_string(lines.size()) + " lines");
    }
    // Crossings of another collector, appended to these, count lines of their own.
    if (names && names->GetValue(id) != lines[std::size_t(c.line)].name)
    {
      throw DataError(numbered(input) + " has a crossing of line " + std::to_string(c.line) +
        " called \"" + names->GetValue(id) + "\", but its line of that number is \"" +
        lines[std::size_t(c.line)].name + "\": were crossings of several collectors appended?");
    }
  }
}

ReleasedRocks releasedOf(vtkFieldData* field, std::size_t input)
{
  ReleasedRocks rocks;
  vtkDataArray* released = crossingNumbers(field, "CollectorRocks", 2, input);
  vtkDataArray* blocks = crossingNumbers(field, "CollectorBlocks", 1, input);
  vtkDataArray* losses = crossingNumbers(field, "CollectorLosses", 1, input);
  vtkDataArray* ends = crossingNumbers(field, "CollectorEnds", 1, input);
  for (vtkDataArray* array : { blocks, losses, ends })
  {
    if (array->GetNumberOfTuples() != released->GetNumberOfTuples())
    {
      throw DataError(numbered(input) + " has " + std::to_string(array->GetNumberOfTuples()) +
        " values of " + array->GetName() + " for " + std::to_string(released->GetNumberOfTuples()) +
        " rocks");
    }
  }
  vtkDataArray* frequencies = field->GetArray(kCollectorFrequencies); // not of earlier versions
  const bool known = frequencies && frequencies->GetNumberOfTuples() == blocks->GetNumberOfTuples();
  for (vtkIdType i = 0; i < released->GetNumberOfTuples(); ++i)
  {
    rocks.push_back({ int(released->GetComponent(i, 0)), int(released->GetComponent(i, 1)),
      std::int64_t(blocks->GetTuple1(i)), Loss(int(losses->GetTuple1(i))), ends->GetTuple1(i),
      known ? frequencies->GetTuple1(i) : std::numeric_limits<double>::quiet_NaN() });
  }
  checkReleased(rocks);
  return rocks;
}

/// ParaView's filters that put crossings together keep the rocks of only one collector: shares of
/// those would be of too few.
void requireReleased(
  std::span<const Place> places, const ReleasedRocks& released, std::size_t input)
{
  for (const Place& place : places)
  {
    const Crossing& c = place.crossing;
    if (!isReleased(released, c))
    {
      throw DataError(numbered(input) + " has a crossing of rock " + std::to_string(c.rock) +
        " (block " + std::to_string(c.blockId) + ") of iteration " + std::to_string(c.iteration) +
        ", which is not among the rocks of its collector: were crossings of several collectors "
        "appended? Merge Collectors puts them together");
    }
  }
}

/// Frequencies of some rocks only would be as if the others never fell.
void requireAlikeFrequencies(vtkPolyData* first, vtkPolyData* other, std::size_t input)
{
  const auto has = [](vtkPolyData* data)
  { return data->GetPointData()->GetArray("Frequency") != nullptr; };
  if (has(first) != has(other))
  {
    throw DataError(numbered(input) + "'s crossings have " +
      (has(other) ? "a Frequency, those before have none: "
                  : "no Frequency, those before have one: ") +
      "of rocks together all frequencies are known, or none");
  }
}

/// Notes on the run of a collector's crossings, and on crossings that are no longer all.
std::vector<std::string> doubtsOf(vtkPolyData* crossings, const std::string& name)
{
  std::vector<std::string> doubts = doubtsOfRun(crossings->GetFieldData());
  vtkDataArray* made = crossings->GetFieldData()->GetArray(kCollectorCrossings);
  if (made && made->GetNumberOfTuples() == 1 &&
    crossings->GetNumberOfPoints() < made->GetComponent(0, 0))
  {
    doubts.push_back("The Input has " + std::to_string(crossings->GetNumberOfPoints()) +
      " of the " + std::to_string(std::int64_t(made->GetComponent(0, 0))) +
      " crossings of its collector: rocks that are left out count as not having come");
  }
  for (std::string& doubt : doubts)
  {
    doubt = name + doubt;
  }
  return doubts;
}

/// The point arrays of the inputs that have points, in the order of `places`.
void copyArrays(std::span<vtkPolyData* const> inputs, std::span<const Place> places,
  vtkFieldData* pattern, vtkPointData* output)
{
  std::vector<vtkAbstractArray*> from(inputs.size());
  for (int k = 0; k < pattern->GetNumberOfArrays(); ++k)
  {
    vtkAbstractArray* like = pattern->GetAbstractArray(k);
    for (std::size_t input = 0; input < inputs.size(); ++input)
    {
      from[input] = inputs[input]->GetPointData()->GetAbstractArray(like->GetName());
      if (inputs[input]->GetNumberOfPoints() > 0 &&
        (!from[input] || from[input]->GetDataType() != like->GetDataType() ||
          from[input]->GetNumberOfComponents() != like->GetNumberOfComponents()))
      {
        throw DataError(
          numbered(input) + " has no point array " + like->GetName() + " as the first has it");
      }
    }
    auto array = vtk::TakeSmartPointer(like->NewInstance());
    array->SetName(like->GetName());
    array->SetNumberOfComponents(like->GetNumberOfComponents());
    array->SetNumberOfTuples(vtkIdType(places.size()));
    for (std::size_t to = 0; to < places.size(); ++to)
    {
      array->SetTuple(vtkIdType(to), places[to].id, from[places[to].input]);
    }
    output->AddArray(array);
  }
}

} // namespace

MergedCrossings mergeCrossings(std::span<vtkPolyData* const> inputs, vtkPolyData* output)
{
  MergedCrossings merged;
  ReleasedRocks rocks;
  std::vector<RunOrigin> runs;
  std::vector<Place> places;
  vtkPolyData* pattern = nullptr; // the first that has points, or the first
  const vtkIdType all = std::accumulate(inputs.begin(), inputs.end(), vtkIdType(0),
    [](vtkIdType sum, vtkPolyData* input) { return sum + input->GetNumberOfPoints(); });
  places.reserve(std::size_t(all)); // of millions no second copy
  merged.crossings.reserve(std::size_t(all));
  for (std::size_t k = 0; k < inputs.size(); ++k)
  {
    vtkFieldData* field = inputs[k]->GetFieldData();
    std::vector<CollectorLine> lines = linesOf(field, k);
    if (k == 0)
    {
      merged.lines = lines;
    }
    if (!same(lines, merged.lines))
    {
      throw DataError(numbered(k) + " has other lines or barriers than the first");
    }
    if (readCrs(field) != readCrs(inputs[0]->GetFieldData()))
    {
      throw DataError(numbered(k) + " has another CRS than the first");
    }
    runs.push_back(originOf(inputs[k]));
    std::ranges::move(doubtsOf(inputs[k], inputs.size() > 1 ? partName(k) + ": " : ""),
      std::back_inserter(merged.notes));
    const ReleasedRocks released = releasedOf(field, k);
    if (inputs[k]->GetNumberOfPoints() > 0)
    {
      const std::size_t first = places.size();
      appendPlaces(inputs[k], k, lines, places);
      requireReleased(std::span(places).subspan(first), released, k);
      pattern = pattern ? pattern : inputs[k];
      requireAlikeFrequencies(pattern, inputs[k], k);
    }
    rocks.insert(rocks.end(), released.begin(), released.end());
  }
  checkReleased(rocks);
  std::ranges::move(askAfterRuns(runs, [](std::size_t k) { return partName(k); }),
    std::back_inserter(merged.notes));
  merged.released = rocks;
  std::sort(
    places.begin(), places.end(), [](const Place& a, const Place& b) { return key(a) < key(b); });
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(vtkIdType(places.size()));
  vtkNew<vtkCellArray> vertices;
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    const Crossing& c = places[k].crossing;
    if (k > 0 && key(places[k - 1]) == key(places[k]))
    {
      throw DataError("A crossing of rock " + std::to_string(c.rock) + " of iteration " +
        std::to_string(c.iteration) + " is there twice");
    }
    double place[3];
    inputs[places[k].input]->GetPoint(places[k].id, place);
    const auto id = vtkIdType(k);
    points->SetPoint(id, place);
    vertices->InsertNextCell(1, &id);
    merged.crossings.push_back(c);
  }
  merged.releases = releasesOf(rocks, merged.crossings);
  weigh(merged.releases, merged.crossings);
  for (std::string& note : copyNotes(merged.releases, merged.crossings))
  {
    // Of crossings that were merged before it has been told.
    if (std::ranges::find(merged.notes, note) == merged.notes.end())
    {
      merged.notes.push_back(std::move(note));
    }
  }
  copyArrays(
    inputs, places, (pattern ? pattern : inputs[0])->GetPointData(), output->GetPointData());
  output->SetPoints(points);
  output->SetVerts(vertices);
  vtkFieldData* field = output->GetFieldData();
  for (const char* name :
    { "CollectorLineName", "CollectorBarrier", "CollectorOffset", kCollectorSlope, kCollectorRun })
  {
    if (vtkAbstractArray* array = inputs[0]->GetFieldData()->GetAbstractArray(name))
    {
      field->AddArray(array);
    }
  }
  addTexts(field, kRunDoubts, merged.notes);
  writeReleased(rocks, places.size(), field);
  copyCoordinateSystem(inputs[0]->GetFieldData(), field);
  return merged;
}

} // namespace rockfall::filters
