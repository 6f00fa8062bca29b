// Whom a run lost is told by the run and by what is made of it, in notes and in
// field arrays.

#include "helpers.h"
#include "trajectories.h"

#include "vtkCellData.h"
#include "vtkDEMToCFESource.h"
#include "vtkDispersionAngle.h"
#include "vtkImageData.h"
#include "vtkRockBlockSource.h"
#include "vtkRockfallHazardMap.h"
#include "vtkRockfallSimulation.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkTrajectoryCollector.h"

#include "rock/results.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <utility>

using rockfall::Fate;

namespace
{

class TestLostRocks : public FilterTest
{
protected:
  /// A slope of 30° falling to the east, 61 × 41 nodes of 1 m, with nodata in
  /// these columns of the rows given.
  void MakeSlope(int firstColumn, int lastColumn, int firstRow, int lastRow)
  {
    std::ostringstream text;
    text << "ncols 61\nnrows 41\nxllcorner 499999.5\nyllcorner "
            "5099999.5\ncellsize 1\n"
            "NODATA_value -9999\n";
    for (int row = 0; row < 41; ++row)
    {
      for (int column = 0; column < 61; ++column)
      {
        const bool hole =
          column >= firstColumn && column <= lastColumn && row >= firstRow && row <= lastRow;
        text << (hole ? -9999.0 : 60.0 - 0.577 * column) << ' ';
      }
      text << '\n';
    }
    this->Slope->SetFileName(this->WriteFile("slope.asc", text.str()).c_str());
    this->Slope->SetRoughnessMean(0.0);
    this->Slope->SetRoughnessDeviation(0.0);
    this->Slope->SetFrictionAngle(15.0);
    this->Rocks->SetInputConnection(1, this->Slope->GetOutputPort());
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

/// A run of a moment, with which a study looks at its inputs, keeps what it loses and tells nothing.
TEST_F(TestLostRocks, ALookAtTheInputsTellsNoLosses)
{
  this->MakeSlope(100, 100, 0, 0);
  this->FilterTest::Heard->Notes.clear();
  this->Rocks->SetVelocity(-700.0, 0.0, 600.0);
  this->Run->SetEndTime(0.05);
  this->Run->Update();
  EXPECT_TRUE(Notes(this->Summary(), "4 of 4 rocks went over the edge of the DEM"));
  EXPECT_FALSE(this->Heard("over the edge"));
}

TEST_F(TestLostRocks, ASeamBetweenTilesIsAHole)
{
  this->MakeSlope(36, 44, 0, 40); // as wide as no rock flies over
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

TEST_F(TestLostRocks, ALineTellsWhomItLostBefore)
{
  // Past x = 500010: two that pass and are lost behind it, three that are lost
  // before, one rests.
  HandMadeTrajectories paths;
  const int fates[] = { 2, 4, 2, 1, 4, 0 };
  for (int rock = 0; rock < 6; ++rock)
  {
    paths.AddLevel(
      0, rock, { 500000, 5100000.0 + rock, 50 }, rock < 2 ? 30 : 8, 5.0, 1.0, fates[rock]);
  }
  vtkNew<vtkTrajectoryCollector> line;
  line->SetInputDataObject(0, paths.Data);
  line->AddPoint(500010, 5099990, 0);
  line->AddPoint(500010, 5100020, 0);
  line->Update();
  auto* table = vtkTable::SafeDownCast(line->GetOutputDataObject(1));
  EXPECT_TRUE(Notes(table, "1 of 6 rocks were still moving at EndTime (1.6 s) before they passed"));
  EXPECT_TRUE(Notes(table, "1 of 6 rocks went over the edge of the DEM before they passed"));
  EXPECT_TRUE(Notes(table, "1 of 6 rocks were lost in nodata of the DEM before they passed"));
  EXPECT_TRUE(Notes(table,
    "Too few rocks passed line \"drawn line\" for any quantile: 50, 90, 95 and 99 % take 5, 29, 59 "
    "and 299"));
  EXPECT_TRUE(Notes(line->GetOutputDataObject(0), "before they passed"));
  EXPECT_EQ(table->GetValueByName(0, "MovingBefore").ToInt(), 1);
  EXPECT_EQ(table->GetValueByName(0, "OverEdgeBefore").ToInt(), 1);
  EXPECT_EQ(table->GetValueByName(0, "InNodataBefore").ToInt(), 1);
  EXPECT_EQ(table->GetValueByName(0, "HighestQuantile").ToInt(), 0);
  line->ClearPoints();
  line->AddPoint(500040, 5099990, 0);
  line->AddPoint(500040, 5100020, 0);
  line->Update();
  EXPECT_TRUE(Notes(line->GetOutputDataObject(1), "No rock reached line \"drawn line\""));
}

TEST_F(TestLostRocks, SharesOfNoneAndAllHaveTheirLimit)
{
  HandMadeTrajectories paths;
  for (int rock = 0; rock < 6; ++rock)
  {
    paths.AddLevel(0, rock, { 500000, 5100000, 50 }, 20, 5.0, 1.0, 0);
  }
  const double limit = 1.0 - std::pow(0.05, 1.0 / 6.0);
  for (const double x : { 500010.0, 500030.0 })
  {
    vtkNew<vtkTrajectoryCollector> line;
    line->SetInputDataObject(0, paths.Data);
    line->AddPoint(x, 5099990, 0);
    line->AddPoint(x, 5100020, 0);
    line->Update();
    auto* table = vtkTable::SafeDownCast(line->GetOutputDataObject(1));
    EXPECT_EQ(table->GetValueByName(0, "Share").ToDouble(), x < 500020 ? 1.0 : 0.0);
    EXPECT_NEAR(table->GetValueByName(0, "ShareError").ToDouble(), limit, 1e-12);
  }
  // Of six rocks that never pass the line one was lost before it and may pass it: 1 of 6 is as likely as 5 %
  // where (1 - p)^6 + 6 p (1 - p)^5 is.
  paths.Data->GetCellData()->GetArray("Fate")->SetTuple1(5, 1.0);
  vtkNew<vtkTrajectoryCollector> beyond;
  beyond->SetInputDataObject(0, paths.Data);
  beyond->AddPoint(500030, 5099990, 0);
  beyond->AddPoint(500030, 5100020, 0);
  beyond->Update();
  const double p =
    value(vtkTable::SafeDownCast(beyond->GetOutputDataObject(1))->GetRowData(), "ShareError");
  EXPECT_NEAR(std::pow(1.0 - p, 6.0) + 6.0 * p * std::pow(1.0 - p, 5.0), 0.05, 1e-9);
  HandMadeTrajectories apart;
  for (int rock = 0; rock < 7; ++rock)
  {
    apart.AddLevel(0, rock, { 500000, rock < 6 ? 5100000.0 : 5100010.0, 50 }, 20, 5.0, 1.0, 0);
  }
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputDataObject(0, apart.Data);
  map->SetCellSize(5.0);
  map->Update();
  auto* image = vtkImageData::SafeDownCast(map->GetOutputDataObject(0));
  vtkDataArray* error = image->GetCellData()->GetArray("ReachProbabilityError");
  EXPECT_NEAR(error->GetTuple1(5), 1.0 - std::pow(0.05, 1.0 / 7.0),
    1e-6); // between the two paths
  EXPECT_GT(error->GetRange()[0], 0.0);
  EXPECT_EQ(value(image->GetCellData(), "HighestQuantile"), 50); // six rocks
  EXPECT_TRUE(Notes(image, "No cell has more than 6 rocks"));
}

TEST_F(TestLostRocks, RunsWithBlocksOfTheirOwnAreOne)
{
  // Two runs of the same iteration and the same rock numbers.
  HandMadeTrajectories paths;
  for (int run = 0; run < 2; ++run)
  {
    paths.AddLevel(0, 0, { 500000, 5100000, 50 }, 20, 5.0);
    paths.AddLevel(0, 1, { 500000, 5100000, 50 }, 20, 5.0);
  }
  vtkDataArray* block = paths.Data->GetCellData()->GetArray("BlockId");
  const auto made = [&](vtkAlgorithm* filter)
  {
    filter->SetInputDataObject(0, paths.Data);
    filter->Update();
    return filter->GetOutputDataObject(0);
  };
  vtkNew<vtkRockfallHazardMap> twice;
  twice->SetCellSize(5.0);
  made(twice);
  this->ExpectOneError({ "is there twice", "a run was given twice" });
  vtkNew<vtkTrajectoryCollector> lineTwice;
  made(lineTwice);
  this->ExpectOneError({ "is there twice", "a run was given twice" });
  block->SetTuple1(2, 200);
  block->SetTuple1(3, 201);
  paths.Data->Modified();
  vtkNew<vtkRockfallHazardMap> map;
  map->SetCellSize(5.0);
  EXPECT_EQ(value(vtkImageData::SafeDownCast(made(map))->GetCellData(), "Rocks"), 4);
  vtkNew<vtkTrajectoryCollector> line;
  made(line);
  auto* table = vtkTable::SafeDownCast(line->GetOutputDataObject(1));
  EXPECT_EQ(table->GetValueByName(0, "Rocks").ToInt(), 4);
  EXPECT_EQ(table->GetValueByName(0, "Share").ToDouble(), 1.0);
}

TEST_F(TestLostRocks, WideRocksTouchTheCellsUnderThem)
{
  HandMadeTrajectories paths;
  paths.AddLevel(0, 0, { 500000.25, 5100000.3, 50 }, 20, 5.0, 1.0, 0);
  vtkNew<vtkDoubleArray> width;
  width->SetName("Width");
  width->InsertNextValue(5.0);
  paths.Data->GetCellData()->AddArray(width);
  const auto rows = [&](bool wide, double size)
  {
    vtkNew<vtkRockfallHazardMap> map;
    map->SetInputDataObject(0, paths.Data);
    map->SetCellSize(size);
    map->SetRockWidth(wide);
    map->Update();
    auto* image = vtkImageData::SafeDownCast(map->GetOutputDataObject(0));
    int n[3];
    image->GetDimensions(n);
    vtkDataArray* rocks = image->GetCellData()->GetArray("Rocks");
    int stops = 0, touched = 0;
    for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
    {
      stops += int(value(image->GetCellData(), "StoppingPoints", cell));
      EXPECT_LE(value(image->GetCellData(), "Passages", cell), 1.0);
    }
    EXPECT_EQ(stops, 1);
    for (int row = 0; row < n[1] - 1; ++row)
    {
      touched += rocks->GetTuple1(vtkIdType(row) * (n[0] - 1) + (n[0] - 1) / 2) > 0.0;
    }
    return touched;
  };
  EXPECT_EQ(rows(false, 0.5), 1);
  EXPECT_EQ(rows(true, 0.5), 11); // y − 2.2 … 2.8
  EXPECT_EQ(rows(true, 2.0), 4);
  EXPECT_EQ(rows(true, 5.0), 1); // not wider than a cell
}

/// A rock that broke is lost where a piece of it is, once, before lines that none of it passed.
TEST_F(TestLostRocks, PiecesOfARockThatAreLost)
{
  HandMadeTrajectories paths;
  vtkNew<vtkIntArray> pieces;
  pieces->SetName("Piece");
  const auto add = [&](int rock, int piece, double from, Fate fate)
  {
    paths.AddLevel(0, rock, { 500000.0 + from, 5100000, 50 }, 10.0, 5.0, 2.0, int(fate));
    pieces->InsertNextValue(piece);
  };
  add(0, 0, 0.0, Fate::Broken); // one piece moves, one lies
  add(0, 1, 10.0, Fate::Rested);
  add(0, 2, 10.0, Fate::Moving);
  add(0, 3, 10.0, Fate::Moving);
  add(1, 0, 0.0, Fate::Broken); // one is behind the line
  add(1, 1, 25.0, Fate::LeftDomain);
  add(2, 0, 0.0, Fate::Broken); // none is lost
  add(2, 1, 10.0, Fate::Rested);
  add(3, 0, 0.0, Fate::LeftDomain);
  paths.Data->GetCellData()->AddArray(pieces);
  vtkNew<vtkTrajectoryCollector> collector;
  collector->AddPoint(500030, 5099990, 0);
  collector->AddPoint(500030, 5100010, 0);
  collector->SetInputDataObject(0, paths.Data);
  collector->Update();
  auto* lines = vtkTable::SafeDownCast(collector->GetOutputDataObject(1));
  EXPECT_EQ(lines->GetValueByName(0, "MovingBefore").ToInt(), 1);
  EXPECT_EQ(lines->GetValueByName(0, "OverEdgeBefore").ToInt(), 1);
  EXPECT_EQ(lines->GetValueByName(0, "Rocks").ToInt(), 1);
}

/// Each would be a rock of its own, with the frequency of the whole one.
TEST_F(TestLostRocks, PiecesWithoutTheirRock)
{
  HandMadeTrajectories paths;
  vtkNew<vtkIntArray> pieces;
  pieces->SetName("Piece");
  for (const auto& [rock, piece] : { std::pair(0, 0), std::pair(0, 1), std::pair(1, 2) })
  {
    paths.AddLevel(0, rock, { 500000.0, 5100000, 50 }, 10.0, 5.0);
    pieces->InsertNextValue(piece);
  }
  paths.Data->GetCellData()->AddArray(pieces);
  vtkNew<vtkTrajectoryCollector> collector;
  vtkNew<vtkRockfallHazardMap> map;
  vtkNew<vtkDispersionAngle> dispersion;
  map->SetCellSize(5.0);
  dispersion->SetUseGroups(false);
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ collector, map, dispersion })
  {
    filter->SetInputDataObject(0, paths.Data);
    filter->Update();
    this->ExpectOneError({ "piece 2 of rock 1 of iteration 0 (block 101)", "without the rock" });
  }
}
