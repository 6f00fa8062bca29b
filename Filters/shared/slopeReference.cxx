#include "shared/slopeReference.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "shared/arrays.h"
#include "shared/cells.h"
#include "shared/coordinateFieldData.h"
#include "shared/inputContent.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace rockfall::filters
{

namespace
{

constexpr char keyName[] = "TerrainKey";
constexpr char diagonalName[] = "TerrainCellDiagonal";

/// The slope's arrays, shared with the mesh that shows it.
struct Slope
{
  vtkNew<vtkFieldData> arrays;
};

/// Slopes that somebody refers to, by the number of their content.
class Slopes
{
public:
  static Slopes& get()
  {
    static Slopes slopes;
    return slopes;
  }

  std::shared_ptr<const Slope> find(const std::string& key)
  {
    const std::lock_guard lock(mutex_);
    const auto slope = slopes_.find(key);
    return slope == slopes_.end() ? nullptr : slope->second.lock();
  }

  /// The one that is there already, else that of `data`.
  std::shared_ptr<const Slope> keep(const std::string& key, vtkFieldData* data)
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(slopes_, [](const auto& slope) { return slope.second.expired(); });
    if (std::shared_ptr<const Slope> known = slopes_[key].lock())
    {
      return known;
    }
    const auto made = std::make_shared<Slope>();
    for (int k = 0; k < data->GetNumberOfArrays(); ++k)
    {
      if (isOfSlope(data->GetAbstractArray(k)->GetName()))
      {
        made->arrays->AddArray(data->GetAbstractArray(k));
      }
    }
    slopes_[key] = made;
    return made;
  }

private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const Slope>> slopes_;
};

/// The slope's number, and the slope kept alive. Deep copies and NewInstance give a plain array with
/// the number.
class Reference : public vtkStringArray
{
public:
  static Reference* New() { VTK_STANDARD_NEW_BODY(Reference); }
  void Refer(const std::string& key, std::shared_ptr<const Slope> slope)
  {
    this->SetName(keyName);
    this->InsertNextValue(key);
    this->To = std::move(slope);
  }

protected:
  Reference() = default;
  ~Reference() override = default;

private:
  std::shared_ptr<const Slope> To;
};

/// Empty if there is none.
std::string keyOf(vtkFieldData* data)
{
  auto* array = vtkStringArray::SafeDownCast(data->GetAbstractArray(keyName));
  return array && array->GetNumberOfValues() == 1 ? std::string(array->GetValue(0)) : std::string();
}

} // namespace

bool isOfSlope(const char* name)
{
  const std::string_view of = name ? name : "";
  return of.starts_with("Terrain") || of == kOriginArray;
}

void writeDiagonal(CellDiagonal diagonal, vtkFieldData* data)
{
  addArray<vtkIntArray>(data, diagonalName)->InsertNextValue(int(diagonal));
}

CellDiagonal readDiagonal(vtkFieldData* data)
{
  vtkDataArray* array = data->GetArray(diagonalName);
  return array && array->GetNumberOfValues() == 1 ? cellDiagonalFrom(array->GetComponent(0, 0))
                                                  : CellDiagonal::FromUpperLeft;
}

void referToSlope(vtkFieldData* from, vtkFieldData* to)
{
  for (const char* name :
    { kGridArray, diagonalName, kCrsArray, kOriginArray, kFileUnitsArray, keyName })
  {
    if (vtkAbstractArray* array = from->GetAbstractArray(name))
    {
      to->AddArray(array);
    }
  }
  if (!from->GetAbstractArray(kHeightsArray))
  {
    return;
  }
  char key[17];
  std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(terrainContent(from)));
  vtkNew<Reference> reference;
  reference->Refer(key, Slopes::get().keep(key, from));
  to->AddArray(reference);
}

vtkSmartPointer<vtkFieldData> slopeOf(vtkFieldData* data)
{
  if (data->GetAbstractArray(kHeightsArray))
  {
    return data;
  }
  const std::string key = keyOf(data);
  const std::shared_ptr<const Slope> slope = key.empty() ? nullptr : Slopes::get().find(key);
  return slope ? slope->arrays.Get() : nullptr;
}

std::optional<std::uint64_t> slopeKey(vtkFieldData* data)
{
  const std::string key = keyOf(data);
  std::uint64_t number = 0;
  const auto end = std::from_chars(key.data(), key.data() + key.size(), number, 16);
  return !key.empty() && end.ec == std::errc() && end.ptr == key.data() + key.size()
    ? std::optional(number)
    : std::nullopt;
}

namespace
{

constexpr char tilesName[] = "TerrainTiles";
constexpr char tileHeightsName[] = "TerrainTileHeights";
constexpr char widthName[] = "Width";

constexpr int kSide = 8; ///< Nodes along a tile.
constexpr int kNodes = kSide * kSide;
/// Beside a path its tiles reach so far: in nodes, and in m beside its rock. Maps want the heights
/// at the corners of their cells, and a path bends a little between two points.
constexpr double kBesideNodes = 6.0;
constexpr double kBeside = 1.0;

/// The tiles of a grid.
struct Tiling
{
  int columns = 0, rows = 0; ///< Nodes.
  double cellSize = 0.0, x = 0.0, north = 0.0;

  int across() const { return (columns + kSide - 1) / kSide; }
  int down() const { return (rows + kSide - 1) / kSide; }
  double columnAt(double easting) const { return (easting - x) / cellSize; }
  double rowAt(double northing) const { return (north - northing) / cellSize; }
};

Tiling tilingOf(const GridGeometry& grid)
{
  return { grid.columns, grid.rows, grid.cellSize, grid.xOrigin,
    grid.yOrigin + (grid.rows - 1) * grid.cellSize };
}

/// Marks the tiles within `margin` nodes of a place; a tile beyond the grid is none.
void markAround(
  const Tiling& tiling, double column, double row, double margin, std::vector<char>& wanted)
{
  const auto first = [&](double from) { return int(std::max(from, 0.0)) / kSide; };
  const auto last = [&](double to, int count) { return int(std::min(to, count - 1.0)) / kSide; };
  if (column + margin < 0.0 || row + margin < 0.0 || column - margin > tiling.columns ||
    row - margin > tiling.rows)
  {
    return;
  }
  for (int j = first(row - margin); j <= last(row + margin + 1.0, tiling.rows); ++j)
  {
    for (int i = first(column - margin); i <= last(column + margin + 1.0, tiling.columns); ++i)
    {
      wanted[std::size_t(j) * std::size_t(tiling.across()) + std::size_t(i)] = 1;
    }
  }
}

std::vector<char> tilesUnder(vtkPolyData* paths, const Tiling& tiling)
{
  std::vector<char> wanted(std::size_t(tiling.across()) * std::size_t(tiling.down()), 0);
  vtkDataArray* width = paths->GetCellData()->GetArray(widthName);
  forEachLine(paths,
    [&](vtkIdType cell, std::span<const vtkIdType> ids)
    {
      const double half = width ? 0.5 * width->GetComponent(cell, 0) : 0.0;
      const double margin = std::max(kBesideNodes, 2.0 + (half + kBeside) / tiling.cellSize);
      std::array<double, 2> before{};
      for (std::size_t k = 0; k < ids.size(); ++k)
      {
        double p[3];
        paths->GetPoint(ids[k], p);
        const std::array<double, 2> here{ tiling.columnAt(p[0]), tiling.rowAt(p[1]) };
        const double far =
          k > 0 ? std::max(std::abs(here[0] - before[0]), std::abs(here[1] - before[1])) : 0.0;
        // A path may leap over tiles.
        const int steps =
          std::isfinite(far) ? std::max(1, int(std::min(far, 1e6) / (0.5 * kSide)) + 1) : 0;
        for (int s = k > 0 ? 1 : steps; s <= steps && steps > 0; ++s)
        {
          const double share = double(s) / steps;
          markAround(tiling, before[0] + share * (here[0] - before[0]),
            before[1] + share * (here[1] - before[1]), margin, wanted);
        }
        before = here;
      }
    });
  return wanted;
}

/// The node of a tile's place; the last row and column of the grid where the tile goes beyond.
std::size_t nodeOf(const Tiling& tiling, int tile, int place)
{
  const int row = std::min(tile / tiling.across() * kSide + place / kSide, tiling.rows - 1);
  const int column = std::min(tile % tiling.across() * kSide + place % kSide, tiling.columns - 1);
  return std::size_t(row) * std::size_t(tiling.columns) + std::size_t(column);
}

} // namespace

void writeTiles(vtkPolyData* paths)
{
  vtkFieldData* data = paths->GetFieldData();
  data->RemoveArray(tilesName);
  data->RemoveArray(tileHeightsName);
  const vtkSmartPointer<vtkFieldData> slope = slopeOf(data);
  auto* heights = slope ? vtkDoubleArray::SafeDownCast(slope->GetArray(kHeightsArray)) : nullptr;
  vtkDataArray* numbers = slope ? slope->GetArray(kGridArray) : nullptr;
  if (!heights || !numbers)
  {
    return;
  }
  GridGeometry grid;
  grid.columns = int(numbers->GetComponent(0, 0));
  grid.rows = int(numbers->GetComponent(0, 1));
  grid.cellSize = numbers->GetComponent(0, 2);
  grid.xOrigin = numbers->GetComponent(0, 3);
  grid.yOrigin = numbers->GetComponent(0, 4);
  const Tiling tiling = tilingOf(grid);
  const std::vector<char> wanted = tilesUnder(paths, tiling);
  const auto tiles = addArray<vtkIntArray>(data, tilesName);
  const auto values = addArray<vtkDoubleArray>(data, tileHeightsName, kNodes);
  const auto count = std::count(wanted.begin(), wanted.end(), 1);
  tiles->SetNumberOfValues(count);
  values->SetNumberOfTuples(count);
  vtkIdType next = 0;
  for (std::size_t tile = 0; tile < wanted.size(); ++tile)
  {
    if (wanted[tile])
    {
      tiles->SetValue(next, int(tile));
      double* of = values->GetPointer(next++ * kNodes);
      for (int place = 0; place < kNodes; ++place)
      {
        of[place] = heights->GetValue(vtkIdType(nodeOf(tiling, int(tile), place)));
      }
    }
  }
}

bool hasTiles(vtkFieldData* data)
{
  return data->GetArray(tilesName) && data->GetArray(tileHeightsName);
}

void addTiles(vtkFieldData* from, vtkFieldData* to)
{
  auto* more = vtkDoubleArray::SafeDownCast(from->GetArray(tileHeightsName));
  vtkDataArray* numbers = from->GetArray(tilesName);
  vtkDataArray* known = to->GetArray(tilesName);
  auto* heights = vtkDoubleArray::SafeDownCast(to->GetArray(tileHeightsName));
  if (!more || !numbers || !known || !heights || more == heights ||
    more->GetNumberOfTuples() != numbers->GetNumberOfTuples() ||
    more->GetNumberOfComponents() != heights->GetNumberOfComponents())
  {
    return;
  }
  std::vector<double> have;
  for (vtkIdType k = 0; k < known->GetNumberOfTuples(); ++k)
  {
    have.push_back(known->GetComponent(k, 0));
  }
  std::sort(have.begin(), have.end());
  // Not into arrays that an input has.
  const auto tiles = vtkSmartPointer<vtkIntArray>::New();
  tiles->DeepCopy(known);
  const auto values = vtkSmartPointer<vtkDoubleArray>::New();
  values->DeepCopy(heights);
  for (vtkIdType k = 0; k < numbers->GetNumberOfTuples(); ++k)
  {
    if (!std::binary_search(have.begin(), have.end(), numbers->GetComponent(k, 0)))
    {
      tiles->InsertNextValue(int(numbers->GetComponent(k, 0)));
      values->InsertNextTuple(k, more);
    }
  }
  to->AddArray(tiles);
  to->AddArray(values);
}

Terrain readTiles(vtkPolyData* paths, const GridGeometry& grid)
{
  vtkFieldData* data = paths->GetFieldData();
  vtkDataArray* numbers = data->GetArray(tilesName);
  auto* heights = vtkDoubleArray::SafeDownCast(data->GetArray(tileHeightsName));
  const Tiling tiling = tilingOf(grid);
  const int count = tiling.across() * tiling.down();
  const std::string remedy = ": connect the slope as Terrain";
  if (!heights || heights->GetNumberOfComponents() != kNodes ||
    heights->GetNumberOfTuples() != numbers->GetNumberOfTuples())
  {
    throw DataError("The trajectories' field arrays " + std::string(tilesName) + " and " +
      tileHeightsName + " do not belong together" + remedy);
  }
  std::vector<char> known(std::size_t(count), 0);
  std::vector<double> nodes(
    std::size_t(grid.nodeCount()), std::numeric_limits<double>::quiet_NaN());
  for (vtkIdType k = 0; k < numbers->GetNumberOfTuples(); ++k)
  {
    const double tile = numbers->GetComponent(k, 0);
    if (!(tile >= 0.0 && tile < count))
    {
      throw DataError("The trajectories' field array " + std::string(tilesName) + " has " +
        numberText(tile) + " at place " + std::to_string(k) + ", the slope has " +
        std::to_string(count) + " tiles" + remedy);
    }
    known[std::size_t(tile)] = 1;
    for (int place = 0; place < kNodes; ++place)
    {
      nodes[nodeOf(tiling, int(tile), place)] = heights->GetTypedComponent(k, place);
    }
  }
  // Paths of several files that a filter has appended have the tiles of one of them.
  for (vtkIdType k = 0; k < paths->GetNumberOfPoints(); ++k)
  {
    double p[3];
    paths->GetPoint(k, p);
    const double column = tiling.columnAt(p[0]), row = tiling.rowAt(p[1]);
    if (column >= 0.0 && row >= 0.0 && column <= grid.columns - 1.0 && row <= grid.rows - 1.0 &&
      !known[std::size_t(int(row) / kSide) * std::size_t(tiling.across()) +
        std::size_t(int(column) / kSide)])
    {
      throw DataError("The trajectories do not bring the heights under their point at (" +
        numberText(p[0]) + ", " + numberText(p[1]) + "), as they come from several files" + remedy);
    }
  }
  return { grid, std::move(nodes) };
}

} // namespace rockfall::filters
