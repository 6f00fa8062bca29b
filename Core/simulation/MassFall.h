#pragma once

/// @file
/// Rocks of one iteration that fall together and hit each other [paper 3.4].
///
/// Time goes on in steps of Δt. In each, rocks that can touch within the step are groups; every
/// group is a system of its own (system/GroupSolver.h), and whatever is alone goes on as if it were
/// the only rock (RockSimulator): flight costs nothing, and without a meeting a stiff rock's way is
/// the one that it has without collisions. One that is soft enough to ring in an impact does so
/// only when it falls without collisions.
///
/// Small groups resolve their impacts in time like single rocks. In large ones an impact is an
/// event of one step: what closes leaves with e times its speed of approach (Newton's law of
/// restitution). Groups that have come to rest sleep until something touches them.

#include "contact/pairs.h"
#include "simulation/RockSimulator.h"
#include "simulation/rockContacts.h"
#include "system/GroupSolver.h"

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace rockfall
{

struct Pace;

class MassFall
{
public:
  MassFall(const Surface& surface, std::span<const Rock> rocks, std::span<const Block> blocks,
    const SimulationParameters& parameters);
  ~MassFall();

  /// All rocks to rest, to the edge of the slope or to the end time: a trajectory for each, in
  /// their order. `goOn` is asked after every step with the time reached (s); false stops, and the
  /// trajectories are then a part.
  std::vector<Trajectory> run(const std::function<bool(double)>& goOn = {});

  // The same in parts.
  void release();
  bool advance(); ///< One step of Δt; false when nothing moves any more.
  double time() const { return time_; }
  int rocks() const { return int(members_.size()); }
  const BlockState& state(int rock) const { return members_[rock]->sim.state(); }
  // Of a rock, so far.
  const std::vector<ImpactEvent>& impacts(int rock) const
  {
    return members_[rock]->sim.recorder_.trajectory().impacts;
  }
  const TrajectorySummary& summary(int rock) const
  {
    return members_[rock]->sim.recorder_.trajectory().summary;
  }
  /// Those near each other whose axis was ever looked for, by (first, second).
  std::vector<const RockPair*> pairs() const;
  std::span<const Contact> slopeContacts(int rock) const { return members_[rock]->sim.contacts_; }

  /// Rocks never sleep: for tests of how still a pile stands.
  bool awake = false;
  GroupMethod method = GroupMethod::Suited;
  /// Largest group that resolves its impacts in time; fewer rocks if the smallest of them needs
  /// more than a hundred steps in one of Δt.
  int resolved = 64;

private:
  struct Member
  {
    Member(const Surface& surface, const Rock& rock, const Block& block,
      const SimulationParameters& parameters, std::uint32_t number)
      : sim(surface, rock, block, parameters, number)
    {
    }
    /// `sim.placed_` and `body` for where the rock stands, unless they are.
    void stand();
    /// Takes on `end` as where it stands, and returns whether it does.
    bool arrive();

    /// Where, and since when, s, it has not gone far from.
    struct Place
    {
      double time = 0.0;
      Vec3 position = Vec3::Zero();        ///< m
      Quat orientation = Quat::Identity(); ///< Body to world.

      Place() = default;
      Place(const BlockState& s)
        : time(s.time)
        , position(s.position)
        , orientation(s.orientation)
      {
      }
    };

    // What the step of a crowd needs of a rock lies together, before and behind where `sim` begins.
    Place stayed;
    Place lingered;  ///< The same, further and for longer.
    PlacedBlock end; ///< Of the step at hand, as long as it is being solved.
    PairBody body;
    PairBody endBody;
    double turned = 0.0;        ///< Longest way about the centroid until then, by its turn, m.
    std::uint64_t carriers = 0; ///< Which contacts with others carry.
    int place = -1;             ///< Among the bodies of its group in the step at hand.
    bool asleep = false;
    RockSimulator sim;
  };
  /// All of them in one piece of memory: a step goes over them again and again, in their order.
  class Members
  {
  public:
    void reserve(std::size_t count) { all_.reserve(count); }
    template <class... Of>
    Member& add(Of&&... of)
    {
      Member& added = all_.emplace_back(std::forward<Of>(of)...);
      first_ = all_.data();
      return added;
    }
    Member* operator[](std::size_t i) const { return first_ + i; }
    std::size_t size() const { return all_.size(); }
    Member* begin() const { return first_; }
    Member* end() const { return first_ + all_.size(); }

  private:
    std::vector<Member> all_;
    Member* first_ = nullptr;
  };
  struct Group
  {
    std::vector<int> members;
    std::vector<RockPair*> pairs;
    bool crowd = false; ///< Too large to resolve its impacts in time.
  };
  struct PartOfGroup
  {
    Group group;
    std::vector<std::size_t> sights; ///< Of its pairs (Parting::sights).
  };
  struct Workspace;
  struct Meetings;
  struct Trees;
  struct Parting;

  void comeToRock(const Group& group, std::size_t k) const;

  /// Who may meet whom within the step: massFallMeet.cxx to massFallGroups.cxx.
  void findGroups(double duration);
  void wake(Member& member);
  void putToSleep(Member& member);
  /// Whether the two have touched within the time that rest takes.
  bool heldLately(const RockPair& pair) const;
  void restAnew(int rock);          ///< As something has gone that it may have lain on or leant on.
  void tellBroken();                ///< What a rock has broken is gone for all.
  bool stays(Member& member) const; ///< Whether it has been still for long enough.
  bool isCrowd(const Group& group) const;
  bool advanceAll();
  void advanceGroup(const Group& group, double until) const;
  /// As one system all the way, or only as long as its steps last. Returns the time reached, s.
  double advanceTogether(const Group& group, double until, bool lastingOnly) const;
  double timeOf(const Group& group, double until) const; ///< s; `until` if all are gone.
  void advanceAlone(Member& member, double until) const;
  // A group over its step in parts: massFallParts.cxx.
  void advanceParts(const PartOfGroup& part, double from, double until, Parting& parting) const;
  /// Those that may meet each other within a duration (s), and those that meet no other.
  std::vector<PartOfGroup> fallApart(
    const PartOfGroup& whole, double duration, Parting& parting) const;
  /// Whether it touches all through: no part of it moves by itself.
  bool isOne(const Group& group, Parting& parting) const;
  bool isCarried(const Group& group) const; ///< Whether something carries each of it.
  double gapAlong(const RockPair& pair, const Parting& parting, std::size_t sight) const;
  /// Finds the axis of two rocks where they stand.
  void sight(RockPair& pair, double reach, Parting& parting, std::size_t sight) const;
  /// How a rock may move within a duration (s) if no other strikes it.
  void foresee(const RockSimulator& sim, double duration, Pace& pace) const;
  double groupStep(const Group& group) const;
  void gatherContacts(const Group& group, double h, Workspace& work) const;
  static void findPushes(const Group& group, Workspace& work);
  /// Springs on the slope into which others press the rock.
  static void stiffenPressed(RockSimulator& sim);
  void armPair(RockPair& pair, double h) const;
  /// One of a crowd, whose dashpots are not asked for.
  void armContact(const RockPair& pair, Contact& contact) const;
  bool isCalm(const Group& group) const;
  bool mayLast(const Group& group, double h) const;
  double freeTime(const Group& group, double most) const;
  /// For how long, at most `most`, nothing touches those of a calm group that nothing carries yet.
  /// A lasting step must end before: its contacts are those of where it begins, and what falls or
  /// spins within it would come past them.
  double freeOfFlying(const Group& group, double most, Workspace& work) const;
  double freeOfSlope(RockSimulator& sim, double most) const;
  double freeOfEachOther(const RockPair& pair, double gravity) const;
  void fly(const Group& group, double duration) const;
  void solve(const Group& group, double h, StepKind kind, bool bounces, Workspace& work) const;
  /// Deep overlaps of the two, before a lasting step.
  void pressOutDeep(RockPair& pair, double h, bool crowd, const Workspace& work) const;
  /// Gives rocks, pairs and contacts their places in the system; returns how many rocks have one.
  std::size_t layOut(const Group& group, Workspace& work) const;
  /// No bounce for what meets several (mayBounce).
  void settleBounces(bool lasting, Workspace& work) const;
  /// What a contact is in a step of `h`; between rocks an impact begins with it if it closes fast.
  GroupContact take(RockPair& pair, const PairMotion& motion, Contact& contact, double h,
    bool bounces, const Workspace& work) const;
  GroupContact take(const Member& member, Contact& contact, double h, bool bounces) const;
  /// Contacts that nobody reckoned with, seen where a step would end: they are appended. Returns
  /// how deep the deepest is, of the smaller radius; 0: none.
  LookOutcome lookAgain(const Group& group, double h, bool bounces, Workspace& work) const;
  double lookAtPassed(const Group& group, const Workspace& work) const; ///< LookOutcome::passed
  double lookAtPairs(const Group& group, double h, bool bounces, Workspace& work) const;
  double lookAtSlope(const Group& group, double h, bool bounces, Workspace& work) const;
  /// Contacts of a rock with the slope where a step would end: those that are reckoned with, then
  /// those that are not. Returns how many the former are.
  std::size_t touchesOnSlope(const Group& group, std::size_t m, const CandidatePairs& near,
    Workspace& work, std::vector<Contact>& touches) const;
  void add(GroupContact taken, bool bounces, Workspace& work) const;
  // Trees that rocks are driven into within the step: massFallTrees.cxx.
  void standTrees(const Group& group, Workspace& work) const; ///< All of them again.
  /// Whether any was let go, or set in again.
  bool lookAtTrees(const Group& group, double h, Workspace& work) const;
  /// Those that a rock has broken in the step that it has absorbed.
  void fellTrees(const Group& group, std::size_t member, const Workspace& work) const;
  void absorb(const Group& group, double h, StepKind kind, Workspace& work) const;
  /// An impact of the two, unless one is under way; as they were before it, and where (m).
  void beginPairImpact(
    RockPair& pair, const BlockState& first, const BlockState& second, const Vec3& point) const;
  /// One that began within a step of `h`: rocks that were apart, and that others drove together.
  void findKnock(RockPair& pair, const GroupContact& taken, double h) const;
  /// An event, if it is one. `over`: else time ends in the middle of it, and what the springs hold
  /// is not lost.
  void finishPairImpact(RockPair& pair, bool over = true) const;
  void closePairBooks(RockPair& pair) const; ///< What it has lost, to the two rocks.
  PairMotion motionOf(const RockPair& pair) const;

  const Surface& surface_;
  const SimulationParameters& parameters_;
  double time_ = 0.0;
  RockContacts contacts_;
  Members members_;
  std::unique_ptr<Meetings> meetings_;
  std::vector<Group> groups_;
  std::vector<int> alone_;
  std::vector<int> turns_;   ///< Groups in the order in which they are gone over.
  std::vector<int> groupOf_; ///< By the first rock of a group.
};

} // namespace rockfall
