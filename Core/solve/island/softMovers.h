#pragma once

/// @file
/// The rocks of an island while they are solved for: where they start, how impulses move and turn
/// them, where they are.

#include "solve/island/PairSprings.h"
#include "solve/island/island.h"
#include "solve/island/softRow.h"

#include <vector>

namespace rockfall::soft
{

/// The step, as asked.
struct Step
{
  double duration = 0.0, gravity = 0.0;
  int substeps = 0;
  double h = 0.0;             ///< Of a substep, s.
  Vec3 origin = Vec3::Zero(); ///< First rock where the step begins, m.
  std::vector<IslandBody>* bodies = nullptr;
  std::vector<IslandContact>* contacts = nullptr;
  PairStiffness stiffness; ///< Of contacts that come without springs.
};

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
  Vec3 start;              ///< Centroid where the step begins, from Step::origin, m.
  bool turned;             ///< So far in the step that its contacts weigh otherwise.
  bool touched;            ///< A contact that lasts has pushed it in the substep.
  bool flies;              ///< Nothing has touched it in the step.
  bool moved;              ///< Since the last look.
  bool deep;               ///< Overlaps the slope deeper than springs explain.
  double noise;            ///< Speed to which its impacts in the step are exact, m/s.
  Vec3 momentum;           ///< Angular, about the centroid.
  Mat3 inverseInertia;
  double smallTurn;   ///< Largest one of a substep that a midpoint does, rad.
  double weighedTurn; ///< Largest one of the step within which its contacts weigh the same, rad.
  Quat orientation;
  const Block* block;
  Vec3 seenAt, seenTurn; ///< Displacement and turn at the last look.
};

class Movers
{
public:
  explicit Movers(const Step& step)
    : step_(step)
  {
  }

  std::vector<Motion> motions; ///< By body.
  std::vector<Motion> before;  ///< By body, behind the impacts of the substep.
  std::vector<Mover> all;      ///< By body.

  std::size_t size() const { return all.size(); }
  Mover& operator[](int i) { return all[std::size_t(i)]; }
  const Mover& operator[](int i) const { return all[std::size_t(i)]; }

  void begin(); ///< A step, whose bodies nobody has looked at.
  void start(); ///< Back to where the step begins.
  void noteDetection();
  void findMoved();                    ///< Since the last look.
  BlockState end(std::size_t i) const; ///< At the end of the step.

  void fall();       ///< Gravity of a substep, and no contact yet.
  void move();       ///< For a substep.
  void forgetDeep(); ///< Which ones are.

  static Vec3 speedOf(const ContactRow& row, const std::vector<Motion>& motions);
  /// Of a's point alone.
  static Vec3 speedOfA(const ContactRow& row, const std::vector<Motion>& motions);
  Vec3 speedOf(const ContactRow& row) const { return speedOf(row, motions); }
  Vec3 speedOfA(const ContactRow& row) const { return speedOfA(row, motions); }
  void push(const ContactRow& row, const Vec3& J);       ///< J on a, −J on b, N s.
  void twist(const ContactRow& row, const Vec3& moment); ///< On a, the opposite on b, N m s.
  double mobility(int mover) const; ///< At least that of any of its axes, 1/(kg m²).

private:
  void start(std::size_t i);
  void turn(std::size_t i);
  void push(int mover, const Vec3& J, const Vec3& lever);
  void twist(int mover, const Vec3& moment);

  const Step& step_;
};

inline Vec3 Movers::speedOfA(const ContactRow& r, const std::vector<Motion>& motions)
{
  const Motion& a = motions[std::size_t(r.a)];
  return a.velocity + a.spin.cross(r.lever);
}

inline Vec3 Movers::speedOf(const ContactRow& r, const std::vector<Motion>& motions)
{
  Vec3 u = speedOfA(r, motions);
  if (r.b >= 0)
  {
    const Motion& b = motions[std::size_t(r.b)];
    u -= b.velocity + b.spin.cross(r.leverB);
  }
  return u;
}

inline double Movers::mobility(int i) const
{
  const double moment = motions[std::size_t(i)].inverseMoment;
  return moment > 0.0 ? moment : (*this)[i].inverseInertia.trace();
}

inline void Movers::push(int i, const Vec3& J, const Vec3& lever)
{
  Motion& m = motions[std::size_t(i)];
  m.velocity += m.inverseMass * J;
  this->twist(i, lever.cross(J));
}

inline void Movers::twist(int i, const Vec3& moment)
{
  Motion& m = motions[std::size_t(i)];
  if (m.inverseMoment > 0.0)
  {
    m.spin += m.inverseMoment * moment;
    return;
  }
  Mover& mover = (*this)[i];
  mover.momentum += moment;
  m.spin += mover.inverseInertia * moment;
}

inline void Movers::push(const ContactRow& r, const Vec3& J)
{
  if (r.b >= 0)
  {
    this->push(r.b, -J, r.leverB);
  }
  this->push(r.a, J, r.lever);
}

inline void Movers::twist(const ContactRow& r, const Vec3& moment)
{
  this->twist(r.b, -moment);
  this->twist(r.a, moment);
}

} // namespace rockfall::soft
