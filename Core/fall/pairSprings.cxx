#include "fall/pairSprings.h"

#include "contact/motion.h"
#include "fall/pressedIn.h"
#include "law/settings.h"
#include "rock/impactMode.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rockfall
{

namespace
{

/// Gives contacts of a pair what they are made of, along the normal and across it side by side;
/// what only the normal decides is found once.
class PairSprings
{
public:
  PairSprings(const PlacedBlock& a, const BlockState& s, const PlacedBlock& b, const BlockState& t,
    const PairLaw& law, const SimulationParameters& parameters)
    : rigid_(parameters.rigid)
    , dampings_(std::max(0.0, law.damping), kShearDamping)
    , sides_{ { { &a.block(), a.rotation(), s.position, {} },
        { &b.block(), b.rotation(), t.position, {} } } }
  {
    const double mass = 1.0 / (1.0 / a.block().mass() + 1.0 / b.block().mass());
    const double depth = kDeepestPairImpact * std::min(a.block().radius(), b.block().radius());
    const double speed = (s.velocity - t.velocity).norm();
    const double penalty =
      std::max(parameters.normalPenalty, mass * speed * speed / (depth * depth));
    penalties_ = { penalty, penalty * parameters.shearRatio };
  }
  void set(Contact& c)
  {
    if (c.normal != normal_)
    {
      normal_ = c.normal;
      const Vec3 along = normal_.unitOrthogonal();
      for (Side& side : sides_)
      {
        side.motions =
          twoDirections(side.turn.transpose() * normal_, side.turn.transpose() * along);
      }
    }
    Two soft = Two::Zero(), mobile = Two::Zero();
    for (const Side& side : sides_)
    {
      const Vec3 x = side.turn.transpose() * (c.point - side.position);
      soft += rigid_ ? Two(Two::Zero()) : side.block->compliance(side.motions, x);
      mobile += side.block->mobility(side.motions, x);
    }
    const Two stiffnesses = penalties_ / (1.0 + penalties_ * soft);
    const Two dashpots = 2.0 * dampings_ * (stiffnesses / mobile).sqrt();
    c.stiffness = stiffnesses[0];
    c.shearStiffness = stiffnesses[1];
    c.frequency2 = c.stiffness * mobile[0];
    c.stopped = 1.0 / mobile[0];
    c.dashpot = dashpots[0];
    c.shearDashpot = dashpots[1];
  }

private:
  using Two = Eigen::Array2d;
  struct Side
  {
    const Block* block;
    Mat3 turn; ///< Body to world axes.
    Vec3 position;
    TwoDirections motions; ///< The normal and a direction across it, body axes.
  };
  bool rigid_;
  Two dampings_;
  Two penalties_; ///< N/m
  Vec3 normal_ = Vec3::Zero();
  std::array<Side, 2> sides_;
};

} // namespace

void stiffenPressed(RockSimulator& sim)
{
  const double r = sim.body().block.radius(), mass = sim.body().block.mass();
  double speed = sim.body().state.velocity.norm() + sim.body().state.spin.norm() * r;
  if (const ImpactEvent* impact = sim.impactUnderWay())
  {
    speed = std::max(speed, impact->velocityBefore.norm());
  }
  for (Contact& c : sim.body().contacts)
  {
    if (!c.closed() || c.gap() >= -kFirm * r)
    {
      continue;
    }
    const double share = deepestBetween(r, speed, mass, c.stiffness) / -c.gap();
    if (share < 1.0)
    {
      // The same force at less overlap. What the spring held more is not given back.
      const double lost = 0.5 * c.stiffness * c.gap() * c.gap() * (1.0 - share);
      c.offset = c.distance - share * c.gap();
      c.stiffness /= share;
      c.frequency2 /= share;
      c.dashpot /= std::sqrt(share);
      sim.body().energy.restitution += lost;
      sim.body().springEnergy = std::max(0.0, sim.body().springEnergy - lost);
      sim.body().normalEnergy = std::max(0.0, sim.body().normalEnergy - lost);
    }
  }
}

void setPairSprings(const FallState& fall, RockPair& pair, double h)
{
  Contact* k = pair.contacts.data();
  Contact* const end = k + pair.contacts.size();
  while (k != end && k->closed())
  {
    ++k;
  }
  if (k == end)
  {
    return;
  }
  const RockBody &a = fall.rocks[pair.first].body(), &b = fall.rocks[pair.second].body();
  PairSprings springs(a.placed, a.state, b.placed, b.state, pair.law, fall.parameters);
  for (; k != end; ++k)
  {
    if (!k->closed())
    {
      springs.set(*k);
    }
  }
  if (pair.law.damping > 0.0)
  {
    tuneDashpots(
      pair.contacts, h,
      [motion = motionOf(fall, pair)](const Contact& c)
      { return -c.normal.dot(motion.at(c.point)); },
      [&](const Vec3& force, const Vec3& moment, const Vec3& at)
      { return response(a.placed, force, moment, at) + response(b.placed, force, moment, at); });
  }
}

void setSprings(const FallState& fall, const RockPair& pair, Contact& c)
{
  const RockBody &a = fall.rocks[pair.first].body(), &b = fall.rocks[pair.second].body();
  PairSprings(a.placed, a.state, b.placed, b.state, pair.law, fall.parameters).set(c);
}

} // namespace rockfall
