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

#include "system/CrowdSolver.h"
#include "system/NewtonSolver.h"

#include <vector>

namespace rockfall
{

/// How the linear systems are solved.
enum class IslandMethod : std::uint8_t
{
  Suited,    ///< Direct up to a size, iterative beyond.
  Direct,    ///< Elimination of K's blocks.
  Iterative, ///< Gauss–Seidel over the contacts of a lasting step (system/CrowdSolver.h).
};

class IslandSolver
{
public:
  IslandMethod method = IslandMethod::Suited;
  /// Share of the largest displacement to which Gauss–Seidel goes.
  double tolerance = 1e-4;
  int maxSweeps = 6;
  /// Of contacts that come without springs (IslandContact::bare).
  PairStiffness stiffness;

  /// Whether a step is solved by Gauss–Seidel from the start.
  bool isSwept(StepKind kind, std::size_t bodies) const;

  void begin(const StepRequest& request, Accept accept, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts);
  /// Whether it is worth a look where the bodies would be.
  bool asksForALook() const;
  /// Goes on from where it is with what a look has found.
  void goOn(const LookOutcome& seen);
  /// Advances the bodies' states and the contacts' springs by `request.duration`. If open–close
  /// has not settled nothing is changed, unless `accept` says so.
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
  void sweep(); ///< From the start.
  void sweepIfUnsettled();

  NewtonSolver newton_;
  CrowdSolver crowd_;
  // Of the step at hand.
  IslandSystem* system_ = &newton_;
  StepRequest request_;
  Accept accept_ = Accept::Settled;
  std::vector<IslandBody>* bodies_ = nullptr;
  std::vector<IslandContact>* contacts_ = nullptr;
  LookOutcome seen_;
  int look_ = 0;           ///< Number of the next look.
  bool looking_ = false;   ///< The last look has left something to solve for.
  bool unsettled_ = false; ///< Newton's iteration has not settled.
  int iterations_ = 0;     ///< Then: what it took.
};

} // namespace rockfall
