#include "rock/retention.h"

namespace rockfall
{

bool isKeptBetween(const Sample& sample, Retention retention)
{
  switch (retention)
  {
    case Retention::Full:
      return true;
    case Retention::Thinned:
      return sample.kind != SampleKind::Even;
    case Retention::Events:
      // In contact there are knots, too, where the motion changes.
      return (sample.kind == SampleKind::Knot || sample.kind == SampleKind::EvenKnot) &&
        !sample.contact;
    default:
      return false;
  }
}

std::vector<std::size_t> keptSamples(const std::vector<Sample>& samples, Retention retention)
{
  std::vector<std::size_t> kept;
  if (retention == Retention::Nothing)
  {
    return kept;
  }
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    const bool first = k == 0 && retention != Retention::StoppingPoints;
    if (first || k + 1 == samples.size() || isKeptBetween(samples[k], retention))
    {
      kept.push_back(k);
    }
  }
  return kept;
}

void thin(Trajectory& trajectory, Retention retention)
{
  if (retention == Retention::Full)
  {
    return;
  }
  std::vector<Sample> samples;
  const std::vector<std::size_t> kept = keptSamples(trajectory.samples, retention);
  samples.reserve(kept.size());
  for (std::size_t k : kept)
  {
    samples.push_back(trajectory.samples[k]);
  }
  trajectory.samples = std::move(samples);
}

} // namespace rockfall
