// Trees that the rocks of an island are driven into within a step.
//
// A rock that comes to a tree by itself is told before the step whether the tree holds it
// (RockSimulator::breakTrees). Others may drive a rock into a tree that it did not come to, and the
// tree would take all that they give it. So one that carries in the solution and could not hold the
// rock as it would go without it is let go. If the rock drives on through it then with more than
// the tree's capacity the tree breaks, else it is set in again.

#include "simulation/massFallWork.h"

#include "block/Block.h"
#include "law/settings.h"

#include <algorithm>

namespace rockfall
{

/// Trees that the rocks of an island meet in a step.
struct MassFall::Trees
{
  using Stem = Workspace::Stem;

  const MassFall& fall;
  const Island& island;
  Workspace& work;

  const Member& memberOf(const Stem& stem) const
  {
    return *fall.members_[std::size_t(island.members[stem.member])];
  }
  /// use(contact, its number in the system): those of the rock with the tree.
  template <class Use>
  void forContacts(const Stem& stem, Use&& use) const
  {
    const RockSimulator& sim = this->memberOf(stem).sim;
    for (std::size_t k = 0; k < sim.body().contacts.size(); ++k)
    {
      if (sim.treeOf(sim.body().contacts[k]) == stem.tree)
      {
        use(sim.body().contacts[k], work.slopeFirsts[stem.member] + k);
      }
    }
  }
  void setAbsent(const Stem& stem, bool absent) const
  {
    this->forContacts(stem,
      [&](const Contact&, std::size_t k) { work.solver.setAbsent(work.contacts, k, absent); });
  }
  BlockState endOf(const Stem& stem) const
  {
    return work.solver.end(work.bodies, std::size_t(this->memberOf(stem).place));
  }
  /// The same without what the tree does in a step of `h`, as long as others do as they did.
  BlockState endWithout(const Stem& stem, double h) const
  {
    const RockSimulator& sim = this->memberOf(stem).sim;
    BlockState end = this->endOf(stem);
    const auto take = [&](const Contact& c, std::size_t k)
    {
      const Vec3 impulse = h * work.solver.force(k) * c.normal;
      const Mat3 back = end.orientation.toRotationMatrix().transpose();
      end.velocity -= impulse / sim.body().block.mass();
      end.spin -= sim.body().block.inverseInertia() *
        (back * (c.point - sim.body().state.position).cross(impulse));
    };
    this->forContacts(stem, take);
    return end;
  }
  /// Whether the tree cannot hold the rock that ends so, and that goes on into it. `through`: it is
  /// let go.
  bool cannotHold(const Stem& stem, const BlockState& end, bool through) const
  {
    const RockSimulator& sim = this->memberOf(stem).sim;
    const Tree& tree =
      fall.surface_.terrain().obstacles()->structures().trees[std::size_t(stem.tree)];
    bool meets = false;
    const auto look = [&](const Contact& c, std::size_t k)
    {
      const Vec3 lever = c.point - sim.body().state.position;
      const double approach = -c.normal.dot(end.velocity + end.angularVelocity().cross(lever));
      meets = meets ||
        (approach > (c.closed() ? sim.body().restingSpeed : 0.0) &&
          (!through || work.solver.gap(k) < 0.0));
    };
    this->forContacts(stem, look);
    return meets && rigidKineticEnergy(sim.body().block, end) > tree.capacity;
  }
  bool isKnown(std::size_t member, int tree) const
  {
    return std::any_of(work.stems.begin(), work.stems.end(),
      [&](const Stem& s) { return s.member == member && s.tree == tree; });
  }
};

void MassFall::standTrees(const Island& island, Workspace& work) const
{
  const Trees trees{ *this, island, work };
  for (const Workspace::Stem& stem : work.stems)
  {
    trees.forContacts(
      stem, [&](const Contact&, std::size_t k) { work.contacts[k].absent = false; });
  }
  work.stems.clear();
  work.looks = 0;
}

bool MassFall::lookAtTrees(const Island& island, double h, Workspace& work) const
{
  const Obstacles* obstacles = surface_.terrain().obstacles();
  if (!obstacles || obstacles->structures().trees.empty())
  {
    return false;
  }
  using Stem = Workspace::Stem;
  const Trees trees{ *this, island, work };
  bool any = false;
  for (Stem& stem : work.stems)
  {
    if (stem.stands == Stem::Stands::Asked)
    {
      const bool falls = trees.cannotHold(stem, trees.endOf(stem), true);
      stem.stands = falls ? Stem::Stands::No : Stem::Stands::Yes;
      if (!falls)
      {
        trees.setAbsent(stem, false);
        any = true;
      }
    }
  }
  if (++work.looks >= kTreeLooks)
  {
    return any;
  }
  for (std::size_t m = 0; m < island.members.size(); ++m)
  {
    const Member& member = *members_[std::size_t(island.members[m])];
    if (member.sim.body().done)
    {
      continue;
    }
    const std::vector<Contact>& contacts = member.sim.body().contacts;
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
      const int tree = member.sim.treeOf(contacts[k]);
      if (tree < 0 || work.solver.force(work.slopeFirsts[m] + k) <= 0.0 || trees.isKnown(m, tree))
      {
        continue;
      }
      const Stem stem{ m, tree, Stem::Stands::Asked };
      if (trees.cannotHold(stem, trees.endWithout(stem, h), false))
      {
        work.stems.push_back(stem);
        trees.setAbsent(stem, true);
        any = true;
      }
    }
  }
  return any;
}

void MassFall::fellTrees(const Island& island, std::size_t member, const Workspace& work)
{
  bool any = false;
  RockSimulator& sim = members_[std::size_t(island.members[member])]->sim;
  for (const Workspace::Stem& stem : work.stems)
  {
    if (stem.member != member || stem.stands != Workspace::Stem::Stands::No)
    {
      continue;
    }
    for (const Contact& c : sim.body().contactsBefore)
    {
      // A lasting step books what is left over as damped; one of an impact does not.
      const bool closed = c.closed() && sim.body().steppedAs == StepKind::Impact;
      if (closed && sim.treeOf(c) == stem.tree)
      {
        sim.body().energy.damping +=
          c.springEnergy() - 0.5 * c.shearStiffness * c.slip.squaredNorm();
      }
    }
    const Tree& tree = surface_.terrain().obstacles()->structures().trees[std::size_t(stem.tree)];
    if (rigidKineticEnergy(sim.body().block, sim.body().state) <= tree.capacity)
    {
      // Others have taken it since: it holds from here on.
      for (Contact& c : sim.body().contacts)
      {
        c.offset = sim.treeOf(c) == stem.tree ? std::min(c.offset, c.distance) : c.offset;
      }
      continue;
    }
    // Energy that its springs held when the step began is gone with it, and booked as a loss of the
    // step.
    double held = 0.0;
    for (std::size_t k = 0; k < sim.body().contactsBefore.size(); ++k)
    {
      const Contact& c = sim.body().contactsBefore[k];
      if (sim.treeOf(c) == stem.tree)
      {
        const double all = c.springEnergy();
        const double shear = c.closed() ? 0.5 * c.shearStiffness * c.slip.squaredNorm() : 0.0;
        const bool bounced = work.contacts[work.slopeFirsts[member] + k].bounce >= 0.0;
        held += all;
        sim.body().energy.restitution -= bounced ? all : 0.0;
        sim.body().energy.friction -= bounced ? 0.0 : shear;
        sim.body().energy.damping -= bounced ? 0.0 : all - shear;
      }
    }
    sim.breakTree(stem.tree, held);
    any = true;
  }
  if (any)
  {
    sim.forgetTrees();
  }
}

} // namespace rockfall
