#include "run/brokenFall.h"

#include "base/Mixer.h"
#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/roundBody.h"
#include "rock/fall/SingleRock.h"
#include "rock/fall/atStructures.h"
#include "rock/fragmentation.h"
#include "run/ensemble.h"

#include <algorithm>
#include <string>
#include <utility>

namespace rockfall
{

namespace
{

/// A rock or a piece whose fall has not been looked at yet.
struct Waiting
{
  Rock rock;
  double time = 0.0; ///< s
  std::uint32_t number = 0;
  StructuresOnWay::Broken gone; ///< By those that it was a part of.
};

/// The number under which a piece draws what is drawn for it.
std::uint32_t numberOf(std::uint32_t rock, std::size_t piece)
{
  return piece == 0 ? rock : std::uint32_t(scramble(std::uint64_t(rock) << 32 | piece));
}

/// Takes the fall of `whole`, which has broken, apart.
void breakUp(const Waiting& whole, SingleRock& fall, const Surface& surface,
  const Fragmentation& law, std::uint32_t rock, std::vector<Waiting>& waiting)
{
  const BlockState& state = fall.state();
  const Vec3 normal = fall.fall().impact.last().normal;
  const Vec3 spin = state.angularVelocity();
  TrajectorySummary& summary = fall.trajectory().summary;
  StructuresOnWay::Broken gone = whole.gone;
  const StructuresOnWay::Broken now = fall.fall().structures.drainBroken();
  gone.trees.insert(gone.trees.end(), now.trees.begin(), now.trees.end());
  gone.barriers.insert(gone.barriers.end(), now.barriers.begin(), now.barriers.end());
  double mass = fall.body().block.mass();
  double energy = rigidKineticEnergy(fall.body().block, state);
  for (const Polyhedron& shape : fragmentsOf(whole.rock.shape, law, surface, whole.number))
  {
    Waiting piece{ whole.rock, state.time, numberOf(rock, waiting.size()), gone };
    const Vec3 lever = state.orientation * shape.integrals().centroid;
    piece.rock.shape = shape.centred();
    piece.rock.position = state.position + lever;
    piece.rock.orientation = state.orientation;
    piece.rock.velocity =
      spreadVelocity(state.velocity + spin.cross(lever), normal, law, surface, piece.number);
    piece.rock.angularVelocity = spin;
    const Block block = blockOf(piece.rock);
    BlockState moving = state;
    moving.velocity = piece.rock.velocity;
    mass -= block.mass();
    energy -= rigidKineticEnergy(block, moving);
    ++summary.pieces;
    waiting.push_back(std::move(piece));
  }
  summary.finesMass = std::max(0.0, mass);
  summary.finesEnergy = std::max(0.0, energy);
}

} // namespace

std::vector<Trajectory> fallAndBreak(const Surface& surface, const Rock& rock,
  const SimulationParameters& parameters, std::uint32_t number, double enough)
{
  std::vector<Trajectory> trajectories;
  std::vector<Waiting> waiting{ { rock, 0.0, number, {} } };
  for (std::size_t k = 0; k < waiting.size(); ++k)
  {
    const Waiting at = std::move(waiting[k]);
    if (at.time > enough)
    {
      continue;
    }
    const Block block = blockOf(at.rock);
    SimulationParameters own = parameters;
    if (own.normalPenalty == 0.0)
    {
      own.normalPenalty = penaltyByMass(block.mass(), surface.terrain());
    }
    SingleRock fall(surface, at.rock, block, own, at.number);
    fall.body().state.time = at.time;
    applyBroken(fall.fall(), at.gone);
    fall.trajectory().summary.piece = int(k);
    if (k == 0)
    {
      fall.liftOntoGround();
      fall.begin();
    }
    else
    {
      fall.begin(); // the books begin where those of the whole ended
      fall.liftOntoGround();
    }
    fall.advance(parameters.endTime, enough);
    if (fall.trajectory().summary.fate == Fate::Broken)
    {
      breakUp(at, fall, surface, parameters.fragmentation, number, waiting);
    }
    trajectories.push_back(fall.finish());
  }
  return trajectories;
}

Polyhedron PieceShapes::next(const TrajectorySummary& summary, const Rock& rock)
{
  if (summary.piece == 0)
  {
    shapes_ = { rock.uncertainty.volume.law == VolumeLaw::Fixed
        ? rock.shape
        : rock.shape.withVolume(summary.volume) };
  }
  const Polyhedron shape = shapes_[std::size_t(summary.piece)];
  if (summary.pieces > 0)
  {
    const Surface surface(terrain_, parameters_.seed, summary.iteration);
    const std::uint32_t number = numberOf(std::uint32_t(summary.rock), std::size_t(summary.piece));
    for (const Polyhedron& piece : fragmentsOf(shape, parameters_.fragmentation, surface, number))
    {
      shapes_.push_back(piece.centred());
    }
  }
  return summary.piece == 0 ? Polyhedron() : shape;
}

void requireBreakable(const Rock& rock, const Fragmentation& law)
{
  const std::string name = "block " + std::to_string(rock.blockId);
  if (isRound(rock.shape.layout()))
  {
    throw ParameterError(name +
      " is a sphere or an ellipsoid, which cannot break: Fragmentation must be 0, or the block "
      "another shape, as an icosahedron");
  }
  const double volume = rock.shape.integrals().volume;
  const double pieces =
    volume > law.leastVolume ? meanFragments(law.fractalDimension, law.leastVolume / volume) : 0.0;
  if (pieces > kMostFragments)
  {
    throw ParameterError("LeastFragment is " + numberText(law.leastVolume) + " m³: " + name +
      " of " + numberText(volume, 4) + " m³ would break into some " + numberText(pieces, 3) +
      " pieces, at most " + numberText(kMostFragments) + " are followed; give a larger one");
  }
}

} // namespace rockfall
