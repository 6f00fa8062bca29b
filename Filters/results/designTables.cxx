#include "results/designTables.h"

#include "base/errors.h"
#include "shared/arrays.h"
#include "statistics/frequency.h"
#include "statistics/sample.h"

#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace rockfall::filters
{

namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Frequencies of the rocks, by number and block; nothing without the array.
std::optional<RockFrequencies> frequenciesOf(const MergedCrossings& merged, vtkDataArray* frequency)
{
  if (!frequency)
  {
    return std::nullopt;
  }
  std::map<std::pair<int, std::int64_t>, double> known;
  for (std::size_t k = 0; k < merged.crossings.size(); ++k)
  {
    const Crossing& c = merged.crossings[k];
    known[{ c.rock, c.blockId }] = frequency->GetTuple1(vtkIdType(k));
  }
  RockFrequencies result;
  for (const CollectedRock& rock : merged.released)
  {
    const auto found = known.find({ rock.rock, rock.blockId });
    if (found != known.end()) // else it passes no line
    {
      result.add(rock.rock, rock.blockId, found->second);
    }
  }
  return result;
}

/// A table with a number and a name of the line in each row.
class Rows
{
public:
  explicit Rows(vtkTable* output)
    : data_(output->GetRowData())
    , number_(addArray<vtkIntArray>(data_, "Line"))
    , name_(addArray<vtkStringArray>(data_, "LineName"))
  {
  }

  template <typename Array = vtkDoubleArray>
  vtkSmartPointer<Array> column(const std::string& name)
  {
    return addArray<Array>(data_, name.c_str());
  }

  void begin(std::size_t number, const DesignLine& line)
  {
    number_->InsertNextValue(int(number));
    name_->InsertNextValue(line.line.name);
  }

private:
  vtkFieldData* data_;
  vtkSmartPointer<vtkIntArray> number_;
  vtkSmartPointer<vtkStringArray> name_;
};

/// A characteristic value and its limits.
class ValueColumns
{
public:
  ValueColumns(Rows& rows, const std::string& name, double unit)
    : value_(rows.column(name))
    , low_(rows.column(name + "Low"))
    , high_(rows.column(name + "High"))
    , unit_(unit)
  {
  }

  void add(const DesignValue& of)
  {
    value_->InsertNextValue(of.value / unit_);
    low_->InsertNextValue(of.limits.low / unit_);
    high_->InsertNextValue(of.limits.high / unit_);
  }

private:
  vtkSmartPointer<vtkDoubleArray> value_, low_, high_;
  double unit_;
};

constexpr double kKilo = 1000.0;

} // namespace

std::vector<DesignLine> designLines(
  const MergedCrossings& merged, vtkPolyData* points, double annualFrequency)
{
  std::vector<DesignLine> lines;
  for (const CollectorLine& line : merged.lines)
  {
    lines.push_back({ line, {} });
  }
  vtkPointData* data = points->GetPointData();
  vtkDataArray *top = data->GetArray("TopHeight"), *source = data->GetArray("SourceId"),
               *frequency = data->GetArray("Frequency");
  if (!merged.crossings.empty() && !top)
  {
    throw DataError("The Input's crossings have no array TopHeight: they were made by an earlier "
                    "version; make them anew");
  }
  const bool together = annualFrequency > 0.0;
  const auto rocks = together ? std::nullopt : frequenciesOf(merged, frequency);
  const double share = together ? annualFrequency / double(merged.released.size()) : kNan;
  std::vector<const Crossing*> last(lines.size()); // of each line
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
          c.kineticEnergy, c.velocity.norm(), top->GetTuple1(id));
        continue;
      }
      Passage of;
      of.rock = c.rock;
      of.blockId = c.blockId;
      lines[std::size_t(c.line)].passings.push_back(
        { source ? std::int64_t(source->GetTuple1(id)) : -1, c.kineticEnergy, c.velocity.norm(),
          top->GetTuple1(id), rocks ? rocks->weight(of) : share });
    }
  }
  return lines;
}

void writeDesign(
  const std::vector<DesignLine>& lines, const PartialFactors& factors, vtkTable* output)
{
  Rows rows(output);
  const auto level = rows.column("Quantile");
  const auto count = rows.column<vtkIntArray>("Rocks"),
             least = rows.column<vtkIntArray>("LeastRocks");
  ValueColumns energy(rows, "EnergyInKilojoules", kKilo), speed(rows, "Speed", 1.0),
    top(rows, "TopHeight", 1.0);
  const auto designEnergy = rows.column("DesignEnergyInKilojoules"),
             designHeight = rows.column("DesignHeight"),
             requiredHeight = rows.column("RequiredHeight");
  const auto required = rows.column<vtkIntArray>("RequiredClass"),
             holds = rows.column<vtkIntArray>("BarrierHolds");
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const DesignLine& line = lines[k];
    for (const DesignLevel& of : designLevels(line.passings))
    {
      rows.begin(k, line);
      level->InsertNextValue(100.0 * of.quantile);
      count->InsertNextValue(int(line.passings.size()));
      least->InsertNextValue(of.quantile < 1.0 ? leastForQuantile(of.quantile) : 0);
      energy.add(of.energy);
      speed.add(of.speed);
      top.add(of.top);
      const double joules = factors.energy(of.energy.value, of.speed.value);
      const double metres = factors.height(of.top.value);
      designEnergy->InsertNextValue(joules / kKilo);
      designHeight->InsertNextValue(metres);
      requiredHeight->InsertNextValue(metres + factors.freeboard);
      required->InsertNextValue(sufficientClass(joules * factors.barrier));
      holds->InsertNextValue(joules * factors.barrier <= line.line.barrierCapacity &&
        metres + factors.freeboard <= line.line.barrierHeight);
    }
  }
}

void writeClasses(const std::vector<DesignLine>& lines, vtkTable* output)
{
  Rows rows(output);
  const auto name = rows.column<vtkStringArray>("Class");
  const auto height = rows.column("BarrierHeight"), maximum = rows.column("MaximumEnergyLevel"),
             service = rows.column("ServiceEnergyLevel");
  using Outcome = BarrierOutcome;
  const std::pair<const char*, Outcome::Count Outcome::*> kinds[] = {
    { "Caught", &Outcome::caught }, { "Over", &Outcome::over }, { "TooStrong", &Outcome::tooStrong }
  };
  std::vector<vtkSmartPointer<vtkIntArray>> counts;
  std::vector<vtkSmartPointer<vtkDoubleArray>> shares, frequencies;
  for (const auto& [kind, of] : kinds)
  {
    counts.push_back(rows.column<vtkIntArray>(kind));
  }
  for (const auto& [kind, of] : kinds)
  {
    shares.push_back(rows.column(kind + std::string("Share")));
  }
  const auto limit = rows.column("UncaughtShareHigh");
  for (const auto& [kind, of] : kinds)
  {
    frequencies.push_back(rows.column(kind + std::string("Frequency")));
  }
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const DesignLine& line = lines[k];
    const auto add = [&](const std::string& called, double mel, double sel)
    {
      rows.begin(k, line);
      name->InsertNextValue(called);
      height->InsertNextValue(line.line.barrierHeight);
      maximum->InsertNextValue(mel / kKilo);
      service->InsertNextValue(sel > 0.0 ? sel / kKilo : kNan);
      const Outcome outcome = outcomeOf(line.passings, line.line.barrierHeight, mel);
      for (std::size_t kind = 0; kind < std::size(kinds); ++kind)
      {
        const Outcome::Count& of = outcome.*kinds[kind].second;
        counts[kind]->InsertNextValue(of.rocks);
        shares[kind]->InsertNextValue(
          outcome.rocks() > 0 ? double(of.rocks) / outcome.rocks() : kNan);
        frequencies[kind]->InsertNextValue(of.frequency);
      }
      limit->InsertNextValue(
        shareAtMost(outcome.over.rocks + outcome.tooStrong.rocks, outcome.rocks()));
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
  Rows rows(output);
  const auto number = rows.column<vtkIdTypeArray>("SourceId");
  const auto count = rows.column<vtkIntArray>("Rocks"), caught = rows.column<vtkIntArray>("Caught"),
             over = rows.column<vtkIntArray>("Over"),
             tooStrong = rows.column<vtkIntArray>("TooStrong");
  const auto share = rows.column("Share"), uncaughtShare = rows.column("UncaughtShare"),
             frequency = rows.column("AnnualFrequency"),
             uncaught = rows.column("UncaughtFrequency"), most = rows.column("EnergyMaximum");
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const DesignLine& line = lines[k];
    std::map<std::int64_t, std::vector<DesignPassing>> sources;
    for (const DesignPassing& passing : line.passings)
    {
      sources[passing.source].push_back(passing);
    }
    const auto outcomeAt = [&line](const std::vector<DesignPassing>& passings)
    { return outcomeOf(passings, line.line.barrierHeight, line.line.barrierCapacity); };
    const BarrierOutcome all = outcomeAt(line.passings);
    const int allUncaught = all.over.rocks + all.tooStrong.rocks;
    for (const auto& [source, passings] : sources)
    {
      rows.begin(k, line);
      number->InsertNextValue(vtkIdType(source));
      const BarrierOutcome of = outcomeAt(passings);
      const int ofUncaught = of.over.rocks + of.tooStrong.rocks;
      count->InsertNextValue(of.rocks());
      caught->InsertNextValue(of.caught.rocks);
      over->InsertNextValue(of.over.rocks);
      tooStrong->InsertNextValue(of.tooStrong.rocks);
      share->InsertNextValue(double(of.rocks()) / all.rocks());
      uncaughtShare->InsertNextValue(allUncaught > 0 ? double(ofUncaught) / allUncaught : kNan);
      frequency->InsertNextValue(of.frequency());
      uncaught->InsertNextValue(of.over.frequency + of.tooStrong.frequency);
      double energy = 0.0;
      for (const DesignPassing& passing : passings)
      {
        energy = std::max(energy, passing.energy);
      }
      most->InsertNextValue(energy / kKilo);
    }
  }
}

void writePlaces(const std::vector<DesignLine>& lines, const PartialFactors& factors,
  std::int64_t released, vtkTable* output)
{
  Rows rows(output);
  const auto offset = rows.column("Offset");
  const auto count = rows.column<vtkIntArray>("Rocks");
  const auto share = rows.column("Share"), frequency = rows.column("AnnualFrequency");
  struct Level
  {
    std::size_t number; ///< Of designQuantiles.
    ValueColumns energy, top;
    vtkSmartPointer<vtkIntArray> required;
  };
  const auto level = [&rows](std::size_t number, const std::string& end)
  {
    return Level{ number, { rows, "EnergyInKilojoules" + end, kKilo },
      { rows, "TopHeight" + end, 1.0 }, rows.column<vtkIntArray>("RequiredClass" + end) };
  };
  Level of[] = { level(2, "95"), level(4, "99") };
  const auto uncaughtShare = rows.column("UncaughtShare"),
             uncaught = rows.column("UncaughtFrequency");
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const DesignLine& line = lines[k];
    rows.begin(k, line);
    offset->InsertNextValue(line.line.offset);
    const BarrierOutcome outcome =
      outcomeOf(line.passings, line.line.barrierHeight, line.line.barrierCapacity);
    count->InsertNextValue(outcome.rocks());
    share->InsertNextValue(double(outcome.rocks()) / double(released));
    frequency->InsertNextValue(outcome.frequency());
    const std::vector<DesignLevel> levels = designLevels(line.passings);
    for (Level& column : of)
    {
      const DesignLevel& values = levels[column.number];
      column.energy.add(values.energy);
      column.top.add(values.top);
      column.required->InsertNextValue(
        sufficientClass(factors.barrier * factors.energy(values.energy.value, values.speed.value)));
    }
    uncaughtShare->InsertNextValue(outcome.rocks() > 0
        ? double(outcome.over.rocks + outcome.tooStrong.rocks) / outcome.rocks()
        : kNan);
    uncaught->InsertNextValue(outcome.over.frequency + outcome.tooStrong.frequency);
  }
}

} // namespace rockfall::filters
