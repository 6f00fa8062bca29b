// Ground that gives way under a rock: where its hard surface lies, and what it takes.

#include "rock/SingleRock.h"

#include "block/flight.h"
#include "contact/ground/clearance.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/rollingResistance.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Share of r by which rounding does not make a distance larger.
constexpr double kSureClearance = 1e-9;

/// For how long hops in one scar are one impact, s. Beyond it each draws its restitution anew: a
/// rock whose impact had drawn 1 would hop on its face for ever.
constexpr double kOneImpact = 1.0;

/// Between two attitudes that differ by little, at a fraction of the turn.
Quat turnedBetween(const Quat& from, const Quat& to, double fraction)
{
  const double way = from.dot(to) < 0.0 ? -fraction : fraction; // q and −q are one attitude
  return Quat(((1.0 - fraction) * from.coeffs() + way * to.coeffs()).normalized());
}

} // namespace

const YieldingGround& SingleRock::yieldingOf(int restitutionClass) const
{
  return surface_.terrain().restitutionMaterial(restitutionClass).yielding;
}

const YieldingGround& SingleRock::yieldingAt(const Contact& contact) const
{
  static const YieldingGround hard;
  if (structures_.solid() && structures_.treeOf(contact) >= 0)
  {
    return hard;
  }
  return this->yieldingOf(surface_.restitutionClass(contact.cfe));
}

bool SingleRock::followScar(double h)
{
  return this->sinkUnder(h) || this->riseWithRock();
}

bool SingleRock::sinkUnder(double h)
{
  const Vec3 spin = body_.state.angularVelocity();
  const Contact* under = nullptr;
  double deepest = std::max((1.0 + kDeeperScar) * scar_.depth(),
           scar_.depth() + kShallowScar * body_.block.radius()),
         fastest = 0.0;
  for (const Contact& c : body_.contacts)
  {
    const double approach =
      -c.normal.dot(body_.state.velocity + spin.cross(c.point - body_.state.position));
    if (c.closed() || approach <= body_.restingSpeed || c.gap() > approach * h ||
      c.normal.z() < kSteepestScar)
    {
      continue;
    }
    const double depth = this->yieldingAt(c).scarDepth(
      body_.block.mass(), body_.block.volume(), approach / c.normal.z(), this->softnessAt(c));
    if (depth > deepest)
    {
      deepest = depth;
      fastest = approach;
      under = &c;
    }
  }
  if (!under)
  {
    return false;
  }
  if (!impact_.pending)
  {
    this->beginImpact(body_.state, body_.energy.friction, body_.energy.restitution);
    impact_.event.cfe = under->cfe;
    impact_.event.position = under->point;
    impact_.event.normal = under->normal;
  }
  impact_.event.approachSpeed = std::max(impact_.event.approachSpeed, fastest);
  const double before = scar_.depth();
  scar_.sink(deepest, surface_.restitutionClass(under->cfe), *under);
  // Other contacts that were pressed in lose their hold.
  const double held = springEnergyOf(body_.contacts);
  for (Contact& c : body_.contacts)
  {
    c.distance += (deepest - before) * c.normal.z();
  }
  body_.springEnergy = springEnergyOf(body_.contacts);
  body_.energy.scars += held - body_.springEnergy;
  this->lowerPatch(deepest - before);
  return true;
}

bool SingleRock::riseWithRock()
{
  if (!scar_.open() || !scar_.turned() || anyClosed(body_.contacts))
  {
    return false;
  }
  const double close = kScarClearance * body_.block.radius();
  const double least = kHigherScar * scar_.depth() + close; // over Λ
  // One corner that is too near says so at less cost.
  const double enough = least - kSureClearance * body_.block.radius() - scar_.depth();
  const Vec3 lower = body_.placed.lower(), upper = body_.placed.upper();
  if (!structures_.solid() && window_.covers(lower.x(), upper.x(), lower.y(), upper.y()) &&
    heightOver(body_.placed, window_, enough) < enough)
  {
    return false;
  }
  const double away =
    clearance(body_.placed, body_.state, patch_, parameters_.gravity, 0.0).distance;
  const double by = std::min(scar_.depth(), away - close);
  if (by < kHigherScar * scar_.depth())
  {
    return false;
  }
  body_.contacts.clear();
  this->raiseScar(by);
  return true;
}

bool SingleRock::flyOverScar(double small)
{
  if (structures_.solid() ||
    !(body_.state.strain.isZero(0.0) && body_.state.strainRate.isZero(0.0)))
  {
    return false;
  }
  this->ensurePatch(0.0);
  if (this->riseWithRock())
  {
    return true;
  }
  const double speed = body_.state.velocity.norm();
  double duration = horizon_ - body_.state.time;
  duration = std::min(
    duration, speed * duration > body_.block.radius() ? body_.block.radius() / speed : 1.0);
  const double away = body_.state.velocity.dot(scar_.normal());
  if (away > 0.0)
  {
    // Drag brings Λ nearer than a free flight has it.
    const double rate =
      this->yieldingOf(scar_.ground()).speedLost(scar_.area() * speed, body_.block.mass());
    duration = rate * duration > kLostOverScar ? kLostOverScar / rate : duration;
  }
  this->ensureWindow(duration);
  if (!window_.whole())
  {
    return false;
  }
  // As far over Λ as a rock higher up would be over the slope.
  thread_local PlacedBlock raised;
  BlockState up = body_.state;
  up.position.z() += scar_.depth();
  raised.place(body_.block, up);
  double free = timeToTouch(raised, up, window_, parameters_.gravity, duration);
  free *= away > 0.0 ? 1.0 - kLostOverScar : 1.0;
  if (!(free > small))
  {
    return false;
  }
  if (scar_.turned() && body_.state.time - impact_.event.time > kOneImpact)
  {
    ++impactsOver_;
  }
  this->advanceInFlight(free);
  this->checkEnd(0.0);
  return true;
}

void SingleRock::closeScar()
{
  if (scar_.open())
  {
    this->raiseScar(scar_.depth());
  }
}

void SingleRock::raiseScar(double by)
{
  this->lowerPatch(-by);
  scar_.rise(by);
  if (!scar_.open())
  {
    this->finishImpact();
  }
}

void SingleRock::lowerPatch(double by)
{
  for (SurfacePatch::Node& node : patch_.nodes)
  {
    node.position.z() -= by;
  }
  for (SurfacePatch::Triangle& triangle : patch_.triangles)
  {
    triangle.offset -= by * triangle.normal.z();
  }
  patch_.highest -= by;
  // For the pairs that can touch the rock has moved the other way.
  candidates_.position.z() -= by;
}

void SingleRock::plough(double volume)
{
  if (!(volume > 0.0))
  {
    return;
  }
  const YieldingGround& ground = this->yieldingOf(scar_.ground());
  const double before = rigidKineticEnergy(body_.block, body_.state);
  body_.state.velocity *= ground.speedLeft(volume, body_.block.mass());
  body_.state.spin *= ground.spinLeft(volume, body_.block.mass());
  body_.energy.scars += before - rigidKineticEnergy(body_.block, body_.state);
  impact_.event.scarDepth = scar_.deepest();
  impact_.event.scarLength = scar_.length();
}

void SingleRock::flyThroughSoil(double duration)
{
  const YieldingGround& ground = this->yieldingOf(scar_.ground());
  thread_local PlacedBlock placed;
  const double spin = body_.state.spin.norm();
  const double longest = spin > 0.0 ? std::max(kShortestPiece, kTurnInSoil / spin) : duration;
  for (double left = duration; left > 0.0;)
  {
    const BlockState start = body_.state;
    const Scar before = scar_;
    for (double piece = std::min(left, longest);; piece *= 0.5)
    {
      const BlockState end = fly(body_.block, start, parameters_.gravity, piece);
      // Between the ends of so small a turn it is a steady one.
      const auto at = [&](double fraction) -> const PlacedBlock&
      {
        BlockState between = fraction < 1.0 ? start : end;
        if (fraction > 0.0 && fraction < 1.0)
        {
          between.position = placeInFlight(start, parameters_.gravity, fraction * piece);
          between.orientation = turnedBetween(start.orientation, end.orientation, fraction);
        }
        placed.placeFrame(body_.block, between);
        if (spin == 0.0)
        {
          placed.placeVertices(); // a straight way looks at corners
        }
        return placed;
      };
      const double volume = scar_.sweep(end.position - start.position, at, spin > 0.0);
      if (piece > kShortestPiece && ground.speedLeft(volume, body_.block.mass()) < kLeastLeft)
      {
        scar_ = before;
        continue;
      }
      body_.state = end;
      this->plough(volume);
      left = piece < left ? left - piece : 0.0;
      break;
    }
  }
  if (scar_.cleared() && body_.state.velocity.dot(scar_.normal()) > 0.0)
  {
    scar_.leave();
  }
}

void SingleRock::forgetSlip(double duration)
{
  if (slip_ > 0.0)
  {
    slip_ *= std::exp(-this->yieldingOf(touched_).frictionDecay * duration);
  }
}

void SingleRock::yieldInStep(double h)
{
  const Contact* most = nullptr;
  for (const Contact& c : body_.contacts)
  {
    if (c.normalForce > 0.0 && (!most || c.normalForce > most->normalForce))
    {
      most = &c;
    }
  }
  if (most)
  {
    touched_ = surface_.restitutionClass(most->cfe);
    slip_ += h * body_.state.velocity.norm();
  }
  else
  {
    this->forgetSlip(h);
  }
  if (scar_.open())
  {
    if (most)
    {
      scar_.touch(*most);
    }
    body_.placed.move(body_.block, body_.state);
    this->plough(scar_.sweep(body_.before.position, body_.placed));
  }
  if (most)
  {
    const double rolling = this->yieldingAt(*most).rollingResistance;
    if (rolling > 0.0)
    {
      body_.energy.rolling += resistRolling(body_.block, body_.contacts, rolling, h, body_.state);
    }
  }
}

} // namespace rockfall
