#pragma once

/// @file
/// One rock on one realisation of the slope, from release to rest: flight in closed form, contact
/// in steps, restitution as events.

#include "contact/ground/candidates.h"
#include "rock/Recorder.h"
#include "rock/Rock.h"
#include "rock/RockBody.h"
#include "rock/Scar.h"
#include "rock/StructuresOnWay.h"
#include "rock/parameters.h"

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace rockfall
{

class PairBody;

/// The fall of a rock alone (`run`), and the same in parts, for rocks that may meet others
/// (World): those bring each other through a step together, and ask each rock for its part.
class SingleRock
{
public:
  SingleRock(const Surface& surface, const Rock& rock, const Block& block,
    const SimulationParameters& p,
    std::uint32_t number = 0); ///< `number` of the rock in its iteration.

  /// Runs to rest, to the edge of the slope or to the end time. Stops earlier if there is a sample
  /// at `enough` (s) or later: what it has by then is as in the whole run, bit for bit, but the
  /// summary is not complete.
  Trajectory run(double enough = std::numeric_limits<double>::infinity());

  // The same in parts.
  void release(); ///< liftOntoGround, begin.
  /// Straight up, at the start, as far as roughness and embankments make it needed.
  void liftOntoGround();
  void begin(); ///< From where it stands.
  /// Up to this time (s) or to the end; `enough` as in `run`.
  void advance(double until, double enough = std::numeric_limits<double>::infinity());
  Trajectory finish();

  RockBody& body() { return body_; }
  const RockBody& body() const { return body_; }
  const BlockState& state() const { return body_.state; }
  bool done() const { return body_.done; }
  Trajectory& trajectory() { return recorder_.trajectory(); } ///< So far.
  const Trajectory& trajectory() const { return recorder_.trajectory(); }
  void end(Fate fate);
  void wake(double time); ///< Goes on after an end, from this time on, s.

  // A step in the hands of others, in the order of its parts.

  /// The block's strain follows its contacts as at rest, without inertia.
  void letStrainFollow();
  void beginContact();        ///< Unless it has begun.
  double travelLimit() const; ///< Longest step in which it goes no further than contacts serve, s.
  double impactStep() const;  ///< Longest step that resolves an impact, s.
  bool isCalm() const;        ///< Contacts that carry neither approach nor part.
  bool clearFor(double duration) const; ///< No ground under the way of a flight.
  /// Whether no ground is within a reach of the rock (m) for sure, among others; looks for how high
  /// it is where that is not known.
  bool isClear(double reach);
  /// The same where it is known, wherever the rock may be.
  bool isClearAt(const Vec3& place, double reach) const
  {
    return heightBound_.isUnder(place, body_.block.radius() + reach);
  }
  const SurfacePatch& patch() const { return patch_; }
  const CandidatePairs& candidates() const { return candidates_; } ///< By ensureCandidates.
  void ensureCandidates(double reach, bool among = false);         ///< `among`: many others.
  /// Candidates of a rock among many others, for where it stands in this step only if there is
  /// nothing but the slope near it; `body` stands there, too. They serve until this thread asks
  /// again.
  const CandidatePairs& stepCandidates(const PairBody& body, const SlopeReach& reach);
  /// Where a step would end, by a way (m), those that would overlap by more than `allowed` (m); in
  /// doubt others, too.
  const CandidatePairs& candidatesAt(const BlockState& end, const PlacedBlock& placed,
    const PairBody& body, double way, double allowed);
  /// Contacts with the slope within `reach` (m). A step of `h` (s) may turn a rock that is held at
  /// a corner onto a face; with 0 no contact is looked for there.
  void findContacts(const CandidatePairs& candidates, double reach, double h);
  /// Contacts of what has slipped through between others, of those that `findContacts` had.
  void guardPenetrations(const CandidatePairs& candidates);
  StructuresOnWay& structures() { return structures_; }
  const StructuresOnWay& structures() const { return structures_; }
  /// Trees that it is about to touch within `h`, presses against or has `hit`, and that cannot hold
  /// it; whether there were any.
  bool breakTrees(double h, std::span<const int> hit = {});
  /// Contacts with those that are gone, and all that hangs on them; `touched`: one of them carried.
  void forgetTrees(bool touched = true);
  bool meetsYielding() const { return yields_; } ///< Some class of the ground does.
  /// Λ sinks under what comes down within a step of `h` (s), or rises with the rock. Whether it
  /// did: contacts and candidates are then out of date.
  bool followScar(double h);
  void closeScar();             ///< The rock is out of the ground.
  void setNewSprings(double h); ///< Gives new contacts their springs and dashpots, for a step of h.
  void setSprings(Contact& contact);
  /// Key of the deviates of the ground at a place, now.
  GroundTouch touchAt(std::int64_t cfe, const Vec3& place) const
  {
    return { cfe, place, number_, impactsOver_ };
  }
  double mechanicalEnergy() const; ///< Without contact springs, J.
  /// Books a step that has been taken from `before` to `state`. `given`: work done on other rocks,
  /// J. `recovers`: loose overlaps go slowly (overlapRecovery.h).
  void commitStep(
    StepKind kind, const StepOutcome& outcome, double energyBefore, double given, bool recovers);
  void flyFree(double duration); ///< Without contacts, through barriers that break.
  /// The impact on the slope that is under way, if there is one.
  const ImpactEvent* impactUnderWay() const { return impact_.pending ? &impact_.event : nullptr; }
  void checkLeft(); ///< Beyond the slope?
  void followRest(double h, bool touching);

  /// Structures that others of its fall have broken are gone for this rock, too. Whether it touched
  /// any.
  bool applyBroken(const StructuresOnWay::Broken& broken);

private:
  /// The impact under way between the first touch and the take-off or settling.
  struct Impact
  {
    bool pending = false;
    bool slowed = false;    ///< The velocity has been scaled for it.
    double lastTouch = 0.0; ///< s
    ImpactEvent event;
    Vec3 normalImpulse = Vec3::Zero(); ///< N s, world.
    double largestForce = 0.0;         ///< N
    double frictionBefore = 0.0;       ///< Friction work when it began, J.
    double restitutionBefore = 0.0;    ///< Taken by restitution until then, J.
    double yieldedBefore = 0.0;        ///< Taken by scars and rolling resistance, J.
  };

  // Flight, SingleRock.cxx
  void flyUntilNear(); ///< Returns when a touch is possible within a few steps, or at the end.
  void advanceInFlight(double duration);
  void checkEnd(double h); ///< Rested, left, or out of time? `h`: time since the last call, s.

  // Structures, atStructures.cxx
  double freeOfObstacles(double duration); ///< For how long, at most this, nothing is touched, s.
  /// Takes a step of `h` back in which it came against trees that cannot hold it, and breaks them.
  bool undoAtTrees(double h);
  /// Goes on along this way (StructuresOnWay); whether it hits one.
  bool passBarriers(const PathPiece& way, double taken);
  void meetBarrier(); ///< The one that it hits, where the rock is.
  /// A held rock comes to rest on a straight way of this length (m), as steep as the ground, with
  /// the speed v √(1 − (x/b)²) of a spring. False, and nothing done, where the way would lead off
  /// the slope or past the end time.
  bool brakeBehindNet(double distance);
  /// The one that it hits, in a step of contact that would go to `end` and in which others have taken
  /// so much (J); returns what this one takes if it breaks.
  double endStepAtBarrier(const BlockState& end, double taken, bool touching);
  void forgetPatch();

  // Contact, contactPhase.cxx
  double stoppingPenalty() const; ///< Stiffness that stops it in time, N/m.
  void stayInContact();           ///< Returns after take-off, at the horizon or at the end.
  void endContact();
  /// Without contacts that carry: relaxes, takes off, or flies as long as nothing can close within
  /// steps of `small` (s). Whether anything was done.
  bool flyFromContact(double small);
  void takeStep(double h, StepKind kind);
  bool mayLast(double h) const; ///< A long, damped step is right.
  /// Overlaps that were found, not made (overlapRecovery.h): deep ones before a lasting step, loose ones
  /// after it.
  void recoverDeepOverlap(double h);
  void recoverOverlap(double h);
  double looseOverlap() const; ///< m
  /// No spring in a deep overlap holds more than those of a rock that lies still and alone. Returns
  /// what it no longer holds, J.
  double limitDeepOverlaps(double loose);
  double settledSpeed() const; ///< Speed that the springs of such a rock could give it, m/s.
  double dampingRatioFor(int ground, double restitution); ///< ζ of a class of ground, now.
  /// Part of a step of `h` that contacts which are closed or close in it allow, s.
  double touchdownStep(double h) const;

  // Impacts as events, impulses.cxx
  /// A point of the rock that touches the ground.
  struct Touch
  {
    Vec3 point;
    Vec3 normal;
    std::int64_t cfe;
  };
  /// Flies by at most `duration` (s) over the window, through impacts on the way's end, if it comes
  /// to one. False: what comes is none that an impulse resolves.
  bool hop(double duration);
  /// A contact that closes within `small` (s) at more than the resting speed: flies to it, and
  /// resolves the impact. Else `first` is when the first one does. Whether anything was done.
  bool strikeSoon(double small, double& first);
  /// One impact at all these points, where the rock is. Whether there was one.
  bool strike(std::span<const Touch> touches, bool carried);
  bool partsFrom(std::span<const Touch> touches) const; ///< Faster than it may rest.

  // Ground that gives way, groundYields.cxx
  const YieldingGround& yieldingOf(int restitutionClass) const;
  const YieldingGround& yieldingAt(const Contact& contact) const; ///< Hard on trees.
  /// S of the ground under the rock, of the class at a contact.
  double softnessAt(const Contact& contact) const
  {
    return surface_.softnessAt(surface_.restitutionClass(contact.cfe), body_.state.position);
  }
  bool sinkUnder(double h);
  bool riseWithRock();
  /// Goes on through soil, over nothing but the slope and far from Λ for steps of `small` (s).
  /// Whether anything was done.
  bool flyOverScar(double small);
  void raiseScar(double by);
  void lowerPatch(double by);           ///< m; < 0: raises it.
  void flyThroughSoil(double duration); ///< As `fly`, braked.
  void plough(double volume);       ///< Takes what a swept volume (m³) takes from speed and spin.
  void forgetSlip(double duration); ///< Time (s) without touch.
  void yieldInStep(double h);       ///< A step of contact from `before` to `state`.

  // Impacts on the slope, slopeImpacts.cxx
  void beginImpact(const BlockState& at, double frictionBefore, double restitutionBefore);
  double impactDuration() const; ///< Of a spring that stops the rock and throws it back, s.
  /// A touch at this time (s) goes on with the last impact if that is an event in no time, and
  /// springs would still be pressed together: what they take for one is one. Whether it does.
  bool resumeImpact(double time);
  bool isWorthAnEvent(const ImpactEvent& event) const;
  void followImpact(const BlockState& start, double h, const StepOutcome& outcome);
  /// An event, if it is one. `over`: else the rock's time ends in the middle of it, and it leaves
  /// nothing of its speed.
  /// `told`: the samples before and after it are the caller's.
  void finishImpact(bool over = true, bool told = false);

  // Ground near the rock, groundNear.cxx
  /// Least and most x and y (m) that a flight comes over.
  std::array<double, 4> boxOfWay(double duration) const;
  void ensureWindow(double duration); ///< Heights under all of the way of a flight.
  /// Lower bound of the time to the first touch of the ground in free flight, s.
  double timeToGround(double duration);
  void ensurePatch(double margin);

  /// Whether the horizon is reached, but for what is too short to be a step.
  bool arrived() const { return body_.state.time >= horizon_ - 1e-9; }
  EnergyAudit auditAt(const BlockState& state) const;
  void auditSamples(const BlockState& state); ///< Gives new samples their audit.

  const Surface& surface_;
  const Rock& rock_;
  const SimulationParameters& parameters_;
  std::uint32_t number_ = 0; ///< In its iteration.
  /// Touches that began as impacts and are over, and hops in a scar that come late.
  std::uint32_t impactsOver_ = 0;
  // In the order of their use in the step of an island, which goes from rock to rock: what it needs
  // lies together, and in one page.
  bool inContact_ = false;
  bool recovering_ = false; ///< A deep overlap is pressed out in the step at hand.
  bool stiff_ = false;      ///< The block's strain follows its contacts without inertia.
  bool yields_ = false;     ///< Some class of the ground does.
  bool impulses_ = false;   ///< Impacts are events in impulse space.
  RockBody body_;
  GroundHeightBound heightBound_;
  double openTime_ = 0.0;      ///< Since it touched, s.
  double horizon_ = 0.0;       ///< Up to which it is to advance, s.
  double penalty_ = 0.0;       ///< pₙ of the contacts that are made now, N/m.
  std::uint64_t carrying_ = 0; ///< The features that carried in the last lasting step.
  StructuresOnWay structures_;
  double energyAtStart_ = 0.0; ///< Kinetic and potential, J.
  Recorder recorder_;
  CandidatePairs candidates_;
  Impact impact_;
  Scar scar_;
  std::vector<Touch> touches_; ///< Of the impact at hand.
  int struckAtOnce_ = 0;       ///< Impacts as events since it last moved on.
  double slip_ = 0.0;          ///< s of the slip-dependent friction, m.
  int touched_ = 0;            ///< Class of the ground that it touched last.
  SurfacePatch patch_;
  HeightWindow window_;
  SurfacePatch holed_;    ///< Under the way of a flight that comes over holes.
  double softness_ = 0.0; ///< Of a contact and the block behind it, m/N.
  double ringing_ = 0.0;  ///< Period of a soft block's slowest strain, 0 for a stiff one, s.
  std::vector<double> dampingRatios_;      ///< ζ by restitution class; < 0: not known yet.
  double dampedFor_ = -1.0, damped_ = 0.0; ///< The restitution looked up last, and its ζ.
  double freeUntil_ = 0.0; ///< Nothing can be touched until then, after a take-off, s.
};

} // namespace rockfall
