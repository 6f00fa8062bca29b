#pragma once

/// @file
/// Results of a run: samples, impact events and one summary per rock and iteration.
/// Positions are in the terrain's local frame.

#include "base/types.h"

#include <string>
#include <vector>

namespace rockfall
{

/// Losses of energy, J. Their sum is what the numerics kept; `numerical` is the remainder:
/// released = kinetic + strain + friction + restitution + vibration + damping + structures +
/// scars + rolling + breaking + exchanged + numerical. What two rocks exchange does not add up to
/// nothing: the rest is lost, or held, between them.
struct EnergyAudit
{
  double released = 0.0;    ///< Start's kinetic energy plus potential energy given up.
  double kinetic = 0.0;     ///< At the end of the time that is audited.
  double strain = 0.0;      ///< Block strain and contact springs, at the end.
  double friction = 0.0;    ///< Dissipated by sliding.
  double restitution = 0.0; ///< Taken by Rv.
  double vibration = 0.0;   ///< Strain energy left in a block when it took off.
  double damping = 0.0;     ///< Dissipated by the damped step of lasting contact.
  double structures = 0.0;  ///< Taken by barriers and by trees that broke.
  double scars = 0.0;       ///< Taken by ground that gives way.
  double rolling = 0.0;     ///< Taken by rolling resistance.
  double breaking = 0.0;    ///< Taken by the rock's breaking.
  double exchanged = 0.0;   ///< Given to other rocks by contact (−: received).
  double numerical = 0.0;   ///< Gained (−) or lost (+) by the numerics.
};

/// Why a sample is there.
enum class SampleKind : std::uint8_t
{
  Even,     ///< At a multiple of the output interval.
  Knot,     ///< A touch, a take-off, or a place where the motion changes.
  EvenKnot, ///< Both at one time.
  End,      ///< Where the rock rests, leaves or is cut off.
};

/// The state of a rock at one time (METHOD 8). The motion between two samples is the cubic Hermite
/// curve of their places and velocities: exact in flight, within 1 % of the rock's radius in
/// contact.
struct Sample
{
  SampleKind kind = SampleKind::Even;
  bool contact = false;                ///< Touching the slope.
  double time = 0.0;                   ///< s
  Quat orientation = Quat::Identity(); ///< Body to world.
  Vec3 position = Vec3::Zero();        ///< Centroid, m.
  Vec3 velocity = Vec3::Zero();        ///< Vx, Vy, Vz, m/s.
  Vec3 angularVelocity = Vec3::Zero(); ///< Ryz, Rzx, Rxy: about x, y, z, rad/s.
  double kineticEnergy = 0.0;          ///< Translation and rotation, J.
  double heightOverGround = 0.0;       ///< Least height of a vertex over the ground under it, m.
  /// From the release to this time; in contact to the end of the step in which it falls.
  EnergyAudit energy;
};

/// An impact: the rock came from flight, touched, and left or settled. Another rock may also
/// strike it through one that it touches.
struct ImpactEvent
{
  double time = 0.0;            ///< Of the first touch, s.
  Vec3 position = Vec3::Zero(); ///< Of the contact, m.
  Vec3 normal = Vec3::UnitZ();  ///< Of the slope there.
  std::int64_t cfe = 0;         ///< Number of the CFE with the largest force.
  double impulse = 0.0;         ///< Normal, N s.
  double approachSpeed = 0.0;   ///< Of the contact point along the normal, m/s.
  Vec3 velocityBefore = Vec3::Zero();
  Vec3 velocityAfter = Vec3::Zero();
  /// By friction, restitution, scar and rolling resistance, J. Between rocks < 0 where friction turns
  /// back and gives more than the normal takes, with what another impact of the moment loses.
  double energyLoss = 0.0;
  double restitution = 1.0; ///< The coefficient that was applied.
  double scarDepth = 0.0;   ///< Straight under the surface, m; 0: hard ground.
  double scarLength = 0.0;  ///< Along the surface, m.
  int otherRock = -1;       ///< Index of the rock that was hit, −1: the slope.
};

/// Fate of a structure that a rock met.
enum class StructureOutcome
{
  BarrierStopped = 0,  ///< Holds the rock.
  BarrierBroken = 1,   ///< The rock went through, and lost the barrier's capacity.
  BarrierRecorded = 2, ///< Only records; nothing happened to the rock.
  TreeBroken = 3,      ///< The rock broke it, and lost the share of its capacity of its offset.
  TreePassed = 4,      ///< The same, but the tree stands and has turned the rock.
  /// A part of the rock's outline met it, too little to be held, and nothing is taken of the rock.
  /// Of more energy than the barrier has left it breaks for the other rocks.
  BarrierStruck = 5,
  BarrierPassed = 6, ///< The rock went over it.
  BarrierGone = 7,   ///< The rock went where another one had broken it.
};

/// A rock at the line of a barrier, or at a tree that does not hold it. Trees that hold and embankments are slope:
/// their impacts are ImpactEvents.
struct StructureEvent
{
  StructureOutcome outcome = StructureOutcome::BarrierStopped;
  std::int64_t feature = 0;      ///< Number of the structure in its layer, from 1.
  double time = 0.0;             ///< s
  Vec3 position = Vec3::Zero();  ///< Of the rock's centre, m.
  Vec3 velocity = Vec3::Zero();  ///< Before, m/s.
  double kineticEnergy = 0.0;    ///< Translation and rotation, before, J.
  double heightOverGround = 0.0; ///< Of the rock's centre over the slope, m.
  double topHeight = 0.0;        ///< Of its highest point over the same ground, m.
  double energyTaken = 0.0;      ///< J
  double heldBefore = 0.0;       ///< By a barrier, of other rocks, J.
  double usefulHeight = 0.0;     ///< Of a barrier, from its fill to its rope, before, m.
  double brakingDistance = 0.0;  ///< Behind the line of the barrier that stopped it, m.
};

enum class Fate
{
  Rested = 0,     ///< The rock lies still on the slope.
  LeftDomain = 1, ///< Went beyond the slope's edge.
  Moving = 2,     ///< Still moving at the end time.
  Caught = 3,     ///< Stopped by a barrier.
  /// Fell where the slope has no data, but ground on two sides (HeightGrid::isHole).
  LostInNodata = 4,
  Broken = 5, ///< Broke in an impact: its pieces go on.
};
std::string fateName(Fate fate);

/// One row per rock and iteration, and per piece of a rock that broke.
struct TrajectorySummary
{
  int rock = 0;      ///< Index in the list of rocks.
  int iteration = 0; ///< From 0, or from the run's first one.
  int piece = 0;     ///< Of the rock in the iteration, from 1; 0: the rock as released.
  int pieces = 0;    ///< Pieces that the rock broke into and that are followed.
  std::int64_t blockId = 0;
  Fate fate = Fate::Moving;
  double endTime = 0.0; ///< When the rock rested, left or was cut off, s.
  Vec3 start = Vec3::Zero();
  Vec3 stop = Vec3::Zero();
  double runOut = 0.0;              ///< Horizontal distance from start to stop, m.
  double pathLength = 0.0;          ///< m
  double maxSpeed = 0.0;            ///< m/s
  double maxKineticEnergy = 0.0;    ///< J
  double maxHeightOverGround = 0.0; ///< m
  double mass = 0.0;                ///< kg
  double volume = 0.0;              ///< m³
  int impacts = 0;
  std::uint64_t impactBits = 0;  ///< Hashes of all impacts, summed: their order does not count.
  std::int64_t contactSteps = 0; ///< Steps solved in contact.
  std::int64_t openCloseIterations = 0;
  std::int64_t cutSteps = 0; ///< Steps redone with a smaller Δt.
  /// Steps taken although open–close had not settled, in an island: although rocks were deep in
  /// each other.
  std::int64_t unsettledSteps = 0;
  EnergyAudit energy;
  /// Energy that contacts with other rocks took while no impact was under way, half of it for each
  /// of the two, J: the sum over rocks, and the losses of impacts between rocks, are that of
  /// `exchanged`.
  double lastingLoss = 0.0;
  /// The most by which its energy rose over what it had been before, with springs of the slope and
  /// what it gave to other rocks, J: from nowhere, as the slope has none to give.
  double gained = 0.0;
  double finesMass = 0.0;   ///< Of pieces too small to be followed, kg.
  double finesEnergy = 0.0; ///< Kinetic energy that they fly off with, J.
  std::uint64_t hash = 0;   ///< Of the motion: `motionHash`, given by the ensemble.
};

/// All of one rock in one iteration.
struct Trajectory
{
  TrajectorySummary summary;
  std::vector<Sample> samples;            ///< In the order of time, the last one is the end.
  std::vector<ImpactEvent> impacts;       ///< Where SimulationParameters::kept asks for them.
  std::vector<StructureEvent> structures; ///< In the order of time.
};

/// Energy that a rock has got from nowhere, of what it released and other rocks gave it; 0: none.
/// `gravity`: m/s².
double gainFromNowhere(const TrajectorySummary& summary, double gravity);
/// The same of energy that it has lost to nowhere, by the numerics.
double lossToNowhere(const TrajectorySummary& summary, double gravity);

/// Books an impact, and keeps it as an event where a list is asked for.
void noteImpact(Trajectory& trajectory, const ImpactEvent& event, bool keep);
/// Takes back one that has been noted: it goes on, and will be noted as a whole.
void forgetImpact(Trajectory& trajectory, const ImpactEvent& event, bool kept);

} // namespace rockfall
