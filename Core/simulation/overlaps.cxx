#include "simulation/overlaps.h"

#include "contact/pairs.h"
#include "system/broadPhase.h"

#include <algorithm>

namespace rockfall
{

namespace
{

/// Shallower overlaps are rounding: rocks laid on each other by computed coordinates.
constexpr double kLaidDown = 1e-6; // of the smaller radius

} // namespace

std::vector<RockOverlap> findOverlaps(std::span<const Rock> rocks)
{
  std::vector<Block> blocks;
  std::vector<PlacedBlock> placed(rocks.size());
  std::vector<PairBody> bodies(rocks.size());
  std::vector<BroadBox> boxes(rocks.size());
  blocks.reserve(rocks.size());
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    const Rock& rock = rocks[i];
    blocks.emplace_back(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
    BlockState state;
    state.position = rock.position;
    state.orientation = rock.orientation.normalized();
    placed[i].place(blocks[i], state);
    bodies[i].update(placed[i]);
    boxes[i].center = rock.position;
    boxes[i].radius = rock.shape.radius();
  }
  std::vector<RockOverlap> overlaps;
  for (const std::array<int, 2>& ij : findNear(boxes))
  {
    const std::size_t i = std::size_t(ij[0]), j = std::size_t(ij[1]);
    const double smaller = std::min(boxes[i].radius, boxes[j].radius);
    const PairAxis axis = findAxis(bodies[i], bodies[j], {}, 0.0);
    if (axis.distance < -kLaidDown * smaller)
    {
      overlaps.push_back({ ij[0], ij[1], -axis.distance, axis.normal });
    }
  }
  return overlaps;
}

} // namespace rockfall
