#include "solve/island/island.h"

namespace rockfall
{

ContactBooks writeContact(const ContactLaw& law, const std::array<Vec3, 3>& directions,
  const ContactMotion& motion, double gap0, IslandContact& contact)
{
  Contact& c = *contact.contact;
  const Eigen::Vector2d travel = motion.displacement.tail<2>();
  const bool bounced = contact.reboundSpeed >= 0.0;
  const double stored = bounced ? c.springEnergy() : 0.0; // of an impact that was under way
  c.normalForce = law.force;
  contact.opening = motion.displacement[0];
  c.shearForce = law.shearForce.norm();
  c.distance = gap0 + motion.displacement[0] + c.offset;
  const Vec3 along = motion.means[0] - motion.means[1];
  const double mean = along.dot(directions[0]);
  const Eigen::Vector2d across(along.dot(directions[1]), along.dot(directions[2]));
  ContactBooks books;
  books.frictionWork = -law.shearForce.dot(across);
  books.dampedWork = stored - law.force * mean;
  if (!bounced)
  {
    books.frictionWork += law.shearForce.dot(travel) + law.frictionWork(travel);
    books.dampedWork += law.force * motion.displacement[0] + law.dampedWork();
  }
  if (contact.second >= 0)
  {
    const Vec3 force = law.force * directions[0] + law.shearForce[0] * directions[1] +
      law.shearForce[1] * directions[2];
    books.done = { force.dot(motion.means[0]), -force.dot(motion.means[1]) };
    contact.work = -books.done[0] - books.done[1];
  }
  if (!bounced && law.gap1 < 0.0)
  {
    books.normalEnergy = law.normalEnergy();
    books.springEnergy = books.normalEnergy + law.shearEnergy();
    c.state = law.state == ContactState::Open ? ContactState::Sliding : law.state;
    c.slip = directions[1] * law.slip1[0] + directions[2] * law.slip1[1];
  }
  else
  {
    c.state = ContactState::Open;
    c.slip.setZero();
    if (bounced)
    {
      // The bounce stands for the spring: what overlap is left was never pressed in.
      c.offset = std::min(c.offset, c.distance);
    }
  }
  return books;
}

void addBooks(const std::vector<IslandContact>& contacts, const std::vector<ContactBooks>& books,
  std::vector<IslandBody>& bodies, IslandOutcome& outcome)
{
  for (IslandBody& body : bodies)
  {
    body.given = body.frictionWork = body.dampedWork = 0.0;
    body.springEnergy = body.normalEnergy = 0.0;
  }
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    const ContactBooks& of = books[k];
    IslandBody& first = bodies[std::size_t(contacts[k].first)];
    if (contacts[k].second < 0)
    {
      first.frictionWork += of.frictionWork;
      first.dampedWork += of.dampedWork;
      first.normalEnergy += of.normalEnergy;
      first.springEnergy += of.springEnergy;
    }
    else
    {
      outcome.frictionWork += of.frictionWork;
      outcome.dampedWork += of.dampedWork;
      first.given -= of.done[0];
      bodies[std::size_t(contacts[k].second)].given -= of.done[1];
    }
  }
}

} // namespace rockfall
