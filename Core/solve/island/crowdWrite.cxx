// The end of a crowd's step: into the states of the bodies and the springs of the contacts.

#include "solve/island/CrowdSolver.h"

#include "base/parallel.h"

#include <algorithm>

namespace rockfall
{

void CrowdSolver::write()
{
  std::vector<IslandBody>& bodies = *bodies_;
  std::vector<IslandContact>& contacts = *contacts_;
  books_.resize(contacts.size());
  const auto writeRow = [&](std::size_t k)
  {
    const Row& row = rows_[k];
    IslandContact& asked = contacts[k];
    Contact& c = *asked.contact;
    const Vec3 force = this->forceOf(row);
    const double gap1 = row.gap0 + this->opened(row);
    // Where its rock has carried it: by this the next step knows it again.
    const int carrier = c.kind == ContactKind::FaceVertex ? asked.second : asked.first;
    if (carrier >= 0)
    {
      const Work& w = work_[std::size_t(carrier)];
      c.point = w.position + w.displacement + w.turned * (c.point - w.position);
    }
    if (row.isSpeculative() ||
      (force[0] == 0.0 && !c.closed() && (asked.reboundSpeed >= 0.0 || gap1 >= 0.0)))
    {
      // Open before and after, as most are.
      c.distance = gap1 + c.offset;
      c.offset = std::min(c.offset, c.distance); // as after a bounce (writeContact)
      c.normalForce = c.shearForce = asked.work = 0.0;
      books_[k] = {};
      return;
    }
    // The states are those of where the rocks end; the forces that the rocks were moved with are
    // the ones that are booked.
    const crowd::Batch& p = batches_[std::size_t(row.batch)];
    const crowd::Springs& springs = springs_[std::size_t(row.batch)];
    const int lane = row.lane;
    ContactMotion displacements;
    displacements.displacement = this->travel(row);
    ContactLaw law;
    law.gap0 = row.gap0;
    law.penalty = springs.penalty[lane];
    law.shearPenalty = springs.shear[lane];
    law.friction = asked.friction;
    law.cohesion = asked.cohesion;
    law.slip0 = { p.slip[0][lane], p.slip[1][lane] };
    law.evaluate(
      true, h_, p.gap[lane] + displacements.displacement[0], displacements.displacement.tail<2>());
    law.force = force[0];
    law.shearForce = force.tail<2>();
    displacements.means = { this->meanDisplacementOf(row, 0), this->meanDisplacementOf(row, 1) };
    books_[k] = writeContact(law,
      { laneOf(p.directions[0], lane), laneOf(p.directions[1], lane),
        laneOf(p.directions[2], lane) },
      displacements, row.gap0, asked);
  };
  this->forStrips(false, [&](int strip) { this->forContacts(strip, writeRow); });
  for (std::size_t k = order_.size(); k < contacts.size(); ++k)
  {
    writeRow(k);
  }
  addBooks(contacts, books_, bodies, outcome_);
  const auto writeBody = [&](std::size_t i)
  {
    *bodies[i].state = this->end(i);
    bodies[i].state->time += request_.duration;
  };
  forEach(bodies.size(), kBodyGrain, writeBody);
}

} // namespace rockfall
