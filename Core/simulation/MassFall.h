#pragma once

/// @file
/// Rocks of one iteration that fall together and hit each other [paper 3.4].
///
/// Time goes on in steps of Δt. In each, rocks that can touch within the step are islands; every
/// island is a system of its own (system/IslandSolver.h), and whatever is alone goes on as if it
/// were the only rock (RockSimulator): flight costs nothing, and without a meeting a stiff rock's
/// displacement is the one that it has without collisions. One that is soft enough to ring in an
/// impact does so only when it falls without collisions.
///
/// Small islands resolve their impacts in time like single rocks. In large ones an impact is an
/// event of one step: what closes leaves with e times its speed of approach (Newton's law of
/// restitution). Islands that have come to rest sleep until something touches them.

#include "contact/pairs.h"
#include "simulation/RockSimulator.h"
#include "simulation/rockContacts.h"
#include "system/IslandSolver.h"

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
  bool advance(); ///< By Δt; false when nothing moves any more.
  double time() const { return time_; }
  int rocks() const { return int(members_.size()); }
  const BlockState& state(int rock) const { return members_[rock]->sim.state(); }
  // Of a rock, so far.
  const std::vector<ImpactEvent>& impacts(int rock) const
  {
    return members_[rock]->sim.trajectory().impacts;
  }
  const TrajectorySummary& summary(int rock) const
  {
    return members_[rock]->sim.trajectory().summary;
  }
  /// Pairs near each other whose axis was ever looked for, by (first, second).
  std::vector<const RockPair*> pairs() const;
  std::span<const Contact> slopeContacts(int rock) const
  {
    return members_[rock]->sim.body().contacts;
  }

  /// Rocks never sleep: for tests of how still a pile stands.
  bool awake = false;
  IslandMethod method = IslandMethod::Suited;
  /// Largest island that resolves its impacts in time; fewer rocks if the smallest of them needs
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
    /// `sim.body().placed` and `body` for where the rock stands, unless they are.
    void stand();
    /// Takes on `end` as where it stands, and returns whether it does.
    bool arrive();

    /// A place from which the rock has not gone far since a time, s.
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

    // Members that the step of a crowd needs lie together, before and behind where `sim` begins.
    Place stayed;
    Place lingered;  ///< The same, further and for longer.
    PlacedBlock end; ///< Of the step at hand, as long as it is being solved.
    PairBody body;
    PairBody endBody;
    double rimTravel = 0.0; ///< Longest displacement about the centroid until then, by its turn, m.
    std::uint64_t carriers = 0; ///< A number for the contacts with others that carry.
    int place = -1;             ///< Among the bodies of its island in the step at hand.
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
    Member* operator[](std::size_t i) { return first_ + i; }
    const Member* operator[](std::size_t i) const { return first_ + i; }
    std::size_t size() const { return all_.size(); }
    Member* begin() { return first_; }
    Member* end() { return first_ + all_.size(); }
    const Member* begin() const { return first_; }
    const Member* end() const { return first_ + all_.size(); }

  private:
    std::vector<Member> all_;
    Member* first_ = nullptr;
  };
  struct Island
  {
    std::vector<int> members;
    std::vector<RockPair*> pairs;
    bool crowd = false; ///< Too large to resolve its impacts in time.
  };
  struct PartOfIsland
  {
    Island island;
    std::vector<std::size_t> sights; ///< Of its pairs (Parting::sights).
  };
  struct Workspace;
  struct Meetings;
  struct Trees;
  struct Parting;

  void comeToRock(const Island& island, std::size_t k) const;

  /// Islands of rocks that may meet within the step: massFallMeet.cxx to massFallIslands.cxx.
  void findIslands(double duration);
  void wake(Member& member);
  void putToSleep(Member& member);
  /// Whether the two have touched within the time that rest takes.
  bool heldLately(const RockPair& pair) const;
  void restAnew(int rock);    ///< As something has gone that it may have lain on or leant on.
  void tellBroken();          ///< Structures that a rock has broken are gone for all.
  bool stays(Member& member); ///< Whether it has been still for long enough.
  bool isCrowd(const Island& island) const;
  bool advanceAll();
  void advanceIsland(const Island& island, double until);
  /// As one system all the way, or only as long as its steps last. Returns the time reached, s.
  double advanceTogether(const Island& island, double until, bool lastingOnly);
  double timeOf(const Island& island, double until) const; ///< s; `until` if all are gone.
  void advanceAlone(Member& member, double until);
  // An island over its step in parts: massFallParts.cxx.
  void advanceParts(const PartOfIsland& part, double from, double until, Parting& parting);
  /// Parts of rocks that may meet each other within a duration (s), and rocks that meet no other.
  std::vector<PartOfIsland> fallApart(const PartOfIsland& whole, double duration, Parting& parting);
  /// Whether it touches all through: no part of it moves by itself.
  bool isOne(const Island& island, Parting& parting) const;
  bool isCarried(const Island& island) const; ///< Whether something carries each of it.
  double gapAlong(const RockPair& pair, const Parting& parting, std::size_t sight) const;
  /// Finds the axis of two rocks where they stand.
  void sight(RockPair& pair, double reach, Parting& parting, std::size_t sight);
  /// How a rock may move within a duration (s) if no other strikes it.
  void foresee(const RockSimulator& sim, double duration, Pace& pace) const;
  double islandStep(const Island& island) const;
  void gatherContacts(const Island& island, double h, Workspace& work);
  static void findPushes(const Island& island, Workspace& work);
  /// Springs on the slope into which others press the rock.
  static void stiffenPressed(RockSimulator& sim);
  void setPairSprings(RockPair& pair, double h);
  /// Springs of a contact in a crowd, whose dashpots are not asked for.
  void setSprings(const RockPair& pair, Contact& contact);
  bool isCalm(const Island& island) const;
  bool mayLast(const Island& island, double h) const;
  double freeTime(const Island& island, double most);
  /// For how long, at most `most`, nothing touches those of a calm island that nothing carries yet.
  /// A lasting step must end before: its contacts are those of where it begins, and what falls or
  /// spins within it would come past them.
  double freeOfFlying(const Island& island, double most, Workspace& work);
  double freeOfSlope(RockSimulator& sim, double most);
  double freeOfEachOther(const RockPair& pair, double gravity) const;
  void fly(const Island& island, double duration);
  void solve(const Island& island, double h, StepKind kind, bool bounces, Workspace& work);
  /// Deep overlaps of the two, before a lasting step.
  void pressOutDeep(RockPair& pair, double h, bool crowd, const Workspace& work);
  /// Gives rocks, pairs and contacts their places in the system; returns how many rocks have one.
  std::size_t layOut(const Island& island, Workspace& work);
  /// No bounce for what meets several (mayBounce).
  void settleBounces(bool lasting, Workspace& work) const;
  /// A contact in a step of `h`, for the solver; between rocks an impact begins with it if it
  /// closes fast.
  IslandContact islandContact(RockPair& pair, const PairMotion& motion, Contact& contact, double h,
    bool bounces, const Workspace& work);
  IslandContact islandContact(const Member& member, Contact& contact, double h, bool bounces) const;
  /// Appends contacts that show only where a step would end. Returns the depth of the deepest, of
  /// the smaller radius; 0: none.
  LookOutcome lookAgain(const Island& island, double h, bool bounces, Workspace& work);
  double lookAtPassed(const Island& island, const Workspace& work) const; ///< LookOutcome::passed
  double lookAtPairs(const Island& island, double h, bool bounces, Workspace& work);
  /// Whether two rocks overlap where the step would end, deeper than a contact of theirs; finds
  /// their axis there.
  bool findMissed(const Island& island, std::size_t p, const Workspace& work);
  /// Contacts of the missed pair of this number.
  double addMissed(const Island& island, std::size_t m, double h, bool bounces, Workspace& work);
  static double smallerRadius(const RockPair& pair, const Workspace& work); ///< m
  /// Gap of a contact where the step would end, without its offset, m.
  static double overlapAt(std::size_t contact, const Workspace& work);
  /// Least of a pair's, at most 0, m.
  static double deepestOf(std::size_t pair, const Workspace& work);
  double lookAtSlope(const Island& island, double h, bool bounces, Workspace& work);
  /// Contacts of a rock with the slope where a step would end: those that are reckoned with, then
  /// those that are not. Returns how many the former are.
  std::size_t touchesOnSlope(const Island& island, std::size_t m, const CandidatePairs& near,
    Workspace& work, std::vector<Contact>& touches) const;
  void add(IslandContact touch, bool bounces, Workspace& work) const;
  // Trees that rocks are driven into within the step: massFallTrees.cxx.
  void standTrees(const Island& island, Workspace& work) const; ///< All of them again.
  /// Whether any was let go, or set in again.
  bool lookAtTrees(const Island& island, double h, Workspace& work) const;
  /// Breaks trees that could not hold a rock in the step that it has gone.
  void fellTrees(const Island& island, std::size_t member, const Workspace& work);
  void applyStep(const Island& island, double h, StepKind kind, Workspace& work);
  // Its parts: a pair, by number among those that touch; contacts that were missed at first; a rock
  // of the island; the axis of a pair where the step ends, if it was looked at there.
  void applyToPair(const Island& island, std::size_t t, double h, StepKind kind, Workspace& work);
  static void bookContact(RockPair& pair, const IslandContact& touch, double h);
  void applyMissed(const Island& island, double h, StepKind kind, Workspace& work);
  void applyToRock(const Island& island, std::size_t k, double h, StepKind kind, Workspace& work);
  void keepAxis(const Island& island, std::size_t p, const Workspace& work);
  /// An impact of the two, unless one is under way; as they were before it, and where (m).
  void beginPairImpact(
    RockPair& pair, const BlockState& first, const BlockState& second, const Vec3& point);
  /// An impact that began within a step of `h`: others drove rocks together that were apart.
  void findKnock(RockPair& pair, const IslandContact& touch, double h);
  /// An event, if it is one. `over`: else time ends in the middle of it, and what the springs hold
  /// is not lost.
  void finishPairImpact(RockPair& pair, bool over = true);
  void closePairBooks(RockPair& pair); ///< Books its losses on the two rocks.
  PairMotion motionOf(const RockPair& pair) const;

  const Surface& surface_;
  const SimulationParameters& parameters_;
  double time_ = 0.0;
  RockContacts contacts_;
  Members members_;
  std::unique_ptr<Meetings> meetings_;
  std::vector<Island> islands_;
  std::vector<int> alone_;
  std::vector<int> order_;    ///< Islands in the order in which they are gone over.
  std::vector<int> islandOf_; ///< By the first rock of an island.
};

} // namespace rockfall
