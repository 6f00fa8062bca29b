// Data that lie by pipeline: one error that names the input and the array, and nothing falls.

#include "simulationTest.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkDispersionAngle.h"
#include "vtkDoubleArray.h"
#include "vtkGrowingPaths.h"
#include "vtkHazardPassageWriter.h"
#include "vtkLineSource.h"
#include "vtkMergeCollectors.h"
#include "vtkPointData.h"
#include "vtkRockfallHazardMap.h"
#include "vtkStringArray.h"
#include "vtkTrajectoryCollector.h"
#include "vtkTrajectoryLayerWriter.h"

#include <functional>
#include <limits>

namespace
{

using Lie = std::function<void(vtkPolyData*)>;

struct Case
{
  const char* name;
  Lie lie;
  std::vector<std::string> words;
};

constexpr double inf = std::numeric_limits<double>::infinity();

/// Points of the cells are others than there are.
Lie pointsAt(vtkIdType id)
{
  return [id](vtkPolyData* data)
  {
    vtkCellArray* cells = data->GetNumberOfLines() > 0 ? data->GetLines() : data->GetPolys();
    cells->GetConnectivityArray()->SetComponent(3, 0, double(id));
  };
}

Lie offsetsAt(vtkIdType place, vtkIdType offset)
{
  return [place, offset](vtkPolyData* data)
  {
    vtkCellArray* cells = data->GetNumberOfLines() > 0 ? data->GetLines() : data->GetPolys();
    cells->GetOffsetsArray()->SetComponent(place, 0, double(offset));
  };
}

Lie length(bool ofPoints, const char* name, vtkIdType tuples)
{
  return [=](vtkPolyData* data)
  {
    vtkFieldData* fields = data->GetPointData();
    if (!ofPoints)
    {
      fields = data->GetCellData();
    }
    fields->GetAbstractArray(name)->SetNumberOfTuples(tuples);
  };
}

Lie number(bool ofPoints, const char* name, double value)
{
  return [=](vtkPolyData* data)
  {
    vtkFieldData* fields = data->GetPointData();
    if (!ofPoints)
    {
      fields = data->GetCellData();
    }
    vtkNew<vtkDoubleArray> array; // whatever the type was
    array->DeepCopy(fields->GetArray(name));
    array->SetName(name);
    array->SetComponent(array->GetNumberOfTuples() / 2, 0, value);
    fields->AddArray(array);
  };
}

/// Of all cells.
Lie all(const char* name, double value)
{
  return [=](vtkPolyData* data)
  {
    vtkDataArray* array = data->GetCellData()->GetArray(name);
    array->Fill(value);
  };
}

/// Of the last cell.
Lie lastName(const char* of, const char* value)
{
  return [=](vtkPolyData* data)
  {
    auto* names = vtkStringArray::SafeDownCast(data->GetCellData()->GetAbstractArray(of));
    names->SetValue(names->GetNumberOfValues() - 1, value);
  };
}

Lie pointOf(double x)
{
  return [x](vtkPolyData* data)
  {
    double p[3];
    data->GetPoint(2, p);
    data->GetPoints()->SetPoint(2, p[0], x, p[2]);
  };
}

class TestLyingInputs : public SimulationTest
{
protected:
  /// The simulation has one error and no result of each of these rocks.
  void ExpectRefused(int port, vtkAlgorithm* source, const std::vector<Case>& cases)
  {
    source->Update();
    vtkDataObject* whole = source->GetOutputDataObject(0);
    for (const Case& lying : cases)
    {
      SCOPED_TRACE(lying.name);
      vtkNew<vtkPolyData> data;
      data->DeepCopy(whole);
      lying.lie(data);
      this->Simulation->SetInputData(port, data);
      this->ExpectEmpty();
      this->ExpectOneError(lying.words);
    }
    this->Simulation->SetInputConnection(port, source->GetOutputPort());
  }
};

} // namespace

TEST_F(TestLyingInputs, RocksAreRefusedByName)
{
  const std::string rocks = "The Rocks input";
  this->ExpectRefused(1, this->Rocks,
    {
      { "a point far beyond", pointsAt(1'000'000'000),
        { rocks, "point 1000000000", "there are 8" } },
      { "the next point", pointsAt(8), { rocks, "point 8" } },
      { "a negative point", pointsAt(-1), { rocks, "point -1" } },
      { "a cell that ends beyond", offsetsAt(6, 4000), { rocks, "4000" } },
      { "a cell that ends before it begins", offsetsAt(2, 1), { rocks, "from place" } },
      { "an array of nothing", length(false, "Density", 0), { rocks, "Density", "0 tuples" } },
      { "a short array", length(false, "Velocity", 5), { rocks, "Velocity", "5 tuples for 6" } },
      { "a short array of names", length(false, "Material", 1), { rocks, "Material" } },
      { "a long array", length(false, "BlockId", 7), { rocks, "BlockId", "7 tuples" } },
      { "NaN for a point", pointOf(std::nan("")), { rocks, "point 2", "nan" } },
      { "an infinite point", pointOf(inf), { rocks, "point 2", "inf" } },
      { "NaN for a number", number(false, "BlockId", std::nan("")), { rocks, "BlockId", "nan" } },
      { "a half block", number(false, "BlockId", 1.5), { rocks, "BlockId", "1.5" } },
      { "a source of 1e300", number(false, "SourceId", 1e300), { rocks, "SourceId", "1e+300" } },
      { "an infinite shape", number(false, "Shape", inf), { rocks, "Shape", "inf" } },
      { "two densities", number(false, "Density", 1000.0), { rocks, "Density", "1000", "block" } },
      { "two velocities", number(false, "Velocity", 3.0), { rocks, "Velocity", "0 in cell", "3" } },
      { "two materials", lastName("Material", "slag"), { rocks, "Material", "slag" } },
      { "no density", all("Density", 0.0), { "block", "Density is 0" } },
      { "a negative density", all("Density", -2700.0), { "block", "Density is -2700" } },
      { "no modulus", all("YoungModulus", 0.0), { "block", "YoungModulus is 0" } },
      { "no points at all", [](vtkPolyData* data) { data->SetPoints(nullptr); }, { rocks } },
    });
}

TEST_F(TestLyingInputs, TerrainsAreRefusedByName)
{
  const std::string terrain = "The Terrain input";
  const auto field = [](const char* name, int place, double value)
  {
    return [=](vtkPolyData* data)
    {
      vtkNew<vtkDoubleArray> array;
      array->DeepCopy(data->GetFieldData()->GetArray(name));
      array->SetName(name);
      array->SetComponent(0, place, value);
      data->GetFieldData()->AddArray(array);
    };
  };
  this->ExpectRefused(0, this->Terrain,
    {
      { "a point far beyond", pointsAt(1'000'000'000), { terrain, "point 1000000000" } },
      { "a short array", length(false, "CFEId", 3), { terrain, "CFEId", "3 tuples" } },
      { "an infinite cell size", field("TerrainGrid", 2, inf), { terrain, "TerrainGrid", "inf" } },
      { "NaN for its place", field("TerrainGrid", 3, std::nan("")), { terrain, "TerrainGrid" } },
      { "more columns", field("TerrainGrid", 0, 1e9), { "heights" } },
      { "NaN for a coefficient", field("TerrainMaterial", 0, std::nan("")),
        { terrain, "TerrainMaterial" } },
    });
}

TEST_F(TestLyingInputs, TrajectoriesAreRefusedByEveryFilter)
{
  this->Simulation->Update();
  auto* good = vtkPolyData::SafeDownCast(this->Simulation->GetOutputDataObject(1));
  vtkNew<vtkLineSource> line;
  line->SetPoint1(6, 0, 0);
  line->SetPoint2(6, 100, 0);
  const Case cases[] = {
    { "a point far beyond", pointsAt(1'000'000'000), { "The Input", "point 1000000000" } },
    { "a short array of points", length(true, "Velocity", 3), { "The Input", "Velocity" } },
    { "a short array of lines", length(false, "Iteration", 0), { "The Input", "Iteration" } },
    { "NaN for a point", pointOf(std::nan("")), { "The Input", "point 2" } },
  };
  for (const Case& lying : cases)
  {
    SCOPED_TRACE(lying.name);
    vtkNew<vtkPolyData> data;
    data->DeepCopy(good);
    lying.lie(data);
    vtkNew<vtkTrajectoryCollector> collector;
    collector->SetInputData(0, data);
    collector->SetInputConnection(1, line->GetOutputPort());
    collector->Update();
    this->ExpectOneError(lying.words);
    vtkNew<vtkDispersionAngle> dispersion;
    dispersion->SetInputData(data);
    dispersion->Update();
    this->ExpectOneError(lying.words);
    vtkNew<vtkRockfallHazardMap> map;
    map->SetInputData(0, data);
    map->SetInputConnection(1, this->Terrain->GetOutputPort());
    map->Update();
    this->ExpectOneError(lying.words);
    vtkNew<vtkTrajectoryLayerWriter> layer;
    layer->SetInputData(data);
    layer->SetFileName(this->WriteFile("lines.gpkg", "").c_str());
    layer->Write();
    this->ExpectOneError(lying.words);
    vtkNew<vtkHazardPassageWriter> passages;
    passages->SetInputData(0, data);
    passages->SetInputConnection(1, this->Terrain->GetOutputPort());
    passages->SetFileName(this->WriteFile("run.passages", "").c_str());
    passages->Write();
    this->ExpectOneError(lying.words);
  }
}

TEST_F(TestLyingInputs, NumbersOfTrajectoriesMustBeSuch)
{
  this->Simulation->Update();
  auto* good = vtkPolyData::SafeDownCast(this->Simulation->GetOutputDataObject(1));
  const Case cases[] = {
    { "NaN for a time", number(true, "Time", std::nan("")), { "Time", "nan" } },
    { "an infinite energy", number(true, "KineticEnergy", inf), { "KineticEnergy", "inf" } },
    { "an iteration of 1e300", number(false, "Iteration", 1e300), { "Iteration", "1e+300" } },
    { "NaN for a rock", number(false, "RockId", std::nan("")), { "RockId", "nan" } },
    { "half a fate", number(false, "Fate", 0.5), { "Fate", "0.5" } },
    { "a fate that there is not", number(false, "Fate", -5.0), { "Fate", "-5", "0 to 5" } },
    { "a fate of a later version", number(false, "Fate", 6.0), { "Fate", "6", "0 to 5" } },
    { "a path back in time", number(true, "Time", 0.0), { "back in time" } },
    { "an energy below 0", number(true, "KineticEnergy", -5.0), { "KineticEnergy", "-5" } },
    { "a spin of no rock", number(true, "RotationRate", 1e300), { "RotationRate", "1e+300" } },
    { "a height of no slope", number(true, "HeightOverGround", 1e300), { "1e+300" } },
    { "an infinite width", number(false, "Width", inf), { "Width", "inf" } },
    { "NaN for a volume", number(false, "Volume", std::nan("")), { "Volume", "nan" } },
    { "a mass of no rock", number(false, "Mass", 1e300), { "Mass", "1e+300" } },
    { "a pair of times",
      [](vtkPolyData* data)
      {
        vtkNew<vtkDoubleArray> pairs;
        pairs->SetName("Time");
        pairs->SetNumberOfComponents(2);
        pairs->SetNumberOfTuples(data->GetNumberOfPoints());
        pairs->Fill(1.0);
        data->GetPointData()->AddArray(pairs);
      },
      { "Time has 2 components, it must have 1" } },
  };
  for (const Case& lying : cases)
  {
    SCOPED_TRACE(lying.name);
    vtkNew<vtkPolyData> data;
    data->DeepCopy(good);
    lying.lie(data);
    vtkNew<vtkRockfallHazardMap> map;
    map->SetInputData(0, data);
    map->SetInputConnection(1, this->Terrain->GetOutputPort());
    map->Update();
    this->ExpectOneError(lying.words);
    vtkNew<vtkGrowingPaths> paths;
    paths->SetInputData(data);
    paths->Update();
    this->ExpectOneError(lying.words);
    EXPECT_EQ(paths->GetOutput()->GetNumberOfCells(), 0);
  }
  vtkNew<vtkPolyData> data;
  data->DeepCopy(good);
  vtkNew<vtkDoubleArray> groups;
  groups->SetName("Groups");
  groups->InsertNextValue(std::nan(""));
  data->GetCellData()->AddArray(groups);
  vtkNew<vtkDispersionAngle> dispersion;
  dispersion->SetInputData(data);
  dispersion->SetGroupBy("Groups");
  dispersion->Update();
  this->ExpectOneError({ "Groups", "nan" });
}

TEST_F(TestLyingInputs, LinesAndCrossingsAreRefusedToo)
{
  this->Simulation->Update();
  vtkNew<vtkLineSource> line;
  line->SetPoint1(6, 0, 0);
  line->SetPoint2(6, 100, 0);
  line->SetResolution(4);
  line->Update();
  vtkNew<vtkTrajectoryCollector> collector;
  collector->SetInputConnection(0, this->Simulation->GetOutputPort(1));
  for (const Case& lying : { Case{ "a point beyond", pointsAt(77), { "The Lines input", "77" } },
         Case{ "NaN", pointOf(std::nan("")), { "The Lines input", "nan" } } })
  {
    SCOPED_TRACE(lying.name);
    vtkNew<vtkPolyData> data;
    data->DeepCopy(line->GetOutput());
    lying.lie(data);
    collector->SetInputData(1, data);
    collector->Update();
    this->ExpectOneError(lying.words);
  }
  collector->SetInputConnection(1, line->GetOutputPort());
  collector->Update();
  auto* good = vtkPolyData::SafeDownCast(collector->GetOutputDataObject(0));
  ASSERT_GT(good->GetNumberOfPoints(), 0);
  for (const Case& lying :
    { Case{ "a short array", length(true, "Velocity", 0), { "The Input's part 1", "Velocity" } },
      Case{ "a line of 1e300", number(true, "Line", 1e300), { "The Input's part 1", "Line" } } })
  {
    SCOPED_TRACE(lying.name);
    vtkNew<vtkPolyData> data;
    data->DeepCopy(good);
    lying.lie(data);
    vtkNew<vtkMergeCollectors> merge;
    merge->SetInputData(data);
    merge->Update();
    this->ExpectOneError(lying.words);
  }
}

TEST_F(TestLyingInputs, SinglePrecisionFarFromTheOriginIsAnError)
{
  // ParaView's own sources of shapes make it.
  std::string grid = "ncols 21\nnrows 11\nxllcorner 600000\nyllcorner 5200000\ncellsize 5\n";
  for (int row = 0; row < 11; ++row)
  {
    for (int column = 0; column < 21; ++column)
    {
      grid += std::to_string(1000 - 3 * column) + " ";
    }
    grid += "\n";
  }
  this->Terrain->SetFileName(this->WriteFile("far.asc", grid).c_str());
  vtkNew<vtkCubeSource> box;
  box->SetXLength(1.3);
  box->SetYLength(0.9);
  box->SetZLength(0.7);
  box->SetCenter(600050.123, 5200031.234, 990.0);
  this->Simulation->SetInputConnection(1, box->GetOutputPort());
  this->ExpectEmpty();
  this->ExpectOneError({ "The Rocks input", "block 0", "in single precision", "0.25 m", "Center" });
  // Stored in double, it is still what it was.
  box->Update();
  vtkNew<vtkPolyData> twice;
  twice->DeepCopy(box->GetOutput());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->DeepCopy(box->GetOutput()->GetPoints());
  twice->SetPoints(points);
  this->Simulation->SetInputData(1, twice);
  this->ExpectEmpty();
  this->ExpectOneError({ "in single precision" });
  // The remedy works.
  box->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  this->Simulation->SetInputConnection(1, box->GetOutputPort());
  EXPECT_NEAR(this->Summary()->GetValueByName(0, "Volume").ToDouble(), 0.819, 1e-9);
}

TEST_F(TestLyingInputs, ValuesBeyondAnyRocksAreRefused)
{
  this->Rocks->SetVelocity(1e300, 0, 0);
  this->Rocks->Update();
  this->ExpectOneError({ "Velocity", "1e+300 m/s", "no rock has more than 1000" });
  this->Rocks->SetVelocity(0, 0, 0);
  this->Rocks->SetAngularVelocity(0, 1e6, 0);
  this->Rocks->Update();
  this->ExpectOneError({ "AngularVelocity", "1000000 rad/s", "10000" });
  this->Rocks->SetAngularVelocity(0, 0, 0);
  this->ExpectRefused(1, this->Rocks,
    { { "by pipeline",
      [](vtkPolyData* data) { data->GetCellData()->GetArray("Density")->FillComponent(0, 1e300); },
      { "block 1", "Density", "1e+300" } } });
}
