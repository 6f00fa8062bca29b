// What comes of a crowd's step: into the bodies' states and the contacts' springs.

#include "system/CrowdSolver.h"

#include "base/parallel.h"
#include "solver/contactLaw.h"

namespace rockfall
{

void CrowdSolver::write(const StepRequest& request, std::vector<GroupBody>& bodies,
  std::vector<GroupContact>& contacts, GroupOutcome& outcome)
{
  const auto writeContact = [&](std::size_t k)
  {
    Row& row = rows_[k];
    GroupContact& group = contacts[k];
    Contact& c = *group.contact;
    const crowd::Batch& p = batches_[std::size_t(row.batch)];
    const int lane = row.lane;
    const Vec3 way = this->travel(row);
    const Vec3 force(p.force[0][lane], p.force[1][lane], p.force[2][lane]);
    const double gap1 = row.gap0 + way[0];
    const bool bounced = group.bounce >= 0.0;
    group.work = 0.0;
    row.done[0] = row.done[1] = row.frictionWork = row.dampedWork = 0.0;
    row.normalEnergy = row.springEnergy = 0.0;
    c.distance = gap1 + c.offset;
    // Where its rock has carried it: by this the next step knows it again.
    const int carrier = c.kind == ContactKind::FaceVertex ? group.second : group.first;
    if (carrier >= 0)
    {
      const Work& w = work_[std::size_t(carrier)];
      c.point = w.position + w.way + w.turned * (c.point - w.position);
    }
    c.normalForce = force[0];
    c.shearForce = 0.0;
    if (force[0] == 0.0 && !c.closed() && (bounced || gap1 >= 0.0))
    {
      return; // open before and after
    }
    const auto direction = [&](int i)
    { return Vec3(p.directions[i][0][lane], p.directions[i][1][lane], p.directions[i][2][lane]); };
    const Vec3 u = direction(1), v = direction(2);
    // The states are those of where the rocks end; the forces that the rocks were moved with are
    // the ones that are booked.
    ContactLaw law;
    law.gap0 = row.gap0;
    law.penalty = row.penalty;
    law.shearPenalty = row.shearPenalty;
    law.friction = group.friction;
    law.cohesion = group.cohesion;
    law.slip0 = { p.slip[0][lane], p.slip[1][lane] };
    law.evaluate(true, h_, p.gap[lane] + way[0], way.tail<2>());
    law.force = force[0];
    law.shearForce = force.tail<2>();
    c.shearForce = law.shearForce.norm();
    const bool closed = !bounced && law.gap1 < 0.0;
    row.frictionWork =
      bounced ? -law.shearForce.dot(way.tail<2>()) : law.frictionWork(way.tail<2>());
    row.dampedWork = bounced ? -law.force * (gap1 - row.gap0) : 0.0;
    if (closed)
    {
      row.normalEnergy = law.normalEnergy();
      row.springEnergy = row.normalEnergy + law.shearEnergy();
    }
    if (group.second >= 0)
    {
      const Vec3 push = force[0] * direction(0) + force[1] * u + force[2] * v;
      for (int side = 0; side < 2; ++side)
      {
        const Work& w = work_[std::size_t(p.body[side][lane])];
        const Vec3 lever(p.lever[side][0][lane], p.lever[side][1][lane], p.lever[side][2][lane]);
        row.done[side] = (side == 0 ? 1.0 : -1.0) * push.dot(w.way + w.spun.cross(lever));
      }
      group.work = -row.done[0] - row.done[1];
    }
    if (closed)
    {
      c.state = law.state == ContactState::Open ? ContactState::Sliding : law.state;
      c.slip = u * law.slip1[0] + v * law.slip1[1];
    }
    else
    {
      c.state = ContactState::Open;
      c.slip.setZero();
    }
  };
  forEach(contacts.size(), kRowGrain, writeContact);
  const auto writeBody = [&](std::size_t i)
  {
    const Work& w = work_[i];
    GroupBody& body = bodies[i];
    BlockState& state = *body.state;
    body.given = body.frictionWork = body.dampedWork = 0.0;
    body.springEnergy = body.normalEnergy = 0.0;
    state.time += request.duration;
    state.position += w.way;
    state.velocity = w.way / h_ + w.offset;
    state.orientation = (w.turn * state.orientation).normalized();
    state.spin = w.rotation.transpose() * (w.spun / h_ + w.spinOffset);
  };
  forEach(bodies.size(), kBodyGrain, writeBody);
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    const Row& row = rows_[k];
    GroupBody& first = bodies[std::size_t(contacts[k].first)];
    if (contacts[k].second < 0)
    {
      first.frictionWork += row.frictionWork;
      first.dampedWork += row.dampedWork;
      first.normalEnergy += row.normalEnergy;
      first.springEnergy += row.springEnergy;
    }
    else
    {
      outcome.frictionWork += row.frictionWork;
      outcome.dampedWork += row.dampedWork;
      first.given -= row.done[0];
      bodies[std::size_t(contacts[k].second)].given -= row.done[1];
    }
  }
}

} // namespace rockfall
