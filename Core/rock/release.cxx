#include "rock/release.h"

#include "base/random.h"
#include "base/require.h"
#include "geometry/shell.h"
#include "law/settings.h"
#include "rock/Rock.h"
#include "rock/placement.h"
#include "terrain/Surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

Quat rotationOf(const Vec3& vector)
{
  const double angle = vector.norm();
  return angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, vector / angle)) : Quat::Identity();
}

} // namespace

Quat randomRotation(double u, double v, double w)
{
  const double a = std::sqrt(1.0 - u), b = std::sqrt(u);
  const double s = 2.0 * std::numbers::pi * v, t = 2.0 * std::numbers::pi * w;
  return Quat(b * std::cos(t), a * std::sin(s), a * std::cos(s), b * std::sin(t));
}

void ReleaseUncertainty::validate() const
{
  const auto notNegative = [](double value, const char* field, const char* unit)
  {
    require(value >= 0.0 && std::isfinite(value), field, value, "",
      std::string("a finite number of ") + unit + ", at least 0");
  };
  notNegative(this->horizontalDeviation, "HorizontalDeviation", "m");
  notNegative(this->verticalDeviation, "VerticalDeviation", "m");
  notNegative(degrees(this->attitudeDeviation), "AttitudeDeviation", "degrees");
  if (this->attitude < AttitudeLaw::AsGiven || this->attitude > AttitudeLaw::Deviate)
  {
    throw ParameterError(
      "AttitudeLaw is " + std::to_string(int(this->attitude)) + ", it must be 0 to 2");
  }
  this->volume.validate();
}

Rock realise(
  const Terrain& terrain, const Rock& rock, std::uint64_t seed, int iteration, std::uint64_t index)
{
  const ReleaseUncertainty& unsure = rock.uncertainty;
  const auto realisation = std::uint32_t(iteration);
  Rock drawn = rock;
  if (unsure.volume.law != VolumeLaw::Fixed)
  {
    drawn.shape = rock.shape.withVolume(
      unsure.volume.quantile(uniformDeviate(seed, realisation, Draw::Volume, index)));
  }
  // Two numbers are had for each index, and a rock needs up to four of them.
  const auto first = 2 * index, second = 2 * index + 1;
  if (unsure.attitude == AttitudeLaw::Random)
  {
    const auto [u, v] = uniformDeviates(seed, realisation, Draw::Attitude, first);
    drawn.orientation =
      randomRotation(u, v, uniformDeviate(seed, realisation, Draw::Attitude, second));
  }
  else if (unsure.attitude == AttitudeLaw::Deviate)
  {
    const auto [x, y] = normalDeviates(seed, realisation, Draw::Attitude, first);
    const double z = normalDeviate(seed, realisation, Draw::Attitude, second);
    drawn.orientation =
      rotationOf(unsure.attitudeDeviation * Vec3(x, y, z)) * rock.orientation.normalized();
  }

  if (unsure.horizontalDeviation > 0.0)
  {
    int attempt = 0;
    do
    {
      if (attempt == kMostDraws)
      {
        throw PlacementError("block " + std::to_string(rock.blockId) + ": HorizontalDeviation " +
          numberText(unsure.horizontalDeviation) + " m puts it outside the slope " +
          std::to_string(kMostDraws) + " times in a row in iteration " + std::to_string(iteration));
      }
      const auto [x, y] = normalDeviates(
        seed, realisation, Draw::StartPosition, index * kMostDraws + std::uint64_t(attempt));
      drawn.position.head<2>() =
        rock.position.head<2>() + unsure.horizontalDeviation * Eigen::Vector2d(x, y);
      ++attempt;
    } while (terrain.cfeAt(drawn.position.x(), drawn.position.y()) == 0);
  }
  const Surface surveyed = Surface::asSurveyed(terrain);
  const double over = rock.position.z() -
    touchingHeight(
      surveyed, rock.shape, rock.orientation.normalized(), rock.position.x(), rock.position.y());
  const double deviation = unsure.verticalDeviation > 0.0
    ? unsure.verticalDeviation * normalDeviate(seed, realisation, Draw::StartHeight, index)
    : 0.0;
  drawn.position.z() = std::max(0.0, over + deviation) +
    touchingHeight(
      surveyed, drawn.shape, drawn.orientation, drawn.position.x(), drawn.position.y());
  drawn.uncertainty = {};
  return drawn;
}

} // namespace rockfall
