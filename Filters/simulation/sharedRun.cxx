#include "simulation/sharedRun.h"

#include "run/packing.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace rockfall::filters
{

namespace
{

/// Trajectories per rank in the first round, and how long a round should take, s: long enough that
/// waiting for the slowest rank costs little, short enough that an abort is soon known to all.
constexpr std::int64_t firstRound = 8;
constexpr double roundTime = 5.0;

/// How many a rank should simulate next, from what the slowest took. The same on all ranks.
std::int64_t nextRound(std::int64_t last, double slowest)
{
  const double fitting = double(last) * roundTime / std::max(slowest, 1e-6);
  return std::clamp(
    std::int64_t(std::min(fitting, 1e9)), std::max<std::int64_t>(1, last / 4), 4 * last);
}

} // namespace

bool runShared(const Ensemble& ensemble, const KeptParts& kept, TrajectorySink* sink,
  const Ranks& ranks, const Progress& progress, const std::string& noMemory)
{
  bool finished = true;
  if (ranks.count() == 1)
  {
    ranks.together([&] { finished = ensemble.run(ensemble.whole(), *sink, progress); }, noMemory);
    return finished;
  }
  const std::int64_t total = ensemble.size();
  std::int64_t perRank = firstRound;
  for (std::int64_t begin = 0; begin < total;)
  {
    const std::int64_t end = std::min(total, begin + perRank * ranks.count());
    PackingSink packed(kept);
    const auto started = std::chrono::steady_clock::now();
    ranks.together(
      [&]
      {
        finished = ensemble.run({ begin + ranks.rank(), end, ranks.count() }, packed,
          [&](double share)
          { return progress((double(begin) + share * double(end - begin)) / double(total)); });
      },
      noMemory);
    const std::vector<int> ok = ranks.gather(finished ? 1 : 0);
    if (std::find(ok.begin(), ok.end(), 0) != ok.end())
    {
      return false;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
    const std::vector<double> times = ranks.gather(took.count());
    const std::vector<std::vector<char>> parts = ranks.collect(std::move(packed.bytes()), noMemory);
    ranks.together(
      [&]
      {
        std::vector<std::span<const char>> parcels(parts.begin(), parts.end());
        for (std::int64_t n = begin; n < end && ranks.rank() == 0; ++n)
        {
          for (std::int64_t left = ensemble.trajectoriesPerUnit(); left > 0; --left)
          {
            Trajectory next = unpack(parcels[std::size_t((n - begin) % ranks.count())]);
            left += next.summary.pieces; // which come behind
            sink->consume(std::move(next));
          }
        }
      },
      noMemory);
    perRank = nextRound(perRank, *std::max_element(times.begin(), times.end()));
    begin = end;
  }
  return true;
}

PushedApart pushedOnAll(const Ensemble& ensemble, const Ranks& ranks)
{
  const PushedApart own = ensemble.pushed();
  const std::vector<double> rocks = ranks.gather(double(own.rocks));
  const std::vector<double> ways = ranks.gather(own.farthest);
  const std::vector<int> passes = ranks.gather(own.passes);
  const std::vector<int> iterations = ranks.gather(int(own.iterations));
  PushedApart all;
  for (std::size_t k = 0; k < rocks.size(); ++k)
  {
    all.add({ std::int64_t(rocks[k]), ways[k], passes[k], iterations[k] });
  }
  return all;
}

} // namespace rockfall::filters
