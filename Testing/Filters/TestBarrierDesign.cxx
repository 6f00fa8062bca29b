#include "helpers.h"
#include "trajectories.h"

#include "vtkBarrierDesign.h"
#include "vtkMergeCollectors.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkTrajectoryCollector.h"

#include "rock/results.h"

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

using rockfall::Fate;

namespace
{

/// Ten rocks of 1000 kg, 1 m wide, of two sources and three classes of volume, level past a road.
class TestBarrierDesign : public FilterTest
{
protected:
  struct Rock
  {
    double speed;  ///< m/s
    double height; ///< Of its lowest point, m.
    int source;
    double frequency; ///< 1/a
  };
  /// Energies ½ 1000 v² + 100 J: 2.1, 8.1, 18.1, 32.1, 50.1, 72.1, 98.1, 128.1, 162.1, 200.1 kJ.
  static constexpr Rock rocks[10] = { { 2, 0.0, 1, 0.25 }, { 4, 0.5, 2, 0.25 }, { 6, 1.0, 1, 0.25 },
    { 8, 1.5, 2, 0.25 }, { 10, 2.0, 1, 0.0625 }, { 12, 2.5, 2, 0.0625 }, { 14, 3.0, 1, 0.0625 },
    { 16, 0.25, 2, 0.015625 }, { 18, 0.75, 1, 0.015625 }, { 20, 1.25, 2, 0.015625 } };

  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Points->SetDataTypeToDouble();
    this->Points->InsertNextPoint(500010, 5099990, 0);
    this->Points->InsertNextPoint(500010, 5100200, 0);
    vtkNew<vtkCellArray> lines;
    lines->InsertNextCell({ 0, 1 });
    this->Drawn->SetPoints(this->Points);
    this->Drawn->SetLines(lines);
  }

  /// The crossings of `iterations` iterations, in which all rocks come in the first and none in the
  /// others, as all end with this fate; of the rocks with rock % parts == part.
  vtkSmartPointer<vtkTrajectoryCollector> Collect(bool frequencies = true, int iterations = 2,
    int parts = 1, int part = 0, Fate fate = Fate::Rested)
  {
    HandMadeTrajectories paths;
    vtkNew<vtkDoubleArray> width, frequency;
    vtkNew<vtkIdTypeArray> source;
    width->SetName("Width");
    source->SetName("SourceId");
    frequency->SetName("Frequency");
    for (int iteration = 0; iteration < iterations; ++iteration)
    {
      for (int k = part; k < 10; k += parts)
      {
        paths.AddLevel(iteration, k, { 500000, 5100000.0 + 7 * k, 50 }, iteration == 0 ? 30.0 : 5.0,
          rocks[k].speed, rocks[k].height, int(fate));
        width->InsertNextValue(1.0);
        source->InsertNextValue(rocks[k].source);
        frequency->InsertNextValue(rocks[k].frequency);
      }
    }
    paths.Data->GetCellData()->AddArray(width);
    paths.Data->GetCellData()->AddArray(source);
    if (frequencies)
    {
      paths.Data->GetCellData()->AddArray(frequency);
    }
    auto collector = vtkSmartPointer<vtkTrajectoryCollector>::New();
    collector->SetInputDataObject(0, paths.Data);
    collector->SetInputDataObject(1, this->Drawn);
    collector->SetBarrierHeight(3.0);
    collector->SetBarrierCapacity(100.0);
    collector->Update();
    return collector;
  }

  double Number(int port, const char* column, int row)
  {
    this->Filter->Update();
    auto* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(port));
    if (row >= table->GetNumberOfRows() || !table->GetColumnByName(column))
    {
      ADD_FAILURE() << "port " << port << " has no " << column << " in row " << row;
      return 0.0;
    }
    return table->GetValueByName(row, column).ToDouble();
  }

  /// How many notes of a filter's port have these words.
  static int Told(vtkAlgorithm* filter, int port, const std::string& words)
  {
    filter->Update();
    auto* notes = vtkStringArray::SafeDownCast(
      filter->GetOutputDataObject(port)->GetFieldData()->GetAbstractArray("Notes"));
    int count = 0;
    for (vtkIdType k = 0; notes && k < notes->GetNumberOfValues(); ++k)
    {
      count += notes->GetValue(k).find(words) != std::string::npos;
    }
    return count;
  }
  int Told(const std::string& words) { return Told(this->Filter, 0, words); }

  vtkNew<vtkPoints> Points;
  vtkNew<vtkPolyData> Drawn;
  vtkNew<vtkBarrierDesign> Filter;
};

} // namespace

TEST_F(TestBarrierDesign, CharacteristicAndDesignValues)
{
  this->Filter->SetInputData(this->Collect()->GetOutput());
  const double energies[] = { 61.1, 165.9, 183.0, 193.26, 196.68, 200.1 };
  const double speeds[] = { 11.0, 18.2, 19.1, 19.64, 19.82, 20.0 };
  // Tops: 1 1.25 1.5 1.75 2 2.25 2.5 3 3.5 4 m
  const double tops[] = { 2.125, 3.55, 3.775, 3.91, 3.955, 4.0 };
  const double levels[] = { 50, 90, 95, 98, 99, 100 };
  const double least[] = { 5, 29, 59, 149, 299, 0 };
  const double classes[] = { 0, 1, 1, 1, 1, 1 };
  for (int row = 0; row < 6; ++row)
  {
    EXPECT_NEAR(this->Number(0, "Quantile", row), levels[row], 1e-12);
    EXPECT_EQ(this->Number(0, "Rocks", row), 10);
    EXPECT_EQ(this->Number(0, "LeastRocks", row), least[row]);
    EXPECT_NEAR(this->Number(0, "EnergyInKilojoules", row), energies[row], 1e-9);
    EXPECT_NEAR(this->Number(0, "Speed", row), speeds[row], 1e-12);
    EXPECT_NEAR(this->Number(0, "TopHeight", row), tops[row], 1e-12);
    EXPECT_NEAR(this->Number(0, "DesignEnergyInKilojoules", row), energies[row], 1e-9);
    EXPECT_NEAR(this->Number(0, "RequiredHeight", row), tops[row] + 0.5, 1e-12);
    EXPECT_EQ(this->Number(0, "RequiredClass", row), classes[row]);
    EXPECT_EQ(this->Number(0, "BarrierHolds", row), row == 0); // 61 of 100 kJ, 2.6 of 3 m
  }
  EXPECT_NEAR(this->Number(0, "EnergyInKilojoulesLow", 0), 8.1, 1e-9); // ranks 2 and 9
  EXPECT_NEAR(this->Number(0, "EnergyInKilojoulesHigh", 0), 162.1, 1e-9);
  EXPECT_TRUE(std::isnan(this->Number(0, "EnergyInKilojoulesHigh", 1)));

  this->Filter->SetFactorSet(vtkBarrierDesign::UNI_POOR);
  this->Filter->SetSlopeSurveyFactor(5.0); // the set's is taken
  this->Filter->SetRiskFactor(1.05);
  const double all = 1.05 * 1.1 * 1.21 * 1.21;
  EXPECT_NEAR(this->Number(0, "DesignEnergyInKilojoules", 2), 183.0 * all, 1e-9); // 309
  EXPECT_EQ(this->Number(0, "RequiredClass", 2), 2);
  EXPECT_NEAR(this->Number(0, "DesignHeight", 2), 3.775 * 1.21, 1e-12);
  this->Filter->SetBarrierFactor(2.0);
  EXPECT_EQ(this->Number(0, "RequiredClass", 2), 3);
  this->Filter->SetDesignMass(2000.0);
  EXPECT_NEAR(this->Number(0, "DesignEnergyInKilojoules", 2), 19.1 * 19.1 * all, 1e-9);
}

TEST_F(TestBarrierDesign, ClassesAndTheirFrequencies)
{
  const auto collector = this->Collect();
  this->Filter->SetInputData(collector->GetOutput());
  auto* table =
    vtkTable::SafeDownCast((this->Filter->Update(), this->Filter->GetOutputDataObject(1)));
  ASSERT_EQ(table->GetNumberOfRows(), 9);
  EXPECT_EQ(table->GetValueByName(0, "Class").ToString(), "barrier");
  EXPECT_EQ(table->GetValueByName(8, "Class").ToString(), "7");
  // 3.5 and 4 m are over it; of the others 128.1, 162.1 and 200.1 kJ are too strong. Each rock
  // came in one of two iterations.
  EXPECT_EQ(this->Number(1, "Caught", 0), 5);
  EXPECT_EQ(this->Number(1, "Over", 0), 2);
  EXPECT_EQ(this->Number(1, "TooStrong", 0), 3);
  vtkNew<vtkMergeCollectors> merge;
  merge->SetInputData(collector->GetOutput());
  merge->Update();
  for (vtkAlgorithm* lines : std::initializer_list<vtkAlgorithm*>{ collector, merge })
  {
    auto* of = vtkTable::SafeDownCast(lines->GetOutputDataObject(1));
    EXPECT_EQ(of->GetValueByName(0, "Caught").ToInt(), 5); // the same rocks
    EXPECT_EQ(of->GetValueByName(0, "CaughtShare").ToDouble(), 0.5);
  }
  EXPECT_EQ(this->Number(1, "CaughtShare", 0), 0.5);
  EXPECT_EQ(this->Number(1, "CaughtFrequency", 0), (4 * 0.25 + 0.0625) / 2);
  EXPECT_EQ(this->Number(1, "OverFrequency", 0), 2 * 0.0625 / 2);
  EXPECT_EQ(this->Number(1, "TooStrongFrequency", 0), 3 * 0.015625 / 2);
  EXPECT_NEAR(this->Number(1, "UncaughtShareHigh", 0), 0.777559, 1e-6); // of 5 of 10
  // Level 1: 250 kJ; what is over it stays.
  EXPECT_EQ(this->Number(1, "MaximumEnergyLevel", 2), 250);
  EXPECT_EQ(this->Number(1, "ServiceEnergyLevel", 2), 85);
  EXPECT_TRUE(std::isnan(this->Number(1, "ServiceEnergyLevel", 1)));
  EXPECT_EQ(this->Number(1, "Caught", 2), 8);
  EXPECT_EQ(this->Number(1, "Over", 2), 2);
  EXPECT_EQ(this->Number(1, "TooStrong", 2), 0);

  this->Filter->SetAnnualFrequency(0.5); // 1/40 for each of twenty releases
  EXPECT_DOUBLE_EQ(this->Number(1, "CaughtFrequency", 0), 5.0 / 40);
  this->Heard->Notes.clear();              // of the line
  this->Filter->SetAnnualFrequency(300.0); // a return period
  this->Filter->Update();
  ASSERT_EQ(this->Heard->Notes.size(), 2u); // the rocks have frequencies of their own
  EXPECT_NE(this->Heard->Notes[0].find("fall 300 times a year"), std::string::npos);
  EXPECT_NE(this->Heard->Notes[1].find("of their own are not used"), std::string::npos);
  this->Heard->Notes.clear();
  this->Filter->SetAnnualFrequency(0.0);
  this->Filter->SetInputData(this->Collect(false)->GetOutput());
  EXPECT_TRUE(std::isnan(this->Number(1, "CaughtFrequency", 0)));
}

TEST_F(TestBarrierDesign, SourcesOfWhatPasses)
{
  this->Filter->SetInputData(this->Collect()->GetOutput());
  const double uncaught[] = { 2, 3 }; // 3.0 high and 18 m/s; 2.5 high, 16 and 20 m/s
  const double frequency[] = { 0.0625 + 0.015625, 0.0625 + 2 * 0.015625 };
  const double all[] = { 0.5 + 0.125 + 0.015625, 0.5 + 0.0625 + 0.03125 };
  for (int row = 0; row < 2; ++row)
  {
    EXPECT_EQ(this->Number(2, "SourceId", row), row + 1);
    EXPECT_EQ(this->Number(2, "Rocks", row), 5);
    EXPECT_EQ(this->Number(2, "Share", row), 0.5);
    EXPECT_DOUBLE_EQ(this->Number(2, "UncaughtShare", row), uncaught[row] / 5);
    EXPECT_EQ(this->Number(2, "UncaughtFrequency", row), frequency[row] / 2);
    EXPECT_EQ(this->Number(2, "AnnualFrequency", row), all[row] / 2);
    EXPECT_NEAR(this->Number(2, "EnergyMaximum", row), row == 0 ? 162.1 : 200.1, 1e-9);
  }
}

TEST_F(TestBarrierDesign, PlacesAlongAFamily)
{
  // From right to left of the line, which points north, is against the fall: −10 m is further down.
  const auto collector = this->Collect();
  collector->SetParallelLines(2);
  collector->SetParallelSpacing(-10.0);
  collector->Update();
  this->Filter->SetInputData(collector->GetOutput());
  // The second line is reached by all again, the third, where they end, by none.
  const double rocksAt[] = { 10, 10, 0 };
  for (int row = 0; row < 3; ++row)
  {
    EXPECT_EQ(this->Number(3, "Offset", row), -10.0 * row);
    EXPECT_EQ(this->Number(3, "Rocks", row), rocksAt[row]);
    EXPECT_EQ(this->Number(3, "Share", row), rocksAt[row] / 20);
  }
  for (int row = 0; row < 2; ++row)
  {
    EXPECT_NEAR(this->Number(3, "EnergyInKilojoules95", row), 183.0, 1e-9);
    EXPECT_NEAR(this->Number(3, "EnergyInKilojoules99", row), 196.68, 1e-9);
    EXPECT_NEAR(this->Number(3, "TopHeight95", row), 3.775, 1e-12);
    EXPECT_EQ(this->Number(3, "RequiredClass99", row), 1);
    EXPECT_EQ(this->Number(3, "UncaughtShare", row), 0.5);
    EXPECT_EQ(this->Number(3, "UncaughtFrequency", row), (2 * 0.0625 + 3 * 0.015625) / 2);
  }
  auto* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(3));
  EXPECT_EQ(table->GetValueByName(1, "LineName").ToString(), "line 1 −10 m");
  // Through Merge Collectors, too.
  vtkNew<vtkMergeCollectors> merge;
  merge->AddInputDataObject(0, collector->GetOutput());
  this->Filter->SetInputConnection(merge->GetOutputPort());
  EXPECT_EQ(this->Number(3, "Offset", 1), -10.0);
}

/// Levels and quantiles are of the simulated rocks, however rare each is.
TEST_F(TestBarrierDesign, QuantilesOfRocksThatDifferInFrequency)
{
  const auto told = [](vtkAlgorithm* filter, int port)
  { return Told(filter, port, "by up to 16 times, but quantiles count each rock alike"); };
  const auto unlike = this->Collect(), unknown = this->Collect(false);
  vtkNew<vtkMergeCollectors> merge;
  merge->SetInputData(unlike->GetOutput());
  this->Filter->SetInputData(unlike->GetOutput());
  EXPECT_EQ(told(unlike, 1), 1);
  EXPECT_EQ(told(merge, 1), 1);
  EXPECT_EQ(told(this->Filter, 0), 1);
  this->Filter->SetAnnualFrequency(0.5); // of all alike
  EXPECT_EQ(told(this->Filter, 0), 0);
  EXPECT_EQ(told(unknown, 1), 0);
}

/// All that pass are as rare as each other, but rarer than those that do not.
TEST_F(TestBarrierDesign, SharesOfRocksThatDifferInFrequency)
{
  const char* const words =
    "Rocks that are released differ in their frequencies, by up to 16 times, but shares at lines";
  this->Points->SetPoint(0, 500010, 5100000.0 + 7 * 7 - 3, 0); // rocks 7 to 9, 1/64 a year
  this->Points->Modified();
  const auto unlike = this->Collect(), unknown = this->Collect(false);
  vtkNew<vtkMergeCollectors> merge;
  merge->SetInputData(unlike->GetOutput());
  this->Filter->SetInputData(unlike->GetOutput());
  EXPECT_EQ(this->Number(1, "CaughtShare", 0), 0.0);
  EXPECT_EQ(this->Number(3, "Share", 0), 3.0 / 20);
  EXPECT_EQ(this->Told("quantiles count each rock alike"), 0);
  for (auto [filter, port] : { std::pair<vtkAlgorithm*, int>(unlike, 1), { merge, 1 } })
  {
    EXPECT_EQ(Told(filter, port, words), 1);
  }
  EXPECT_EQ(this->Told(words), 1);
  EXPECT_EQ(Told(unknown, 1, words), 0);
  this->Filter->SetAnnualFrequency(0.5); // of all alike
  EXPECT_EQ(this->Told(words), 0);
}

/// 1/4 a year each, but rocks of one iteration and rocks of three: what passes is 3 to 1.
TEST_F(TestBarrierDesign, RocksOfUnlikeIterations)
{
  vtkNew<vtkMergeCollectors> merge;
  for (const int iterations : { 1, 3 })
  {
    const auto part = this->Collect(true, iterations, 2, iterations == 3);
    for (const int data : { 0, 1 })
    {
      vtkFieldData* fields = data == 0
        ? static_cast<vtkFieldData*>(part->GetOutput()->GetPointData())
        : part->GetOutput()->GetFieldData();
      fields->GetArray(data == 0 ? "Frequency" : "CollectorFrequencies")->FillComponent(0, 0.25);
    }
    merge->AddInputDataObject(0, part->GetOutput());
  }
  EXPECT_EQ(Told(merge, 1, "by up to 3 times, but quantiles count each rock alike"), 1);
  EXPECT_EQ(Told(merge, 1, "by up to 3 times, but shares at lines count each rock alike"), 1);
  this->Filter->SetInputConnection(merge->GetOutputPort());
  EXPECT_EQ(this->Told("by up to 3 times, but quantiles count each rock alike"), 1);
  EXPECT_DOUBLE_EQ(this->Number(3, "AnnualFrequency", 0), 5 * 0.25 + 5 * 0.25 / 3);
}

/// Not known is not never, where no rock passes or gets past, too.
TEST_F(TestBarrierDesign, FrequenciesThatAreNotKnown)
{
  this->Filter->SetInputData(this->Collect(false)->GetOutput());
  const auto expectUnknown = [this](int port, std::initializer_list<const char*> columns)
  {
    for (const char* column : columns)
    {
      EXPECT_TRUE(std::isnan(this->Number(port, column, 0))) << column;
    }
  };
  EXPECT_EQ(this->Number(1, "TooStrong", 8), 0.0); // of class 7
  EXPECT_TRUE(std::isnan(this->Number(1, "TooStrongFrequency", 8)));
  const auto expectAll = [&]
  {
    expectUnknown(1, { "CaughtFrequency", "OverFrequency", "TooStrongFrequency" });
    expectUnknown(3, { "AnnualFrequency", "UncaughtFrequency", "LostFrequency" });
  };
  expectAll();
  expectUnknown(2, { "AnnualFrequency", "UncaughtFrequency" });
  this->Points->SetPoint(0, 500029.5, 5099000, 0); // nothing passes there
  this->Points->SetPoint(1, 500029.5, 5099001, 0);
  this->Points->Modified();
  this->Filter->SetInputData(this->Collect(false)->GetOutput());
  EXPECT_EQ(this->Number(3, "Rocks", 0), 0.0);
  expectAll();
  this->Filter->SetInputData(this->Collect(true)->GetOutput());
  EXPECT_EQ(this->Number(3, "AnnualFrequency", 0), 0.0);
  this->Filter->SetInputData(this->Collect(false)->GetOutput());
  this->Filter->SetAnnualFrequency(0.5);
  EXPECT_EQ(this->Number(3, "AnnualFrequency", 0), 0.0);
}

/// Of some rocks only they are as if the others never fell.
TEST_F(TestBarrierDesign, FrequenciesOfSomeRocksOnly)
{
  for (const bool first : { true, false })
  {
    vtkNew<vtkMergeCollectors> merge;
    merge->AddInputDataObject(0, this->Collect(first, 2, 2, 0)->GetOutput());
    merge->AddInputDataObject(0, this->Collect(!first, 2, 2, 1)->GetOutput());
    merge->Update();
    this->ExpectOneError({ "part 2", "Frequency", "or none" });
  }
}

/// Rocks that were lost before the line may pass it, too.
TEST_F(TestBarrierDesign, RocksThatWereLostBefore)
{
  this->Filter->SetInputData(this->Collect(true, 2, 1, 0, Fate::LeftDomain)->GetOutput());
  EXPECT_EQ(
    this->Told("10 of 20 rocks went over the edge of the DEM before they passed the line"), 1);
  EXPECT_EQ(this->Number(3, "LostBefore", 0), 10.0);
  double all = 0.0;
  for (const Rock& rock : rocks)
  {
    all += rock.frequency / 2;
  }
  EXPECT_EQ(this->Number(3, "LostFrequency", 0), all);
  EXPECT_EQ(this->Number(3, "AnnualFrequency", 0), all); // of those that were seen to pass
  EXPECT_NEAR(this->Number(1, "UncaughtShareHigh", 0), 0.895919, 1e-6); // of 15 of 20
  this->Filter->SetAnnualFrequency(0.5);
  EXPECT_DOUBLE_EQ(this->Number(3, "LostFrequency", 0), 0.25);
  this->Filter->SetAnnualFrequency(0.0);
  this->Filter->SetInputData(this->Collect()->GetOutput());
  EXPECT_EQ(this->Told("before they passed"), 0);
  EXPECT_EQ(this->Number(3, "LostBefore", 0), 0.0);
  EXPECT_EQ(this->Number(3, "LostFrequency", 0), 0.0);
}

/// Sources 1 and 2 of two runs, each of which numbers them by itself.
TEST_F(TestBarrierDesign, SourcesOfTwoRuns)
{
  const char* const words = "2 of 2 SourceIds are of several runs, first 1: each run numbers its "
                            "sources by itself";
  const auto one = this->Collect(), other = this->Collect(true, 3);
  vtkFieldData* const fields[] = { other->GetOutput()->GetPointData(),
    other->GetOutput()->GetFieldData() };
  for (vtkFieldData* of : fields)
  {
    vtkDataArray* blocks = of->GetArray(of == fields[0] ? "BlockId" : "CollectorBlocks");
    for (vtkIdType k = 0; k < blocks->GetNumberOfTuples(); ++k)
    {
      blocks->SetTuple1(k, blocks->GetTuple1(k) + 50);
    }
  }
  vtkDataArray* energy = other->GetOutput()->GetPointData()->GetArray("KineticEnergy");
  for (vtkIdType k = 0; k < energy->GetNumberOfTuples(); ++k)
  {
    energy->SetTuple1(k, energy->GetTuple1(k) + 1000.0); // no copies
  }
  vtkNew<vtkMergeCollectors> merge;
  merge->AddInputDataObject(0, other->GetOutput());
  merge->AddInputDataObject(0, one->GetOutput());
  this->Filter->SetInputConnection(merge->GetOutputPort());
  const double ids[] = { 1, 1, 2, 2 };
  const double all[] = { 0.5 + 0.125 + 0.015625, 0.5 + 0.0625 + 0.03125 };
  for (int row = 0; row < 4; ++row)
  {
    EXPECT_EQ(this->Number(2, "SourceId", row), ids[row]);
    EXPECT_EQ(this->Number(2, "Rocks", row), 5);
    EXPECT_EQ(this->Number(2, "Share", row), 0.25);
    EXPECT_NEAR(
      this->Number(2, "AnnualFrequency", row), all[row / 2] / (row % 2 == 0 ? 2 : 3), 1e-12);
  }
  EXPECT_EQ(this->Told(words), 1);
  EXPECT_EQ(this->Told("fell exactly"), 0);
  this->Filter->SetInputData(one->GetOutput());
  EXPECT_EQ(this->Told(words), 0);
}

/// The same run under other block ids: its frequencies come twice.
TEST_F(TestBarrierDesign, ARunThatWasMadeAgain)
{
  const char* const words = "10 rocks fell exactly as another one of their iteration";
  const auto one = this->Collect(), again = this->Collect();
  vtkNew<vtkMergeCollectors> merge;
  merge->AddInputDataObject(0, one->GetOutput());
  merge->AddInputDataObject(0, again->GetOutput());
  merge->Update();
  this->ExpectOneError({ "is there twice" });
  vtkFieldData* const fields[] = { again->GetOutput()->GetPointData(),
    again->GetOutput()->GetFieldData() };
  for (vtkFieldData* of : fields)
  {
    vtkDataArray* blocks = of->GetArray(of == fields[0] ? "BlockId" : "CollectorBlocks");
    for (vtkIdType k = 0; k < blocks->GetNumberOfTuples(); ++k)
    {
      blocks->SetTuple1(k, blocks->GetTuple1(k) + 1000);
    }
  }
  again->GetOutput()->Modified();
  vtkNew<vtkMergeCollectors> twice;
  twice->AddInputDataObject(0, one->GetOutput());
  twice->AddInputDataObject(0, again->GetOutput());
  EXPECT_EQ(Told(twice, 1, words), 1);
  this->Filter->SetInputConnection(twice->GetOutputPort());
  EXPECT_EQ(this->Told(words), 1);
  EXPECT_EQ(Told(one, 1, words), 0);
}

/// What a factor replaces, leaves out or goes beyond is told.
TEST_F(TestBarrierDesign, FactorsThatAreNotWhatOneMayThink)
{
  const char *const replaced = "FactorSet replaces what these properties say: ",
                    *const less = "DesignMass makes less energy than the simulated rocks have",
                    *const above = "are above the last class, 4500 kJ",
                    *const alone = "partial factors are in Design and RequiredClass alone";
  this->Filter->SetInputData(this->Collect()->GetOutput());
  for (const char* words : { replaced, less, above, alone })
  {
    EXPECT_EQ(this->Told(words), 0) << words;
  }
  this->Filter->SetSlopeSurveyFactor(1.2);
  this->Filter->SetBlockSurveyFactor(1.3);
  EXPECT_EQ(this->Told(replaced), 0);
  EXPECT_EQ(this->Told(alone), 1);
  this->Filter->SetFactorSet(vtkBarrierDesign::UNI_GOOD);
  EXPECT_EQ(this->Told(std::string(replaced) + "SlopeSurveyFactor, BlockSurveyFactor"), 1);
  this->Filter->SetSlopeSurveyFactor(1.0);
  this->Filter->SetBlockSurveyFactor(1.0);
  EXPECT_EQ(this->Told(replaced), 0);
  this->Filter->SetFactorSet(vtkBarrierDesign::TYPED);
  this->Filter->SetDesignMass(500.0); // the rocks have 1000 kg: 20² / 4 kJ of 200.1
  EXPECT_EQ(
    this->Told("On 1 of 1 lines DesignMass makes less energy than the simulated rocks have, "
               "first \"line 1\", 50 %: 30.25 kJ instead of 61.1 kJ"),
    1);
  this->Filter->SetDesignMass(1100.0);
  EXPECT_EQ(this->Told(less), 0);
  this->Filter->SetDesignMass(0.0);
  this->Filter->SetBarrierFactor(25.0);
  EXPECT_EQ(this->Told("On 1 of 1 lines design energies times BarrierFactor are above the last "
                       "class, 4500 kJ, first \"line 1\", 95 %: 4575 kJ"),
    1);
}

TEST_F(TestBarrierDesign, PartsAreTheWhole)
{
  this->Filter->SetInputData(this->Collect()->GetOutput());
  vtkNew<vtkMergeCollectors> merge;
  for (const int part : { 2, 0, 1 })
  {
    merge->AddInputDataObject(0, this->Collect(true, 2, 3, part)->GetOutput());
  }
  vtkNew<vtkBarrierDesign> merged;
  merged->SetInputConnection(merge->GetOutputPort());
  merged->Update();
  this->Filter->Update();
  for (int port = 0; port < 3; ++port)
  {
    auto* one = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(port));
    auto* other = vtkTable::SafeDownCast(merged->GetOutputDataObject(port));
    ASSERT_EQ(one->GetNumberOfRows(), other->GetNumberOfRows());
    for (vtkIdType column = 0; column < one->GetNumberOfColumns(); ++column)
    {
      for (vtkIdType row = 0; row < one->GetNumberOfRows(); ++row)
      {
        const vtkVariant a = one->GetValue(row, column), b = other->GetValue(row, column);
        const bool neither = a.IsNumeric() && std::isnan(a.ToDouble()) && std::isnan(b.ToDouble());
        EXPECT_TRUE(a == b || neither) << one->GetColumnName(column);
      }
    }
  }
}

// A Threshold of crossings leaves the rocks in the count that they are shares of.
TEST_F(TestBarrierDesign, CrossingsThatAreLeftOutAreTold)
{
  const auto crossings = this->Collect();
  vtkNew<vtkPolyData> some;
  some->DeepCopy(crossings->GetOutput());
  ASSERT_EQ(some->GetNumberOfPoints(), 10);
  vtkNew<vtkPoints> points;
  vtkNew<vtkPointData> data;
  data->CopyAllocate(some->GetPointData());
  vtkNew<vtkCellArray> vertices;
  for (vtkIdType k = 0; k < 4; ++k)
  {
    points->InsertNextPoint(some->GetPoint(k));
    data->CopyData(some->GetPointData(), k, k);
    vertices->InsertNextCell(1, &k);
  }
  some->SetPoints(points);
  some->SetVerts(vertices);
  some->GetPointData()->ShallowCopy(data);
  this->Filter->SetInputData(some);
  this->Filter->Update();
  auto* notes = vtkStringArray::SafeDownCast(
    this->Filter->GetOutputDataObject(0)->GetFieldData()->GetAbstractArray("Notes"));
  ASSERT_NE(notes, nullptr);
  EXPECT_EQ(notes->GetValue(0),
    "The Input has 4 of the 10 crossings of its collector: rocks that are left out count as not "
    "having come");
  this->Filter->SetInputData(crossings->GetOutput());
  this->Filter->Update();
  notes = vtkStringArray::SafeDownCast(
    this->Filter->GetOutputDataObject(0)->GetFieldData()->GetAbstractArray("Notes"));
  EXPECT_TRUE(!notes || notes->GetValue(0).rfind("The Input has", 0) != 0);
}

TEST_F(TestBarrierDesign, BadInput)
{
  const auto crossings = this->Collect();
  this->Filter->SetInputData(crossings->GetOutput());
  this->Filter->SetUnitWeightFactor(0.9);
  this->Filter->Update();
  this->ExpectOneError({ "UnitWeightFactor is 0.9", "at least 1" });
  this->Filter->SetUnitWeightFactor(1.0);
  this->Filter->SetAnnualFrequency(-1.0);
  this->Filter->Update();
  this->ExpectOneError({ "AnnualFrequency is -1" });
  this->Filter->SetAnnualFrequency(0.0);
  this->Filter->SetFactorSet(3);
  this->Filter->Update();
  this->ExpectOneError({ "FactorSet is 3" });
  this->Filter->SetFactorSet(0);
  vtkNew<vtkPolyData> older, none;
  older->DeepCopy(crossings->GetOutput());
  older->GetPointData()->RemoveArray("TopHeight");
  this->Filter->SetInputData(older);
  this->Filter->Update();
  this->ExpectOneError({ "TopHeight", "anew" });
  // A rock of 1/4 a year in the first iteration and 1/16 in the second.
  vtkNew<vtkPolyData> differing;
  differing->DeepCopy(crossings->GetOutput());
  for (const auto& [name, number] :
    { std::pair("RockId", 0), std::pair("BlockId", 100), std::pair("Iteration", 1) })
  {
    differing->GetPointData()->GetArray(name)->SetTuple1(4, number);
  }
  this->Filter->SetInputData(differing);
  this->Filter->Update();
  this->ExpectOneError({ "The Frequency of rock 0 is 0.0625 per year in one iteration and 0.25" });
  this->Filter->SetInputData(none);
  this->Filter->Update();
  this->ExpectOneError({ "CollectorBarrier", "Trajectory Collector" });
}

TEST_F(TestBarrierDesign, ALineThatNothingPasses)
{
  this->Points->SetPoint(0, 500029.5, 5099000, 0);
  this->Points->SetPoint(1, 500029.5, 5099001, 0);
  this->Points->Modified();
  this->Filter->SetInputData(this->Collect()->GetOutput());
  EXPECT_EQ(this->Number(0, "Rocks", 2), 0);
  EXPECT_TRUE(std::isnan(this->Number(0, "EnergyInKilojoules", 2)));
  EXPECT_EQ(this->Number(0, "RequiredClass", 2), -1);
  EXPECT_EQ(this->Number(0, "BarrierHolds", 2), 0);
  EXPECT_TRUE(std::isnan(this->Number(1, "UncaughtShareHigh", 0)));
  EXPECT_EQ(vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2))->GetNumberOfRows(), 0);
}
