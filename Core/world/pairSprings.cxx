#include "world/pairSprings.h"

#include "contact/ground/motion.h"
#include "contact/impactMode.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

PairStiffness pairStiffness(const SimulationParameters& parameters)
{
  return { parameters.pairPenalty(), parameters.shearRatio, parameters.rigid };
}

namespace
{

/// The deepest overlap (m) at which a spring (N/m) holds no more energy than two that meet at
/// `speed` (m/s) have between them. `mass`: the reduced one, kg; `radius`: the smaller one, m. What
/// is deeper others have pressed in.
double deepestBetween(double radius, double speed, double mass, double stiffness)
{
  return std::max(kFirm * radius, kSomeMore * speed * std::sqrt(mass / stiffness));
}

PairSprings springsOf(const WorldState& world, const RockPair& pair)
{
  const RockBody& a = world.rocks[std::size_t(pair.first)].body();
  const RockBody& b = world.rocks[std::size_t(pair.second)].body();
  return { pairStiffness(world.parameters), pair.law.damping, a.block, a.state, &b.block,
    &b.state };
}

} // namespace

void stiffenPressed(SingleRock& sim)
{
  const double r = sim.body().block.radius(), mass = sim.body().block.mass();
  double speed = sim.body().state.velocity.norm() + sim.body().state.spin.norm() * r;
  if (const ImpactEvent* impact = sim.fall().impact.underWay())
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

void setSprings(const WorldState& world, const RockPair& pair, Contact& c)
{
  springsOf(world, pair).set(c);
}

} // namespace rockfall
