#include "rock/fall/TouchSearch.h"

#include "base/abort.h"
#include "block/flight.h"
#include "contact/ground/heightOver.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/fall/Fall.h"

#include <algorithm>

namespace rockfall
{

TouchSearch::TouchSearch(Fall& fall, double duration)
  : fall_(fall)
  , duration_(duration)
  , rotation_(fall.body.block, fall.body.state.spin)
{
}

TouchSearch::Outcome TouchSearch::find()
{
  const Outcome outcome = this->bracket();
  if (outcome == Outcome::Ahead)
  {
    this->refine();
  }
  return outcome;
}

BlockState TouchSearch::flown(double t) const
{
  return fly(rotation_, fall_.body.state, fall_.parameters.gravity, t);
}

double TouchSearch::heightAt(double t)
{
  RockBody& body = fall_.body;
  body.placed.move(body.block, this->flown(t));
  return heightOver(body.placed, fall_.ground.window(), -body.block.radius());
}

TouchSearch::Outcome TouchSearch::bracket()
{
  RockBody& body = fall_.body;
  const double gravity = fall_.parameters.gravity, small = fall_.springs.impactStep(body);
  Vec3 lowest = Vec3::Zero();
  for (bool first = true, far = true;; first = false)
  {
    stayWanted();
    const BlockState at = this->flown(after_);
    body.placed.move(body.block, at);
    const double left = duration_ - after_;
    const double clear =
      far ? timeToPlane(body.placed, at, fall_.ground.window(), gravity, left) : 0.0;
    if (clear >= left)
    {
      return Outcome::Free;
    }
    far = clear > kClearSteps * small;
    if (far)
    {
      after_ += clear;
      continue;
    }
    const FlightLook look =
      lookAhead(body.placed, at, fall_.ground.window(), lowest, gravity, left);
    if (look.free <= 0.0)
    {
      low_ = look.gap;
      return first ? Outcome::Here : Outcome::Ahead;
    }
    if (look.free >= left)
    {
      return Outcome::Free;
    }
    sure_ = after_;
    high_ = look.gap;
    lowest = look.lowest;
    after_ = std::min(duration_, after_ + std::max(look.free, small));
    far = look.free > kFarSteps * small;
    if (!first && look.free < small)
    {
      low_ = this->heightAt(after_); // most likely that is it
      if (low_ <= 0.0)
      {
        return Outcome::Ahead;
      }
    }
  }
}

void TouchSearch::refine()
{
  const double found = kTouchFound * fall_.body.block.radius();
  // Regula falsi, by halves where one end stays.
  for (int k = 0, side = 0; k < 60 && (high_ > found || sure_ == 0.0) && after_ - sure_ > 1e-12;
       ++k)
  {
    // Aims at a point over the ground, so that the end over it is the one that comes near.
    const double aim = 0.5 * found;
    const double share = std::clamp((high_ - aim) / (high_ - low_), 0.02, 0.98);
    const double middle = sure_ + share * (after_ - sure_);
    const double height = this->heightAt(middle);
    if (height > 0.0)
    {
      sure_ = middle;
      high_ = height;
      low_ *= side > 0 ? 0.5 : 1.0;
      side = 1;
    }
    else
    {
      after_ = middle;
      low_ = height;
      high_ *= side < 0 ? 0.5 : 1.0;
      side = -1;
    }
  }
}

} // namespace rockfall
