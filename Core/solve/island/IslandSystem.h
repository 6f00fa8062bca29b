#pragma once

/// @file
/// The equations of one step of an island, and their solution as far as it has come.

#include "solve/island/island.h"
#include "solve/step/StepSolver.h"

#include <vector>

namespace rockfall
{

class IslandSystem
{
public:
  virtual ~IslandSystem() = default;

  /// Sets the equations up and solves them. Bodies and contacts stay where they are until `finish`.
  virtual void begin(const StepRequest& request, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts) = 0;
  virtual bool hasSolution() const = 0; ///< Whether there is a solution to look at.
  /// Whether bodies have gone far since they were looked at last.
  virtual bool needsRecheck() const = 0;
  /// What has been found is to be solved for from here on: contacts behind those that are known,
  /// whose `distance` is that at the end, the rest of them as all stands at the start.
  virtual void append() = 0;
  virtual void noteDetection() = 0; ///< The bodies have been looked at where they are now.
  virtual void solve() = 0;         ///< Again.
  /// Writes bodies and contacts if the solution is accepted. `deep`: the last look found rocks deep
  /// in each other.
  virtual IslandOutcome finish(Accept accept, bool deep) = 0;

  // What the solution says, by numbers of bodies and contacts.
  virtual BlockState end(std::size_t body) const = 0;  ///< At the end of the step.
  virtual bool moved(std::size_t body) const = 0;      ///< Since the last look.
  virtual double gap(std::size_t contact) const = 0;   ///< At the end of the step, m.
  virtual double force(std::size_t contact) const = 0; ///< Along the normal, N.
  /// The gap is found to be another one (m). No contact is asked to open further than it was.
  /// Returns whether this changes anything.
  virtual bool setGap(std::size_t contact, double found) = 0;
  /// Lets a contact go or sets it in again, as its `absent` says.
  virtual void setAbsent(std::size_t contact) = 0;
};

} // namespace rockfall
