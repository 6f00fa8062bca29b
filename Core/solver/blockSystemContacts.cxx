// Springs and friction between the rock and the blocks of the slope.

#include "solver/BlockSystem.h"

namespace rockfall
{

void BlockSystem::prepareRows(const BlockState& state, const std::vector<Contact>& contacts)
{
  rotation_ = state.orientation.toRotationMatrix();
  deform_ = Mat3::Identity() + strainTensor(state.strain);
  rows_.assign(contacts.size(), Row());
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    const Contact& c = contacts[i];
    Row& row = rows_[i];
    row.block = slope_.ofCfe[std::size_t(c.cfe)];
    row.n = rotation_.transpose() * c.normal;
    row.fixedToSlope = c.kind == ContactKind::FaceVertex;
    if (c.kind == ContactKind::VertexFace)
    {
      row.x = rock_.shape().vertices()[std::size_t(c.rockFeature)];
      row.y0 = deform_ * row.x;
    }
    else
    {
      row.y0 = rotation_.transpose() * (c.point - state.position);
      row.x = deform_.inverse() * row.y0;
    }
    row.tangent[0] = row.n.unitOrthogonal();
    row.tangent[1] = row.n.cross(row.tangent[0]);
    const SlopeBlock& block = slope_.blocks[std::size_t(row.block)];
    row.normal.tail<12>() = -block.row(c.normal, c.point);
    for (int k = 0; k < 2; ++k)
    {
      row.shear[k].tail<12>() = -block.row(rotation_ * row.tangent[k], c.point);
      row.slip0[k] = row.tangent[k].dot(rotation_.transpose() * c.slip);
    }
    row.gap0 = this->gap(c);
    row.state = c.state;
  }
}

void BlockSystem::levers(const Vec12& rock)
{
  const Mat3 turn = turnOf(rock.segment<3>(kRotation)).toRotationMatrix();
  const Mat3 strain = strainTensor(rock.segment<6>(kStrain));
  for (Row& row : rows_)
  {
    Vec3 n = row.n, lever;
    if (row.fixedToSlope)
    {
      // The node rests but for the slope's D, the face turns: normal and node as of mid-step.
      n = 0.5 * (row.n + turn * row.n);
      lever = row.y0 - 0.5 * rock.head<3>();
    }
    else
    {
      const Vec3 y1 = row.y0 + strain * row.x;
      lever = 0.5 * (y1 + turn * y1);
    }
    row.normal.head<12>() = displacementRow(n, lever, row.x);
    for (int k = 0; k < 2; ++k)
    {
      row.shear[k].head<12>() = displacementRow(row.tangent[k], lever, row.x);
    }
  }
}

bool BlockSystem::evaluate(const SystemRequest& request, const Eigen::VectorXd& d)
{
  const double p = request.normalPenalty;
  bool changed = false;
  for (Row& row : rows_)
  {
    const Vec24 both = this->pick(row, d);
    const double d0 = row.gap0, d1 = d0 + row.normal.dot(both);
    row.gap1 = d1;
    row.travel = { row.shear[0].dot(both), row.shear[1].dot(both) };
    // Force at the end of the step (Shi), or −(V(d₁) − V(d₀)) / (d₁ − d₀) with V = ½ p min(d, 0)².
    row.force = row.stiffness = row.share = 0.0;
    if (request.lasting)
    {
      row.share = d1 < 0.0 ? 1.0 : 0.0;
      row.stiffness = p * row.share;
      row.force = -row.stiffness * d1;
    }
    else if (d0 <= 0.0 && d1 <= 0.0)
    {
      row.share = 1.0;
      row.stiffness = 0.5 * p;
      row.force = -0.5 * p * (d0 + d1);
    }
    else if (d0 <= 0.0) // opens on the way
    {
      row.share = -d0 / (d1 - d0);
      row.force = 0.5 * p * d0 * d0 / (d1 - d0);
      row.stiffness = row.force / (d1 - d0);
    }
    else if (d1 <= 0.0) // closes on the way
    {
      row.share = -d1 / (d0 - d1);
      row.force = 0.5 * p * d1 * d1 / (d0 - d1);
      row.stiffness = -0.5 * p * d1 * (2.0 * d0 - d1) / ((d0 - d1) * (d0 - d1));
    }
    this->evaluateShear(request, row, changed);
  }
  return changed;
}

void BlockSystem::evaluateShear(const SystemRequest& request, Row& row, bool& changed) const
{
  row.shearForce.setZero();
  row.shearStiffness.setZero();
  row.shearCoupling.setZero();
  row.slip1.setZero();
  ContactState state = ContactState::Open;
  if (row.force > 0.0)
  {
    const double limit = request.friction * row.force + request.cohesion;
    const double weight = (request.lasting ? 1.0 : 0.5) * row.share;
    const Eigen::Vector2d stretch = row.slip0 + weight * row.travel;
    const double length = stretch.norm();
    // A slip that turned back from one iteration to the next has passed through rest.
    const bool reversed = row.direction.dot(stretch) < 0.0;
    row.direction.setZero();
    if (reversed || request.shearPenalty * length <= limit)
    {
      changed = changed || reversed;
      state = ContactState::Locked;
      row.shearForce = -request.shearPenalty * stretch;
      row.shearStiffness = request.shearPenalty * weight * Eigen::Matrix2d::Identity();
      row.slip1 = row.slip0 + row.share * row.travel;
    }
    else
    {
      // Back onto the Mohr–Coulomb limit along the slip, which depends on D through its direction
      // and through the normal force.
      state = ContactState::Sliding;
      row.direction = stretch / length;
      row.shearForce = -limit * row.direction;
      row.shearStiffness = (limit * weight / length) *
        (Eigen::Matrix2d::Identity() - row.direction * row.direction.transpose());
      row.shearCoupling = -request.friction * row.stiffness * row.direction;
      row.slip1 = row.direction * (limit / request.shearPenalty);
    }
  }
  changed = changed || state != row.state;
  row.state = state;
}

void BlockSystem::writeContacts(
  const SystemRequest& request, std::vector<Contact>& contacts, SystemOutcome& outcome) const
{
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    const Row& row = rows_[i];
    Contact& c = contacts[i];
    c.normalForce = row.force;
    c.shearForce = row.shearForce.norm();
    c.distance = row.gap1 + c.offset;
    const bool closed = row.force > 0.0 && row.gap1 < 0.0;
    c.state = closed ? row.state : ContactState::Open;
    c.slip.setZero();
    if (closed)
    {
      c.slip = rotation_ * (row.tangent[0] * row.slip1[0] + row.tangent[1] * row.slip1[1]);
      const double normal = 0.5 * request.normalPenalty * row.gap1 * row.gap1;
      outcome.normalEnergy += normal;
      outcome.springEnergy += normal + 0.5 * request.shearPenalty * row.slip1.squaredNorm();
    }
    if (row.force > 0.0)
    {
      const double before = 0.5 * request.shearPenalty * row.slip0.squaredNorm();
      const double after = closed ? 0.5 * request.shearPenalty * row.slip1.squaredNorm() : 0.0;
      outcome.frictionWork += -row.shearForce.dot(row.travel) - (after - before);
    }
  }
}

} // namespace rockfall
