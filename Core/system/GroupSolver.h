#pragma once

/// @file
/// One step of rocks that touch each other: block-sparse K D = F with 6 unknowns per rock,
/// open–close over all contacts at once (METHOD 3: Kii, Kij, Kji, Kjj).
///
/// The step of a single rock (solver/StepSolver.h) for many: the same integration, springs and
/// states. What differs: both sides of a contact move, and the unknowns of different rocks are
/// coupled by contacts only. Force and moment of a contact act on both rocks at one point of
/// mid-step, so that momentum and angular momentum are kept to rounding.

#include "block/Block.h"
#include "solver/StepSolver.h"
#include "solver/contactLaw.h"
#include "system/BlockMatrix.h"

#include <array>
#include <functional>
#include <vector>

namespace rockfall
{

/// How the linear systems are solved.
enum class GroupMethod : std::uint8_t
{
  Suited,    ///< Direct up to a size, iterative beyond.
  Direct,    ///< Elimination of K's blocks.
  Iterative, ///< Gauss–Seidel over the contacts, in their own three directions.
};

struct GroupBody
{
  const Block* block = nullptr;
  BlockState* state = nullptr;
  Vec3 acceleration = Vec3::Zero();     ///< Of the last step, world, m/s².
  Vec3 spinAcceleration = Vec3::Zero(); ///< Of the spin, body axes, rad/s².
  double given = 0.0; ///< Out: work that this rock did on other rocks in the step, J.
  double frictionWork = 0.0, dampedWork = 0.0;   ///< Out: on the slope, J.
  double springEnergy = 0.0, normalEnergy = 0.0; ///< Out: of its contacts with the slope, J.
};

struct GroupContact
{
  Contact* contact = nullptr;
  int first = -1;
  int second = -1;       ///< −1: the slope.
  double friction = 0.0; ///< tan φ
  double cohesion = 0.0; ///< N
  /// ≥ 0: leaves with at least this speed along the normal if it closes in a lasting step (Newton's
  /// law of restitution), m/s.
  double bounce = -1.0;
  double approach = 0.0; ///< Speed at which it closes, m/s.
  double work = 0.0;     ///< Out: what it took from the rocks' motion, springs included, J.
};

struct GroupOutcome
{
  bool settled = false;
  int iterations = 0;        ///< Of open–close.
  double residual = 0.0;     ///< Largest |Δ gap| of the last correction, m.
  double frictionWork = 0.0; ///< Between rocks, J.
  double dampedWork = 0.0;   ///< Between rocks, J.
};

class GroupSolver
{
public:
  /// Advances the bodies' states and the contacts' springs by `request.duration`. If open–close
  /// does not settle nothing is changed, unless `takeAnyway`.
  ///
  /// `lookAgain` is asked after a solution that has settled, or one by Gauss–Seidel, before it is
  /// written: it may look where the bodies would be (`end`), append contacts that were not reckoned
  /// with, and correct the gaps of others (`setGap`); if it returns true the step goes on from
  /// where it is. The `distance` of an appended contact is that at the end, the rest of it as all
  /// stands at the start.
  GroupOutcome step(const StepRequest& request, std::vector<GroupBody>& bodies,
    std::vector<GroupContact>& contacts, bool takeAnyway,
    const std::function<bool()>& lookAgain = {});

  // For lookAgain.
  /// Where a body would be at the end of the step; its velocity is not set.
  BlockState end(const std::vector<GroupBody>& bodies, std::size_t i) const;
  double gap(std::size_t contact) const; ///< At the end of the step as reckoned, m.
  /// The gap is found to be another one (m). No contact is asked to open further than it was.
  void setGap(std::size_t contact, double found);
  bool moved(std::size_t body) const; ///< Since lookAgain was asked last.

  GroupMethod method = GroupMethod::Suited;
  /// Share of the largest displacement to which Gauss–Seidel goes.
  double tolerance = 1e-4;
  int maxSweeps = 30;

private:
  static constexpr int kNever = -2;                              ///< A sweep before all others.
  static constexpr std::size_t kBodyGrain = 64, kRowGrain = 256; ///< For one thread at a time.

  // Everything in world axes. A rotation over the step is the Cayley vector of its turn.
  struct Side
  {
    int body = -1;
    Vec3 lever = Vec3::Zero(); ///< From the centroid to the point of force, at mid-step.
    Vec3 place = Vec3::Zero(); ///< The material point about the centroid, at the start.
    Vec3 edge = Vec3::Zero();  ///< EdgeEdge: direction of the edge at the start.
  };
  struct Row
  {
    ContactLaw law;
    std::array<Side, 2> sides;
    ContactKind kind;
    Vec3 n;                         ///< At the start.
    std::array<Vec3, 3> directions; ///< Normal at mid-step, and the two tangents.
    Vec3 fixed = Vec3::Zero();      ///< A point of the slope.
    double gap0 = 0.0;              ///< Without what a bounce asks for, m.
    Vec3 force = Vec3::Zero();      ///< Normal and shear, with which Gauss–Seidel begins, N.
    double done[2] = {};            ///< Out: work of the force on the two bodies, J.
    double frictionWork = 0.0, dampedWork = 0.0; ///< Out, J.
    bool closed = false;                         ///< Out.
  };
  struct Work
  {
    Mat3 rotation; ///< At the start.
    Mat3 turned;   ///< cay(θ)
    Quat turn;     ///< The same.
    Vec6 velocity0, offset, load, free, d, last;
    double inverseMass;  ///< h/(rate m)
    Mat3 inverseInertia; ///< h/rate · I⁻¹
    Mat3 inertia;        ///< rate/h · I
    Vec3 position;       ///< Of the centroid at the start.
  };
  /// What a sweep of Gauss–Seidel meets of a contact, and of a rock: no more than that.
  struct Point
  {
    std::array<int, 2> body; ///< The slope is one more body of each part, which nothing moves.
    std::array<Vec3, 3> directions;
    std::array<Vec3, 2> lever;
    double w;              ///< nᵀ J A⁻¹ Jᵀ n
    double coupling[2];    ///< Of a normal force with the two tangents.
    double gap, stiffness; ///< Gap at the start, and p/(1 + p w).
    double shear, gain;    ///< 1/pₛ, and the step towards the locked spring.
    double friction, cohesion;
    double slip[2];
    double force[3];
  };
  struct Mover
  {
    Vec3 way, turn;
    double inverseMass;
    Mat3 inverseInertia;
    int changed; ///< The last sweep in which it was moved by more than a share of the tolerance.
  };

  void prepare(const StepRequest& request, const std::vector<GroupBody>& bodies,
    const std::vector<GroupContact>& contacts);
  /// Rows of the contacts from `first` on.
  void prepareRows(const StepRequest& request, const std::vector<GroupBody>& bodies,
    const std::vector<GroupContact>& contacts, std::size_t first);
  void startRows(
    const StepRequest& request, const std::vector<GroupContact>& contacts, std::size_t first);
  /// Rows of the contacts that lookAgain has appended.
  void append(const StepRequest& request, const std::vector<GroupBody>& bodies,
    std::vector<GroupContact>& contacts);
  void lever(Row& row) const;
  void turn();                         ///< Rotations as the displacements are.
  void levers();                       ///< … and levers with them.
  Mat3 mobility(const Row& row) const; ///< J A⁻¹ Jᵀ of a force at the contact, m/N.
  Vec3 travel(const Row& row) const;   ///< J D: along the normal and the two tangents, m.
  bool evaluate(double h, bool lasting);
  void loads(const StepRequest& request, const std::vector<GroupBody>& bodies);
  bool newton(
    const StepRequest& request, const std::vector<GroupBody>& bodies, GroupOutcome& outcome);
  bool solveDirect(Eigen::VectorXd& next);
  template <class Add>
  void assemble(Eigen::VectorXd& right, Add&& add) const;
  bool gaussSeidel(
    const StepRequest& request, const std::vector<GroupBody>& bodies, GroupOutcome& outcome);
  void arrange(); ///< Rows by parts of the group.
  void gather();  ///< Rows and bodies into points and movers.
  void gatherPoint(const Row& row, Point& point) const;
  bool sweeps(int most, GroupOutcome& outcome);
  void collect(); ///< Displacements and forces from movers and points.
  /// Goes on with the rows that were appended and the gaps that were set.
  bool resume(GroupOutcome& outcome);
  void finishSweeps(const StepRequest& request);
  double visit(int part, int number, double enough);
  double sweep(int number, double enough);
  double relax(Point& p);
  void write(const StepRequest& request, std::vector<GroupBody>& bodies,
    std::vector<GroupContact>& contacts, GroupOutcome& outcome);

  std::vector<Row> rows_;
  std::vector<Work> work_;
  std::vector<Point> points_;
  std::vector<Mover> movers_;
  // Parts are strips across the group, and contacts belong to the lower part of their two rocks:
  // those of every second part share no rock, and are swept at the same time. The last part holds
  // what reaches further than to the next strip.
  int parts_ = 1;
  std::vector<int> order_;          ///< Rows, part by part.
  std::vector<std::size_t> starts_; ///< First of each part there.
  std::vector<std::size_t> nextInPart_;
  std::vector<int> byPlace_, partOf_; ///< Bodies.
  std::vector<double> most_;          ///< Largest change, by part.
  std::vector<int> pointOf_;          ///< By row, its point.
  int sweep_ = 0;                     ///< Number of the next sweep.
  int looked_ = 0;                    ///< Number of the first one since lookAgain was asked.
  double enough_ = 0.0;               ///< m
  bool sweeping_ = false;             ///< Gauss–Seidel it is.
  double rate_ = 0.0;
  BlockMatrix blocks_, kept_;
};

} // namespace rockfall
