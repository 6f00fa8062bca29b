#pragma once

/// @file
/// Impacts within a substep: what closes faster than the resting speed leaves by Newton's law, and
/// strikes what closes by it in the next impact round. What goes on for too long is a jam, as of a
/// stone that a rock drives into the slope: then it stops what closes, and holds what it has
/// stopped, until nothing closes. So nothing is taken by what opens, which would give energy.

#include "solve/island/softSweep.h"

#include <vector>

namespace rockfall::soft
{

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

class Impacts
{
public:
  Impacts(const Step& step, Movers& movers, Rows& rows, Sweeps& sweeps)
    : step_(step)
    , movers_(movers)
    , rows_(rows)
    , sweeps_(sweeps)
  {
  }

  void begin();     ///< A step of other bodies.
  void setStrips(); ///< Of rows that are arranged anew.

  void forget(std::size_t strip) { rounds_[strip].struck.clear(); }
  /// Whether an impact is under way, or the gap closes as one within so many substeps.
  bool closes(std::size_t row, double substeps) const;
  bool jams(std::size_t row) const;      ///< The row is of a jam and has not opened.
  bool staysOpen(std::size_t row) const; ///< Within the substep, at its speed `before`.
  /// The manifold's rows strike.
  void start(std::size_t manifold, std::size_t strip);
  /// Impacts that are to strike, at a time from the step's beginning (s), and what they set going.
  void strike(double time);

private:
  /// Whether any of its rows does, at its speed now. Rows that do not stay open are idle no more.
  bool isSetGoing(std::size_t manifold, std::vector<std::size_t>& woken);
  double leaves(std::size_t row) const; ///< Speed after an impact, m/s.
  void link();
  std::size_t countStruck() const; ///< Rows that are to strike.
  bool anyCloses() const;          ///< Whether a row that is to strike closes.
  void beginRound(ImpactRound& round);
  void settleAll(std::size_t count);
  bool settle(Impact& impact); ///< Whether the impact changed by more than it is exact to.
  /// Impacts that share rocks, one with the next, give no more than was there: else a share.
  void limitGains();
  void scaleBack(const ImpactRound& round); ///< The rest of a share.
  void book(const ImpactRound& round, double time);
  void note(const Impact& impact, double time);   ///< Speed of the impact, and the rocks it struck.
  void findStruck(std::size_t strip, int number); ///< Rows that close by round `number`.
  void listWoken(std::size_t strip);              ///< Among those that are busy.

  const Step& step_;
  Movers& movers_;
  Rows& rows_;
  Sweeps& sweeps_;
  std::vector<ImpactRound> rounds_;                ///< By strip.
  std::vector<std::size_t> firstOf_, manifoldsOf_; ///< Manifolds of each rock.
  std::vector<int> joined_;                        ///< By mover, whom impacts join it to.
  std::vector<ImpactEnergy> energies_;             ///< By mover, of those that are joined to it.
  bool linked_ = false;
  bool jammed_ = false; ///< Generations do not end by themselves: a jam stops.
};

} // namespace rockfall::soft
