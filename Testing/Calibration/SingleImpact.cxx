#include "SingleImpact.h"

#include "rock/fall/SingleRock.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace rockfall::calibration
{

namespace
{

/// How far a ball about a place is over the slope, straight up and at nine places under it, m.
double clearance(const Terrain& terrain, const Vec3& at, double radius)
{
  double least = 1e9;
  for (int i = -4; i <= 4; ++i)
  {
    for (int j = -4; j <= 4; ++j)
    {
      const double dx = 0.25 * i * radius, dy = 0.25 * j * radius;
      const double under = radius * radius - dx * dx - dy * dy;
      if (under >= 0.0)
      {
        const double ground = terrain.elevation(at.x() + dx, at.y() + dy);
        least = std::min(least, at.z() - std::sqrt(under) - ground);
      }
    }
  }
  return least;
}

} // namespace

Rock heldBack(const Terrain& terrain, Rock rock, double gravity)
{
  const Vec3 place = rock.position, velocity = rock.velocity;
  double best = -1e9, since = 0.0;
  for (int k = 0; k <= 100; ++k)
  {
    const double t = 0.005 * k;
    const Vec3 back = place - velocity * t - Vec3(0.0, 0.0, 0.5 * gravity * t * t);
    const double free = clearance(terrain, back, rock.shape.radius());
    if (free > best)
    {
      best = free;
      since = t;
    }
    if (free > 0.01)
    {
      break;
    }
  }
  rock.position = place - velocity * since - Vec3(0.0, 0.0, 0.5 * gravity * since * since);
  rock.velocity.z() += gravity * since;
  return rock;
}

namespace
{

/// Whether nothing but gravity acted between two samples.
bool isFree(const Sample& a, const Sample& b, double gravity)
{
  const Vec3 fall(0.0, 0.0, -gravity * (b.time - a.time));
  return (b.velocity - a.velocity - fall).norm() <= 1e-6 * (1.0 + a.velocity.norm());
}

} // namespace

ImpactOutcome simulateImpact(
  const Terrain& terrain, const Rock& rock, const SimulationParameters& p, int iteration)
{
  const Surface surface(terrain, p.seed, iteration);
  const Block block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
  const Trajectory t = SingleRock(surface, rock, block, p).run();
  const std::vector<Sample>& samples = t.samples;
  ImpactOutcome result;
  std::size_t touch = 0;
  while (touch + 1 < samples.size() && isFree(samples[touch], samples[touch + 1], p.gravity))
  {
    ++touch;
  }
  if (touch + 1 >= samples.size())
  {
    return result;
  }
  result.touched = true;
  const Sample& before = samples[touch];
  // To the first flight that is long enough, or to where time is over.
  std::size_t after = touch + 1;
  for (std::size_t k = touch + 1; k < samples.size(); ++k)
  {
    if (!isFree(samples[k - 1], samples[k], p.gravity))
    {
      after = k;
      result.tookOff = k + 1 == samples.size() && t.summary.fate == Fate::LeftDomain;
    }
    else if (samples[k].time - samples[after].time >= kShortestFlight ||
      (k + 1 == samples.size() && t.summary.fate == Fate::LeftDomain))
    {
      result.tookOff = true;
      break;
    }
    if (samples[k].time - before.time > kLongestImpact)
    {
      break;
    }
  }
  const auto translation = [&](const Sample& s)
  { return 0.5 * block.mass() * s.velocity.squaredNorm(); };
  const Sample& end = samples[after];
  result.energyBefore = translation(before);
  result.energyAfter = translation(end);
  result.spinBefore = before.kineticEnergy - result.energyBefore;
  result.spinAfter = end.kineticEnergy - result.energyAfter;
  result.rateBefore = before.angularVelocity.norm();
  result.rateAfter = end.angularVelocity.norm();
  result.velocityAfter = end.velocity;
  result.duration = end.time - before.time;
  if (!t.impacts.empty())
  {
    result.scarDepth = t.impacts.front().scarDepth;
    result.scarLength = t.impacts.front().scarLength;
  }
  result.way = (end.position - before.position).head<2>().norm();
  return result;
}

std::vector<ImpactOutcome> simulateImpacts(
  const Terrain& terrain, const std::vector<Rock>& rocks, const SimulationParameters& p)
{
  std::vector<ImpactOutcome> results(rocks.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&]
  {
    for (std::size_t k = next++; k < rocks.size(); k = next++)
    {
      results[k] = simulateImpact(terrain, rocks[k], p, int(k));
    }
  };
  const unsigned count = p.threads > 0 ? unsigned(p.threads) : std::thread::hardware_concurrency();
  std::vector<std::jthread> threads;
  for (unsigned k = 1; k < count; ++k)
  {
    threads.emplace_back(work);
  }
  work();
  threads.clear();
  return results;
}

} // namespace rockfall::calibration
