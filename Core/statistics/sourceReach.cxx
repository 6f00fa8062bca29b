#include "statistics/sourceReach.h"

#include "base/errors.h"

#include <algorithm>
#include <string>

namespace rockfall
{

SourceReach::SourceReach(const RockReleases& releases)
{
  releases.requireOneSource();
  const RockRuns runs = releases.runs();
  std::map<std::pair<int, std::int64_t>, std::size_t> numbers; // of a source of a run
  for (const auto& [rock, release] : releases.all())
  {
    if (release.source)
    {
      const std::pair source(runs.of(rock.first, rock.second), *release.source);
      const auto number = numbers.try_emplace(source, numbers.size()).first->second;
      sources_.resize(numbers.size());
      sources_[number].released += release.iterations;
      sourceOf_.emplace(rock, number);
    }
  }
}

void SourceReach::add(const Passage& passage)
{
  const auto found = sourceOf_.find({ passage.rock, passage.blockId });
  if (found == sourceOf_.end())
  {
    throw DataError("Rock " + std::to_string(passage.rock) + " (block " +
      std::to_string(passage.blockId) + ") passes cells, but its source is not known");
  }
  if (sources_[found->second].came++ == 0)
  {
    touched_.push_back(found->second);
  }
}

double SourceReach::take()
{
  double largest = 0.0;
  for (const std::size_t number : touched_)
  {
    Source& source = sources_[number];
    largest = std::max(largest, double(source.came) / double(source.released));
    source.came = 0;
  }
  touched_.clear();
  return largest;
}

} // namespace rockfall
