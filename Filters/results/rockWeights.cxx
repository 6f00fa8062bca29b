#include "results/rockWeights.h"

#include "statistics/copies.h"

#include <array>
#include <cmath>
#include <optional>

namespace rockfall::filters
{

namespace
{

std::optional<double> known(double frequency)
{
  return std::isnan(frequency) ? std::nullopt : std::optional(frequency);
}

} // namespace

RockReleases releasesOf(const ReleasedRocks& released, std::span<const Crossing> crossings)
{
  RockReleases releases;
  for (const Crossing& c : crossings)
  {
    releases.add(c.rock, c.blockId, { 0, known(c.frequency) });
  }
  const RockReleases crossed = releases;
  for (const CollectedRock& rock : released)
  {
    const auto of = crossed.all().find({ rock.rock, rock.blockId });
    const bool own = of == crossed.all().end() || !of->second.frequency;
    releases.add(
      rock.rock, rock.blockId, { 1, own ? known(rock.frequency) : std::optional<double>() });
  }
  return releases;
}

void weigh(const RockReleases& releases, std::span<Crossing> crossings)
{
  for (Crossing& c : crossings)
  {
    c.weight = releases.weight(c.rock, c.blockId);
  }
}

std::vector<std::string> copyNotes(
  const RockReleases& releases, std::span<const Crossing> crossings)
{
  const RockRuns runs = releases.runs();
  Copies copies;
  for (const Crossing& c : crossings)
  {
    if (runs.hasSeveral(c.rock))
    {
      copies.add(c.iteration, c.rock, c.blockId,
        std::array{ double(c.line), double(c.number), double(c.piece), c.kineticEnergy,
          c.velocity.x(), c.velocity.y(), c.velocity.z(), c.heightOverGround, c.top });
    }
  }
  return rockfall::copyNotes(copies.count());
}

} // namespace rockfall::filters
