// Lines of a collector beside the slope that its rocks fell on.

#include "simulationTest.h"

#include "vtkTrajectoryCollector.h"

using TestLinesOverGround = SimulationTest;

TEST_F(TestLinesOverGround, LinesThatGoOnWithoutGroundAreTold)
{
  this->Simulation->SetEndTime(1.0);
  vtkNew<vtkTrajectoryCollector> collector;
  collector->SetInputConnection(0, this->Simulation->GetOutputPort(1));
  collector->SetInputConnection(2, this->Terrain->GetOutputPort());
  const auto told = [&](double y, const std::string& note)
  {
    collector->ClearPoints();
    collector->AddPoint(20.0, 40.0, 0.0);
    collector->AddPoint(20.0, y, 0.0);
    this->Heard->Notes.clear();
    collector->Update();
    return std::any_of(this->Heard->Notes.begin(), this->Heard->Notes.end(),
      [&](const std::string& heard) { return heard.find(note) != std::string::npos; });
  };
  double bounds[6];
  this->Terrain->Update();
  this->Terrain->GetOutput()->GetBounds(bounds);
  const std::string note = "1 of 1 lines go on where the slope has no ground, first \"drawn line\"";
  EXPECT_TRUE(told(bounds[3] + 30.0, note + " on 30 of ")) << bounds[3];
  EXPECT_FALSE(told(bounds[3], note));
}
