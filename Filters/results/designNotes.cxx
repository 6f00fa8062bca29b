#include "results/designNotes.h"

#include "base/Tally.h"
#include "base/text/numberText.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

namespace rockfall::filters
{

namespace
{

std::string kilojoules(double energy)
{
  return numberText(energy / 1000.0, 4) + " kJ";
}

/// "95 %", or "largest value".
std::string levelName(double quantile)
{
  return quantile < 1.0 ? numberText(100.0 * quantile) + " %" : "largest value";
}

bool changesAnything(const PartialFactors& factors)
{
  return factors.designMass > 0.0 || factors.energy(1.0, 1.0) != 1.0 || factors.height(1.0) != 1.0;
}

} // namespace

std::vector<std::string> sourceNotes(const std::vector<DesignLine>& lines)
{
  std::map<std::int64_t, std::set<int>> runs; // of each source
  for (const DesignLine& line : lines)
  {
    for (const DesignPassing& passing : line.passings)
    {
      runs[passing.source].insert(passing.run);
    }
  }
  Tally several;
  for (const auto& [source, of] : runs)
  {
    several.look(of.size() > 1, [id = source] { return std::to_string(id); });
  }
  std::vector<std::string> notes;
  several.tell(notes, "",
    " of " + std::to_string(runs.size()) + " SourceIds are of several runs, first ",
    ": each run numbers its sources by itself, so Sources has a row for each, in the order of "
    "their BlockIds. Another FirstSourceId for each run tells them apart");
  return notes;
}

std::vector<std::string> frequencyNotes(
  const std::vector<DesignLine>& lines, const FrequencyRange& released)
{
  FrequencyRange differing;
  for (const DesignLine& line : lines)
  {
    FrequencyRange ofLine;
    for (const DesignPassing& passing : line.passings)
    {
      ofLine.add(passing.frequency);
    }
    if (ofLine.differs())
    {
      differing.add(ofLine);
    }
  }
  std::vector<std::string> notes = differing.notes();
  std::ranges::move(released.notesOnShares(), std::back_inserter(notes));
  return notes;
}

std::vector<std::string> factorNotes(
  const std::vector<DesignLine>& lines, const PartialFactors& factors)
{
  PartialFactors asSimulated = factors;
  asSimulated.designMass = 0.0;
  Tally less, above;
  for (const DesignLine& line : lines)
  {
    const std::vector<DesignLevel> levels = designLevels(line.passings);
    const auto designEnergy = [](const PartialFactors& by, const DesignLevel& of)
    { return by.energy(of.energy.value, of.speed.value); };
    const auto lower = std::ranges::find_if(levels,
      [&](const DesignLevel& of)
      { return designEnergy(factors, of) < designEnergy(asSimulated, of); });
    less.look(factors.designMass > 0.0 && lower != levels.end(),
      [&]
      {
        return "\"" + line.line.name + "\", " + levelName(lower->quantile) + ": " +
          kilojoules(designEnergy(factors, *lower)) + " instead of " +
          kilojoules(designEnergy(asSimulated, *lower));
      });
    const auto high = std::ranges::find_if(levels,
      [&](const DesignLevel& of)
      { return designEnergy(factors, of) * factors.barrier > barrierClasses.back().maximum; });
    above.look(high != levels.end(),
      [&]
      {
        return "\"" + line.line.name + "\", " + levelName(high->quantile) + ": " +
          kilojoules(designEnergy(factors, *high) * factors.barrier);
      });
  }
  std::vector<std::string> notes;
  const std::string of = " of " + std::to_string(lines.size()) + " lines ";
  less.tell(notes, "On ", of + "DesignMass makes less energy than the simulated rocks have, first ",
    ". Design and RequiredClass are of the less");
  above.tell(notes, "On ",
    of + "design energies times BarrierFactor are above the last class, " +
      kilojoules(barrierClasses.back().maximum) + ", first ",
    ". RequiredClass 8 is no class that all nets of it hold: the maker's declaration counts");
  if (changesAnything(factors))
  {
    notes.emplace_back("DesignMass and partial factors are in Design and RequiredClass alone: "
                       "shares and frequencies "
                       "of what is caught are of the rocks as they were simulated");
  }
  return notes;
}

} // namespace rockfall::filters
