#include "statistics/frequency.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/text/numberText.h"

#include <cmath>
#include <string>

namespace rockfall
{

double powerLawFrequency(double a, double b, double v1, double v2)
{
  if (!(a >= 0.0 && b > 0.0 && v1 > 0.0 && v2 >= v1) || !std::isfinite(a) || !std::isfinite(b))
  {
    throw ParameterError("The frequency of volumes from " + numberText(v1) + " to " +
      numberText(v2) + " m³ by A = " + numberText(a) + ", B = " + numberText(b) +
      " cannot be: A must not be negative, B and the volumes positive and ascending");
  }
  return a * (std::pow(v1, -b) - std::pow(v2, -b));
}

double probabilityWithin(double frequency, double years)
{
  return -std::expm1(-frequency * years);
}

int intensityClass(std::span<const double> frequencies, double period)
{
  constexpr double rounding = 1e-9;
  int reached = 0;
  for (const double frequency : frequencies)
  {
    reached += frequency * period >= 1.0 - rounding ? 1 : 0;
  }
  return reached;
}

void RockFrequencies::add(int rock, std::int64_t blockId, double frequency)
{
  if (!(frequency >= 0.0) || !std::isfinite(frequency))
  {
    throw DataError("The Frequency of rock " + std::to_string(rock) + " is " +
      numberText(frequency) + " per year, it must be finite and not negative");
  }
  Release& release = releases_[{ rock, blockId }];
  if (release.iterations > 0 && release.frequency != frequency)
  {
    throw DataError("The Frequency of rock " + std::to_string(rock) + " is " +
      numberText(frequency) + " per year in one iteration and " + numberText(release.frequency) +
      " in another");
  }
  release.frequency = frequency;
  ++release.iterations;
}

double RockFrequencies::weight(const Passage& of) const
{
  const auto found = releases_.find({ of.rock, of.blockId });
  if (found == releases_.end())
  {
    throw DataError("Rock " + std::to_string(of.rock) + " has no Frequency");
  }
  return found->second.frequency / double(found->second.iterations);
}

void summarizeFrequencies(std::span<const Passage> passages, std::span<const double> thresholds,
  const std::function<double(const Passage&)>& weight,
  const std::function<void(const CellFrequency&)>& use)
{
  CellFrequency cell;
  for (std::size_t k = 0; k < passages.size(); ++k)
  {
    stayWanted();
    const Passage& passage = passages[k];
    if (k == 0 || passages[k - 1].cell != passage.cell)
    {
      cell.cell = passage.cell;
      cell.rocks.assign(thresholds.size() + 1, 0);
      cell.frequencies.assign(thresholds.size() + 1, 0.0);
    }
    const double share = weight(passage);
    const double energy = passage.maxima[std::size_t(Hazard::KineticEnergy)];
    for (std::size_t t = 0; t <= thresholds.size(); ++t)
    {
      if (t == 0 || energy >= thresholds[t - 1])
      {
        ++cell.rocks[t];
        cell.frequencies[t] += share;
      }
    }
    if (k + 1 == passages.size() || passages[k + 1].cell != passage.cell)
    {
      use(cell);
    }
  }
}

} // namespace rockfall
