// Embankments, trees and barriers on their way through the pipeline.

#include "shared/structureFieldData.h"
#include "shared/terrainFieldData.h"
#include "simulationTest.h"
#include "terrain/Obstacles.h"
#include "terrain/Surface.h"

#include "vtkCellData.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

using namespace rockfall;

namespace
{

class TestStructures : public SimulationTest
{
protected:
  void SetUp() override
  {
    this->SimulationTest::SetUp();
    this->Terrain->SetEmbankmentFile(this
                                       ->WriteFile("dams.csv",
                                         "WKT,height,width,slope,phi\n"
                                         "\"LINESTRING(200 20,200 80)\",3.5,1.5,1.5,40\n")
                                       .c_str());
    this->Terrain->SetTreeFile(
      this->WriteFile("trees.csv", "x,y,diameter,height,capacity\n180,10,30,20,\n180,90,30,20,5\n")
        .c_str());
    this->Terrain->SetBarrierFile(
      this
        ->WriteFile("nets.csv",
          "WKT,height,capacity,braking,name\n\"LINESTRING(60 1,60 99)\",30,1000,6,Upper net\n")
        .c_str());
  }
};

} // namespace

TEST_F(TestStructures, AreShownBesideTheSlope)
{
  this->Terrain->Update();
  // The slope itself is as without them: one triangle per CFE.
  vtkNew<vtkDEMToCFESource> bare;
  bare->Update();
  EXPECT_EQ(this->Terrain->GetOutput()->GetNumberOfCells(), bare->GetOutput()->GetNumberOfCells());
  EXPECT_EQ(bare->GetOutput(1)->GetNumberOfCells(), 0);
  vtkPolyData* shown = this->Terrain->GetOutput(1);
  vtkDataArray* kind = shown->GetCellData()->GetArray("StructureKind");
  ASSERT_NE(kind, nullptr);
  int count[3] = { 0, 0, 0 };
  for (vtkIdType k = 0; k < shown->GetNumberOfCells(); ++k)
  {
    ++count[int(kind->GetTuple1(k))];
  }
  EXPECT_GT(count[0], 0);
  EXPECT_EQ(count[1], 2 * Obstacles::treeTriangles);
  EXPECT_EQ(count[2], 20); // 98 m in pieces of at most 5 m
}

/// A note on a layer of structures names it, and not the elevations as well.
TEST_F(TestStructures, NotesNameTheirOwnFile)
{
  const std::string forest =
    this->WriteFile("odd.csv", "x,y,diameter,height\n180,10,1.5,20\n180,90,30,20\n");
  this->Terrain->SetTreeFile(forest.c_str());
  this->Terrain->Update();
  int told = 0;
  for (const std::string& note : this->Heard->Notes)
  {
    const std::size_t at = note.find(forest);
    told += at != std::string::npos ? 1 : 0;
    EXPECT_TRUE(at == std::string::npos || at < 10) << note; // but for a word of VTK's
  }
  EXPECT_EQ(told, 1);
}

/// What is shown of many trees is thinned out as the slope is; the simulation has all of them.
TEST_F(TestStructures, ManyTreesAreShownInPart)
{
  std::string rows = "x,y,diameter,height\n";
  for (int k = 0; k < 100; ++k)
  {
    rows += std::to_string(20 + 2 * k) + ",50,30,20\n";
  }
  this->Terrain->SetEmbankmentFile("");
  this->Terrain->SetBarrierFile("");
  this->Terrain->SetTreeFile(this->WriteFile("many.csv", rows).c_str());
  this->Terrain->SetMaximumDisplayCells(40 * Obstacles::treeTriangles);
  this->Terrain->Update();
  vtkPolyData* shown = this->Terrain->GetOutput(1);
  ASSERT_EQ(shown->GetNumberOfCells(), 34 * Obstacles::treeTriangles); // one in three
  vtkDataArray* number = shown->GetCellData()->GetArray("CFEId");
  const rockfall::Terrain terrain = filters::readTerrain(this->Terrain->GetOutput());
  ASSERT_EQ(terrain.obstacles()->structures().trees.size(), 100u);
  const vtkIdType last = shown->GetNumberOfCells() - 1;
  EXPECT_EQ(value(shown->GetCellData(), "StructureId", last), 100.0);
  EXPECT_EQ(terrain.obstacles()->treeOf(std::int64_t(number->GetTuple1(last))), 99);
}

TEST_F(TestStructures, ARasterOfDensitiesIsAForest)
{
  const float bands[2] = { 400.0F, 30.0F };
  const std::string name =
    this->WriteFile("stands.img", std::string(reinterpret_cast<const char*>(bands), sizeof(bands)));
  this->WriteFile("stands.hdr",
    "ENVI\nsamples = 1\nlines = 1\nbands = 2\nheader offset = 0\nfile type = ENVI Standard\n"
    "data type = 4\ninterleave = bsq\nbyte order = 0\nmap info = {Arbitrary, 1, 1, 0, 100, 100, "
    "100}\n");
  this->Terrain->SetTreeFile(name.c_str());
  this->Terrain->Update();
  const rockfall::Terrain terrain = filters::readTerrain(this->Terrain->GetOutput());
  ASSERT_NE(terrain.obstacles(), nullptr);
  // 400 of the hectare: four deviations of Poisson's number.
  EXPECT_NEAR(double(terrain.obstacles()->structures().trees.size()), 400.0, 80.0);
}

TEST_F(TestStructures, SurviveAFile)
{
  const std::string name = this->WriteFile("slope.vtp", "");
  this->Terrain->SetTreesBreak(0); // an infinite capacity survives as well
  this->Terrain->Update();
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(name.c_str());
  writer->SetInputConnection(this->Terrain->GetOutputPort());
  writer->SetDataModeToBinary(); // not every libexpat lets appended data be read back
  writer->Write();
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(name.c_str());
  reader->Update();
  const rockfall::Terrain before = filters::readTerrain(this->Terrain->GetOutput());
  const rockfall::Terrain after = filters::readTerrain(reader->GetOutput());
  ASSERT_NE(after.obstacles(), nullptr);
  const Structures &a = before.obstacles()->structures(), &b = after.obstacles()->structures();
  ASSERT_EQ(b.embankments.size(), 1u);
  EXPECT_EQ(a.embankments[0].points, b.embankments[0].points);
  EXPECT_EQ(b.embankments[0].height, 3.5);
  EXPECT_TRUE(std::isnan(b.embankments[0].elevation));
  EXPECT_EQ(b.embankments[0].material, 1);
  EXPECT_EQ(a.materials[0].frictionAngle, b.materials[0].frictionAngle);
  ASSERT_EQ(b.trees.size(), 2u);
  EXPECT_TRUE(std::isinf(b.trees[0].capacity));
  EXPECT_EQ(b.trees[1].capacity, 5e3);
  ASSERT_EQ(b.barriers.size(), 1u);
  EXPECT_EQ(b.barriers[0].capacity, 1e6);
  EXPECT_EQ(b.barriers[0].braking, 6.0);
  EXPECT_EQ(b.barriers[0].name, "Upper net");
  EXPECT_EQ(b.embankments[0].name, "");
  EXPECT_FALSE(isLoaded(b.barriers[0])); // neither worn nor filled
}

/// A stem that lies is drawn and travels with its other end.
TEST_F(TestStructures, StemsThatLieTravelWithTheSlope)
{
  const std::string stems = this->WriteFile(
    "logs.csv", "WKT,diameter,height\nPOINT(180 10),30,20\n\"LINESTRING(180 80,180 90)\",40,\n");
  this->Terrain->SetTreeFile(stems.c_str());
  this->Terrain->Update();
  const rockfall::Terrain terrain = filters::readTerrain(this->Terrain->GetOutput());
  ASSERT_NE(terrain.obstacles(), nullptr);
  const std::vector<Tree>& trees = terrain.obstacles()->structures().trees;
  ASSERT_EQ(trees.size(), 2u);
  EXPECT_FALSE(trees[0].lies());
  EXPECT_EQ(trees[1].position, Eigen::Vector2d(180.0, 80.0));
  EXPECT_EQ(trees[1].end, Eigen::Vector2d(180.0, 90.0));
  vtkPolyData* shown = this->Terrain->GetOutput(1);
  vtkDataArray* kind = shown->GetCellData()->GetArray("StructureKind");
  vtkDataArray* feature = shown->GetCellData()->GetArray("StructureId");
  double box[6], top = 0.0;
  int count = 0;
  for (vtkIdType k = 0; k < shown->GetNumberOfCells(); ++k)
  {
    if (kind->GetTuple1(k) == 1.0 && feature->GetTuple1(k) == 2.0)
    {
      ++count;
      shown->GetCellBounds(k, box);
      EXPECT_GE(box[2], 80.0 - 1e-9);
      EXPECT_LE(box[3], 90.0 + 1e-9);
      top = std::max(top, box[5]);
    }
  }
  EXPECT_EQ(count, int(Obstacles::lyingShape().triangles.size()));
  EXPECT_GE(top, terrain.elevation(180.0, 85.0) + 0.4 - 1e-9);
  EXPECT_LT(top, terrain.elevation(180.0, 85.0) + 0.6);
}

TEST_F(TestStructures, ACrestTravelsWithTheSlope)
{
  const std::string dams = this->WriteFile(
    "crest.csv", "WKT,crest,width,slope\n\"LINESTRING(200 20,200 80)\",2.25,1.5,1.5\n");
  this->Terrain->SetEmbankmentFile(dams.c_str());
  this->Terrain->Update();
  const rockfall::Terrain terrain = filters::readTerrain(this->Terrain->GetOutput());
  ASSERT_NE(terrain.obstacles(), nullptr);
  const Embankment& read = terrain.obstacles()->structures().embankments.at(0);
  EXPECT_TRUE(std::isnan(read.height));
  EXPECT_EQ(read.elevation, 2.25);
}

/// What a structure does not say of its material is drawn as the slope's is.
TEST_F(TestStructures, AMaterialTravelsWithTheSlope)
{
  const std::string dams = this->WriteFile("material.csv",
    "WKT,height,width,slope,phi,cohesion\n\"LINESTRING(200 20,200 80)\",2,1.5,1.5,35,7\n");
  this->Terrain->SetEmbankmentFile(dams.c_str());
  this->Terrain->SetRestitutionCoefficient(0.5);
  this->Terrain->SetRestitutionDeviation(0.1);
  this->Terrain->SetFrictionAngleDeviation(4.0);
  this->Terrain->Update();
  const rockfall::Terrain terrain = filters::readTerrain(this->Terrain->GetOutput());
  ASSERT_NE(terrain.obstacles(), nullptr);
  const SurfaceMaterial& read = terrain.obstacles()->structures().materials.at(0);
  EXPECT_EQ(read.restitution, 0.5);
  EXPECT_EQ(read.restitutionDeviation, 0.1);
  EXPECT_DOUBLE_EQ(read.frictionAngle, radians(35.0));
  EXPECT_EQ(read.frictionAngleDeviation, 0.0);
  EXPECT_EQ(read.cohesion, 7.0);
  const GroundTouch onDam{ .cfe = terrain.cfeCapacity() + 1 };
  EXPECT_EQ(terrain.restitutionClassOf(onDam.cfe), 1);
  EXPECT_NE(
    Surface(terrain, 1, 1).restitutionAt(onDam), Surface(terrain, 1, 2).restitutionAt(onDam));
}

TEST_F(TestStructures, ABarrierCatchesTheRock)
{
  // Thrown at it, and met in flight: a step of contact has books of its own.
  this->Rocks->SetVelocity(10.0, 0.0, 5.0);
  this->Simulation->SetEndTime(20.0);
  vtkPolyData* met = this->Output(4);
  ASSERT_EQ(met->GetNumberOfPoints(), 1);
  EXPECT_EQ(value(met->GetPointData(), "StructureId"), 1.0);
  EXPECT_EQ(value(met->GetPointData(), "Outcome"), 0.0);
  EXPECT_NEAR(met->GetPoint(0)[0], 60.0, 1e-6);
  EXPECT_EQ(value(met->GetPointData(), "UsefulHeight"), 30.0);
  EXPECT_EQ(value(met->GetPointData(), "HeldBefore"), 0.0);
  EXPECT_NEAR(value(met->GetPointData(), "BrakingDistance"),
    6.0 * std::sqrt(value(met->GetPointData(), "EnergyTaken") / 1e6), 1e-12);
  EXPECT_EQ(value(this->Summary()->GetRowData(), "FateCode"), 3.0);
  // Books close with the fall on the braking way; what the net is rated by is the energy at its line.
  const auto summary = [this](const char* column)
  { return value(this->Summary()->GetRowData(), column); };
  const double energy = value(met->GetPointData(), "KineticEnergy");
  const double drop = met->GetPoint(0)[2] - summary("StopZ");
  EXPECT_EQ(value(met->GetPointData(), "EnergyTaken"), energy);
  EXPECT_NEAR(std::hypot(summary("StopX") - 60.0, summary("StopY") - met->GetPoint(0)[1], drop),
    value(met->GetPointData(), "BrakingDistance"), 1e-6);
  EXPECT_NEAR(summary("EnergyStructures"), energy + summary("Mass") * 9.81 * drop, 1e-6 * energy);
}

/// A net that meets a part of the rock lets it go on: the run says so, as nothing stops it.
TEST_F(TestStructures, ANetThatIsTooShortIsTold)
{
  this->Rocks->SetVelocity(10.0, 0.0, 5.0);
  this->Simulation->SetEndTime(20.0);
  const auto told = [this]
  {
    const auto* notes =
      vtkStringArray::SafeDownCast(this->Summary()->GetFieldData()->GetAbstractArray("Notes"));
    int count = 0;
    for (vtkIdType k = 0; notes && k < notes->GetNumberOfValues(); ++k)
    {
      count += notes->GetValue(k).find("1 of 1 rocks struck a barrier with a part only") == 0;
    }
    return count;
  };
  const double y = this->Output(4)->GetPoint(0)[1];
  EXPECT_EQ(told(), 0); // held
  this->Terrain->SetBarrierFile(
    this
      ->WriteFile("short.csv",
        "WKT,height,capacity\n\"LINESTRING(60 1,60 " + std::to_string(y - 0.1) + ")\",30,1000\n")
      .c_str());
  ASSERT_EQ(this->Output(4)->GetNumberOfPoints(), 1);
  EXPECT_EQ(value(this->Output(4)->GetPointData(), "Outcome"), 5.0);
  EXPECT_EQ(told(), 1);
}

TEST_F(TestStructures, NetsThatWearAreNewForRocksThatFallAlone)
{
  this->Terrain->SetBarrierFile(
    this->WriteFile("worn.csv", "WKT,height,fill\n\"LINESTRING(60 1,60 99)\",5,2\n").c_str());
  this->Simulation->SetEndTime(0.1);
  const auto told = [this]
  {
    this->Heard->Notes.clear();
    this->Output(4);
    return std::count_if(this->Heard->Notes.begin(), this->Heard->Notes.end(),
      [](const std::string& note)
      { return note.find("residual or fill are new for each") != std::string::npos; });
  };
  EXPECT_EQ(told(), 1);
  this->Simulation->SetRockRockContact(true);
  EXPECT_EQ(told(), 0);
}

TEST_F(TestStructures, ABadLayerIsOneError)
{
  const std::string name = this->WriteFile(
    "bad.csv", "WKT,height,width,slope\n\"LINESTRING(200 20,200 80)\",\"3,5\",1,1\n");
  this->Terrain->SetEmbankmentFile(name.c_str());
  this->Terrain->Update();
  this->ExpectOneError({ name, "row 1", "height", "3,5" });
}
