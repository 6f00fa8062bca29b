// What has no effect is not passed over in silence: notes on properties, errors of columns. Notes go on
// with the data.

#include "simulationTest.h"

#include "shared/errorReport.h"
#include "terrain/presets.h"

#include "vtkAppendPolyData.h"
#include "vtkDispersionAngle.h"
#include "vtkDrawnStructure.h"
#include "vtkJointedRockMass.h"
#include "vtkTrajectoryCollector.h"

#include <algorithm>
#include <functional>

namespace
{

using Source = vtkRockBlockSource;

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

  /// What the rocks' notes say once `change` is made.
  void ExpectNotes(
    const std::function<void(vtkRockBlockSource*)>& change, const std::vector<std::string>& texts)
  {
    vtkNew<vtkRockBlockSource> rocks;
    rocks->SetInputConnection(1, this->Terrain->GetOutputPort());
    change(rocks);
    rocks->Update();
    EXPECT_GT(rocks->GetOutput()->GetNumberOfCells(), 0);
    std::vector<std::string> notes = rockfall::filters::notesOf(rocks->GetOutput()->GetFieldData());
    std::erase_if(
      notes, [](const std::string& note) { return note.find("bare rock") != std::string::npos; });
    EXPECT_EQ(notes, texts);
  }

  /// Notes of the table of a run, but that on bare rock.
  std::vector<std::string> NotesOfRun()
  {
    std::vector<std::string> notes = rockfall::filters::notesOf(this->Summary()->GetFieldData());
    std::erase_if(
      notes, [](const std::string& note) { return note.find("bare rock") != std::string::npos; });
    return notes;
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

TEST_F(TestUnusedInputs, NothingIsToldOfWhatNobodySet)
{
  rockfall::filters::IdleProperties idle;
  idle.add("A", 2.0, 2.0, "why");
  idle.addTo("Cause", "B", 3, 3);
  EXPECT_TRUE(idle.notes().empty());
  idle.add("A", 2.5, 2.0, "it is late", " m");
  idle.addTo("Cause", "B", 4, 3);
  idle.add("C", true, false, "it is on");
  idle.addTo("Cause", "D", std::string("d"), std::string());
  EXPECT_EQ(idle.notes(),
    std::vector<std::string>({ "A is 2.5 m, but has no effect: it is late", "Cause: B, D",
      "C is on, but has no effect: it is on" }));
  this->ExpectNotes([](vtkRockBlockSource*) {}, {});
  this->ExpectNotes(
    [](vtkRockBlockSource* rocks) { rocks->SetDraw(vtkRockBlockSource::LINE); }, {});
}

TEST_F(TestUnusedInputs, ShapesAndVolumes)
{
  const std::string lengths =
    "Lengths is 1, 2, 3 m, but has no effect: only a box or an ellipsoid has lengths";
  const auto long_ = [](Source* rocks) { rocks->SetLengths(1.0, 2.0, 3.0); };
  this->ExpectNotes(long_, { lengths });
  for (const int shape : { Source::BOX, Source::ELLIPSOID })
  {
    this->ExpectNotes(
      [&](Source* rocks)
      {
        long_(rocks);
        rocks->SetShape(shape);
      },
      {});
  }
  this->ExpectNotes(
    [&](Source* rocks)
    {
      long_(rocks);
      rocks->SetShape(Source::SPHERE);
      rocks->SetShapeMix("cube:1;box:1");
    },
    { "Shape is \"sphere\", but has no effect: ShapeMix names the shapes" });
  this->ExpectNotes([](Source* rocks) { rocks->SetShapeFileName("rock.stl"); },
    { "ShapeFileName is \"rock.stl\", but has no effect: no block's shape is \"file\"" });

  const auto bounds = [](const char* name, const char* value)
  {
    return std::string("Volume") + name + " is " + value +
      " m³, but has no effect: only a VolumeLaw that draws, and PowerLawFrequency, have bounds";
  };
  const auto bound = [](Source* rocks)
  {
    rocks->SetVolumeMinimum(0.2);
    rocks->SetVolumeMaximum(5.0);
  };
  this->ExpectNotes(bound, { bounds("Minimum", "0.2"), bounds("Maximum", "5") });
  this->ExpectNotes(
    [&](Source* rocks)
    {
      bound(rocks);
      rocks->SetVolumeExponent(0.6);
      rocks->SetPowerLawFrequency(1.0);
    },
    {});
  this->ExpectNotes(
    [&](Source* rocks)
    {
      bound(rocks);
      rocks->SetVolumeLaw(Source::UNIFORM);
      rocks->SetVolume(3.0);
      rocks->SetVolumeDeviation(0.1);
      rocks->SetVolumeExponent(0.6);
    },
    { "Volume is 3 m³, but has no effect: the volumes of all sources are their own, of a law "
      "without "
      "a mean, or by Lengths",
      "VolumeDeviation is 0.1 m³, but has no effect: only the normal and the log-normal VolumeLaw "
      "have one",
      "VolumeExponent is 0.6, but has no effect: only the VolumeLaw Power law, and "
      "PowerLawFrequency, have one" });
  this->ExpectNotes([](Source* rocks) { rocks->SetRedrawVolume(true); },
    { "RedrawVolume is on, but has no effect: VolumeLaw is Fixed: nothing is drawn" });
}

TEST_F(TestUnusedInputs, AttitudesMaterialsAndPlaces)
{
  this->ExpectNotes([](Source* rocks) { rocks->SetAttitudeDeviation(20.0); },
    { "AttitudeDeviation is 20 degrees, but has no effect: only the AttitudeLaw Deviating has "
      "one" });
  this->ExpectNotes(
    [](Source* rocks)
    {
      rocks->SetAttitudeDeviation(20.0);
      rocks->SetAttitudeLaw(Source::DEVIATING);
    },
    {});
  this->ExpectNotes(
    [](Source* rocks)
    {
      rocks->SetOrientation(0.0, 0.0, 30.0);
      rocks->SetRandomOrientation(true);
    },
    { "Orientation is 0, 0, 30 degrees, but has no effect: RandomOrientation is on" });
  this->ExpectNotes(
    [](Source* rocks)
    {
      rocks->SetMaterial(1);
      rocks->SetDensity(2400.0);
      rocks->SetPoissonRatio(0.3);
    },
    { "The Material replaces what these properties say: Density, PoissonRatio" });
  this->ExpectNotes(
    [](Source* rocks)
    {
      rocks->SetDraw(Source::LINE);
      rocks->SetIntensity(0.5);
      rocks->SetCenter(20.0, 50.0, 50.0);
    },
    { "The source is drawn, so that these have no effect: Center" });
  this->ExpectNotes(
    [](Source* rocks)
    {
      rocks->AddPoint(20.0, 30.0, 0.0);
      rocks->AddPoint(20.0, 60.0, 0.0);
    },
    { "Draw is Nothing, so that these have no effect: Points" });
  const std::string whole = this->WriteFile(
    "whole.csv", "x,y,z,density,volume,amount\n5,50,58,2600,2,1\n5,60,58,2700,1,1\n");
  this->ExpectNotes(
    [&](Source* rocks)
    {
      rocks->SetFileName(whole.c_str());
      rocks->SetDensity(2400.0);
      rocks->SetVolume(3.0);
      rocks->SetCenter(30.0, 50.0, 50.0);
    },
    { "FileName has the sources, so that these have no effect: Center",
      "Volume is 3 m³, but has no effect: the volumes of all sources are their own, of a law "
      "without "
      "a mean, or by Lengths",
      "All rows of FileName have their own of what these properties say: Density" });
}

/// Before anybody draws, the window puts points and centre where the line or the block is.
TEST_F(TestUnusedInputs, PlacesOfTheWindowAreNotTold)
{
  vtkNew<vtkRockBlockSource> first;
  first->SetInputConnection(1, this->Terrain->GetOutputPort());
  first->SetDraw(vtkRockBlockSource::LINE);
  first->Update();
  const double* line = first->GetPlacedLine();
  const auto cm = [](double x) { return std::round(100.0 * x) / 100.0; };
  const std::string file = this->WriteFile("one.csv", "x,y\n5,50\n");
  for (const bool moved : { false, true })
  {
    const double by = moved ? 20.0 : 0.0;
    const std::vector<std::string> told = { "FileName has the sources, so that these have no "
                                            "effect: Points, Center" };
    this->ExpectNotes(
      [&](vtkRockBlockSource* rocks)
      {
        rocks->AddPoint(cm(line[0]) + by, cm(line[1]), cm(line[2]));
        rocks->AddPoint(cm(line[3]) + by, cm(line[4]), cm(line[5]));
        rocks->SetCenter(0.5 * (line[0] + line[3]) + by, 0.5 * (line[1] + line[4]), 58.0);
        rocks->SetFileName(file.c_str());
      },
      moved ? told : std::vector<std::string>());
  }
}

TEST_F(TestUnusedInputs, PropertiesOfAMass)
{
  vtkNew<vtkJointedRockMass> mass;
  mass->SetMassFileName("mass.stl");
  mass->Update();
  this->ExpectNote({ "MassFileName is \"mass.stl\"", "no effect", "MassShape is 0 (box)" });
  mass->SetMassFileName(
    this->WriteFile("mass.csv", "0,0,60\n3,0,60\n0,3,60\n3,3,60\n0,0,63\n3,0,63\n0,3,63\n3,3,63\n")
      .c_str());
  mass->SetMassShape(vtkJointedRockMass::FROM_FILE);
  mass->SetLengths(4.0, 3.0, 3.0);
  mass->SetCenter(10.0, 50.0, 50.0);
  mass->SetMaterial(1);
  mass->SetYoungModulus(2e10);
  mass->Update();
  ASSERT_EQ(mass->GetOutput()->GetNumberOfCells(), 27 * 6);
  const std::vector<std::string> notes =
    rockfall::filters::notesOf(mass->GetOutput()->GetFieldData());
  EXPECT_EQ(notes,
    std::vector<std::string>(
      { "MassShape is 1 (from file), where these have no effect: Center, Lengths",
        "The Material replaces what these properties say: YoungModulus" }));
  EXPECT_EQ(this->Heard->Notes.size(), notes.size());
}

TEST_F(TestUnusedInputs, PropertiesOfGround)
{
  using Slope = vtkDEMToCFESource;
  const auto expect =
    [](const std::function<void(Slope*)>& change, const std::vector<std::string>& texts)
  {
    vtkNew<Slope> slope;
    change(slope);
    slope->Update();
    std::vector<std::string> notes = rockfall::filters::notesOf(slope->GetOutput()->GetFieldData());
    std::erase_if(notes,
      [](const std::string& note)
      {
        return note.find("bare rock") != std::string::npos ||
          note.starts_with("The preset "); // where it errs
      });
    EXPECT_EQ(notes, texts);
  };
  expect([](Slope*) {}, {});
  expect(
    [](Slope* slope)
    {
      slope->SetTangentialRestitution(0.9);
      slope->SetRestitutionSpeed(5.0);
      slope->SetScarCompaction(1.0);
      slope->SetScarRadius(0.6);
      slope->SetSlipFrictionGrowth(3.0);
      slope->SetGroundDeviation(0.1);
      slope->SetTreesBreak(0);
      slope->SetBand(2);
      slope->SetAllowReferences(1);
    },
    { "RestitutionModel Whole velocity does not take: TangentialRestitution",
      "Only RestitutionModel Speed-dependent takes: RestitutionSpeed",
      "GroundModulus is 0, without which these have no effect: ScarRadius, ScarCompaction",
      "SlipFrictionMax is 0, without which these have no effect: SlipFrictionGrowth",
      "GroundModulus and SlipFrictionMax are 0, without which these have no effect: "
      "GroundDeviation",
      "Band is 2, but has no effect: there is no FileName",
      "TreesBreak is off, but has no effect: there is no TreeFile",
      "AllowReferences is on, but has no effect: there is no file" });
  expect(
    [](Slope* slope)
    {
      slope->SetRestitutionModel(Slope::SPEED_DEPENDENT);
      slope->SetTangentialRestitution(0.9);
      slope->SetRestitutionSpeed(5.0);
      slope->SetGroundModulus(10.0);
      slope->SetScarCompaction(1.0);
      slope->SetSlipFrictionMax(2.0);
      slope->SetSlipFrictionGrowth(3.0);
      slope->SetGroundDeviation(0.1);
      slope->SetGroundDeviationLength(20.0);
    },
    {});
  expect(
    [](Slope* slope)
    {
      slope->SetRestitutionDeviation(0.0);
      slope->SetDeviationPer(Slope::PER_IMPACT);
      slope->SetRoughnessDeviation(0.0);
      slope->SetRoughnessLength(3.0);
    },
    { "RestitutionDeviation and FrictionAngleDeviation are 0, without which these have no effect: "
      "DeviationPer",
      "RoughnessDeviation and the obstacle heights are 0, without which these have no effect: "
      "RoughnessLength" });
  // Of the file's two kinds each has its own.
  const std::string grid = this->WriteFile("grid.asc",
    "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n30 30 30\n20 20 20\n10 10 10\n");
  expect(
    [&](Slope* slope)
    {
      slope->SetFileName(grid.c_str());
      slope->SetRelaxFlats(0);
      slope->SetElevationField("height");
    },
    { "The file has no CRS; its coordinates were taken as metres.",
      "RelaxFlats is off, but has no effect: FileName is a raster, not contour lines",
      "ElevationField is \"height\", but has no effect: FileName is a raster, not contour lines" });
  vtkNew<Slope> contours;
  contours->SetFileName(this
                          ->WriteFile("contours.csv",
                            "WKT,elev\n\"LINESTRING(0 0,100 0)\",30\n\"LINESTRING(0 50,100 "
                            "50)\",20\n\"LINESTRING(0 100,100 100)\",10\n")
                          .c_str());
  contours->SetBand(2);
  contours->SetRelaxFlats(0);
  contours->SetElevationField("elev");
  contours->Update();
  std::vector<std::string> idle = rockfall::filters::notesOf(contours->GetOutput()->GetFieldData());
  std::erase_if(
    idle, [](const std::string& note) { return note.find("no effect") == std::string::npos; });
  EXPECT_EQ(idle,
    std::vector<std::string>(
      { "Band is 2, but has no effect: FileName has contour lines, not bands" }));
  // What a preset replaces; a window fills its numbers into the panel.
  for (int preset = 1; preset <= 7; ++preset)
  {
    const auto values = rockfall::presetValues(preset);
    const auto numberOf = [&](const std::string& name)
    { return std::ranges::find(values, name, &std::pair<std::string, double>::first)->second; };
    for (const bool other : { false, true })
    {
      const auto replaced = [&](Slope* slope)
      {
        slope->SetPreset(preset);
        const int model = int(numberOf("RestitutionModel"));
        slope->SetRestitutionModel(other ? 3 - model : model);
        slope->SetDeviationPer(other ? Slope::PER_PLACE : int(numberOf("DeviationPer")));
        slope->SetFrictionAngle(numberOf("FrictionAngle") + (other ? 1.0 : 0.0));
        slope->SetRestitutionSpeed(numberOf("RestitutionSpeed"));
        slope->SetGroundModulus(numberOf("GroundModulus"));
        slope->SetRoughnessLength(numberOf("RoughnessLength"));
        slope->SetScarCompaction(numberOf("ScarCompaction"));
      };
      expect(replaced,
        other ? std::vector<std::string>({ "The Preset replaces what these properties say: "
                                           "RestitutionModel, FrictionAngle, DeviationPer" })
              : std::vector<std::string>());
    }
  }
}

TEST_F(TestUnusedInputs, PropertiesOfADrawnStructure)
{
  vtkNew<vtkDrawnStructure> drawn;
  drawn->SetInputConnection(this->Terrain->GetOutputPort());
  this->Terrain->Update();
  this->Heard->Notes.clear();
  drawn->SetCrestWidth(3.0);
  drawn->SetResidual(40.0);
  drawn->Update();
  const std::vector<std::string> own = {
    "The Kind is net, which these properties say nothing of: CrestWidth",
    "Residual is 40 %, but has no effect: Wears is off"
  };
  const auto notes = [](vtkAlgorithm* of)
  { return rockfall::filters::notesOf(of->GetOutputDataObject(0)->GetFieldData()); };
  std::vector<std::string> all = notes(this->Terrain);
  ASSERT_EQ(all.size(), 1u) << "bare rock";
  all.insert(all.end(), own.begin(), own.end());
  EXPECT_EQ(notes(drawn), all);
  EXPECT_EQ(notes(this->Terrain).size(), 1u) << "the slope's own";
  EXPECT_EQ(this->Heard->Notes.size(), 2u);
  drawn->SetKind(vtkDrawnStructure::FOREST);
  drawn->AddPoint(40.0, 20.0, 0.0);
  drawn->AddPoint(40.0, 60.0, 0.0);
  drawn->AddPoint(60.0, 40.0, 0.0);
  drawn->SetWears(true);
  drawn->SetTreeHeight(15.0);
  drawn->Update();
  EXPECT_EQ(notes(drawn).back(),
    "The Kind is forest, which these properties say nothing of: CrestWidth, Wears, Residual");
  drawn->SetKind(vtkDrawnStructure::NET);
  drawn->SetTreesBreak(false);
  drawn->Update();
  EXPECT_EQ(notes(drawn).back(),
    "The Kind is net, which these properties say nothing of: TreeHeight, TreesBreak, CrestWidth");
}

TEST_F(TestUnusedInputs, PropertiesOfARunAndOfWhatIsMadeOfIt)
{
  this->Simulation->SetEndTime(0.05);
  EXPECT_EQ(std::ranges::count_if(this->NotesOfRun(),
              [](const std::string& note) { return note.find("no effect") != std::string::npos; }),
    0);
  this->Simulation->SetFractalDimension(2.5);
  this->Simulation->SetFragmentSpread(10.0);
  this->Simulation->SetRockFrictionAngle(35.0);
  this->Simulation->SetRockContactFile("pairs.csv");
  this->Heard->Notes.clear();
  const std::string contact = "RockRockContact is off, without which these have no effect: ";
  const std::string fragments =
    "Fragmentation is off, without which these have no effect: FractalDimension, FragmentSpread";
  std::vector<std::string> notes = this->NotesOfRun();
  const auto has = [&](const std::string& note) { return std::ranges::count(notes, note) == 1; };
  EXPECT_TRUE(has(contact + "RockContactFile, RockFrictionAngle"));
  EXPECT_TRUE(has(fragments));
  EXPECT_EQ(std::ranges::count(this->Heard->Notes, fragments + "\n"), 1);
  // Told again without another run.
  const int runs = this->Simulation->GetNumberOfRuns();
  this->Simulation->SetAllowReferences(1);
  notes = this->NotesOfRun();
  EXPECT_TRUE(has(contact + "RockContactFile, RockFrictionAngle, AllowReferences"));
  EXPECT_FALSE(has(contact + "RockContactFile, RockFrictionAngle"));
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), runs);
  this->Simulation->SetRockContactFile("");
  this->Simulation->SetRockContactSheet("pairs");
  this->Simulation->SetRockRockContact(true);
  notes = this->NotesOfRun();
  EXPECT_TRUE(has("RockContactSheet is \"pairs\", but has no effect: there is no RockContactFile"));
  EXPECT_TRUE(has("AllowReferences is on, but has no effect: there is no RockContactFile"));

  vtkNew<vtkTrajectoryCollector> line;
  line->SetInputConnection(this->Simulation->GetOutputPort(1));
  line->AddPoint(20.0, 1.0, 0.0);
  line->AddPoint(20.0, 99.0, 0.0);
  line->SetParallelSpacing(20.0);
  line->SetAllowReferences(1);
  line->Update();
  notes = rockfall::filters::notesOf(line->GetOutputDataObject(1)->GetFieldData());
  EXPECT_TRUE(has("ParallelSpacing is 20 m, but has no effect: ParallelLines is 0"));
  EXPECT_TRUE(has("AllowReferences is on, but has no effect: there is no FileName"));
  line->ClearPoints();
  line->SetParallelLines(1);
  line->SetBarrierHeight(3.0);
  line->SetBarrierCapacity(500.0);
  line->SetFileName(
    this->WriteFile("line.csv", "WKT,height\n\"LINESTRING(20 1,20 99)\",2\n").c_str());
  line->Update();
  notes = rockfall::filters::notesOf(line->GetOutputDataObject(1)->GetFieldData());
  EXPECT_TRUE(
    has("All lines of FileName have their own of what these properties say: BarrierHeight"));
  EXPECT_EQ(std::ranges::count_if(notes,
              [](const std::string& note) { return note.find("effect") != std::string::npos; }),
    0);

  vtkNew<vtkDispersionAngle> angle;
  angle->SetInputConnection(this->Simulation->GetOutputPort(1));
  angle->SetDirection(0.0, 1.0, 0.0);
  angle->AddClassLimit(1.0);
  angle->SetUseGroups(false);
  angle->Update();
  notes = rockfall::filters::notesOf(angle->GetOutputDataObject(0)->GetFieldData());
  EXPECT_TRUE(has("Direction is 0, 1, 0, but has no effect: AutomaticDirection is on"));
  EXPECT_TRUE(has("UseGroups is off, without which these have no effect: ClassLimits"));
  angle->SetAutomaticDirection(false);
  angle->SetUseGroups(true);
  angle->SetGroupBy("Volume");
  angle->Update();
  notes = rockfall::filters::notesOf(angle->GetOutputDataObject(0)->GetFieldData());
  EXPECT_EQ(std::ranges::count_if(notes,
              [](const std::string& note) { return note.find("effect") != std::string::npos; }),
    0);
}

TEST_F(TestUnusedInputs, NotesOfInputsGoOnToTheRun)
{
  this->Simulation->SetEndTime(0.05);
  this->Simulation->SetIterations(2);
  this->Rocks->SetLengths(1.0, 2.0, 3.0);
  this->Terrain->SetTreesBreak(0);
  this->Rocks->SetInputConnection(1, this->Terrain->GetOutputPort());
  const std::string trees = "TreesBreak is off, but has no effect: there is no TreeFile";
  const std::string lengths =
    "Lengths is 1, 2, 3 m, but has no effect: only a box or an ellipsoid has lengths";
  // The slope comes by itself, or with the rocks.
  for (const bool alone : { true, false })
  {
    if (!alone)
    {
      this->Simulation->SetInputConnection(0, nullptr);
    }
    const std::vector<std::string> notes = this->NotesOfRun();
    for (const std::string& note : { trees, lengths })
    {
      EXPECT_EQ(std::ranges::count(notes, note), 1) << note;
      EXPECT_EQ(std::ranges::count_if(this->Heard->Notes,
                  [&](const std::string& heard) { return heard.find(note) != std::string::npos; }),
        1)
        << "by its source alone";
    }
    EXPECT_EQ(
      std::ranges::count_if(notes,
        [](const std::string& note) { return note.starts_with("All 2 iterations are alike"); }),
      1);
  }
  // Rocks that are the same take the run over, with their own notes.
  const int runs = this->Simulation->GetNumberOfRuns();
  this->Rocks->SetLengths(1.0, 1.0, 1.0);
  EXPECT_EQ(std::ranges::count(this->NotesOfRun(), lengths), 0);
  EXPECT_EQ(std::ranges::count(this->NotesOfRun(), trees), 1);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), runs);
  // Kept, though not told.
  this->Heard->Notes.clear();
  this->Simulation->SetPrintNotes(false);
  this->Simulation->SetIterations(3);
  EXPECT_TRUE(std::ranges::any_of(this->NotesOfRun(),
    [](const std::string& note) { return note.starts_with("All 3 iterations are alike"); }));
  EXPECT_TRUE(this->Heard->Notes.empty());
}
