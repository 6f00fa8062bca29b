// What two rocks do to each other by what they are made of: the material's way from the source to
// the run, and the table of pairs.
#include "simulationTest.h"

#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkIntArray.h"
#include "vtkJointedRockMass.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

namespace
{

const std::string header = "material_a,material_b,restitution,phi,cohesion\n";

std::string materialOf(vtkPolyData* rocks, vtkIdType cell = 0)
{
  auto* names = vtkStringArray::SafeDownCast(rocks->GetCellData()->GetAbstractArray("Material"));
  return names ? std::string(names->GetValue(cell)) : "no array";
}

/// Two cubes that hit each other high over the slope, a granite one and one of slag.
class TestRockContactFile : public SimulationTest
{
protected:
  void SetUp() override
  {
    this->SimulationTest::SetUp();
    this->Rocks->SetCenter(40, 50, 60);
    this->Rocks->SetVelocity(5, 0, 0);
    this->Rocks->SetMaterial(1);
    this->Other->SetAttitudeLaw(vtkRockBlockSource::AS_GIVEN);
    this->Other->SetCenter(44, 50, 60);
    this->Other->SetVelocity(-3, 0, 0);
    this->Other->SetMaterialName("Slag");
    this->Other->SetFirstBlockId(2);
    this->Both->AddInputConnection(this->Rocks->GetOutputPort());
    this->Both->AddInputConnection(this->Other->GetOutputPort());
    this->Simulation->SetInputConnection(1, this->Both->GetOutputPort());
    this->Simulation->SetRockRockContact(true);
    this->Simulation->SetRockRestitution(0.5);
    this->Simulation->SetEndTime(1.0);
  }

  void SetTable(const std::string& rows)
  {
    const std::string name = "contacts" + std::to_string(++this->Tables) + ".csv";
    this->Simulation->SetRockContactFile(this->WriteFile(name, header + rows).c_str());
  }

  /// With which the two met.
  double Restitution()
  {
    vtkPolyData* impacts = this->Output(2);
    for (vtkIdType k = 0; k < impacts->GetNumberOfPoints(); ++k)
    {
      if (value(impacts->GetPointData(), "OtherBlockId", k) > 0)
      {
        return value(impacts->GetPointData(), "Restitution", k);
      }
    }
    return -1.0;
  }

  /// Speed of 2 over that of 1 before they met, from their speeds at the end along x.
  double SpeedsRatio()
  {
    vtkPolyData* moved = this->RocksAt(1.0);
    const vtkIdType last = moved->GetNumberOfCells() - 1;
    return (value(moved->GetCellData(), "Velocity", last) -
             value(moved->GetCellData(), "Velocity", 0)) /
      8.0;
  }

  int Tables = 0;
  vtkNew<vtkRockBlockSource> Other;
  vtkNew<vtkAppendPolyData> Both;
};

} // namespace

TEST_F(TestRockContactFile, TheTwoMeetAsTheirMaterialsSay)
{
  EXPECT_EQ(this->Restitution(), 0.5);
  this->SetTable("granite,slag,0.9,0,0\n");
  EXPECT_EQ(this->Restitution(), 0.9);
  // Faces that meet flat share the impact between four corners: within 5 %.
  EXPECT_NEAR(this->SpeedsRatio(), 0.9, 0.045);
  this->SetTable("slag,GRANITE,0.2,0,0\nslag,slag,1,0,0\n");
  EXPECT_EQ(this->Restitution(), 0.2);
  EXPECT_NEAR(this->SpeedsRatio(), 0.2, 0.045);
  this->SetTable("granite,granite,0.9,0,0\nslag,slag,0.9,0,0\n"); // nothing of the two
  EXPECT_EQ(this->Restitution(), 0.5);
}

TEST_F(TestRockContactFile, AppendedAndSavedRocksKeepTheirMaterial)
{
  this->Both->Update();
  EXPECT_EQ(materialOf(this->Both->GetOutput(), 0), "granite");
  EXPECT_EQ(materialOf(this->Both->GetOutput(), 6), "Slag");
  const std::string name = this->WriteFile("rocks.vtp", "");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(name.c_str());
  writer->SetInputConnection(this->Both->GetOutputPort());
  ASSERT_EQ(writer->Write(), 1);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(name.c_str());
  this->Simulation->SetInputConnection(1, reader->GetOutputPort());
  this->SetTable("granite,slag,0.7,0,0\n");
  EXPECT_EQ(this->Restitution(), 0.7);
}

TEST_F(TestRockContactFile, MaterialsMayBeNumbers)
{
  this->Both->Update();
  vtkNew<vtkPolyData> rocks;
  rocks->ShallowCopy(this->Both->GetOutput());
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Material");
  for (vtkIdType cell = 0; cell < rocks->GetNumberOfCells(); ++cell)
  {
    numbers->InsertNextValue(cell < 6 ? 3 : 11);
  }
  rocks->GetCellData()->AddArray(numbers);
  this->Simulation->SetInputData(1, rocks);
  this->SetTable("3,11,0.8,0,0\n");
  EXPECT_EQ(this->Restitution(), 0.8);
}

TEST_F(TestRockContactFile, SourcesNameTheirMaterials)
{
  const auto first = [](vtkAlgorithm* source)
  {
    source->Update();
    return materialOf(vtkPolyData::SafeDownCast(source->GetOutputDataObject(0)));
  };
  vtkNew<vtkRockBlockSource> rocks;
  EXPECT_EQ(first(rocks), "");
  rocks->SetMaterial(4);
  EXPECT_EQ(first(rocks), "limestone");
  rocks->SetMaterialName("Malm");
  EXPECT_EQ(first(rocks), "Malm");
  const std::string layer = this->WriteFile("rocks.csv",
    "x,y,z,material,mat_name\n5,50,58,,\n5,60,58,Basalt,\n5,70,58,basalt,lapilli\n5,80,58,,"
    "dacite\n");
  rocks->SetFileName(layer.c_str());
  EXPECT_EQ(first(rocks), "Malm"); // the row says nothing
  EXPECT_EQ(materialOf(rocks->GetOutput(), 6), "basalt");
  EXPECT_EQ(materialOf(rocks->GetOutput(), 12), "lapilli");
  EXPECT_EQ(materialOf(rocks->GetOutput(), 18), "dacite");
  EXPECT_EQ(value(rocks->GetOutput()->GetCellData(), "Density", 18), 2550); // limestone's
  vtkNew<vtkJointedRockMass> mass;
  mass->SetMaterial(2);
  EXPECT_EQ(first(mass), "gneiss");
  mass->SetMaterialName("augen gneiss");
  EXPECT_EQ(first(mass), "augen gneiss");
}

TEST_F(TestRockContactFile, WhatTheTableDoesNotChangeStaysTheSame)
{
  this->Simulation->Update();
  const std::string without = this->Simulation->GetStateHash();
  this->SetTable("granite,slag,0.5,30,\n"); // as the properties
  this->Simulation->Update();
  EXPECT_EQ(this->Simulation->GetStateHash(), without);
  this->SetTable("granite,slag,0.5,20,\n");
  this->Simulation->Update();
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 3);
  const std::string with = this->Simulation->GetStateHash();
  this->SetTable("granite,slag,0.6,30,\n");
  this->Simulation->Update();
  EXPECT_NE(this->Simulation->GetStateHash(), without);
  EXPECT_NE(this->Simulation->GetStateHash(), with);
  // Rocks that do not collide have no use for it.
  this->Simulation->SetRockRockContact(false);
  this->Simulation->SetRockContactFile("/no/such.csv");
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 2);
}

TEST_F(TestRockContactFile, MayReachOutWhereThatIsAllowed)
{
  // A table that is not beside the virtual layer that names it.
  const std::string table = this->WriteFile("pairs.csv", header + "granite,slag,0.2,30,0\n");
  const std::string folder = std::filesystem::path(table).parent_path().string() + "/elsewhere";
  std::filesystem::create_directories(folder);
  const std::string layer = folder + "/pairs.vrt";
  std::ofstream(layer) << "<OGRVRTDataSource><OGRVRTLayer name=\"pairs\"><SrcDataSource>" << table
                       << "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>";
  this->Simulation->SetRockContactFile(layer.c_str());
  this->Simulation->Update();
  this->ExpectOneError({ layer, table, "AllowReferences" });
  this->Simulation->AllowReferencesOn();
  EXPECT_DOUBLE_EQ(this->Restitution(), 0.2);
}

TEST_F(TestRockContactFile, BadTablesAreOneError)
{
  const struct
  {
    const char* rows;
    std::vector<std::string> words;
  } cases[] = {
    { "granite,cheese,0.5,30,0\n",
      { "row 1", "material_b", "\"cheese\"", "\"granite\", \"Slag\"" } },
    { "granite,slag,0.5,30,0\nSlag,granite,0.4,30,0\n", { "row 2", "is in row 1 already" } },
    { "granite,slag,1.5,30,0\n", { "row 1", "restitution", "1.5" } },
    { "granite,slag,0.5,95,0\n", { "row 1", "phi", "95" } },
    { "granite,slag,\"0,5\",30,0\n", { "row 1", "restitution", "0,5", "decimal sign" } },
  };
  for (const auto& c : cases)
  {
    this->SetTable(c.rows);
    this->ExpectEmpty();
    std::vector<std::string> words = c.words;
    words.push_back("contacts" + std::to_string(this->Tables) + ".csv");
    this->ExpectOneError(words);
  }
  this->Simulation->SetRockContactFile("/no/such.csv");
  this->ExpectEmpty();
  this->ExpectOneError({ "/no/such.csv" });
  this->SetTable("granite,slag,0.5,30,0\n");
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 2); // and it recovers
}
