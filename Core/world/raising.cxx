#include "world/raising.h"

#include "base/abort.h"
#include "contact/pair/broadPhase.h"
#include "contact/pairs.h"
#include "law/settings.h"

#include <algorithm>
#include <queue>
#include <utility>
#include <vector>

namespace rockfall
{

namespace
{

/// A rock somewhere over where it stands.
class Climbing
{
public:
  void set(const RaisedRock& rock, double height)
  {
    BlockState state = rock.state;
    state.position.z() += height;
    placed_.place(*rock.block, state);
    body_.update(placed_);
  }
  const PairBody& body() const { return body_; }

private:
  PlacedBlock placed_;
  PairBody body_;
};

/// Whether faces of the two lie on each other: corners of the polygon that they share.
bool isJoined(const PairBody& first, const PairBody& second, double touch)
{
  PairAxis axis = findAxis(first, second, {}, touch);
  if (axis.distance > touch)
  {
    return false;
  }
  axis = bestAxis(first, second);
  std::vector<Contact> touches;
  findTouches(first, second, axis, touch, touches);
  return std::count_if(touches.begin(), touches.end(),
           [&](const Contact& c) { return c.distance <= touch; }) > 2;
}

/// How far (m) a rock may go straight up until it comes into another one; `most` or more: not
/// within that. 0 if they are joined.
///
/// The gap is a convex function of the way, the largest of what single axes show: going by one
/// axis' gap until that is used up never goes too far, and needs each axis once.
double roomAbove(const RaisedRock& rock, const RaisedRock& other, double most, Climbing& climbing,
  Climbing& standing)
{
  const double touch = kTouch * std::min(rock.block->radius(), other.block->radius());
  standing.set(other, 0.0);
  climbing.set(rock, 0.0);
  if (isJoined(climbing.body(), standing.body(), touch))
  {
    return 0.0;
  }
  double way = 0.0;
  for (int k = 0; k < kMostAxes && way < most; ++k)
  {
    climbing.set(rock, way);
    PairAxis axis = findAxis(climbing.body(), standing.body(), {}, kEndsBelow * touch);
    if (axis.distance <= kEndsBelow * touch)
    {
      axis = bestAxis(climbing.body(), standing.body());
    }
    if (axis.normal.z() >= 0.0)
    {
      return most; // up is away from it
    }
    if (axis.distance <= kEndsBelow * touch)
    {
      return way;
    }
    way += (axis.distance - kEndsAt * touch) / -axis.normal.z();
  }
  return way;
}

} // namespace

void raiseOthers(std::span<RaisedRock> rocks)
{
  // By falling lifts: what a rock makes another one's lift is never more than its own, so each has
  // its last one when it is the highest that is left.
  std::priority_queue<std::pair<double, int>> left;
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    if (rocks[i].lift > 0.0)
    {
      left.emplace(rocks[i].lift, int(i));
    }
  }
  if (left.empty())
  {
    return;
  }
  std::vector<BroadBox> boxes(rocks.size());
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    boxes[i].center = rocks[i].state.position;
    boxes[i].radius = (1.0 + kTouch) * rocks[i].block->radius();
  }
  BroadPhase near;
  near.place(boxes);
  std::vector<int> found;
  Climbing climbing, standing;
  while (!left.empty())
  {
    stayWanted();
    const auto [lift, i] = left.top();
    left.pop();
    const RaisedRock& rock = rocks[std::size_t(i)];
    if (lift < rock.lift)
    {
      continue; // it came again, higher
    }
    near.within(boxes[std::size_t(i)].center + Vec3(0.0, 0.0, 0.5 * lift),
      boxes[std::size_t(i)].radius + 0.5 * lift, found);
    for (const int j : found)
    {
      RaisedRock& other = rocks[std::size_t(j)];
      const Vec3 apart = other.state.position - rock.state.position;
      if (other.lift >= lift ||
        apart.head<2>().norm() > boxes[std::size_t(i)].radius + boxes[std::size_t(j)].radius)
      {
        continue;
      }
      const double raised = lift - roomAbove(rock, other, lift - other.lift, climbing, standing);
      if (raised > other.lift)
      {
        other.lift = raised;
        left.emplace(raised, j);
      }
    }
  }
}

} // namespace rockfall
