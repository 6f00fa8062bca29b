#pragma once

#include "rock/parameters.h"

namespace rockfall::testing
{

/// A run of rigid rocks over so many seconds.
inline SimulationParameters rigidFor(double seconds)
{
  SimulationParameters p;
  p.endTime = seconds;
  p.rigid = true;
  return p;
}

} // namespace rockfall::testing
