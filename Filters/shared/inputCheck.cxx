// Requirements on the points, cells and arrays of an input.

#include "base/errors.h"
#include "base/text/numberText.h"
#include "mesh/precision.h"
#include "rock/results.h"
#include "shared/cells.h"
#include "shared/inputs.h"
#include "shared/rockPaths.h"

#include "vtkAbstractArray.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace rockfall::filters
{

namespace
{

constexpr double kWhole32 = std::numeric_limits<int>::max();
constexpr double kWhole53 = 0x1p53;

enum class Holds
{
  Finite,
  NotInfinite, ///< NaN where there is nothing to say.
  Whole32,
  Whole53,
};

/// What a rock has, in SI. Beyond it squares and sums overflow, or nothing on earth is so.
struct Bounds
{
  double low, high;
};
constexpr Bounds kAny{ -std::numeric_limits<double>::infinity(),
  std::numeric_limits<double>::infinity() };
constexpr Bounds kTime{ 0.0, 1e9 }, kSpeed{ -1000.0, 1000.0 }, kSpin{ -1e4, 1e4 },
  kEnergy{ 0.0, 1e18 }, kHeight{ -1e5, 1e5 }, kMass{ 0.0, 1e15 }, kWidth{ 0.0, 1e4 },
  kVolume{ 0.0, 1e9 }, kFate{ 0.0, double(int(Fate::Broken)) }, kCount{ 0.0, kWhole32 };

struct ArrayRule
{
  InputKind kind;
  bool ofPoints; ///< Else of cells.
  const char* name;
  Holds holds;
  Bounds bounds = kAny;
};

/// Arrays that filters make numbers of, beyond what the readers of a kind look at themselves.
constexpr ArrayRule rules[] = {
  { InputKind::Rocks, false, "BlockId", Holds::Whole53 },
  { InputKind::Rocks, false, "SourceId", Holds::Whole53 },
  { InputKind::Rocks, false, "Frequency", Holds::Finite },
  { InputKind::Rocks, false, "Shape", Holds::Whole32 },
  { InputKind::Rocks, false, "State", Holds::Whole32 },
  { InputKind::Trajectories, true, "Time", Holds::Finite, kTime },
  { InputKind::Trajectories, true, "Velocity", Holds::Finite, kSpeed },
  { InputKind::Trajectories, true, "RotationRate", Holds::Finite, kSpin },
  { InputKind::Trajectories, true, "KineticEnergy", Holds::Finite, kEnergy },
  { InputKind::Trajectories, true, "HeightOverGround", Holds::NotInfinite, kHeight },
  { InputKind::Trajectories, false, "Iteration", Holds::Whole32, kCount },
  { InputKind::Trajectories, false, "RockId", Holds::Whole32, kCount },
  { InputKind::Trajectories, false, "BlockId", Holds::Whole53 },
  { InputKind::Trajectories, false, "SourceId", Holds::Whole53 },
  { InputKind::Trajectories, false, "Shape", Holds::Whole32 },
  { InputKind::Trajectories, false, "Fate", Holds::Whole32, kFate },
  { InputKind::Trajectories, false, "Piece", Holds::Whole32, kCount },
  { InputKind::Trajectories, false, "Mass", Holds::Finite, kMass },
  { InputKind::Trajectories, false, "Width", Holds::Finite, kWidth },
  { InputKind::Trajectories, false, "Volume", Holds::Finite, kVolume },
  { InputKind::Crossings, true, "Line", Holds::Whole32 },
  { InputKind::Crossings, true, "Iteration", Holds::Whole32, kCount },
  { InputKind::Crossings, true, "RockId", Holds::Whole32, kCount },
  { InputKind::Crossings, true, "Piece", Holds::Whole32, kCount },
  { InputKind::Crossings, true, "Passing", Holds::Whole32 },
  { InputKind::Crossings, true, "KineticEnergy", Holds::Finite, kEnergy },
  { InputKind::Crossings, true, "HeightOverGround", Holds::NotInfinite, kHeight },
  { InputKind::Crossings, true, "TopHeight", Holds::NotInfinite, kHeight },
  { InputKind::Crossings, true, "Frequency", Holds::Finite },
  { InputKind::Crossings, true, "SourceId", Holds::Whole53 },
  { InputKind::Crossings, true, "Velocity", Holds::Finite, kSpeed },
};

bool fits(double value, Holds holds)
{
  switch (holds)
  {
    case Holds::Finite:
      return std::isfinite(value);
    case Holds::NotInfinite:
      return !std::isinf(value);
    case Holds::Whole32:
      return std::abs(value) <= kWhole32 && value == std::floor(value);
    case Holds::Whole53:
      break;
  }
  return std::abs(value) < kWhole53 && value == std::floor(value);
}

const char* textOf(Holds holds)
{
  return holds == Holds::Finite   ? "finite"
    : holds == Holds::NotInfinite ? "finite, or NaN"
                                  : "a whole number";
}

void checkNumbers(vtkDataArray* array, const ArrayRule& rule, const std::string& name)
{
  const int components = array->GetNumberOfComponents();
  const std::string_view of = rule.name;
  if (const int wanted = of == "Velocity" || of == "RotationRate" ? 3 : 1; components != wanted)
  {
    throw DataError(name + " has " + std::to_string(components) + " components, it must have " +
      std::to_string(wanted));
  }
  const vtkIdType values = array->GetNumberOfValues();
  auto* doubles = vtkDoubleArray::SafeDownCast(array);
  const double* fast = doubles ? doubles->GetPointer(0) : nullptr;
  for (vtkIdType k = 0; k < values; ++k)
  {
    const double value = fast ? fast[k] : array->GetComponent(k / components, int(k % components));
    const bool fitting = fits(value, rule.holds);
    if (!fitting || value < rule.bounds.low || value > rule.bounds.high) // not so of NaN
    {
      throw DataError(name + " has " + numberText(value, 17) + " at place " +
        std::to_string(k / components) + ", it must be " +
        (fitting ? numberText(rule.bounds.low) + " to " + numberText(rule.bounds.high)
                 : std::string(textOf(rule.holds))));
    }
  }
}

/// Whether all points are finite, so that those of each cell need no look.
bool areFinite(vtkPoints* points)
{
  const auto all = [](auto* numbers)
  {
    const auto* const first = numbers->GetPointer(0);
    return std::all_of(
      first, first + numbers->GetNumberOfValues(), [](double x) { return std::isfinite(x); });
  };
  vtkDataArray* data = points ? points->GetData() : nullptr;
  if (auto* doubles = vtkDoubleArray::SafeDownCast(data))
  {
    return all(doubles);
  }
  auto* floats = vtkFloatArray::SafeDownCast(data);
  return floats && all(floats);
}

/// Where the cells begin and end, and that their points are there and finite. `finite`: all points are.
void checkCells(vtkCellArray* cells, vtkPoints* points, bool finite, const std::string& name,
  const std::string& kind)
{
  // Of any storage, as numbers that are exact up to 2^53.
  vtkDataArray* offsets = cells->GetOffsetsArray();
  vtkDataArray* ids = cells->GetConnectivityArray();
  constexpr int digits = 17;
  const vtkIdType count = offsets->GetNumberOfValues() - 1, last = ids->GetNumberOfValues();
  const vtkIdType pointCount = points ? points->GetNumberOfPoints() : 0;
  if (count < 0 || offsets->GetComponent(0, 0) != 0.0)
  {
    throw DataError(name + "'s " + kind + " have no beginning: they are damaged");
  }
  for (vtkIdType k = 0; k < count; ++k)
  {
    const double begin = offsets->GetComponent(k, 0), end = offsets->GetComponent(k + 1, 0);
    if (end < begin || end > double(last))
    {
      throw DataError(name + "'s " + kind + " are damaged: number " + std::to_string(k) +
        " goes from place " + numberText(begin, digits) + " to " + numberText(end, digits) +
        " of " + std::to_string(last));
    }
    for (vtkIdType at = vtkIdType(begin); at < vtkIdType(end); ++at)
    {
      const double id = ids->GetComponent(at, 0);
      if (id < 0.0 || id >= double(pointCount))
      {
        throw DataError(name + "'s " + kind + " refer to point " + numberText(id, digits) +
          ", there are " + std::to_string(pointCount));
      }
      if (finite)
      {
        continue;
      }
      double p[3];
      points->GetPoint(vtkIdType(id), p);
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
      {
        throw DataError(name + " has a point " + numberText(id, digits) + " at (" +
          numberText(p[0]) + ", " + numberText(p[1]) + ", " + numberText(p[2]) +
          "), it must be finite");
      }
    }
  }
}

/// Paths of single precision far from the origin are steps of half a metre.
void checkPrecision(vtkPolyData* data, const std::string& name)
{
  if (data->GetNumberOfPoints() == 0 || data->GetPoints()->GetDataType() != VTK_FLOAT)
  {
    return;
  }
  double bounds[6], largest = 0.0, rock = 1.0;
  data->GetBounds(bounds);
  for (const double bound : bounds)
  {
    largest = std::max(largest, std::abs(bound));
  }
  if (vtkDataArray* volume = data->GetCellData()->GetArray("Volume"))
  {
    double range[2];
    volume->GetRange(range, 0);
    rock = range[0] > 0.0 ? std::cbrt(range[0]) : rock;
  }
  const double rounding = singleRounding(largest);
  if (rounding > 1e-3 * rock)
  {
    throw DataError(name + " has its points, of up to " + numberText(largest, 10) +
      " m, in single precision: rounded by up to " + numberText(rounding, 3) +
      " m, more than a thousandth of a rock of " + numberText(rock, 3) +
      " m. Take the trajectories as Rockfall Simulation makes them, or save them with double "
      "precision");
  }
}

/// A path that goes back in time is none: lines were joined, or its arrays are those of another.
void checkOrder(vtkPolyData* data, const std::string& name)
{
  vtkDataArray* times = data->GetPointData()->GetArray("Time");
  auto* doubles = vtkDoubleArray::SafeDownCast(times);
  const double* fast = doubles ? doubles->GetPointer(0) : nullptr;
  const auto at = [&](vtkIdType id) { return fast ? fast[id] : times->GetComponent(id, 0); };
  forEachCell(data->GetLines(), 0,
    [&](vtkIdType line, std::span<const vtkIdType> ids)
    {
      for (std::size_t k = 1; times && k < ids.size(); ++k)
      {
        if (at(ids[k]) < at(ids[k - 1]))
        {
          throw DataError(name + "'s line " + std::to_string(line) + " goes back in time, from " +
            numberText(at(ids[k - 1])) + " to " + numberText(at(ids[k])) +
            " s: it is no path of one rock");
        }
      }
    });
}

} // namespace

void checkTuples(vtkFieldData* data, vtkIdType count, const std::string& name, const char* of)
{
  for (int k = 0; k < data->GetNumberOfArrays(); ++k)
  {
    vtkAbstractArray* array = data->GetAbstractArray(k);
    if (array->GetNumberOfTuples() != count)
    {
      throw DataError(name + "'s " + of + " array " +
        (array->GetName() ? array->GetName() : "number " + std::to_string(k)) + " has " +
        std::to_string(array->GetNumberOfTuples()) + " tuples for " + std::to_string(count) + " " +
        of + "s: its file or its source is damaged");
    }
  }
}

void checkPolyData(vtkPolyData* data, InputKind kind, const std::string& name)
{
  vtkPoints* points = data->GetPoints();
  if (points && points->GetData()->GetNumberOfComponents() != 3)
  {
    throw DataError(name + "'s points have " +
      std::to_string(points->GetData()->GetNumberOfComponents()) + " coordinates");
  }
  const std::pair<vtkCellArray*, const char*> cells[] = { { data->GetVerts(), "vertices" },
    { data->GetLines(), "lines" }, { data->GetPolys(), "polygons" },
    { data->GetStrips(), "strips" } };
  const bool finite = areFinite(points);
  vtkIdType count = 0;
  for (const auto& [array, what] : cells)
  {
    checkCells(array, points, finite, name, what);
    count += array->GetNumberOfCells();
  }
  checkTuples(data->GetPointData(), data->GetNumberOfPoints(), name, "point");
  checkTuples(data->GetCellData(), count, name, "cell");
  if (kind == InputKind::Trajectories)
  {
    requireWhole(data->GetFieldData(), name);
    checkPrecision(data, name);
  }
  for (const ArrayRule& rule : rules)
  {
    vtkFieldData* arrays = data->GetPointData();
    if (!rule.ofPoints)
    {
      arrays = data->GetCellData();
    }
    vtkDataArray* array = rule.kind == kind ? arrays->GetArray(rule.name) : nullptr;
    if (array)
    {
      checkNumbers(
        array, rule, name + "'s " + (rule.ofPoints ? "point" : "cell") + " array " + rule.name);
    }
  }
  if (kind == InputKind::Trajectories)
  {
    checkOrder(data, name);
  }
}

} // namespace rockfall::filters
