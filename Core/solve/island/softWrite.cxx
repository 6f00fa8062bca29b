#include "solve/island/softWrite.h"

#include "base/parallel.h"
#include "law/settings.h"

#include <algorithm>

namespace rockfall::soft
{

bool Writer::isDeep() const
{
  bool deep = false;
  for (std::size_t k = 0; k < rows_.rows.size() && !deep; ++k)
  {
    const ContactRow& r = rows_.rows[k];
    const double a = movers_[r.a].block->radius();
    const double radius = r.b < 0 ? a : std::min(a, movers_[r.b].block->radius());
    // The gap where the step began, whatever a look has set since.
    const double before = (*step_.contacts)[rows_.results[k].contact].contact->distance;
    deep = rows_.gapOf(k) < std::min(0.0, before) - kDeepStep * radius;
  }
  return deep;
}

void Writer::write(IslandOutcome& outcome)
{
  books_.assign(movers_.size(), { 0.0, 0.0, 0.0, 0.0, rows_.rows.size() });
  for (IslandBody& body : *step_.bodies)
  {
    body.given = 0.0;
    body.onSlope = {};
  }
  for (const IslandContact& asked : *step_.contacts)
  {
    if (asked.second < 0)
    {
      books_[std::size_t(asked.first)].held += asked.contact->springEnergy();
    }
  }
  forEach(rows_.rows.size(), kRowGrain, [&](std::size_t k) { this->writeContact(k); });
  this->bookContacts(outcome);
  for (std::size_t i = 0; i < movers_.size(); ++i)
  {
    this->writeBody(i);
  }
}

void Writer::writeContact(std::size_t row) const
{
  const ContactRow& r = rows_.rows[row];
  const Result& result = rows_.results[row];
  IslandContact& asked = (*step_.contacts)[result.contact];
  std::vector<IslandBody>& bodies = *step_.bodies;
  Contact& c = *asked.contact;
  const double gap = rows_.gapOfContact(result.contact) + c.offset;
  const int carrier = c.kind == ContactKind::FaceVertex ? asked.second : asked.first;
  if (carrier >= 0)
  {
    const Mover& m = movers_[carrier];
    const BlockState& state = *bodies[std::size_t(carrier)].state;
    const Vec3 arm = state.orientation.conjugate() * (c.point - state.position);
    c.point = state.position + m.displacement + m.orientation * arm;
  }
  asked.opening = gap - c.distance;
  asked.struck = result.struck;
  asked.struckAt = result.struckAt;
  asked.struckPoint = step_.origin + result.struckPoint;
  c.distance = gap;
  const double along = result.impulse.dot(r.normal);
  c.normalForce = std::max(0.0, along) / step_.duration;
  c.shearForce = (result.impulse - along * r.normal).norm() / step_.duration;
  asked.work = asked.second >= 0 ? result.frictionWork - result.normalWork : 0.0;
  if (r.P > 0.0 && !r.stops)
  {
    if (c.stiffness <= 0.0 || asked.bare)
    {
      const IslandBody& first = bodies[std::size_t(asked.first)];
      const IslandBody* second = asked.second < 0 ? nullptr : &bodies[std::size_t(asked.second)];
      PairSprings(step_.stiffness, asked.damping, *first.block, *first.state,
        second ? second->block : nullptr, second ? second->state : nullptr)
        .set(c);
    }
    c.state = r.T.norm() < (1.0 - 1e-9) * frictionLimit(r, r.P) ? ContactState::Locked
                                                                : ContactState::Sliding;
    // Springs that carry what it carries.
    c.offset = c.distance + r.P / (step_.h * c.stiffness);
    c.slip = (rows_.starts[row].flipped ? 1.0 : -1.0) / (step_.h * c.shearStiffness) * r.T;
  }
  else
  {
    c.state = ContactState::Open;
    c.slip.setZero();
    c.offset = std::min(0.0, c.distance);
  }
}

void Writer::bookContacts(IslandOutcome& outcome)
{
  for (std::size_t k = 0; k < rows_.rows.size(); ++k)
  {
    const ContactRow& r = rows_.rows[k];
    const Result& result = rows_.results[k];
    const IslandContact& asked = (*step_.contacts)[result.contact];
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
    StepOutcome& onSlope = (*step_.bodies)[std::size_t(r.a)].onSlope;
    const double energy = c.springEnergy();
    books_[std::size_t(r.a)].slope += work;
    onSlope.frictionWork += result.frictionWork;
    onSlope.springEnergy += energy;
    onSlope.normalEnergy +=
      energy - (c.closed() ? 0.5 * c.shearStiffness * c.slip.squaredNorm() : 0.0);
  }
}

void Writer::writeBody(std::size_t i)
{
  IslandBody& body = (*step_.bodies)[i];
  Books& books = books_[i];
  const Block& block = *body.block;
  const BlockState end = movers_.end(i);
  const auto energy = [&](const BlockState& s)
  {
    return 0.5 * block.mass() * s.velocity.squaredNorm() +
      0.5 * s.spin.dot(block.inertia() * s.spin) + block.mass() * step_.gravity * s.position.z();
  };
  // What the motion of the step leaves over is of the contact that did most.
  const double rest = energy(end) - energy(*body.state) - books.slope - books.rocks;
  if (books.by < rows_.rows.size())
  {
    IslandContact& by = (*step_.contacts)[rows_.results[books.by].contact];
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
  body.onSlope.dampedWork =
    -books.slope - body.onSlope.frictionWork + books.held - body.onSlope.springEnergy;
  *body.state = end;
  body.state->time += step_.duration;
}

} // namespace rockfall::soft
