#include "world/StepTrees.h"

#include "block/Block.h"
#include "law/settings.h"
#include "rock/fall/atStructures.h"

#include <algorithm>

namespace rockfall
{

StepTrees::StepTrees(WorldState& world, const Island& island, IslandWork& work)
  : world_(world)
  , island_(island)
  , work_(work)
  , obstacles_(world.surface.terrain().obstacles())
{
}

const FallingRock& StepTrees::rockOf(const Stem& stem) const
{
  return world_.rocks[std::size_t(island_.members[stem.member])];
}

template <class Use>
void StepTrees::forContacts(const Stem& stem, Use&& use) const
{
  const FallingRock& rock = this->rockOf(stem);
  const std::vector<Contact>& contacts = rock.body().contacts;
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    if (rock.fall().structures.treeOf(contacts[k]) == stem.tree)
    {
      use(contacts[k], work_.slopeFirsts[stem.member] + k);
    }
  }
}

void StepTrees::setAbsent(const Stem& stem, bool absent)
{
  const auto set = [&](const Contact&, std::size_t k)
  {
    work_.contacts[k].absent = absent;
    work_.solver.setAbsent(k);
  };
  this->forContacts(stem, set);
}

BlockState StepTrees::endOf(const Stem& stem) const
{
  return work_.solver.end(std::size_t(this->rockOf(stem).place));
}

BlockState StepTrees::endWithout(const Stem& stem, double h) const
{
  const FallingRock& rock = this->rockOf(stem);
  const RockBody& body = rock.body();
  BlockState end = this->endOf(stem);
  for (std::size_t i = 0; i < body.contacts.size(); ++i)
  {
    const Contact& c = body.contacts[i];
    const std::size_t k = work_.slopeFirsts[stem.member] + i;
    if (rock.fall().structures.treeOf(c) < 0)
    {
      continue;
    }
    const Vec3 impulse = h * work_.solver.force(k) * c.normal;
    const Mat3 back = end.orientation.toRotationMatrix().transpose();
    end.velocity -= impulse / body.block.mass();
    end.spin -=
      body.block.inverseInertia() * (back * (c.point - body.state.position).cross(impulse));
  }
  return end;
}

bool StepTrees::cannotHold(const Stem& stem, const BlockState& end, bool through) const
{
  const Fall& fall = this->rockOf(stem).fall();
  const RockBody& body = fall.body;
  bool meets = false;
  const auto look = [&](const Contact& c, std::size_t k)
  {
    const Vec3 lever = c.point - body.state.position;
    const double approach = -c.normal.dot(end.velocity + end.angularVelocity().cross(lever));
    meets = meets ||
      (approach > (c.closed() ? body.restingSpeed : 0.0) &&
        (!through || work_.solver.gap(k) < 0.0));
  };
  this->forContacts(stem, look);
  return meets && !fall.structures.stemHolds(stem.tree, body, end, body.contacts);
}

bool StepTrees::isKnown(std::size_t member, int tree) const
{
  return std::any_of(work_.stems.begin(), work_.stems.end(),
    [&](const Stem& s) { return s.member == member && s.tree == tree; });
}

void StepTrees::stand()
{
  for (const Stem& stem : work_.stems)
  {
    this->forContacts(
      stem, [&](const Contact&, std::size_t k) { work_.contacts[k].absent = false; });
  }
  work_.stems.clear();
  work_.looks = 0;
}

bool StepTrees::look(double h)
{
  if (!obstacles_ || obstacles_->structures().trees.empty())
  {
    return false;
  }
  bool any = false;
  for (Stem& stem : work_.stems)
  {
    if (stem.stands == Stem::Stands::Asked)
    {
      const bool falls = this->cannotHold(stem, this->endOf(stem), true);
      stem.stands = falls ? Stem::Stands::No : Stem::Stands::Yes;
      if (!falls)
      {
        this->setAbsent(stem, false);
        any = true;
      }
    }
  }
  if (++work_.looks >= kTreeLooks)
  {
    return any;
  }
  for (std::size_t m = 0; m < island_.members.size(); ++m)
  {
    const FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
    if (rock.sim.done())
    {
      continue;
    }
    const std::vector<Contact>& contacts = rock.body().contacts;
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
      const int tree = rock.fall().structures.treeOf(contacts[k]);
      if (tree < 0 || work_.solver.force(work_.slopeFirsts[m] + k) <= 0.0 || this->isKnown(m, tree))
      {
        continue;
      }
      const Stem stem{ m, tree, Stem::Stands::Asked };
      if (this->cannotHold(stem, this->endWithout(stem, h), false))
      {
        work_.stems.push_back(stem);
        this->setAbsent(stem, true);
        any = true;
      }
    }
  }
  return any;
}

void StepTrees::fell(std::size_t member)
{
  bool any = false;
  Fall& fall = world_.rocks[std::size_t(island_.members[member])].fall();
  RockBody& body = fall.body;
  for (const Stem& stem : work_.stems)
  {
    if (stem.member != member || stem.stands != Stem::Stands::No)
    {
      continue;
    }
    if (fall.structures.stemHolds(stem.tree, body, body.state, body.contactsBefore))
    {
      // Others have taken it since: it holds from here on.
      for (Contact& c : body.contacts)
      {
        c.offset =
          fall.structures.treeOf(c) == stem.tree ? std::min(c.offset, c.distance) : c.offset;
      }
      continue;
    }
    // Energy that its springs held when the step began is gone with it, and booked as a loss of the
    // step.
    double held = 0.0;
    for (const Contact& c : body.contactsBefore)
    {
      if (fall.structures.treeOf(c) == stem.tree)
      {
        const double all = c.springEnergy();
        held += all;
        body.energy.restitution -= all;
      }
    }
    fall.structures.passTree(stem.tree, held, body, fall.recorder.trajectory().structures);
    any = true;
  }
  if (any)
  {
    forgetTrees(fall);
  }
}

} // namespace rockfall
