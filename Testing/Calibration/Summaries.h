#pragma once

/// @file
/// Ends of rocks, for figures that need nothing of their ways.

#include "run/ensemble.h"

#include <vector>

namespace rockfall::calibration
{

/// Summaries of all trajectories.
class Summaries : public TrajectorySink
{
public:
  void trim(Trajectory& t) const override
  {
    t.samples.clear();
    t.impacts.clear();
  }
  void consume(Trajectory&& t) override { all.push_back(t.summary); }

  std::vector<TrajectorySummary> all;
};

} // namespace rockfall::calibration
