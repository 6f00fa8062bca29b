#pragma once

/// @file
/// The fall of a rock that may break, and of its pieces: each goes on from where the rock breaks,
/// with the velocity that it has as a part of it, and may break again. Pieces meet each other only
/// in what they leave of structures.

#include "rock/Rock.h"
#include "rock/parameters.h"
#include "rock/results.h"
#include "terrain/Surface.h"

#include <cstdint>
#include <vector>

namespace rockfall
{

/// The trajectory of the rock and behind it those of its pieces, by their numbers: pieces of the
/// same parent one after the other, parents in their order. `number`, `enough` as in SingleRock; a
/// piece that comes to be later than `enough` is not there.
std::vector<Trajectory> fallAndBreak(const Surface& surface, const Rock& rock,
  const SimulationParameters& parameters, std::uint32_t number, double enough);

/// Shapes of pieces, made again for whoever shows them: trajectories have none.
class PieceShapes
{
public:
  /// Keeps references.
  PieceShapes(const Terrain& terrain, const SimulationParameters& parameters)
    : terrain_(terrain)
    , parameters_(parameters)
  {
  }
  /// Of a piece of `rock`, as given; nothing of a whole rock. The trajectories of a rock and its
  /// pieces are asked for in their order.
  Polyhedron next(const TrajectorySummary& summary, const Rock& rock);

private:
  const Terrain& terrain_;
  const SimulationParameters& parameters_;
  std::vector<Polyhedron> shapes_;     ///< Of the rock at hand, by piece.
  std::vector<std::uint32_t> numbers_; ///< Under which they draw.
};

/// Throws ParameterError naming the block if it cannot break by this law, or into too many pieces.
void requireBreakable(const Rock& rock, const Fragmentation& law);

} // namespace rockfall
