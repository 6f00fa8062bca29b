#include "shared/rockFieldData.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/shapes.h"
#include "geometry/shell.h"
#include "mesh/precision.h"
#include "shared/cells.h"
#include "shared/columns.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace rockfall::filters
{

namespace
{

constexpr const char* kNamedBlock = "NamedBlock";

/// The polygons of one block.
struct Faces
{
  std::int64_t blockId = 0;
  vtkIdType firstCell = 0; ///< The one whose cell data are the block's.
  std::vector<vtkIdType> furtherCells;
  std::vector<Vec3> points;
  std::vector<std::vector<int>> loops;
  std::map<vtkIdType, int> numbers; ///< From the polydata's points to `points`.
};

/// In world coordinates.
std::vector<Faces> groupByBlock(vtkPolyData* input)
{
  vtkDataArray* blockIds = input->GetCellData()->GetArray("BlockId");
  // A polydata's cells are its vertices, its lines, its polygons and its strips, in this order.
  const vtkIdType first = input->GetNumberOfVerts() + input->GetNumberOfLines();
  std::vector<Faces> blocks;
  std::map<std::int64_t, std::size_t> index;
  forEachCell(input->GetPolys(), first,
    [&](vtkIdType cell, std::span<const vtkIdType> ids)
    {
      stayWanted();
      double id = 0.0;
      if (blockIds)
      {
        id = blockIds->GetComponent(cell, 0);
        if (!(std::abs(id) < 0x1p53) || id != std::floor(id))
        {
          throw DataError("The Rocks input's BlockId of cell " + std::to_string(cell) + " is " +
            numberText(id) + ", it must be a whole number");
        }
      }
      const auto place = index.emplace(std::int64_t(id), blocks.size());
      if (place.second)
      {
        blocks.emplace_back();
        blocks.back().blockId = std::int64_t(id);
        blocks.back().firstCell = cell;
      }
      Faces& block = blocks[place.first->second];
      if (!place.second)
      {
        block.furtherCells.push_back(cell);
      }
      std::vector<int>& loop = block.loops.emplace_back();
      for (const vtkIdType point : ids)
      {
        const auto number = block.numbers.emplace(point, int(block.points.size()));
        if (number.second)
        {
          Vec3 p;
          input->GetPoint(point, p.data());
          block.points.push_back(p);
        }
        loop.push_back(number.first->second);
      }
    });
  return blocks;
}

/// Sources of shapes and readers of meshes make single precision: a box is 0.44 m³ instead of 0.82
/// then at a northing of 5,200,000 m.
void checkBlockPrecision(vtkPolyData* input, const Faces& block)
{
  if (input->GetPoints()->GetDataType() == VTK_FLOAT || lookSingle(block.points))
  {
    checkRounding(block.points, singleRounding(largestCoordinate(block.points)),
      "The Rocks input's block " + std::to_string(block.blockId), "in single precision",
      "Take Rock Blocks instead, whose Shape may be a file saved near the origin and whose Center "
      "is its place, or a source of double precision");
  }
}

/// Values that are read of a block's cells, one for all of them.
constexpr const char* kOfBlocks[] = { "Density", "YoungModulus", "PoissonRatio", "Material",
  "Velocity", "AngularVelocity", "Shape", "SourceId", "SourceName", "Frequency", "State",
  "PositionDeviation", "AttitudeLaw", "AttitudeDeviation", "VolumeLaw", "VolumeParameters" };

/// Throws DataError where two cells of a block say different things of it.
void checkOneBlock(vtkPolyData* input, const Faces& block)
{
  for (const char* name : kOfBlocks)
  {
    vtkAbstractArray* array = input->GetCellData()->GetAbstractArray(name);
    auto* numbers = vtkDataArray::SafeDownCast(array);
    auto* names = vtkStringArray::SafeDownCast(array);
    const auto refuse = [&](const std::string& one, const std::string& other, vtkIdType cell)
    {
      throw DataError("The Rocks input's cell array " + std::string(name) + " has " + one +
        " in cell " + std::to_string(block.firstCell) + " and " + other + " in cell " +
        std::to_string(cell) + ", which both are of block " + std::to_string(block.blockId));
    };
    for (const vtkIdType cell : block.furtherCells)
    {
      for (int k = 0; numbers && k < numbers->GetNumberOfComponents(); ++k)
      {
        const double one = numbers->GetComponent(block.firstCell, k),
                     other = numbers->GetComponent(cell, k);
        if (one != other && !(std::isnan(one) && std::isnan(other)))
        {
          refuse(numberText(one), numberText(other), cell);
        }
      }
      if (names && names->GetValue(block.firstCell) != names->GetValue(cell))
      {
        refuse(names->GetValue(block.firstCell), names->GetValue(cell), cell);
      }
    }
  }
}

void readNumber(vtkPolyData* input, const char* name, vtkIdType cell, double& value)
{
  if (vtkDataArray* array = input->GetCellData()->GetArray(name))
  {
    value = array->GetComponent(cell, 0);
  }
}

/// The names of blocks that field arrays hold.
class NamesRead
{
public:
  explicit NamesRead(vtkPolyData* input)
  {
    vtkFieldData* field = input->GetFieldData();
    vtkDataArray* blocks = field->GetArray(kNamedBlock);
    for (const char* name : { "Material", "SourceName" })
    {
      auto* names = vtkStringArray::SafeDownCast(field->GetAbstractArray(name));
      if (!blocks || !names)
      {
        continue;
      }
      if (names->GetNumberOfValues() != blocks->GetNumberOfTuples())
      {
        throw DataError("The Rocks input's field array " + std::string(name) + " has " +
          std::to_string(names->GetNumberOfValues()) + " values, it must have " +
          std::to_string(blocks->GetNumberOfTuples()) + ", as many as NamedBlock");
      }
      for (vtkIdType k = 0; k < names->GetNumberOfValues(); ++k)
      {
        names_[name].try_emplace(blocks->GetComponent(k, 0), names->GetValue(k));
      }
    }
  }

  /// Empty if the block has none.
  std::string of(const char* name, std::int64_t block) const
  {
    const auto names = names_.find(name);
    if (names == names_.end())
    {
      return {};
    }
    const auto found = names->second.find(double(block));
    return found == names->second.end() ? std::string() : found->second;
  }

private:
  std::map<std::string, std::map<double, std::string>> names_; ///< By array and block.
};

/// A name, of which a number will do; that of the block's entry in `others` if there is no such cell
/// array.
std::string nameOf(
  vtkPolyData* input, const char* name, const Faces& block, const NamesRead& others)
{
  const vtkIdType cell = block.firstCell;
  vtkAbstractArray* array = input->GetCellData()->GetAbstractArray(name);
  if (auto* names = vtkStringArray::SafeDownCast(array))
  {
    return names->GetValue(cell);
  }
  auto* numbers = vtkDataArray::SafeDownCast(array);
  return numbers ? numberText(numbers->GetComponent(cell, 0)) : others.of(name, block.blockId);
}

/// A whole number of an enumeration, as a double that its own check can refuse.
template <typename Law>
void readLaw(vtkPolyData* input, const char* name, vtkIdType cell, Law& law)
{
  double value = double(law);
  readNumber(input, name, cell, value);
  if (!(std::abs(value) < 1e6) || value != std::floor(value))
  {
    throw DataError("The Rocks input's cell array " + std::string(name) + " has " +
      numberText(value) + ", it must be a whole number");
  }
  law = Law(int(value));
}

/// The components of an array, if it is there, into these numbers.
void readTuple(
  vtkPolyData* input, const char* name, vtkIdType cell, std::initializer_list<double*> values)
{
  vtkDataArray* array = input->GetCellData()->GetArray(name);
  if (!array)
  {
    return;
  }
  if (array->GetNumberOfComponents() != int(values.size()))
  {
    throw DataError("The Rocks input's cell array " + std::string(name) + " has " +
      std::to_string(array->GetNumberOfComponents()) + " components, it must have " +
      std::to_string(values.size()));
  }
  int component = 0;
  for (double* value : values)
  {
    *value = array->GetComponent(cell, component++);
  }
}

void readUncertainty(vtkPolyData* input, vtkIdType cell, ReleaseUncertainty& unsure)
{
  readTuple(
    input, "PositionDeviation", cell, { &unsure.horizontalDeviation, &unsure.verticalDeviation });
  readLaw(input, "AttitudeLaw", cell, unsure.attitude);
  double angle = 0.0;
  readNumber(input, "AttitudeDeviation", cell, angle);
  unsure.attitudeDeviation = radians(angle);
  VolumeDistribution& v = unsure.volume;
  readLaw(input, "VolumeLaw", cell, v.law);
  readTuple(input, "VolumeParameters", cell,
    { &v.mean, &v.deviation, &v.minimum, &v.maximum, &v.exponent });
}

using R = const ReleasedRock&;

/// Adds what is drawn in each iteration.
void addUncertainty(Columns<ReleasedRock>& columns)
{
  const auto of = [](R r) -> const ReleaseUncertainty& { return r.rock.uncertainty; };
  columns.add("PositionDeviation",
    [of](R r) {
      return std::array{ of(r).horizontalDeviation, of(r).verticalDeviation };
    });
  columns.add("AttitudeDeviation", [of](R r) { return degrees(of(r).attitudeDeviation); });
  columns.add("VolumeParameters",
    [of](R r)
    {
      const VolumeDistribution& v = of(r).volume;
      return std::array{ v.mean, v.deviation, v.minimum, v.maximum, v.exponent };
    });
  columns.add("AttitudeLaw", [of](R r) { return int(of(r).attitude); });
  columns.add("VolumeLaw", [of](R r) { return int(of(r).volume.law); });
}

} // namespace

void appendFaces(const Polyhedron& shape, const Mat3& rotation, const Vec3& shift,
  vtkPoints* points, vtkCellArray* polygons)
{
  const vtkIdType first = points->GetNumberOfPoints();
  for (const Vec3& vertex : shape.vertices())
  {
    const Vec3 world = rotation * vertex + shift;
    points->InsertNextPoint(world.data());
  }
  for (const std::vector<int>& loop : shape.faces())
  {
    polygons->InsertNextCell(int(loop.size()));
    for (int vertex : loop)
    {
      polygons->InsertCellPoint(first + vertex);
    }
  }
}

void writeRocks(std::span<const ReleasedRock> rocks, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  Columns<ReleasedRock> columns(output->GetCellData());
  columns.add("BlockId", [](R r) { return r.rock.blockId; });
  columns.add("Density", [](R r) { return r.rock.density; });
  columns.add("Volume", [](R r) { return r.rock.shape.integrals().volume; });
  columns.add("YoungModulus", [](R r) { return r.rock.youngModulus; });
  columns.add("PoissonRatio", [](R r) { return r.rock.poissonRatio; });
  columns.add("Material", [](R r) { return r.rock.material; });
  columns.add("Velocity", [](R r) { return r.rock.velocity; });
  columns.add("AngularVelocity", [](R r) { return r.rock.angularVelocity; });
  columns.add("Shape", [](R r) { return int(r.shape); });
  columns.add("SourceId", [](R r) { return r.sourceId; });
  addUncertainty(columns);
  columns.add("SourceName", [](R r) { return r.sourceName; });
  // Of all rocks or none.
  if (!rocks.empty() &&
    std::none_of(rocks.begin(), rocks.end(), [](R r) { return std::isnan(r.frequency); }))
  {
    columns.add("Frequency", [](R r) { return r.frequency; });
  }
  const auto shapeNames = addArray<vtkStringArray>(output->GetFieldData(), "ShapeName");
  for (int number = 0; number < kShapes; ++number)
  {
    shapeNames->InsertNextValue(shapeName(Shape(number)));
  }
  for (const ReleasedRock& released : rocks)
  {
    stayWanted();
    const Rock& rock = released.rock;
    appendFaces(rock.shape, rock.orientation.toRotationMatrix(), rock.position, points, polygons);
    for (std::size_t face = 0; face < rock.shape.faces().size(); ++face)
    {
      columns.append(released);
    }
  }
  output->SetPoints(points);
  output->SetPolys(polygons);
}

BlockNames::BlockNames(vtkFieldData* field)
  : block_(addArray<vtkIdTypeArray>(field, kNamedBlock))
  , material_(addArray<vtkStringArray>(field, "Material"))
  , sourceName_(addArray<vtkStringArray>(field, "SourceName"))
{
}

BlockNames::~BlockNames() = default;

void BlockNames::append(const Rock& rock, const std::string& sourceName)
{
  block_->InsertNextValue(rock.blockId);
  material_->InsertNextValue(rock.material);
  sourceName_->InsertNextValue(sourceName);
}

std::set<std::int64_t> namedBlocks(vtkPolyData* input)
{
  std::set<std::int64_t> blocks;
  vtkDataArray* array = input->GetFieldData()->GetArray(kNamedBlock);
  for (vtkIdType k = 0; array && k < array->GetNumberOfTuples(); ++k)
  {
    blocks.insert(std::int64_t(array->GetComponent(k, 0)));
  }
  return blocks;
}

std::vector<ReleasedRock> readRocks(vtkPolyData* input, const Vec3& origin)
{
  if (input->GetNumberOfPolys() == 0)
  {
    throw DataError("The Rocks input has no polygons, so there is no rock in it");
  }
  std::vector<ReleasedRock> rocks;
  std::vector<Faces> blocks = groupByBlock(input);
  const NamesRead names(input);
  for (Faces& block : blocks)
  {
    stayWanted();
    checkBlockPrecision(input, block);
    for (Vec3& p : block.points)
    {
      p -= origin;
    }
    const std::string name = "block " + std::to_string(block.blockId);
    ReleasedRock released;
    Polyhedron placed;
    try
    {
      placed = Polyhedron::fromFaces(block.points, block.loops, name);
    }
    catch (const GeometryError& error)
    {
      // Sources appended without a thought to their numbers look like one block in pieces.
      throw GeometryError(std::string(error.what()) +
        (rocks.empty() && block.loops.size() < 4
            ? ""
            : ". (Where rock sources were appended, each needs its own First Block Id)"));
    }
    checkOneBlock(input, block);
    Rock& rock = released.rock;
    rock.blockId = block.blockId;
    rock.position = placed.integrals().centroid;
    rock.shape = placed.centred();
    readNumber(input, "Density", block.firstCell, rock.density);
    readNumber(input, "YoungModulus", block.firstCell, rock.youngModulus);
    readNumber(input, "PoissonRatio", block.firstCell, rock.poissonRatio);
    rock.material = nameOf(input, "Material", block, names);
    Vec3 &v = rock.velocity, &w = rock.angularVelocity;
    readTuple(input, "Velocity", block.firstCell, { &v.x(), &v.y(), &v.z() });
    readTuple(input, "AngularVelocity", block.firstCell, { &w.x(), &w.y(), &w.z() });
    double shape = double(Shape::File);
    readNumber(input, "Shape", block.firstCell, shape);
    if (shape >= 0.0 && shape < double(kShapes))
    {
      released.shape = Shape(int(shape));
    }
    readNumber(input, "Frequency", block.firstCell, released.frequency);
    if (released.frequency < 0.0)
    {
      throw DataError("The Rocks input's Frequency of " + name + " is " +
        numberText(released.frequency) + " per year, it must not be negative");
    }
    double state = -1.0;
    readNumber(input, "State", block.firstCell, state);
    released.state = int(state);
    readUncertainty(input, block.firstCell, rock.uncertainty);
    double source = 0.0;
    readNumber(input, "SourceId", block.firstCell, source);
    if (!(std::abs(source) < 0x1p53))
    {
      throw DataError("The Rocks input's SourceId of " + name + " is " + numberText(source) +
        ", it must be a whole number");
    }
    released.sourceId = std::int64_t(source);
    released.sourceName = nameOf(input, "SourceName", block, names);
    if (released.sourceName.empty())
    {
      released.sourceName = "source " + std::to_string(released.sourceId);
    }
    rocks.push_back(std::move(released));
  }
  return rocks;
}

} // namespace rockfall::filters
