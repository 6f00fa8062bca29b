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
void StepTrees::forAll(std::size_t member, Use&& use) const
{
  const FallingRock& rock = world_.rocks[std::size_t(island_.members[member])];
  const auto ask = [&](const Contact& contact, std::size_t k)
  {
    const int tree = rock.fall().structures.treeOf(contact);
    if (tree >= 0)
    {
      use(tree, contact, k);
    }
  };
  const std::vector<Contact>& contacts = rock.body().contacts;
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    ask(contacts[k], work_.slopeFirsts[member] + k);
  }
  for (std::size_t k = 0; k < work_.added.size(); ++k)
  {
    if (work_.addedTo[k].onSlope && work_.addedTo[k].of == member)
    {
      ask(work_.added[k], work_.firsts.back() + k);
    }
  }
}

template <class Use>
void StepTrees::forContacts(const Stem& stem, Use&& use) const
{
  this->forAll(stem.member,
    [&](int tree, const Contact& contact, std::size_t k)
    {
      if (tree == stem.tree)
      {
        use(contact, k);
      }
    });
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
  const auto takeBack = [&](int, const Contact& c, std::size_t k)
  {
    const Vec3 impulse = h * work_.solver.force(k) * c.normal;
    const Mat3 back = end.orientation.toRotationMatrix().transpose();
    end.velocity -= impulse / body.block.mass();
    end.spin -=
      body.block.inverseInertia() * (back * (c.point - body.state.position).cross(impulse));
  };
  this->forAll(stem.member, takeBack);
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
  return meets &&
    (stem.driven > fall.structures.capacityOf(stem.tree) ||
      !fall.structures.stemHolds(stem.tree, body, end, body.contacts));
}

StepTrees::Stem StepTrees::pushOf(std::size_t member, int tree, double h) const
{
  Stem stem{ member, tree, Stem::Stands::Asked };
  double all = 0.0;
  const auto add = [&](const Contact& c, std::size_t k)
  {
    const double impulse = h * work_.solver.force(k);
    all += impulse;
    stem.push += impulse * c.normal;
    stem.at += impulse * c.point;
  };
  this->forContacts(stem, add);
  if (!(all > 0.0))
  {
    return stem;
  }
  stem.at /= all;
  const BlockState end = this->endOf(stem);
  stem.away =
    std::max(0.0, -approachOf(end, end.angularVelocity(), stem.at, stem.push.normalized()));
  return stem;
}

double StepTrees::takenByAll(int tree) const
{
  double sum = world_.drivenInto(tree);
  for (const int i : island_.members) // in the parts of this Δt, of which others have not heard
  {
    sum += world_.rocks[std::size_t(i)].fall().structures.notedDriven(tree);
  }
  for (const Stem& stem : work_.stems)
  {
    sum += stem.tree == tree ? stem.taken : 0.0;
  }
  return sum;
}

double StepTrees::takenOf(const Stem& stem, double h) const
{
  const BlockState end = this->endOf(stem);
  const double v = approachOf(end, end.angularVelocity(), stem.at, stem.push.normalized());
  // What rests or creeps gains as much within a step.
  const double slow = 2.0 * h * world_.parameters.gravity;
  if (v <= std::max(slow, this->rockOf(stem).body().restingSpeed))
  {
    return 0.0;
  }
  // No more than came into the step.
  double energy = 0.0;
  for (const int i : island_.members)
  {
    const RockBody& body = world_.rocks[std::size_t(i)].body();
    energy += body.done ? 0.0 : rigidKineticEnergy(body.block, body.state);
  }
  return std::min(energy, 0.5 * stem.push.norm() * v * v / (v + stem.away));
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
  ++work_.looks;
  for (Stem& stem : work_.stems)
  {
    stem.taken = stem.stands == Stem::Stands::Asked ? this->takenOf(stem, h) : stem.taken;
  }
  for (Stem& stem : work_.stems)
  {
    if (stem.stands == Stem::Stands::Yes && work_.looks < kTreeLooks)
    {
      // Contacts that have been found since may bring more.
      const Stem now = this->pushOf(stem.member, stem.tree, h);
      if (now.push.norm() > (1.0 + kMorePush) * stem.push.norm())
      {
        stem = now;
        this->setAbsent(stem, true);
        any = true;
      }
    }
    else if (stem.stands == Stem::Stands::Asked)
    {
      stem.driven = this->takenByAll(stem.tree);
      const bool falls = this->cannotHold(stem, this->endOf(stem), true);
      stem.stands = falls ? Stem::Stands::No : Stem::Stands::Yes;
      if (!falls)
      {
        this->setAbsent(stem, false);
        any = true;
      }
    }
  }
  if (work_.looks >= kTreeLooks)
  {
    return any;
  }
  const double fastest = world_.fastest(island_.members);
  for (std::size_t m = 0; m < island_.members.size(); ++m)
  {
    const FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
    if (rock.sim.done())
    {
      continue;
    }
    const auto ask = [&](int tree, const Contact&, std::size_t k)
    {
      if (work_.solver.force(k) <= 0.0 || this->isKnown(m, tree))
      {
        return;
      }
      const Stem stem = this->pushOf(m, tree, h);
      // A light rock that the fastest strikes leaves at twice its speed.
      const double most = stem.push.norm() * fastest;
      if (most > kAskedShare * rock.fall().structures.capacityOf(tree) ||
        this->cannotHold(stem, this->endWithout(stem, h), false))
      {
        work_.stems.push_back(stem);
        this->setAbsent(stem, true);
        any = true;
      }
    };
    this->forAll(m, ask);
  }
  return any;
}

void StepTrees::forgetSingles()
{
  std::erase_if(work_.stems,
    [&](const Stem& stem) { return work_.alone[std::size_t(this->rockOf(stem).place)] != 0; });
}

bool StepTrees::isOfAnother(const Stem& stem) const
{
  const auto falls = [&](const Stem& s)
  { return s.tree == stem.tree && s.stands == Stem::Stands::No; };
  return std::find_if(work_.stems.begin(), work_.stems.end(), falls)->member != stem.member;
}

void StepTrees::fell(std::size_t member)
{
  bool any = false;
  Fall& fall = world_.rocks[std::size_t(island_.members[member])].fall();
  RockBody& body = fall.body;
  for (const Stem& stem : work_.stems)
  {
    if (stem.member != member || stem.stands == Stem::Stands::Asked)
    {
      continue;
    }
    if (stem.stands == Stem::Stands::Yes)
    {
      fall.structures.noteDriven(stem.tree, stem.taken);
      continue;
    }
    const bool driven = stem.driven > fall.structures.capacityOf(stem.tree);
    if (driven && this->isOfAnother(stem))
    {
      applyBroken(fall, { { stem.tree }, {}, {}, {} });
      continue;
    }
    if (!driven && fall.structures.stemHolds(stem.tree, body, body.state, body.contactsBefore))
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
    fall.structures.passTree(stem.tree, held, driven, body, fall.recorder.trajectory().structures);
    any = true;
  }
  if (any)
  {
    forgetTrees(fall);
  }
}

} // namespace rockfall
