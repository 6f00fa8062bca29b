#include "rock/parts/SoilUnderRock.h"

#include "block/flight.h"
#include "contact/ground/clearance.h"
#include "contact/ground/heightOver.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/parts/rollingResistance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Share of r by which rounding does not make a distance larger.
constexpr double kSureClearance = 1e-9;

/// Between two attitudes that differ by little, at a fraction of the turn.
Quat turnedBetween(const Quat& from, const Quat& to, double fraction)
{
  const double way = from.dot(to) < 0.0 ? -fraction : fraction; // q and −q are one attitude
  return Quat(((1.0 - fraction) * from.coeffs() + way * to.coeffs()).normalized());
}

} // namespace

const YieldingGround& SoilUnderRock::groundOf(int restitutionClass) const
{
  return surface_.terrain().restitutionMaterial(restitutionClass).yielding;
}

const YieldingGround& SoilUnderRock::groundAt(
  const Contact& contact, const StructuresOnWay& structures) const
{
  static const YieldingGround hard;
  if (structures.solid() && structures.treeOf(contact) >= 0)
  {
    return hard;
  }
  return this->groundOf(surface_.restitutionClass(contact.cfe));
}

double SoilUnderRock::softnessAt(const Contact& contact, const RockBody& body) const
{
  const Softness asked{ surface_.restitutionClass(contact.cfe), body.state.position };
  if (known_.ground != asked.ground || known_.place != asked.place)
  {
    known_ = asked;
    known_.value = surface_.softnessAt(asked.ground, asked.place);
  }
  return known_.value;
}

double SoilUnderRock::slipFriction(
  const Contact& contact, const RockBody& body, const StructuresOnWay& structures) const
{
  const YieldingGround* ground = yields_ ? &this->groundAt(contact, structures) : nullptr;
  return ground && ground->slips() ? ground->frictionAfter(slip_) * this->softnessAt(contact, body)
                                   : std::numeric_limits<double>::quiet_NaN();
}

SoilUnderRock::Sink SoilUnderRock::sinkWithin(
  const RockBody& body, const StructuresOnWay& structures, double h) const
{
  const Vec3 spin = body.state.angularVelocity();
  Sink deepest;
  deepest.depth = std::max(
    (1.0 + kDeeperScar) * scar_.depth(), scar_.depth() + kShallowScar * body.block.radius());
  for (const Contact& c : body.contacts)
  {
    const double approach = approachOf(body.state, spin, c.point, c.normal);
    if (c.closed() || approach <= body.restingSpeed || c.gap() > approach * h ||
      c.normal.z() < kSteepestScar)
    {
      continue;
    }
    const double depth = this->groundAt(c, structures)
                           .scarDepth(body.block.mass(), body.block.volume(),
                             approach / c.normal.z(), this->softnessAt(c, body));
    if (depth > deepest.depth)
    {
      deepest = { &c, depth, approach };
    }
  }
  return deepest;
}

void SoilUnderRock::sink(
  const Sink& sink, const StructuresOnWay& structures, RockBody& body, GroundNear& ground)
{
  const double by = sink.depth - scar_.depth();
  scar_.sink(sink.depth, surface_.restitutionClass(sink.under->cfe), *sink.under);
  // Other contacts that were pressed in lose their hold.
  const double held = springEnergyOf(body.contacts);
  for (Contact& c : body.contacts)
  {
    c.distance += structures.isFirm(c) ? 0.0 : by * c.normal.z();
  }
  body.springEnergy = springEnergyOf(body.contacts);
  body.energy.scars += held - body.springEnergy;
  ground.lower(by, scar_.depth());
}

void SoilUnderRock::rise(double by, GroundNear& ground)
{
  scar_.rise(by);
  ground.lower(-by, scar_.depth());
}

double SoilUnderRock::riseNow(
  const RockBody& body, const StructuresOnWay& structures, const GroundNear& ground) const
{
  const auto isOnScar = [&](const Contact& c) { return c.closed() && !structures.isFirm(c); };
  if (!scar_.open() || !scar_.turned() ||
    std::any_of(body.contacts.begin(), body.contacts.end(), isOnScar))
  {
    return 0.0;
  }
  const double close = kScarClearance * body.block.radius();
  const double least = kHigherScar * scar_.depth() + close; // over Λ
  // The first corner that is too near decides; the exact height costs more.
  const double enough = least - kSureClearance * body.block.radius() - scar_.depth();
  const Vec3 lower = body.placed.lower(), upper = body.placed.upper();
  if (!structures.solid() && ground.window().covers(lower.x(), upper.x(), lower.y(), upper.y()) &&
    heightOver(body.placed, ground.window(), enough) < enough)
  {
    return 0.0;
  }
  const double away =
    clearance(body.placed, body.state, ground.patch(), gravity_, 0.0, true).distance;
  const double by = std::min(scar_.depth(), away - close);
  return by < kHigherScar * scar_.depth() ? 0.0 : by;
}

double SoilUnderRock::freeOverScar(const RockBody& body, GroundNear& ground) const
{
  const double speed = body.state.velocity.norm();
  double duration = speed > body.block.radius() ? body.block.radius() / speed : 1.0;
  const double away = body.state.velocity.dot(scar_.normal());
  if (away > 0.0)
  {
    // Drag brings Λ nearer than a free flight has it.
    const double rate =
      this->groundOf(scar_.ground()).speedLost(scar_.area() * speed, body.block.mass());
    duration = rate * duration > kLostOverScar ? kLostOverScar / rate : duration;
  }
  ground.ensureWindow(body, duration);
  if (!ground.window().whole())
  {
    return 0.0;
  }
  // As far over Λ as a rock higher up would be over the slope.
  thread_local PlacedBlock raised;
  BlockState up = body.state;
  up.position.z() += scar_.depth();
  raised.place(body.block, up);
  const double free = timeToTouch(raised, up, ground.window(), gravity_, duration);
  return away > 0.0 ? (1.0 - kLostOverScar) * free : free;
}

bool SoilUnderRock::plough(RockBody& body, double volume)
{
  if (!(volume > 0.0))
  {
    return false;
  }
  const YieldingGround& ground = this->groundOf(scar_.ground());
  const double before = rigidKineticEnergy(body.block, body.state);
  body.state.velocity *= ground.speedLeft(volume, body.block.mass());
  body.state.spin *= ground.spinLeft(volume, body.block.mass());
  body.energy.scars += before - rigidKineticEnergy(body.block, body.state);
  return true;
}

bool SoilUnderRock::fly(RockBody& body, double duration)
{
  bool ploughed = false;
  const YieldingGround& ground = this->groundOf(scar_.ground());
  thread_local PlacedBlock placed;
  const double spin = body.state.spin.norm();
  const double longest = spin > 0.0 ? std::max(kShortestPiece, kTurnInSoil / spin) : duration;
  for (double left = duration; left > 0.0;)
  {
    const BlockState start = body.state;
    const Scar before = scar_;
    for (double piece = std::min(left, longest);; piece *= 0.5)
    {
      const BlockState end = rockfall::fly(body.block, start, gravity_, piece);
      // Between the ends of so small a turn it is a steady one.
      const auto at = [&](double fraction) -> const PlacedBlock&
      {
        BlockState between = fraction < 1.0 ? start : end;
        if (fraction > 0.0 && fraction < 1.0)
        {
          between.position = placeInFlight(start, gravity_, fraction * piece);
          between.orientation = turnedBetween(start.orientation, end.orientation, fraction);
        }
        placed.placeFrame(body.block, between);
        if (spin == 0.0)
        {
          placed.placeVertices(); // a straight way looks at corners
        }
        return placed;
      };
      const double volume = scar_.sweep(end.position - start.position, at, spin > 0.0);
      if (piece > kShortestPiece && ground.speedLeft(volume, body.block.mass()) < kLeastLeft)
      {
        scar_ = before;
        continue;
      }
      body.state = end;
      ploughed = this->plough(body, volume) || ploughed;
      left = piece < left ? left - piece : 0.0;
      break;
    }
  }
  if (scar_.cleared() && body.state.velocity.dot(scar_.normal()) > 0.0)
  {
    scar_.leave();
  }
  return ploughed;
}

void SoilUnderRock::forgetSlip(double duration)
{
  if (slip_ > 0.0)
  {
    slip_ *= std::exp(-this->groundOf(touched_).frictionDecay * duration);
  }
}

bool SoilUnderRock::yieldInStep(RockBody& body, const StructuresOnWay& structures, double h)
{
  bool ploughed = false;
  const Contact *most = nullptr, *onScar = nullptr;
  for (const Contact& c : body.contacts)
  {
    const auto isMore = [&](const Contact* than)
    { return c.normalForce > 0.0 && (!than || c.normalForce > than->normalForce); };
    most = isMore(most) ? &c : most;
    onScar = isMore(onScar) && !structures.isFirm(c) ? &c : onScar;
  }
  if (most)
  {
    touched_ = surface_.restitutionClass(most->cfe);
    slip_ += h * body.state.velocity.norm();
  }
  else
  {
    this->forgetSlip(h);
  }
  if (scar_.open())
  {
    if (onScar)
    {
      scar_.touch(*onScar);
    }
    body.placed.move(body.block, body.state);
    ploughed = this->plough(body, scar_.sweep(body.before.position, body.placed));
  }
  if (most)
  {
    const double rolling = this->groundAt(*most, structures).rollingResistance;
    if (rolling > 0.0)
    {
      body.energy.rolling +=
        resistRolling(body.block, supportOf(body.contacts), rolling, h, body.state);
    }
  }
  return ploughed;
}

} // namespace rockfall
