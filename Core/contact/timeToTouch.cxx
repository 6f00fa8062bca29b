#include "contact/Contact.h"
#include "contact/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// The bound while it is made smaller place by place. A material point q of the rock over a slope
/// with gradient a ± s closes its gap at no more than −w_z + a·w + s |w| with its velocity w, and
/// gravity and its turning add no more than ½ (g + κ q̈) t². Between two places of the rock's
/// surface over one CFE the gap is linear and that rate convex: the places where either has a
/// corner are enough.
class Touch
{
public:
  Touch(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch, double gravity,
    double horizon)
    : rock_(rock)
    , patch_(patch)
    , velocity_(state.velocity)
    , spin_(state.angularVelocity())
    , time_(horizon)
  {
    const Block& block = rock.block();
    const double rim = block.largestRimSpeed(state.spin);
    const double kappa = std::sqrt(1.0 + patch.tilt.squaredNorm()) + patch.relief;
    // |ω̇| ≤ |ω|², as no moment of inertia is more than the sum of the others.
    const double fastest = block.isotropic() ? state.spin.norm() : block.largestSpin(state.spin).norm();
    const double turning = (block.isotropic() ? 1.0 : 2.0) * fastest * fastest * block.radius();
    acceleration_ = gravity + kappa * turning;
    fastest_ = this->rate(velocity_) + kappa * rim;
    this->updateFar();
  }

  double time() const { return time_; }
  /// Gaps beyond this do not matter any more, m.
  double far() const { return far_; }

  void visit(const Vec3& point, double gap)
  {
    if (gap >= far_)
    {
      return;
    }
    const Vec3 w = velocity_ + spin_.cross(point - rock_.position());
    const double t = timeToCover(gap, this->rate(w), acceleration_);
    if (t < time_)
    {
      time_ = t;
      this->updateFar();
    }
  }

private:
  double rate(const Vec3& w) const
  {
    return patch_.tilt.dot(w.head<2>()) - w.z() + patch_.relief * w.head<2>().norm();
  }
  void updateFar()
  {
    far_ = std::max(0.0, fastest_ * time_) + 0.5 * acceleration_ * time_ * time_;
  }

  const PlacedBlock& rock_;
  const SurfacePatch& patch_;
  Vec3 velocity_, spin_;
  double time_;
  double acceleration_ = 0.0;
  double fastest_ = 0.0;
  double far_ = 0.0;
};

/// Where a vertical line through a world point enters the rock from below, over that point, m; ∞ if
/// it misses it.
double entersAt(const PlacedBlock& rock, const Vec3& world)
{
  const Polyhedron& shape = rock.block().shape();
  const Vec3 x = rock.materialPoint(world);
  const Vec3 up = rock.rotation().row(2).transpose();
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t f = 0; f < shape.normals().size(); ++f)
  {
    const Vec3& n = shape.normals()[f];
    const double rise = n.dot(up), room = shape.offsets()[f] - n.dot(x);
    if (rise < 0.0)
    {
      low = std::max(low, room / rise);
    }
    else if (rise > 0.0)
    {
      high = std::min(high, room / rise);
    }
    else if (room < 0.0)
    {
      return high;
    }
  }
  return low <= high ? low : std::numeric_limits<double>::infinity();
}

} // namespace

double timeToTouch(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double gravity, double horizon)
{
  if (patch.nodes.empty())
  {
    return horizon;
  }
  Touch touch(rock, state, patch, gravity, horizon);
  const auto over = [&](const Vec3& p) { touch.visit(p, p.z() - patch.elevation(p.x(), p.y())); };
  const std::vector<Vec3>& vertices = rock.vertices();
  for (const Vec3& p : vertices)
  {
    if (p.z() - patch.highest < touch.far())
    {
      over(p);
    }
  }
  // Nodes of the slope under the rock.
  const Vec3 corner = patch.nodes[0].position;
  const double inverse = 1.0 / patch.cellSize;
  const auto index = [&](double v, int count) { return std::clamp(int(std::floor(v)), -1, count); };
  const int column0 = index((rock.lower().x() - corner.x()) * inverse, patch.nodeColumns) + 1;
  const int column1 = index((rock.upper().x() - corner.x()) * inverse, patch.nodeColumns - 1);
  const int row0 = index((corner.y() - rock.upper().y()) * inverse, patch.nodeRows) + 1;
  const int row1 = index((corner.y() - rock.lower().y()) * inverse, patch.nodeRows - 1);
  for (int row = row0; row <= row1; ++row)
  {
    for (int column = column0; column <= column1; ++column)
    {
      const SurfacePatch::Node& node = patch.nodes[std::size_t(row) * patch.nodeColumns + column];
      if (node.cfe != 0 && rock.lower().z() - node.position.z() < touch.far())
      {
        const double gap = entersAt(rock, node.position);
        if (gap < touch.far())
        {
          touch.visit(node.position + gap * Vec3::UnitZ(), gap);
        }
      }
    }
  }
  // Edges of the rock where they pass over edges of the slope: grid lines and diagonals.
  const Polyhedron& shape = rock.block().shape();
  const Vec3 up = rock.rotation().row(2).transpose();
  for (const Polyhedron::Edge& e : shape.edges())
  {
    const Vec3& p = vertices[e.vertices[0]];
    const Vec3& q = vertices[e.vertices[1]];
    if (std::min(p.z(), q.z()) - patch.highest >= touch.far() ||
      (up.dot(shape.normals()[e.faces[0]]) > 0.0 && up.dot(shape.normals()[e.faces[1]]) > 0.0))
    {
      continue;
    }
    const double x0 = (p.x() - corner.x()) * inverse, x1 = (q.x() - corner.x()) * inverse;
    const double y0 = (corner.y() - p.y()) * inverse, y1 = (corner.y() - q.y()) * inverse;
    const double from[3] = { x0, y0, x0 - y0 }, to[3] = { x1, y1, x1 - y1 };
    const int most[3] = { patch.nodeColumns - 1, patch.nodeRows - 1, patch.nodeColumns - 1 };
    const int least[3] = { 0, 0, 1 - patch.nodeRows };
    for (int family = 0; family < 3; ++family)
    {
      const double a = std::min(from[family], to[family]), b = std::max(from[family], to[family]);
      const int first = int(std::ceil(std::max(a, double(least[family]))));
      const int last = int(std::floor(std::min(b, double(most[family]))));
      for (int k = first; k <= last; ++k)
      {
        const double part = (k - from[family]) / (to[family] - from[family]);
        if (part >= 0.0 && part <= 1.0)
        {
          over(p + part * (q - p));
        }
      }
    }
  }
  return touch.time();
}

} // namespace rockfall
