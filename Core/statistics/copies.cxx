#include "statistics/copies.h"

#include "base/Mixer.h"

#include <algorithm>
#include <limits>
#include <set>

namespace rockfall
{

RockRuns::RockRuns(std::vector<std::pair<int, std::int64_t>> rocks)
{
  std::ranges::sort(rocks);
  rocks.erase(std::unique(rocks.begin(), rocks.end()), rocks.end());
  const auto isOfOneNumber = [](const auto& a, const auto& b) { return a.first == b.first; };
  if (std::ranges::adjacent_find(rocks, isOfOneNumber) == rocks.end())
  {
    return;
  }
  std::ranges::sort(rocks, {}, [](const auto& rock) { return std::pair(rock.second, rock.first); });
  std::vector<int> last;              // number of each run
  std::map<std::int64_t, int> byStep; // run whose blocks are so far from their numbers
  int current = -1;
  for (const auto& rock : rocks)
  {
    const auto fits = [&](int run) { return run >= 0 && rock.first > last[std::size_t(run)]; };
    const auto same = byStep.find(rock.second - rock.first);
    if (same != byStep.end() && fits(same->second))
    {
      current = same->second;
    }
    else if (!fits(current))
    {
      current = int(last.size());
      last.push_back(std::numeric_limits<int>::min());
    }
    last[std::size_t(current)] = rock.first;
    byStep[rock.second - rock.first] = current;
    runs_.emplace(rock, current);
  }
  count_ = int(last.size());
}

int RockRuns::of(int rock, std::int64_t blockId) const
{
  const auto found = runs_.find({ rock, blockId });
  return found == runs_.end() ? 0 : found->second;
}

bool RockRuns::hasSeveral(int rock) const
{
  const auto first = runs_.lower_bound({ rock, std::numeric_limits<std::int64_t>::min() });
  return first != runs_.end() && first->first.first == rock && std::next(first) != runs_.end() &&
    std::next(first)->first.first == rock;
}

void Copies::add(int iteration, int rock, std::int64_t blockId, std::span<const double> values)
{
  Mixer mixer;
  for (const double value : values)
  {
    mixer.add(value);
  }
  contents_[{ iteration, rock, blockId }] += mixer.value();
}

std::int64_t Copies::count() const
{
  std::int64_t copies = 0;
  std::set<std::uint64_t> seen; // of one iteration and number
  std::pair<int, int> before(-1, -1);
  for (const auto& [rock, content] : contents_)
  {
    const std::pair of(std::get<0>(rock), std::get<1>(rock));
    if (of != std::exchange(before, of))
    {
      seen.clear();
    }
    copies += !seen.insert(content).second;
  }
  return copies;
}

std::vector<std::string> copyNotes(std::int64_t copies)
{
  if (copies == 0)
  {
    return {};
  }
  return { std::to_string(copies) +
    " rocks fell exactly as another one of their iteration: a run that was made again with other "
    "block ids and the same Seed says nothing new, and its frequencies count twice" };
}

} // namespace rockfall
