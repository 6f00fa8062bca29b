#pragma once

/// @file
/// How soon work is given up that is no longer wanted.

#include "base/abort.h"

#include <atomic>
#include <chrono>
#include <ctime>

namespace rockfall::testing
{

inline constexpr double kWanted = 0.2; // s
inline constexpr double kHeard = 1.0;  // s of processor time, whatever else the machine does

inline double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Work is wanted for kWanted; and the processor time of the process since it last was, s.
class Patience
{
public:
  bool stillWanted()
  {
    const bool wanted = secondsSince(start_) < kWanted;
    if (wanted)
    {
      last_ = std::clock();
    }
    return wanted;
  }
  double spentSince() const { return double(std::clock() - last_) / CLOCKS_PER_SEC; }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<std::clock_t> last_ = std::clock();
};

/// What work spends after it was last wanted until it is given up, s; negative if it ended before.
template <class Work>
double heardAfter(const Work& work)
{
  Patience patience;
  const AbortScope scope([&] { return patience.stillWanted(); });
  try
  {
    work();
  }
  catch (const Aborted&)
  {
    return patience.spentSince();
  }
  return -1.0;
}

} // namespace rockfall::testing
