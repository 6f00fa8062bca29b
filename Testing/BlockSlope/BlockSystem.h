#pragma once

/// @file
/// One step of a rock on a slope of DDA blocks: K D = F with 12 unknowns for each of the n + 1
/// blocks, contact terms in Kii, Kij, Kji and Kjj (METHOD 3), open–close iteration. CFEs replace
/// this engine; it is there to be compared with.
///
/// Contact law, Cayley map, levers at mid-step and damping of lasting contact are those of the step
/// on CFEs, so that only the slope differs. An edge on a ridge keeps the normal of the step's
/// start, good to second order.

#include "BlockSlope/SlopeBlocks.h"
#include "contact/Contact.h"
#include "law/contactLaw.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <vector>

namespace rockfall
{

struct SystemRequest
{
  double duration = 0.0;      ///< h, s.
  bool lasting = false;       ///< Damp what the step does not resolve; else conserve energy.
  double gravity = 9.81;      ///< m/s²
  double normalPenalty = 1e9; ///< pₙ, N/m.
  double shearPenalty = 1e9;  ///< pₛ, N/m.
  double friction = 0.0;      ///< tan φ
  double cohesion = 0.0;      ///< N per closed contact.
  int maxOpenClose = 12;
  /// Acceleration of translation (world) and of the spin (body) in the last lasting step.
  Vec3 acceleration = Vec3::Zero();
  Vec3 spinAcceleration = Vec3::Zero();
};

struct SystemOutcome
{
  bool settled = false;
  int iterations = 0;        ///< Solutions of the whole system.
  double frictionWork = 0.0; ///< J, ≥ 0.
  double springEnergy = 0.0; ///< In the contact springs at the end, J.
  double normalEnergy = 0.0; ///< The part of it in the normal springs, J.
};

class BlockSystem
{
public:
  BlockSystem(const Block& rock, SlopeBlocks slope);

  /// Advances rock, slope and the contacts' springs by one step. Contacts come with distance,
  /// normal and point as the rock stands over the undeformed slope. If open–close does not settle,
  /// nothing is changed unless `takeAnyway`.
  SystemOutcome step(const SystemRequest& request, std::vector<Contact>& contacts,
    BlockState& state, bool takeAnyway);

  int unknowns() const { return 12 * (int(slope_.blocks.size()) + 1); }
  const SlopeBlocks& slope() const { return slope_; }
  /// Gap of a contact over the slope as it is deformed, m.
  double gap(const Contact& contact) const;
  double slopeEnergy() const; ///< Kinetic and elastic, J.
  /// Puts the slope at rest where it started and returns the energy that this takes away, J.
  double settleSlope();

private:
  using Vec24 =
    Eigen::Matrix<double, 24, 1>; ///< The rock's 12, then those of a block of the slope.
  struct Row
  {
    int block = 0;                ///< Of the slope.
    Vec24 normal = Vec24::Zero(); ///< (nᵀTᵢ, −nᵀTⱼ)
    std::array<Vec24, 2> shear;   ///< The same for two directions in the contact's plane.
    std::array<Vec3, 2> tangent;  ///< Rock's axes.
    Vec3 n = Vec3::Zero();        ///< Rock's axes.
    Vec3 x = Vec3::Zero();        ///< Material point of the rock.
    Vec3 y0 = Vec3::Zero();       ///< Place at the start, rock's axes.
    bool fixedToSlope = false;    ///< FaceVertex: the point is the slope's.
    ContactLaw law;
    Eigen::Vector2d travel = Eigen::Vector2d::Zero();
  };

  /// The Cayley map of a rotation vector.
  static Quat turnOf(const Vec3& r)
  {
    return Quat(1.0, 0.5 * r.x(), 0.5 * r.y(), 0.5 * r.z()).normalized();
  }
  void prepareRows(
    const SystemRequest& request, const BlockState& state, const std::vector<Contact>& contacts);
  void levers(const Vec12& rock);
  Vec24 pick(const Row& row, const Eigen::VectorXd& d) const;
  bool evaluate(const SystemRequest& request, const Eigen::VectorXd& d);
  void assembleBlocks(const SystemRequest& request, const BlockState& state);
  void assembleContacts(const Eigen::VectorXd& d);
  bool solve(Eigen::VectorXd& next);
  void add(int row, int column, const Mat12& part);
  void writeContacts(std::vector<Contact>& contacts, SystemOutcome& outcome) const;

  const Block& rock_;
  SlopeBlocks slope_;
  std::vector<Row> rows_;
  std::vector<Eigen::Triplet<double>> entries_;
  std::size_t blockEntries_ = 0; ///< How many of them are not contacts'.
  Eigen::SparseMatrix<double> matrix_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors_; ///< LU, as friction is unsymmetric.
  std::vector<int> pattern_; ///< Blocks that the rock touched when it was last analysed.
  Eigen::VectorXd blockLoad_, load_;
  double rate_ = 0.0; ///< Ḋ¹ = rate D + offset
  Eigen::VectorXd offset_;
  Mat3 rotation_ = Mat3::Identity(); ///< Rock's axes to world at the start of the step.
  Mat3 deform_ = Mat3::Identity();   ///< I + ε of the rock then.
};

} // namespace rockfall
