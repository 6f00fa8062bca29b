#pragma once

/// @file
/// The impact of one rock on the slope that is under way: from the first touch until the rock takes
/// off or settles. When it is over it is booked as an event, restitution of its velocity is applied,
/// and the ground's next deviates are drawn.
///
/// In ground that yields an impact lasts as long as the rock is in its scar, where it may hit the
/// hard surface Λ several times. Each hit breaks the rock by itself, or not, when the rock takes off
/// from Λ.

#include "rock/parameters.h"
#include "rock/parts/Recorder.h"
#include "rock/parts/RockBody.h"
#include "terrain/Surface.h"

#include <algorithm>

namespace rockfall
{

class SlopeImpact
{
public:
  /// `number`: of the rock in its iteration. `impulses`: impacts are events in no time, after which
  /// others may go on.
  SlopeImpact(const Surface& surface, const SimulationParameters& parameters, std::uint32_t number,
    bool impulses)
    : surface_(surface)
    , parameters_(parameters)
    , number_(number)
    , impulses_(impulses)
  {
  }

  /// Key of the deviates of the ground at a place, now.
  GroundTouch touchAt(std::int64_t cfe, const Vec3& place) const
  {
    return { cfe, place, number_, impactsOver_ };
  }
  bool pending() const { return pending_; }
  /// The one that is under way, if there is one.
  const ImpactEvent* underWay() const { return pending_ ? &event_ : nullptr; }
  const ImpactEvent& last() const { return event_; } ///< The last impact, over or not.
  /// Time of a spring that stops the rock and throws it back, s.
  double duration(const RockBody& body) const;

  /// Begins one at this state. `frictionBefore`, `restitutionBefore`: what they had taken until
  /// then, J.
  void begin(
    const RockBody& body, const BlockState& at, double frictionBefore, double restitutionBefore);
  /// A touch at this time (s) goes on with the last impact if that is an event in no time, and
  /// springs would still be pressed together: what they take for one is one. Whether it does.
  bool resume(const RockBody& body, double time, Recorder& recorder);
  /// A step of contact of `h` (s) from `start` to where the body is.
  void follow(const RockBody& body, const BlockState& start, double h, const StepOutcome& outcome,
    Recorder& recorder);

  // What is told of it while it is under way

  void noteApproach(double speed) { event_.approachSpeed = std::max(event_.approachSpeed, speed); }
  /// `force` (N): the largest one tells where the impact was.
  void addImpulse(const Vec3& impulse, double force, std::int64_t cfe, const Vec3& place);
  void noteScar(double depth, double length);
  /// Λ sinks under a contact of this rock: a hit begins, and an impact that begins with it is there.
  void noteSink(const RockBody& body, const Contact& under);
  /// The rock is off Λ, but in the scar.
  void takeOff(RockBody& body, Recorder& recorder);
  /// For how long it has been under way, s.
  double age(double time) const { return time - event_.time; }
  /// Others' deviates from here on, in the same impact.
  void drawAnew() { ++impactsOver_; }

  /// An event, if it is one. `over`: else the rock's time ends in the middle of it, and it leaves
  /// nothing of its speed. `told`: the samples before and after it are the caller's.
  void finish(RockBody& body, Recorder& recorder, bool over = true, bool told = false);

private:
  /// One against the hard surface.
  struct Hit
  {
    bool underWay = false;
    Vec3 velocity = Vec3::Zero(); ///< Before, m/s.
    Vec3 impulse = Vec3::Zero();  ///< Normal, N s, world.
    double largestForce = 0.0;    ///< N
    std::int64_t cfe = 0;         ///< Where that was.

    void add(const Vec3& by, double force, std::int64_t on);
  };

  bool isWorthAnEvent(const RockBody& body) const;
  void beginHit(const BlockState& at);
  Vec3 hitNormal() const;
  bool breaks(const RockBody& body) const; ///< Whether the hit breaks the rock.

  const Surface& surface_;
  const SimulationParameters& parameters_;
  std::uint32_t number_;
  /// Touches that began as impacts and are over, and hops in a scar that come late.
  std::uint32_t impactsOver_ = 0;
  bool impulses_;
  bool pending_ = false;
  bool slowed_ = false;    ///< The velocity has been scaled for it.
  double lastTouch_ = 0.0; ///< s
  Hit hit_;
  std::uint32_t hitsOver_ = 0; ///< Of the impact.
  ImpactEvent event_;
  Vec3 normalImpulse_ = Vec3::Zero(); ///< N s, world.
  double largestForce_ = 0.0;         ///< N
  double frictionBefore_ = 0.0;       ///< Friction work when it began, J.
  double restitutionBefore_ = 0.0;    ///< Taken by restitution until then, J.
  double yieldedBefore_ = 0.0;        ///< Taken by scars and rolling resistance, J.
};

} // namespace rockfall
