#pragma once

/// @file
/// The law of one contact over a step of h (s) (METHOD 3), as single rocks and the slope as blocks
/// have it. The soft rows of an island (solve/island/SoftSolver.h) rest at the same forces.
///
/// Along the normal n, gaps d₀ and d₁ at the start and the end (m; < 0: overlap), V(d) = ½ pₙ
/// min(d, 0)²:
///
///     impact    N = −(V(d₁) − V(d₀)) / (d₁ − d₀) + (cₙ/h) (min(d₀, 0) − min(d₁, 0))
///     lasting   N = −pₙ min(d₁, 0)
///     always    N ≥ 0
///
/// Along the two tangents, with the elongation s₀ at the start, the travel t over the step (m) and
/// the share a of the step in which the contact is closed:
///
///     trial     s = s₀ + a (½ + cₛ/(pₛ h)) t in an impact, s₀ + a t in lasting contact
///     limit     L = μ N + min(c, 20 N)        (cohesion.h)
///     locked    pₛ |s| ≤ L:  T = −pₛ s,        s₁ = s₀ + a t
///     sliding   else:        T = −L s / |s|,  s₁ = (L/pₛ) s / |s|, less what the dashpot carries
///
/// N > 0 pushes the rock along n; T acts against the slip of the rock on what it touches.

#include "base/types.h"
#include "law/ContactState.h"
#include "law/cohesion.h"
#include "law/springs.h"

namespace rockfall
{

/// The springs of a contact over a step: the start, and the result of the last evaluation.
struct ContactLaw
{
  double gap0 = 0.0;                               ///< At the start of the step, m.
  double penalty = 0.0;                            ///< pₙ, N/m.
  double shearPenalty = 0.0;                       ///< pₛ, N/m.
  double dashpot = 0.0;                            ///< Normal, N s/m.
  double shearLag = 0.0;                           ///< cₛ/pₛ, s.
  double friction = 0.0;                           ///< tan φ
  double cohesion = 0.0;                           ///< N
  Eigen::Vector2d slip0 = Eigen::Vector2d::Zero(); ///< Along the two tangents, m.

  double gap1 = 0.0;
  double force = 0.0;     ///< Normal, N, ≥ 0.
  double stiffness = 0.0; ///< −∂force/∂gap1
  double share = 1.0;     ///< Part of the step in which it is closed.
  Eigen::Vector2d shearForce = Eigen::Vector2d::Zero();
  Eigen::Matrix2d shearStiffness = Eigen::Matrix2d::Zero(); ///< −∂shearForce/∂travel
  Eigen::Vector2d shearCoupling = Eigen::Vector2d::Zero();  ///< −∂shearForce/∂gap1
  Eigen::Vector2d slip1 = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::Zero(); ///< Of the slip while it slides, else zero.
  ContactState state = ContactState::Open;

  bool acts() const { return this->force > 0.0 || this->stiffness > 0.0; }

  /// For a gap at the end of the step and a travel along the tangents (m), over `h` (s). Returns
  /// whether the state has changed.
  bool evaluate(bool lasting, double h, double gap, const Eigen::Vector2d& travel)
  {
    this->gap1 = gap;
    const NormalSpring normal = lasting
      ? endSpring(this->penalty, gap)
      : dampedSpring(this->penalty, this->dashpot / h, this->gap0, gap);
    this->force = normal.force;
    this->stiffness = normal.stiffness;
    this->share = normal.share;
    this->shearForce.setZero();
    this->shearStiffness.setZero();
    this->shearCoupling.setZero();
    this->slip1 = this->slip0;
    bool changed = false;
    ContactState now = ContactState::Open;
    if (this->force > 0.0)
    {
      const auto [limit, slope] = coulombLimit(this->friction, this->cohesion, this->force);
      const double weight = this->share * ((lasting ? 1.0 : 0.5) + this->shearLag / h);
      const Eigen::Vector2d stretch = this->slip0 + weight * travel;
      const double length = stretch.norm();
      // A slip that has reversed from one iteration to the next has passed through rest: it locks
      // and is judged again, or the two directions would alternate for ever.
      const bool reversed = this->direction.dot(stretch) < 0.0;
      this->direction.setZero();
      if (reversed || this->shearPenalty * length <= limit)
      {
        changed = reversed;
        now = ContactState::Locked;
        this->shearForce = -this->shearPenalty * stretch;
        this->shearStiffness = this->shearPenalty * weight * Eigen::Matrix2d::Identity();
        this->slip1 = this->slip0 + this->share * travel;
      }
      else
      {
        // Radial return onto the Coulomb cone; the spring stretches no further than what carries
        // it.
        now = ContactState::Sliding;
        this->direction = stretch / length;
        this->shearForce = -limit * this->direction;
        this->shearStiffness = (limit * weight / length) *
          (Eigen::Matrix2d::Identity() - this->direction * this->direction.transpose());
        this->shearCoupling = -slope * this->stiffness * this->direction;
        const double part = weight > this->share ? this->share / weight : 1.0;
        this->slip1 =
          this->slip0 + part * (this->direction * (limit / this->shearPenalty) - this->slip0);
      }
    }
    changed = changed || now != this->state;
    this->state = now;
    return changed;
  }

  /// A lasting contact that is on the way to a solution, over a gap: its law goes on linearly.
  void pull(double gap, const Eigen::Vector2d& travel)
  {
    this->gap1 = gap;
    this->force = -this->penalty * gap;
    this->stiffness = this->penalty;
    this->share = 1.0;
    this->shearCoupling.setZero();
    this->shearStiffness.setZero();
    if (this->state == ContactState::Locked)
    {
      this->shearForce = -this->shearPenalty * (this->slip0 + travel);
      this->shearStiffness = this->shearPenalty * Eigen::Matrix2d::Identity();
    }
    else
    {
      this->shearForce = -this->friction * this->force * this->direction;
      this->shearCoupling = -this->friction * this->stiffness * this->direction;
    }
  }

  /// Of the spring at the end of the step, J.
  double normalEnergy() const
  {
    const double compressed = std::min(this->gap1, 0.0);
    return 0.5 * this->penalty * compressed * compressed;
  }
  double shearEnergy() const
  {
    return this->gap1 < 0.0 ? 0.5 * this->shearPenalty * this->slip1.squaredNorm() : 0.0;
  }
  /// Dissipated along the contact's plane over the step, J.
  double frictionWork(const Eigen::Vector2d& travel) const
  {
    return 0.5 * this->shearPenalty * this->slip0.squaredNorm() - this->shearEnergy() -
      this->shearForce.dot(travel);
  }
  /// Dissipated by the normal dashpot, J.
  double dampedWork() const
  {
    const double compressed = std::min(this->gap0, 0.0);
    return this->dashpot > 0.0 ? 0.5 * this->penalty * compressed * compressed -
        this->normalEnergy() - this->force * (this->gap1 - this->gap0)
                               : 0.0;
  }
};

} // namespace rockfall
