#include "statistics/rockReleases.h"

#include "base/errors.h"
#include "base/text/numberText.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace rockfall
{

namespace
{

double weightOf(const RockRelease& release)
{
  return *release.frequency / double(release.iterations);
}

} // namespace

void RockReleases::add(int rock, std::int64_t blockId, const RockRelease& release)
{
  const auto name = [&]
  {
    return "The Frequency of rock " + std::to_string(rock) + " is " +
      numberText(*release.frequency) + " per year";
  };
  if (release.frequency && (!(*release.frequency >= 0.0) || !std::isfinite(*release.frequency)))
  {
    throw DataError(name() + ", it must be finite and not negative");
  }
  const auto [at, isNew] = rocks_.try_emplace({ rock, blockId }, release);
  if (isNew)
  {
    return;
  }
  RockRelease& known = at->second;
  known.iterations += release.iterations;
  if (release.frequency && release.frequency != known.frequency.value_or(*release.frequency))
  {
    throw DataError(
      name() + " in one iteration and " + numberText(*known.frequency) + " in another");
  }
  if (release.source && twoSources_.empty() &&
    release.source != known.source.value_or(*release.source))
  {
    twoSources_ = "Rock " + std::to_string(rock) + " (block " + std::to_string(blockId) +
      ") is of the source " + std::to_string(*release.source) + " in one iteration and of " +
      std::to_string(*known.source) + " in another";
  }
  known.frequency = known.frequency ? known.frequency : release.frequency;
  known.source = known.source ? known.source : release.source;
}

void RockReleases::add(const RockReleases& other)
{
  for (const auto& [rock, release] : other.rocks_)
  {
    this->add(rock.first, rock.second, release);
  }
  if (twoSources_.empty())
  {
    twoSources_ = other.twoSources_;
  }
}

bool RockReleases::haveFrequencies() const
{
  return std::ranges::any_of(rocks_, [](const auto& r) { return r.second.frequency.has_value(); });
}

bool RockReleases::haveSources() const
{
  return std::ranges::any_of(rocks_, [](const auto& r) { return r.second.source.has_value(); });
}

void RockReleases::requireOneSource() const
{
  if (!twoSources_.empty())
  {
    throw DataError(twoSources_);
  }
}

double RockReleases::weight(const Passage& of) const
{
  const double known = this->weight(of.rock, of.blockId);
  if (std::isnan(known))
  {
    throw DataError("Rock " + std::to_string(of.rock) + " has no Frequency");
  }
  return known;
}

double RockReleases::weight(int rock, std::int64_t blockId) const
{
  const auto found = rocks_.find({ rock, blockId });
  return found == rocks_.end() || !found->second.frequency
    ? std::numeric_limits<double>::quiet_NaN()
    : weightOf(found->second);
}

FrequencyRange RockReleases::weights() const
{
  FrequencyRange range;
  for (const auto& [rock, release] : rocks_)
  {
    range.add(this->weight(rock.first, rock.second));
  }
  return range;
}

RockRuns RockReleases::runs() const
{
  std::vector<std::pair<int, std::int64_t>> rocks;
  rocks.reserve(rocks_.size());
  for (const auto& [rock, release] : rocks_)
  {
    rocks.push_back(rock);
  }
  return RockRuns(std::move(rocks));
}

double RockReleases::largestWeight() const
{
  double largest = 0.0;
  for (const auto& [rock, release] : rocks_)
  {
    largest = std::max(largest, release.frequency ? weightOf(release) : 0.0);
  }
  return largest;
}

} // namespace rockfall
