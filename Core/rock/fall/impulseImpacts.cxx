#include "rock/fall/impulseImpacts.h"

#include "contact/ground/heightOver.h"
#include "law/settings.h"
#include "rock/fall/Fall.h"
#include "rock/fall/TouchSearch.h"
#include "rock/fall/flightPhase.h"
#include "rock/parts/rollingResistance.h"
#include "rock/restitution.h"
#include "solve/step/impulse.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace rockfall
{

namespace
{

/// A point of the rock that touches the ground.
struct StruckPoint
{
  Vec3 point;
  Vec3 normal;
  std::int64_t cfe;
};

/// Touches of the impact at hand.
std::vector<StruckPoint>& touchSpace()
{
  thread_local std::vector<StruckPoint> touches;
  return touches;
}

/// Whether the rock leaves all of them faster than it may rest.
bool partsFrom(const RockBody& body, std::span<const StruckPoint> touches)
{
  const Vec3 spin = body.state.angularVelocity();
  return std::all_of(touches.begin(), touches.end(),
    [&](const StruckPoint& touch)
    { return -approachOf(body.state, spin, touch.point, touch.normal) > body.restingSpeed; });
}

/// What rolling resistance takes of the motion that an impact leaves.
void resistRollingAt(
  Fall& fall, std::span<const StruckPoint> touches, std::span<const ImpulsePoint> points)
{
  RockBody& body = fall.body;
  const Vec3 spin = body.state.angularVelocity();
  Support support;
  double most = 0.0, coefficient = 0.0;
  for (std::size_t i = 0; i < touches.size(); ++i)
  {
    const ImpulsePoint& point = points[i];
    const Vec3 speed = body.state.velocity + spin.cross(point.lever);
    const Vec3 slip = speed - point.normal.dot(speed) * point.normal;
    support.add(point.impulse, slip.norm() > kQuietImpulse * body.restingSpeed, touches[i].point);
    if (point.impulse > most)
    {
      most = point.impulse;
      coefficient =
        fall.soil.groundOf(fall.surface.restitutionClass(touches[i].cfe)).rollingResistance;
    }
  }
  if (coefficient > 0.0)
  {
    body.energy.rolling += resistRolling(body.block, support, coefficient, 1.0, body.state);
  }
}

/// One impact at all these points, where the rock is. Whether there was one.
bool strike(Fall& fall, std::span<const StruckPoint> touches, bool carried)
{
  RockBody& body = fall.body;
  if (touches.empty() || touches.size() > kMostImpulsePoints ||
    ++fall.struckAtOnce > kImpactsAtOnce)
  {
    return false;
  }
  const Block& block = body.block;
  const Mat3 rotation = body.state.orientation.toRotationMatrix();
  ImpulseBody moving{ 1.0 / block.mass(), rotation * block.inverseInertia() * rotation.transpose(),
    body.state.velocity, rotation * body.state.spin };
  std::array<ImpulsePoint, kMostImpulsePoints> points;
  const double speed = moving.velocity.norm();
  double fastest = 0.0;
  for (std::size_t i = 0; i < touches.size(); ++i)
  {
    const StruckPoint& touch = touches[i];
    ImpulsePoint& point = points[i];
    point.normal = touch.normal;
    point.lever = touch.point - body.state.position;
    const double approach =
      -touch.normal.dot(moving.velocity + moving.angularVelocity.cross(point.lever));
    fastest = std::max(fastest, approach);
    if (fall.surface.cohesionAt(touch.cfe) > 0.0)
    {
      return false; // holds by a force, which takes time
    }
    const GroundTouch ground = fall.impact.touchAt(touch.cfe, touch.point);
    point.friction = fall.surface.frictionAt(ground);
    point.restitution = contactRestitution(
      fall.surface.terrain().restitutionMaterial(fall.surface.restitutionClass(touch.cfe)),
      fall.surface.restitutionAt(ground), approach,
      approach > body.restingSpeed &&
        comesDown(approach, speed, fall.parameters.gravity, block.radius()));
    const double compliance = fall.parameters.rigid
      ? 0.0
      : block.compliance(rotation.transpose() * touch.normal, rotation.transpose() * point.lever);
    point.stiffness = fall.springs.penalty() / (1.0 + fall.springs.penalty() * compliance);
  }
  if (!(fastest > body.restingSpeed))
  {
    return false;
  }
  if (!fall.impact.resume(body, body.state.time, fall.recorder))
  {
    fall.impact.finish(body, fall.recorder); // the one before
    fall.impact.begin(body, body.state, body.energy.friction, body.energy.restitution);
  }
  fall.recorder.beforeJump(body, carried);
  resolveImpulse(moving, { points.data(), touches.size() }, kQuietImpulse * body.restingSpeed);
  body.state.velocity = moving.velocity;
  body.state.spin = rotation.transpose() * moving.angularVelocity;
  fall.impact.noteApproach(fastest);
  for (std::size_t i = 0; i < touches.size(); ++i)
  {
    const ImpulsePoint& point = points[i];
    body.energy.friction += point.frictionLoss;
    body.energy.restitution += point.restitutionLoss;
    // As a force, beside those of springs in the same impact.
    fall.impact.addImpulse(point.impulse * point.normal, point.impulse / fall.impact.duration(body),
      touches[i].cfe, touches[i].point);
  }
  resistRollingAt(fall, touches, { points.data(), touches.size() });
  fall.impact.finish(body, fall.recorder, true, true);
  fall.recorder.afterJump(body, carried);
  fall.recorder.follow(body);
  body.acceleration.setZero();
  body.spinAcceleration.setZero();
  return true;
}

/// Points at which the rock touches the ground, or nearly so.
std::vector<StruckPoint>& touchesNow(Fall& fall)
{
  thread_local std::vector<GroundPlace> places;
  RockBody& body = fall.body;
  body.placed.move(body.block, body.state);
  findTouches(body.placed, fall.ground.window(), kSharedTouch * body.block.radius(), places);
  std::vector<StruckPoint>& touches = touchSpace();
  touches.clear();
  const Terrain& terrain = fall.surface.terrain();
  const double width = terrain.width(), height = terrain.height();
  const double inset = 1e-9 * (width + height); // on the apron the ground is that of the edge
  for (const GroundPlace& place : places)
  {
    const std::int64_t cfe = terrain.cfeAt(std::clamp(place.point.x(), inset, width - inset),
      std::clamp(place.point.y(), inset, height - inset));
    touches.push_back({ place.point, place.normal, cfe });
  }
  return touches;
}

} // namespace

bool hop(Fall& fall, double duration)
{
  TouchSearch search(fall, duration);
  const TouchSearch::Outcome outcome = search.find();
  if (outcome == TouchSearch::Outcome::Here)
  {
    return false;
  }
  if (outcome == TouchSearch::Outcome::Free)
  {
    advanceInFlight(fall, duration);
    return true;
  }
  RockBody& body = fall.body;
  if (search.sure() > 0.0)
  {
    const double until = body.state.time + search.sure();
    advanceInFlight(fall, search.sure());
    if (body.done || body.state.time < until)
    {
      return true; // a barrier on the way
    }
    fall.struckAtOnce = 0;
  }
  const std::vector<StruckPoint>& touches = touchesNow(fall);
  return strike(fall, touches, false) && partsFrom(body, touches);
}

bool strikeSoon(Fall& fall, double small, double& first)
{
  RockBody& body = fall.body;
  first = std::numeric_limits<double>::infinity();
  const Vec3 spin = body.state.angularVelocity();
  for (const Contact& c : body.contacts)
  {
    const double approach = approachOf(body.state, spin, c.point, c.normal);
    if (!c.closed() && approach > body.restingSpeed)
    {
      first = std::min(first, std::max(0.0, c.gap()) / approach);
    }
  }
  if (first > small)
  {
    return false;
  }
  // What carries does so on the way, and shares the impact.
  const bool carried = anyClosed(body.contacts);
  const double shared = kSharedTouch * body.block.radius();
  std::vector<StruckPoint>& touches = touchSpace();
  touches.clear();
  for (const Contact& c : body.contacts)
  {
    const double approach = approachOf(body.state, spin, c.point, c.normal);
    if (c.closed() || c.gap() - approach * first < shared)
    {
      if (fall.structures.solid() && fall.structures.treeOf(c) >= 0)
      {
        return false; // which may break
      }
      touches.push_back({ c.point, c.normal, c.cfe });
    }
  }
  if (first > kNoTime)
  {
    advanceInFlight(fall, first);
    fall.struckAtOnce = 0;
    if (body.done)
    {
      return true; // at a barrier on the way
    }
  }
  if (!strike(fall, touches, carried))
  {
    return first > kNoTime; // where it is now is looked at anew
  }
  // Springs that are let go give nothing back.
  const double held = springEnergyOf(body.contacts);
  const Vec3 turned = body.state.angularVelocity();
  std::erase_if(body.contacts,
    [&](const Contact& c) {
      return !c.closed() || -approachOf(body.state, turned, c.point, c.normal) > body.restingSpeed;
    });
  body.springEnergy = springEnergyOf(body.contacts);
  body.energy.damping += held - body.springEnergy;
  return true;
}

} // namespace rockfall
