// Springs and friction between the rock and the blocks of the slope.

#include "BlockSlope/BlockSystem.h"

namespace rockfall
{

void BlockSystem::prepareRows(
  const SystemRequest& request, const BlockState& state, const std::vector<Contact>& contacts)
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
      row.law.slip0[k] = row.tangent[k].dot(rotation_.transpose() * c.slip);
    }
    row.law.gap0 = this->gap(c);
    row.law.penalty = request.normalPenalty;
    row.law.shearPenalty = request.shearPenalty;
    row.law.friction = request.friction;
    row.law.cohesion = request.cohesion;
    row.law.state = c.state;
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
  bool changed = false;
  for (Row& row : rows_)
  {
    const Vec24 both = this->pick(row, d);
    row.travel = { row.shear[0].dot(both), row.shear[1].dot(both) };
    const double gap = row.law.gap0 + row.normal.dot(both);
    changed = row.law.evaluate(request.lasting, request.duration, gap, row.travel) || changed;
  }
  return changed;
}

void BlockSystem::writeContacts(std::vector<Contact>& contacts, SystemOutcome& outcome) const
{
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    const Row& row = rows_[i];
    const ContactLaw& law = row.law;
    Contact& c = contacts[i];
    c.normalForce = law.force;
    c.shearForce = law.shearForce.norm();
    c.distance = law.gap1 + c.offset;
    const bool closed = law.force > 0.0 && law.gap1 < 0.0;
    c.state = closed ? law.state : ContactState::Open;
    c.slip.setZero();
    if (closed)
    {
      c.slip = rotation_ * (row.tangent[0] * law.slip1[0] + row.tangent[1] * law.slip1[1]);
      outcome.normalEnergy += law.normalEnergy();
      outcome.springEnergy += law.normalEnergy() + law.shearEnergy();
    }
    if (law.force > 0.0)
    {
      outcome.frictionWork += law.frictionWork(row.travel);
    }
  }
}

} // namespace rockfall
