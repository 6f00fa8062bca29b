#pragma once

/// @file
/// A step of rocks that touch each other as soft rows in substeps.
///
/// A contact is a row: a spring pₙ that is damped more than critically, implicit (Macklin et al.
/// 2019, small steps; Catto 2023, soft step), in n substeps of h = Δt/n. Its gap goes on linearly
/// with the motion of the two rocks; its normal and levers are those of mid-step. In each substep:
///
///     impacts   what closes faster than the resting speed and would overlap: Newton's law, by
///               generations, so that what is struck passes it on within the substep
///     gravity
///     warm      the impulses of the last substep
///     press     closed: ΔP = −(m (v + max(β g, −v_r)) + s P) / (1 + s)
///               open:   ΔP = −m (v + g/h);  P ≥ 0
///     move      turns from the angular momentum
///     relax     P ← max(0, P − m v); friction within μ P + c h; two rocks that push each other
///               at one point only: a moment M ← M − J ω against their turning, within 2/3 μ a P
///
/// with m the effective mass, β = ω / (2 ζ + h ω), ω² = pₙ/m but no more than a quarter of the
/// substep rate, s = m β / (h pₙ), v_r the speed at which overlap goes, and a the radius of the
/// crushed corner (softPivots.cxx). At rest the overlap is P/(h pₙ), as of Shi's spring. Pressing
/// and relaxing go on around rows that change by more than their resting speed.
///
/// The impulse of a row that stopped what closed would throw it back in the next substep, so that
/// such a row begins anew. One that stops something in two substeps in succession carries a load:
/// if it began anew each time, what lies on it would creep for ever.

#include "base/parallel.h"
#include "solve/island/PairSprings.h"
#include "solve/island/island.h"
#include "solve/step/StepSolver.h"

#include <array>
#include <cstddef>
#include <vector>

namespace rockfall
{

class SoftSolver
{
public:
  /// Sets the rows up and solves them. Bodies and contacts stay where they are until `finish`.
  void begin(const StepRequest& request, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts);
  /// Takes up what a look has found: contacts behind those that are known, whose `distance` is that
  /// at the end, the rest of them as all stands at the start.
  void append();
  void noteDetection(); ///< The bodies have been looked at where they are now.
  void solve();         ///< Again.
  /// Writes bodies and contacts if the solution is accepted. `deep`: the last look found rocks deep
  /// in each other.
  IslandOutcome finish(Accept accept, bool deep);

  // What the solution says, by numbers of bodies and contacts.
  BlockState end(std::size_t body) const;                            ///< At the end of the step.
  bool moved(std::size_t body) const { return movers_[body].moved; } ///< Since the last look.
  double gap(std::size_t contact) const;                             ///< At the end of the step, m.
  double force(std::size_t contact) const;                           ///< Along the normal, N.
  /// The gap is found to be another one (m). No contact is asked to open further than it was.
  /// Returns whether this changes anything.
  bool setGap(std::size_t contact, double found);
  void setAbsent(std::size_t contact); ///< Lets go or sets in again, as its `absent` says.

  PairStiffness stiffness; ///< See IslandSolver.

private:
  /// How a rock moves, world axes: what sweeps go over, in one cache line.
  struct alignas(64) Motion
  {
    Vec3 velocity, spin;
    double inverseMass;
    double inverseMoment; ///< Each principal one; 0: they are not all equal.
  };
  /// What else of a rock while it is solved for. World axes.
  struct alignas(64) Mover
  {
    Vec3 displacement, turn; ///< Since the step begins; the turn as a sum of small ones.
    Vec3 start;              ///< Centroid where the step begins, from `origin_`, m.
    bool turned;             ///< So far in the step that its contacts weigh otherwise.
    bool touched;            ///< A contact that lasts has pushed it in the substep,
    bool carried;            ///< one with another rock.
    bool flies;              ///< Nothing has touched it in the step.
    bool moved;              ///< Since the last look.
    double noise;            ///< Speed to which its impacts in the step are exact, m/s.
    double kinetic;          ///< Before contacts that last push it in the substep, J.
    Vec3 momentum;           ///< Angular, about the centroid.
    Mat3 inverseInertia;
    double smallTurn;   ///< Largest one of a substep that a midpoint does, rad.
    double weighedTurn; ///< Largest one of the step within which its contacts weigh the same, rad.
    Quat orientation;
    const Block* block;
    Vec3 seenAt, seenTurn; ///< Displacement and turn at the last look.
  };
  /// A contact while it is solved for, of a point that moves with the rock `a`: what sweeps go
  /// over, in three cache lines.
  struct alignas(64) ContactRow
  {
    int a, b;         ///< Movers; b < 0: the slope.
    bool idle;        ///< Stays open in the substep.
    bool stops;       ///< Stopped what closed: its impulse is not one to go on with.
    bool loaded;      ///< Did so in the last substep: it carries a load.
    double gap;       ///< Now, m.
    double P;         ///< N s
    double mass;      ///< Effective, kg.
    Vec3 normal;      ///< Direction from b to a, at mid-step.
    Vec3 lever;       ///< Arm from a's centroid, at mid-step, m.
    Vec3 leverB;      ///< Arm from b's centroid to that point now, m.
    Vec3 T;           ///< Across, N s.
    double shearMass; ///< Effective, kg.
    double friction;  ///< tan φ
    double cohesion;  ///< N s
    double rate;      ///< β, 1/s
    double softness;  ///< m β / (h pₙ)
    double resting;   ///< Speed below which a touch is no impact, m/s.
    double slide2;    ///< Square of how far its rocks may slide and weigh the same, m².
  };
  /// What else of a row.
  struct ContactRowCold
  {
    bool flipped;   ///< `a` is the contact's second rock.
    double gap0;    ///< Where the step begins, m.
    double spring;  ///< pₙ, N/m
    double before;  ///< Speed along the normal before an impact round, m/s.
    double pending; ///< ≥ 0: speed at which an impact that was under way leaves, m/s.
  };
  /// Rows of the same two rocks.
  struct Manifold
  {
    int a, b; ///< Movers; b < 0: the slope.
    std::size_t first, end;
    int impactRound; ///< Of impacts, in which it was last asked.
    bool busy;       ///< Swept over: rows that are not idle stand where the rocks are.
    bool pivots;     ///< Two rocks that push each other at one point only.
  };
  /// What a manifold that pivots does against its rocks' turning about its point.
  struct Pivot
  {
    Vec3 M;          ///< Impulse of the moment, on a, N m s.
    std::size_t row; ///< Which pushes.
    double inertia;  ///< Effective, kg m².
    double arm;      ///< M within arm · P, m.
  };
  /// A row in a round of impacts.
  struct Impact
  {
    std::size_t row;
    double Q;             ///< Impulse along the normal, N s,
    Vec3 S;               ///< and across.
    Vec3 before, beforeA; ///< Velocities behind it, of both and of a's point alone, m/s.
    double leaves;        ///< m/s
    double stored;        ///< By the spring of one that was under way, J.
    double share = 1.0;   ///< Of its impulse that is given.
  };
  /// A round of impacts, those of a strip.
  struct ImpactRound
  {
    std::vector<std::size_t> struck; ///< Rows that are to strike, in order.
    std::vector<Impact> impacts;
    std::vector<int> moved;         ///< Movers.
    std::vector<std::size_t> woken; ///< Manifolds that the substep has woken.
  };
  /// Works of impacts that share rocks, J.
  struct ImpactEnergy
  {
    double along = 0.0;  ///< Of their impulses along the velocities before.
    double work = 0.0;   ///< Of all.
    double stored = 0.0; ///< By springs of those that were under way.

    double share() const; ///< Factor on the impulses with which they give no more than was there.
  };
  /// What a contact did in the step.
  struct Result
  {
    std::size_t contact;
    Vec3 impulse;        ///< On a, N s.
    double normalWork;   ///< On both, J.
    double workOnA;      ///< On a alone, J.
    double frictionWork; ///< Taken, J.
    double struck;       ///< Greatest speed at which it closed as an impact, m/s.
    double struckAt;     ///< When that was, from the step's beginning, s,
    Vec3 struckPoint;    ///< and where, from `origin_`, m.
  };

  void run(); ///< All substeps, from where the movers start.
  void startMovers();
  double kineticEnergy(std::size_t i) const; ///< J
  /// The slope, which is at rest, gives a rock no energy: not by pressing an overlap out either, at
  /// a speed that friction between two walls turns into a throw.
  void holdEnergy(std::size_t i);
  void startMover(std::size_t i);
  /// Strips across the island: contacts belong to the lower one of their two rocks, and those of
  /// every second strip share no rock.
  void findStrips();
  int stripOf(const IslandContact& contact) const;
  /// Rows in order: by strip, pairs before the slope, those of the same two rocks side by side.
  void arrange();
  void prepareRow(std::size_t contact, ContactRow& row, ContactRowCold& start) const;
  void weigh(std::size_t row); ///< Effective masses where its rocks are now.
  /// The arm of its second rock now. Returns whether its rocks have turned, or slid past each
  /// other, so far that it weighs otherwise.
  bool place(ContactRow& row) const;
  void prepareImpulses(std::size_t row, const IslandContact& contact);
  /// visit(strip), by the calling thread alone if there are only few rows to go over.
  template <class Visit>
  void forStrips(Visit&& visit, std::size_t rows = kRowGrain) const;
  template <class Visit>
  void forBusy(Visit&& visit); ///< visit(row's number) of those that are not idle, strip by strip
  template <class Visit>
  void forRows(const Manifold& manifold, Visit&& visit); ///< The same of its rows.

  void substep(int k);
  void updateGaps(std::size_t strip);          ///< Gaps, books and who strikes.
  void arriveAt(std::size_t row, bool placed); ///< `placed`: it stands where the rocks are.
  void bookForces(std::size_t strip);          ///< The work of impulses behind impacts.
  /// Books an impulse `along` the normal and `across` (N s), whose work is along the mean of the
  /// velocities before and after, of both rocks and of a's point alone (m/s).
  static void book(const ContactRow& row, double along, const Vec3& across, const Vec3& mean,
    const Vec3& meanA, Result& result);
  void warm(std::size_t strip); ///< Goes on with the impulses of the last substep.
  void warm(ContactRow& row);
  void keepPushing(std::size_t strip); ///< Busy manifolds that push; notes their rocks.
  bool solveNormal(ContactRow& row);   ///< Whether by so much that others may change.
  bool relax(ContactRow& row);
  /// Friction under an impulse P (N s) along the normal. Returns by how much it changes, N s.
  static Vec3 solveFriction(ContactRow& row, double P, const Vec3& across);
  static double frictionLimit(const ContactRow& row, double P); ///< N s
  /// Whether a mover (< 0: the slope) has been moved by this sweep or the last one.
  bool moves(int i) const { return i >= 0 && stamp_[std::size_t(i)] >= tick_ - 1; }
  bool stripMoves(std::size_t strip) const; ///< Whether one of its rows' rocks may have been.
  void noteMoved(const Manifold& manifold);
  /// Sweeps over the busy rows, so many times; then over those of rocks that the last sweep has
  /// moved, until no row has changed by more.
  template <class Sweep>
  void sweep(int least, Sweep&& sweepManifold);

  // Moments about points, softPivots.cxx
  void warmPivot(std::size_t manifold);
  /// Whether a manifold pivots: `pushing` of its rows push, `last` the last of them.
  void findPivot(std::size_t manifold, int pushing, std::size_t last);
  void relax(Pivot& pivot);
  void bookPivot(const Pivot& pivot);

  // Impacts, softImpacts.cxx
  /// Whether an impact is under way, or the gap closes as one within so many substeps.
  bool closes(std::size_t row, double substeps) const;
  /// Whether any of its rows does, at its speed now. Rows that do not stay open are idle no more.
  bool startsImpact(std::size_t manifold, std::vector<std::size_t>& woken);
  void startImpact(std::size_t manifold, std::vector<std::size_t>& struck);
  double leaves(std::size_t row) const; ///< Speed after an impact, m/s.
  void link();
  std::size_t countStruck() const; ///< Rows that are to strike.
  void strikeGenerations(double time);
  void beginImpacts(ImpactRound& impactRound) const;
  void settleImpacts(std::size_t count);
  bool settle(Impact& impact); ///< Whether it changed by more than it is exact to.
  /// Impacts that share rocks, one with the next, give no more than was there: else a share.
  void limitGains();
  void scaleBack(const ImpactRound& impactRound); ///< The rest of a share.
  void bookImpacts(const ImpactRound& impactRound, double time);
  void noteImpact(const Impact& impact, double time); ///< Its speed, and the rocks it struck.
  void findStruck(std::size_t strip, int number);     ///< Rows that close by impactRound `number`.
  bool staysOpen(std::size_t row) const; ///< Within the substep, at its speed `before`.
  void listWoken(std::size_t strip);     ///< Among those that are busy.

  double gapOf(const ContactRow& row, const ContactRowCold& start) const;
  double gapOf(std::size_t row) const { return this->gapOf(rows_[row], starts_[row]); }
  static Vec3 speedOf(const ContactRow& row, const std::vector<Motion>& motions);
  static Vec3 speedOfA(
    const ContactRow& row, const std::vector<Motion>& motions); ///< Of a's point alone.
  Vec3 speedOf(const ContactRow& row) const { return speedOf(row, motions_); }
  Vec3 speedOfA(const ContactRow& row) const { return speedOfA(row, motions_); }
  void push(const ContactRow& row, const Vec3& J); ///< J on a, −J on b, N s.
  void push(int mover, const Vec3& J, const Vec3& lever);
  void twist(int mover, const Vec3& moment);             ///< An impulse of a moment, N m s.
  void twist(const ContactRow& row, const Vec3& moment); ///< On a, the opposite on b.
  double mobility(int mover) const; ///< At least that of any of its axes, 1/(kg m²).
  void turn(std::size_t mover);
  static void limitTo(Vec3& T, double most);

  void write(IslandOutcome& outcome);
  void writeContact(std::size_t row);
  void bookContacts(IslandOutcome& outcome);
  void writeBody(std::size_t i);

  Vec3 origin_ = Vec3::Zero(); ///< First rock where the step begins, m.
  double duration_ = 0.0, gravity_ = 0.0;
  double h_ = 0.0; ///< Of a substep, s.
  int substeps_ = 0;
  std::vector<IslandBody>* bodies_ = nullptr;
  std::vector<IslandContact>* contacts_ = nullptr;
  std::vector<Motion> motions_; ///< By body.
  std::vector<Motion> before_;  ///< By body, behind the impacts of the substep.
  std::vector<Mover> movers_;   ///< By body.
  std::vector<ContactRow> rows_;
  std::vector<ContactRowCold> starts_; ///< By row.
  std::vector<Result> results_;        ///< By row.
  std::vector<std::size_t> rowOf_;     ///< By contact.
  std::vector<double> gap0_;           ///< By contact, m.
  std::vector<int> stripOfBody_;
  int strips_ = 1;
  std::vector<Manifold> manifolds_;
  std::vector<Pivot> pivots_;                    ///< By manifold.
  std::vector<std::size_t> firstOfStrip_;        ///< Among manifolds.
  std::vector<std::vector<std::size_t>> busyOf_; ///< By strip, manifolds.
  std::vector<ImpactRound> impactRounds_;        ///< By strip.
  std::vector<int> stampOfStrip_;                ///< The sweep that last moved a rock of its rows.
  std::vector<int> stamp_;                       ///< By mover, the sweep that last moved it.
  int tick_ = 0;                                 ///< Number of the sweep.
  std::vector<std::size_t> firstOf_, manifoldsOf_; ///< Manifolds of each rock.
  std::vector<int> joined_;                        ///< By mover, whom impacts join it to.
  std::vector<ImpactEnergy> impactEnergies_;       ///< By mover, of those that are joined to it.
  /// Books of a rock.
  struct Books
  {
    double slope;     ///< Work of contacts with the slope on it, J.
    double rocks;     ///< Work of other rocks on it, J.
    double held;      ///< In springs on the slope where the step began, J.
    double strongest; ///< Impulse of a contact, N s.
    std::size_t by;   ///< That contact's row.
  };
  std::vector<Books> books_;
  bool linked_ = false;
};

template <class Visit>
void SoftSolver::forStrips(Visit&& visit, std::size_t rows) const
{
  for (const int first : { 0, 1 })
  {
    const std::size_t count = std::size_t(strips_ - first + 1) / 2;
    forEach(count, rows < kRowGrain ? count : 1,
      [&](std::size_t k) { visit(std::size_t(first) + 2 * k); });
  }
}

template <class Visit>
void SoftSolver::forBusy(Visit&& visit)
{
  this->forStrips(
    [&](std::size_t strip)
    {
      for (const std::size_t m : busyOf_[strip])
      {
        this->forRows(manifolds_[m], visit);
      }
    });
}

template <class Visit>
void SoftSolver::forRows(const Manifold& manifold, Visit&& visit)
{
  for (std::size_t k = manifold.first; k < manifold.end; ++k)
  {
    if (!rows_[k].idle)
    {
      visit(k);
    }
  }
}

} // namespace rockfall
