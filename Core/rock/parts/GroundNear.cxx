#include "rock/parts/GroundNear.h"

#include "block/cayley.h"
#include "block/flight.h"
#include "contact/ground/clearance.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"

#include <algorithm>

namespace rockfall
{

namespace
{

/// State of the rock, as it goes now, when some point of it may have come `way` (m) far.
BlockState onTheWay(const RockBody& body, double way)
{
  BlockState ahead = body.state;
  const double speed = ahead.velocity.norm() + ahead.spin.norm() * body.block.radius();
  if (speed > 0.0)
  {
    const double time = way / speed;
    ahead.position += time * ahead.velocity;
    ahead.orientation = (ahead.orientation * cayley(time * ahead.spin)).normalized();
  }
  return ahead;
}

} // namespace

std::array<double, 4> GroundNear::boxOfWay(const RockBody& body, double duration) const
{
  const double r = body.block.radius();
  const Vec3& p = body.state.position;
  const Vec3 end = p + duration * body.state.velocity;
  return { std::min(p.x(), end.x()) - r, std::max(p.x(), end.x()) + r, std::min(p.y(), end.y()) - r,
    std::max(p.y(), end.y()) + r };
}

void GroundNear::ensureWindow(const RockBody& body, double duration)
{
  const auto [x0, x1, y0, y1] = this->boxOfWay(body, duration);
  if (!window_.covers(x0, x1, y0, y1))
  {
    window_.gather(surface_, x0, x1, y0, y1);
  }
}

double GroundNear::timeToGround(const RockBody& body, double duration)
{
  if (window_.whole())
  {
    return timeToTouch(body.placed, body.state, window_, gravity_, duration);
  }
  // A rock over a hole has no gap to close: it comes to a rim or a wall from beside.
  const auto [x0, x1, y0, y1] = this->boxOfWay(body, duration);
  if (!holed_.covers(x0, x1, y0, y1))
  {
    gatherPatch(surface_, x0, x1, y0, y1, holed_);
  }
  return clearance(body.placed, body.state, holed_, gravity_, duration).time;
}

bool GroundNear::clearFor(const RockBody& body, double duration) const
{
  // The parabola is concave: its lowest point is at one of its ends.
  const double end = placeInFlight(body.state, gravity_, duration).z();
  const double lowest = std::min(body.state.position.z(), end) - body.block.radius();
  const auto [x0, x1, y0, y1] = this->boxOfWay(body, duration);
  return surface_.maxHeight(x0, x1, y0, y1) < lowest;
}

void GroundNear::ensurePatch(const RockBody& body, const StructuresOnWay& structures, double margin)
{
  const Vec3 lower = body.placed.lower(), upper = body.placed.upper();
  if (!patch_.covers(
        lower.x() - margin, upper.x() + margin, lower.y() - margin, upper.y() + margin))
  {
    gatherPatch(surface_, lower.x() - margin, upper.x() + margin, lower.y() - margin,
      upper.y() + margin, patch_);
    if (structures.solid())
    {
      const double ring = patch_.cellSize;
      structures.obstacles().append(patch_.xMin - ring, patch_.xMax + ring, patch_.yMin - ring,
        patch_.yMax + ring, structures.goneTrees(), patch_);
    }
    if (depth_ > 0.0)
    {
      this->lower(depth_, depth_);
    }
    this->forgetCandidates();
  }
}

void GroundNear::forgetPatch()
{
  patch_.xMax = patch_.xMin - 1.0;
  this->forgetCandidates();
}

void GroundNear::lower(double by, double depth)
{
  depth_ = depth;
  bool firm = false;
  for (SurfacePatch::Node& node : patch_.nodes)
  {
    node.position.z() -= node.firm ? 0.0 : by;
    firm = firm || node.firm;
  }
  for (SurfacePatch::Triangle& triangle : patch_.triangles)
  {
    triangle.offset -= triangle.firm ? 0.0 : by * triangle.normal.z();
  }
  if (firm)
  {
    this->forgetCandidates();
    return;
  }
  // For the pairs that can touch the rock has moved the other way.
  candidates_.position.z() -= by;
  candidates_.travel.lower(by);
}

void GroundNear::ensureCandidates(
  const RockBody& body, const StructuresOnWay& structures, double reach, bool among)
{
  if (candidates_.room(body.state, body.block.radius(), reach) < 0.0)
  {
    // Where nothing was near at the last look there is little that a wider one finds.
    const double slack = among && candidates_.empty() ? kFarCandidateSlack : kCandidateSlack;
    // In a scar the ground moves under the rock as well.
    const double room = std::max(slack * body.block.radius(), depth_);
    const double share = among ? kCandidatesBeyondAmong : kCandidatesBeyond;
    const double beyond = std::max(share * reach, room);
    const double distance = reach + beyond, ahead = kCandidatesAhead * beyond;
    this->ensurePatch(body, structures, distance + ahead);
    const BlockState state = onTheWay(body, ahead);
    thread_local PlacedBlock placed;
    placed.place(body.block, state);
    gatherCandidates(placed, state, patch_, distance, candidates_);
  }
}

const CandidatePairs& GroundNear::candidatesAt(
  const RockBody& body, const StructuresOnWay& structures, const BlockState& end, double way)
{
  if (candidates_.room(end, body.block.radius(), 0.0) < 0.0)
  {
    // Thrown further than anyone would have thought.
    this->ensureCandidates(body, structures, way, true);
  }
  return candidates_;
}

bool GroundNear::isClear(const RockBody& body, const StructuresOnWay& structures, double reach)
{
  if (structures.solid() || !body.contacts.empty())
  {
    return false;
  }
  const double r = body.block.radius();
  const Vec3& p = body.state.position;
  if (!heightBound_.covers(p, r + reach))
  {
    thread_local HeightWindow window;
    const double half = r + reach + kGroundHeightBound * r;
    window.gather(surface_, p.x() - half, p.x() + half, p.y() - half, p.y() + half);
    heightBound_ = GroundHeightBound(window);
  }
  return this->isClearAt(body, p, reach);
}

} // namespace rockfall
