#include "system/GroupSolver.h"

#include "contact/features.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// A bounce is this much stiffer than the rocks are heavy: it misses its speed by so little.
constexpr double kBounceStiffness = 1e4;

Quat cayley(const Vec3& r)
{
  const double scale = 1.0 / std::sqrt(1.0 + 0.25 * r.squaredNorm());
  return Quat(scale, 0.5 * scale * r.x(), 0.5 * scale * r.y(), 0.5 * scale * r.z());
}

} // namespace

void GroupSolver::prepare(const StepRequest& request, const std::vector<GroupBody>& bodies,
  const std::vector<GroupContact>& contacts)
{
  const double h = request.duration;
  const bool lasting = request.kind == StepKind::Lasting;
  rate_ = lasting ? 1.0 / h : 2.0 / h;
  work_.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
  {
    const GroupBody& body = bodies[i];
    const Block& block = *body.block;
    const BlockState& state = *body.state;
    Work& w = work_[i];
    w.rotation = state.orientation.toRotationMatrix();
    w.velocity0.head<3>() = w.rotation.transpose() * state.velocity;
    w.velocity0.tail<3>() = state.spin;
    w.offset = -w.velocity0;
    const Vec3 acceleration = w.rotation.transpose() * body.acceleration;
    if (lasting)
    {
      w.offset.head<3>() = 0.5 * h * acceleration;
      w.offset.tail<3>() = 0.5 * h * body.spinAcceleration;
    }
    w.inverseMass = h / (rate_ * block.mass());
    w.inverseInertia = (h / rate_) * block.inverseInertia();
    w.inertia = (rate_ / h) * block.inertia();
    w.position = state.position;
    // First guess: as the last step went.
    w.d.head<3>() = h * w.velocity0.head<3>() + (0.5 * h * h) * acceleration;
    w.d.tail<3>() = h * state.spin + (0.5 * h * h) * body.spinAcceleration;
    w.last.setZero();
  }
  rows_.resize(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    const GroupContact& group = contacts[k];
    const Contact& c = *group.contact;
    Row& row = rows_[k];
    row.kind = c.kind;
    row.n = c.normal;
    row.tangent[0] = c.normal.unitOrthogonal();
    row.tangent[1] = c.normal.cross(row.tangent[0]);
    row.sides[0].body = group.first;
    row.sides[1].body = group.second;
    row.fixed = c.kind == ContactKind::EdgeEdge ? c.ridge[0] : c.point;
    for (int s = 0; s < 2; ++s)
    {
      const int i = row.sides[s].body;
      if (i < 0)
      {
        row.edge[s] = c.ridge[1];
        continue;
      }
      const Mat3& r = work_[i].rotation;
      const Vec3& at = c.kind == ContactKind::EdgeEdge && s == 1 ? c.ridge[0] : c.point;
      row.place[s] = r.transpose() * (at - bodies[i].state->position);
      if (c.kind == ContactKind::EdgeEdge)
      {
        if (s == 0)
        {
          const Polyhedron& shape = bodies[i].block->shape();
          const std::array<int, 2>& ends = shape.edges()[c.rockFeature].vertices;
          row.edge[0] = shape.vertices()[ends[1]] - shape.vertices()[ends[0]];
        }
        else
        {
          row.edge[1] = r.transpose() * c.ridge[1];
        }
      }
    }
    ContactLaw& law = row.law;
    law = ContactLaw();
    law.gap0 = row.gap0 = c.gap();
    law.penalty = c.stiffness;
    law.shearPenalty = c.shearStiffness;
    law.dashpot = lasting ? 0.0 : c.dashpot;
    law.shearLag = lasting ? 0.0 : c.shearDashpot / c.shearStiffness;
    law.friction = group.friction;
    law.cohesion = group.cohesion;
    law.slip0 = { row.tangent[0].dot(c.slip), row.tangent[1].dot(c.slip) };
    law.state = c.state;
    row.force.setZero();
  }
  this->levers();
  this->mobilities();
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    Row& row = rows_[k];
    if (contacts[k].bounce >= 0.0)
    {
      row.law.gap0 = -contacts[k].bounce * h;
      row.law.penalty = std::max(row.law.penalty, kBounceStiffness / row.w(0, 0));
      row.law.shearPenalty = std::max(row.law.shearPenalty, kBounceStiffness / row.w(1, 1));
    }
    else if (lasting && contacts[k].contact->closed())
    {
      // Gauss–Seidel starts from the forces of the last step.
      row.force[0] = contacts[k].contact->normalForce;
      row.force.tail<2>() = -row.law.shearPenalty * row.law.slip0;
    }
  }
}

void GroupSolver::levers()
{
  for (Work& w : work_)
  {
    w.turn = cayley(w.d.tail<3>());
    w.turned = w.turn.toRotationMatrix();
  }
  // A material vector of a body, averaged over the step, in the body's axes of the start.
  const auto mean = [&](int body, const Vec3& y)
  { return Vec3(0.5 * (y + work_[body].turned * y)); };
  for (Row& row : rows_)
  {
    const int a = row.sides[0].body, b = row.sides[1].body;
    Vec3 n = row.n, x = row.fixed;
    const auto pointOn = [&](int side)
    {
      const int i = row.sides[side].body;
      return i < 0 ? row.fixed
                   : Vec3(work_[i].position +
                       work_[i].rotation * (0.5 * work_[i].d.head<3>() + mean(i, row.place[side])));
    };
    const auto turnedWith = [&](int i, const Vec3& world)
    {
      const Mat3& r = work_[i].rotation;
      return Vec3(r * mean(i, r.transpose() * world));
    };
    switch (row.kind)
    {
      case ContactKind::VertexFace:
        x = pointOn(0);
        n = b < 0 ? n : turnedWith(b, n);
        break;
      case ContactKind::FaceVertex:
        x = pointOn(1);
        n = turnedWith(a, n);
        break;
      case ContactKind::EdgeEdge:
      {
        const Vec3 p = pointOn(0), q = pointOn(1);
        const Vec3 u = work_[a].rotation * mean(a, row.edge[0]);
        const Vec3 w = b < 0 ? row.edge[1] : Vec3(work_[b].rotation * mean(b, row.edge[1]));
        double s, t;
        x = p;
        if (closestOnLines(p, u, q, w, s, t))
        {
          const Vec3 cross = u.cross(w).normalized();
          n = cross.dot(row.n) < 0.0 ? Vec3(-cross) : cross;
          x = p + s * u;
        }
        break;
      }
    }
    for (int side = 0; side < 2; ++side)
    {
      Side& s = row.sides[side];
      if (s.body < 0)
      {
        continue;
      }
      const Work& w = work_[s.body];
      const double sign = side == 0 ? 1.0 : -1.0;
      const Vec3 lever = w.rotation.transpose() * (x - w.position) - 0.5 * w.d.head<3>();
      const std::array<Vec3, 3> directions = { n, row.tangent[0], row.tangent[1] };
      for (int k = 0; k < 3; ++k)
      {
        const Vec3 local = sign * (w.rotation.transpose() * directions[k]);
        s.row[k].head<3>() = local;
        s.row[k].tail<3>() = lever.cross(local);
      }
    }
  }
}

void GroupSolver::mobilities()
{
  for (Row& row : rows_)
  {
    row.w.setZero();
    for (Side& side : row.sides)
    {
      if (side.body < 0)
      {
        continue;
      }
      const Work& w = work_[side.body];
      for (int k = 0; k < 3; ++k)
      {
        side.moved[k].head<3>() = w.inverseMass * side.row[k].head<3>();
        side.moved[k].tail<3>() = w.inverseInertia * side.row[k].tail<3>();
      }
      for (int i = 0; i < 3; ++i)
      {
        for (int j = 0; j < 3; ++j)
        {
          row.w(i, j) += side.row[i].dot(side.moved[j]);
        }
      }
    }
  }
}

double GroupSolver::along(const Row& row, int direction) const
{
  double sum = 0.0;
  for (const Side& side : row.sides)
  {
    sum += side.body < 0 ? 0.0 : side.row[direction].dot(work_[side.body].d);
  }
  return sum;
}

bool GroupSolver::evaluate(double h, bool lasting)
{
  bool changed = false;
  for (Row& row : rows_)
  {
    const Eigen::Vector2d travel(this->along(row, 1), this->along(row, 2));
    changed |= row.law.evaluate(lasting, h, row.law.gap0 + this->along(row, 0), travel);
  }
  return changed;
}

void GroupSolver::loads(const StepRequest& request, const std::vector<GroupBody>& bodies)
{
  const double h = request.duration;
  for (std::size_t i = 0; i < bodies.size(); ++i)
  {
    const Block& block = *bodies[i].block;
    Work& w = work_[i];
    const Vec6 change = (w.velocity0 - w.offset) / h;
    w.load.head<3>() =
      block.mass() * (change.head<3>() - request.gravity * Vec3(w.rotation.row(2).transpose()));
    // The momentum of rotation is carried to the end of the step: R₁ p₁ − R₀ p₀ = h τ
    // (METHOD 10.4).
    const Vec3 momentum = block.inertia() * (rate_ * w.d + w.offset).tail<3>();
    w.load.tail<3>() = block.inertia() * change.tail<3>() - (w.turned * momentum - momentum) / h;
    w.free.head<3>() = w.inverseMass * w.load.head<3>();
    w.free.tail<3>() = w.inverseInertia * w.load.tail<3>();
  }
}

} // namespace rockfall
