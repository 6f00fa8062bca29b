#include "shared/terrainFieldData.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/shell.h"
#include "shared/arrays.h"
#include "shared/roughnessFieldData.h"
#include "shared/slopeReference.h"
#include "shared/structureFieldData.h"
#include "shared/terrainMesh.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall::filters
{

namespace
{

constexpr char materialName[] = "TerrainMaterial";
constexpr char yieldingName[] = "TerrainYielding";

/// Names of the arrays of the two kinds of classes.
struct ClassNames
{
  const char* cells;
  const char* numbers;
  const char* names;
};
constexpr ClassNames restitutionNames = { "TerrainRestitutionClass", "TerrainRestitutionClasses",
  "TerrainRestitutionNames" };
constexpr ClassNames jointNames = { "TerrainJointClass", "TerrainJointClasses",
  "TerrainJointNames" };

/// An array over memory that somebody else owns and that it keeps alive. Deep copies and
/// NewInstance give a plain array.
template <class Base, typename Value>
class Shared : public Base
{
public:
  static Shared* New() { VTK_STANDARD_NEW_BODY(Shared); }
  void Share(std::shared_ptr<const Terrain> terrain, std::span<const Value> values)
  {
    // VTK knows no array over constant memory; nothing in a pipeline writes into its input.
    this->SetArray(const_cast<Value*>(values.data()), vtkIdType(values.size()), 1);
    this->Owner = std::move(terrain);
  }

protected:
  Shared() = default;
  ~Shared() override = default;

private:
  std::shared_ptr<const Terrain> Owner;
};
using SharedHeights = Shared<vtkDoubleArray, double>;
using SharedClasses = Shared<vtkUnsignedCharArray, std::uint8_t>;

void addNumbers(vtkFieldData* fieldData, const char* name, std::initializer_list<double> values)
{
  addArray<vtkDoubleArray>(fieldData, name, int(values.size()))->InsertNextTuple(values.begin());
}

constexpr int materialNumbers = 10;
constexpr int materialNumbersOnce = 7; ///< Before there was a choice of restitution models.

/// The numbers of a small array, however they are arranged in tuples. `count` is how many it has,
/// `orCount` how many it may have instead.
std::vector<double> numbers(vtkFieldData* fieldData, const char* name, int count, int orCount = -1)
{
  vtkDataArray* array = fieldData->GetArray(name);
  if (!array || (array->GetNumberOfValues() != count && array->GetNumberOfValues() != orCount))
  {
    throw DataError(
      "The Terrain input must come from DEM to CFE Mesh, directly or from a file saved "
      "from it: its field data has no array " +
      std::string(name) + " of " + std::to_string(count) + " numbers");
  }
  std::vector<double> values;
  for (vtkIdType tuple = 0; tuple < array->GetNumberOfTuples(); ++tuple)
  {
    for (int component = 0; component < array->GetNumberOfComponents(); ++component)
    {
      values.push_back(array->GetComponent(tuple, component));
      if (!std::isfinite(values.back()))
      {
        throw DataError("The Terrain input's field array " + std::string(name) + " has " +
          numberText(values.back()) + " at place " + std::to_string(values.size() - 1) +
          ", it must be finite");
      }
    }
  }
  return values;
}

int gridCount(double value, const char* what)
{
  if (!(value >= 1.0 && value <= std::numeric_limits<int>::max()))
  {
    throw DataError("The Terrain input's field array TerrainGrid says " + numberText(value) + " " +
      what + ", it must be a count");
  }
  return int(std::lround(value));
}

struct ShownGrid
{
  GridGeometry grid;
  int stride = 1; ///< Of the shown mesh.
};

ShownGrid readGrid(vtkFieldData* fieldData)
{
  const std::vector<double> g = numbers(fieldData, kGridArray, 6);
  ShownGrid shown;
  shown.grid.columns = gridCount(g[0], "columns");
  shown.grid.rows = gridCount(g[1], "rows");
  shown.grid.cellSize = g[2];
  shown.grid.xOrigin = g[3];
  shown.grid.yOrigin = g[4];
  shown.stride = gridCount(g[5], "as its stride");
  shown.grid.crs = readCrs(fieldData);
  shown.grid.fileUnits = readFileUnits(fieldData);
  shown.grid.diagonal = readDiagonal(fieldData);
  return shown;
}

RestitutionModel modelOf(double number, const char* array)
{
  if (!(number >= double(RestitutionModel::Velocity) &&
        number <= double(RestitutionModel::SpeedDependent) && number == std::floor(number)))
  {
    throw DataError("The Terrain input's field array " + std::string(array) +
      " says RestitutionModel " + numberText(number) + ", this version knows 0, 1 and 2");
  }
  return RestitutionModel(int(number));
}

SurfaceMaterial materialOf(const std::vector<double>& numbers)
{
  SurfaceMaterial material;
  material.restitution = numbers[0];
  material.restitutionDeviation = numbers[1];
  material.frictionAngle = numbers[2];
  material.frictionAngleDeviation = numbers[3];
  material.cohesion = numbers[4];
  if (numbers.size() == materialNumbers)
  {
    material.restitutionModel = modelOf(numbers[7], materialName);
    material.tangentialRestitution = numbers[8];
    material.restitutionSpeed = numbers[9];
  }
  return material;
}

/// The numbers of one kind of a material, in the order in which its array has them.
constexpr int restitutionNumbers = 5;
constexpr int jointNumbers = 3;

std::vector<double> restitutionOf(const SurfaceMaterial& m)
{
  return { m.restitution, m.restitutionDeviation, double(m.restitutionModel),
    m.tangentialRestitution, m.restitutionSpeed };
}

std::vector<double> jointOf(const SurfaceMaterial& m)
{
  return { m.frictionAngle, m.frictionAngleDeviation, m.cohesion };
}

void takeRestitution(const double* numbers, SurfaceMaterial& m)
{
  m.restitution = numbers[0];
  m.restitutionDeviation = numbers[1];
  m.restitutionModel = modelOf(numbers[2], restitutionNames.numbers);
  m.tangentialRestitution = numbers[3];
  m.restitutionSpeed = numbers[4];
}

void takeJoint(const double* numbers, SurfaceMaterial& m)
{
  m.frictionAngle = numbers[0];
  m.frictionAngleDeviation = numbers[1];
  m.cohesion = numbers[2];
}

/// Yielding ground: as typed, class 0 first, then those of the restitution layer.
void writeYielding(const Terrain& terrain, vtkFieldData* fieldData)
{
  const auto fields = yieldingFields();
  const auto table = addArray<vtkDoubleArray>(fieldData, yieldingName, int(fields.size()));
  for (int k = 0; k <= terrain.restitutionClasses().count(); ++k)
  {
    std::vector<double> row;
    for (const YieldingField& field : fields)
    {
      row.push_back(field.typed(terrain.restitutionMaterial(k).yielding));
    }
    table->InsertNextTuple(row.data());
  }
}

/// Hard ground everywhere if there is no such array.
std::vector<YieldingGround> readYielding(vtkFieldData* fieldData, int classes)
{
  std::vector<YieldingGround> grounds(std::size_t(classes) + 1);
  const vtkAbstractArray* array = fieldData->GetAbstractArray(yieldingName);
  if (!array)
  {
    return grounds;
  }
  // A file of an earlier version has fewer of them, the first ones.
  const auto fields = yieldingFields().first(
    std::min(yieldingFields().size(), std::size_t(array->GetNumberOfComponents())));
  const std::vector<double> values =
    numbers(fieldData, yieldingName, int(fields.size() * grounds.size()));
  for (std::size_t k = 0; k < grounds.size(); ++k)
  {
    for (std::size_t f = 0; f < fields.size(); ++f)
    {
      fields[f].set(grounds[k], values[k * fields.size() + f]);
    }
  }
  return grounds;
}

template <typename Numbers>
void writeClasses(const MaterialClasses& classes, const ClassNames& arrays, int count,
  Numbers&& numbersOf, const std::shared_ptr<const Terrain>& terrain, vtkFieldData* fieldData)
{
  if (classes.cells.empty())
  {
    return;
  }
  addArray<SharedClasses>(fieldData, arrays.cells)->Share(terrain, classes.cells);
  const auto table = addArray<vtkDoubleArray>(fieldData, arrays.numbers, count);
  const auto names = addArray<vtkStringArray>(fieldData, arrays.names);
  for (std::size_t k = 0; k < classes.materials.size(); ++k)
  {
    table->InsertNextTuple(numbersOf(classes.materials[k]).data());
    names->InsertNextValue(classes.names[k]);
  }
}

/// Nothing if there are no such classes.
template <typename Take>
MaterialClasses readClasses(vtkFieldData* fieldData, const ClassNames& arrays, int count,
  Take&& take, const SurfaceMaterial& usual)
{
  MaterialClasses classes;
  vtkAbstractArray* any = fieldData->GetAbstractArray(arrays.cells);
  if (!any)
  {
    return classes;
  }
  vtkSmartPointer<vtkUnsignedCharArray> cells = vtkUnsignedCharArray::SafeDownCast(any);
  vtkDataArray* table = fieldData->GetArray(arrays.numbers);
  auto* names = vtkStringArray::SafeDownCast(fieldData->GetAbstractArray(arrays.names));
  if (!cells || !table || !names || table->GetNumberOfValues() % count != 0 ||
    table->GetNumberOfValues() / count != names->GetNumberOfValues())
  {
    throw DataError(
      "The Terrain input must come from DEM to CFE Mesh, directly or from a file saved "
      "from it: its field arrays " +
      std::string(arrays.cells) + ", " + arrays.numbers + " and " + arrays.names +
      " do not belong together");
  }
  const std::vector<double> values =
    numbers(fieldData, arrays.numbers, int(table->GetNumberOfValues()));
  for (vtkIdType k = 0; k < names->GetNumberOfValues(); ++k)
  {
    classes.names.push_back(names->GetValue(k));
    classes.materials.push_back(usual);
    take(values.data() + k * count, classes.materials.back());
  }
  classes.cells = { cells->GetPointer(0), std::size_t(cells->GetNumberOfValues()) };
  // As for the heights: the array lives in the deleter.
  classes.owner = std::shared_ptr<const void>(classes.cells.data(), [cells](const void*) {});
  return classes;
}

/// Throws unless the mesh is the one that belongs to the slope: all of its triangles, and a sample
/// of its points where the slope's nodes are.
void checkMesh(vtkPolyData* mesh, const Terrain& terrain, int stride)
{
  const std::string remedy =
    ". The rocks would not fall on what is shown. Connect the output of DEM "
    "to CFE Mesh itself; crop or move the raster, not the mesh";
  const std::int64_t expected = countTriangles(terrain, stride);
  if (mesh->GetNumberOfPolys() != expected || mesh->GetNumberOfCells() != expected)
  {
    throw DataError("The Terrain input has " + std::to_string(mesh->GetNumberOfCells()) +
      " cells but its heights make " + std::to_string(expected) +
      " triangles: it was clipped or otherwise changed" + remedy);
  }
  const GridGeometry& grid = terrain.geometry();
  const vtkIdType points = mesh->GetNumberOfPoints();
  const vtkIdType samples = std::min<vtkIdType>(points, 1000);
  // Loose enough for a mesh that went through single precision: 500 km in a float is good to 3 cm.
  const double tolerance =
    std::max(1e-3 * grid.cellSize, std::max(std::abs(grid.xOrigin), std::abs(grid.yOrigin)) * 1e-7);
  for (vtkIdType k = 0; k < samples; ++k)
  {
    double p[3];
    mesh->GetPoint(samples > 1 ? k * (points - 1) / (samples - 1) : 0, p);
    const double column = (p[0] - grid.xOrigin) / grid.cellSize;
    const double row = (grid.rows - 1) - (p[1] - grid.yOrigin) / grid.cellSize;
    const double nearColumn = std::round(column);
    const double nearRow = std::round(row);
    bool fits = nearColumn >= 0 && nearColumn < grid.columns && nearRow >= 0 &&
      nearRow < grid.rows && std::abs(column - nearColumn) * grid.cellSize <= tolerance &&
      std::abs(row - nearRow) * grid.cellSize <= tolerance;
    if (fits)
    {
      const double height = terrain.nodeHeight(int(nearRow), int(nearColumn));
      fits = std::abs(p[2] - height) <= 1e-3 + 1e-6 * std::abs(height);
    }
    if (!fits)
    {
      throw DataError("The Terrain input has a point at (" + numberText(p[0]) + ", " +
        numberText(p[1]) + ", " + numberText(p[2]) +
        ") where the slope has no node: it was moved or otherwise changed" + remedy);
    }
  }
}

} // namespace

void writeTerrain(std::shared_ptr<const Terrain> terrain, int stride, vtkFieldData* fieldData)
{
  const GridGeometry& grid = terrain->geometry();
  const SurfaceMaterial& material = terrain->material();
  const Roughness& roughness = terrain->roughness();
  addNumbers(fieldData, kGridArray,
    { double(grid.columns), double(grid.rows), grid.cellSize, grid.xOrigin, grid.yOrigin,
      double(stride) });
  writeDiagonal(grid.diagonal, fieldData);
  addNumbers(fieldData, materialName,
    { material.restitution, material.restitutionDeviation, material.frictionAngle,
      material.frictionAngleDeviation, material.cohesion, roughness.mean, roughness.deviation,
      double(material.restitutionModel), material.tangentialRestitution,
      material.restitutionSpeed });
  writeFileUnits(grid.fileUnits, fieldData);
  const Vec3 origin = grid.origin();
  addNumbers(fieldData, kOriginArray, { origin.x(), origin.y(), origin.z() });
  addArray<vtkStringArray>(fieldData, kCrsArray)->InsertNextValue(grid.crs);
  writeClasses(terrain->restitutionClasses(), restitutionNames, restitutionNumbers, restitutionOf,
    terrain, fieldData);
  writeYielding(*terrain, fieldData);
  writeClasses(terrain->jointClasses(), jointNames, jointNumbers, jointOf, terrain, fieldData);
  writeRoughness(*terrain, fieldData);
  writeStructures(*terrain, fieldData);
  addArray<SharedHeights>(fieldData, kHeightsArray)->Share(terrain, terrain->heights());
}

Terrain readTerrain(vtkPolyData* mesh, bool withMesh)
{
  vtkSmartPointer<vtkFieldData> fieldData = slopeOf(mesh->GetFieldData());
  if (!fieldData)
  {
    fieldData = mesh->GetFieldData();
  }
  if (mesh->GetNumberOfCells() == 0 && !fieldData->GetArray(kHeightsArray))
  {
    throw DataError("The Terrain input is empty: its source made nothing");
  }
  const auto [grid, stride] = readGrid(fieldData);
  const std::vector<double> m =
    numbers(fieldData, materialName, materialNumbers, materialNumbersOnce);
  Roughness roughness;
  roughness.mean = m[5];
  roughness.deviation = m[6];
  roughness = readRoughness(fieldData, roughness);

  vtkSmartPointer<vtkDoubleArray> heights =
    vtkDoubleArray::SafeDownCast(fieldData->GetArray(kHeightsArray));
  if (!heights)
  {
    throw DataError(
      "The Terrain input must come from DEM to CFE Mesh, directly or from a file saved "
      "from it: its field data has no array " +
      std::string(kHeightsArray) + " of double precision");
  }
  const std::span<const double> view(
    heights->GetPointer(0), std::size_t(heights->GetNumberOfValues()));
  // The smart pointer lives in the deleter: the terrain keeps the array, not a copy of it.
  std::shared_ptr<const void> owner(view.data(), [heights](const void*) {});
  SurfaceMaterial material = materialOf(m);
  MaterialClasses restitution =
    readClasses(fieldData, restitutionNames, restitutionNumbers, takeRestitution, material);
  const std::vector<YieldingGround> yielding = readYielding(fieldData, restitution.count());
  material.yielding = yielding[0];
  for (int k = 0; k < restitution.count(); ++k)
  {
    restitution.materials[std::size_t(k)].yielding = yielding[std::size_t(k) + 1];
  }
  restitution.roughness = readClassRoughness(fieldData, restitution.count());
  Terrain terrain(grid, view, std::move(owner), material, roughness);
  terrain.setDeviationPer(readDeviationPer(fieldData));
  MaterialClasses joint =
    readClasses(fieldData, jointNames, jointNumbers, takeJoint, terrain.material());
  readClassDeviationPer(fieldData, restitution, joint);
  terrain.setRestitutionClasses(std::move(restitution));
  terrain.setJointClasses(std::move(joint));
  terrain.setStructures(readStructures(fieldData));
  if (withMesh)
  {
    checkMesh(mesh, terrain, stride);
  }
  return terrain;
}

void dropTerrain(vtkFieldData* data)
{
  for (int k = data->GetNumberOfArrays() - 1; k >= 0; --k)
  {
    vtkAbstractArray* array = data->GetAbstractArray(k);
    if (isOfSlope(array->GetName()) && array->GetName() != std::string(kCrsArray))
    {
      data->RemoveArray(k);
    }
  }
}

bool hasTerrain(vtkFieldData* fieldData)
{
  const vtkSmartPointer<vtkFieldData> slope = slopeOf(fieldData);
  return slope && slope->GetArray(kGridArray);
}

std::optional<Terrain> slopeUnder(vtkPolyData* trajectories, vtkPolyData* mesh)
{
  vtkFieldData* fieldData = trajectories->GetFieldData();
  if (mesh)
  {
    std::optional<Terrain> terrain(readTerrain(mesh));
    checkSameCrs(fieldData, "The trajectories of the Input are", mesh->GetFieldData());
    return terrain;
  }
  if (hasTerrain(fieldData))
  {
    return readTerrain(trajectories, false);
  }
  if (hasTiles(fieldData))
  {
    return readTiles(trajectories, readGrid(fieldData).grid);
  }
  if (slopeKey(fieldData))
  {
    throw DataError("The trajectories refer to a slope that is not here, and have no heights of it "
                    "with them: connect the slope as Terrain");
  }
  return {};
}

} // namespace rockfall::filters
