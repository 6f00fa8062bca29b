#pragma once

/// @file
/// Lasting contact of several rocks by one direct system: an oracle for soft rows.
///
/// Six unknowns for each rock, implicit Euler, springs with dashpots and Coulomb's law of
/// law/contactLaw.h, a dense LU of all rocks and contacts together, open–close iteration (METHOD 3):
///
///     (M/h + Σ h k r rᵀ) u = M u₀/h + f + Σ (…)        r = (n, l₁ × n; −n, −l₂ × n)
///
/// No sweeps, nothing that is warm, no relaxing, no impacts.

#include "block/Block.h"
#include "block/cayley.h"
#include "contact/Contact.h"
#include "law/contactLaw.h"
#include "law/settings.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace rockfall::testing
{

/// Of rocks `first` and `second` (< 0: the slope); its normal points to the first one.
struct Touch
{
  int first, second;
  Contact contact;
  double friction;           ///< tan φ
  Vec3 force = Vec3::Zero(); ///< Along the normal on the first one, mean over the last step, N.

  bool flipped() const { return contact.kind == ContactKind::FaceVertex; }
  int pointOf() const { return this->flipped() ? second : first; } ///< Rock that carries the point,
  int faceOf() const { return this->flipped() ? first : second; }  ///< and the normal.

  /// Where it is when its rocks have gone from some states to others.
  void carry(const std::vector<BlockState>& from, const std::vector<BlockState>& to)
  {
    const auto turn = [&](int i)
    {
      return i < 0
        ? Quat::Identity()
        : Quat(to[std::size_t(i)].orientation * from[std::size_t(i)].orientation.conjugate());
    };
    if (const int i = this->pointOf(); i >= 0)
    {
      contact.point =
        to[std::size_t(i)].position + turn(i) * (contact.point - from[std::size_t(i)].position);
    }
    const Quat face = turn(this->faceOf());
    contact.normal = contact.kind == ContactKind::EdgeEdge
      ? (turn(this->pointOf()).slerp(0.5, face) * contact.normal).normalized()
      : (face * contact.normal).normalized();
  }
};

class DirectIsland
{
public:
  std::vector<const Block*> blocks;
  std::vector<BlockState> states;
  std::vector<Touch> touches;
  double gravity = 9.81;
  int unsettled = 0; ///< Substeps whose iteration has not settled.

  /// As an island's step: normals and levers of its middle stay for all of it.
  void step(double duration, int substeps)
  {
    const std::vector<BlockState> from = states;
    const std::vector<Touch> before = touches;
    this->goToMiddle(0.5 * duration);
    for (int k = 0; k < substeps; ++k)
    {
      this->substep(duration / substeps, 1.0 / substeps);
    }
    for (std::size_t j = 0; j < touches.size(); ++j)
    {
      touches[j].contact.point = before[j].contact.point;
      touches[j].contact.normal = before[j].contact.normal;
      touches[j].carry(from, states);
    }
  }

private:
  using Vector = Eigen::VectorXd;
  struct Row
  {
    std::array<Vec3, 3> axes; ///< Normal, two tangents.
    std::array<Vector, 3> gradients;
    double lag; ///< Of the dashpot beside the normal spring, s.
    ContactLaw law;
  };

  void goToMiddle(double half)
  {
    std::vector<BlockState> middle = states;
    for (BlockState& s : middle)
    {
      s.orientation = cayley(Vec3(half * s.angularVelocity())) * s.orientation;
    }
    for (Touch& touch : touches)
    {
      touch.force.setZero();
      touch.carry(states, middle);
      if (touch.pointOf() < 0) // a node of the slope, as it moves under the rock
      {
        touch.contact.point -= half * states[std::size_t(touch.first)].velocity;
      }
    }
  }

  void substep(double h, double share)
  {
    const Eigen::Index n = 6 * Eigen::Index(states.size());
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
    Vector known = Vector::Zero(n), u = Vector::Zero(n);
    for (std::size_t i = 0; i < states.size(); ++i)
    {
      const BlockState& s = states[i];
      const Mat3 R = s.orientation.toRotationMatrix();
      const Mat3 inertia = R * blocks[i]->inertia() * R.transpose();
      const double m = blocks[i]->mass();
      const Eigen::Index at = 6 * Eigen::Index(i);
      const Vec3 spin = s.angularVelocity();
      mass.block<3, 3>(at, at) = m / h * Mat3::Identity();
      mass.block<3, 3>(at + 3, at + 3) = inertia / h;
      known.segment<3>(at) = m / h * s.velocity - m * gravity * Vec3::UnitZ();
      known.segment<3>(at + 3) = inertia * spin / h - spin.cross(inertia * spin);
      u.segment<3>(at) = s.velocity;
      u.segment<3>(at + 3) = spin;
    }
    std::vector<Row> rows;
    for (const Touch& touch : touches)
    {
      rows.push_back(this->rowOf(touch));
    }
    bool settled = false;
    for (int iteration = 0; iteration < 100 && !settled; ++iteration)
    {
      Eigen::MatrixXd k = mass;
      Vector f = known;
      this->addPivots(rows, u, k);
      for (Row& row : rows)
      {
        addRow(row, h, u, k, f);
      }
      const Vector next = k.partialPivLu().solve(f);
      const double change = (next - u).cwiseAbs().maxCoeff();
      // Half of the way where open–close goes round in circles.
      u = iteration < 30 ? next : Vector(0.5 * (u + next));
      bool changed = false;
      for (Row& row : rows)
      {
        changed = evaluate(row, h, u) || changed;
      }
      settled = !changed && change < 1e-8;
    }
    unsettled += settled ? 0 : 1;
    this->move(h, share, u, rows);
  }

  Vec3 lever(const Touch& touch, int i) const
  {
    return touch.contact.point - states[std::size_t(i)].position;
  }

  Row rowOf(const Touch& touch) const
  {
    const Contact& c = touch.contact;
    Row row;
    row.axes = { c.normal, c.normal.unitOrthogonal(), Vec3::Zero() };
    row.axes[2] = c.normal.cross(row.axes[1]);
    row.gradients.fill(Vector::Zero(6 * Eigen::Index(states.size())));
    double mobility = 0.0;
    for (const int i : { touch.first, touch.second })
    {
      const double sign = i == touch.first ? 1.0 : -1.0;
      for (std::size_t a = 0; a < 3 && i >= 0; ++a)
      {
        row.gradients[a].segment<3>(6 * i) = sign * row.axes[a];
        row.gradients[a].segment<3>(6 * i + 3) = sign * this->lever(touch, i).cross(row.axes[a]);
      }
      if (i >= 0)
      {
        const Block& block = *blocks[std::size_t(i)];
        const Vec3 moment =
          states[std::size_t(i)].orientation.conjugate() * this->lever(touch, i).cross(c.normal);
        mobility += 1.0 / block.mass() + moment.dot(block.inverseInertia() * moment);
      }
    }
    const auto lag = [&](double k) { return 2.0 * kSoftDamping / std::sqrt(k * mobility); };
    row.lag = c.gap() < 0.0 ? lag(c.stiffness) : 0.0;
    row.law.shearLag = lag(c.shearStiffness);
    row.law.gap0 = c.gap();
    row.law.penalty = c.stiffness;
    row.law.shearPenalty = c.shearStiffness;
    row.law.friction = touch.friction;
    row.law.slip0 = { row.axes[1].dot(c.slip), row.axes[2].dot(c.slip) };
    row.law.state = c.state;
    return row;
  }

  static bool evaluate(Row& row, double h, const Vector& u)
  {
    const auto way = [&](std::size_t axis) { return h * row.gradients[axis].dot(u); };
    const double gap = row.law.gap0 + (1.0 + row.lag / h) * way(0);
    return row.law.evaluate(true, h, gap, { way(1), way(2) });
  }

  static void addRow(Row& row, double h, const Vector& u, Eigen::MatrixXd& k, Vector& f)
  {
    evaluate(row, h, u);
    const ContactLaw& law = row.law;
    if (!law.acts())
    {
      return;
    }
    const auto& [n, t1, t2] = row.gradients;
    const auto add = [&](const Vector& along, double force, const Vector& slope)
    {
      k += h * along * slope.transpose(); // f(u') ≈ f(u) − h slope (u' − u)
      f += (force + h * slope.dot(u)) * along;
    };
    const double damped = 1.0 + row.lag / h;
    add(n, law.force, damped * law.stiffness * n);
    for (int a = 0; a < 2; ++a)
    {
      add(a == 0 ? t1 : t2, law.shearForce[a],
        damped * law.shearCoupling[a] * n + law.shearStiffness(a, 0) * t1 +
          law.shearStiffness(a, 1) * t2);
    }
  }

  /// Moments of pairs that push at one point only (softPivots.cxx), as viscous as the last
  /// iteration's turning asks.
  void addPivots(const std::vector<Row>& rows, const Vector& u, Eigen::MatrixXd& k) const
  {
    struct Pair
    {
      int pushing = 0;
      std::size_t row = 0; ///< Which pushes most.
    };
    std::map<std::array<int, 2>, Pair> pairs;
    for (std::size_t j = 0; j < rows.size(); ++j)
    {
      if (const double force = rows[j].law.force; touches[j].second >= 0 && force > 0.0)
      {
        Pair& pair = pairs[{ touches[j].first, touches[j].second }];
        pair.row = pair.pushing == 0 || force > rows[pair.row].law.force ? j : pair.row;
        ++pair.pushing;
      }
    }
    for (const auto& [rocks, pair] : pairs)
    {
      if (pair.pushing > 1)
      {
        continue;
      }
      const double load = rows[pair.row].law.force;
      const double radius =
        std::min(blocks[std::size_t(rocks[0])]->radius(), blocks[std::size_t(rocks[1])]->radius());
      const double patch =
        std::min(kLargestPatch * radius, std::sqrt(load / (std::numbers::pi * kCrushingStress)));
      const double most = 2.0 / 3.0 * touches[pair.row].friction * patch * load;
      const Vec3 turning = u.segment<3>(6 * rocks[0] + 3) - u.segment<3>(6 * rocks[1] + 3);
      const double viscosity = most / std::max(turning.norm(), 1e-5);
      for (int a = 0; a < 3; ++a)
      {
        const Eigen::Index i = 6 * rocks[0] + 3 + a, j = 6 * rocks[1] + 3 + a;
        k(i, i) += viscosity;
        k(j, j) += viscosity;
        k(i, j) -= viscosity;
        k(j, i) -= viscosity;
      }
    }
  }

  void move(double h, double share, const Vector& u, const std::vector<Row>& rows)
  {
    for (std::size_t j = 0; j < rows.size(); ++j)
    {
      const Row& row = rows[j];
      Touch& touch = touches[j];
      Contact& c = touch.contact;
      touch.force += share * row.law.force * row.axes[0];
      c.state = row.law.state;
      c.slip.setZero();
      if (c.closed())
      {
        c.slip = row.axes[1] * row.law.slip1[0] + row.axes[2] * row.law.slip1[1];
      }
      c.distance += h * row.gradients[0].dot(u);
      c.point += h * u.segment<3>(6 * (touch.pointOf() < 0 ? touch.first : touch.pointOf()));
    }
    for (std::size_t i = 0; i < states.size(); ++i)
    {
      BlockState& s = states[i];
      s.velocity = u.segment<3>(6 * Eigen::Index(i));
      const Vec3 spin = u.segment<3>(6 * Eigen::Index(i) + 3);
      s.position += h * s.velocity;
      s.orientation = (cayley(Vec3(h * spin)) * s.orientation).normalized();
      s.spin = s.orientation.conjugate() * spin;
    }
  }
};

} // namespace rockfall::testing
