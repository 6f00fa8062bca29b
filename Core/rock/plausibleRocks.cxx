#include "rock/plausibleRocks.h"

#include "terrain/doubt.h"

#include <numeric>

namespace rockfall
{

void askAfterRocks(
  std::span<const Rock> rocks, std::span<const double> frequencies, std::vector<std::string>& notes)
{
  using namespace plausible;
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
    askAfterFrequency(std::accumulate(frequencies.begin(), frequencies.end(), 0.0), notes);
  }
}

} // namespace rockfall
