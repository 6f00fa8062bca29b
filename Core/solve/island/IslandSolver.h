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

#include "solve/island/CrowdSolver.h"
#include "solve/island/SoftSolver.h"

#include <vector>

namespace rockfall
{

enum class IslandMethod : std::uint8_t
{
  Soft,  ///< Substeps, impacts within them (solve/island/SoftSolver.h).
  Crowd, ///< One step, swept over by many threads (solve/island/CrowdSolver.h).
};

class IslandSolver
{
public:
  IslandMethod method = IslandMethod::Soft;
  /// Share of the largest displacement to which a crowd's sweeps go.
  double tolerance = 1e-4;
  int maxSweeps = 6;
  /// Of contacts that come without springs (IslandContact::bare).
  PairStiffness stiffness;

  void begin(const StepRequest& request, Accept accept, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts);
  /// Whether it is worth a look where the bodies would be.
  bool asksForALook() const;
  /// Goes on from where it is with what a look has found.
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

  /// What a look finds, and asks for.
  IslandSystem& system() { return *system_; }
  const IslandSystem& system() const { return *system_; }

private:
  SoftSolver soft_;
  CrowdSolver crowd_;
  // Of the step at hand.
  IslandSystem* system_ = &soft_;
  Accept accept_ = Accept::Settled;
  EndDetectionOutcome seen_;
  int look_ = 0;         ///< Number of the next look.
  bool looking_ = false; ///< The last look has left something to solve for.
};

} // namespace rockfall
