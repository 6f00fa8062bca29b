#include "rock/plausibleRocks.h"

#include "terrain/doubt.h"

#include <numeric>

namespace rockfall
{

std::vector<std::string> implausibleRocks(
  std::span<const Rock> rocks, std::span<const double> frequencies)
{
  using namespace plausible;
  std::vector<std::string> notes;
  Doubt light("Rocks have " + between(kRockDensity) + " kg/m³: is it in kg/m³?");
  for (const Rock& rock : rocks)
  {
    light.look(kRockDensity.has(rock.density), std::string("block "),
      [&]
      { return std::to_string(rock.blockId) + " with " + numberText(rock.density, 6) + " kg/m³"; });
  }
  light.tell("densities of rocks", notes);
  if (!frequencies.empty())
  {
    const double all = std::accumulate(frequencies.begin(), frequencies.end(), 0.0);
    for (std::string& note : implausibleFrequency(all))
    {
      notes.push_back(std::move(note));
    }
  }
  return notes;
}

} // namespace rockfall
