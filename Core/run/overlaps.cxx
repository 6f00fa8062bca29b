#include "run/overlaps.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/text/numberText.h"
#include "contact/pair/broadPhase.h"
#include "contact/pairs.h"
#include "law/settings.h"
#include "rock/placement.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace rockfall
{

namespace
{

/// A rock where it stands, as the search for axes takes it.
struct Standing
{
  Block block;
  PlacedBlock placed;
  PairBody body;

  explicit Standing(const Rock& rock)
    : block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio)
  {
    this->move(rock);
  }
  void move(const Rock& rock)
  {
    BlockState state;
    state.position = rock.position;
    state.orientation = rock.orientation.normalized();
    placed.place(block, state);
    body.update(placed);
  }
};

/// Bodies refer to their own blocks, and stay where they are.
std::vector<std::unique_ptr<Standing>> standing(std::span<const Rock> rocks)
{
  std::vector<std::unique_ptr<Standing>> all;
  all.reserve(rocks.size());
  for (const Rock& rock : rocks)
  {
    all.push_back(std::make_unique<Standing>(rock));
  }
  return all;
}

std::vector<RockOverlap> overlapsOf(
  std::span<const Rock> rocks, const std::vector<std::unique_ptr<Standing>>& all)
{
  std::vector<BroadBox> boxes(rocks.size());
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    boxes[i].center = rocks[i].position;
    boxes[i].radius = rocks[i].shape.radius();
  }
  std::vector<RockOverlap> overlaps;
  for (const std::array<int, 2>& ij : findNear(boxes))
  {
    stayWanted();
    const std::size_t i = std::size_t(ij[0]), j = std::size_t(ij[1]);
    const double smaller = std::min(boxes[i].radius, boxes[j].radius);
    if (findAxis(all[i]->body, all[j]->body, {}, 0.0).distance >= -kTouch * smaller)
    {
      continue;
    }
    const PairAxis axis = bestAxis(all[i]->body, all[j]->body);
    if (axis.distance < -kTouch * smaller)
    {
      overlaps.push_back({ ij[0], ij[1], -axis.distance, axis.normal });
    }
  }
  return overlaps;
}

/// The share of a rock in getting apart from another one; `up`: z of its way out, a unit vector.
double shareOf(double mass, double otherMass, double up, bool byMass)
{
  if (byMass)
  {
    return otherMass / (mass + otherMass);
  }
  return std::abs(up) <= kUpward ? 0.5 : up > 0.0 ? 1.0 : 0.0;
}

std::string nameOf(const Rock& rock, const Vec3& origin)
{
  const Vec3 world = rock.position + origin;
  return "block " + std::to_string(rock.blockId) + " at (" + numberText(world.x()) + ", " +
    numberText(world.y()) + ", " + numberText(world.z()) + ")";
}

const RockOverlap& deepest(const std::vector<RockOverlap>& overlaps)
{
  return *std::max_element(overlaps.begin(), overlaps.end(),
    [](const RockOverlap& a, const RockOverlap& b) { return a.depth < b.depth; });
}

std::string others(std::size_t overlaps)
{
  return overlaps < 2 ? ""
    : overlaps == 2   ? "; so does 1 other pair"
                      : "; so do " + std::to_string(overlaps - 1) + " other pairs";
}

bool isSame(const Rock& a, const Rock& b)
{
  const double rounding = kTouch * a.shape.radius();
  if ((a.position - b.position).norm() > rounding ||
    a.shape.vertices().size() != b.shape.vertices().size())
  {
    return false;
  }
  for (std::size_t v = 0; v < a.shape.vertices().size(); ++v)
  {
    const Vec3 apart = a.orientation.normalized() * a.shape.vertices()[v] -
      b.orientation.normalized() * b.shape.vertices()[v];
    if (apart.norm() > rounding)
    {
      return false;
    }
  }
  return true;
}

} // namespace

std::vector<RockOverlap> findOverlaps(std::span<const Rock> rocks)
{
  return overlapsOf(rocks, standing(rocks));
}

void requireEachOnce(std::span<const Rock> rocks, const Vec3& origin)
{
  // Rocks that are one stand beside each other along x.
  std::vector<std::size_t> order(rocks.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    {
      const double x = rocks[a].position.x(), y = rocks[b].position.x();
      return x != y ? x < y : a < b;
    });
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const Rock& a = rocks[order[i]];
    const double rounding = kTouch * a.shape.radius();
    for (std::size_t j = i + 1; j < order.size(); ++j)
    {
      const Rock& b = rocks[order[j]];
      if (b.position.x() - a.position.x() > rounding)
      {
        break;
      }
      if (isSame(a, b))
      {
        const bool inOrder = order[i] < order[j];
        throw PlacementError(nameOf(inOrder ? a : b, origin) + " and block " +
          std::to_string((inOrder ? b : a).blockId) +
          " are the same rock twice: of one shape, at one place, in one attitude. Give it once, or "
          "let sources of several rocks spread them (ClusterRadius)");
      }
    }
  }
}

void requireNoOverlap(std::span<const Rock> rocks, const Vec3& origin, const std::string& when)
{
  const std::vector<RockOverlap> overlaps = findOverlaps(rocks);
  if (overlaps.empty())
  {
    return;
  }
  const RockOverlap& worst = deepest(overlaps);
  throw PlacementError(nameOf(rocks[std::size_t(worst.first)], origin) + " and " +
    nameOf(rocks[std::size_t(worst.second)], origin) + " overlap at the start" + when + ", by " +
    numberText(worst.depth, 4) + " m" + others(overlaps.size()) +
    ". Move them apart, or switch PushRocksApart on");
}

void PushedApart::add(const PushedApart& others)
{
  rocks = std::max(rocks, others.rocks);
  farthest = std::max(farthest, others.farthest);
  passes = std::max(passes, others.passes);
  iterations += others.iterations;
}

PushedApart pushApart(const Terrain& terrain, std::span<Rock> rocks)
{
  const Surface ground = Surface::asSurveyed(terrain);
  const Vec3 origin = terrain.geometry().origin();
  std::vector<Vec3> before;
  for (const Rock& rock : rocks)
  {
    before.push_back(rock.position);
  }
  const auto all = standing(rocks);
  std::vector<Vec3> ways(rocks.size());
  std::vector<int> pairs(rocks.size());
  PushedApart done;
  std::vector<RockOverlap> overlaps = overlapsOf(rocks, all);
  for (; !overlaps.empty(); overlaps = overlapsOf(rocks, all))
  {
    if (++done.passes > kMostPasses)
    {
      const RockOverlap& worst = deepest(overlaps);
      throw PlacementError(nameOf(rocks[std::size_t(worst.first)], origin) + " and " +
        nameOf(rocks[std::size_t(worst.second)], origin) + " cannot be pushed apart: after " +
        std::to_string(kMostPasses) + " passes they still overlap, by " +
        numberText(worst.depth, 4) + " m" + others(overlaps.size()));
    }
    std::fill(ways.begin(), ways.end(), Vec3::Zero());
    std::fill(pairs.begin(), pairs.end(), 0);
    const bool byMass = done.passes <= kPushPatience;
    for (const RockOverlap& overlap : overlaps)
    {
      const std::size_t i = std::size_t(overlap.first), j = std::size_t(overlap.second);
      const double massI = all[i]->block.mass(), massJ = all[j]->block.mass();
      const double up = overlap.normal.z();
      const Vec3 apart = kPushApart * overlap.depth * overlap.normal;
      const double shareI = shareOf(massI, massJ, up, byMass);
      const double shareJ = shareOf(massJ, massI, -up, byMass);
      ways[i] += shareI * apart;
      ways[j] -= shareJ * apart;
      pairs[i] += shareI > 0.0;
      pairs[j] += shareJ > 0.0;
    }
    for (std::size_t i = 0; i < rocks.size(); ++i)
    {
      stayWanted();
      if (pairs[i] == 0)
      {
        continue;
      }
      Rock& rock = rocks[i];
      rock.position += ways[i] / double(pairs[i]);
      const double height = touchingHeight(
        ground, rock.shape, rock.orientation.normalized(), rock.position.x(), rock.position.y());
      if (std::isnan(height))
      {
        throw PlacementError("PushRocksApart moves " + nameOf(rock, origin) +
          " off the slope; move the rocks apart, or in from its edge");
      }
      rock.position.z() = std::max(rock.position.z(), height);
      all[i]->move(rock);
    }
  }
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    const double way = (rocks[i].position - before[i]).norm();
    done.rocks += way > 0.0;
    done.farthest = std::max(done.farthest, way);
  }
  done.iterations = done.rocks > 0;
  return done;
}

std::array<std::int64_t, 2> ApartPlacer::cellOf(const Vec3& place) const
{
  return { std::int64_t(std::floor(place.x() / cell_)),
    std::int64_t(std::floor(place.y() / cell_)) };
}

bool ApartPlacer::fits(const Rock& rock) const
{
  const auto cell = this->cellOf(rock.position);
  for (std::int64_t i = cell[0] - 1; i <= cell[0] + 1; ++i)
  {
    for (std::int64_t j = cell[1] - 1; j <= cell[1] + 1; ++j)
    {
      const auto found = cells_.find({ i, j });
      if (found == cells_.end())
      {
        continue;
      }
      for (const std::size_t k : found->second)
      {
        const Rock& other = rocks_[k];
        if ((other.position - rock.position).norm() >= other.shape.radius() + rock.shape.radius())
        {
          continue;
        }
        if (other.uncertainty.attitude != AttitudeLaw::AsGiven ||
          rock.uncertainty.attitude != AttitudeLaw::AsGiven)
        {
          return false;
        }
        const std::array<Rock, 2> two = { rock, other };
        if (!findOverlaps(two).empty())
        {
          return false;
        }
      }
    }
  }
  return true;
}

void ApartPlacer::add(const Rock& rock)
{
  cells_[this->cellOf(rock.position)].push_back(rocks_.size());
  rocks_.push_back(rock);
}

} // namespace rockfall
