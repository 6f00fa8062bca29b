#pragma once

/// @file
/// A lasting step of many rocks that touch each other: open–close iteration as projected
/// Gauss–Seidel over the contacts, in their own three directions.
///
/// The same unknowns, springs and integration as in solve/island/IslandSolver.h, which uses this
/// for what is too large to eliminate. Contacts lie in memory as the sweeps meet them
/// (solve/island/crowdKernel.h), and nothing else of them is kept. Most contacts of a crowd are open
/// and stay so: they are speculative, stay out of the sweeps, and are made ready when they close.

#include "base/cache.h"
#include "base/parallel.h"
#include "law/settings.h"
#include "solve/island/IslandSystem.h"
#include "solve/island/PairSprings.h"
#include "solve/island/crowdKernel.h"
#include "solve/step/StepSolver.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace rockfall
{

class CrowdSolver final : public IslandSystem
{
public:
  /// Sets the equations up, as if the step lasted, and sweeps.
  void begin(const StepRequest& request, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts) override;
  bool hasSolution() const override { return !work_.empty(); }
  bool needsRecheck() const override;
  void append() override;
  void noteDetection() override;
  void solve() override;
  IslandOutcome finish(Accept accept, bool deep) override;

  BlockState end(std::size_t body) const override;
  bool moved(std::size_t body) const override { return work_[body].moved; }
  double gap(std::size_t contact) const override;
  double force(std::size_t contact) const override { return this->forceOf(rows_[contact])[0]; }
  bool setGap(std::size_t contact, double found) override;
  void setAbsent(std::size_t contact) override;

  /// Share of the largest displacement to which the sweeps go.
  double tolerance = 1e-4;
  int maxSweeps = 6;
  PairStiffness stiffness; ///< See IslandSolver.

private:
  static constexpr int kNever = -2; ///< A sweep before all others.

  /// World axes. A rotation over the step is the Cayley vector of its turn.
  struct Work
  {
    Mat3 rotation;           ///< At the start.
    Mat3 turned;             ///< As turned for which levers and loads hold, and at last as solved.
    Mat3 mean;               ///< ½ (I + turned): a material vector, averaged over the step.
    Quat turn;               ///< Of `turned`.
    Vec3 position;           ///< Of the centroid at the start.
    Vec3 displacement, spun; ///< Displacement and Cayley vector.
    Vec3 velocity0, spin0;
    Vec3 offset, spinOffset; ///< Velocity at the end is displacement/h + offset.
    double inverseMass;      ///< h²/m
    std::size_t mover;       ///< Among movers_.
    bool moved;              ///< Since the last look.
    Mat3 inverseInertia;     ///< h² I⁻¹
  };
  /// The part of a contact that is not in its lane of a batch.
  struct Row
  {
    int batch = 0; ///< ~i: it is speculative, in fours i.
    int lane = 0;
    double gap0 = 0.0; ///< Without what a bounce asks for, m.
    bool isSpeculative() const { return batch < 0; }
    std::size_t fours() const { return std::size_t(~batch); }
  };

  static Vec3 laneOf(const double (&of)[3][crowd::kLanes], int lane)
  {
    return { of[0][lane], of[1][lane], of[2][lane] };
  }
  Vec3 forceOf(const Row& row) const ///< Along the normal and the tangents, N.
  {
    return row.isSpeculative() ? Vec3(Vec3::Zero())
                               : laneOf(forces_[std::size_t(row.batch)].along, row.lane);
  }
  void prepareBodies(const StepRequest& request, const std::vector<IslandBody>& bodies);
  void turnAs(Work& work, const Vec3& spun) const; ///< turned, mean and turn.
  /// Where a body goes without contacts, for the turn that it has.
  std::array<Vec3, 2> freeMotion(const IslandBody& body, const Work& work) const;
  /// Movers in order, and the number of strips.
  void lineUp(const std::vector<IslandBody>& bodies);
  void arrange(const std::vector<IslandContact>& contacts); ///< Batches of each strip.
  /// The rocks whose contacts a batch will hold.
  struct Hand
  {
    explicit Hand(int slope);
    /// A batch of contacts that do nothing as yet.
    template <class Of>
    Of idle() const;
    int body[2][crowd::kLanes]; ///< Movers.
    int filled = 0;             ///< Lanes.
  };
  /// Deals contacts out to batches; `slope`: the mover that stands for it.
  void deal(const std::vector<IslandContact>& contacts, const int* first, const int* last,
    int slope, std::vector<Hand>& hands);
  void layOutSpeculative(const std::vector<IslandContact>& contacts, int strip, int slope);
  /// visit(strip): every second strip, the others, and what reaches further, or backwards. Strips
  /// that are visited at the same time share no rock.
  template <class Visit>
  void forStrips(bool backwards, Visit&& visit) const;
  /// visit(row) of a strip, without those that were appended.
  template <class Visit>
  void forRows(int strip, Visit&& visit) const;
  /// The same where contacts themselves are read or written: they are asked for ahead.
  template <class Visit>
  void forContacts(int strip, Visit&& visit) const;
  std::size_t firstOf(std::size_t key) const { return key == 0 ? 0 : ends_[key - 1]; }
  /// Batches of a strip that hold any contact: go(the first, how many), by kind.
  template <class Go>
  void forUsed(int strip, Go&& go) const;
  void prepareRow(const std::vector<IslandBody>& bodies, const IslandContact& asked, Row& row);
  void stiffen(const IslandContact& asked, const Row& row); ///< A contact that bounces.
  void askGap(const IslandContact& asked, const Row& row);  ///< Of its lane of a batch.
  /// Directions and levers at mid-step.
  void lever(const std::vector<IslandBody>& bodies, const IslandContact& asked, const Row& row);
  void assemble(std::size_t first, std::size_t count); ///< Batches: what forces do along levers.
  void pushed(const Row& row, double sign);            ///< Movers by the row's force.
  const Work* workOf(const Row& row, int side) const;  ///< Null: the slope.
  Vec3 leverOf(const Row& row, int side) const;        ///< m
  /// Of the first rock's point of force less the second one's, as the sweeps have it, m.
  Vec3 displacementOf(const int (&body)[2][crowd::kLanes],
    const double (&lever)[2][3][crowd::kLanes], int lane) const;
  /// Of a rock's point of force at the mean of the velocities before and after the step, m.
  Vec3 meanDisplacementOf(const Row& row, int side) const;
  double opened(const Row& row) const; ///< Along the normal, m.
  Vec3 travel(const Row& row) const;   ///< Along the normal and the tangents, m.
  /// Velocities before and after the step along the normal and the tangents, m/s.
  std::array<Vec3, 2> velocities(const Row& row) const;
  void startMover(const IslandBody& body, std::size_t i);
  void startMovers(const std::vector<IslandBody>& bodies); ///< As if there were no contacts.
  /// All rows, and what they do to the movers to begin with.
  void prepareRows(
    const std::vector<IslandBody>& bodies, const std::vector<IslandContact>& contacts);
  /// Turns that were guessed wrong, and the levers that go with them.
  bool correctTurns(
    const std::vector<IslandBody>& bodies, const std::vector<IslandContact>& contacts);
  /// Lanes for further contacts: those that are still empty in batches of their strip, or else in
  /// batches behind all others. `fresh_` are the batches that they are in.
  void findLanes(const std::vector<IslandContact>& contacts, const std::vector<int>& added);
  bool findEmptyLane(const IslandContact& contact, Row& row);
  void appendBatches(const std::vector<IslandContact>& contacts, const std::vector<int>& added);
  void assembleFresh();
  /// The strip that a contact belongs to.
  int stripOf(const IslandContact& contact) const;
  void noteChange(const IslandContact& contact); ///< Contacts of its rocks are to be visited.
  /// Makes speculative contacts ready that are closed where the rocks go now; whether there were
  /// any. `sweep` is the next one.
  bool closeSpeculative(int sweep);
  void setSprings(const IslandContact& contact) const; ///< Of one that comes without.
  double visit(int strip);
  double sweep();
  /// Sweeps until none changes anything by more than `goal`, m; whether they get there.
  bool sweepTo(double goal, int most, bool conjugate, IslandOutcome& outcome);
  /// A run of sweeps over everything, or around what has changed; whether all has settled.
  bool sweeps(int most, bool everywhere, IslandOutcome& outcome);
  void begin();                ///< Before the first of a run of sweeps.
  void extrapolate();          ///< Between two sweeps of a run: along a conjugate direction,
  void extrapolate(int strip); ///< and the forces of a strip that is swept next.
  /// Sweeps, and again as long as bounces give energy.
  void settle(
    int most, bool everywhere, std::vector<IslandContact>& contacts, IslandOutcome& outcome);
  bool holdBounces(std::vector<IslandContact>& contacts); ///< Whether any gives energy.
  void collect();                                         ///< Displacements from movers.
  bool isNear(const Vec3& a, const Vec3& b) const
  {
    return (a - b).cwiseAbs().maxCoeff() <= kQuiet * enough_;
  }
  void goTo(Work& work, const Vec3& displacement) const
  {
    work.moved = work.moved || !this->isNear(work.displacement, displacement);
    work.displacement = displacement;
  }
  void sweepAndCorrect(bool everywhere); ///< Sweeps, and again with turns that were guessed wrong.
  void write();

  double h_ = 0.0, gravity_ = 0.0;
  std::vector<Work> work_;
  /// Of each body, where it was looked at last.
  struct Seen
  {
    Vec3 displacement, spun;
    double radius; ///< m
  };
  std::vector<Seen> seen_;
  std::vector<Row> rows_;
  std::vector<ContactBooks> books_; ///< Out, by row.
  std::vector<crowd::Batch> batches_;
  std::vector<crowd::Springs> springs_; ///< Of each batch.
  std::vector<crowd::Forces> forces_;   ///< Of the contacts of each batch.
  std::vector<int> filled_;             ///< Lanes of each batch that hold a contact.
  std::vector<crowd::Speculative> speculative_;
  std::vector<int> speculativeContacts_; ///< By fours and lane; −1: none.
  std::vector<int> speculativeStarts_;   ///< First fours of each strip.
  std::vector<unsigned char> closes_;
  int checked_ = 0; ///< Sweep before which speculative contacts were last looked at.
  /// In order along the island's largest extent, so that what threads work on lies apart; the slope
  /// is one more of each strip, which nothing moves.
  std::vector<crowd::Mover> movers_;
  std::vector<std::pair<double, int>> line_; ///< Place along the island and body, by mover.
  std::vector<int> changed_;
  // Strips lie across the island, and contacts belong to the lower strip of their two rocks: those
  // of every second strip share no rock, and are swept at the same time. The last strip holds
  // what reaches further than to the next strip, and what turns up while the sweeps go on
  // (speculative contacts that close, and those of a second look) if no batch of its strip has an
  // empty lane for it. In each strip contacts between rocks come before those with the slope, but
  // in the last one they are mixed; what is speculative is swept by none.
  static constexpr int kKinds = 3;
  enum Kind
  {
    Pairs,
    OnSlope,
    Speculative,
  };
  int strips_ = 1;
  std::vector<std::vector<Hand>> hands_; ///< Of each strip.
  std::vector<char> wrong_; ///< By contact, whether a rock of it has turned otherwise than guessed.
  std::vector<std::size_t> bouncing_; ///< Contacts that are to leave with some speed.
  std::vector<char> gives_;           ///< Of these, whether the bounce gives energy.
  std::vector<char> turned_;          ///< By batch, whether it holds such a contact.
  std::vector<int> touched_;          ///< Bodies.
  std::vector<int> closing_;          ///< Speculative contacts that have closed,
  std::vector<int> left_;             ///< and those for which there is no empty lane.
  std::vector<int> fresh_;            ///< Batches with contacts that are new in them.
  std::vector<int> keyOf_, order_;    ///< Contacts: strip and kind; in order of it.
  // Of each strip and kind: its first batch, and where the contacts are that are swept, the end of
  // those batches that hold any and the first one that may have an empty lane.
  std::vector<int> starts_, used_, room_;
  std::vector<std::size_t> ends_;   ///< Behind the last contact of each strip and kind in `order_`.
  std::vector<std::uint32_t> open_; ///< By mover: the batches being filled that hold it.
  std::vector<double> most_;        ///< Largest change, by strip.
  // Of the run of sweeps at hand: what it was before the last sweep, and the direction
  // in which it goes on, by batch and by mover.
  std::vector<crowd::Forces> forcesBefore_, forcesAlong_;
  std::vector<crowd::Motion> before_, along_;
  std::vector<double> changes_; ///< By share of the movers.
  double lastChange_ = 0.0;     ///< Of the sweep before; negative: there was none.
  crowd::Further further_ = {};
  bool goingFurther_ = false; ///< In the sweep at hand.
  const crowd::Kernel* kernel_ = nullptr;
  // Of the step at hand.
  StepRequest request_;
  std::vector<IslandBody>* bodies_ = nullptr;
  std::vector<IslandContact>* contacts_ = nullptr;
  IslandOutcome outcome_;
  bool calm_ = false;        ///< No contact is to leave with some speed.
  int sweepsAllowed_ = 0;    ///< In a run.
  int sweep_ = 0;            ///< Number of the next sweep.
  double scale_ = 0.0;       ///< The longest displacement in the step, m.
  double enough_ = 0.0;      ///< Changes that settle a run, m,
  double unconverged_ = 0.0; ///< those that leave it far from settled,
  double quiet_ = 0.0;       ///< and those that are no reason to visit a contact again.
};

template <class Visit>
void CrowdSolver::forStrips(bool backwards, Visit&& visit) const
{
  const auto visitSecond = [&](int first)
  {
    forEach(
      std::size_t(strips_ - first + 1) / 2, 1, [&](std::size_t k) { visit(first + 2 * int(k)); });
  };
  if (!backwards)
  {
    visitSecond(0);
    visitSecond(1);
    visit(strips_);
  }
  else
  {
    visit(strips_);
    visitSecond(1);
    visitSecond(0);
  }
}

template <class Go>
void CrowdSolver::forUsed(int strip, Go&& go) const
{
  for (const Kind kind : { Pairs, OnSlope })
  {
    const std::size_t key = std::size_t(strip * kKinds + kind);
    go(std::size_t(starts_[key]), std::size_t(used_[key] - starts_[key]));
  }
}

template <class Visit>
void CrowdSolver::forRows(int strip, Visit&& visit) const
{
  const std::size_t key = std::size_t(strip * kKinds);
  for (std::size_t k = this->firstOf(key); k < ends_[key + kKinds - 1]; ++k)
  {
    visit(std::size_t(order_[k]));
  }
}

template <class Visit>
void CrowdSolver::forContacts(int strip, Visit&& visit) const
{
  constexpr std::size_t kContactsAhead = 6;
  const std::size_t key = std::size_t(strip * kKinds), end = ends_[key + kKinds - 1];
  for (std::size_t k = this->firstOf(key); k < end; ++k)
  {
    if (k + kContactsAhead < end)
    {
      askCache<sizeof(Contact) / kCacheLine>(
        (*contacts_)[std::size_t(order_[k + kContactsAhead])].contact);
    }
    visit(std::size_t(order_[k]));
  }
}

} // namespace rockfall
