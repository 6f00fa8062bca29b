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
    ASSERT_EQ(this->Heard->Notes.size(), words.empty() ? 0u : 1u)
      << (this->Heard->Notes.empty() ? "" : this->Heard->Notes[0]);
    for (const std::string& word : words)
    {
      EXPECT_NE(this->Heard->Notes[0].find(word), std::string::npos)
        << "\"" << word << "\" is not in: " << this->Heard->Notes[0];
    }
    this->Heard->Notes.clear();
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
