// What a filter writes of a run, from trajectories made by hand: every number in its array.

#include "helpers.h"
#include "shared/arrays.h"
#include "shared/inputContent.h"
#include "simulation/motion.h"
#include "simulation/progressText.h"
#include "simulation/runNotes.h"
#include "simulation/runSink.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <cmath>
#include <limits>

using namespace rockfall;

namespace
{

constexpr double mass = 2000.0;       // kg
constexpr double frameGravity = 10.0; // m/s²

Sample sampleOf(double time, double height, double taken)
{
  Sample sample;
  sample.time = time;
  sample.position = Vec3(1.0, 2.0, height);
  sample.kineticEnergy = 7.0;
  // Each term another multiple, so that none can stand for another.
  sample.energy = EnergyAudit{ .released = 50.0 * taken,
    .kinetic = 7.0,
    .strain = taken,
    .friction = 2.0 * taken,
    .restitution = 3.0 * taken,
    .vibration = 4.0 * taken,
    .damping = 5.0 * taken,
    .numerical = -6.0 * taken };
  return sample;
}

Trajectory fall()
{
  Trajectory trajectory;
  trajectory.summary.mass = mass;
  trajectory.samples = { sampleOf(0.0, 30.0, 0.0), sampleOf(1.0, 20.0, 100.0) };
  return trajectory;
}

filters::RunFrame frameOf(int rocks)
{
  filters::RunFrame frame;
  frame.rocks.resize(std::size_t(rocks));
  frame.shapes.resize(std::size_t(rocks), Shape::Cube);
  frame.sourceIds.resize(std::size_t(rocks), 1);
  frame.sourceNames.resize(std::size_t(rocks));
  frame.origin = Vec3(500000.0, 4000000.0, 0.0);
  frame.gravity = frameGravity;
  return frame;
}

} // namespace

TEST(RunOutputs, RangesAreRememberedAsVtkHasThem)
{
  vtkNew<vtkDoubleArray> array, other;
  array->SetNumberOfComponents(3);
  for (int k = 0; k < 300; ++k)
  {
    array->InsertNextValue(std::sin(7.0 * k) - 0.2);
  }
  other->DeepCopy(array);
  filters::rememberRanges(array.Get());
  array->SetValue(0, 100.0); // without telling: what is remembered is given
  for (int component : { -1, 0, 1, 2 })
  {
    const double* asked = other->GetRange(component);
    const double range[2] = { asked[0], asked[1] };
    EXPECT_EQ(array->GetRange(component)[0], range[0]);
    EXPECT_EQ(array->GetRange(component)[1], range[1]);
    EXPECT_EQ(array->GetFiniteRange(component)[0], other->GetFiniteRange(component)[0]);
    EXPECT_EQ(array->GetFiniteRange(component)[1], other->GetFiniteRange(component)[1]);
  }
  array->Modified();
  EXPECT_EQ(array->GetRange(0)[1], 100.0);
  array->SetValue(3, std::numeric_limits<double>::infinity());
  array->Modified();
  filters::rememberRanges(array.Get());
  EXPECT_EQ(array->GetFiniteRange(0)[1], 100.0);
  EXPECT_GT(array->GetRange(0)[1], 100.0);
}

TEST(RunOutputs, TrajectoriesAreHandedOnWithTheirRanges)
{
  const Trajectory trajectory = fall();
  const filters::RunFrame frame = frameOf(1);
  filters::TrajectoryLines writer(frame, false);
  writer.append(trajectory);
  vtkNew<vtkPolyData> part, whole;
  writer.copy(part);
  writer.finish(whole);
  for (vtkPolyData* lines : { part.Get(), whole.Get() })
  {
    for (vtkDataArray* array : { lines->GetPointData()->GetArray("Time"),
           lines->GetCellData()->GetArray("Volume"), lines->GetPoints()->GetData() })
    {
      ASSERT_TRUE(array && array->HasInformation());
      EXPECT_TRUE(array->GetInformation()->Has(vtkAbstractArray::PER_COMPONENT()));
    }
  }
}

TEST(RunOutputs, TrajectoriesHaveEveryTermOfTheEnergy)
{
  const Trajectory trajectory = fall();
  const filters::RunFrame frame = frameOf(1);
  vtkNew<vtkPolyData> lines;
  filters::TrajectoryLines writer(frame, true);
  writer.append(trajectory);
  writer.finish(lines);
  vtkFieldData* data = lines->GetPointData();
  ASSERT_EQ(lines->GetNumberOfPoints(), 2);
  const struct
  {
    const char* name;
    double first, last; // J
  } expected[] = {
    { "PotentialEnergy", mass * frameGravity * 30.0, mass * frameGravity * 20.0 },
    { "KineticEnergy", 7.0, 7.0 },
    { "StrainEnergy", 0.0, 100.0 },
    { "FrictionLoss", 0.0, 200.0 },
    { "RestitutionLoss", 0.0, 300.0 },
    { "VibrationLoss", 0.0, 400.0 },
    { "DampingLoss", 0.0, 500.0 },
    { "NumericalLoss", 0.0, -600.0 },
  };
  for (const auto& [name, first, last] : expected)
  {
    EXPECT_EQ(value(data, name, 0), first) << name;
    EXPECT_EQ(value(data, name, 1), last) << name;
  }
}

TEST(RunOutputs, EnergyBetweenSamplesIsInterpolated)
{
  const Sample between = filters::sampleAt(fall(), 0.25);
  EXPECT_DOUBLE_EQ(between.energy.released, 0.25 * 5000.0);
  EXPECT_DOUBLE_EQ(between.energy.kinetic, 7.0);
  EXPECT_DOUBLE_EQ(between.energy.strain, 0.25 * 100.0);
  EXPECT_DOUBLE_EQ(between.energy.friction, 0.25 * 200.0);
  EXPECT_DOUBLE_EQ(between.energy.restitution, 0.25 * 300.0);
  EXPECT_DOUBLE_EQ(between.energy.vibration, 0.25 * 400.0);
  EXPECT_DOUBLE_EQ(between.energy.damping, 0.25 * 500.0);
  EXPECT_DOUBLE_EQ(between.energy.numerical, -0.25 * 600.0);
}

TEST(RunOutputs, OneSampleIsAVertexAndNoneIsNothing)
{
  const filters::RunFrame frame = frameOf(3);
  filters::TrajectoryLines writer(frame, false);
  for (int rock = 0; rock < 3; ++rock)
  {
    Trajectory trajectory = fall();
    trajectory.summary.rock = rock;
    thin(trajectory, rock == 1 ? Retention::Nothing : Retention::StoppingPoints);
    writer.append(trajectory);
  }
  vtkNew<vtkPolyData> points;
  writer.finish(points);
  ASSERT_EQ(points->GetNumberOfVerts(), 2);
  EXPECT_EQ(points->GetNumberOfCells(), 2);
  EXPECT_EQ(value(points->GetCellData(), "RockId", 1), 2);
  EXPECT_EQ(points->GetPoint(1)[2], 20.0);
  EXPECT_EQ(points->GetPoint(1)[0], 500001.0);
  // The audit is of full trajectories only.
  EXPECT_FALSE(points->GetPointData()->HasArray("FrictionLoss"));
}

TEST(RunOutputs, TheIterationThatIsShownIsKeptWhole)
{
  const filters::RunFrame frame = frameOf(1);
  const filters::KeptParts parts{ Retention::StoppingPoints, true, 1 };
  filters::RunSink sink(frame, parts);
  for (int iteration = 0; iteration < 3; ++iteration)
  {
    Trajectory trajectory = fall();
    trajectory.summary.iteration = iteration;
    trajectory.impacts.resize(4);
    thin(trajectory, sink.kept(iteration).samples);
    sink.consume(std::move(trajectory));
  }
  filters::RunData data;
  sink.finish(data);
  EXPECT_EQ(data.trajectories->GetNumberOfVerts(), 3);
  EXPECT_EQ(data.trajectories->GetNumberOfLines(), 0);
  EXPECT_EQ(data.impacts->GetNumberOfCells(), 12);
  EXPECT_EQ(data.summary->GetNumberOfRows(), 3);
  ASSERT_EQ(sink.whole().size(), 1u);
  EXPECT_EQ(sink.whole()[0].samples.size(), 2u);
  EXPECT_EQ(sink.whole()[0].summary.iteration, 1);
}

TEST(RunOutputs, RocksWhoseBooksDoNotCloseAreToldOf)
{
  // A stone of 0.7 g and its books, J: as they are, then with energy from nowhere, a piece and its
  // rock, one that only lies there, and what the numerics took.
  struct Case
  {
    double released, gained, numerical;
    int piece;
    bool gains, loses;
  };
  const Case cases[] = { { 5e-3, 0.0, 0.0, 0, false, false }, { 5e-3, 2.0, 0.0, 0, true, false },
    { 5e-3, 4e-4, 0.0, 0, true, false }, { 5e-3, 4e-4, 0.0, 1, false, false },
    { 5e-3, 1e-4, 0.0, 0, false, false }, { 5e-3, 4e-4, 0.0, 1, true, false },
    { 1e-12, 1e-9, 0.0, 0, false, false }, { 5e-3, 0.0, 1e-3, 0, false, true },
    { 5e-3, 0.0, 1e-3, 1, false, false }, { 5e-3, 0.0, 2e-4, 0, false, false } };
  const filters::RunFrame frame = frameOf(1);
  filters::RunSink sink(frame, filters::KeptParts());
  for (const Case& of : cases)
  {
    const filters::UnclosedBooks before = sink.unclosed();
    Trajectory trajectory = fall();
    TrajectorySummary& summary = trajectory.summary;
    summary.mass = 7e-4;
    summary.volume = 2.6e-7;
    summary.piece = of.piece;
    summary.energy.released = of.released;
    summary.gained = of.gained;
    summary.energy.numerical = of.numerical;
    sink.consume(std::move(trajectory));
    EXPECT_EQ(sink.unclosed().gained.rocks - before.gained.rocks, of.gains ? 1 : 0) << of.gained;
    EXPECT_EQ(sink.unclosed().lost.rocks - before.lost.rocks, of.loses ? 1 : 0) << of.numerical;
  }
  EXPECT_EQ(sink.unclosed().rocks, 7);
  const std::vector<std::string> notes = filters::unclosedNotes(sink.unclosed());
  EXPECT_EQ(notes.size(), 2u);
  filters::RunData data;
  sink.finish(data);
  EXPECT_EQ(filters::doubtsOfRun(data.trajectories->GetFieldData()), notes); // for maps and lines
  EXPECT_TRUE(filters::unclosedNotes({}).empty());
}

TEST(ProgressText, LinesComeWhenTheCountMovesAndEverMoreRarely)
{
  EXPECT_FALSE(filters::lineIsDue(100.0, 0.0, 0, 0)) << "nothing is done";
  EXPECT_FALSE(filters::lineIsDue(9.0, 0.0, 5, 0)) << "10 s have not gone";
  EXPECT_TRUE(filters::lineIsDue(10.0, 0.0, 5, 0));
  EXPECT_FALSE(filters::lineIsDue(140.0, 100.0, 9, 5));
  EXPECT_TRUE(filters::lineIsDue(150.0, 100.0, 9, 5));
  int lines = 0;
  double last = 0.0;
  for (int s = 0; s < 24 * 3600; ++s) // a trajectory a second
  {
    if (filters::lineIsDue(s, last, s, std::int64_t(last)))
    {
      last = s;
      ++lines;
    }
  }
  EXPECT_LE(lines, 25);
  EXPECT_GE(lines, 15);
}

TEST(ProgressText, SaysHowFarAndHowLong)
{
  EXPECT_EQ(filters::durationText(0.0), "0 s");
  EXPECT_EQ(filters::durationText(41.2), "42 s");
  EXPECT_EQ(filters::durationText(59.9), "1 min 00 s");
  EXPECT_EQ(filters::durationText(200.0), "3 min 20 s");
  EXPECT_EQ(filters::durationText(3599.5), "1 h 00 min");
  EXPECT_EQ(filters::durationText(7500.0), "2 h 05 min");
  EXPECT_EQ(filters::progressText(0.25, 100000, "trajectories", 60.0),
    "25,000 of 100,000 trajectories (25 %), about 3 min 00 s left");
  EXPECT_EQ(filters::progressText(1.0, 12, "trajectories", 60.0),
    "12 of 12 trajectories (100 %), about 0 s left");
  // Too early to tell.
  EXPECT_EQ(
    filters::progressText(0.0, 1234567, "trajectories", 5.0), "0 of 1,234,567 trajectories (0 %)");
  EXPECT_EQ(filters::progressText(0.5, 10, "trajectories", 0.1), "5 of 10 trajectories (50 %)");
  // Every share of so many is exact but for rounding; within one nothing is done yet.
  for (int k = 0; k <= 49; ++k)
  {
    EXPECT_EQ(
      filters::progressText(k / 49.0, 49, "trajectories", 0.1).find(std::to_string(k) + " of 49"),
      0u);
  }
  EXPECT_EQ(filters::progressText(0.9, 1, "iterations", 0.1), "0 of 1 iterations (90 %)");
}
