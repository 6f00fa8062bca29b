#pragma once

/// @file
/// A step of rocks that touch each other, whatever their number, as soft rows in substeps: bodies
/// and contacts in, their motion and forces out.
///
///     solver.begin(request, accept, bodies, contacts);
///     while (solver.asksForALook())
///     {
///       // end(), gap(), force(): where the bodies would be
///       // contacts.push_back(), setGap(), setAbsent(): what was not reckoned with
///       solver.goOn(seen);
///     }
///     outcome = solver.finish();
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
/// Around a rock that overlaps the slope by more than a thousandth of r beyond P/(h pₙ), impulses
/// go back to those of *warm* behind the move: overlap goes as place, without a speed or a spring.
///
/// with m the effective mass, β = ω / (2 ζ + h ω), ω² = pₙ/m but no more than a quarter of the
/// substep rate, s = m β / (h pₙ), v_r the speed at which overlap goes, and a the radius of the
/// crushed corner (softPivots.h). At rest the overlap is P/(h pₙ), as of Shi's spring. Pressing
/// and relaxing go on around rows that change by more than their resting speed.
///
/// The impulse of a row that stopped what closed would throw it back in the next substep, so that
/// such a row begins anew. One that stops something in two substeps in succession carries a load:
/// if it began anew each time, what lies on it would creep for ever.

#include "solve/island/softImpacts.h"
#include "solve/island/softPivots.h"
#include "solve/island/softWrite.h"
#include "solve/step/StepSolver.h"

#include <cstddef>
#include <vector>

namespace rockfall
{

/// The step of a solver in its order; what it does to rocks, rows, and impacts is theirs.
class SoftSolver
{
public:
  SoftSolver() = default;
  SoftSolver(const SoftSolver&) = delete; // its parts know each other
  SoftSolver& operator=(const SoftSolver&) = delete;

  /// Springs of contacts that come without (IslandContact::bare).
  void setStiffness(const PairStiffness& stiffness) { step_.stiffness = stiffness; }
  /// Sets the rows up and solves them. Bodies and contacts stay where they are until `finish`.
  void begin(const StepRequest& request, Accept accept, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts);
  /// Whether a look where the bodies would be is worth it.
  bool asksForALook() const { return looking_ && seen_.asksFor(look_); }
  /// The step goes on with what a look has found: contacts behind those that are known,
  /// whose `distance` is that at the end, the rest of them as all stands at the start.
  void goOn(const EndDetectionOutcome& seen);
  /// Advances the bodies' states and the contacts by `request.duration`. If the step has not
  /// settled nothing is changed, unless `accept` says so.
  IslandOutcome finish();
  /// All of it, without a look.
  IslandOutcome step(const StepRequest& request, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts, Accept accept)
  {
    this->begin(request, accept, bodies, contacts);
    return this->finish();
  }

  // What the solution says, by numbers of bodies and contacts.
  BlockState end(std::size_t body) const { return movers_.end(body); } ///< At the end of the step.
  bool moved(std::size_t body) const { return movers_.all[body].moved; } ///< Since the last look.
  /// At the end of the step, m.
  double gap(std::size_t contact) const { return rows_.gapOfContact(contact); }
  double force(std::size_t contact) const; ///< Along the normal, N.
  /// The gap at the end is found to be another one (m): its normal has turned. Returns whether this
  /// changes anything.
  bool setGap(std::size_t contact, double found);
  void setAbsent(std::size_t contact); ///< Lets go or sets in again, as its `absent` says.

private:
  void arrange(); ///< All parts as the rows are now.
  void append();  ///< Takes up contacts that a look has found.
  void run();     ///< All substeps, from where the movers start.
  void substep(int k);
  void updateGaps(std::size_t strip);          ///< Gaps, books and who strikes.
  void arriveAt(std::size_t row, bool placed); ///< `placed`: the row stands where the rocks are.
  /// Begins with the impulses of the last substep, and keeps those of deep rocks as they are now.
  void warm(std::size_t strip);
  void warm(soft::ContactRow& row);
  void keepPushing(std::size_t strip);     ///< Busy manifolds that push; notes their rocks.
  bool solveNormal(soft::ContactRow& row); ///< Whether by so much that others may change.
  void noteDeep(std::size_t row);          ///< A rock that overlaps the slope deeply there.
  bool isDeep(const soft::Manifold& manifold) const; ///< Whether one of its rocks is.
  /// Behind the move, what pressing gave them is taken back. A deep overlap goes as place: else a
  /// rock that is jammed winds up springs, and friction throws it.
  void takeBackPress(std::size_t strip);
  bool relax(soft::ContactRow& row);
  void bookForces(std::size_t strip); ///< The work of impulses behind impacts.

  soft::Step step_; ///< As asked.
  Accept accept_ = Accept::Settled;
  EndDetectionOutcome seen_;          ///< By the last look.
  int look_ = 0;                      ///< Number of the next look.
  bool looking_ = false;              ///< The last look has left something to solve for.
  soft::Movers movers_{ step_ };      ///< The rocks.
  soft::Rows rows_{ step_, movers_ }; ///< Contacts of the rocks.
  soft::Sweeps sweeps_{ rows_ };      ///< Which rows are swept over.
  soft::Pivots pivots_{ step_, movers_, rows_ };
  soft::Impacts impacts_{ step_, movers_, rows_, sweeps_ };
  soft::Writer writer_{ step_, movers_, rows_ };
};

} // namespace rockfall
