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

#include <Eigen/Sparse>

#include <array>
#include <vector>

namespace rockfall
{

/// How the linear systems are solved.
enum class GroupMethod : std::uint8_t
{
  Suited,    ///< Direct up to a size, iterative beyond.
  Direct,    ///< Sparse LU of K.
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
  double work = 0.0; ///< Out: what it took from the rocks' motion, springs included, J.
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
  GroupOutcome step(const StepRequest& request, std::vector<GroupBody>& bodies,
    std::vector<GroupContact>& contacts, bool takeAnyway);

  GroupMethod method = GroupMethod::Suited;
  /// Share of the largest displacement to which Gauss–Seidel goes.
  double tolerance = 1e-4;
  int maxSweeps = 100;

private:
  struct Side
  {
    int body = -1;
    std::array<Vec6, 3> row;   ///< nᵀT and the two lᵀT, in the body's axes.
    std::array<Vec6, 3> moved; ///< A⁻¹ of them.
  };
  struct Row
  {
    ContactLaw law;
    std::array<Side, 2> sides;
    ContactKind kind;
    Vec3 n;                      ///< World, at the start.
    std::array<Vec3, 2> tangent; ///< World.
    std::array<Vec3, 2> place;   ///< Of the point about each centroid at the start, body axes.
    std::array<Vec3, 2> edge;    ///< EdgeEdge: directions of the edges, of the bodies' axes.
    Vec3 fixed = Vec3::Zero();   ///< A point of the slope, world.
    double gap0 = 0.0;           ///< Without what a bounce asks for, m.
    Mat3 w = Mat3::Zero();       ///< J A⁻¹ Jᵀ in the three directions.
    Vec3 force = Vec3::Zero();   ///< Normal and shear, as applied by Gauss–Seidel so far, N.
  };
  struct Work
  {
    Mat3 rotation;
    Quat turn;
    Mat3 turned; ///< R₀ · cay(r)
    Vec6 velocity0, offset, load, free, d, last;
    double inverseMass;  ///< h/(rate m)
    Mat3 inverseInertia; ///< h/rate · I⁻¹
    Mat3 inertia;        ///< rate/h · I
    Vec3 position;       ///< Of the centroid at the start, world.
  };

  void prepare(const StepRequest& request, const std::vector<GroupBody>& bodies,
    const std::vector<GroupContact>& contacts);
  void levers();
  void mobilities();
  bool evaluate(double h, bool lasting);
  void loads(const StepRequest& request, const std::vector<GroupBody>& bodies);
  double along(const Row& row, int direction) const; ///< Row of J times D, m.
  bool newton(const StepRequest& request, const std::vector<GroupBody>& bodies, bool dense,
    GroupOutcome& outcome);
  bool solveDense(Eigen::VectorXd& next);
  bool solveSparse(Eigen::VectorXd& next);
  template <class Add>
  void assemble(Eigen::VectorXd& right, Add&& add) const;
  bool gaussSeidel(
    const StepRequest& request, const std::vector<GroupBody>& bodies, GroupOutcome& outcome);
  double sweep();
  void apply(const Row& row, const Vec3& change);
  void write(const StepRequest& request, std::vector<GroupBody>& bodies,
    std::vector<GroupContact>& contacts, GroupOutcome& outcome);

  std::vector<Row> rows_;
  std::vector<Work> work_;
  double rate_ = 0.0;
  Eigen::MatrixXd dense_;
  std::vector<Eigen::Triplet<double>> triplets_;
};

} // namespace rockfall
