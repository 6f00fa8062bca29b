#include "shared/structureFieldData.h"

#include "base/errors.h"
#include "shared/arrays.h"
#include "terrain/Obstacles.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall::filters
{

namespace
{

constexpr char embankmentsName[] = "TerrainEmbankments";
constexpr char embankmentPointsName[] = "TerrainEmbankmentPoints";
constexpr char treesName[] = "TerrainTrees";
constexpr char lyingName[] = "TerrainLyingStems";
constexpr char barriersName[] = "TerrainBarriers";
constexpr char barrierPointsName[] = "TerrainBarrierPoints";
constexpr char embankmentNamesName[] = "TerrainEmbankmentNames";
constexpr char barrierNamesName[] = "TerrainBarrierNames";
constexpr char materialsName[] = "TerrainStructureMaterials";

void addPoints(vtkDoubleArray* array, const std::vector<Eigen::Vector2d>& points)
{
  for (const Eigen::Vector2d& p : points)
  {
    array->InsertNextTuple(p.data());
  }
}

void writeNames(const auto& structures, const char* name, vtkFieldData* fieldData)
{
  const auto names = addArray<vtkStringArray>(fieldData, name);
  for (const auto& one : structures)
  {
    names->InsertNextValue(one.name);
  }
}

void readNames(vtkFieldData* fieldData, const char* name, auto& structures)
{
  auto* names = vtkStringArray::SafeDownCast(fieldData->GetAbstractArray(name));
  for (std::size_t k = 0; names && k < structures.size(); ++k)
  {
    structures[k].name =
      vtkIdType(k) < names->GetNumberOfValues() ? names->GetValue(vtkIdType(k)) : "";
  }
}

[[noreturn]] void failTogether()
{
  throw DataError("The Terrain input must come from DEM to CFE Mesh, directly or from a file saved "
                  "from it: its field arrays of embankments, trees and barriers do not belong "
                  "together");
}

constexpr double kNoLimit = -1.0;

double writtenCapacity(double capacity)
{
  return std::isinf(capacity) ? kNoLimit : capacity;
}

double readCapacity(double written)
{
  return written < 0.0 ? std::numeric_limits<double>::infinity() : written;
}

/// Tuples of an array of this many components; none if there is no such array.
struct Rows
{
  Rows(vtkFieldData* fieldData, const char* name, int components)
    : array(fieldData->GetArray(name))
  {
    if (array && array->GetNumberOfComponents() != components)
    {
      failTogether();
    }
  }
  vtkIdType count() const { return array ? array->GetNumberOfTuples() : 0; }
  double at(vtkIdType row, int column) const { return array->GetComponent(row, column); }
  std::int64_t whole(vtkIdType row, int column) const
  {
    const double value = this->at(row, column);
    if (!(std::abs(value) < 0x1p53) || value != std::floor(value))
    {
      failTogether();
    }
    return std::int64_t(value);
  }
  int number(vtkIdType row, int column) const
  {
    const std::int64_t value = this->whole(row, column);
    return int(std::clamp<std::int64_t>(value, -1, std::numeric_limits<int>::max()));
  }

  vtkDataArray* array;
};

/// The next points of an array.
std::vector<Eigen::Vector2d> takePoints(const Rows& rows, double count, vtkIdType& next)
{
  if (!(count >= 2.0 && count <= double(rows.count() - next)))
  {
    failTogether();
  }
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < int(count); ++k, ++next)
  {
    points.emplace_back(rows.at(next, 0), rows.at(next, 1));
  }
  return points;
}

} // namespace

void writeStructures(const Terrain& terrain, vtkFieldData* fieldData)
{
  if (!terrain.obstacles())
  {
    return;
  }
  const Structures& s = terrain.obstacles()->structures();
  const auto embankments = addArray<vtkDoubleArray>(fieldData, embankmentsName, 8);
  const auto embankmentPoints = addArray<vtkDoubleArray>(fieldData, embankmentPointsName, 2);
  for (const Embankment& e : s.embankments)
  {
    // Either a height or an elevation; the other one is 0.
    const bool high = e.height > 0.0;
    const double row[] = { double(e.feature), high ? e.height : 0.0, high ? 0.0 : e.elevation,
      e.crestWidth, e.mountainSlope, e.valleySlope, double(e.material), double(e.points.size()) };
    embankments->InsertNextTuple(row);
    addPoints(embankmentPoints, e.points);
  }
  writeNames(s.embankments, embankmentNamesName, fieldData);
  writeNames(s.barriers, barrierNamesName, fieldData);
  const auto trees = addArray<vtkDoubleArray>(fieldData, treesName, 7);
  for (const Tree& t : s.trees)
  {
    const double row[] = { double(t.feature), t.position.x(), t.position.y(), t.diameter, t.height,
      writtenCapacity(t.capacity), double(t.material) };
    trees->InsertNextTuple(row);
  }
  const auto lying = addArray<vtkDoubleArray>(fieldData, lyingName, 3);
  for (std::size_t k = 0; k < s.trees.size(); ++k)
  {
    if (s.trees[k].lies())
    {
      lying->InsertNextTuple3(double(k), s.trees[k].end.x(), s.trees[k].end.y());
    }
  }
  const auto barriers = addArray<vtkDoubleArray>(fieldData, barriersName, 10);
  const auto barrierPoints = addArray<vtkDoubleArray>(fieldData, barrierPointsName, 2);
  for (const Barrier& b : s.barriers)
  {
    const double row[] = { double(b.feature), b.height, writtenCapacity(b.capacity),
      double(b.absorbs), double(b.records), b.overhang, b.braking,
      std::isnan(b.residual) ? kNoLimit : b.residual, writtenCapacity(b.room),
      double(b.points.size()) };
    barriers->InsertNextTuple(row);
    addPoints(barrierPoints, b.points);
  }
  const auto materials = addArray<vtkDoubleArray>(fieldData, materialsName, 8);
  for (const SurfaceMaterial& m : s.materials)
  {
    const double row[] = { m.restitution, m.restitutionDeviation, double(m.restitutionModel),
      m.tangentialRestitution, m.restitutionSpeed, m.frictionAngle, m.frictionAngleDeviation,
      m.cohesion };
    materials->InsertNextTuple(row);
  }
}

void dropStructures(vtkFieldData* fieldData)
{
  for (const char* name : { embankmentsName, embankmentPointsName, treesName, lyingName,
         barriersName, barrierPointsName, materialsName, embankmentNamesName, barrierNamesName })
  {
    fieldData->RemoveArray(name);
  }
}

Structures readStructures(vtkFieldData* fieldData)
{
  const Rows embankments(fieldData, embankmentsName, 8), trees(fieldData, treesName, 7),
    barriers(fieldData, barriersName, 10), materials(fieldData, materialsName, 8),
    embankmentPoints(fieldData, embankmentPointsName, 2),
    barrierPoints(fieldData, barrierPointsName, 2), lying(fieldData, lyingName, 3);
  Structures s;
  vtkIdType next = 0;
  for (vtkIdType k = 0; k < embankments.count(); ++k)
  {
    Embankment& e = s.embankments.emplace_back();
    e.feature = embankments.whole(k, 0);
    const bool high = embankments.at(k, 1) > 0.0;
    (high ? e.height : e.elevation) = embankments.at(k, high ? 1 : 2);
    e.crestWidth = embankments.at(k, 3);
    e.mountainSlope = embankments.at(k, 4);
    e.valleySlope = embankments.at(k, 5);
    e.material = embankments.number(k, 6);
    e.points = takePoints(embankmentPoints, embankments.at(k, 7), next);
  }
  for (vtkIdType k = 0; k < trees.count(); ++k)
  {
    Tree& t = s.trees.emplace_back();
    t.feature = trees.whole(k, 0);
    t.position = { trees.at(k, 1), trees.at(k, 2) };
    t.diameter = trees.at(k, 3);
    t.height = trees.at(k, 4);
    t.capacity = readCapacity(trees.at(k, 5));
    t.material = trees.number(k, 6);
  }
  for (vtkIdType k = 0; k < lying.count(); ++k)
  {
    const std::int64_t tree = lying.whole(k, 0);
    if (tree < 0 || tree >= trees.count())
    {
      failTogether();
    }
    s.trees[std::size_t(tree)].end = { lying.at(k, 1), lying.at(k, 2) };
  }
  next = 0;
  for (vtkIdType k = 0; k < barriers.count(); ++k)
  {
    Barrier& b = s.barriers.emplace_back();
    b.feature = barriers.whole(k, 0);
    b.height = barriers.at(k, 1);
    b.capacity = readCapacity(barriers.at(k, 2));
    b.absorbs = barriers.at(k, 3) != 0.0;
    b.records = barriers.at(k, 4) != 0.0;
    b.overhang = barriers.at(k, 5);
    b.braking = barriers.at(k, 6);
    b.residual = barriers.at(k, 7) < 0.0 ? b.residual : barriers.at(k, 7);
    b.room = readCapacity(barriers.at(k, 8));
    b.points = takePoints(barrierPoints, barriers.at(k, 9), next);
  }
  for (vtkIdType k = 0; k < materials.count(); ++k)
  {
    SurfaceMaterial& m = s.materials.emplace_back();
    m.restitution = materials.at(k, 0);
    m.restitutionDeviation = materials.at(k, 1);
    m.restitutionModel = RestitutionModel(materials.number(k, 2));
    m.tangentialRestitution = materials.at(k, 3);
    m.restitutionSpeed = materials.at(k, 4);
    m.frictionAngle = materials.at(k, 5);
    m.frictionAngleDeviation = materials.at(k, 6);
    m.cohesion = materials.at(k, 7);
  }
  readNames(fieldData, embankmentNamesName, s.embankments);
  readNames(fieldData, barrierNamesName, s.barriers);
  return s;
}

int makeStructureMesh(const Terrain& terrain, vtkIdType mostCells, vtkPolyData* mesh)
{
  std::size_t stride = 1;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  const auto kind = addArray<vtkIntArray>(mesh->GetCellData(), "StructureKind");
  const auto id = addArray<vtkIdTypeArray>(mesh->GetCellData(), "StructureId");
  const auto cfe = addArray<vtkIdTypeArray>(mesh->GetCellData(), "CFEId");
  const Obstacles* const obstacles = terrain.obstacles();
  const Vec3 origin = terrain.geometry().origin();
  const auto add = [&](std::initializer_list<vtkIdType> corners, int what, std::int64_t feature,
                     std::int64_t number)
  {
    cells->InsertNextCell(int(corners.size()), corners.begin());
    kind->InsertNextValue(what);
    id->InsertNextValue(feature);
    cfe->InsertNextValue(number);
  };
  const auto point = [&](const Vec3& local)
  { return points->InsertNextPoint(Vec3(local + origin).data()); };
  if (obstacles)
  {
    const Structures& s = obstacles->structures();
    std::int64_t number = obstacles->firstCfe();
    const ObstacleMesh& built = obstacles->mesh();
    for (const ObstacleMesh::Node& node : built.nodes)
    {
      point(node.position);
    }
    for (std::size_t k = 0; k < built.triangles.size(); ++k)
    {
      const auto& n = built.triangles[k].nodes;
      add({ n[0], n[1], n[2] }, 0,
        s.embankments[std::size_t(obstacles->embankmentOf(int(k)))].feature, number++);
    }
    const std::int64_t firstOfTrees = number;
    const std::size_t shown =
      std::max<std::size_t>(1, std::size_t(mostCells) / Obstacles::treeTriangles);
    stride = std::max<std::size_t>(1, (s.trees.size() + shown - 1) / shown);
    for (std::size_t k = 0; k < s.trees.size(); k += stride)
    {
      number = firstOfTrees + std::int64_t(k) * Obstacles::treeTriangles;
      const vtkIdType first = points->GetNumberOfPoints();
      const ObstacleMesh& shape = obstacles->shapeOf(int(k));
      for (int corner = 0; corner < int(shape.nodes.size()); ++corner)
      {
        point(obstacles->treeCorner(int(k), corner));
      }
      for (const ObstacleMesh::Triangle& t : shape.triangles)
      {
        add({ first + t.nodes[0], first + t.nodes[1], first + t.nodes[2] }, 1, s.trees[k].feature,
          number++);
      }
    }
    for (const Barrier& b : s.barriers)
    {
      for (std::size_t k = 1; k < b.points.size(); ++k)
      {
        // In pieces of a cell or so, to follow the ground.
        const Eigen::Vector2d from = b.points[k - 1], way = b.points[k] - from;
        const int n = std::max(1, int(std::ceil(way.norm() / terrain.geometry().cellSize)));
        vtkIdType before[2] = { -1, -1 };
        for (int i = 0; i <= n; ++i)
        {
          const Eigen::Vector2d p = from + (double(i) / n) * way;
          const double ground =
            std::max(terrain.elevation(p.x(), p.y()), obstacles->embankmentTop(p.x(), p.y()));
          if (std::isnan(ground))
          {
            before[0] = -1;
            continue;
          }
          const vtkIdType now[2] = { point({ p.x(), p.y(), ground }),
            point({ p.x(), p.y(), ground + b.height }) };
          if (before[0] >= 0)
          {
            add({ before[0], now[0], now[1], before[1] }, 2, b.feature, 0);
          }
          before[0] = now[0], before[1] = now[1];
        }
      }
    }
  }
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  return int(stride);
}

} // namespace rockfall::filters
