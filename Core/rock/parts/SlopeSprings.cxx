#include "rock/parts/SlopeSprings.h"

#include "law/settings.h"
#include "law/springs.h"
#include "rock/restitution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

/// Frequencies of a block on the springs of several contacts, squared, 1/s².
struct ImpactFrequency
{
  double sum = 0.0;      ///< Of each alone.
  double together = 0.0; ///< Of what they stop together (tuneTogether).

  void add(const Contact& c, bool acts)
  {
    this->sum += acts ? c.frequency2 : 0.0;
    this->together = std::max(this->together, acts ? c.stiffness / c.stopped : 0.0);
  }
  /// `one`: of one where the block is turned best.
  double ofAll(double one) const
  {
    return std::min(this->sum, std::max({ one, kOneMotionShare * this->sum, this->together }));
  }
};

/// Response of a body to a force and its moment about `at` (N, N m): fᵀ M⁻¹ f, N² / kg.
double response(const PlacedBlock& body, const Vec3& force, const Vec3& moment, const Vec3& at)
{
  const Vec3 turning = body.rotation().transpose() * (moment + (at - body.position()).cross(force));
  return force.squaredNorm() / body.block().mass() +
    turning.dot(body.block().inverseInertia() * turning);
}

/// The deepest overlap (m) at which a spring (N/m) holds no more energy than a rock brings that comes
/// at `speed` (m/s). What is deeper others have pressed in.
double deepestOf(const Block& block, double speed, double stiffness)
{
  return std::max(kFirm * block.radius(), kSomeMore * speed * std::sqrt(block.mass() / stiffness));
}

} // namespace

SlopeSprings::SlopeSprings(
  const Surface& surface, const SimulationParameters& parameters, const Block& block)
  : surface_(surface)
  , parameters_(parameters)
  , least_(parameters.penaltyFor(block.mass()))
  , penalty_(least_)
{
}

void SlopeSprings::part(const RockBody& body)
{
  least_ = parameters_.penaltyFor(body.block.mass());
  penalty_ = this->stoppingPenalty(body);
}

void SlopeSprings::join(RockBody& body)
{
  least_ = parameters_.pairPenalty();
  penalty_ = this->stoppingPenalty(body, springEnergyOf(body.contacts));
  for (Contact& c : body.contacts)
  {
    if (!c.closed())
    {
      continue;
    }
    const Vec3 y = body.placed.rotation().transpose() * (c.point - body.state.position);
    const Vec3 n = body.placed.rotation().transpose() * c.normal;
    const Stiffness softer = this->stiffnessAt(body, n, n.unitOrthogonal(), y);
    const double normal = softer.normal / c.stiffness, shear = softer.shear / c.shearStiffness;
    if (normal >= 1.0)
    {
      continue;
    }
    // As far on in its swing as before, so that an impact leaves at the same speed.
    c.offset = c.distance - c.gap() / std::sqrt(normal);
    c.slip /= std::sqrt(shear);
    c.stiffness *= normal;
    c.frequency2 *= normal;
    c.dashpot *= std::sqrt(normal);
    c.shearStiffness *= shear;
    c.shearDashpot *= std::sqrt(shear);
  }
}

double SlopeSprings::travelLimit(const RockBody& body) const
{
  const double rim = body.state.spin.norm() * body.block.radius();
  const double speed =
    body.state.velocity.norm() + rim + body.pull(parameters_.gravity) * parameters_.timeStep;
  return speed > 0.0 ? kTravelPerStep * body.block.radius() / speed : parameters_.timeStep;
}

double SlopeSprings::impactStep(const RockBody& body) const
{
  ImpactFrequency closed;
  for (const Contact& c : body.contacts)
  {
    closed.add(c, c.closed());
  }
  const double one = penalty_ * body.block.largestMobility();
  const double frequency2 = closed.sum > 0.0 ? closed.ofAll(one) : one;
  const double resolved = std::numbers::pi / (kStepsPerImpact * std::sqrt(frequency2));
  return std::min({ parameters_.timeStep, resolved, this->travelLimit(body) });
}

double SlopeSprings::touchdownStep(const RockBody& body, double h) const
{
  ImpactFrequency closing;
  const Vec3 spin = body.state.angularVelocity();
  for (const Contact& c : body.contacts)
  {
    const double approach = approachOf(body.state, spin, c.point, c.normal);
    closing.add(c, c.closed() || c.gap() < approach * h);
  }
  const double frequency2 = closing.ofAll(penalty_ * body.block.largestMobility());
  return std::min(h, std::numbers::pi / (kStepsPerImpact * std::sqrt(frequency2)));
}

bool SlopeSprings::mayLast(const RockBody& body, double h) const
{
  bool any = false;
  const Vec3 spin = body.state.angularVelocity();
  for (const Contact& c : body.contacts)
  {
    const double approach = approachOf(body.state, spin, c.point, c.normal);
    if (c.closed())
    {
      any = true;
      if (std::abs(approach) > body.restingSpeed)
      {
        return false;
      }
    }
    else if (approach > body.restingSpeed)
    {
      if (c.gap() < approach * h)
      {
        return false;
      }
    }
    else if (c.gap() <= 0.5 * parameters_.gravity * h * h && approach > -body.restingSpeed)
    {
      any = true; // laid down, not thrown
    }
  }
  return any;
}

bool SlopeSprings::holdLittle(const RockBody& body) const
{
  // At the turning point of an impact nothing moves either, but the springs hold its energy; at
  // rest they hold the weight's, ½ m v² with v = g √(m/p), several times that when the rock rolls.
  double softest = 1.0 / least_ + body.block.largestCompliance();
  for (const Contact& c : body.contacts) // those of an island are softer
  {
    softest = std::max(softest, c.closed() ? 1.0 / c.stiffness : 0.0);
  }
  const double settled =
    body.restingSpeed + 4.0 * parameters_.gravity * std::sqrt(body.block.mass() * softest);
  const double held = body.normalEnergy + (body.stiff ? 0.0 : strainEnergy(body.block, body.state));
  return held <= 0.5 * body.block.mass() * settled * settled;
}

bool SlopeSprings::carryAtRest(const RockBody& body) const
{
  const Vec3 spin = body.state.angularVelocity();
  return std::all_of(body.contacts.begin(), body.contacts.end(),
    [&](const Contact& c)
    {
      return !c.closed() ||
        std::abs(approachOf(body.state, spin, c.point, c.normal)) <= body.restingSpeed;
    });
}

double SlopeSprings::stoppingPenalty(const RockBody& body, double held) const
{
  // All that moves in one spring.
  const double depth =
    std::min(kDeepestImpact * body.block.radius(), kDeepestOfThin * body.block.thickness());
  return std::max(
    least_, 2.0 * (rigidKineticEnergy(body.block, body.state) + held) / (depth * depth));
}

void SlopeSprings::stiffen(const RockBody& body)
{
  penalty_ = std::max(penalty_, this->stoppingPenalty(body));
}

double SlopeSprings::dampingRatioFor(int ground, double restitution)
{
  if (surface_.deviationPer(ground) != DeviationPer::Iteration)
  {
    if (restitution != dampedFor_)
    {
      dampedFor_ = restitution;
      damped_ = dampingRatio(restitution);
    }
    return damped_;
  }
  // Solved for when a rock meets the class for the first time.
  const auto number = std::size_t(ground);
  dampingRatios_.resize(std::max(dampingRatios_.size(), number + 1), -1.0);
  double& ratio = dampingRatios_[number];
  if (ratio < 0.0)
  {
    ratio = dampingRatio(restitution);
  }
  return ratio;
}

SlopeSprings::Stiffness SlopeSprings::stiffnessAt(
  const RockBody& body, const Vec3& n, const Vec3& t, const Vec3& y) const
{
  const double shear = penalty_ * parameters_.shearRatio;
  const bool strains = body.stiff && !parameters_.rigid;
  const auto with = [&](double penalty, const Vec3& along)
  { return penalty / (1.0 + (strains ? penalty * body.block.compliance(along, y) : 0.0)); };
  return { with(penalty_, n), with(shear, t) };
}

void SlopeSprings::give(Contact& c, const RockBody& body, double restitution)
{
  const Vec3 lever = c.point - body.state.position;
  const Vec3 y = body.placed.rotation().transpose() * lever;
  const Vec3 n = body.placed.rotation().transpose() * c.normal;
  const Vec3 t = n.unitOrthogonal();
  const Stiffness stiffness = this->stiffnessAt(body, n, t, y);
  c.stiffness = stiffness.normal;
  c.shearStiffness = stiffness.shear;
  const double speed = body.state.velocity.norm();
  const double approach = approachOf(body.state, body.state.angularVelocity(), c.point, c.normal);
  const bool down = approach > body.restingSpeed &&
    comesDown(approach, speed, parameters_.gravity, body.block.radius());
  const int ground = surface_.restitutionClass(c.cfe);
  const double here =
    contactRestitution(surface_.terrain().restitutionMaterial(ground), restitution, approach, down);
  const double damped =
    here == restitution ? this->dampingRatioFor(ground, restitution) : dampingRatio(here);
  const double mobility = body.block.mobility(n, y);
  c.frequency2 = c.stiffness * mobility;
  c.stopped = 1.0 / mobility;
  c.dashpot = damped > 0.0 ? 2.0 * damped * std::sqrt(c.stiffness / mobility) : 0.0;
  c.shearDashpot = 2.0 * kShearDamping * std::sqrt(c.shearStiffness / body.block.mobility(t, y));
}

void SlopeSprings::tuneTogether(RockBody& body, double h) const
{
  const auto approachTo = [&body, spin = body.state.angularVelocity()](const Contact& c)
  { return approachOf(body.state, spin, c.point, c.normal); };
  const auto stops = [h](const Contact& c, double approach)
  { return c.closed() || (approach > 0.0 && c.gap() < approach * h); };
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero(), at = Vec3::Zero();
  double work = 0.0;
  int count = 0;
  bool damped = false;
  for (const Contact& c : body.contacts)
  {
    const double approach = approachTo(c);
    if (!stops(c, approach))
    {
      continue;
    }
    at = count++ == 0 ? c.point : at;
    const Vec3 f = c.stiffness * approach * c.normal;
    force += f;
    moment += (c.point - at).cross(f);
    work += c.stiffness * approach * approach;
    damped = damped || (!c.closed() && c.dashpot > 0.0);
  }
  if (count < 2 || !damped || !(work > 0.0))
  {
    return;
  }
  const double frequency2 = response(body.placed, force, moment, at) / work;
  for (Contact& c : body.contacts)
  {
    if (!c.closed() && stops(c, approachTo(c)))
    {
      const double together2 = std::max(frequency2, kLowestImpactMode * c.frequency2);
      c.dashpot *= std::sqrt(c.frequency2 / together2);
      c.stopped = c.stiffness / together2;
    }
  }
}

void SlopeSprings::stiffenPressed(RockBody& body, double fastest) const
{
  const double r = body.block.radius();
  const double speed = std::max(fastest, body.state.velocity.norm() + body.state.spin.norm() * r);
  for (Contact& c : body.contacts)
  {
    if (!c.closed() || c.gap() >= -kFirm * r)
    {
      continue;
    }
    const double share = deepestOf(body.block, speed, c.stiffness) / -c.gap();
    if (share < 1.0)
    {
      // The same force at less overlap. What the spring held more is not given back.
      const double lost = 0.5 * c.stiffness * c.gap() * c.gap() * (1.0 - share);
      c.offset = c.distance - share * c.gap();
      c.stiffness /= share;
      c.frequency2 /= share;
      c.dashpot /= std::sqrt(share);
      body.energy.restitution += lost;
      body.springEnergy = std::max(0.0, body.springEnergy - lost);
      body.normalEnergy = std::max(0.0, body.normalEnergy - lost);
    }
  }
}

} // namespace rockfall
