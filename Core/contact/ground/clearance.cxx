#include "contact/ground/clearance.h"

#include "contact/ground/motion.h"
#include "contact/ground/roundContact.h"

#include <algorithm>
#include <limits>

namespace rockfall
{

namespace
{

/// How fast the rock can come nearer along an axis.
struct Approach
{
  Vec3 velocity;
  double rim; ///< |ω| r, m/s.
  double gravity;

  double time(const Vec3& axis, double distance) const
  {
    return timeToCover(
      distance, this->rim - axis.dot(this->velocity), this->gravity * std::max(0.0, axis.z()));
  }
};

/// The best separating axis of one triangle so far.
struct Separation
{
  double distance = -std::numeric_limits<double>::infinity();
  double time = 0.0;

  void improve(const Approach& approach, const Vec3& axis, double along)
  {
    this->distance = std::max(this->distance, along);
    this->time = std::max(this->time, approach.time(axis, along));
  }
};

Separation separate(const PlacedBlock& rock, const std::array<Vec3, 3>& q,
  const SurfacePatch::Triangle& t, const Approach& approach, double horizon)
{
  Separation best;
  const auto low = [&](int axis) { return std::min({ q[0][axis], q[1][axis], q[2][axis] }); };
  const auto high = [&](int axis) { return std::max({ q[0][axis], q[1][axis], q[2][axis] }); };
  for (int axis = 0; axis < 3; ++axis)
  {
    best.improve(approach, Vec3::Unit(axis), rock.lower()[axis] - high(axis));
    best.improve(approach, -Vec3::Unit(axis), low(axis) - rock.upper()[axis]);
  }
  if (best.time >= horizon)
  {
    return best;
  }
  const auto lowestAlong = [&](const Vec3& n)
  {
    double d = std::numeric_limits<double>::infinity();
    for (const Vec3& p : rock.vertices())
    {
      d = std::min(d, n.dot(p));
    }
    return d;
  };
  const auto highestAlong = [&](const Vec3& n) {
    return std::max({ n.dot(q[0]), n.dot(q[1]), n.dot(q[2]) });
  };
  best.improve(approach, t.normal, lowestAlong(t.normal) - t.offset);
  if (best.time >= horizon)
  {
    return best;
  }
  const Polyhedron& shape = rock.block().shape();
  for (std::size_t f = 0; f < rock.block().shape().faces().size(); ++f)
  {
    const Vec3 n = -rock.normal(f);
    const double face = n.dot(rock.vertices()[shape.faces()[f][0]]);
    best.improve(approach, n, face - highestAlong(n));
  }
  if (best.time >= horizon)
  {
    return best;
  }
  for (const Polyhedron::Edge& e : shape.edges())
  {
    const Vec3 u = rock.vertices()[e.vertices[1]] - rock.vertices()[e.vertices[0]];
    for (int k = 0; k < 3; ++k)
    {
      Vec3 n = u.cross(q[(k + 1) % 3] - q[k]);
      const double length = n.norm();
      if (length < 1e-12)
      {
        continue;
      }
      n /= length;
      if (n.dot(rock.position() - q[k]) < 0.0)
      {
        n = -n;
      }
      // The axis separates best between the two edges themselves; else another one does.
      const double bound = n.dot(rock.vertices()[e.vertices[0]]) - n.dot(q[k]);
      if (bound > best.distance)
      {
        best.improve(approach, n, lowestAlong(n) - highestAlong(n));
        if (best.time >= horizon)
        {
          return best;
        }
      }
    }
  }
  return best;
}

} // namespace

Clearance clearance(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double gravity, double horizon, bool ofScar)
{
  if (isRound(rock))
  {
    return roundClearance(rock, state, patch, gravity, horizon, ofScar);
  }
  Clearance result;
  result.distance = std::numeric_limits<double>::infinity();
  result.time = horizon;
  const Block& block = rock.block();
  const Approach approach{ state.velocity, block.largestRimSpeed(state.spin), gravity };
  const Approach ball{ state.velocity, 0.0, gravity }; // the bounding sphere does not turn
  for (const SurfacePatch::Triangle& t : patch.triangles)
  {
    if (t.cfe == 0 || (ofScar && t.firm))
    {
      continue;
    }
    const double under = t.normal.dot(rock.position()) - t.offset - block.radius();
    if (under > 0.0 && ball.time(t.normal, under) >= result.time)
    {
      result.distance = std::min(result.distance, under);
      continue;
    }
    const std::array<Vec3, 3> nodes = { patch.nodes[t.nodes[0]].position,
      patch.nodes[t.nodes[1]].position, patch.nodes[t.nodes[2]].position };
    const Separation s = separate(rock, nodes, t, approach, result.time);
    result.distance = std::min(result.distance, s.distance);
    result.time = std::min(result.time, s.time);
  }
  return result;
}

} // namespace rockfall
