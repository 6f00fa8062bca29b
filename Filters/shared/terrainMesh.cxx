#include "shared/terrainMesh.h"

#include "shared/arrays.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>

namespace rockfall::filters
{

namespace
{

/// Every stride-th node of a slope, from its north-west corner.
struct CoarseGrid
{
  const Terrain& terrain;
  int stride;
  int columns;
  int rows;

  CoarseGrid(const Terrain& slope, int step)
    : terrain(slope)
    , stride(step)
    , columns((slope.geometry().columns - 1) / step + 1)
    , rows((slope.geometry().rows - 1) / step + 1)
  {
  }

  double height(std::int64_t node) const
  {
    return this->terrain.nodeHeight(
      int(node / this->columns) * this->stride, int(node % this->columns) * this->stride);
  }

  /// Calls visit(number of the CFE, its three nodes here) for every triangle, in order of number.
  /// Numbering and cut are those of Terrain::cfeNodes.
  template <typename Visit>
  void forEachTriangle(Visit&& visit) const
  {
    const std::int64_t fullColumns = this->terrain.geometry().columns - 1;
    const auto known = [this](std::int64_t node) { return !std::isnan(this->height(node)); };
    for (int row = 0; row + 1 < this->rows; ++row)
    {
      for (int column = 0; column + 1 < this->columns; ++column)
      {
        const std::int64_t upperLeft = std::int64_t(row) * this->columns + column;
        const std::int64_t lowerLeft = upperLeft + this->columns;
        if (!known(upperLeft) || !known(lowerLeft + 1))
        {
          continue;
        }
        const std::int64_t number =
          2 * (std::int64_t(row) * this->stride * fullColumns + column * this->stride) + 1;
        if (isCutRising(this->terrain.geometry().diagonal, this->height(upperLeft),
              this->height(upperLeft + 1), this->height(lowerLeft), this->height(lowerLeft + 1)))
        {
          visit(number, { lowerLeft, lowerLeft + 1, upperLeft + 1 });
          visit(number + 1, { upperLeft, lowerLeft, upperLeft + 1 });
          continue;
        }
        if (known(lowerLeft))
        {
          visit(number, { upperLeft, lowerLeft, lowerLeft + 1 });
        }
        if (known(upperLeft + 1))
        {
          visit(number + 1, { upperLeft, lowerLeft + 1, upperLeft + 1 });
        }
      }
    }
  }
};

using Corners = std::array<std::int64_t, 3>;

/// The class of each triangle and a number of its material.
template <typename Value>
void addMaterialArrays(vtkPolyData* mesh, vtkIdTypeArray* cfes, const MaterialClasses& classes,
  const char* className, const char* valueName, Value&& valueOf)
{
  const vtkIdType triangles = cfes->GetNumberOfValues();
  std::vector<double> ofClass;
  for (int number = 0; number <= classes.count(); ++number)
  {
    ofClass.push_back(valueOf(number));
  }
  const auto values = addArray<vtkDoubleArray>(mesh->GetCellData(), valueName);
  values->SetNumberOfValues(triangles);
  const auto numbers = addArray<vtkUnsignedCharArray>(mesh->GetCellData(), className);
  numbers->SetNumberOfValues(triangles);
  for (vtkIdType cell = 0; cell < triangles; ++cell)
  {
    const int number = classes.at(cfes->GetValue(cell));
    numbers->SetValue(cell, static_cast<unsigned char>(number));
    values->SetValue(cell, ofClass[std::size_t(number)]);
  }
}

} // namespace

int displayStride(const Terrain& terrain, std::int64_t maximum)
{
  const GridGeometry& grid = terrain.geometry();
  const int largest = std::min(grid.columns, grid.rows) - 1; // at least one row of cells remains
  int stride = 1;
  while (stride < largest &&
    2 * (std::int64_t(grid.columns - 1) / stride) * ((grid.rows - 1) / stride) > maximum)
  {
    ++stride;
  }
  return stride;
}

std::int64_t countTriangles(const Terrain& terrain, int stride)
{
  std::int64_t count = 0;
  CoarseGrid(terrain, stride).forEachTriangle([&](std::int64_t, const Corners&) { ++count; });
  return count;
}

void makeTerrainMesh(const Terrain& terrain, int stride, vtkPolyData* mesh)
{
  const CoarseGrid coarse(terrain, stride);
  const GridGeometry& grid = terrain.geometry();

  // Nodes that are used, then their point numbers.
  std::vector<vtkIdType> pointOf(std::size_t(coarse.columns) * coarse.rows, -1);
  vtkIdType triangles = 0;
  coarse.forEachTriangle(
    [&](std::int64_t, const Corners& nodes)
    {
      ++triangles;
      for (std::int64_t node : nodes)
      {
        pointOf[std::size_t(node)] = 0;
      }
    });
  vtkIdType used = 0;
  for (vtkIdType& point : pointOf)
  {
    point = point < 0 ? -1 : used++;
  }

  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(used);
  vtkNew<vtkDoubleArray> elevation;
  elevation->SetName("Elevation");
  elevation->SetNumberOfValues(used);
  for (std::int64_t node = 0; node < std::int64_t(pointOf.size()); ++node)
  {
    const vtkIdType point = pointOf[std::size_t(node)];
    if (point >= 0)
    {
      const Vec3 world =
        terrain.node(int(node / coarse.columns) * stride, int(node % coarse.columns) * stride) +
        grid.origin();
      points->SetPoint(point, world.data());
      elevation->SetValue(point, world.z());
    }
  }

  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(triangles + 1);
  vtkNew<vtkIdTypeArray> connectivity;
  connectivity->SetNumberOfValues(3 * triangles);
  const auto numbers = addArray<vtkIdTypeArray>(mesh->GetCellData(), "CFEId");
  numbers->SetNumberOfValues(triangles);
  vtkIdType cell = 0;
  coarse.forEachTriangle(
    [&](std::int64_t number, const Corners& nodes)
    {
      offsets->SetValue(cell, 3 * cell);
      numbers->SetValue(cell, number);
      for (int corner = 0; corner < 3; ++corner)
      {
        connectivity->SetValue(3 * cell + corner, pointOf[std::size_t(nodes[corner])]);
      }
      ++cell;
    });
  offsets->SetValue(triangles, 3 * triangles);
  vtkNew<vtkCellArray> polygons;
  polygons->SetData(offsets, connectivity);

  mesh->SetPoints(points);
  mesh->SetPolys(polygons);
  mesh->GetPointData()->SetScalars(elevation);
  addMaterialArrays(mesh, numbers, terrain.restitutionClasses(), "RestitutionClass",
    "RestitutionCoefficient",
    [&](int number) { return terrain.restitutionMaterial(number).restitution; });
  addMaterialArrays(mesh, numbers, terrain.jointClasses(), "JointClass", "FrictionAngle",
    [&](int number) { return degrees(terrain.jointMaterial(number).frictionAngle); });
}

} // namespace rockfall::filters
