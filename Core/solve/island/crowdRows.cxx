// The contacts of a crowd's step as its sweeps meet them: directions, levers, springs.

#include "solve/island/CrowdSolver.h"

#include "contact/ground/features.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

void setLane(double (&of)[3][crowd::kLanes], int lane, const Vec3& to)
{
  of[0][lane] = to[0];
  of[1][lane] = to[1];
  of[2][lane] = to[2];
}

} // namespace

void CrowdSolver::prepareRow(
  const std::vector<IslandBody>& bodies, const IslandContact& asked, Row& row)
{
  const Contact& c = *asked.contact;
  row.gap0 = c.gap();
  if (row.isSpeculative())
  {
    speculative_[row.fours()].gap[row.lane] = asked.absent ? kAbsent : row.gap0;
  }
  else
  {
    crowd::Batch& p = batches_[std::size_t(row.batch)];
    crowd::Springs& springs = springs_[std::size_t(row.batch)];
    const int lane = row.lane;
    const Vec3 u = c.normal.unitOrthogonal(), v = c.normal.cross(u);
    setLane(p.directions[1], lane, u);
    setLane(p.directions[2], lane, v);
    springs.penalty[lane] = c.stiffness;
    springs.shear[lane] = c.shearStiffness;
    p.gap[lane] = asked.absent ? kAbsent : row.gap0;
    p.slip[0][lane] = u.dot(c.slip);
    p.slip[1][lane] = v.dot(c.slip);
    p.friction[lane] = asked.friction;
    p.cohesion[lane] = asked.cohesion;
    // The sweeps start from the forces of the last step.
    if (c.closed() && asked.reboundSpeed < 0.0 && c.normalForce > 0.0)
    {
      setLane(forces_[std::size_t(row.batch)].along, lane,
        { c.normalForce, -c.shearStiffness * p.slip[0][lane],
          -c.shearStiffness * p.slip[1][lane] });
    }
  }
  this->lever(bodies, asked, row);
}

void CrowdSolver::stiffen(const IslandContact& asked, const Row& row)
{
  crowd::Batch& p = batches_[std::size_t(row.batch)];
  crowd::Springs& springs = springs_[std::size_t(row.batch)];
  const int lane = row.lane;
  const double stiff = kBounceStiffness / p.w[lane];
  springs.penalty[lane] = std::max(springs.penalty[lane], stiff);
  springs.shear[lane] = std::max(springs.shear[lane], stiff);
  this->askGap(asked, row);
  this->assemble(std::size_t(row.batch), 1);
}

void CrowdSolver::askGap(const IslandContact& asked, const Row& row)
{
  crowd::Batch& p = batches_[std::size_t(row.batch)];
  const double penalty = springs_[std::size_t(row.batch)].penalty[row.lane];
  double& gap = p.gap[row.lane];
  gap = row.gap0;
  if (asked.absent)
  {
    gap = kAbsent;
  }
  else if (asked.reboundSpeed >= 0.0)
  {
    gap = bounceGap(asked, h_, penalty * p.w[row.lane]);
  }
}

void CrowdSolver::assemble(std::size_t first, std::size_t count)
{
  kernel_->assemble(batches_.data() + first, springs_.data() + first, movers_.data(), count);
}

void CrowdSolver::prepareRows(
  const std::vector<IslandBody>& bodies, const std::vector<IslandContact>& contacts)
{
  // Strip by strip, as long as it lies in the cache.
  const auto prepareStrip = [&](int strip)
  {
    this->forContacts(
      strip, [&](std::size_t k) { this->prepareRow(bodies, contacts[k], rows_[k]); });
    this->forUsed(
      strip, [&](std::size_t first, std::size_t count) { this->assemble(first, count); });
    const std::size_t key = std::size_t(strip * kKinds);
    for (std::size_t at = this->firstOf(key); at < ends_[key + OnSlope]; ++at)
    {
      const std::size_t k = std::size_t(order_[at]);
      if (contacts[k].reboundSpeed >= 0.0)
      {
        this->stiffen(contacts[k], rows_[k]);
      }
      this->pushed(rows_[k], 1.0);
    }
  };
  this->forStrips(false, prepareStrip);
}

void CrowdSolver::lever(
  const std::vector<IslandBody>& bodies, const IslandContact& asked, const Row& row)
{
  const Contact& c = *asked.contact;
  const int lane = row.lane;
  const Work& a = work_[std::size_t(asked.first)];
  const Work* b = asked.second < 0 ? nullptr : &work_[std::size_t(asked.second)];
  const Vec3 middleA = a.position + 0.5 * a.displacement;
  const Vec3 middleB = b ? Vec3(b->position + 0.5 * b->displacement) : Vec3(Vec3::Zero());
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
      const Polyhedron& shape = bodies[std::size_t(asked.first)].block->shape();
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
  const Vec3 armA = x - middleA, armB = b ? Vec3(x - middleB) : Vec3(Vec3::Zero());
  auto* const normal = row.isSpeculative() ? speculative_[row.fours()].normal
                                           : batches_[std::size_t(row.batch)].directions[0];
  auto* const levers =
    row.isSpeculative() ? speculative_[row.fours()].lever : batches_[std::size_t(row.batch)].lever;
  for (int k = 0; k < 3; ++k)
  {
    normal[k][lane] = n[k];
    levers[0][k][lane] = armA[k];
    levers[1][k][lane] = armB[k];
  }
}

void CrowdSolver::pushed(const Row& row, double sign)
{
  if (row.isSpeculative())
  {
    return;
  }
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
      m.displacement[k] += m.displacement[3] * force[k];
      m.turn[k] += moment[k];
    }
    force = -force;
  }
}

const CrowdSolver::Work* CrowdSolver::workOf(const Row& row, int side) const
{
  const auto& body =
    row.isSpeculative() ? speculative_[row.fours()].body : batches_[std::size_t(row.batch)].body;
  const std::size_t i = std::size_t(body[side][row.lane]);
  return i < work_.size() ? &work_[std::size_t(line_[i].second)] : nullptr;
}

Vec3 CrowdSolver::leverOf(const Row& row, int side) const
{
  return laneOf(row.isSpeculative() ? speculative_[row.fours()].lever[side]
                                    : batches_[std::size_t(row.batch)].lever[side],
    row.lane);
}

Vec3 CrowdSolver::meanDisplacementOf(const Row& row, int side) const
{
  const Work* w = this->workOf(row, side);
  if (!w)
  {
    return Vec3::Zero();
  }
  const Vec3 displacement = 0.5 * (h_ * (w->velocity0 + w->offset) + w->displacement);
  const Vec3 spun = 0.5 * (h_ * (w->spin0 + w->spinOffset) + w->spun);
  return displacement + spun.cross(this->leverOf(row, side));
}

Vec3 CrowdSolver::displacementOf(
  const int (&body)[2][crowd::kLanes], const double (&lever)[2][3][crowd::kLanes], int lane) const
{
  const auto displacementOn = [&](int side) -> Vec3
  {
    const crowd::Mover& m = movers_[std::size_t(body[side][lane])]; // the slope's goes nowhere
    return Eigen::Map<const Vec3>(m.displacement) +
      Eigen::Map<const Vec3>(m.turn).cross(laneOf(lever[side], lane));
  };
  return displacementOn(0) - displacementOn(1);
}

double CrowdSolver::opened(const Row& row) const
{
  const int lane = row.lane;
  if (row.isSpeculative())
  {
    const crowd::Speculative& four = speculative_[row.fours()];
    return laneOf(four.normal, lane).dot(this->displacementOf(four.body, four.lever, lane));
  }
  const crowd::Batch& p = batches_[std::size_t(row.batch)];
  return laneOf(p.directions[0], lane).dot(this->displacementOf(p.body, p.lever, lane));
}

Vec3 CrowdSolver::travel(const Row& row) const
{
  const crowd::Batch& p = batches_[std::size_t(row.batch)];
  const int lane = row.lane;
  const Vec3 displacement = this->displacementOf(p.body, p.lever, lane);
  return { laneOf(p.directions[0], lane).dot(displacement),
    laneOf(p.directions[1], lane).dot(displacement),
    laneOf(p.directions[2], lane).dot(displacement) };
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
      after +=
        sign * (w->displacement / h_ + w->offset + (w->spun / h_ + w->spinOffset).cross(lever));
    }
  }
  Mat3 along;
  along << laneOf(p.directions[0], lane).transpose(), laneOf(p.directions[1], lane).transpose(),
    laneOf(p.directions[2], lane).transpose();
  return { along * before, along * after };
}

} // namespace rockfall
