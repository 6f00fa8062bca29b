// A step of soft rows as its contacts and rocks take it on: motion, springs, books.

#include "base/parallel.h"
#include "law/settings.h"
#include "solve/island/softSweep.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

IslandOutcome SoftSolver::finish(Accept accept, bool deep)
{
  IslandOutcome outcome;
  for (std::size_t k = 0; k < rows_.size() && !deep; ++k)
  {
    const ContactRow& r = rows_[k];
    const double a = movers_[std::size_t(r.a)].block->radius();
    const double radius = r.b < 0 ? a : std::min(a, movers_[std::size_t(r.b)].block->radius());
    deep = this->gapOf(k) < std::min(0.0, starts_[k].gap0) - kDeepStep * radius;
  }
  outcome.settled = !deep;
  outcome.iterations = substeps_;
  outcome.accepted = !deep || accept == Accept::Any;
  if (outcome.accepted)
  {
    this->write(outcome);
  }
  return outcome;
}

void SoftSolver::write(IslandOutcome& outcome)
{
  books_.assign(movers_.size(), { 0.0, 0.0, 0.0, 0.0, rows_.size() });
  for (IslandBody& body : *bodies_)
  {
    body.given = body.frictionWork = body.dampedWork = 0.0;
    body.springEnergy = body.normalEnergy = 0.0;
  }
  for (const IslandContact& asked : *contacts_)
  {
    if (asked.second < 0)
    {
      books_[std::size_t(asked.first)].held += asked.contact->springEnergy();
    }
  }
  forEach(rows_.size(), kRowGrain, [&](std::size_t k) { this->writeContact(k); });
  this->bookContacts(outcome);
  for (std::size_t i = 0; i < movers_.size(); ++i)
  {
    this->writeBody(i);
  }
}

void SoftSolver::writeContact(std::size_t row)
{
  const ContactRow& r = rows_[row];
  const Result& result = results_[row];
  IslandContact& asked = (*contacts_)[result.contact];
  std::vector<IslandBody>& bodies = *bodies_;
  Contact& c = *asked.contact;
  const double gap = this->gap(result.contact) + c.offset;
  const int carrier = c.kind == ContactKind::FaceVertex ? asked.second : asked.first;
  if (carrier >= 0)
  {
    const Mover& m = movers_[std::size_t(carrier)];
    const BlockState& state = *bodies[std::size_t(carrier)].state;
    const Vec3 arm = state.orientation.conjugate() * (c.point - state.position);
    c.point = state.position + m.displacement + m.orientation * arm;
  }
  asked.opening = gap - c.distance;
  asked.struck = result.struck;
  asked.struckAt = result.struckAt;
  asked.struckPoint = origin_ + result.struckPoint;
  c.distance = gap;
  const double along = result.impulse.dot(r.normal);
  c.normalForce = std::max(0.0, along) / duration_;
  c.shearForce = (result.impulse - along * r.normal).norm() / duration_;
  asked.work = asked.second >= 0 ? result.frictionWork - result.normalWork : 0.0;
  if (r.P > 0.0 && !r.stops)
  {
    if (c.stiffness <= 0.0 || asked.bare)
    {
      const IslandBody& first = bodies[std::size_t(asked.first)];
      const IslandBody* second = asked.second < 0 ? nullptr : &bodies[std::size_t(asked.second)];
      PairSprings(stiffness, asked.damping, *first.block, *first.state,
        second ? second->block : nullptr, second ? second->state : nullptr)
        .set(c);
    }
    c.state = r.T.norm() < (1.0 - 1e-9) * frictionLimit(r, r.P) ? ContactState::Locked
                                                                : ContactState::Sliding;
    // Springs that carry what it carries.
    c.offset = c.distance + r.P / (h_ * c.stiffness);
    c.slip = (starts_[row].flipped ? 1.0 : -1.0) / (h_ * c.shearStiffness) * r.T;
  }
  else
  {
    c.state = ContactState::Open;
    c.slip.setZero();
    c.offset = std::min(0.0, c.distance);
  }
}

void SoftSolver::bookContacts(IslandOutcome& outcome)
{
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    const ContactRow& r = rows_[k];
    const Result& result = results_[k];
    const IslandContact& asked = (*contacts_)[result.contact];
    const double size = result.impulse.norm(), work = result.normalWork - result.frictionWork;
    for (const int i : { r.a, r.b })
    {
      if (i >= 0 && size > books_[std::size_t(i)].strongest)
      {
        books_[std::size_t(i)].strongest = size;
        books_[std::size_t(i)].by = k;
      }
    }
    if (asked.second >= 0)
    {
      books_[std::size_t(r.a)].rocks += result.workOnA;
      books_[std::size_t(r.b)].rocks += work - result.workOnA;
      outcome.frictionWork += result.frictionWork;
      outcome.dampedWork -= result.normalWork;
      continue;
    }
    const Contact& c = *asked.contact;
    IslandBody& body = (*bodies_)[std::size_t(r.a)];
    const double energy = c.springEnergy();
    books_[std::size_t(r.a)].slope += work;
    body.frictionWork += result.frictionWork;
    body.springEnergy += energy;
    body.normalEnergy +=
      energy - (c.closed() ? 0.5 * c.shearStiffness * c.slip.squaredNorm() : 0.0);
  }
}

void SoftSolver::writeBody(std::size_t i)
{
  IslandBody& body = (*bodies_)[i];
  Books& books = books_[i];
  const Block& block = *body.block;
  const BlockState end = this->end(i);
  const auto energy = [&](const BlockState& s)
  {
    return 0.5 * block.mass() * s.velocity.squaredNorm() +
      0.5 * s.spin.dot(block.inertia() * s.spin) + block.mass() * gravity_ * s.position.z();
  };
  // What the motion of the step leaves over is of the contact that did most.
  const double rest = energy(end) - energy(*body.state) - books.slope - books.rocks;
  if (books.by < rows_.size())
  {
    IslandContact& by = (*contacts_)[results_[books.by].contact];
    if (by.second >= 0)
    {
      by.work -= rest;
      books.rocks += rest;
    }
    else
    {
      books.slope += rest;
    }
  }
  body.given = -books.rocks;
  body.dampedWork = -books.slope - body.frictionWork + books.held - body.springEnergy;
  *body.state = end;
  body.state->time += duration_;
}

} // namespace rockfall
