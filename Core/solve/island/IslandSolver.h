#pragma once

/// @file
/// One step of rocks that touch each other, whatever their number: bodies and contacts in, their
/// motion and forces out.
///
///     solver.begin(request, accept, bodies, contacts);
///     while (solver.asksForALook())
///     {
///       // end(), gap(), force(): where the bodies would be
///       // contacts.push_back(), setGap(), setAbsent(): what was not reckoned with
///       solver.goOn(seen);
///     }
///     outcome = solver.finish();

#include "solve/island/SoftSolver.h"

#include <vector>

namespace rockfall
{

class IslandSolver
{
public:
  /// Of contacts that come without springs (IslandContact::bare).
  PairStiffness stiffness;

  void begin(const StepRequest& request, Accept accept, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts);
  /// Whether it is worth a look where the bodies would be.
  bool asksForALook() const { return looking_ && seen_.asksFor(look_); }
  /// Goes on from where it is with what a look has found.
  void goOn(const EndDetectionOutcome& seen);
  /// Advances the bodies' states and the contacts by `request.duration`. If the step has not
  /// settled nothing is changed, unless `accept` says so.
  IslandOutcome finish() { return rows_.finish(accept_, seen_.isDeep()); }
  /// All of it, without a look.
  IslandOutcome step(const StepRequest& request, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts, Accept accept)
  {
    this->begin(request, accept, bodies, contacts);
    return this->finish();
  }

  /// What a look finds, and asks for.
  SoftSolver& rows() { return rows_; }
  const SoftSolver& rows() const { return rows_; }

private:
  SoftSolver rows_;
  // Of the step at hand.
  Accept accept_ = Accept::Settled;
  EndDetectionOutcome seen_;
  int look_ = 0;         ///< Number of the next look.
  bool looking_ = false; ///< The last look has left something to solve for.
};

} // namespace rockfall
