// The part of the slope near a rock, and the proof that none is.

#include "rock/SingleRock.h"

#include "contact/ground/clearance.h"
#include "contact/ground/timeToTouch.h"
#include "contact/pairs.h"
#include "law/settings.h"

#include <algorithm>

namespace rockfall
{

namespace
{

CandidatePairs& workSpace()
{
  thread_local CandidatePairs pairs;
  return pairs;
}

} // namespace

std::array<double, 4> SingleRock::boxOfWay(double duration) const
{
  const double r = body_.block.radius();
  const Vec3& p = body_.state.position;
  const Vec3 end = p + duration * body_.state.velocity;
  return { std::min(p.x(), end.x()) - r, std::max(p.x(), end.x()) + r, std::min(p.y(), end.y()) - r,
    std::max(p.y(), end.y()) + r };
}

void SingleRock::ensureWindow(double duration)
{
  const auto [x0, x1, y0, y1] = this->boxOfWay(duration);
  if (!window_.covers(x0, x1, y0, y1))
  {
    window_.gather(surface_, x0, x1, y0, y1);
  }
}

double SingleRock::timeToGround(double duration)
{
  if (window_.whole())
  {
    return timeToTouch(body_.placed, body_.state, window_, parameters_.gravity, duration);
  }
  // A rock over a hole has no gap to close: it comes to a rim or a wall from beside.
  const auto [x0, x1, y0, y1] = this->boxOfWay(duration);
  if (!holed_.covers(x0, x1, y0, y1))
  {
    gatherPatch(surface_, x0, x1, y0, y1, holed_);
  }
  return clearance(body_.placed, body_.state, holed_, parameters_.gravity, duration).time;
}

bool SingleRock::clearFor(double duration) const
{
  const double r = body_.block.radius();
  const Vec3& p = body_.state.position;
  const Vec3 end = p + duration * body_.state.velocity;
  const double zEnd = end.z() - 0.5 * parameters_.gravity * duration * duration;
  // The parabola is concave: its lowest point is at one of its ends.
  const double lowest = std::min(p.z(), zEnd) - r;
  return surface_.maxHeight(std::min(p.x(), end.x()) - r, std::max(p.x(), end.x()) + r,
           std::min(p.y(), end.y()) - r, std::max(p.y(), end.y()) + r) < lowest;
}

void SingleRock::ensurePatch(double margin)
{
  const Vec3 lower = body_.placed.lower(), upper = body_.placed.upper();
  if (!patch_.covers(
        lower.x() - margin, upper.x() + margin, lower.y() - margin, upper.y() + margin))
  {
    gatherPatch(surface_, lower.x() - margin, upper.x() + margin, lower.y() - margin,
      upper.y() + margin, patch_);
    if (structures_.solid())
    {
      const double ring = patch_.cellSize;
      structures_.obstacles().append(patch_.xMin - ring, patch_.xMax + ring, patch_.yMin - ring,
        patch_.yMax + ring, structures_.goneTrees(), patch_);
    }
    if (scar_.open())
    {
      this->lowerPatch(scar_.depth());
    }
    candidates_.distance = -1.0;
  }
}

void SingleRock::ensureCandidates(double reach, bool among)
{
  if (candidates_.room(body_.state, body_.block.radius(), reach) < 0.0)
  {
    // Where nothing was near at the last look there is little that a wider one finds.
    const double slack = among && candidates_.empty() ? kFarCandidateSlack : kCandidateSlack;
    // In a scar the ground moves under the rock as well.
    const double room = std::max(slack * body_.block.radius(), scar_.depth());
    const double distance = std::max(2.0 * reach, reach + room);
    this->ensurePatch(distance);
    gatherCandidates(body_.placed, body_.state, patch_, distance, candidates_);
  }
}

const CandidatePairs& SingleRock::stepCandidates(const PairBody& body, const SlopeReach& reach)
{
  if (!structures_.solid())
  {
    this->ensurePatch(2.0 * reach.most);
    if (patch_.isSlopeOnly())
    {
      CandidatePairs& now = workSpace();
      gatherStepCandidates(body_.placed, body, patch_, reach, now);
      return now;
    }
  }
  this->ensureCandidates(reach.most, true);
  return candidates_;
}

const CandidatePairs& SingleRock::candidatesAt(const BlockState& end, const PlacedBlock& placed,
  const PairBody& body, double way, double allowed)
{
  if (!structures_.solid())
  {
    const double r = body_.block.radius();
    const Vec3& p = end.position;
    if (!patch_.covers(p.x() - r, p.x() + r, p.y() - r, p.y() + r))
    {
      this->ensurePatch(way);
    }
    if (patch_.isSlopeOnly())
    {
      CandidatePairs& now = workSpace();
      gatherCandidatesUnder(placed, body, patch_, allowed, now);
      return now;
    }
  }
  if (candidates_.room(end, body_.block.radius(), 0.0) < 0.0)
  {
    // Thrown further than anyone would have thought.
    this->ensureCandidates(way, true);
  }
  return candidates_;
}

bool SingleRock::isClear(double reach)
{
  if (structures_.solid() || !body_.contacts.empty())
  {
    return false;
  }
  const double r = body_.block.radius();
  const Vec3& p = body_.state.position;
  if (!heightBound_.covers(p, r + reach))
  {
    thread_local HeightWindow window;
    const double half = r + reach + kGroundHeightBound * r;
    window.gather(surface_, p.x() - half, p.x() + half, p.y() - half, p.y() + half);
    heightBound_ = GroundHeightBound(window);
  }
  return this->isClearAt(p, reach);
}

} // namespace rockfall
