#include "run/retention.h"

namespace rockfall
{

std::vector<std::size_t> keptSamples(const std::vector<Sample>& samples, Retention retention)
{
  std::vector<std::size_t> kept;
  if (retention == Retention::Nothing)
  {
    return kept;
  }
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    const bool first = k == 0, last = k + 1 == samples.size();
    bool keep = retention == Retention::Full || last;
    if (retention == Retention::Thinned)
    {
      keep = keep || first || samples[k].kind != SampleKind::Even;
    }
    else if (retention == Retention::Events)
    {
      // In contact there are knots, too, where the motion changes.
      const bool knot =
        samples[k].kind == SampleKind::Knot || samples[k].kind == SampleKind::EvenKnot;
      keep = keep || first || (knot && !samples[k].contact);
    }
    if (keep)
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
