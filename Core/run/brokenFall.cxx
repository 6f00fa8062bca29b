#include "run/brokenFall.h"

#include "base/Mixer.h"
#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/roundBody.h"
#include "rock/fall/SingleRock.h"
#include "rock/fall/atStructures.h"
#include "rock/fragmentation.h"
#include "run/ensemble.h"
#include "terrain/Obstacles.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>

namespace rockfall
{

namespace
{

/// The number under which a piece draws what is drawn for it: of its parent's and its own among
/// those that this broke into, from 1.
std::uint32_t numberOf(std::uint32_t parent, std::size_t piece)
{
  return std::uint32_t(scramble(std::uint64_t(parent) << 32 | piece));
}

/// A rock or a piece on its way.
struct Part
{
  Part(const Surface& surface, const Rock& given, const SimulationParameters& p, std::uint32_t n)
    : rock(given)
    , block(blockOf(rock))
    , number(n)
    , fall(surface, rock, block, p, n)
  {
  }

  Rock rock;
  Block block;
  std::uint32_t number;
  SingleRock fall;
  double born = 0.0;               ///< s
  bool told = false;               ///< The part has all that is asked for, though it moves.
  std::vector<std::size_t> pieces; ///< Among all parts.
};

/// A rock and its pieces. Where there are structures they go on together by Δt, as the rocks of a
/// mass fall do: what one of them has broken or loaded is so for the others.
class Family
{
public:
  Family(const Surface& surface, const SimulationParameters& parameters, double enough)
    : surface_(surface)
    , parameters_(parameters)
    , enough_(enough)
  {
    if (const Obstacles* obstacles = surface.terrain().obstacles())
    {
      const Structures& s = obstacles->structures();
      together_ = !s.trees.empty() || !s.barriers.empty();
      loads_.resize(s.barriers.size());
    }
  }

  void fallAll(const Rock& rock, std::uint32_t number)
  {
    Part& whole = this->add(rock, number);
    whole.fall.liftOntoGround();
    whole.fall.begin();
    this->advance(0, parameters_.endTime);
    // The rock is the only part so far.
    const double first = together_ ? whole.fall.state().time : parameters_.endTime;
    const double dt = parameters_.timeStep;
    for (double step = std::floor(first / dt) + 1.0; this->anyGoesOn(); step += 1.0)
    {
      const double until =
        together_ ? std::min(step * dt, parameters_.endTime) : parameters_.endTime;
      for (std::size_t k = 1; k < parts_.size(); ++k) // those that come to be, too
      {
        this->advance(k, until);
      }
      if (until >= parameters_.endTime)
      {
        break;
      }
    }
  }

  /// By their numbers: pieces of one parent one after the other, parents in their order.
  std::vector<Trajectory> finish()
  {
    std::vector<std::size_t> order{ 0 };
    std::vector<Trajectory> trajectories;
    for (std::size_t k = 0; k < order.size(); ++k)
    {
      Part& part = *parts_[order[k]];
      if (part.born <= enough_)
      {
        part.fall.trajectory().summary.piece = int(k);
        trajectories.push_back(part.fall.finish());
      }
      order.insert(order.end(), part.pieces.begin(), part.pieces.end());
    }
    return trajectories;
  }

private:
  Part& add(const Rock& rock, std::uint32_t number)
  {
    parts_.push_back(std::make_unique<Part>(surface_, rock, parameters_, number));
    parts_.back()->fall.fall().structures.setBarrierLoads(&loads_);
    return *parts_.back();
  }

  /// Whether more of a part is asked for.
  bool goesOn(const Part& part) const
  {
    return !part.fall.done() && !part.told && part.born <= enough_;
  }

  bool anyGoesOn() const
  {
    return std::any_of(
      parts_.begin() + 1, parts_.end(), [&](const auto& part) { return this->goesOn(*part); });
  }

  void advance(std::size_t number, double until)
  {
    Part& part = *parts_[number];
    if (!this->goesOn(part) || part.fall.state().time >= until)
    {
      return;
    }
    part.fall.advance(until, enough_);
    part.told = !part.fall.done() && !part.fall.fall().arrived();
    this->share(number);
    if (part.fall.trajectory().summary.fate == Fate::Broken)
    {
      this->breakUp(number);
    }
  }

  /// What a part has broken and loaded is so for the others.
  void share(std::size_t from)
  {
    StructuresOnWay::Broken now = parts_[from]->fall.fall().structures.drainBroken();
    now.addTo(loads_);
    if (now.trees.empty() && now.barriers.empty())
    {
      return;
    }
    gone_.trees.insert(gone_.trees.end(), now.trees.begin(), now.trees.end());
    gone_.barriers.insert(gone_.barriers.end(), now.barriers.begin(), now.barriers.end());
    const double time = parts_[from]->fall.state().time;
    for (const auto& part : parts_)
    {
      const bool leant = applyBroken(part->fall.fall(), now);
      if (leant && part->fall.done() && part->fall.trajectory().summary.fate == Fate::Rested)
      {
        part->fall.wake(std::max(time, part->fall.state().time));
      }
    }
  }

  /// Pieces of a rock in a scar begin in it, so that nothing lifts them.
  void sinkWith(const Fall& whole, Fall& piece) const
  {
    const Scar& scar = whole.soil.scar();
    const Vec3& at = piece.body.state.position;
    Contact under;
    under.cfe = whole.impact.last().cfe;
    under.normal = scar.normal();
    under.point = Vec3(at.x(), at.y(), surface_.elevation(at.x(), at.y()));
    if (scar.open() && std::isfinite(under.point.z()))
    {
      piece.soil.sink({ &under, scar.depth(), 0.0 }, piece.structures, piece.body, piece.ground);
    }
  }

  void breakUp(std::size_t number)
  {
    const BlockState state = parts_[number]->fall.state();
    const Vec3 normal = parts_[number]->fall.fall().impact.last().normal;
    const Vec3 spin = state.angularVelocity();
    double mass = parts_[number]->block.mass();
    double energy = rigidKineticEnergy(parts_[number]->block, state);
    const Fragmentation& law = parameters_.fragmentation;
    const std::uint32_t parent = parts_[number]->number;
    for (const Polyhedron& shape : fragmentsOf(parts_[number]->rock.shape, law, surface_, parent))
    {
      std::vector<std::size_t>& pieces = parts_[number]->pieces;
      const std::uint32_t own = numberOf(parent, pieces.size() + 1);
      Rock rock = parts_[number]->rock;
      const Vec3 lever = state.orientation * shape.integrals().centroid;
      rock.shape = shape.centred();
      rock.position = state.position + lever;
      rock.orientation = state.orientation;
      rock.velocity =
        spreadVelocity(state.velocity + spin.cross(lever), normal, law, surface_, own);
      rock.angularVelocity = spin;
      pieces.push_back(parts_.size());
      Part& piece = this->add(rock, own);
      piece.born = piece.fall.body().state.time = state.time;
      applyBroken(piece.fall.fall(), gone_);
      // A stem past which the rock has slipped may be where the piece begins.
      const std::span<const int> passed = parts_[number]->fall.fall().structures.goneTrees();
      applyBroken(piece.fall.fall(), { { passed.begin(), passed.end() }, {}, {}, {} });
      this->sinkWith(parts_[number]->fall.fall(), piece.fall.fall());
      piece.fall.beginAsPiece(state.position);
      this->share(parts_.size() - 1);
      BlockState moving = state;
      moving.velocity = rock.velocity;
      mass -= piece.block.mass();
      energy -= rigidKineticEnergy(piece.block, moving);
    }
    TrajectorySummary& summary = parts_[number]->fall.trajectory().summary;
    summary.pieces = int(parts_[number]->pieces.size());
    summary.finesMass = std::max(0.0, mass);
    summary.finesEnergy = std::max(0.0, energy);
  }

  const Surface& surface_;
  const SimulationParameters& parameters_;
  double enough_;
  bool together_ = false;
  std::vector<std::unique_ptr<Part>> parts_; ///< The rock itself is the first.
  StructuresOnWay::Broken gone_;             ///< For all of them.
  std::vector<BarrierLoad> loads_;           ///< By barrier.
};

} // namespace

std::vector<Trajectory> fallAndBreak(const Surface& surface, const Rock& rock,
  const SimulationParameters& parameters, std::uint32_t number, double enough)
{
  Family family(surface, parameters, enough);
  family.fallAll(rock, number);
  return family.finish();
}

Polyhedron PieceShapes::next(const TrajectorySummary& summary, const Rock& rock)
{
  if (summary.piece == 0)
  {
    shapes_ = { rock.uncertainty.volume.law == VolumeLaw::Fixed
        ? rock.shape
        : rock.shape.withVolume(summary.volume) };
    numbers_ = { std::uint32_t(summary.rock) };
  }
  const Polyhedron shape = shapes_[std::size_t(summary.piece)];
  if (summary.pieces > 0)
  {
    const Surface surface(terrain_, parameters_.seed, summary.iteration);
    const std::uint32_t number = numbers_[std::size_t(summary.piece)];
    std::size_t k = 0;
    for (const Polyhedron& piece : fragmentsOf(shape, parameters_.fragmentation, surface, number))
    {
      shapes_.push_back(piece.centred());
      numbers_.push_back(numberOf(number, ++k));
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
