#include "run/releaseHeights.h"

#include "base/text/numberText.h"
#include "law/settings.h"
#include "rock/placement.h"
#include "terrain/Surface.h"
#include "terrain/doubt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace rockfall
{

namespace
{

double heightOver(const Surface& surface, const Rock& rock)
{
  const double x = rock.position.x(), y = rock.position.y();
  return rock.position.z() -
    touchingHeight(surface, rock.shape, rock.orientation.normalized(), x, y);
}

/// The bounding spheres of rocks in columns as wide as the largest one: what lies under which.
class Columns
{
public:
  explicit Columns(std::span<const Rock> rocks)
  {
    for (const Rock& rock : rocks)
    {
      width_ = std::max(width_, 2.0 * rock.shape.radius());
    }
    for (const Rock& rock : rocks)
    {
      const double r = rock.shape.radius(), z = rock.position.z();
      columns_[this->at(rock)].emplace_back(z - r, z + r);
    }
    for (auto& [place, spheres] : columns_)
    {
      std::sort(spheres.begin(), spheres.end());
      double top = -std::numeric_limits<double>::infinity();
      for (auto& [low, high] : spheres)
      {
        high = top = std::max(top, high);
      }
    }
  }

  /// From the rock's lower end down to the highest top of those that reach farther down, m.
  double gapUnder(const Rock& rock) const
  {
    const auto [x, y] = this->at(rock);
    const double low = rock.position.z() - rock.shape.radius();
    double top = -std::numeric_limits<double>::infinity();
    for (int beside = 0; beside < 9; ++beside)
    {
      const auto found = columns_.find({ x + beside % 3 - 1, y + beside / 3 - 1 });
      if (found != columns_.end())
      {
        const auto next = std::lower_bound(found->second.begin(), found->second.end(),
          std::pair(low, -std::numeric_limits<double>::infinity()));
        top = next == found->second.begin() ? top : std::max(top, std::prev(next)->second);
      }
    }
    return low - top;
  }

private:
  using Place = std::pair<double, double>;

  Place at(const Rock& rock) const
  {
    return { std::floor(rock.position.x() / width_), std::floor(rock.position.y() / width_) };
  }

  double width_ = 0.0;
  /// By their lower ends; with the highest top of those up to each.
  std::map<Place, std::vector<std::pair<double, double>>> columns_;
};

} // namespace

void askAfterHeights(
  const Terrain& terrain, std::span<const Rock> rocks, std::vector<std::string>& notes)
{
  const double most = plausible::kReleaseHeight.most;
  const Surface surveyed = Surface::asSurveyed(terrain);
  const auto isHigh = [&](const Rock& rock)
  {
    const double middle =
      rock.position.z() - terrain.elevation(rock.position.x(), rock.position.y());
    return middle > most && rock.velocity.norm() < kInFlight && heightOver(surveyed, rock) > most;
  };
  if (std::none_of(rocks.begin(), rocks.end(), isHigh))
  {
    return;
  }
  const Columns columns(rocks);
  Doubt high("heights of rocks over the ground",
    "Rocks start up to " + numberText(most) +
      " m over the ground or other rocks: do their heights belong to this slope?");
  for (const Rock& rock : rocks)
  {
    high.look(!isHigh(rock) || columns.gapUnder(rock) <= most,
      "block " + std::to_string(rock.blockId),
      [&] { return " at " + numberText(heightOver(surveyed, rock), 4) + " m"; });
  }
  high.tell(notes);
}

} // namespace rockfall
