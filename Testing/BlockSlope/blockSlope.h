#pragma once

/// @file
/// A rock on a slope of DDA blocks, to show the paper's two claims for CFEs: the same motion (figs
/// 12 and 14), at a cost that does not grow with the slope. For verification; nothing else uses it.

#include "BlockSlope/SlopeBlocks.h"
#include "run/ensemble.h"

namespace rockfall
{

struct BlockSlopeRun
{
  Trajectory trajectory;
  int blocks = 0;   ///< Of the slope, n.
  int unknowns = 0; ///< 12 (n + 1)
  std::int64_t steps = 0;
  std::int64_t solutions = 0; ///< Of the whole system, by open–close.
  double seconds = 0.0;       ///< Wall time of the steps, contact search included, s.
  double secondsPerStep() const { return steps > 0 ? seconds / double(steps) : 0.0; }
};

/// Simulates one rock on iteration 0 of a terrain whose CFEs are blocks of the rock's material, the
/// prisms under them `depth` (m) deep. Every step solves the whole system and looks for contacts on
/// the whole slope, in flight as well, with Δt in flight and lasting contact and as fine as on CFEs
/// during an impact. Neighbouring artificial blocks have no contacts with each other, as each is
/// held by fixed points: the cost is a lower bound.
///
/// Choose `depth` such that a prism, of stiffness E A / depth, is far stiffer than pₙ and vibrates
/// faster than an impact lasts: 1 m under cells of 5 m will do from E 1e10 Pa on, 2 m will not.
///
/// Impacts are elastic, whatever the terrain's Rv: the paper's adjustment has nothing to do with
/// how the slope is modelled. As on CFEs the vibration of rock and slope is dropped when the rock
/// takes off; `summary.energy` has it, with the elastic energy of the slope in `strain`.
///
/// Throws ParameterError, GeometryError, or PlacementError for a rock that is not over the slope.
BlockSlopeRun simulateOnBlockSlope(const Terrain& terrain, const Rock& rock,
  const SimulationParameters& parameters, SlopeModel model, double depth = 1.0);

} // namespace rockfall
