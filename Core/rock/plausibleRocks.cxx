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
  Doubt light(
    "densities of rocks", "Rocks have " + between(kRockDensity) + " kg/m³: is it in kg/m³?");
  Doubt large("volumes of rocks", "Rocks have " + between(kRockVolume) + " m³: is it in m³?");
  Doubt soft(
    "Young's moduli of rocks", "Rocks have " + between(kYoung, 1e9) + " GPa: is it in Pa?");
  Doubt fast("speeds of rocks at release",
    "Rocks start with up to " + numberText(kReleaseSpeed.most) +
      " m/s, by their spin, too: are they in m/s and rad/s?");
  Doubt vague("deviations of places",
    "Places deviate by up to " + numberText(kPlaceDeviation.most) + " m, heights by " +
      numberText(kHeightDeviation.most) + " m: are deviations in m?");
  Doubt turned("deviations of attitudes",
    "Attitudes deviate by up to " + numberText(kAttitudeDeviation.most) +
      " degrees: is it in degrees, or are they random?");
  for (const Rock& rock : rocks)
  {
    const std::string name = "block " + std::to_string(rock.blockId);
    light.look(kRockDensity, name, rock.density, " kg/m³");
    large.look(kRockVolume, name, rock.shape.integrals().volume, " m³");
    soft.look(kYoung, name, rock.youngModulus, " GPa", 1e9);
    fast.look(kReleaseSpeed, name,
      std::max(rock.velocity.norm(), rock.angularVelocity.norm() * rock.shape.radius()), " m/s");
    const ReleaseUncertainty& unsure = rock.uncertainty;
    const double turn = unsure.attitude == AttitudeLaw::Deviate ? unsure.attitudeDeviation : 0.0;
    turned.look(kAttitudeDeviation, name, degrees(turn), " degrees");
    const bool high = !kHeightDeviation.has(unsure.verticalDeviation);
    vague.look(!high && kPlaceDeviation.has(unsure.horizontalDeviation), name,
      high ? unsure.verticalDeviation : unsure.horizontalDeviation, " m");
  }
  tellAll(notes, light, large, soft, fast, vague, turned);
  if (!frequencies.empty())
  {
    askAfterFrequency(std::accumulate(frequencies.begin(), frequencies.end(), 0.0), notes);
  }
}

} // namespace rockfall
