#include "system/NewtonSolver.h"

#include "base/parallel.h"
#include "block/cayley.h"
#include "contact/features.h"
#include "law/settings.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace rockfall
{

void NewtonSolver::begin(
  const StepRequest& request, std::vector<IslandBody>& bodies, std::vector<IslandContact>& contacts)
{
  request_ = request;
  bodies_ = &bodies;
  contacts_ = &contacts;
  outcome_ = {};
  rate_ = (request.kind == StepKind::Lasting ? 1.0 : 2.0) / request.duration;
  this->prepareBodies();
  this->prepareRows(0);
  this->levers();
  this->startRows(0);
  this->solve();
}

void NewtonSolver::prepareBodies()
{
  const double h = request_.duration;
  const bool lasting = request_.kind == StepKind::Lasting;
  const std::vector<IslandBody>& bodies = *bodies_;
  work_.resize(bodies.size());
  const auto prepareBody = [&](std::size_t i)
  {
    const IslandBody& body = bodies[i];
    const Block& block = *body.block;
    const BlockState& state = *body.state;
    Work& w = work_[i];
    w.rotation = state.orientation.toRotationMatrix();
    const Mat3 back = w.rotation.transpose();
    w.velocity0.head<3>() = state.velocity;
    w.velocity0.tail<3>() = w.rotation * state.spin;
    const Vec3 spinAcceleration = w.rotation * body.spinAcceleration;
    w.offset = -w.velocity0;
    if (lasting)
    {
      w.offset.head<3>() = 0.5 * h * body.acceleration;
      w.offset.tail<3>() = 0.5 * h * spinAcceleration;
    }
    w.inverseMass = h / (rate_ * block.mass());
    w.inverseInertia = w.rotation * ((h / rate_) * block.inverseInertia()) * back;
    w.inertia = w.rotation * ((rate_ / h) * block.inertia()) * back;
    w.position = state.position;
    // First guess: as the last step went.
    w.d.head<3>() = h * w.velocity0.head<3>() + (0.5 * h * h) * body.acceleration;
    w.d.tail<3>() = h * w.velocity0.tail<3>() + (0.5 * h * h) * spinAcceleration;
    w.last.setZero();
  };
  forEach(bodies.size(), kBodyGrain, prepareBody);
}

void NewtonSolver::prepareRows(std::size_t first)
{
  const std::vector<IslandBody>& bodies = *bodies_;
  const std::vector<IslandContact>& contacts = *contacts_;
  const bool lasting = request_.kind == StepKind::Lasting;
  rows_.resize(contacts.size());
  const auto prepareRow = [&](std::size_t further)
  {
    const std::size_t k = first + further;
    const IslandContact& asked = contacts[k];
    const Contact& c = *asked.contact;
    Row& row = rows_[k];
    row.kind = c.kind;
    row.n = row.directions[0] = c.normal;
    row.directions[1] = c.normal.unitOrthogonal();
    row.directions[2] = c.normal.cross(row.directions[1]);
    row.sides[0].body = asked.first;
    row.sides[1].body = asked.second;
    row.fixed = c.kind == ContactKind::EdgeEdge ? c.ridge[0] : c.point;
    row.sides[1].edge = c.ridge[1];
    for (int s = 0; s < 2; ++s)
    {
      Side& side = row.sides[s];
      if (side.body < 0)
      {
        continue;
      }
      const Vec3& at = c.kind == ContactKind::EdgeEdge && s == 1 ? c.ridge[0] : c.point;
      side.place = at - work_[side.body].position;
      if (c.kind == ContactKind::EdgeEdge && s == 0)
      {
        const Polyhedron& shape = bodies[side.body].block->shape();
        const std::array<int, 2>& ends = shape.edges()[c.rockFeature].vertices;
        side.edge =
          work_[side.body].rotation * (shape.vertices()[ends[1]] - shape.vertices()[ends[0]]);
      }
    }
    ContactLaw& law = row.law;
    law = ContactLaw();
    law.gap0 = row.gap0 = c.gap();
    law.penalty = c.stiffness;
    law.shearPenalty = c.shearStiffness;
    law.dashpot = lasting ? 0.0 : dashpotOver(request_.duration, c.dashpot, c.stopped);
    law.shearLag = lasting ? 0.0 : c.shearDashpot / c.shearStiffness;
    law.friction = asked.friction;
    law.cohesion = asked.cohesion;
    law.slip0 = { row.directions[1].dot(c.slip), row.directions[2].dot(c.slip) };
    law.state = c.state;
  };
  forEach(contacts.size() - first, kRowGrain, prepareRow);
}

void NewtonSolver::startRows(std::size_t first)
{
  const double h = request_.duration;
  const std::vector<IslandContact>& contacts = *contacts_;
  const auto start = [&](std::size_t further)
  {
    const std::size_t k = first + further;
    Row& row = rows_[k];
    if (contacts[k].bounce >= 0.0)
    {
      const Mat3 w = this->mobility(row);
      const auto mobile = [&](int i) { return row.directions[i].dot(w * row.directions[i]); };
      row.law.penalty = std::max(row.law.penalty, kBounceStiffness / mobile(0));
      row.law.gap0 = bounceGap(contacts[k], h, row.law.penalty * mobile(0));
      row.law.shearPenalty = std::max(row.law.shearPenalty, kBounceStiffness / mobile(1));
    }
  };
  forEach(contacts.size() - first, kRowGrain, start);
}

void NewtonSolver::append()
{
  std::vector<IslandContact>& contacts = *contacts_;
  const std::size_t first = rows_.size();
  this->prepareRows(first);
  for (std::size_t k = first; k < rows_.size(); ++k)
  {
    // The gap at the start from which this displacement leads to the one at the end.
    Row& row = rows_[k];
    Contact& c = *contacts[k].contact;
    this->lever(row);
    c.distance -= this->travel(row)[0];
    c.offset = std::min(0.0, c.distance);
    row.law.gap0 = row.gap0 = c.gap();
  }
  this->startRows(first);
}

BlockState NewtonSolver::end(std::size_t i) const
{
  const Work& w = work_[i];
  BlockState state = *(*bodies_)[i].state;
  const Vec6 velocity = rate_ * w.d + w.offset;
  state.position += w.d.head<3>();
  state.velocity = velocity.head<3>();
  state.orientation = (w.turn * state.orientation).normalized();
  state.spin = w.rotation.transpose() * velocity.tail<3>();
  return state;
}

double NewtonSolver::gap(std::size_t contact) const
{
  const Row& row = rows_[contact];
  return row.gap0 + this->travel(row)[0];
}

bool NewtonSolver::setGap(std::size_t contact, double found)
{
  Row& row = rows_[contact];
  const double change = gapChange(row.gap0, this->gap(contact), found);
  row.law.gap0 += row.law.gap0 == row.gap0 ? change : 0.0; // a bounce asks for one of its own
  row.gap0 += change;
  return change != 0.0;
}

void NewtonSolver::setAbsent(std::size_t contact)
{
  const bool absent = (*contacts_)[contact].absent;
  Row& row = rows_[contact];
  if (absent)
  {
    row.asked = row.law.gap0;
  }
  row.law.gap0 = absent ? kAbsent : row.asked;
}

void NewtonSolver::levers()
{
  const auto turnBody = [&](std::size_t i)
  {
    Work& w = work_[i];
    w.turn = cayley(w.d.tail<3>());
    w.turned = w.turn.toRotationMatrix();
  };
  forEach(work_.size(), kBodyGrain, turnBody);
  forEach(rows_.size(), kRowGrain, [&](std::size_t k) { this->lever(rows_[k]); });
}

void NewtonSolver::lever(Row& row) const
{
  // A material vector of a body, averaged over the step.
  const auto mean = [&](const Side& side, const Vec3& y)
  { return side.body < 0 ? y : Vec3(0.5 * (y + work_[side.body].turned * y)); };
  const auto middle = [&](const Side& side)
  { return Vec3(work_[side.body].position + 0.5 * work_[side.body].d.head<3>()); };
  Side &first = row.sides[0], &second = row.sides[1];
  const auto pointOn = [&](const Side& side)
  { return side.body < 0 ? row.fixed : Vec3(middle(side) + mean(side, side.place)); };
  Vec3 n = row.n, x = row.fixed;
  switch (row.kind)
  {
    case ContactKind::VertexFace:
      x = pointOn(first);
      n = mean(second, n);
      break;
    case ContactKind::FaceVertex:
      x = pointOn(second);
      n = mean(first, n);
      break;
    case ContactKind::EdgeEdge:
    {
      const Vec3 p = pointOn(first), q = pointOn(second);
      const Vec3 u = mean(first, first.edge), w = mean(second, second.edge);
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
  row.directions[0] = n;
  for (Side& side : row.sides)
  {
    if (side.body >= 0)
    {
      side.lever = x - middle(side);
    }
  }
}

Mat3 NewtonSolver::mobility(const Row& row) const
{
  Mat3 sum = Mat3::Zero();
  for (const Side& side : row.sides)
  {
    if (side.body >= 0)
    {
      const Work& w = work_[side.body];
      Mat3 cross;
      cross << 0.0, -side.lever.z(), side.lever.y(), side.lever.z(), 0.0, -side.lever.x(),
        -side.lever.y(), side.lever.x(), 0.0;
      sum.diagonal().array() += w.inverseMass;
      sum -= cross * w.inverseInertia * cross;
    }
  }
  return sum;
}

Vec3 NewtonSolver::displacementOf(const Side& side) const
{
  const Vec6& d = work_[side.body].d;
  return d.head<3>() + d.tail<3>().cross(side.lever);
}

Vec3 NewtonSolver::meanDisplacementOf(const Side& side) const
{
  const Work& w = work_[side.body];
  const Vec6 mean = (0.5 * request_.duration) * (w.velocity0 + rate_ * w.d + w.offset);
  return mean.head<3>() + mean.tail<3>().cross(side.lever);
}

Vec3 NewtonSolver::travel(const Row& row) const
{
  Vec3 displacement = Vec3::Zero();
  double sign = 1.0;
  for (const Side& side : row.sides)
  {
    if (side.body >= 0)
    {
      displacement += sign * this->displacementOf(side);
    }
    sign = -1.0;
  }
  return { row.directions[0].dot(displacement), row.directions[1].dot(displacement),
    row.directions[2].dot(displacement) };
}

bool NewtonSolver::evaluate()
{
  const double h = request_.duration;
  const bool lasting = request_.kind == StepKind::Lasting;
  std::atomic<bool> changed = false;
  const auto evaluateRow = [&](std::size_t k)
  {
    Row& row = rows_[k];
    const Vec3 displacement = this->travel(row);
    if (row.law.evaluate(lasting, h, row.law.gap0 + displacement[0], displacement.tail<2>()))
    {
      changed.store(true, std::memory_order_relaxed);
    }
  };
  forEach(rows_.size(), kRowGrain, evaluateRow);
  return changed;
}

void NewtonSolver::loads()
{
  const double h = request_.duration;
  const std::vector<IslandBody>& bodies = *bodies_;
  const auto loadBody = [&](std::size_t i)
  {
    Work& w = work_[i];
    const Vec6 change = (w.velocity0 - w.offset) / h;
    const double mass = bodies[i].block->mass();
    w.load.head<3>() = mass * (change.head<3>() - request_.gravity * Vec3::UnitZ());
    // The momentum of rotation is carried to the end of the step: R₁ p₁ − R₀ p₀ = h τ
    // (METHOD 10.4). inertia holds rate/h.
    const double unit = h / rate_;
    const Vec3 momentum = unit * (w.inertia * (rate_ * w.d + w.offset).tail<3>());
    w.load.tail<3>() = unit * (w.inertia * change.tail<3>()) - (w.turned * momentum - momentum) / h;
    w.free.head<3>() = w.inverseMass * w.load.head<3>();
    w.free.tail<3>() = w.inverseInertia * w.load.tail<3>();
  };
  forEach(bodies.size(), kBodyGrain, loadBody);
}

} // namespace rockfall
