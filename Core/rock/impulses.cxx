// Impacts of a rock by itself on hard ground as events in impulse space.

#include "rock/SingleRock.h"

#include "base/abort.h"
#include "block/FreeRotation.h"
#include "block/flight.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/restitution.h"
#include "solve/step/impulse.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

bool SingleRock::hop(double duration)
{
  const Block& block = body_.block;
  const BlockState start = body_.state;
  const FreeRotation rotation(block, start.spin);
  const bool turns = !start.spin.isZero(0.0);
  const auto flown = [&](double t)
  {
    BlockState at = start;
    at.time = start.time + t;
    at.position = placeInFlight(start, parameters_.gravity, t);
    at.velocity.z() -= parameters_.gravity * t;
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
    body_.placed.move(block, flown(t));
    return heightOver(body_.placed, window_, -block.radius());
  };
  const double small = this->impactStep();
  const double found = kTouchFound * block.radius();
  // From bound to bound; where a bound is shorter than what resolves a touch, so far.
  double t = 0.0, sure = 0.0;
  for (bool first = true;; first = false)
  {
    stayWanted();
    const BlockState at = flown(t);
    body_.placed.move(block, at);
    const double bound = timeToTouch(body_.placed, at, window_, parameters_.gravity, duration - t);
    if (bound <= 0.0)
    {
      if (first)
      {
        return false; // nothing to come to
      }
      break;
    }
    sure = t;
    if (bound >= duration - t)
    {
      this->advanceInFlight(duration);
      return true;
    }
    t = std::min(duration, t + std::max(bound, small));
  }
  // Between `sure` and `t`: regula falsi, by halves where one end stays.
  double high = heightAt(sure), low = heightAt(t), after = t;
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
    this->advanceInFlight(sure);
    if (body_.done || body_.state.time < start.time + sure)
    {
      return true; // a barrier on the way
    }
  }
  body_.placed.move(block, body_.state);
  thread_local std::vector<GroundPlace> places;
  findTouches(body_.placed, window_, kSharedTouch * block.radius(), places);
  touches_.clear();
  const double width = surface_.terrain().width(), height = surface_.terrain().height();
  for (const GroundPlace& place : places)
  {
    // On the apron the ground is that of the edge.
    const double inset = 1e-9 * (width + height);
    const std::int64_t cfe =
      surface_.terrain().cfeAt(std::clamp(place.point.x(), inset, width - inset),
        std::clamp(place.point.y(), inset, height - inset));
    touches_.push_back({ place.point, place.normal, cfe });
  }
  struckAtOnce_ = sure > 0.0 ? 0 : struckAtOnce_;
  return this->strike(touches_, false) && this->partsFrom(touches_);
}

bool SingleRock::partsFrom(std::span<const Touch> touches) const
{
  const Vec3 spin = body_.state.angularVelocity();
  return std::all_of(touches.begin(), touches.end(),
    [&](const Touch& touch)
    {
      return touch.normal.dot(body_.state.velocity +
               spin.cross(touch.point - body_.state.position)) > body_.restingSpeed;
    });
}

bool SingleRock::strikeSoon(double small, double& first)
{
  first = std::numeric_limits<double>::infinity();
  const Vec3 spin = body_.state.angularVelocity();
  for (const Contact& c : body_.contacts)
  {
    const double approach =
      -c.normal.dot(body_.state.velocity + spin.cross(c.point - body_.state.position));
    if (!c.closed() && approach > body_.restingSpeed)
    {
      first = std::min(first, std::max(0.0, c.gap()) / approach);
    }
  }
  if (first > small)
  {
    return false;
  }
  // What carries does so on the way, and shares the impact.
  const bool carried = anyClosed(body_.contacts);
  const double shared = kSharedTouch * body_.block.radius();
  touches_.clear();
  for (const Contact& c : body_.contacts)
  {
    const double approach =
      -c.normal.dot(body_.state.velocity + spin.cross(c.point - body_.state.position));
    if (c.closed() || c.gap() - approach * first < shared)
    {
      if (structures_.solid() && structures_.treeOf(c) >= 0)
      {
        return false; // which may break
      }
      touches_.push_back({ c.point, c.normal, c.cfe });
    }
  }
  if (first > kNoTime)
  {
    this->advanceInFlight(first);
    struckAtOnce_ = 0;
    if (body_.done)
    {
      return true; // at a barrier on the way
    }
  }
  if (!this->strike(touches_, carried))
  {
    return first > kNoTime; // where it is now is looked at anew
  }
  // Springs that are let go give nothing back.
  const double held = springEnergyOf(body_.contacts);
  const Vec3 turned = body_.state.angularVelocity();
  std::erase_if(body_.contacts,
    [&](const Contact& c)
    {
      return !c.closed() ||
        c.normal.dot(body_.state.velocity + turned.cross(c.point - body_.state.position)) >
        body_.restingSpeed;
    });
  body_.springEnergy = springEnergyOf(body_.contacts);
  body_.energy.damping += held - body_.springEnergy;
  return true;
}

bool SingleRock::strike(std::span<const Touch> touches, bool carried)
{
  if (touches.empty() || touches.size() > kMostImpulsePoints || ++struckAtOnce_ > kImpactsAtOnce)
  {
    return false;
  }
  const Block& block = body_.block;
  const Mat3 rotation = body_.state.orientation.toRotationMatrix();
  ImpulseBody body{ 1.0 / block.mass(), rotation * block.inverseInertia() * rotation.transpose(),
    body_.state.velocity, rotation * body_.state.spin };
  std::array<ImpulsePoint, kMostImpulsePoints> points;
  const double speed = body.velocity.norm();
  double fastest = 0.0;
  for (std::size_t i = 0; i < touches.size(); ++i)
  {
    const Touch& touch = touches[i];
    ImpulsePoint& point = points[i];
    point.normal = touch.normal;
    point.lever = touch.point - body_.state.position;
    const double approach =
      -touch.normal.dot(body.velocity + body.angularVelocity.cross(point.lever));
    fastest = std::max(fastest, approach);
    if (surface_.cohesionAt(touch.cfe) > 0.0)
    {
      return false; // holds by a force, which takes time
    }
    const GroundTouch ground = this->touchAt(touch.cfe, touch.point);
    point.friction = surface_.frictionAt(ground);
    point.restitution = contactRestitution(
      surface_.terrain().restitutionMaterial(surface_.restitutionClass(touch.cfe)),
      surface_.restitutionAt(ground), approach,
      approach > body_.restingSpeed &&
        comesDown(approach, speed, parameters_.gravity, block.radius()));
    const double compliance = parameters_.rigid
      ? 0.0
      : block.compliance(rotation.transpose() * touch.normal, rotation.transpose() * point.lever);
    point.stiffness = penalty_ / (1.0 + penalty_ * compliance);
  }
  if (!(fastest > body_.restingSpeed))
  {
    return false;
  }
  if (!this->resumeImpact(body_.state.time))
  {
    this->finishImpact(); // the one before
    this->beginImpact(body_.state, body_.energy.friction, body_.energy.restitution);
  }
  recorder_.beforeJump(body_.state, carried);
  this->auditSamples(body_.state);
  resolveImpulse(body, { points.data(), touches.size() }, kQuietImpulse * body_.restingSpeed);
  body_.state.velocity = body.velocity;
  body_.state.spin = rotation.transpose() * body.angularVelocity;
  impact_.event.approachSpeed = std::max(impact_.event.approachSpeed, fastest);
  for (std::size_t i = 0; i < touches.size(); ++i)
  {
    const ImpulsePoint& point = points[i];
    impact_.normalImpulse += point.impulse * point.normal;
    body_.energy.friction += point.frictionLoss;
    body_.energy.restitution += point.restitutionLoss;
    // As a force, beside those of springs in the same impact.
    const double force = point.impulse / this->impactDuration();
    if (force > impact_.largestForce)
    {
      impact_.largestForce = force;
      impact_.event.cfe = touches[i].cfe;
      impact_.event.position = touches[i].point;
    }
  }
  this->finishImpact(true, true);
  recorder_.afterJump(body_.state, carried);
  this->auditSamples(body_.state);
  recorder_.follow(body_.state);
  body_.acceleration.setZero();
  body_.spinAcceleration.setZero();
  return true;
}

} // namespace rockfall
