#pragma once

/// @file
/// One step of one block on CFEs: assemble K D = F, solve, open–close (METHOD 2 and 3).
///
/// Departures from the paper, each for a reason of METHOD 10:
/// - The rotation r is applied as a Cayley map, so that a material point moves by exactly
///   u + r × Z + Δε X with the lever Z = ½ (X₁ + cay(r) X₁) at mid-step: the gap of a vertex–face
///   contact at the end of the step is linear in D without remainder, and the volume does not grow.
/// - The force of a spring over a step is either its discrete gradient
///       −(V(d₁) − V(d₀)) / (d₁ − d₀),  V(d) = ½ p min(d, 0)²,
///   which conserves energy to the last digit for any Δt and any phase of the impact in the step
///   (Impact), or its value at the end of the step (Lasting), as Shi's.
/// - Velocities: Impact takes Shi's Ḋ¹ = 2 D/Δt − Ḋ⁰. With a stiff contact that leaves the velocity
///   ringing at ±v for ever, so Lasting takes
///       Ḋ¹ = D/Δt + ½ Δt D̈⁰,
///   second-order too and damped at high frequency (|λ| = 0.71 as Δt → ∞).
/// - With 6 unknowns the strain has no inertia: what a contact force strains at its point is part of
///   that contact's spring (law/springs.h).
/// - One contact is solved in its own three directions, W = J A⁻¹ Jᵀ; several in D.

#include "block/Block.h"
#include "contact/Contact.h"
#include "law/contactLaw.h"

#include <vector>

namespace rockfall
{

enum class StepKind : std::uint8_t
{
  Impact,  ///< Conserves energy.
  Lasting, ///< Damps what the step does not resolve.
};

struct StepRequest
{
  double duration = 0.0; ///< h, s.
  StepKind kind = StepKind::Impact;
  double gravity = 9.81;      ///< m/s²
  double normalPenalty = 1e9; ///< pₙ of contacts that bring none of their own, N/m.
  double shearPenalty = 1e9;  ///< pₛ of these, N/m.
  double friction = 0.0;      ///< tan φ.
  double cohesion = 0.0;      ///< N per closed contact.
  bool rigid = false;         ///< Strain rows left out: 6 unknowns.
  int maxOpenClose = 12;
  int substeps = 8; ///< Of an island (solve/island/SoftSolver.h).
  /// Acceleration of translation (world) and of the spin (body) in the last step: the lag of
  /// Lasting, a first guess for Impact.
  Vec3 acceleration = Vec3::Zero();
  Vec3 spinAcceleration = Vec3::Zero();
};

struct StepOutcome
{
  bool settled = false;
  int iterations = 0;
  double frictionWork = 0.0; ///< Dissipated along the contacts' planes, J, ≥ 0.
  double dampedWork = 0.0;   ///< Dissipated by the normal dashpots, J, ≥ 0.
  double springEnergy = 0.0; ///< In the contact springs at the end, J.
  double normalEnergy = 0.0; ///< The part of it in the normal springs, J.
};

/// The step for N unknowns per block: 12, or 6 without strain. Holds the work space, so that a step
/// allocates nothing once it has grown.
template <int N>
class BlockStep
{
public:
  using VecN = Eigen::Matrix<double, N, 1>;
  using MatN = Eigen::Matrix<double, N, N>;

  StepOutcome step(const Block& block, const StepRequest& request, std::vector<Contact>& contacts,
    BlockState& state, bool takeAnyway);

private:
  struct Row
  {
    VecN normal;                 ///< nᵀT: the gap changes by its product with D.
    std::array<VecN, 2> shear;   ///< lᵀT for two directions in the contact's plane.
    std::array<Vec3, 2> tangent; ///< Body axes.
    Vec3 n;                      ///< Body axes of the step's start.
    Vec3 x;                      ///< Material point.
    Vec3 y0;                     ///< Place of x about the centroid at the start, body axes.
    std::array<Vec3, 2> ridge;   ///< EdgeEdge: point and direction about the centroid, body axes.
    std::array<Vec3, 2> edge;    ///< The ends of the rock's edge likewise, at the start.
    ContactLaw law;

    /// The last solution has it pressed: over a small gap, which its linear form did not see, it pulls
    /// in the next one. If it were let go the rock would fall, and be pressed again, for ever.
    bool held = false;

    // As of D
    Vec3 start, end; ///< Place of x without and with the turn; of a face only its normal, turned.
    Vec3 mean;       ///< Normal of mid-step.
    Vec3 along;      ///< The rock's edge at mid-step.
    bool crosses;    ///< Whether it is not along the ridge.
    // Derivatives of what `normal` and `shear` make of D, by D: they change with it.
    VecN gapRate;
    std::array<VecN, 2> travelRate;
  };

  /// What the unknowns D of a step must balance: A D = load + contacts, Ḋ¹ = rate · D + offset.
  struct Balance
  {
    double rate; ///< 1/s
    VecN velocity0, offset;
    VecN load;
  };

  Balance balance(const Block& block, const BlockState& state, const StepRequest& request) const;
  /// Free flight, or as the last step went.
  VecN firstGuess(const BlockState& state, const StepRequest& request, const Balance& of) const;
  /// Open–close from `d` on, which becomes the solution; whether it settles.
  bool iterate(const Block& block, const StepRequest& request, const std::vector<Contact>& contacts,
    const Balance& of, VecN& d, int& iterations);
  void prepareInertia(const Block& block, double h, double rate, double stress);
  void prepareRows(const Block& block, const BlockState& state, const StepRequest& request,
    const std::vector<Contact>& contacts);
  void levers(
    const Block& block, const std::vector<Contact>& contacts, const Quat& rotation, const VecN& d);
  /// Sets the derivatives of a row, which are its products' own so far, to what they are with the turn.
  void derive(Row& row, const Contact& contact, const VecN& d) const;
  /// Forces but those of contacts, linearised about D: returns b with A D' = b + contacts. `whole`: with
  /// the turn of the momentum, and sets A.
  VecN turningLoad(const Balance& of, double h, const Quat& turn, const VecN& d, bool whole);
  /// Change by an iteration.
  struct Change
  {
    bool state = false; ///< Of any contact.
    double gap = 0.0;   ///< By how much at most, m.
    double way = 0.0;   ///< The most by which a gap changes over the step, m.
  };
  /// Springs for the displacement D.
  Change evaluate(const StepRequest& request, const VecN& d);
  /// Newton's next D from springs linearised about `d`; `load`: all other forces.
  VecN solve(const VecN& load, const VecN& d);
  VecN solveOne(const Row& row, const VecN& load, const VecN& d) const;
  void write(const VecN& d, std::vector<Contact>& contacts, StepOutcome& outcome) const;

  std::vector<Row> rows_;
  MatN mass_ = MatN::Zero();
  MatN inert_ = MatN::Zero();   ///< A: inertia, and elasticity of the strains.
  MatN inverse_ = MatN::Zero(); ///< A⁻¹
  Mat3 rotation_;               ///< Body to world at the start of the step.
  Mat3 deform_;                 ///< I + ε at the start of the step.
};

extern template class BlockStep<6>;
extern template class BlockStep<12>;

class StepSolver
{
public:
  /// Advances `state` and the contacts' springs by one step. Contacts come with distance, normal
  /// and point as of the start of the step; they leave with state, forces, slip and the gap
  /// predicted for its end in `distance`. If open–close does not settle, nothing is changed unless
  /// `takeAnyway`.
  StepOutcome step(const Block& block, const StepRequest& request, std::vector<Contact>& contacts,
    BlockState& state, bool takeAnyway = false)
  {
    return request.rigid ? rigid_.step(block, request, contacts, state, takeAnyway)
                         : deformable_.step(block, request, contacts, state, takeAnyway);
  }

private:
  BlockStep<6> rigid_;
  BlockStep<12> deformable_;
};

} // namespace rockfall
