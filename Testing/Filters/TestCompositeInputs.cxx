// Composite data as any input: as if the parts had been appended, or one error; never leaf by leaf.

#include "shared/arrays.h"
#include "shared/inputContent.h"
#include "simulationTest.h"

#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkDispersionAngle.h"
#include "vtkDrawnStructure.h"
#include "vtkGroupDataSetsFilter.h"
#include "vtkHazardMapWriter.h"
#include "vtkHazardPassageReader.h"
#include "vtkHazardPassageWriter.h"
#include "vtkImageData.h"
#include "vtkLineSource.h"
#include "vtkMergeCollectors.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkRockfallHazardMap.h"
#include "vtkStringArray.h"
#include "vtkTrajectoryCollector.h"
#include "vtkTrajectoryLayerWriter.h"

#include <algorithm>
#include <filesystem>

namespace
{

/// All cells of a table as text.
std::string textOf(vtkTable* table)
{
  std::string text;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    for (vtkIdType column = 0; column < table->GetNumberOfColumns(); ++column)
    {
      text += table->GetValue(row, column).ToString() + ",";
    }
    text += "\n";
  }
  return text;
}

class TestCompositeInputs : public SimulationTest
{
protected:
  void SetUp() override
  {
    this->SimulationTest::SetUp();
    this->Others->SetCenter(5, 50, 62); // falls onto the first
    this->Others->SetFirstBlockId(2);
    this->Simulation->SetRockRockContact(true);
    this->Appended->AddInputConnection(this->Rocks->GetOutputPort());
    this->Appended->AddInputConnection(this->Others->GetOutputPort());
  }

  /// What the simulation makes of the appended rocks.
  std::string OfAppended()
  {
    this->Simulation->SetInputConnection(1, this->Appended->GetOutputPort());
    return textOf(this->Summary());
  }

  vtkSmartPointer<vtkDataObject> Grouped(
    int type, std::initializer_list<vtkAlgorithmOutput*> parts, bool nested = false)
  {
    vtkNew<vtkGroupDataSetsFilter> group;
    group->SetOutputType(type);
    for (vtkAlgorithmOutput* part : parts)
    {
      group->AddInputConnection(part);
    }
    group->Update();
    vtkSmartPointer<vtkDataObject> made = group->GetOutputDataObject(0);
    if (nested)
    {
      vtkNew<vtkMultiBlockDataSet> outer;
      outer->SetBlock(3, made); // others are empty
      return outer.Get();
    }
    return made;
  }

  vtkNew<vtkRockBlockSource> Others;
  vtkNew<vtkAppendPolyData> Appended;
};

} // namespace

TEST_F(TestCompositeInputs, RocksOfSeveralPartsAreOneErrorWithTheRemedy)
{
  const auto parts = { this->Rocks->GetOutputPort(), this->Others->GetOutputPort() };
  for (const int type :
    { VTK_MULTIBLOCK_DATA_SET, VTK_PARTITIONED_DATA_SET, VTK_PARTITIONED_DATA_SET_COLLECTION })
  {
    for (const bool nested : { false, true })
    {
      if (nested && type != VTK_MULTIBLOCK_DATA_SET)
      {
        continue;
      }
      SCOPED_TRACE(type);
      this->Simulation->SetInputDataObject(1, this->Grouped(type, parts, nested));
      this->ExpectEmpty();
      EXPECT_TRUE(this->Simulation->GetOutputDataObject(3)->IsA("vtkTable"));
      this->ExpectOneError({ "The Rocks input", "composite, of 2 parts", "Append Geometry" });
    }
  }
  // The remedy works, and one part is as good as none around it.
  const std::string both = this->OfAppended();
  EXPECT_EQ(std::count(both.begin(), both.end(), '\n'), 2);
  this->Simulation->SetInputConnection(1, this->Rocks->GetOutputPort());
  const std::string alone = textOf(this->Summary());
  this->Simulation->SetInputDataObject(
    1, this->Grouped(VTK_MULTIBLOCK_DATA_SET, { this->Rocks->GetOutputPort() }, true));
  EXPECT_EQ(textOf(this->Summary()), alone);
}

TEST_F(TestCompositeInputs, AnAnimationDoesNotRunAgain)
{
  vtkNew<vtkGroupDataSetsFilter> group;
  group->AddInputConnection(this->Rocks->GetOutputPort());
  this->Simulation->SetInputConnection(1, group->GetOutputPort());
  for (const double time : { 0.0, 1.0, 2.0, 3.0 })
  {
    EXPECT_EQ(this->RocksAt(time)->GetNumberOfCells(), 6);
  }
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 1);
  this->Rocks->SetCenter(5, 51, 62);
  this->RocksAt(1.0);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 2);
}

TEST_F(TestCompositeInputs, OnePartThatCannotBeTakenIsOneError)
{
  vtkNew<vtkMultiBlockDataSet> mixed;
  this->Rocks->Update();
  mixed->SetBlock(0, this->Rocks->GetOutput());
  vtkNew<vtkImageData> image;
  mixed->SetBlock(1, image);
  this->Simulation->SetInputDataObject(1, mixed);
  this->ExpectEmpty();
  this->ExpectOneError({ "The Rocks input", "part 2", "vtkImageData", "Extract Surface" });
}

TEST_F(TestCompositeInputs, ASlopeAmongOtherParts)
{
  const std::string expected = this->OfAppended();
  vtkNew<vtkLineSource> line; // beside it
  this->Simulation->SetInputDataObject(0,
    this->Grouped(
      VTK_MULTIBLOCK_DATA_SET, { line->GetOutputPort(), this->Terrain->GetOutputPort() }));
  EXPECT_EQ(textOf(this->Summary()), expected);
  vtkNew<vtkDEMToCFESource> second;
  this->Simulation->SetInputDataObject(0,
    this->Grouped(
      VTK_MULTIBLOCK_DATA_SET, { this->Terrain->GetOutputPort(), second->GetOutputPort() }));
  this->ExpectEmpty();
  this->ExpectOneError({ "The Terrain input", "part 2", "second slope" });
}

TEST_F(TestCompositeInputs, AnErrorOfAPartIsToldOnce)
{
  this->Others->SetVolume(-1.0);
  vtkNew<vtkGroupDataSetsFilter> group;
  group->AddInputConnection(this->Rocks->GetOutputPort());
  group->AddInputConnection(this->Others->GetOutputPort());
  this->Simulation->SetInputConnection(1, group->GetOutputPort());
  this->ExpectEmpty();
  this->ExpectOneError({ "Volume", "-1" });
}

TEST_F(TestCompositeInputs, TrajectoriesOfTwoRunsInEveryFilter)
{
  this->Simulation->SetRockRockContact(false);
  this->Simulation->SetIterations(2);
  vtkNew<vtkRockfallSimulation> next;
  next->SetInputConnection(0, this->Terrain->GetOutputPort());
  next->SetInputConnection(1, this->Rocks->GetOutputPort());
  next->SetEndTime(3.0);
  next->SetIterations(2);
  next->SetFirstIteration(2);
  vtkNew<vtkAppendPolyData> append;
  append->AddInputConnection(this->Simulation->GetOutputPort(1));
  append->AddInputConnection(next->GetOutputPort(1));
  append->Update();
  const auto grouped = this->Grouped(
    VTK_MULTIBLOCK_DATA_SET, { this->Simulation->GetOutputPort(1), next->GetOutputPort(1) });
  vtkNew<vtkLineSource> lines[2];
  for (int k = 0; k < 2; ++k)
  {
    lines[k]->SetPoint1(20 + 10 * k, 0, 0);
    lines[k]->SetPoint2(20 + 10 * k, 100, 0);
  }
  vtkNew<vtkAppendPolyData> bothLines;
  bothLines->AddInputConnection(lines[0]->GetOutputPort());
  bothLines->AddInputConnection(lines[1]->GetOutputPort());
  bothLines->Update();
  const auto groupedLines = this->Grouped(
    VTK_MULTIBLOCK_DATA_SET, { lines[0]->GetOutputPort(), lines[1]->GetOutputPort() });

  std::string collected[2], angles[2], passed[2];
  std::vector<double> reached[2];
  std::uintmax_t layers[2];
  vtkNew<vtkTrajectoryCollector> collectors[2];
  for (int k = 0; k < 2; ++k)
  {
    vtkDataObject* input = k == 0 ? append->GetOutputDataObject(0) : grouped.Get();
    collectors[k]->SetInputDataObject(0, input);
    collectors[k]->SetInputDataObject(
      1, k == 0 ? bothLines->GetOutputDataObject(0) : groupedLines.Get());
    collectors[k]->Update();
    collected[k] = textOf(vtkTable::SafeDownCast(collectors[k]->GetOutputDataObject(1)));
    vtkNew<vtkDispersionAngle> angle;
    angle->SetInputDataObject(input);
    angle->Update();
    angles[k] = textOf(vtkTable::SafeDownCast(angle->GetOutputDataObject(0)));
    vtkNew<vtkRockfallHazardMap> map;
    map->SetInputDataObject(0, input);
    map->SetInputConnection(1, this->Terrain->GetOutputPort());
    map->Update();
    auto* image = vtkImageData::SafeDownCast(map->GetOutputDataObject(0));
    ASSERT_TRUE(image);
    vtkDataArray* rocks = image->GetCellData()->GetArray("Rocks");
    ASSERT_TRUE(rocks);
    for (vtkIdType cell = 0; cell < rocks->GetNumberOfTuples(); ++cell)
    {
      reached[k].push_back(rocks->GetTuple1(cell));
    }
    const std::string file = this->WriteFile("run" + std::to_string(k) + ".passages", "");
    vtkNew<vtkHazardPassageWriter> writer;
    writer->SetInputDataObject(0, input);
    writer->SetInputConnection(1, this->Terrain->GetOutputPort());
    writer->SetFileName(file.c_str());
    writer->Write();
    std::ifstream in(file, std::ios::binary);
    passed[k] = { std::istreambuf_iterator<char>(in), {} };
    const std::string csv = this->WriteFile("lines" + std::to_string(k) + ".csv", "");
    vtkNew<vtkTrajectoryLayerWriter> layer;
    layer->SetInputDataObject(input);
    layer->SetFileName(csv.c_str());
    layer->Write();
    layers[k] = std::filesystem::file_size(csv);
  }
  EXPECT_EQ(collected[0], collected[1]);
  EXPECT_EQ(std::count(collected[0].begin(), collected[0].end(), '\n'), 2);
  EXPECT_EQ(angles[0], angles[1]);
  EXPECT_EQ(reached[0], reached[1]);
  EXPECT_GT(*std::max_element(reached[0].begin(), reached[0].end()), 2.0);
  EXPECT_FALSE(passed[0].empty());
  EXPECT_EQ(passed[0], passed[1]);
  EXPECT_GT(layers[0], 1000u);
  EXPECT_EQ(layers[0], layers[1]);
}

/// Doubts on a run's books go with its trajectories, and those of each part with all of them.
TEST_F(TestCompositeInputs, AMapTellsTheDoubtsOfItsRuns)
{
  this->Simulation->SetEndTime(1.0);
  this->Simulation->Update();
  vtkNew<vtkPolyData> doubted;
  doubted->DeepCopy(this->Simulation->GetOutputDataObject(1));
  rockfall::filters::addTexts(
    doubted->GetFieldData(), rockfall::filters::kRunDoubts, std::vector<std::string>{ "odd" });
  this->Simulation->SetFirstIteration(1);
  this->Simulation->Update();
  vtkNew<vtkMultiBlockDataSet> two;
  two->SetBlock(0, this->Simulation->GetOutputDataObject(1));
  two->SetBlock(1, doubted);
  const auto told = [this](vtkDataObject* trajectories, const std::string& note)
  {
    vtkNew<vtkRockfallHazardMap> map;
    map->SetInputDataObject(0, trajectories);
    map->SetInputConnection(1, this->Terrain->GetOutputPort());
    map->Update();
    auto* notes = vtkStringArray::SafeDownCast(
      map->GetOutputDataObject(0)->GetFieldData()->GetAbstractArray("Notes"));
    return notes && notes->LookupValue(note) >= 0;
  };
  EXPECT_TRUE(told(doubted, "odd"));
  EXPECT_TRUE(told(two, "part 2 of the Input: odd"));
  EXPECT_FALSE(told(this->Simulation->GetOutputDataObject(1), "odd"));
}

TEST_F(TestCompositeInputs, CrossingsOfSeveralCollectors)
{
  vtkNew<vtkLineSource> line;
  line->SetPoint1(20, 0, 0);
  line->SetPoint2(20, 100, 0);
  vtkNew<vtkRockfallSimulation> runs[2];
  vtkNew<vtkTrajectoryCollector> collectors[2];
  vtkNew<vtkMergeCollectors> merge, mergeGrouped;
  for (int k = 0; k < 2; ++k)
  {
    runs[k]->SetInputConnection(0, this->Terrain->GetOutputPort());
    runs[k]->SetInputConnection(1, this->Rocks->GetOutputPort());
    runs[k]->SetEndTime(3.0);
    runs[k]->SetIterations(2);
    runs[k]->SetFirstIteration(2 * k);
    collectors[k]->SetInputConnection(0, runs[k]->GetOutputPort(1));
    collectors[k]->SetInputConnection(1, line->GetOutputPort());
    merge->AddInputConnection(collectors[k]->GetOutputPort());
  }
  merge->Update();
  mergeGrouped->SetInputDataObject(this->Grouped(
    VTK_MULTIBLOCK_DATA_SET, { collectors[0]->GetOutputPort(), collectors[1]->GetOutputPort() }));
  mergeGrouped->Update();
  const std::string expected = textOf(vtkTable::SafeDownCast(merge->GetOutputDataObject(1)));
  EXPECT_EQ(textOf(vtkTable::SafeDownCast(mergeGrouped->GetOutputDataObject(1))), expected);
  EXPECT_FALSE(expected.empty());
}

TEST_F(TestCompositeInputs, SourcesStandOnASlopeOfComposites)
{
  this->Rocks->SetPlaceOnGround(true);
  this->Rocks->SetInputDataObject(
    1, this->Grouped(VTK_MULTIBLOCK_DATA_SET, { this->Terrain->GetOutputPort() }));
  this->Rocks->Update();
  ASSERT_TRUE(this->Rocks->GetOutputDataObject(0)->IsA("vtkPolyData"));
  EXPECT_EQ(this->Rocks->GetOutput()->GetNumberOfCells(), 6);
  vtkNew<vtkDrawnStructure> drawn;
  drawn->SetInputDataObject(
    this->Grouped(VTK_MULTIBLOCK_DATA_SET, { this->Terrain->GetOutputPort() }));
  drawn->Update();
  auto* slope = vtkPolyData::SafeDownCast(drawn->GetOutputDataObject(0));
  ASSERT_TRUE(slope);
  EXPECT_EQ(slope->GetNumberOfCells(), this->Terrain->GetOutput()->GetNumberOfCells());
}

TEST_F(TestCompositeInputs, AMapAmongCompositesIsWrittenOnce)
{
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputConnection(0, this->Simulation->GetOutputPort(1));
  map->SetInputConnection(1, this->Terrain->GetOutputPort());
  map->Update();
  vtkNew<vtkMultiBlockDataSet> composite;
  composite->SetBlock(2, map->GetOutputDataObject(0));
  const std::string file = this->WriteFile("map.tif", "");
  vtkNew<vtkHazardMapWriter> writer;
  writer->SetInputDataObject(composite);
  writer->SetFileName(file.c_str());
  writer->Write();
  EXPECT_GT(std::filesystem::file_size(file), 1000u);
  composite->SetBlock(3, map->GetOutputDataObject(0));
  composite->Modified();
  writer->Modified();
  writer->Write();
  this->ExpectOneError({ "several images", "one hazard map" });
}
