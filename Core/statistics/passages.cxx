#include "statistics/passages.h"

#include "base/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace rockfall
{

std::string hazardName(Hazard hazard)
{
  switch (hazard)
  {
    case Hazard::KineticEnergy:
      return "KineticEnergy";
    case Hazard::Speed:
      return "Speed";
    case Hazard::HeightOverGround:
      return "HeightOverGround";
    case Hazard::RotationRate:
      break;
  }
  return "RotationRate";
}

void raise(Maxima& maxima, const Maxima& other)
{
  for (std::size_t k = 0; k < maxima.size(); ++k)
  {
    maxima[k] = std::max(maxima[k], other[k]);
  }
}

void Passage::join(const Passage& other, unsigned times)
{
  this->enter(times);
  stopped |= other.stopped;
  angle = std::min<std::uint32_t>(angle, other.angle);
  raise(maxima, other.maxima);
}

bool operator<(const Passage& a, const Passage& b)
{
  return std::tie(a.cell, a.iteration, a.rock, a.blockId) <
    std::tie(b.cell, b.iteration, b.rock, b.blockId);
}

CellSummarizer::CellSummarizer(const Releases& releases, const UseCell& use)
  : releases_(releases)
  , use_(use)
{
  for (const auto& [iteration, count] : releases)
  {
    all_ += double(count);
    squaredReleases_ += double(count) * double(count);
  }
}

void CellSummarizer::begin(std::uint32_t cell)
{
  summary_ = {};
  summary_.cell = cell;
  angles_ = 0;
  angleLeast_ = Passage::kAngleSteps;
  counts_.clear();
  for (std::vector<double>& list : values_)
  {
    list.clear();
  }
}

void CellSummarizer::add(const Passage& passage)
{
  const auto name = [&passage]
  {
    return "iteration " + std::to_string(passage.iteration) + ", rock " +
      std::to_string(passage.rock) + " (block " + std::to_string(passage.blockId) + ")";
  };
  if (any_ && !(last_ < passage))
  {
    throw DataError(passage < last_ ? "The passages are not in their order at " + name()
                                    : "The trajectory of " + name() +
          " is there twice: a run was given twice, or two runs have "
          "the same iterations and block ids");
  }
  if (any_ && last_.cell != passage.cell)
  {
    this->finish();
  }
  if (!any_)
  {
    this->begin(passage.cell);
  }
  if (counts_.empty() || last_.iteration != passage.iteration)
  {
    const auto released = releases_.find(passage.iteration);
    if (released == releases_.end())
    {
      throw DataError("There is a passage of " + name() + ", but nothing was released in it");
    }
    counts_.push_back({ 0.0, double(released->second) });
  }
  ++counts_.back().rocks;
  if (counts_.back().rocks > counts_.back().released ||
    std::int64_t(summary_.passages) + passage.entries > std::numeric_limits<int>::max())
  {
    throw DataError("Cell " + std::to_string(passage.cell) + " has more passages than can be: " +
      name() + " is one too many of the " + std::to_string(std::int64_t(counts_.back().released)) +
      " rocks that were released, or came in too often");
  }
  summary_.passages += int(passage.entries);
  summary_.stops += int(passage.stopped);
  ++summary_.rocks;
  angles_ += passage.angle;
  angleLeast_ = std::min<std::uint32_t>(angleLeast_, passage.angle);
  for (std::size_t h = 0; h < values_.size(); ++h)
  {
    if (passage.maxima[h] > -std::numeric_limits<double>::infinity())
    {
      values_[h].push_back(passage.maxima[h]);
    }
  }
  last_ = passage;
  any_ = true;
}

void CellSummarizer::finish()
{
  if (!any_)
  {
    return;
  }
  any_ = false;
  const double iterations = double(releases_.size());
  constexpr double step = 90.0 / Passage::kAngleSteps; // degrees
  summary_.angleLeast = step * angleLeast_;
  summary_.angleMean = step * double(angles_) / summary_.rocks;
  const double p = summary_.rocks / all_;
  summary_.reach = p;
  summary_.reachError = binomialError(p, all_);
  // Ratio estimator: n / (n − 1) Σ (kᵢ − p Rᵢ)² / N², also over the iterations with kᵢ = 0.
  double scatter = p * p * squaredReleases_;
  for (const Count& count : counts_)
  {
    scatter += count.rocks * (count.rocks - 2.0 * p * count.released);
  }
  summary_.reachErrorOfIterations = iterations > 1.0
    ? (p < 1.0 ? std::sqrt(std::max(0.0, scatter) * iterations / (iterations - 1.0)) / all_
               : shareLimit(iterations))
    : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t h = 0; h < values_.size(); ++h)
  {
    summary_.statistics[h] = statisticsOf(values_[h]);
  }
  use_(summary_);
}

} // namespace rockfall
