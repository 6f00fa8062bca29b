#pragma once

/// @file
/// Every number that rules a run, in one struct.

#include "base/RockContact.h"
#include "rock/retention.h"

#include <cstdint>
#include <vector>

namespace rockfall
{

/// What resolves an impact of a stiff rock by itself on hard ground.
enum class ImpactResolution : std::uint8_t
{
  Impulse = 0, ///< One event in impulse space (solve/step/impulse.h).
  Springs = 1, ///< Steps of springs and dashpots, as all other impacts on the slope.
};

/// How rocks break in impacts (rock/fragmentation.h).
struct Fragmentation
{
  bool on = false;
  double energy = 0.0;           ///< Normal energy of an impact by volume that breaks, J/m³, > 0.
  double fractalDimension = 0.0; ///< D of the pieces' volumes, dimensionless, 0 < D < 3.
  double leastVolume = 0.0;      ///< Of pieces that are followed, m³, > 0.
  double survival = 0.0;         ///< Share of such impacts that leave a rock whole, 0 … 1.
  double loss = 0.0;             ///< Share of the kinetic energy that breaking takes, 0 … 1.
  double spread = 0.0; ///< Half angle of the cone of the pieces' directions, rad, 0 … 90°.

  void validate() const; ///< Throws ParameterError naming field and value.
};

struct SimulationParameters
{
  double timeStep =
    0.005; ///< Δt of lasting contact, s, > 0. Impacts are resolved finer by themselves.
  double endTime = 60.0;        ///< s, > 0.
  double outputInterval = 0.05; ///< Between samples, s, > 0. Does not change the motion.
  Kept kept;                    ///< Parts of trajectories; in an ensemble its sink tells.
  double gravity = 9.81;        ///< m/s², ≥ 0.
  ImpactResolution impactResolution = ImpactResolution::Springs;

  double normalPenalty = 0.0;   ///< pₙ, N/m; 0: `penaltyFor`. METHOD 9.1: 1e9.
  double shearRatio = 1.0;      ///< pₛ / pₙ, dimensionless, > 0.
  bool rockRockContact = false; ///< Rocks of one iteration fall together and hit each other.
  double rockRestitution = 0.5; ///< Normal, between rocks, dimensionless, 0 … 1.
  double rockFrictionAngle = radians(30.0); ///< φ between rocks, rad, 0° … 89°.
  double rockCohesion = 0.0;                ///< c between rocks, N per contact point, ≥ 0.
  /// Pairs of materials that have others than these three, each pair once.
  std::vector<RockContactPair> rockContactPairs;
  bool pushRocksApart = false; ///< Rocks that overlap at the start are moved instead of an error.

  Fragmentation fragmentation;

  bool rigid = false; ///< Infinite stiffness: 6 unknowns per block.

  int iterations = 1; ///< Independent realisations of roughness, Rv and φ, ≥ 1.
  /// Number of the first of them, ≥ 0: iterations 10 … 19 are the same whether they are run alone
  /// or among 0 … 99.
  int firstIteration = 0;
  std::uint64_t seed = 1; ///< With the iteration it determines every random number.
  int threads = 0;        ///< 0 = all.

  int maxOpenClose = 12; ///< Open–close iterations before a step is cut, ≥ 2.
  int maxCuts = 10;      ///< Halvings of a step before it is taken unsettled, ≥ 0.

  /// pₙ of a rock (kg) on the slope, N/m, while no other is near: `normalPenalty`; of 0 m (10⁴
  /// rad/s)² and no less than `pairPenalty`.
  double penaltyFor(double mass) const;
  /// pₙ between rocks, and of what is near others on the slope, N/m: `normalPenalty`, or of 0 the
  /// paper's.
  double pairPenalty() const;

  void validate() const; ///< Throws ParameterError naming field and value.
};

} // namespace rockfall
