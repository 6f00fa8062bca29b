#pragma once

/// @file
/// Turns the states that a rock passes through into samples at even times and a summary.

#include "rock/parameters.h"
#include "rock/parts/RockBody.h"
#include "terrain/Surface.h"

namespace rockfall
{

/// Each sample has the books of energy of the rock as they stand when it is taken.
class Recorder
{
public:
  Recorder(const Surface& surface, const Block& block, const SimulationParameters& p)
    : surface_(surface)
    , block_(block)
    , interval_(p.outputInterval)
    , gravity_(p.gravity)
    , retention_(p.kept.samples)
  {
  }

  /// The first sample, and the energy that all later books start from.
  void begin(const RockBody& body);
  /// Time of the next sample, s.
  double nextTime() const { return double(next_) * interval_; }
  /// Records a sample at exactly this state and moves on to the next time.
  void record(const RockBody& body, const BlockState& at, bool contact);
  /// Records all samples that fall into a step, interpolated (cubic in place, slerp in attitude), and
  /// a knot before it where the motion since the last one is no uniform acceleration. A step that is
  /// none by itself, as the rock was struck within it, is gone through straight.
  void recordBetween(
    const RockBody& body, const BlockState& from, const BlockState& to, bool contact);
  /// A sample at a touch or a take-off.
  void knot(const RockBody& body, bool contact);
  /// Knots on both sides of a change of velocity that takes no time: the first one an instant
  /// before it. What it had until then would else seem to fade since the last knot.
  void beforeJump(const RockBody& body, bool contact);
  void afterJump(const RockBody& body, bool contact);
  /// The record goes on at a later time; in between nothing moved.
  void resume(const RockBody& body);
  /// Follows maxima and path length; call for every state that is reached …
  void follow(const BlockState& state);
  /// … with its energy, where contact may have changed it …
  void follow(const RockBody& body);
  /// … or once for a whole flight, which is fastest at one of its ends.
  void followFlight(const BlockState& from, const BlockState& to);
  /// Adds the last state if it is not at an even time, or the only one; sums the fall up.
  void end(const RockBody& body, bool contact);

  Trajectory& trajectory() { return trajectory_; }
  const Trajectory& trajectory() const { return trajectory_; }

private:
  void addEven(const BlockState& state, bool contact);
  void addKnot(const BlockState& state, bool contact);
  void addEvens(const BlockState& from, const BlockState& to, bool contact);
  /// Samples of a step at its mean velocity, with knots where that of an end is another one.
  void addStraight(const BlockState& from, const BlockState& to, bool contact);
  void addBeforeJump(BlockState state, bool contact);
  void addAfterJump(const BlockState& state, bool contact);
  EnergyAudit auditAt(const RockBody& body, const BlockState& state) const;
  /// Gives samples that have none their audit.
  void audit(const RockBody& body, const BlockState& state);
  bool isAt(double time) const; ///< Whether the last sample is.
  /// Drops the last sample if it is at this time; what a knot in its place is.
  SampleKind knotAt(double time);
  void dropLast();
  /// The last one. What comes before the last but one is there to stay, and only if it is kept.
  void add(const Sample& sample);
  void reach(const BlockState& state);
  Sample makeSample(const BlockState& state, bool contact);
  bool follows(const BlockState& state) const; ///< The last knot's uniform acceleration leads here.

  /// The part of a state that tells whether the motion since then is a uniform acceleration.
  struct Knot
  {
    double time = 0.0;            ///< s
    Vec3 position = Vec3::Zero(); ///< m
    Vec3 velocity = Vec3::Zero(); ///< m/s

    Knot() = default;
    Knot(const BlockState& state)
      : time(state.time)
      , position(state.position)
      , velocity(state.velocity)
    {
    }
  };

  const Surface& surface_;
  const Block& block_;
  double interval_;
  double gravity_;
  Retention retention_;
  double energyAtStart_ = 0.0; ///< Kinetic and potential, J.
  double leastEnergy_ = 0.0;   ///< So far, with springs and what it gave to other rocks, J.
  std::int64_t next_ = 0;
  Vec3 last_ = Vec3::Zero();           ///< The last position reached.
  Knot knot_;                          ///< The last one.
  SampleKind jump_ = SampleKind::Knot; ///< Kind of the sample after a jump.
  /// Place and height of the last sample: that before an impact and that after it are at one.
  struct Height
  {
    Vec3 position = Vec3::Zero();
    Quat orientation = Quat::Identity();
    double overGround = std::numeric_limits<double>::quiet_NaN(); ///< m; none yet
  };
  Height height_;
  std::size_t audited_ = 0; ///< Samples that have their audit.
  Trajectory trajectory_;
};

/// Lowest point of a block over the surface straight below it, m; NaN beyond the slope.
double heightOverGround(const Surface& surface, const Block& block, const BlockState& state);

} // namespace rockfall
