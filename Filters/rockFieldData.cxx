#include "rockFieldData.h"

#include "arrays.h"
#include "base/errors.h"
#include "geometry/shell.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <cmath>
#include <map>

namespace rockfall::filters
{

namespace
{

/// The polygons of one block.
struct Faces
{
  std::int64_t blockId = 0;
  vtkIdType firstCell = 0; ///< Its cell data are the block's.
  std::vector<Vec3> points;
  std::vector<std::vector<int>> loops;
  std::map<vtkIdType, int> numbers; ///< From the polydata's points to `points`.
};

std::vector<Faces> groupByBlock(vtkPolyData* input, const Vec3& origin)
{
  vtkDataArray* blockIds = input->GetCellData()->GetArray("BlockId");
  // A polydata's cells are its vertices, its lines, its polygons and its strips, in this order.
  vtkIdType cell = input->GetNumberOfVerts() + input->GetNumberOfLines();
  std::vector<Faces> blocks;
  std::map<std::int64_t, std::size_t> index;
  auto polygons = vtk::TakeSmartPointer(input->GetPolys()->NewIterator());
  for (polygons->GoToFirstCell(); !polygons->IsDoneWithTraversal();
       polygons->GoToNextCell(), ++cell)
  {
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
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    polygons->GetCurrentCell(size, ids);
    std::vector<int>& loop = block.loops.emplace_back();
    for (vtkIdType k = 0; k < size; ++k)
    {
      const auto number = block.numbers.emplace(ids[k], int(block.points.size()));
      if (number.second)
      {
        Vec3 p;
        input->GetPoint(ids[k], p.data());
        block.points.push_back(p - origin);
      }
      loop.push_back(number.first->second);
    }
  }
  return blocks;
}

void readNumber(vtkPolyData* input, const char* name, vtkIdType cell, double& value)
{
  if (vtkDataArray* array = input->GetCellData()->GetArray(name))
  {
    value = array->GetComponent(cell, 0);
  }
}

void readVector(vtkPolyData* input, const char* name, vtkIdType cell, Vec3& value)
{
  vtkDataArray* array = input->GetCellData()->GetArray(name);
  if (!array)
  {
    return;
  }
  if (array->GetNumberOfComponents() != 3)
  {
    throw DataError("The Rocks input's cell array " + std::string(name) + " has " +
      std::to_string(array->GetNumberOfComponents()) + " components, it must have 3");
  }
  array->GetTuple(cell, value.data());
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
  vtkFieldData* cells = output->GetCellData();
  const auto blockId = addArray<vtkIdTypeArray>(cells, "BlockId");
  const auto density = addArray<vtkDoubleArray>(cells, "Density");
  const auto volume = addArray<vtkDoubleArray>(cells, "Volume");
  const auto young = addArray<vtkDoubleArray>(cells, "YoungModulus");
  const auto poisson = addArray<vtkDoubleArray>(cells, "PoissonRatio");
  const auto velocity = addArray<vtkDoubleArray>(cells, "Velocity", 3);
  const auto rotation = addArray<vtkDoubleArray>(cells, "AngularVelocity", 3);
  const auto shape = addArray<vtkIntArray>(cells, "Shape");
  vtkNew<vtkStringArray> names;
  names->SetName("ShapeName");
  for (const ReleasedRock& released : rocks)
  {
    const Rock& rock = released.rock;
    appendFaces(rock.shape, rock.orientation.toRotationMatrix(), rock.position, points, polygons);
    for (std::size_t face = 0; face < rock.shape.faces().size(); ++face)
    {
      blockId->InsertNextValue(rock.blockId);
      density->InsertNextValue(rock.density);
      volume->InsertNextValue(rock.shape.integrals().volume);
      young->InsertNextValue(rock.youngModulus);
      poisson->InsertNextValue(rock.poissonRatio);
      velocity->InsertNextTuple(rock.velocity.data());
      rotation->InsertNextTuple(rock.angularVelocity.data());
      shape->InsertNextValue(int(released.shape));
    }
    names->InsertNextValue(shapeName(released.shape));
  }
  output->SetPoints(points);
  output->SetPolys(polygons);
  output->GetFieldData()->AddArray(names);
}

std::vector<ReleasedRock> readRocks(vtkPolyData* input, const Vec3& origin)
{
  if (input->GetNumberOfPolys() == 0)
  {
    throw DataError("The Rocks input has no polygons, so there is no rock in it");
  }
  std::vector<ReleasedRock> rocks;
  for (const Faces& block : groupByBlock(input, origin))
  {
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
    Rock& rock = released.rock;
    rock.blockId = block.blockId;
    rock.position = placed.integrals().centroid;
    rock.shape = placed.centred();
    readNumber(input, "Density", block.firstCell, rock.density);
    readNumber(input, "YoungModulus", block.firstCell, rock.youngModulus);
    readNumber(input, "PoissonRatio", block.firstCell, rock.poissonRatio);
    readVector(input, "Velocity", block.firstCell, rock.velocity);
    readVector(input, "AngularVelocity", block.firstCell, rock.angularVelocity);
    double shape = double(Shape::File);
    readNumber(input, "Shape", block.firstCell, shape);
    if (shape >= double(Shape::Cube) && shape <= double(Shape::File))
    {
      released.shape = Shape(int(shape));
    }
    rocks.push_back(std::move(released));
  }
  return rocks;
}

} // namespace rockfall::filters
