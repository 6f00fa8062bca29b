#include "results/designTables.h"

#include "shared/columns.h"
#include "statistics/copies.h"
#include "statistics/sample.h"

#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace rockfall::filters
{

namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

constexpr double kKilo = 1000.0;

/// A row of a table begins with its line.
struct LineRow
{
  std::size_t number;
  const DesignLine& line;
};

template <typename Row>
Columns<Row> columnsOf(vtkTable* output)
{
  Columns<Row> columns(output->GetRowData());
  columns.add("Line", [](const Row& row) { return int(row.number); });
  columns.add("LineName", [](const Row& row) { return row.line.line.name; });
  return columns;
}

/// Adds a characteristic value and its limits.
template <typename Row, typename Of>
void addValue(Columns<Row>& columns, const std::string& name, double unit, Of of)
{
  columns.add(name, [of, unit](const Row& row) { return of(row).value / unit; });
  columns.add(name + "Low", [of, unit](const Row& row) { return of(row).limits.low / unit; });
  columns.add(name + "High", [of, unit](const Row& row) { return of(row).limits.high / unit; });
}

int uncaughtRocks(const BarrierOutcome& outcome)
{
  return outcome.over.rocks + outcome.tooStrong.rocks;
}

double uncaughtFrequency(const BarrierOutcome& outcome)
{
  return outcome.over.frequency + outcome.tooStrong.frequency;
}

double shareOf(int rocks, int all)
{
  return all > 0 ? double(rocks) / all : kNan;
}

} // namespace

BarrierOutcome DesignLine::outcome(double capacity) const
{
  return outcomeOf(passings, line.barrierHeight, capacity, known);
}

std::vector<DesignLine> designLines(
  const MergedCrossings& merged, vtkPolyData* points, double annualFrequency)
{
  const bool together = annualFrequency > 0.0;
  const double share = together ? annualFrequency / double(merged.released.size()) : kNan;
  const bool known = together || merged.releases.haveFrequencies();
  std::vector<DesignLine> lines(merged.lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    lines[k].line = merged.lines[k];
    lines[k].known = known;
    lines[k].lostFrequency = known ? 0.0 : kNan;
  }
  const std::vector<LostRocks> lost = lostBefore(lines.size(), merged.crossings, merged.released,
    [&](std::size_t line, const CollectedRock& rock)
    {
      lines[line].lostFrequency +=
        together ? share : merged.releases.weight(rock.rock, rock.blockId);
    });
  vtkDataArray* source = points->GetPointData()->GetArray("SourceId");
  const RockRuns runs = merged.releases.runs();
  std::vector<const Crossing*> last(lines.size()); // of each line
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    lines[k].lost = lost[k];
  }
  for (std::size_t k = 0; k < merged.crossings.size(); ++k)
  {
    const Crossing& c = merged.crossings[k];
    if (c.number == 0)
    {
      const auto id = vtkIdType(k);
      const Crossing* before = std::exchange(last[std::size_t(c.line)], &c);
      if (before && c.piece > 0 &&
        std::tie(before->iteration, before->rock, before->blockId) ==
          std::tie(c.iteration, c.rock, c.blockId))
      {
        lines[std::size_t(c.line)].passings.back().takeLarger(
          c.kineticEnergy, c.velocity.norm(), c.top);
        continue;
      }
      lines[std::size_t(c.line)].passings.push_back(
        { source ? std::int64_t(source->GetTuple1(id)) : -1, c.kineticEnergy, c.velocity.norm(),
          c.top, together ? share : c.weight, source ? runs.of(c.rock, c.blockId) : 0 });
    }
  }
  return lines;
}

void writeDesign(
  const std::vector<DesignLine>& lines, const PartialFactors& factors, vtkTable* output)
{
  struct Row : LineRow
  {
    const DesignLevel& of;
  };
  using R = const Row&;
  auto columns = columnsOf<Row>(output);
  const auto energy = [&](R r) { return factors.energy(r.of.energy.value, r.of.speed.value); };
  const auto height = [&](R r) { return factors.height(r.of.top.value); };
  columns.add("Quantile", [](R r) { return 100.0 * r.of.quantile; });
  columns.add("Rocks", [](R r) { return int(r.line.passings.size()); });
  columns.add("LeastRocks",
    [](R r) { return int(r.of.quantile < 1.0 ? leastForQuantile(r.of.quantile) : 0); });
  addValue(columns, "EnergyInKilojoules", kKilo, [](R r) { return r.of.energy; });
  addValue(columns, "Speed", 1.0, [](R r) { return r.of.speed; });
  addValue(columns, "TopHeight", 1.0, [](R r) { return r.of.top; });
  columns.add("DesignEnergyInKilojoules", [energy](R r) { return energy(r) / kKilo; });
  columns.add("DesignHeight", height);
  columns.add("RequiredHeight", [&](R r) { return height(r) + factors.freeboard; });
  columns.add("RequiredClass", [&](R r) { return sufficientClass(energy(r) * factors.barrier); });
  columns.add("BarrierHolds",
    [&](R r)
    {
      return int(energy(r) * factors.barrier <= r.line.line.barrierCapacity &&
        height(r) + factors.freeboard <= r.line.line.barrierHeight);
    });
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    for (const DesignLevel& of : designLevels(lines[k].passings))
    {
      columns.append({ { k, lines[k] }, of });
    }
  }
}

void writeClasses(const std::vector<DesignLine>& lines, vtkTable* output)
{
  struct Row : LineRow
  {
    std::string name;
    double maximum, service; ///< J
    BarrierOutcome outcome;
  };
  using R = const Row&;
  auto columns = columnsOf<Row>(output);
  columns.add("Class", [](R r) { return r.name; });
  columns.add("BarrierHeight", [](R r) { return r.line.line.barrierHeight; });
  columns.add("MaximumEnergyLevel", [](R r) { return r.maximum / kKilo; });
  columns.add("ServiceEnergyLevel", [](R r) { return r.service > 0.0 ? r.service / kKilo : kNan; });
  using Outcome = BarrierOutcome;
  const std::pair<std::string, Outcome::Count Outcome::*> kinds[] = {
    { "Caught", &Outcome::caught }, { "Over", &Outcome::over }, { "TooStrong", &Outcome::tooStrong }
  };
  for (const auto& [kind, of] : kinds)
  {
    columns.add(kind, [of = of](R r) { return (r.outcome.*of).rocks; });
  }
  for (const auto& [kind, of] : kinds)
  {
    columns.add(
      kind + "Share", [of = of](R r) { return shareOf((r.outcome.*of).rocks, r.outcome.rocks()); });
  }
  columns.add("UncaughtShareHigh",
    [](R r)
    {
      // Nobody knows whether a rock that was lost before comes, and gets past.
      const auto lost = r.line.lost.lost();
      return shareAtMost(uncaughtRocks(r.outcome) + lost, r.outcome.rocks() + lost);
    });
  for (const auto& [kind, of] : kinds)
  {
    columns.add(kind + "Frequency", [of = of](R r) { return (r.outcome.*of).frequency; });
  }
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const DesignLine& line = lines[k];
    const auto add = [&](const std::string& name, double maximum, double service) {
      columns.append({ { k, line }, name, maximum, service, line.outcome(maximum) });
    };
    add("barrier", line.line.barrierCapacity, 0.0);
    for (std::size_t level = 0; level < barrierClasses.size(); ++level)
    {
      add(std::to_string(level), barrierClasses[level].maximum, barrierClasses[level].service);
    }
  }
}

void writeSources(const std::vector<DesignLine>& lines, vtkTable* output)
{
  struct Row : LineRow
  {
    std::int64_t source;
    const BarrierOutcome &of, &all;
    double energy; ///< The largest, J.
  };
  using R = const Row&;
  auto columns = columnsOf<Row>(output);
  columns.add("SourceId", [](R r) { return r.source; });
  columns.add("Rocks", [](R r) { return r.of.rocks(); });
  columns.add("Caught", [](R r) { return r.of.caught.rocks; });
  columns.add("Over", [](R r) { return r.of.over.rocks; });
  columns.add("TooStrong", [](R r) { return r.of.tooStrong.rocks; });
  columns.add("Share", [](R r) { return shareOf(r.of.rocks(), r.all.rocks()); });
  columns.add(
    "UncaughtShare", [](R r) { return shareOf(uncaughtRocks(r.of), uncaughtRocks(r.all)); });
  columns.add("AnnualFrequency", [](R r) { return r.of.frequency(); });
  columns.add("UncaughtFrequency", [](R r) { return uncaughtFrequency(r.of); });
  columns.add("EnergyMaximum", [](R r) { return r.energy / kKilo; });
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const DesignLine& line = lines[k];
    std::map<std::pair<std::int64_t, int>, std::vector<DesignPassing>> sources; // of each run
    for (const DesignPassing& passing : line.passings)
    {
      sources[{ passing.source, passing.run }].push_back(passing);
    }
    const BarrierOutcome all = line.outcome();
    for (const auto& [source, passings] : sources)
    {
      const BarrierOutcome outcome =
        outcomeOf(passings, line.line.barrierHeight, line.line.barrierCapacity, line.known);
      double energy = 0.0;
      for (const DesignPassing& passing : passings)
      {
        energy = std::max(energy, passing.energy);
      }
      columns.append({ { k, line }, source.first, outcome, all, energy });
    }
  }
}

void writePlaces(const std::vector<DesignLine>& lines, const PartialFactors& factors,
  std::int64_t released, vtkTable* output)
{
  struct Row : LineRow
  {
    BarrierOutcome outcome;
    std::vector<DesignLevel> levels;
  };
  using R = const Row&;
  auto columns = columnsOf<Row>(output);
  columns.add("Offset", [](R r) { return r.line.line.offset; });
  columns.add("Rocks", [](R r) { return r.outcome.rocks(); });
  columns.add("Share", [=](R r) { return double(r.outcome.rocks()) / double(released); });
  columns.add("AnnualFrequency", [](R r) { return r.outcome.frequency(); });
  for (const auto& [number, end] : { std::pair(2, "95"), std::pair(4, "99") })
  {
    const auto level = [n = std::size_t(number)](R r) -> const DesignLevel& { return r.levels[n]; };
    const std::string of = end;
    addValue(columns, "EnergyInKilojoules" + of, kKilo, [level](R r) { return level(r).energy; });
    addValue(columns, "TopHeight" + of, 1.0, [level](R r) { return level(r).top; });
    columns.add("RequiredClass" + of,
      [level, &factors](R r)
      {
        return sufficientClass(
          factors.barrier * factors.energy(level(r).energy.value, level(r).speed.value));
      });
  }
  columns.add(
    "UncaughtShare", [](R r) { return shareOf(uncaughtRocks(r.outcome), r.outcome.rocks()); });
  columns.add("UncaughtFrequency", [](R r) { return uncaughtFrequency(r.outcome); });
  columns.add("LostBefore", [](R r) { return r.line.lost.lost(); });
  columns.add("LostFrequency", [](R r) { return r.line.lostFrequency; });
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const DesignLine& line = lines[k];
    columns.append({ { k, line }, line.outcome(), designLevels(line.passings) });
  }
}

} // namespace rockfall::filters
