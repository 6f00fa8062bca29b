#include "statistics/runOrigin.h"

#include "base/Tally.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

namespace rockfall
{

namespace
{

constexpr std::string_view kRelease = "Release ", kFrom = " from block ";

std::vector<std::string> linesOf(const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
  {
    lines.push_back(line);
  }
  return lines;
}

/// Properties without what was released, and that.
std::pair<std::string, std::string> takenApart(const std::string& properties)
{
  const std::size_t last = properties.rfind('\n') + 1; // 0 if there is one line
  return properties.compare(last, kRelease.size(), kRelease) == 0
    ? std::pair(properties.substr(0, last == 0 ? 0 : last - 1), properties.substr(last))
    : std::pair(properties, std::string());
}

/// The note on releases under the numbers of another one.
void askAfterReleases(std::span<const std::string> releases,
  const std::function<std::string(std::size_t)>& name, std::vector<std::string>& notes)
{
  std::map<std::string, std::size_t> first; // run that released from a block on
  Tally alike;
  for (std::size_t k = 0; k < releases.size(); ++k)
  {
    const std::size_t from = releases[k].find(kFrom);
    if (from != std::string::npos)
    {
      const std::size_t of = first.try_emplace(releases[k].substr(from), k).first->second;
      alike.look(
        releases[k] != releases[of], [&] { return name(k) + ", not those of " + name(of); });
    }
  }
  alike.tell(notes, "",
    " of " + std::to_string(releases.size()) +
      " runs released other rocks under the same block ids, first ",
    ": rocks of one number count as one, with the frequency of one. Another FirstBlockId for each "
    "release tells them apart");
}

/// "TimeStep 0.01 s, not 0.005 s": what one has of its own, and the other in its place.
std::string differences(const std::string& one, const std::string& other)
{
  const std::vector<std::string> all = linesOf(one), against = linesOf(other);
  std::string told;
  for (const std::string& line : all)
  {
    if (std::find(against.begin(), against.end(), line) != against.end())
    {
      continue;
    }
    const std::string start = line.substr(0, line.find(' ') + 1);
    const auto place = std::find_if(against.begin(), against.end(),
      [&start](const std::string& candidate) { return candidate.starts_with(start); });
    told += (told.empty() ? "" : "; ") + line +
      (place == against.end() ? "" : ", not " + place->substr(start.size()));
  }
  return told;
}

} // namespace

std::string releaseLine(std::uint64_t content, std::int64_t firstBlock)
{
  char number[17];
  std::snprintf(number, sizeof number, "%016llx", static_cast<unsigned long long>(content));
  return std::string(kRelease) + number + std::string(kFrom) + std::to_string(firstBlock);
}

std::vector<std::string> askAfterRuns(
  std::span<const RunOrigin> given, const std::function<std::string(std::size_t)>& name)
{
  std::vector<RunOrigin> runs(given.begin(), given.end());
  std::vector<std::string> notes, releases;
  for (RunOrigin& run : runs)
  {
    std::tie(run.properties, releases.emplace_back()) = takenApart(run.properties);
  }
  const auto look = [&](auto&& isKnown, auto&& isSame, auto&& words)
  {
    std::size_t first = 0, other = 0, others = 0;
    while (first < runs.size() && !isKnown(runs[first]))
    {
      ++first;
    }
    for (std::size_t k = first + 1; k < runs.size(); ++k)
    {
      if (isKnown(runs[k]) && !isSame(runs[k], runs[first]))
      {
        other = others++ == 0 ? k : other;
      }
    }
    if (others > 0)
    {
      notes.push_back(std::to_string(others) + " of " + std::to_string(runs.size()) +
        " runs, first " + name(other) + ", " + words(runs[other], runs[first], name(first)) +
        ". Do their rocks belong together?");
    }
  };
  using R = const RunOrigin&;
  look([](R run) { return run.slope != 0; }, [](R a, R b) { return a.slope == b.slope; },
    [](R, R, const std::string& first)
    { return "fell on another slope than " + first + ": heights, ground or structures differ"; });
  look([](R run) { return !run.properties.empty(); },
    [](R a, R b) { return a.properties == b.properties; },
    [](R run, R first, const std::string& of)
    {
      const std::string told = differences(run.properties, first.properties);
      return "fell with other properties than " + of + ": " +
        (told.empty() ? differences(first.properties, run.properties) + " there alone" : told);
    });
  askAfterReleases(releases, name, notes);
  return notes;
}

} // namespace rockfall
