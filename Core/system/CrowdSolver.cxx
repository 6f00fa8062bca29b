#include "system/CrowdSolver.h"

#include "block/cayley.h"
#include "contact/features.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// How often the turn of a free body is gone over for the first guess of a step.
constexpr int kFreeTurns = 2;
/// Levers and gyroscopic moments are brought up to date where a rock has turned otherwise than
/// guessed by more than this, rad: gaps are right to the square of it.
constexpr double kTurnGuessed = 0.02;

void setLane(double (&of)[3][crowd::kLanes], int lane, const Vec3& to)
{
  of[0][lane] = to[0];
  of[1][lane] = to[1];
  of[2][lane] = to[2];
}

} // namespace

void CrowdSolver::turnAs(Work& w, const Vec3& spun) const
{
  w.turn = cayley(spun);
  w.turned = w.turn.toRotationMatrix();
  w.mean = 0.5 * w.turned;
  w.mean.diagonal().array() += 0.5;
}

std::array<Vec3, 2> CrowdSolver::freeMotion(const GroupBody& body, const Work& w) const
{
  // The momentum of rotation is carried to the end of the step: R₁ p₁ − R₀ p₀ = h τ (METHOD 10.4).
  const Mat3 back = w.rotation.transpose();
  const Vec3 spin = w.spun / h_ + w.spinOffset;
  const Vec3 momentum = w.rotation * (body.block->inertia() * (back * spin));
  const Vec3 gained = back * (w.turned * momentum - momentum);
  Vec3 way = h_ * (w.velocity0 - w.offset);
  way.z() -= h_ * h_ * gravity_;
  return { way,
    h_ * (w.spin0 - w.spinOffset) - h_ * (w.rotation * (body.block->inverseInertia() * gained)) };
}

void CrowdSolver::prepareBodies(const StepRequest& request, const std::vector<GroupBody>& bodies)
{
  const double h = h_ = request.duration;
  gravity_ = request.gravity;
  work_.resize(bodies.size());
  const auto prepareBody = [&](std::size_t i)
  {
    const GroupBody& body = bodies[i];
    const Block& block = *body.block;
    const BlockState& state = *body.state;
    Work& w = work_[i];
    w.moved = true;
    w.rotation = state.orientation.toRotationMatrix();
    const Mat3 back = w.rotation.transpose();
    w.position = state.position;
    w.velocity0 = state.velocity;
    w.spin0 = w.rotation * state.spin;
    const Vec3 spinAcceleration = w.rotation * body.spinAcceleration;
    w.offset = 0.5 * h * body.acceleration;
    w.spinOffset = 0.5 * h * spinAcceleration;
    w.inverseMass = h * h / block.mass();
    w.inverseInertia = w.rotation * ((h * h) * block.inverseInertia()) * back;
    // First guess: as the last step went.
    w.way = h * w.velocity0 + (0.5 * h * h) * body.acceleration;
    w.spun = h * w.spin0 + (0.5 * h * h) * spinAcceleration;
    for (int k = 0; k < kFreeTurns && body.spinAcceleration.isZero(0.0); ++k)
    {
      // … but turning as a free body does, that keeps its angular momentum: taken for constant, its
      // spin would gain energy from the gyroscopic moment.
      this->turnAs(w, w.spun);
      w.spun = this->freeMotion(body, w)[1];
    }
    this->turnAs(w, w.spun);
  };
  forEach(bodies.size(), kBodyGrain, prepareBody);
}

void CrowdSolver::prepareRow(
  const std::vector<GroupBody>& bodies, const GroupContact& group, Row& row)
{
  const Contact& c = *group.contact;
  crowd::Batch& p = batches_[std::size_t(row.batch)];
  const int lane = row.lane;
  const Vec3 u = c.normal.unitOrthogonal(), v = c.normal.cross(u);
  setLane(p.directions[1], lane, u);
  setLane(p.directions[2], lane, v);
  row.gap0 = c.gap();
  row.penalty = c.stiffness;
  row.shearPenalty = c.shearStiffness;
  p.slip[0][lane] = u.dot(c.slip);
  p.slip[1][lane] = v.dot(c.slip);
  p.friction[lane] = group.friction;
  p.cohesion[lane] = group.cohesion;
  const bool closed = c.closed() && group.bounce < 0.0 && c.normalForce > 0.0;
  // The sweeps start from the forces of the last step.
  if (closed)
  {
    setLane(forces_[std::size_t(row.batch)].along, lane,
      { c.normalForce, -row.shearPenalty * p.slip[0][lane], -row.shearPenalty * p.slip[1][lane] });
  }
  this->lever(bodies, group, row);
  p.gap[lane] = row.gap0;
  if (group.bounce >= 0.0)
  {
    row.penalty = std::max(row.penalty, kBounceStiffness / p.w[lane]);
    p.gap[lane] = bounceGap(group, h_, row.penalty * p.w[lane]);
    row.shearPenalty = std::max(row.shearPenalty, kBounceStiffness / p.w[lane]);
    this->lever(bodies, group, row);
  }
}

void CrowdSolver::lever(
  const std::vector<GroupBody>& bodies, const GroupContact& group, const Row& row)
{
  const Contact& c = *group.contact;
  crowd::Batch& p = batches_[std::size_t(row.batch)];
  const int lane = row.lane;
  const Work& a = work_[std::size_t(group.first)];
  const Work* b = group.second < 0 ? nullptr : &work_[std::size_t(group.second)];
  const Vec3 middleA = a.position + 0.5 * a.way;
  const Vec3 middleB = b ? Vec3(b->position + 0.5 * b->way) : Vec3(Vec3::Zero());
  const auto onA = [&](const Vec3& at) -> Vec3 { return middleA + a.mean * (at - a.position); };
  const auto onB = [&](const Vec3& at) -> Vec3
  { return b ? Vec3(middleB + b->mean * (at - b->position)) : at; };
  Vec3 n = c.normal, x = c.point;
  switch (c.kind)
  {
    case ContactKind::VertexFace:
      x = onA(c.point);
      n = b ? Vec3(b->mean * n) : n;
      break;
    case ContactKind::FaceVertex:
      x = onB(c.point);
      n = a.mean * n;
      break;
    case ContactKind::EdgeEdge:
    {
      const Polyhedron& shape = bodies[std::size_t(group.first)].block->shape();
      const std::array<int, 2>& ends = shape.edges()[c.rockFeature].vertices;
      const Vec3 u =
        a.mean * (a.rotation * (shape.vertices()[ends[1]] - shape.vertices()[ends[0]]));
      const Vec3 w = b ? Vec3(b->mean * c.ridge[1]) : c.ridge[1];
      const Vec3 q = onB(c.ridge[0]);
      double s, t;
      x = onA(c.point);
      if (closestOnLines(x, u, q, w, s, t))
      {
        const Vec3 cross = u.cross(w).normalized();
        n = cross.dot(c.normal) < 0.0 ? Vec3(-cross) : cross;
        x += s * u;
      }
      break;
    }
  }
  setLane(p.directions[0], lane, n);
  const std::array<Vec3, 3> directions = { n, laneOf(p.directions[1], lane),
    laneOf(p.directions[2], lane) };
  // J A⁻¹ Jᵀ
  double nn = 0.0, nu = 0.0, nv = 0.0, uu = 0.0, vv = 0.0, uv = 0.0;
  for (int side = 0; side < 2; ++side)
  {
    if (side == 1 && !b)
    {
      setLane(p.lever[1], lane, Vec3::Zero());
      break;
    }
    const Work& of = side == 0 ? a : *b;
    const Vec3 arm = x - (side == 0 ? middleA : middleB);
    setLane(p.lever[side], lane, arm);
    const Vec3 jn = arm.cross(directions[0]), ju = arm.cross(directions[1]);
    const Vec3 jv = arm.cross(directions[2]);
    const Vec3 in = of.inverseInertia * jn, iu = of.inverseInertia * ju;
    const Vec3 iv = of.inverseInertia * jv;
    nn += of.inverseMass * directions[0].squaredNorm() + jn.dot(in);
    nu += of.inverseMass * directions[0].dot(directions[1]) + ju.dot(in);
    nv += of.inverseMass * directions[0].dot(directions[2]) + jv.dot(in);
    uu += of.inverseMass + ju.dot(iu);
    vv += of.inverseMass + jv.dot(iv);
    uv += ju.dot(iv);
  }
  p.w[lane] = nn;
  p.coupling[0][lane] = nu;
  p.coupling[1][lane] = nv;
  p.stiffness[lane] = row.penalty / (1.0 + row.penalty * nn);
  p.shear[lane] = 1.0 / row.shearPenalty;
  const double mobile = std::max(uu, vv) + std::abs(uv);
  p.gain[lane] = row.shearPenalty / (1.0 + row.shearPenalty * mobile);
}

void CrowdSolver::pushed(const Row& row, double sign)
{
  const crowd::Batch& p = batches_[std::size_t(row.batch)];
  const int lane = row.lane;
  const Vec3 along = sign * this->forceOf(row);
  if (along.isZero(0.0))
  {
    return;
  }
  Vec3 force = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
  {
    force += along[k] * laneOf(p.directions[k], lane);
  }
  for (int side = 0; side < 2; ++side)
  {
    const int i = p.body[side][lane];
    if (i >= int(work_.size()))
    {
      break; // the slope
    }
    crowd::Mover& m = movers_[std::size_t(i)];
    const Mat3& inertia = work_[std::size_t(line_[std::size_t(i)].second)].inverseInertia;
    const Vec3 moment = inertia * laneOf(p.lever[side], lane).cross(force);
    for (int k = 0; k < 3; ++k)
    {
      m.way[k] += m.way[3] * force[k];
      m.turn[k] += moment[k];
    }
    force = -force;
  }
}

const CrowdSolver::Work* CrowdSolver::workOf(const Row& row, int side) const
{
  const crowd::Batch& p = batches_[std::size_t(row.batch)];
  const std::size_t i = std::size_t(p.body[side][row.lane]);
  return i < work_.size() ? &work_[std::size_t(line_[i].second)] : nullptr;
}

Vec3 CrowdSolver::leverOf(const Row& row, int side) const
{
  return laneOf(batches_[std::size_t(row.batch)].lever[side], row.lane);
}

Vec3 CrowdSolver::wayOf(const Row& row, int side) const
{
  const Work* w = this->workOf(row, side);
  return w ? Vec3(w->way + w->spun.cross(this->leverOf(row, side))) : Vec3(Vec3::Zero());
}

Vec3 CrowdSolver::meanWayOf(const Row& row, int side) const
{
  const Work* w = this->workOf(row, side);
  if (!w)
  {
    return Vec3::Zero();
  }
  const Vec3 way = 0.5 * (h_ * (w->velocity0 + w->offset) + w->way);
  const Vec3 spun = 0.5 * (h_ * (w->spin0 + w->spinOffset) + w->spun);
  return way + spun.cross(this->leverOf(row, side));
}

Vec3 CrowdSolver::travel(const Row& row) const
{
  const crowd::Batch& p = batches_[std::size_t(row.batch)];
  const int lane = row.lane;
  const Vec3 way = this->wayOf(row, 0) - this->wayOf(row, 1);
  return { laneOf(p.directions[0], lane).dot(way), laneOf(p.directions[1], lane).dot(way),
    laneOf(p.directions[2], lane).dot(way) };
}

std::array<Vec3, 2> CrowdSolver::velocities(const Row& row) const
{
  const crowd::Batch& p = batches_[std::size_t(row.batch)];
  const int lane = row.lane;
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();
  for (int side = 0; side < 2; ++side)
  {
    if (const Work* w = this->workOf(row, side))
    {
      const Vec3 lever = this->leverOf(row, side);
      const double sign = side == 0 ? 1.0 : -1.0;
      before += sign * (w->velocity0 + w->spin0.cross(lever));
      after += sign * (w->way / h_ + w->offset + (w->spun / h_ + w->spinOffset).cross(lever));
    }
  }
  Mat3 along;
  along << laneOf(p.directions[0], lane).transpose(), laneOf(p.directions[1], lane).transpose(),
    laneOf(p.directions[2], lane).transpose();
  return { along * before, along * after };
}

void CrowdSolver::startMover(const GroupBody& body, std::size_t i)
{
  const Work& w = work_[i];
  crowd::Mover& m = movers_[w.mover];
  const std::array<Vec3, 2> free = this->freeMotion(body, w);
  const Mat3& inertia = w.inverseInertia;
  for (int k = 0; k < 3; ++k)
  {
    m.way[k] = free[0][k];
    m.turn[k] = free[1][k];
    m.inertia[k] = inertia(k, k);
  }
  m.way[3] = w.inverseMass;
  m.inertia[3] = inertia(0, 1);
  m.inertia[4] = inertia(0, 2);
  m.inertia[5] = inertia(1, 2);
}

void CrowdSolver::startMovers(const std::vector<GroupBody>& bodies)
{
  movers_.assign(work_.size() + std::size_t(parts_) + 1, crowd::Mover{});
  changed_.assign(movers_.size(), 0);
  std::fill(changed_.begin() + std::ptrdiff_t(work_.size()), changed_.end(), kNever);
  forEach(work_.size(), kBodyGrain, [&](std::size_t i) { this->startMover(bodies[i], i); });
  this->forParts(false,
    [&](int part) { this->forRows(part, [&](std::size_t k) { this->pushed(rows_[k], 1.0); }); });
}

bool CrowdSolver::correctTurns(
  const std::vector<GroupBody>& bodies, const std::vector<GroupContact>& contacts)
{
  bool any = false;
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    const Vec3 spun = Eigen::Map<const Vec3>(movers_[work_[i].mover].turn);
    if ((spun - work_[i].spun).squaredNorm() > kTurnGuessed * kTurnGuessed)
    {
      any = true;
      changed_[work_[i].mover] = sweep_;
      work_[i].moved = true;
      work_[i].spun = spun;
    }
  }
  if (!any)
  {
    return false;
  }
  // Levers lie between places that are of one kind, guessed or solved.
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    this->goTo(work_[i], Eigen::Map<const Vec3>(movers_[work_[i].mover].way));
  }
  const auto wrong = [&](int i)
  { return i >= 0 && changed_[work_[std::size_t(i)].mover] == sweep_; };
  wrong_.resize(rows_.size());
  forEach(rows_.size(), kRowGrain,
    [&](std::size_t k) { wrong_[k] = wrong(contacts[k].first) || wrong(contacts[k].second); });
  const auto forTheirRows = [&](auto&& change)
  {
    const auto ifWrong = [&](std::size_t k)
    {
      if (wrong_[k])
      {
        change(k);
      }
    };
    this->forParts(false, [&](int part) { this->forRows(part, ifWrong); });
    for (std::size_t k = order_.size(); k < rows_.size(); ++k)
    {
      ifWrong(k);
    }
  };
  forTheirRows([&](std::size_t k) { this->pushed(rows_[k], -1.0); });
  const auto turn = [&](std::size_t i)
  {
    if (wrong(int(i)))
    {
      this->turnAs(work_[i], work_[i].spun);
      this->startMover(bodies[i], i);
    }
  };
  forEach(work_.size(), kBodyGrain, turn);
  forTheirRows(
    [&](std::size_t k)
    {
      this->lever(bodies, contacts[k], rows_[k]);
      this->pushed(rows_[k], 1.0);
    });
  // What others press on has been moved with them.
  touched_.clear();
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    for (const int i : { contacts[k].first, contacts[k].second })
    {
      if (wrong_[k] && i >= 0 && !wrong(i))
      {
        touched_.push_back(i);
      }
    }
  }
  for (const int i : touched_)
  {
    changed_[work_[std::size_t(i)].mover] = sweep_;
  }
  return true;
}

} // namespace rockfall
