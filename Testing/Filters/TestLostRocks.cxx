// Whom a run lost is told by the run and by what is made of it, in notes and in field arrays.

#include "helpers.h"
#include "trajectories.h"

#include "vtkDEMToCFESource.h"
#include "vtkDispersionAngle.h"
#include "vtkImageData.h"
#include "vtkRockBlockSource.h"
#include "vtkRockfallHazardMap.h"
#include "vtkRockfallSimulation.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkTrajectoryCollector.h"

#include <algorithm>
#include <sstream>

namespace
{

class TestLostRocks : public FilterTest
{
protected:
  /// A slope of 30° falling to the east, 61 × 41 nodes of 1 m, with nodata in these columns of the
  /// rows given.
  void MakeSlope(int firstColumn, int lastColumn, int firstRow, int lastRow)
  {
    std::ostringstream text;
    text << "ncols 61\nnrows 41\nxllcorner 499999.5\nyllcorner 5099999.5\ncellsize 1\n"
            "NODATA_value -9999\n";
    for (int row = 0; row < 41; ++row)
    {
      for (int column = 0; column < 61; ++column)
      {
        const bool hole = column >= firstColumn && column <= lastColumn && row >= firstRow &&
          row <= lastRow;
        text << (hole ? -9999.0 : 60.0 - 0.577 * column) << ' ';
      }
      text << '\n';
    }
    this->Slope->SetFileName(this->WriteFile("slope.asc", text.str()).c_str());
    this->Slope->SetRoughnessMean(0.0);
    this->Slope->SetRoughnessDeviation(0.0);
    this->Slope->SetFrictionAngle(15.0);
    this->Rocks->SetTerrainConnection(0, this->Slope->GetOutputPort());
    this->Rocks->SetPlaceOnGround(true);
    this->Rocks->SetCenter(500005.0, 5100020.0, 0.0);
    this->Rocks->SetAmount(4);
    this->Rocks->SetClusterRadius(3.0);
    this->Run->SetInputConnection(0, this->Slope->GetOutputPort());
    this->Run->SetInputConnection(1, this->Rocks->GetOutputPort());
    this->Run->SetEndTime(60.0);
    this->Run->Update();
  }
  vtkTable* Summary() { return vtkTable::SafeDownCast(this->Run->GetOutputDataObject(3)); }
  int Fates(const std::string& fate)
  {
    int count = 0;
    for (vtkIdType k = 0; k < this->Summary()->GetNumberOfRows(); ++k)
    {
      count += this->Summary()->GetValueByName(k, "Fate").ToString() == fate;
    }
    return count;
  }
  static bool Notes(vtkDataObject* data, const std::string& words)
  {
    auto* notes = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("Notes"));
    for (vtkIdType k = 0; notes && k < notes->GetNumberOfValues(); ++k)
    {
      if (notes->GetValue(k).find(words) != std::string::npos)
      {
        return true;
      }
    }
    return false;
  }
  bool Heard(const std::string& words)
  {
    return std::any_of(this->FilterTest::Heard->Notes.begin(), this->FilterTest::Heard->Notes.end(),
      [&](const std::string& note) { return note.find(words) != std::string::npos; });
  }

  vtkNew<vtkDEMToCFESource> Slope;
  vtkNew<vtkRockBlockSource> Rocks;
  vtkNew<vtkRockfallSimulation> Run;
};

} // namespace

TEST_F(TestLostRocks, TheEdgeOfTheMapIsNoHole)
{
  this->MakeSlope(100, 100, 0, 0);
  EXPECT_EQ(this->Fates("left the domain"), 4);
  EXPECT_TRUE(this->Heard("4 of 4 rocks went over the edge of the DEM"));
  EXPECT_TRUE(Notes(this->Summary(), "4 of 4 rocks went over the edge of the DEM"));
  EXPECT_EQ(value(this->Summary()->GetFieldData(), "RocksOverEdge"), 4);
  EXPECT_EQ(value(this->Summary()->GetFieldData(), "RocksReleased"), 4);
  EXPECT_EQ(value(this->Summary()->GetFieldData(), "RocksInNodata"), 0);
}

TEST_F(TestLostRocks, ASeamBetweenTilesIsAHole)
{
  this->MakeSlope(40, 40, 0, 40);
  EXPECT_EQ(this->Fates("lost in nodata"), 4);
  EXPECT_TRUE(Notes(this->Summary(), "4 of 4 rocks were lost in nodata"));
  EXPECT_EQ(value(this->Run->GetOutputDataObject(1)->GetFieldData(), "RocksInNodata"), 4);
}

TEST_F(TestLostRocks, APondIsAHole)
{
  this->MakeSlope(35, 45, 8, 32);
  EXPECT_EQ(this->Fates("lost in nodata"), 4);
}

TEST_F(TestLostRocks, ACollarOfNodataIsTheEdge)
{
  // Nothing but nodata from there on, as the corner of a turned raster has it.
  this->MakeSlope(40, 60, 0, 40);
  EXPECT_EQ(this->Fates("left the domain"), 4);
  EXPECT_TRUE(Notes(this->Summary(), "over the edge"));
}

TEST_F(TestLostRocks, MapAndDispersionOfTrajectoriesTellIt)
{
  HandMadeTrajectories paths;
  for (int rock = 0; rock < 6; ++rock)
  {
    const int fates[] = { 2, 2, 1, 4, 0, 3 };
    paths.AddLevel(0, rock, { 500000, 5100000.0 + 10 * rock, 50 }, 30, 5.0, 1.0, fates[rock]);
  }
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputDataObject(0, paths.Data);
  map->SetCellSize(5.0);
  map->Update();
  vtkNew<vtkDispersionAngle> angle;
  angle->SetInputDataObject(0, paths.Data);
  angle->SetUseGroups(false);
  angle->Update();
  for (vtkDataObject* made : { map->GetOutputDataObject(0), angle->GetOutputDataObject(0) })
  {
    EXPECT_TRUE(Notes(made, "2 of 6 rocks were still moving at EndTime (6 s)"));
    EXPECT_TRUE(Notes(made, "1 of 6 rocks went over the edge"));
    EXPECT_TRUE(Notes(made, "1 of 6 rocks were lost in nodata"));
    EXPECT_EQ(value(made->GetFieldData(), "RocksMoving"), 2);
    EXPECT_EQ(value(made->GetFieldData(), "RocksUnmoved"), 0);
  }
}

TEST_F(TestLostRocks, ThatNothingMovedIsTold)
{
  HandMadeTrajectories paths;
  paths.AddLevel(0, 0, { 500000, 5100000, 50 }, 0.01, 5.0, 1.0, 0);
  paths.AddLevel(0, 1, { 500000, 5100010, 50 }, 0.01, 5.0, 1.0, 0);
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputDataObject(0, paths.Data);
  map->SetCellSize(5.0);
  map->Update();
  EXPECT_TRUE(Notes(map->GetOutputDataObject(0), "None of 2 rocks moved"));
  EXPECT_TRUE(this->Heard("None of 2 rocks moved"));
}
