#include "statistics/runOrigin.h"

#include <algorithm>
#include <sstream>

namespace rockfall
{

namespace
{

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

std::vector<std::string> askAfterRuns(
  std::span<const RunOrigin> runs, const std::function<std::string(std::size_t)>& name)
{
  std::vector<std::string> notes;
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
  return notes;
}

} // namespace rockfall
