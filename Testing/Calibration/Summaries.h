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
  Kept kept(int) const override { return { Retention::Nothing, false }; }
  void consume(Trajectory&& t) override { all.push_back(t.summary); }

  std::vector<TrajectorySummary> all;
};

} // namespace rockfall::calibration
