#include "helpers.h"

#include "base/errors.h"
#include "shared/terrainFieldData.h"
#include "terrain/presets.h"

#include "vtkCellData.h"
#include "vtkDEMToCFESource.h"
#include "vtkDoubleArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

namespace
{

/// 4 columns × 3 rows of 10 m, far from the coordinates' origin, with one node of nodata.
constexpr char grid[] = "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\n"
                        "NODATA_value -9999\n"
                        "9 8 7 6\n"
                        "5 4 3 -9999\n"
                        "2 1.5 1.25 1\n";

class TestDEMToCFESource : public FilterTest
{
protected:
  vtkPolyData* Update()
  {
    this->Source->Update();
    return this->Source->GetOutput();
  }
  vtkNew<vtkDEMToCFESource> Source;
};

} // namespace

TEST_F(TestDEMToCFESource, DefaultIsTheBiplanarSlope)
{
  vtkPolyData* mesh = this->Update();
  EXPECT_EQ(mesh->GetNumberOfCells(), 2 * 50 * 20); // 250 m × 100 m of 5 m cells
  EXPECT_EQ(mesh->GetNumberOfPoints(), 51 * 21);
  double bounds[6];
  mesh->GetBounds(bounds);
  const double expected[6] = { 0, 250, 0, 100, 0, 57.7 };
  for (int k = 0; k < 6; ++k)
  {
    EXPECT_DOUBLE_EQ(bounds[k], expected[k]);
  }
  EXPECT_EQ(value(mesh->GetCellData(), "RestitutionCoefficient"), 0.8);
  EXPECT_NEAR(value(mesh->GetCellData(), "FrictionAngle"), 15.0, 1e-12);
  EXPECT_EQ(value(mesh->GetPointData(), "Elevation"), 57.7); // the first node is the north-west one
}

TEST_F(TestDEMToCFESource, TrianglesAreInTheOrderOfTheNumberingAndFaceUp)
{
  this->Source->SetFileName(this->WriteFile("grid.asc", grid).c_str());
  this->Source->SetCellDiagonal(1); // the paper's cut
  vtkPolyData* mesh = this->Update();
  // 3 × 2 cells have 12 CFEs. The node without height is a corner of both triangles of the upper
  // right cell, and of the upper one of the cell below: 5, 6 and 12.
  const std::vector<int> numbers = { 1, 2, 3, 4, 7, 8, 9, 10, 11 };
  ASSERT_EQ(mesh->GetNumberOfCells(), vtkIdType(numbers.size()));
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    EXPECT_EQ(value(mesh->GetCellData(), "CFEId", cell), numbers[std::size_t(cell)]);
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    mesh->GetCellPoints(cell, size, ids);
    ASSERT_EQ(size, 3);
    double a[3], b[3], c[3];
    mesh->GetPoint(ids[0], a);
    mesh->GetPoint(ids[1], b);
    mesh->GetPoint(ids[2], c);
    const double twiceArea =
      (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]); // of the horizontal projection
    EXPECT_NEAR(twiceArea, 100.0, 1e-6);
    // Upper left, lower left, lower right; and upper left, lower right, upper right.
    if (numbers[std::size_t(cell)] % 2 == 1)
    {
      EXPECT_DOUBLE_EQ(a[0], b[0]);
      EXPECT_DOUBLE_EQ(b[1], c[1]);
    }
    else
    {
      EXPECT_DOUBLE_EQ(b[0], c[0]);
      EXPECT_DOUBLE_EQ(a[1], c[1]);
    }
  }
}

TEST_F(TestDEMToCFESource, CoordinatesAreRealAndDouble)
{
  this->Source->SetFileName(this->WriteFile("grid.asc", grid).c_str());
  vtkPolyData* mesh = this->Update();
  EXPECT_EQ(mesh->GetPoints()->GetDataType(), VTK_DOUBLE);
  // None for the node without height, nor for the corner whose only CFE would touch it.
  EXPECT_EQ(mesh->GetNumberOfPoints(), 10);
  double p[3];
  mesh->GetPoint(0, p); // the pixel's centre is the node
  EXPECT_EQ(p[0], 500005.0);
  EXPECT_EQ(p[1], 4000025.0);
  EXPECT_EQ(p[2], 9.0);
  EXPECT_EQ(value(mesh->GetFieldData(), "LocalOrigin", 0, 0), 500005.0);
  EXPECT_EQ(value(mesh->GetFieldData(), "LocalOrigin", 0, 1), 4000005.0);
}

TEST_F(TestDEMToCFESource, FieldDataSurviveAFile)
{
  this->Source->SetFileName(this->WriteFile("grid.asc", grid).c_str());
  this->Source->SetRoughnessDeviation(0.25);
  this->Source->SetFrictionAngle(30.0);
  vtkPolyData* mesh = this->Update();
  const std::string file = this->WriteFile("mesh.vtp", "");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetDataModeToBinary();
  writer->SetInputData(mesh);
  writer->SetFileName(file.c_str());
  ASSERT_EQ(writer->Write(), 1);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkFieldData* before = mesh->GetFieldData();
  vtkFieldData* after = reader->GetOutput()->GetFieldData();
  for (const char* name : { "TerrainHeights", "TerrainGrid", "TerrainMaterial", "LocalOrigin" })
  {
    vtkDataArray* a = before->GetArray(name);
    vtkDataArray* b = after->GetArray(name);
    ASSERT_TRUE(a && b) << name;
    ASSERT_EQ(a->GetNumberOfValues(), b->GetNumberOfValues()) << name;
    for (vtkIdType k = 0; k < a->GetNumberOfValues(); ++k)
    {
      const double x = a->GetVariantValue(k).ToDouble();
      const double y = b->GetVariantValue(k).ToDouble();
      EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << name << " " << k;
    }
  }
  EXPECT_TRUE(after->GetAbstractArray("TerrainCRS"));
}

TEST_F(TestDEMToCFESource, RestitutionTravelsInTheFieldData)
{
  this->Source->SetRestitutionModel(vtkDEMToCFESource::SPEED_DEPENDENT);
  this->Source->SetRestitutionCoefficient(0.4);
  this->Source->SetTangentialRestitution(0.9);
  this->Source->SetRestitutionSpeed(5.0);
  vtkFieldData* data = this->Update()->GetFieldData();
  EXPECT_EQ(value(data, "TerrainMaterial", 0, 0), 0.4);
  EXPECT_EQ(value(data, "TerrainMaterial", 0, 7), 2.0);
  EXPECT_EQ(value(data, "TerrainMaterial", 0, 8), 0.9);
  EXPECT_EQ(value(data, "TerrainMaterial", 0, 9), 5.0);
}

TEST_F(TestDEMToCFESource, RoughnessAndScatterTravelInTheFieldData)
{
  const std::string zones =
    this->WriteFile("zones.csv", "WKT,class\n\"POLYGON((0 0,100 0,100 100,0 100,0 0))\",scree\n");
  const std::string table = this->WriteFile("table.csv", "class,rv,rg70\nscree,0.5,0.2\n");
  this->Source->SetRestitutionLayer(zones.c_str());
  this->Source->SetRestitutionTable(table.c_str());
  this->Source->SetRoughnessMean(0.1);
  this->Source->SetRoughnessDeviation(0.3);
  this->Source->SetRoughnessLength(2.0);
  this->Source->SetObstacleHeight70(0.4);
  this->Source->SetObstacleHeight20(0.5);
  this->Source->SetObstacleHeight10(0.6);
  this->Source->SetDeviationPer(vtkDEMToCFESource::PER_PLACE);
  const rockfall::Terrain read = rockfall::filters::readTerrain(this->Update());
  EXPECT_EQ(read.roughness(), (rockfall::Roughness{ 0.1, 0.3, 2.0, { 0.4, 0.5, 0.6 } }));
  EXPECT_EQ(read.roughnessOf(1), (rockfall::Roughness{ 0.1, 0.3, 2.0, { 0.2, 0.5, 0.6 } }));
  EXPECT_EQ(read.deviationPer(), rockfall::DeviationPer::Place);
  EXPECT_EQ(read.refinement(), 10); // cells of 5 m, obstacles 2 m apart
  // As files had it before.
  vtkFieldData* data = this->Source->GetOutput()->GetFieldData();
  for (const char* name :
    { "TerrainRoughness", "TerrainRestitutionRoughness", "TerrainDeviationPer" })
  {
    data->RemoveArray(name);
  }
  const rockfall::Terrain old = rockfall::filters::readTerrain(this->Source->GetOutput());
  EXPECT_EQ(old.roughnessOf(1), (rockfall::Roughness{ 0.1, 0.3 }));
  EXPECT_EQ(old.deviationPer(), rockfall::DeviationPer::Iteration);
}

TEST_F(TestDEMToCFESource, ClassesKeepTheScatterOfTheirPresets)
{
  const std::string zones =
    this->WriteFile("zones.csv", "WKT,class\n\"POLYGON((0 0,100 0,100 100,0 100,0 0))\",b\n");
  const std::string table =
    this->WriteFile("table.csv", "class,preset,rv\na,rock,\nb,meadow,\nc,,0.5\n");
  const std::string joints = this->WriteFile("joints.csv", "class,preset,phi\nb,meadow,\nc,,30\n");
  this->Source->SetRestitutionLayer(zones.c_str());
  this->Source->SetRestitutionTable(table.c_str());
  this->Source->SetJointLayer(zones.c_str());
  this->Source->SetJointTable(joints.c_str());
  this->Source->SetDeviationPer(vtkDEMToCFESource::PER_PLACE);
  const rockfall::Terrain read = rockfall::filters::readTerrain(this->Update());
  const auto per = [](const rockfall::Terrain& terrain, int number)
  { return terrain.deviationPerOf(terrain.restitutionMaterial(number)); };
  EXPECT_EQ(per(read, 0), rockfall::DeviationPer::Place);
  EXPECT_EQ(per(read, 1), rockfall::DeviationPer::Iteration);
  EXPECT_EQ(per(read, 2), rockfall::DeviationPer::Impact);
  EXPECT_EQ(per(read, 3), rockfall::DeviationPer::Place); // as the slope
  EXPECT_EQ(read.deviationPerOf(read.jointMaterial(1)), rockfall::DeviationPer::Impact);
  EXPECT_EQ(read.deviationPerOf(read.jointMaterial(2)), rockfall::DeviationPer::Place);
  // As files had it before: that of the slope.
  vtkFieldData* data = this->Source->GetOutput()->GetFieldData();
  for (const char* name : { "TerrainRestitutionDeviationPer", "TerrainJointDeviationPer" })
  {
    ASSERT_TRUE(data->HasArray(name));
    data->RemoveArray(name);
  }
  EXPECT_EQ(per(rockfall::filters::readTerrain(this->Source->GetOutput()), 2),
    rockfall::DeviationPer::Place);
}

TEST_F(TestDEMToCFESource, CutOfCellsTravelsInTheFieldData)
{
  // One cell that is higher in its upper left corner: the shorter fold joins the other two.
  const std::string corner = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n5 1\n1 0\n";
  this->Source->SetFileName(this->WriteFile("corner.asc", corner).c_str());
  for (const int diagonal : { 0, 1 })
  {
    this->Source->SetCellDiagonal(diagonal);
    vtkPolyData* mesh = this->Update();
    const rockfall::Terrain read = rockfall::filters::readTerrain(mesh);
    EXPECT_EQ(int(read.geometry().diagonal), diagonal);
    EXPECT_EQ(read.isRising(0, 0), diagonal == 0);
    // In the middle of the cell: half of 1 + 1, or of 5 + 0.
    EXPECT_DOUBLE_EQ(read.elevation(5.0, 5.0), diagonal == 0 ? 1.0 : 2.5);
    for (vtkIdType cell = 0; cell < 2; ++cell)
    {
      vtkNew<vtkIdList> shown;
      mesh->GetCellPoints(cell, shown);
      const auto nodes = read.cfeNodes(cell + 1);
      for (vtkIdType k = 0; k < 3; ++k)
      {
        EXPECT_EQ(shown->GetId(k), nodes[std::size_t(k)]) << cell;
      }
    }
  }
  // A file of before there was a choice.
  this->Source->GetOutput()->GetFieldData()->RemoveArray("TerrainCellDiagonal");
  EXPECT_EQ(rockfall::filters::readTerrain(this->Source->GetOutput()).geometry().diagonal,
    rockfall::CellDiagonal::FromUpperLeft);
  this->Source->SetCellDiagonal(2);
  this->Update();
  this->ExpectOneError({ "CellDiagonal is 2", "0 (shorter fold)", "1 (from upper left)" });
}

TEST_F(TestDEMToCFESource, HeightsOutliveTheSource)
{
  vtkNew<vtkPolyData> copy;
  {
    vtkNew<vtkDEMToCFESource> source;
    source->Update();
    copy->ShallowCopy(source->GetOutput());
  }
  auto* heights = vtkDoubleArray::SafeDownCast(copy->GetFieldData()->GetArray("TerrainHeights"));
  ASSERT_TRUE(heights);
  ASSERT_EQ(heights->GetNumberOfValues(), 51 * 21);
  EXPECT_EQ(heights->GetValue(0), 57.7);
  EXPECT_EQ(heights->GetValue(50), 0.0);
}

TEST_F(TestDEMToCFESource, BigSlopesAreShownCoarser)
{
  this->Source->SetMaximumDisplayCells(600);
  vtkPolyData* mesh = this->Update();
  // Every second node: 25 × 10 cells.
  EXPECT_EQ(mesh->GetNumberOfCells(), 500);
  EXPECT_EQ(mesh->GetFieldData()->GetArray("TerrainHeights")->GetNumberOfValues(), 51 * 21);
  ASSERT_EQ(this->Heard->Notes.size(), 2u); // the first one: bare rock
  EXPECT_NE(this->Heard->Notes[1].find("Maximum Display Cells"), std::string::npos);
  // The second cell of the second row is that of node (2, 2): 2 · (2 · 50 + 2) + 1.
  EXPECT_EQ(value(mesh->GetCellData(), "CFEId", 2 * 26), 205);
}

TEST_F(TestDEMToCFESource, NotesAreShownAndKept)
{
  this->Source->SetFileName(this->WriteFile("grid.asc", grid).c_str());
  this->Source->SetCellSize(5.0);
  vtkPolyData* mesh = this->Update();
  auto* notes = vtkStringArray::SafeDownCast(mesh->GetFieldData()->GetAbstractArray("Notes"));
  ASSERT_TRUE(notes);
  ASSERT_GE(notes->GetNumberOfValues(), 1);
  EXPECT_EQ(vtkIdType(this->Heard->Notes.size()), notes->GetNumberOfValues());
}

TEST_F(TestDEMToCFESource, TheGroundIsNamed)
{
  const auto ground = [&](vtkPolyData* mesh)
  {
    auto* words = vtkStringArray::SafeDownCast(mesh->GetFieldData()->GetAbstractArray("Ground"));
    return words ? std::string(words->GetValue(0)) : std::string();
  };
  EXPECT_EQ(ground(this->Update()), "hard, for comparison with published DDA");
  ASSERT_EQ(this->Heard->Notes.size(), 1u);
  EXPECT_NE(this->Heard->Notes[0].find("bare rock"), std::string::npos);
  this->Heard->Notes.clear();
  this->Source->SetPreset(rockfall::usualPreset());
  EXPECT_EQ(ground(this->Update()), "Meadow (field data)");
  ASSERT_EQ(this->Heard->Notes.size(), 1u); // where it errs
  EXPECT_NE(this->Heard->Notes[0].find("Meadow is too fast on long slopes"), std::string::npos);
  this->Source->SetPreset(0);
  this->Source->SetRollingResistance(0.2);
  EXPECT_EQ(ground(this->Update()), "typed numbers");
  const std::string zones =
    this->WriteFile("zones.csv", "WKT,class\n\"POLYGON((0 0,40 0,40 100,0 100,0 0))\",cliff\n");
  const std::string table = this->WriteFile("table.csv", "class,preset\ncliff,rock\n");
  this->Source->SetRestitutionLayer(zones.c_str());
  this->Source->SetRestitutionTable(table.c_str());
  this->Heard->Notes.clear();
  EXPECT_EQ(ground(this->Update()), "classes cliff, elsewhere typed numbers");
  EXPECT_EQ(std::ranges::count_if(this->Heard->Notes,
              [](const std::string& note)
              { return note.find("The preset Rock stops rocks too soon") != std::string::npos; }),
    1);
}

TEST_F(TestDEMToCFESource, BadValuesAreOneErrorAndNothingElse)
{
  const std::string missing = "/no/such/file.tif";
  this->Source->SetFileName(missing.c_str());
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ missing });
  this->Update(); // nothing has changed
  EXPECT_TRUE(this->Heard->Errors.empty());

  this->Source->SetFileName("");
  this->Source->SetRestitutionCoefficient(1.5);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "RestitutionCoefficient", "1.5" });
  this->Source->SetRestitutionCoefficient(0.8);

  this->Source->SetRestitutionModel(3);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "RestitutionModel", "3" });
  this->Source->SetRestitutionModel(vtkDEMToCFESource::NORMAL_TANGENTIAL);

  this->Source->SetTangentialRestitution(-0.5);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "TangentialRestitution", "-0.5" });
  this->Source->SetTangentialRestitution(1.0);

  this->Source->SetRestitutionSpeed(0.0);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "RestitutionSpeed", "0" });
  this->Source->SetRestitutionSpeed(9.144);

  this->Source->SetFrictionAngle(90.0);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "FrictionAngle", "90" });
  this->Source->SetFrictionAngle(15.0);

  this->Source->SetCellSize(-2.0);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "CellSize", "-2" });
  this->Source->SetCellSize(0.0);

  EXPECT_EQ(this->Update()->GetNumberOfCells(), 2000); // and it recovers
}

TEST_F(TestDEMToCFESource, ClassesAreArraysOfTheMeshAndSurviveAFile)
{
  this->Source->SetFileName(this->WriteFile("grid.asc", grid).c_str());
  // 15 m cells over the western half and nothing over the rest.
  const std::string layer = this->WriteFile(
    "classes.asc", "ncols 1\nnrows 2\nxllcorner 500000\nyllcorner 4000000\ncellsize 15\n3\n3\n");
  this->Source->SetRestitutionLayer(layer.c_str());
  this->Source->SetRestitutionTable(
    this->WriteFile("rv.csv", "class,name,rv\n1,rock,0.9\n3,talus,0.4\n").c_str());
  this->Source->SetJointLayer(layer.c_str());
  this->Source->SetJointTable(
    this->WriteFile("phi.csv", "class,phi,phi_deviation\n3,35,2\n").c_str());
  vtkPolyData* mesh = this->Update();
  ASSERT_EQ(mesh->GetNumberOfCells(), 9);
  for (vtkIdType cell = 0; cell < 9; ++cell)
  {
    // Cells of the slope are centred at x = 10, 20 and 30 m, the layer ends at 15 m.
    const bool covered = (int(value(mesh->GetCellData(), "CFEId", cell)) - 1) / 2 % 3 == 0;
    EXPECT_EQ(value(mesh->GetCellData(), "RestitutionClass", cell), covered ? 2 : 0);
    EXPECT_EQ(value(mesh->GetCellData(), "RestitutionCoefficient", cell), covered ? 0.4 : 0.8);
    EXPECT_EQ(value(mesh->GetCellData(), "JointClass", cell), covered ? 1 : 0);
    EXPECT_NEAR(value(mesh->GetCellData(), "FrictionAngle", cell), covered ? 35.0 : 15.0, 1e-12);
  }
  const std::string file = this->WriteFile("mesh.vtp", "");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(mesh);
  writer->SetFileName(file.c_str());
  ASSERT_EQ(writer->Write(), 1);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  for (vtkPolyData* data : { mesh, reader->GetOutput() })
  {
    const rockfall::Terrain terrain = rockfall::filters::readTerrain(data);
    ASSERT_EQ(terrain.restitutionClasses().count(), 2);
    EXPECT_EQ(terrain.restitutionClasses().names[1], "talus");
    EXPECT_EQ(terrain.restitutionMaterial(2).restitution, 0.4);
    EXPECT_EQ(terrain.restitutionClasses().at(1), 2);
    EXPECT_EQ(terrain.restitutionClasses().at(3), 0);
    ASSERT_EQ(terrain.jointClasses().count(), 1);
    EXPECT_DOUBLE_EQ(terrain.jointMaterial(1).frictionAngleDeviation, rockfall::radians(2.0));
  }
  reader->GetOutput()->GetFieldData()->RemoveArray("TerrainJointNames");
  EXPECT_THROW(rockfall::filters::readTerrain(reader->GetOutput()), rockfall::DataError);
}

TEST_F(TestDEMToCFESource, ContoursAndPresets)
{
  this->Source->SetFileName(
    this
      ->WriteFile(
        "contours.csv", "WKT,elev\n\"LINESTRING(0 0,50 0)\",10\n\"LINESTRING(0 30,50 30)\",20\n")
      .c_str());
  this->Source->SetCellSize(5.0);
  this->Source->SetPreset(4); // talus
  vtkPolyData* mesh = this->Update();
  EXPECT_EQ(mesh->GetNumberOfCells(), 2 * 10 * 6);
  EXPECT_EQ(value(mesh->GetPointData(), "Elevation"), 20.0);
  EXPECT_EQ(value(mesh->GetCellData(), "RestitutionCoefficient"), 0.6);
  EXPECT_EQ(value(mesh->GetFieldData(), "TerrainMaterial", 0, 7), 2.0); // speed-dependent
  // The preset's stones, not the roughness of the fields that it replaces.
  const rockfall::Roughness& stones = rockfall::groundPresets()[3].roughness;
  EXPECT_EQ(value(mesh->GetFieldData(), "TerrainRoughness", 0, 0), 0.0);
  EXPECT_EQ(value(mesh->GetFieldData(), "TerrainRoughness", 0, 2), stones.length);
  EXPECT_EQ(value(mesh->GetFieldData(), "TerrainRoughness", 0, 5), stones.obstacles[2]);
  this->Source->SetElevationField("height");
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "contours.csv", "height", "ElevationField", "elev" });
  this->Source->SetElevationField("");
  this->Source->SetPreset(8);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "Preset", "8" });
  this->Source->SetPreset(0);
  this->Source->SetJointTable("/no/such/table.csv");
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "JointTable", "/no/such/table.csv", "JointLayer" });
}

TEST_F(TestDEMToCFESource, PrintSelfNamesEveryProperty)
{
  std::ostringstream text;
  this->Source->Print(text);
  for (const char* name :
    { "FileName", "CellSize", "CellDiagonal", "Band", "ElevationField", "RelaxFlats", "Preset",
      "RestitutionLayer", "RestitutionTable", "RestitutionField", "JointLayer", "JointTable",
      "JointField", "RestitutionModel", "RestitutionCoefficient", "RestitutionDeviation",
      "TangentialRestitution", "RestitutionSpeed", "FrictionAngle", "FrictionAngleDeviation",
      "Cohesion", "RoughnessMean", "RoughnessDeviation", "MaximumDisplayCells" })
  {
    EXPECT_NE(text.str().find(std::string(name) + ":"), std::string::npos) << name;
  }
}
