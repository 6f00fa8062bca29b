// What a filter writes of a run, from trajectories made by hand: every number in its array.

#include "helpers.h"
#include "motion.h"
#include "runOutputs.h"

#include "vtkPointData.h"
#include "vtkPolyData.h"

using namespace rockfall;

namespace
{

constexpr double mass = 2000.0;  // kg
constexpr double gravity = 10.0; // m/s²

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

} // namespace

TEST(RunOutputs, TrajectoriesHaveEveryTermOfTheEnergy)
{
  const Trajectory trajectory = fall();
  filters::FinishedRun run;
  run.rocks.resize(1);
  run.trajectories = std::span(&trajectory, 1);
  run.origin = Vec3(500000.0, 4000000.0, 0.0);
  run.gravity = gravity;
  vtkNew<vtkPolyData> lines;
  filters::writeTrajectories(run, lines);
  vtkFieldData* data = lines->GetPointData();
  ASSERT_EQ(lines->GetNumberOfPoints(), 2);
  const struct
  {
    const char* name;
    double first, last; // J
  } expected[] = {
    { "PotentialEnergy", mass * gravity * 30.0, mass * gravity * 20.0 },
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
