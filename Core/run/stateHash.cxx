#include "run/stateHash.h"

#include <bit>

namespace rockfall
{

namespace
{

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014): a bijection in which every bit of the
/// input changes every bit of the result with probability one half.
std::uint64_t scramble(std::uint64_t x)
{
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Takes numbers one after the other.
class Mixer
{
public:
  void add(std::int64_t value) { this->add(std::uint64_t(value)); }
  void add(int value) { this->add(std::uint64_t(std::int64_t(value))); }
  void add(double value) { this->add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::uint64_t bits) { state_ = scramble(state_ ^ bits); }
  void add(const Vec3& v)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->add(v[k]);
    }
  }
  std::uint64_t value() const { return state_; }

private:
  std::uint64_t state_ = 0;
};

} // namespace

std::uint64_t motionHash(const Trajectory& trajectory)
{
  const TrajectorySummary& s = trajectory.summary;
  Mixer mixer;
  for (std::int64_t number : { std::int64_t(s.rock), std::int64_t(s.iteration), s.blockId,
         std::int64_t(s.fate), std::int64_t(s.impacts), s.contactSteps, s.openCloseIterations,
         s.cutSteps, s.unsettledSteps })
  {
    mixer.add(number);
  }
  mixer.add(s.start);
  mixer.add(s.stop);
  for (double number : { s.endTime, s.mass, s.volume, s.energy.released, s.energy.kinetic,
         s.energy.strain, s.energy.friction, s.energy.restitution, s.energy.vibration,
         s.energy.damping, s.energy.exchanged })
  {
    mixer.add(number);
  }
  if (!trajectory.samples.empty())
  {
    const Sample& last = trajectory.samples.back();
    mixer.add(last.velocity);
    mixer.add(last.angularVelocity);
    for (int k = 0; k < 4; ++k)
    {
      mixer.add(last.orientation.coeffs()[k]);
    }
  }
  for (const ImpactEvent& impact : trajectory.impacts)
  {
    mixer.add(impact.time);
    mixer.add(impact.position);
    mixer.add(impact.normal);
    mixer.add(impact.cfe);
    mixer.add(impact.impulse);
    mixer.add(impact.approachSpeed);
    mixer.add(impact.velocityBefore);
    mixer.add(impact.velocityAfter);
    mixer.add(impact.energyLoss);
    mixer.add(impact.restitution);
    mixer.add(impact.otherRock);
  }
  for (const StructureEvent& event : trajectory.structures)
  {
    mixer.add(int(event.outcome));
    mixer.add(event.feature);
    mixer.add(event.time);
    mixer.add(event.position);
    mixer.add(event.kineticEnergy);
    mixer.add(event.energyTaken);
  }
  return mixer.value() == 0 ? 1 : mixer.value();
}

void StateHash::add(std::uint64_t hash)
{
  value_ = scramble(value_ ^ hash);
}

std::string StateHash::text() const
{
  std::string digits(16, '0');
  for (int k = 0; k < 16; ++k)
  {
    digits[std::size_t(k)] = "0123456789abcdef"[(value_ >> (60 - 4 * k)) & 15];
  }
  return digits;
}

} // namespace rockfall
