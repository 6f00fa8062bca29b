#include "simulationTest.h"

#include "vtkDrawnStructure.h"
#include "vtkJointedRockMass.h"
#include "vtkPointData.h"

#include "shared/structureFieldData.h"
#include "shared/terrainFieldData.h"

#include <cmath>
#include <random>
#include <string>

namespace
{

/// The test slope: 57.7 m high and 100 m long, then flat, 100 m wide.
class TestDrawnOnSlope : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Rocks->SetInputConnection(1, this->Slope->GetOutputPort());
    this->Structure->SetInputConnection(this->Slope->GetOutputPort());
  }
  vtkPolyData* Blocks()
  {
    this->Rocks->Update();
    return this->Rocks->GetOutput();
  }
  rockfall::Structures Standing()
  {
    this->Structure->Update();
    return rockfall::filters::readStructures(this->Structure->GetOutput()->GetFieldData());
  }

  vtkNew<vtkDEMToCFESource> Slope;
  vtkNew<vtkRockBlockSource> Rocks;
  vtkNew<vtkDrawnStructure> Structure;
};

} // namespace

TEST_F(TestDrawnOnSlope, PointsAreSources)
{
  this->Rocks->SetDraw(vtkRockBlockSource::POINTS);
  this->Rocks->AddPoint(50, 20, -99); // on a slope z does not count
  this->Rocks->AddPoint(50, 80, 99);
  ASSERT_EQ(this->Blocks()->GetNumberOfCells(), 12);
  double b[6];
  this->Blocks()->GetBounds(b);
  EXPECT_NEAR(b[2], 19.5, 1e-9);
  EXPECT_NEAR(b[3], 80.5, 1e-9);
  EXPECT_NEAR(b[4], 57.7 * (1.0 - 0.495), 1e-9); // a cube of 1 m stands on its upper edge
  // The slope goes with them.
  EXPECT_TRUE(rockfall::filters::hasTerrain(this->Blocks()->GetFieldData()));
}

TEST_F(TestDrawnOnSlope, LinesAndAreasHaveTheirAmount)
{
  this->Rocks->SetAmount(7);
  this->Rocks->SetDraw(vtkRockBlockSource::LINE);
  this->Rocks->AddPoint(40, 20, 0);
  this->Rocks->AddPoint(40, 80, 0);
  EXPECT_EQ(this->Blocks()->GetNumberOfCells(), 7 * 6);
  double b[6];
  this->Blocks()->GetBounds(b);
  EXPECT_NEAR(b[0], 39.5, 1e-9);
  EXPECT_NEAR(b[1], 40.5, 1e-9);
  this->Rocks->SetDraw(vtkRockBlockSource::AREA);
  this->Blocks();
  this->ExpectOneError({ "Points has 2 points", "area needs 3" });
  this->Rocks->AddPoint(60, 50, 0);
  EXPECT_EQ(this->Blocks()->GetNumberOfCells(), 7 * 6);
  this->Blocks()->GetBounds(b);
  EXPECT_GT(b[1] - b[0], 2.0);
  this->Rocks->AddPoint(30, 50, 0); // across the first side
  this->Blocks();
  this->ExpectOneError({ "Points", "outline crosses or touches itself" });
  this->Rocks->AddPoint(60, 150, 0);
  this->Blocks();
  this->ExpectOneError({ "drawn point 60, 150", "outside the slope" });
  this->Rocks->SetDraw(4);
  this->Blocks();
  this->ExpectOneError({ "Draw is 4" });
}

TEST_F(TestDrawnOnSlope, NothingDrawnIsTheHighestSteepPlace)
{
  this->Rocks->SetDraw(vtkRockBlockSource::LINE);
  this->Rocks->SetAmount(3);
  EXPECT_EQ(this->Blocks()->GetNumberOfCells(), 3 * 6);
  const double* line = this->Rocks->GetPlacedLine();
  EXPECT_EQ(line[0], line[3]);                        // level
  EXPECT_LE(line[0], 10.0);                           // high up
  EXPECT_NEAR(0.5 * (line[1] + line[4]), 50.0, 1e-9); // in the middle of an even slope
  EXPECT_NEAR(line[2], 57.7 * (1.0 - line[0] / 100.0), 1e-9);
}

// A slope of 45° in the coordinates of a country, steepest everywhere: what has the centre of the
// test slope would lie 2800 km away.
TEST_F(TestDrawnOnSlope, WhatNobodyPlacedStandsOnTheSlope)
{
  std::string grid = "ncols 41\nnrows 41\nxllcorner 2600000\nyllcorner 1200000\ncellsize 5\n";
  for (int row = 0; row < 41; ++row)
  {
    for (int column = 0; column < 41; ++column)
    {
      grid += std::to_string(1000 - 5 * column) + " ";
    }
    grid += "\n";
  }
  this->Slope->SetFileName(this->WriteFile("country.asc", grid).c_str());
  vtkNew<vtkJointedRockMass> mass;
  mass->SetInputConnection(1, this->Slope->GetOutputPort());
  mass->Update();
  double terrain[6], block[6], cut[6];
  this->Blocks()->GetBounds(block);
  this->Slope->GetOutput()->GetBounds(terrain);
  mass->GetOutput()->GetBounds(cut);
  for (const double* b : { block, cut })
  {
    EXPECT_GT(b[0], terrain[0]);
    EXPECT_LT(b[1], terrain[0] + 0.25 * (terrain[1] - terrain[0])); // high up
    EXPECT_GT(b[2], terrain[2]);
    EXPECT_LT(b[3], terrain[3]);
    EXPECT_NEAR(b[4], 1000.0 - (b[0] - 2600002.5), 1e-6); // on its upper edge, which touches
  }
}

// The steepest of rough cells are anywhere: rocks that begin at the border leave the slope.
TEST_F(TestDrawnOnSlope, WhatNobodyPlacedHasSlopeBelowAndBeside)
{
  this->Rocks->SetDraw(vtkRockBlockSource::LINE);
  std::mt19937 random(1);
  constexpr int nodes = 61;
  constexpr double cell = 2.0, side = (nodes - 1) * cell;
  for (int slope = 0; slope < 10; ++slope)
  {
    std::string grid = "ncols 61\nnrows 61\nxllcorner -1\nyllcorner -1\ncellsize 2\n";
    for (int node = 0; node < nodes * nodes; ++node)
    {
      const double rough = double(random() % 1000) * 1e-3;
      grid += std::to_string(100.0 - 0.7 * cell * (node % nodes) + rough) + " ";
    }
    this->Slope->SetFileName(
      this->WriteFile("rough" + std::to_string(slope) + ".asc", grid).c_str());
    this->Blocks();
    const double* line = this->Rocks->GetPlacedLine();
    for (const double* end : { line, line + 3 })
    {
      EXPECT_LT(end[0], 0.81 * side) << "slope " << slope;
      EXPECT_GT(end[1], 0.19 * side) << "slope " << slope;
      EXPECT_LT(end[1], 0.81 * side) << "slope " << slope;
    }
  }
}

TEST_F(TestDrawnOnSlope, ABlockOffTheSlopeIsTold)
{
  this->Rocks->SetCenter(5, 500, 58);
  this->Blocks();
  this->ExpectOneError({ "Center", "5, 500", "outside the slope" });
}

TEST_F(TestDrawnOnSlope, ANetHoldsRocks)
{
  this->Structure->AddPoint(70, 1, 0);
  this->Structure->AddPoint(70, 99, 0);
  this->Structure->SetCapacity(1e6);
  const rockfall::Structures standing = this->Standing();
  ASSERT_EQ(standing.barriers.size(), 1U);
  EXPECT_EQ(standing.barriers[0].height, 4.0);
  EXPECT_EQ(standing.barriers[0].capacity, 1e9);
  auto* shown = vtkPolyData::SafeDownCast(this->Structure->GetOutputDataObject(1));
  EXPECT_GT(shown->GetNumberOfCells(), 0);
  vtkNew<vtkRockfallSimulation> fall;
  this->Rocks->SetInputConnection(1, this->Structure->GetOutputPort());
  this->Rocks->SetDraw(vtkRockBlockSource::POINTS);
  this->Rocks->AddPoint(60, 50, 0);
  fall->SetInputConnection(1, this->Rocks->GetOutputPort()); // the slope comes with the rocks
  fall->SetEndTime(20.0);
  fall->Update();
  auto* met = vtkPolyData::SafeDownCast(fall->GetOutputDataObject(4));
  ASSERT_EQ(met->GetNumberOfPoints(), 1);
  EXPECT_EQ(value(met->GetPointData(), "Outcome"), 0); // stopped
}

TEST_F(TestDrawnOnSlope, NetsBrakeWearAndFillAsThoseOfALayer)
{
  const rockfall::Barrier plain = this->Standing().barriers.at(0);
  EXPECT_EQ(plain.braking, 0.0);
  EXPECT_FALSE(rockfall::isLoaded(plain));
  this->Structure->SetBraking(6.0);
  this->Structure->SetResidual(40.0); // of a net that does not wear it says nothing
  EXPECT_FALSE(rockfall::isLoaded(this->Standing().barriers.at(0)));
  this->Structure->SetWears(true);
  this->Structure->SetFill(2.5);
  const rockfall::Barrier net = this->Standing().barriers.at(0);
  EXPECT_EQ(net.braking, 6.0);
  EXPECT_NEAR(net.residual, 0.4, 1e-15);
  EXPECT_EQ(net.room, 2.5);
  // Half of its capacity used, so 0.7 of its height of 4 m are left.
  EXPECT_NEAR(rockfall::stateOf(net, { 500e3, 0.0 }).rope, 0.7 * 4.0, 1e-12);
}

TEST_F(TestDrawnOnSlope, StructuresFollowEachOther)
{
  vtkNew<vtkDrawnStructure> dam, forest;
  dam->SetInputConnection(this->Structure->GetOutputPort());
  dam->SetKind(vtkDrawnStructure::EMBANKMENT);
  dam->AddPoint(120, 10, 0);
  dam->AddPoint(120, 90, 0);
  forest->SetInputConnection(dam->GetOutputPort());
  forest->SetKind(vtkDrawnStructure::FOREST);
  forest->SetTreeHeight(15.0);
  forest->SetStemsPerHectare(500.0);
  for (const auto& [x, y] :
    { std::pair(10.0, 10.0), std::pair(90.0, 10.0), std::pair(90.0, 90.0), std::pair(10.0, 90.0) })
  {
    forest->AddPoint(x, y, 0);
  }
  forest->Update();
  const rockfall::Structures all =
    rockfall::filters::readStructures(forest->GetOutput()->GetFieldData());
  EXPECT_EQ(all.barriers.size(), 1U);
  ASSERT_EQ(all.embankments.size(), 1U);
  EXPECT_EQ(all.embankments[0].crestWidth, 2.0);
  EXPECT_NEAR(double(all.trees.size()), 500.0 * 0.64, 1.0);
  EXPECT_EQ(all.trees[0].height, 15.0);
  EXPECT_NEAR(all.trees[0].capacity, rockfall::stemCapacity(0.3), 1e-6);
  // The slope's own output is as it was.
  EXPECT_FALSE(rockfall::filters::readStructures(this->Slope->GetOutput()->GetFieldData()).any());
}

TEST_F(TestDrawnOnSlope, BadValues)
{
  const auto refuse = [this](const std::vector<std::string>& words)
  {
    this->Structure->Update();
    EXPECT_EQ(this->Structure->GetOutput()->GetNumberOfCells(), 0);
    this->ExpectOneError(words);
  };
  this->Structure->SetHeight(0.0);
  refuse({ "Height is 0 m" });
  this->Structure->SetHeight(4.0);
  this->Structure->SetCapacity(-1.0);
  refuse({ "Capacity is -1 kJ" });
  this->Structure->SetCapacity(0.0);
  this->Structure->SetBraking(-2.0);
  refuse({ "Braking is -2 m" });
  this->Structure->SetBraking(0.0);
  this->Structure->SetResidual(101.0);
  refuse({ "Residual is 101 %" });
  this->Structure->SetResidual(0.0);
  this->Structure->SetFill(-1.0);
  refuse({ "Fill is -1" });
  this->Structure->SetFill(0.0);
  this->Structure->SetKind(3);
  refuse({ "Kind is 3" });
  this->Structure->SetKind(vtkDrawnStructure::NET);
  this->Structure->AddPoint(1000, 50, 0);
  this->Structure->AddPoint(1000, 60, 0);
  refuse({ "Points", "1000, 50", "outside the slope" });
}
