#pragma once

/// @file
/// One step of rocks that touch each other: block-sparse K D = F with 6 unknowns per rock,
/// open–close over all contacts at once (METHOD 3: Kii, Kij, Kji, Kjj), as Newton's iteration with
/// a direct solver.
///
/// The step of a single rock (solver/StepSolver.h) for many: the same integration, springs and
/// states. What differs: both sides of a contact move, and the unknowns of different rocks are
/// coupled by contacts only. Force and moment of a contact act on both rocks at one point of
/// mid-step, so that momentum and angular momentum are kept to rounding.

#include "law/contactLaw.h"
#include "system/BlockMatrix.h"
#include "system/IslandSystem.h"

#include <array>
#include <vector>

namespace rockfall
{

class NewtonSolver final : public IslandSystem
{
public:
  void begin(const StepRequest& request, std::vector<IslandBody>& bodies,
    std::vector<IslandContact>& contacts) override;
  bool isWorthALook() const override { return outcome_.settled; }
  bool haveGoneOn() const override { return false; }
  void append() override;
  void noteLook() override {}
  void solve() override; ///< Again as long as bounces give energy.
  IslandOutcome finish(Accept accept, bool deep) override;

  bool isSettled(bool deep) const { return outcome_.settled && !deep; }
  int iterations() const { return outcome_.iterations; }

  BlockState end(std::size_t body) const override;
  bool moved(std::size_t) const override { return true; }
  double gap(std::size_t contact) const override;
  double force(std::size_t contact) const override { return rows_[contact].law.force; }
  bool setGap(std::size_t contact, double found) override;
  void setAbsent(std::size_t contact) override;

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
  void prepareBodies();
  void prepareRows(std::size_t first); ///< Of the contacts from `first` on.
  void startRows(std::size_t first);
  void lever(Row& row) const;
  void levers();                               ///< Rotations and levers as the displacements are.
  Mat3 mobility(const Row& row) const;         ///< J A⁻¹ Jᵀ of a force at the contact, m/N.
  Vec3 displacementOf(const Side& side) const; ///< Of a rock's point of force, m.
  /// The same at the mean of the velocities before and after the step, m.
  Vec3 meanDisplacementOf(const Side& side) const;
  Vec3 travel(const Row& row) const; ///< J D: along the normal and the two tangents, m.
  bool evaluate();
  void loads();
  bool newton();
  bool holdBounces(); ///< Whether any gives energy.
  bool solveDirect(Eigen::VectorXd& next);
  /// `places`: of bodies in the system, −1 for those that no contact acts on.
  template <class Add>
  void assemble(const std::vector<int>& places, Eigen::VectorXd& right, Add&& add) const;
  void write();

  std::vector<Row> rows_;
  std::vector<ContactBooks> books_; ///< Out, by row.
  std::vector<Work> work_;
  BlockMatrix blocks_, kept_;
  // Of the step at hand.
  StepRequest request_;
  std::vector<IslandBody>* bodies_ = nullptr;
  std::vector<IslandContact>* contacts_ = nullptr;
  IslandOutcome outcome_;
  double rate_ = 0.0; ///< 1/s: velocity is rate · displacement + offset.
};

} // namespace rockfall
