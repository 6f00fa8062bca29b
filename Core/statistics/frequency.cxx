#include "statistics/frequency.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "statistics/sample.h"

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

std::string ownNotUsed(double annualFrequency)
{
  return "AnnualFrequency is " + numberText(annualFrequency) +
    " per year for all rocks together: the frequencies that they have of their own are not used";
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

void FrequencyRange::add(double frequency)
{
  low_ = std::fmin(low_, frequency);
  high_ = std::fmax(high_, frequency);
}

void FrequencyRange::add(const FrequencyRange& other)
{
  this->add(other.low_);
  this->add(other.high_);
}

bool FrequencyRange::differs() const
{
  constexpr double rounding = 1e-9;
  return high_ > low_ * (1.0 + rounding);
}

std::vector<std::string> FrequencyRange::notesOn(
  const char* rocks, const char* numbers, const char* instead) const
{
  if (!this->differs())
  {
    return {};
  }
  return { "Rocks that " + std::string(rocks) + " differ in their frequencies" +
    (low_ > 0.0 ? ", by up to " + numberText(high_ / low_, 3) + " times" : std::string()) +
    ", but " + numbers +
    " count each rock alike: rare rocks count too much in them, frequent ones too little. Release "
    "amounts in proportion to frequencies, or read how often " +
    instead };
}

std::vector<std::string> FrequencyRange::notes() const
{
  return this->notesOn("pass together", "quantiles", "an energy is exceeded");
}

std::vector<std::string> FrequencyRange::notesOnShares() const
{
  return this->notesOn("are released", "shares at lines", "a rock passes in Barrier Design");
}

void FrequencySummarizer::add(const Passage& passage)
{
  if (cell_.rocks.empty() || cell_.cell != passage.cell)
  {
    this->finish();
    cell_.cell = passage.cell;
    cell_.rocks.assign(thresholds_.size() + 1, 0);
    cell_.frequencies.assign(thresholds_.size() + 1, 0.0);
  }
  const double share = weight_(passage);
  ofCell_.add(share);
  const double energy = passage.maxima[std::size_t(Hazard::KineticEnergy)];
  for (std::size_t t = 0; t <= thresholds_.size(); ++t)
  {
    if (t == 0 || energy >= thresholds_[t - 1])
    {
      ++cell_.rocks[t];
      cell_.frequencies[t] += share;
    }
  }
}

void FrequencySummarizer::finish()
{
  if (!cell_.rocks.empty())
  {
    use_(cell_);
    cell_.rocks.clear();
    if (ofCell_.differs())
    {
      differing_.add(ofCell_);
    }
    ofCell_ = {};
  }
}

double frequencyLimit(double largestWeight)
{
  return -std::log(kDoubt) * largestWeight;
}

} // namespace rockfall
