#include "rock/plausibleRocks.h"

#include "terrain/doubt.h"

#include <algorithm>
#include <numeric>

namespace rockfall
{

void askAfterRocks(
  std::span<const Rock> rocks, std::span<const double> frequencies, std::vector<std::string>& notes)
{
  using namespace plausible;
  Doubt light("Rocks have " + between(kRockDensity) + " kg/m³: is it in kg/m³?");
  Doubt large("Rocks have " + between(kRockVolume) + " m³: is it in m³?");
  Doubt soft("Rocks have " + between(kYoung, 1e9) + " GPa: is it in Pa?");
  Doubt fast("Rocks start with up to " + numberText(kReleaseSpeed.most) +
    " m/s, by their spin, too: are they in m/s and rad/s?");
  Doubt vague("Places deviate by up to " + numberText(kPlaceDeviation.most) + " m, heights by " +
    numberText(kHeightDeviation.most) + " m: are deviations in m?");
  Doubt turned("Attitudes deviate by up to " + numberText(kAttitudeDeviation.most) +
    " degrees: is it in degrees, or are they random?");
  for (const Rock& rock : rocks)
  {
    const auto look = [&](Doubt& doubt, bool fits, double value, const char* unit)
    {
      doubt.look(fits, std::string("block "),
        [&] { return std::to_string(rock.blockId) + " with " + numberText(value, 6) + unit; });
    };
    const auto within = [&](Doubt& doubt, const PlausibleRange& range, double value,
                          const char* unit, double of = 1.0)
    { look(doubt, range.has(value), value / of, unit); };
    within(light, kRockDensity, rock.density, " kg/m³");
    within(large, kRockVolume, rock.shape.integrals().volume, " m³");
    within(soft, kYoung, rock.youngModulus, " GPa", 1e9);
    within(fast, kReleaseSpeed,
      std::max(rock.velocity.norm(), rock.angularVelocity.norm() * rock.shape.radius()), " m/s");
    const ReleaseUncertainty& unsure = rock.uncertainty;
    const double turn = unsure.attitude == AttitudeLaw::Deviate ? unsure.attitudeDeviation : 0.0;
    within(turned, kAttitudeDeviation, degrees(turn), " degrees");
    const bool high = !kHeightDeviation.has(unsure.verticalDeviation);
    look(vague, !high && kPlaceDeviation.has(unsure.horizontalDeviation),
      high ? unsure.verticalDeviation : unsure.horizontalDeviation, " m");
  }
  light.tell("densities of rocks", notes);
  large.tell("volumes of rocks", notes);
  soft.tell("Young's moduli of rocks", notes);
  fast.tell("speeds of rocks at release", notes);
  vague.tell("deviations of places", notes);
  turned.tell("deviations of attitudes", notes);
  if (!frequencies.empty())
  {
    askAfterFrequency(std::accumulate(frequencies.begin(), frequencies.end(), 0.0), notes);
  }
}

} // namespace rockfall
