#include "rock/fall/impulseImpacts.h"

#include "base/abort.h"
#include "block/FreeRotation.h"
#include "block/flight.h"
#include "contact/ground/heightOver.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/fall/Fall.h"
#include "rock/fall/flightPhase.h"
#include "rock/restitution.h"
#include "solve/step/impulse.h"

#include <algorithm>
#include <array>
#include <cmath>
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
  fall.impact.finish(body, fall.recorder, true, true);
  fall.recorder.afterJump(body, carried);
  fall.recorder.follow(body.state);
  body.acceleration.setZero();
  body.spinAcceleration.setZero();
  return true;
}

} // namespace

bool hop(Fall& fall, double duration)
{
  RockBody& body = fall.body;
  const Block& block = body.block;
  const BlockState start = body.state;
  const FreeRotation rotation(block, start.spin);
  const bool turns = !start.spin.isZero(0.0);
  const auto flown = [&](double t)
  {
    BlockState at = start;
    at.time = start.time + t;
    at.position = placeInFlight(start, fall.parameters.gravity, t);
    at.velocity.z() -= fall.parameters.gravity * t;
    if (turns)
    {
      const FreeRotation::Attitude turned = rotation.after(t);
      at.orientation = (start.orientation * turned.turn).normalized();
      at.spin = turned.spin;
    }
    return at;
  };
  const auto heightAt = [&](double t)
  {
    body.placed.move(block, flown(t));
    return heightOver(body.placed, fall.ground.window(), -block.radius());
  };
  const double small = fall.springs.impactStep(body);
  const double found = kTouchFound * block.radius();
  const double gravity = fall.parameters.gravity;
  // From bound to bound; where a bound is shorter than what resolves a touch, so far.
  double t = 0.0, sure = 0.0, high = 0.0, low = 0.0;
  Vec3 lowest = Vec3::Zero();
  for (bool first = true, far = true;; first = false)
  {
    stayWanted();
    const BlockState at = flown(t);
    body.placed.move(block, at);
    const double left = duration - t;
    const double clear =
      far ? timeToPlane(body.placed, at, fall.ground.window(), gravity, left) : 0.0;
    if (clear >= left)
    {
      advanceInFlight(fall, duration);
      return true;
    }
    far = clear > kClearSteps * small;
    if (far)
    {
      t += clear;
      continue;
    }
    const FlightLook look = lookAhead(body.placed, at, fall.ground.window(), lowest, gravity, left);
    if (look.free <= 0.0)
    {
      if (first)
      {
        return false; // nothing to come to
      }
      low = look.gap;
      break;
    }
    if (look.free >= left)
    {
      advanceInFlight(fall, duration);
      return true;
    }
    sure = t;
    high = look.gap;
    lowest = look.lowest;
    t = std::min(duration, t + std::max(look.free, small));
    far = look.free > kFarSteps * small;
    if (!first && look.free < small)
    {
      low = heightAt(t); // most likely that is it
      if (low <= 0.0)
      {
        break;
      }
    }
  }
  // Between `sure` and `t`: regula falsi, by halves where one end stays.
  double after = t;
  for (int k = 0, side = 0; k < 60 && (high > found || sure == 0.0) && after - sure > 1e-12; ++k)
  {
    // Aims at a point over the ground, so that the end over it is the one that comes near.
    const double aim = 0.5 * found;
    const double share = std::clamp((high - aim) / (high - low), 0.02, 0.98);
    const double middle = sure + share * (after - sure);
    const double height = heightAt(middle);
    if (height > 0.0)
    {
      sure = middle;
      high = height;
      low *= side > 0 ? 0.5 : 1.0;
      side = 1;
    }
    else
    {
      after = middle;
      low = height;
      high *= side < 0 ? 0.5 : 1.0;
      side = -1;
    }
  }
  if (sure > 0.0)
  {
    advanceInFlight(fall, sure);
    if (body.done || body.state.time < start.time + sure)
    {
      return true; // a barrier on the way
    }
  }
  body.placed.move(block, body.state);
  thread_local std::vector<GroundPlace> places;
  findTouches(body.placed, fall.ground.window(), kSharedTouch * block.radius(), places);
  std::vector<StruckPoint>& touches = touchSpace();
  touches.clear();
  const double width = fall.surface.terrain().width(), height = fall.surface.terrain().height();
  for (const GroundPlace& place : places)
  {
    // On the apron the ground is that of the edge.
    const double inset = 1e-9 * (width + height);
    const std::int64_t cfe =
      fall.surface.terrain().cfeAt(std::clamp(place.point.x(), inset, width - inset),
        std::clamp(place.point.y(), inset, height - inset));
    touches.push_back({ place.point, place.normal, cfe });
  }
  fall.struckAtOnce = sure > 0.0 ? 0 : fall.struckAtOnce;
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
