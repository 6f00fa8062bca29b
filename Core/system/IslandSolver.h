#pragma once

/// @file
/// One step of rocks that touch each other: block-sparse K D = F with 6 unknowns per rock,
/// open–close over all contacts at once (METHOD 3: Kii, Kij, Kji, Kjj).
///
/// The step of a single rock (solver/StepSolver.h) for many: the same integration, springs and
/// states. What differs: both sides of a contact move, and the unknowns of different rocks are
/// coupled by contacts only. Force and moment of a contact act on both rocks at one point of
/// mid-step, so that momentum and angular momentum are kept to rounding.

#include "law/contactLaw.h"
#include "solver/StepSolver.h"
#include "system/BlockMatrix.h"
#include "system/CrowdSolver.h"

#include <array>
#include <functional>
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
  /// Advances the bodies' states and the contacts' springs by `request.duration`. If open–close
  /// does not settle nothing is changed, unless `accept` says so.
  ///
  /// `lookAgain` is asked after a solution that has settled, or one by Gauss–Seidel, before it is
  /// written: it may look where the bodies would be (`end`), append contacts that were not reckoned
  /// with, correct the gaps of others (`setGap`) and let others go (`setAbsent`). If it has found
  /// anything the step goes on from where it is. The `distance` of an appended contact is that at
  /// the end, the rest of it as all stands at the start.
  IslandOutcome step(const StepRequest& request, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts, Accept accept,
    const std::function<LookOutcome()>& lookAgain = {});

  // For lookAgain.
  /// A body at the end of the step.
  BlockState end(const std::vector<IslandBody>& bodies, std::size_t i) const;
  double gap(std::size_t contact) const; ///< At the end of the step as reckoned, m.
  /// The gap is found to be another one (m). No contact is asked to open further than it was.
  /// Returns whether this changes anything.
  bool setGap(std::size_t contact, double found);
  bool moved(std::size_t body) const;      ///< Since lookAgain was asked last.
  double force(std::size_t contact) const; ///< Along the normal, as reckoned, N.
  /// Lets a contact go, or sets it in again.
  void setAbsent(std::vector<IslandContact>& contacts, std::size_t contact, bool absent);

  IslandMethod method = IslandMethod::Suited;
  /// Whether a step is solved by Gauss–Seidel from the start.
  bool isSwept(StepKind kind, std::size_t bodies) const;
  /// For contacts without springs that mayStayOpen, if it is: gives one its springs when it closes.
  void setSpringsLate(std::function<void(std::size_t contact)> setSprings)
  {
    crowd_.setSprings = std::move(setSprings);
  }
  /// Share of the largest displacement to which Gauss–Seidel goes.
  double tolerance = 1e-4;
  int maxSweeps = 6;

private:
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
    double asked = 0.0;             ///< With it, while the contact is let go, m.
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
  void prepare(const StepRequest& request, const std::vector<IslandBody>& bodies,
    const std::vector<IslandContact>& contacts);
  /// Rows of the contacts from `first` on.
  void prepareRows(const StepRequest& request, const std::vector<IslandBody>& bodies,
    const std::vector<IslandContact>& contacts, std::size_t first);
  void startRows(
    const StepRequest& request, const std::vector<IslandContact>& contacts, std::size_t first);
  /// Rows of the contacts that lookAgain has appended.
  void append(const StepRequest& request, const std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts);
  void lever(Row& row) const;
  void levers();                               ///< Rotations and levers as the displacements are.
  Mat3 mobility(const Row& row) const;         ///< J A⁻¹ Jᵀ of a force at the contact, m/N.
  Vec3 displacementOf(const Side& side) const; ///< Of a rock's point of force, m.
  /// The same at the mean of the velocities before and after the step, m.
  Vec3 meanDisplacementOf(double h, const Side& side) const;
  Vec3 travel(const Row& row) const; ///< J D: along the normal and the two tangents, m.
  bool evaluate(double h, bool lasting);
  void loads(const StepRequest& request, const std::vector<IslandBody>& bodies);
  bool newton(
    const StepRequest& request, const std::vector<IslandBody>& bodies, IslandOutcome& outcome);
  /// Newton, and again as long as bounces give energy; returns whether it has settled.
  bool settle(const StepRequest& request, const std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts, IslandOutcome& outcome);
  bool holdBounces(double h, std::vector<IslandContact>& contacts); ///< Whether any gives energy.
  bool solveDirect(Eigen::VectorXd& next);
  /// `places`: of bodies in the system, −1 for those that no contact acts on.
  template <class Add>
  void assemble(const std::vector<int>& places, Eigen::VectorXd& right, Add&& add) const;
  void write(const StepRequest& request, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts, IslandOutcome& outcome);

  std::vector<Row> rows_;
  std::vector<ContactBooks> books_; ///< Out, by row.
  std::vector<Work> work_;
  CrowdSolver crowd_;
  bool sweeping_ = false; ///< crowd_ solves the step at hand.
  double rate_ = 0.0;
  BlockMatrix blocks_, kept_;
};

} // namespace rockfall
