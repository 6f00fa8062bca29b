#pragma once

/// @file
/// A rock as a step of contact finds and leaves it.

#include "block/Block.h"
#include "contact/Contact.h"
#include "contact/PlacedBlock.h"
#include "rock/results.h"
#include "solve/step/StepSolver.h"

#include <vector>

namespace rockfall
{

/// Speed at which a point (m) of a rock comes against a unit normal, m/s. `turning`: its angular
/// velocity in world axes, rad/s.
inline double approachOf(
  const BlockState& state, const Vec3& turning, const Vec3& point, const Vec3& normal)
{
  return -normal.dot(state.velocity + turning.cross(point - state.position));
}

/// Motion, contacts with the slope and books of one rock. Whoever steps it writes them: the rock
/// itself (SingleRock), or the island that it belongs to (IslandStepper).
struct RockBody
{
  explicit RockBody(const Block& b)
    : block(b)
  {
  }
  /// The block's strain follows its contacts as at rest, without inertia.
  void letStrainFollow()
  {
    this->stiff = true;
    this->ringing = 0.0;
  }
  /// Without contact springs, J.
  double mechanicalEnergy(double gravity) const
  {
    return kineticEnergy(this->block, this->state) + strainEnergy(this->block, this->state) +
      this->block.mass() * gravity * this->state.position.z();
  }

  /// Most by which weight accelerates a point of it that topples over another, m/s².
  double pull(double gravity) const
  {
    return gravity * this->block.mass() * this->block.largestMobility();
  }

  const Block& block;
  bool done = false;                     ///< At rest, gone from the slope or out of time.
  bool inIsland = false;                 ///< The last step was that of an island.
  bool stiff = false;                    ///< The block's strain has no inertia.
  StepKind steppedAs = StepKind::Impact; ///< In the last step.
  double ringing = 0.0;                  ///< Period of a soft block's slowest strain, s; 0: stiff.
  double restingSpeed = 0.0;             ///< Below it a touch is no impact, m/s.
  BlockState state;
  std::vector<Contact> contacts; ///< With the slope.
  std::vector<Contact> contactsBefore;
  BlockState before;                    ///< At the start of the last step of contact.
  Vec3 acceleration = Vec3::Zero();     ///< Of the last step, m/s².
  Vec3 spinAcceleration = Vec3::Zero(); ///< Body axes, rad/s².
  double springEnergy = 0.0;            ///< In the contact springs, J.
  double springEnergyBefore = 0.0;      ///< The same at the start of the last step of contact, J.
  double normalEnergy = 0.0;            ///< In the normal ones, J.
  double quietTime = 0.0;               ///< For how long it has been lying still, s.
  EnergyAudit energy;
  PlacedBlock placed; ///< Where `state` is, as far as it was asked for.
};

} // namespace rockfall
