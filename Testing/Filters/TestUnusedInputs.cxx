// What has no effect is not passed over in silence: notes on properties, errors of columns.

#include "simulationTest.h"

#include "vtkAppendPolyData.h"
#include "vtkJointedRockMass.h"

namespace
{

class TestUnusedInputs : public SimulationTest
{
protected:
  /// Exactly one note, with all of these words in it; or none if there are no words.
  void ExpectNote(const std::vector<std::string>& words)
  {
    this->ForgetBareRock();
    ASSERT_EQ(this->Heard->Notes.size(), words.empty() ? 0u : 1u)
      << (this->Heard->Notes.empty() ? "" : this->Heard->Notes[0]);
    for (const std::string& word : words)
    {
      EXPECT_NE(this->Heard->Notes[0].find(word), std::string::npos)
        << "\"" << word << "\" is not in: " << this->Heard->Notes[0];
    }
    this->Heard->Notes.clear();
  }

  void UpdateRocks(const std::vector<std::string>& words)
  {
    this->Rocks->Update();
    EXPECT_GT(this->Rocks->GetOutput()->GetNumberOfCells(), 0);
    this->ExpectNote(words);
  }
};

} // namespace

TEST_F(TestUnusedInputs, MassWhoseBlocksFallThroughEachOther)
{
  vtkNew<vtkJointedRockMass> mass;
  this->Simulation->SetInputConnection(1, mass->GetOutputPort());
  this->Simulation->SetEndTime(0.05);
  this->Simulation->Update();
  this->ExpectNote({ "RockRockContact is off", "each of the 27 blocks", "27 of them" });
  this->RocksAt(0.05); // of the same run
  this->ExpectNote({});
  this->Simulation->SetRockRockContact(true);
  this->Simulation->Update();
  this->ExpectNote({});
  // Appended, where nothing beside the blocks says what they are.
  vtkNew<vtkAppendPolyData> both;
  this->Rocks->SetFirstBlockId(101);
  this->Rocks->SetCenter(5.0, 90.0, 60.0);
  both->AddInputConnection(this->Rocks->GetOutputPort());
  both->AddInputConnection(mass->GetOutputPort());
  this->Simulation->SetRockRockContact(false);
  this->Simulation->SetInputConnection(1, both->GetOutputPort());
  this->Simulation->Update();
  this->ExpectNote({ "each of the 28 blocks", "27 of them" });
}

TEST_F(TestUnusedInputs, RocksThatFallOneByOneAreNoMass)
{
  // Many from one place, and neighbours with a gap.
  this->Rocks->SetAmount(50);
  this->Simulation->SetEndTime(0.05);
  this->Simulation->Update();
  this->ExpectNote({});
  const std::string two = this->WriteFile("two.csv", "x,y,z\n5,50,58\n5,51.001,58\n");
  this->Rocks->SetAmount(1);
  this->Rocks->SetFileName(two.c_str());
  this->Simulation->Update();
  this->ExpectNote({});
}

TEST_F(TestUnusedInputs, ReleaseHeightOfRocksWithAPlaceOfTheirOwn)
{
  this->Rocks->SetInputConnection(1, this->Terrain->GetOutputPort());
  this->UpdateRocks({});
  this->Rocks->SetReleaseHeight(2.0);
  this->UpdateRocks({ "ReleaseHeight is 2 m", "no effect", "PlaceOnGround is off" });
  this->Rocks->SetPlaceOnGround(true);
  this->UpdateRocks({});
  // A table without z: on the ground in any case. With z for one of two: not for all of them.
  this->Rocks->SetPlaceOnGround(false);
  const std::string flat = this->WriteFile("flat.csv", "x,y\n5,50\n");
  this->Rocks->SetFileName(flat.c_str());
  this->UpdateRocks({});
  const std::string some = this->WriteFile("some.csv", "x,y,z\n5,50,\n5,60,58\n");
  this->Rocks->SetFileName(some.c_str());
  this->UpdateRocks({});
  const std::string high = this->WriteFile("high.csv", "x,y,z\n5,50,58\n5,60,58\n");
  this->Rocks->SetFileName(high.c_str());
  this->UpdateRocks({ "ReleaseHeight is 2 m", "no effect" });
  this->Rocks->SetFileName("");
  this->Rocks->SetSlopeThreshold(20.0);
  this->UpdateRocks({});
}

TEST_F(TestUnusedInputs, ReleaseHeightOfAMass)
{
  vtkNew<vtkJointedRockMass> mass;
  mass->SetInputConnection(1, this->Terrain->GetOutputPort());
  mass->SetReleaseHeight(2.0);
  mass->Update();
  this->ExpectNote({ "ReleaseHeight is 2 m", "no effect", "PlaceOnGround is off" });
  mass->SetPlaceOnGround(true);
  mass->Update();
  this->ExpectNote({});
}

TEST_F(TestUnusedInputs, ClusterRadiusWithoutAPoint)
{
  this->Rocks->SetInputConnection(1, this->Terrain->GetOutputPort());
  this->Rocks->SetClusterRadius(3.0);
  this->UpdateRocks({});
  this->Rocks->SetSlopeThreshold(20.0);
  this->UpdateRocks({ "ClusterRadius is 3 m", "no effect", "SlopeThreshold is 20 degrees" });
  this->Rocks->SetSlopeThreshold(0.0);
  const std::string zone =
    this->WriteFile("zone.csv", "WKT,amount\n\"POLYGON((10 10,20 10,20 20,10 10))\",2\n");
  this->Rocks->SetFileName(zone.c_str());
  this->UpdateRocks({ "ClusterRadius is 3 m", "no source is a point" });
}

TEST_F(TestUnusedInputs, LengthsOfWhatIsNoBox)
{
  const auto refused =
    [&](const std::string& columns, const std::string& cells, const std::vector<std::string>& words)
  {
    const std::string file = this->WriteFile("rocks.csv",
      "x,y,z" + columns + "\n5,60,58" + std::string(columns.size() > 9 ? ",box" : "") +
        ",1,2,3\n5,50,58" + cells + "\n");
    this->Rocks->SetFileName(file.c_str());
    this->Rocks->Modified();
    this->Rocks->Update();
    EXPECT_EQ(this->Rocks->GetOutput()->GetNumberOfCells(), 0);
    this->ExpectOneError(words);
  };
  refused(",shape,lx,ly,lz", ",cube,1,2,3",
    { "rocks.csv, row 2", "\"lx\", \"ly\" and \"lz\" are 1, 2 and 3 m", "\"shape\" is cube",
      "\"volume\"" });
  refused(",shape,lx,ly,lz", ",cube:1;eota111:1,1,2,3", { "row 2", "\"shape\" is cube, eota111" });
  refused(",lx,ly,lz", ",1,2,3", { "row 1", "Shape is cube" });
  // Empty cells are as good as none, and a mix may have boxes.
  for (const char* cells : { "cube,,,", "cube:1;box:1,1,2,3", "box,1,2,3", ",,," })
  {
    const std::string good =
      this->WriteFile("good.csv", "x,y,z,shape,lx,ly,lz\n5,50,58," + std::string(cells) + "\n");
    this->Rocks->SetFileName(good.c_str());
    this->Rocks->Modified();
    this->Rocks->Update();
    EXPECT_EQ(this->Rocks->GetOutput()->GetNumberOfCells(), 6) << cells;
  }
}
