#include "simulation/motion.h"

#include <algorithm>

namespace rockfall::filters
{

Sample sampleAt(const Trajectory& trajectory, double time)
{
  const std::vector<Sample>& samples = trajectory.samples;
  const auto after = std::upper_bound(samples.begin(), samples.end(), time,
    [](double t, const Sample& sample) { return t < sample.time; });
  if (after == samples.begin())
  {
    return samples.front();
  }
  if (after == samples.end())
  {
    return samples.back();
  }
  const Sample& a = *(after - 1);
  const Sample& b = *after;
  const double s = (time - a.time) / (b.time - a.time);
  const auto mix = [s](const auto& from, const auto& to) { return (1.0 - s) * from + s * to; };
  Sample result;
  result.time = time;
  // The cubic Hermite curve: exact in flight.
  const double h = b.time - a.time, s2 = s * s, s3 = s2 * s;
  result.position = (2.0 * s3 - 3.0 * s2 + 1.0) * a.position +
    (s3 - 2.0 * s2 + s) * h * a.velocity + (3.0 * s2 - 2.0 * s3) * b.position +
    (s3 - s2) * h * b.velocity;
  result.orientation = a.orientation.slerp(s, b.orientation);
  result.velocity = mix(a.velocity, b.velocity);
  result.angularVelocity = mix(a.angularVelocity, b.angularVelocity);
  result.kineticEnergy = mix(a.kineticEnergy, b.kineticEnergy);
  result.heightOverGround = mix(a.heightOverGround, b.heightOverGround);
  for (double EnergyAudit::*term :
    { &EnergyAudit::released, &EnergyAudit::kinetic, &EnergyAudit::strain, &EnergyAudit::friction,
      &EnergyAudit::restitution, &EnergyAudit::vibration, &EnergyAudit::damping,
      &EnergyAudit::structures, &EnergyAudit::scars, &EnergyAudit::rolling, &EnergyAudit::breaking,
      &EnergyAudit::exchanged, &EnergyAudit::numerical })
  {
    result.energy.*term = mix(a.energy.*term, b.energy.*term);
  }
  result.contact = s < 0.5 ? a.contact : b.contact;
  return result;
}

MotionState stateAt(const Trajectory& trajectory, double time)
{
  if (time >= trajectory.samples.back().time)
  {
    if (trajectory.summary.fate == Fate::Rested || trajectory.summary.fate == Fate::Caught)
    {
      return MotionState::Stopped;
    }
    if (trajectory.summary.fate == Fate::LeftDomain ||
      trajectory.summary.fate == Fate::LostInNodata)
    {
      return MotionState::LeftDomain;
    }
  }
  return sampleAt(trajectory, time).contact ? MotionState::InContact : MotionState::Flying;
}

ShownRock momentOf(const Trajectory& trajectory, double time)
{
  return { trajectory.summary.rock, trajectory.summary.iteration, trajectory.summary.volume,
    sampleAt(trajectory, time), int(stateAt(trajectory, time)), trajectory.summary.piece, {} };
}

} // namespace rockfall::filters
