#include "run/stateHash.h"

#include "base/Mixer.h"

namespace rockfall
{

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
  mixer.add(s.impactBits);
  if (s.piece > 0 || s.pieces > 0 || s.finesMass > 0.0)
  {
    mixer.add(s.piece);
    mixer.add(s.pieces);
    mixer.add(s.energy.breaking);
    mixer.add(s.finesMass);
    mixer.add(s.finesEnergy);
  }
  for (const StructureEvent& event : trajectory.structures)
  {
    mixer.add(int(event.outcome));
    mixer.add(event.feature);
    mixer.add(event.time);
    mixer.add(event.position);
    mixer.add(event.kineticEnergy);
    mixer.add(event.energyTaken);
    if (event.heldBefore > 0.0)
    {
      mixer.add(event.heldBefore);
      mixer.add(event.usefulHeight);
    }
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
