// The part of the slope near a rock, and the proof that none is.

#include "simulation/RockSimulator.h"

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

void RockSimulator::ensurePatch(double margin)
{
  const Vec3 lower = placed_.lower(), upper = placed_.upper();
  if (!patch_.covers(
        lower.x() - margin, upper.x() + margin, lower.y() - margin, upper.y() + margin))
  {
    gatherPatch(surface_, lower.x() - margin, upper.x() + margin, lower.y() - margin,
      upper.y() + margin, patch_);
    if (solid_)
    {
      const double ring = patch_.cellSize;
      obstacles_->append(patch_.xMin - ring, patch_.xMax + ring, patch_.yMin - ring,
        patch_.yMax + ring, goneTrees_, patch_);
    }
    if (scar_.open())
    {
      this->lowerPatch(scar_.depth());
    }
    candidates_.distance = -1.0;
  }
}

void RockSimulator::ensureCandidates(double reach, bool among)
{
  if (candidates_.room(state_, block_.radius(), reach) < 0.0)
  {
    // Where nothing was near at the last look there is little that a wider one finds.
    const double slack = among && candidates_.empty() ? kFarCandidateSlack : kCandidateSlack;
    // In a scar the ground moves under the rock as well.
    const double room = std::max(slack * block_.radius(), scar_.depth());
    const double distance = std::max(2.0 * reach, reach + room);
    this->ensurePatch(distance);
    gatherCandidates(placed_, state_, patch_, distance, candidates_);
  }
}

const CandidatePairs& RockSimulator::candidatesNow(const PairBody& body, const SlopeReach& reach)
{
  if (!solid_)
  {
    this->ensurePatch(2.0 * reach.most);
    if (patch_.isSlopeOnly())
    {
      CandidatePairs& now = workSpace();
      gatherNow(placed_, body, patch_, reach, now);
      return now;
    }
  }
  this->ensureCandidates(reach.most, true);
  return candidates_;
}

const CandidatePairs& RockSimulator::candidatesAt(const BlockState& end, const PlacedBlock& placed,
  const PairBody& body, double way, double allowed)
{
  if (!solid_)
  {
    const double r = block_.radius();
    const Vec3& p = end.position;
    if (!patch_.covers(p.x() - r, p.x() + r, p.y() - r, p.y() + r))
    {
      this->ensurePatch(way);
    }
    if (patch_.isSlopeOnly())
    {
      CandidatePairs& now = workSpace();
      gatherUnder(placed, body, patch_, allowed, now);
      return now;
    }
  }
  if (candidates_.room(end, block_.radius(), 0.0) < 0.0)
  {
    // Thrown further than anyone would have thought.
    this->ensureCandidates(way, true);
  }
  return candidates_;
}

bool RockSimulator::isHigh(double reach)
{
  if (solid_ || !contacts_.empty())
  {
    return false;
  }
  const double r = block_.radius();
  const Vec3& p = state_.position;
  if (!lid_.covers(p, r + reach))
  {
    thread_local HeightWindow window;
    const double half = r + reach + kGroundLid * r;
    window.gather(surface_, p.x() - half, p.x() + half, p.y() - half, p.y() + half);
    lid_ = GroundLid(window);
  }
  return this->isHighAt(p, reach);
}

} // namespace rockfall
