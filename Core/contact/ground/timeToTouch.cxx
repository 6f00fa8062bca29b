#include "contact/ground/timeToTouch.h"
#include "contact/ground/heightOver.h"
#include "contact/ground/lowPlaces.h"
#include "contact/ground/motion.h"
#include "contact/ground/roundContact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// The bound while it is made smaller place by place. A material point q of the rock over a slope
/// with gradient a ± s closes its gap by no more than c t + ½ c₂ t² + j t³/6: with its velocity w,
/// c = a·w − w_z + s |w|, c₂ ≥ 0 likewise with its acceleration, and j from the largest third
/// derivative of a turning body. Between two places of the rock's surface over one CFE the gap is
/// linear and these rates are convex: the places where either has a corner are enough.
///
/// Over a rectangle whose own gradients are b ± r (`standOver`), c is that of b and r, and beyond it
/// s + |b − a| − r more for each metre: what closes is the larger of the two sums, with |w| t + …
/// less the way out of the rectangle as these metres. That way is concave over the rectangle, so
/// its corners are enough again; of a place on its border both bounds hold.
class FirstTouch
{
  static constexpr double kAround = 3.0;    ///< Bounds of the time that the known part lasts for.
  static constexpr double kOnBorder = 1e-6; ///< m

public:
  /// `relief`: how far gradients may be from the window's tilt.
  FirstTouch(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
    double relief, double gravity, double horizon)
    : position_(rock.position())
    , velocity_(state.velocity)
    , spin_(rock.rotation() * state.spin)
    , tilt_(window.tilt())
    , relief_(relief)
    , gravity_(gravity)
    , time_(horizon)
  {
    const Block& block = rock.block();
    rim_ = block.largestRimSpeed(state.spin);
    kappa_ = std::sqrt(1.0 + tilt_.squaredNorm()) + relief_;
    double fastest = spin_.norm(), derivatives = 1.0;
    if (!block.isotropic())
    {
      // |ω̇| ≤ |ω|², as no moment of inertia is more than the sum of the others; so |ω̈| ≤ 2 |ω|³ and
      // the third derivative of a point is at most (2 + 2 + 1 + 1) |ω|³ r.
      fastest = block.largestSpin(state.spin).norm();
      derivatives = 6.0;
      const Vec3 momentum = block.inertia() * state.spin;
      spinRate_ = rock.rotation() * (block.inverseInertia() * momentum.cross(state.spin));
    }
    const double turning = fastest * fastest * block.radius();
    third_ = kappa_ * derivatives * turning * fastest / 6.0;
    fastest_ = this->rate(velocity_) + kappa_ * rim_;
    largestBend_ = (block.isotropic() ? 1.0 : 2.0) * turning;
    acceleration_ = gravity + kappa_ * largestBend_;
    this->updateFar();
  }

  double time() const { return time_; }
  /// Gaps beyond this do not matter any more, m.
  double far() const { return far_; }

  void visit(const Vec3& point, double gap)
  {
    if (!(gap < far_)) // nor where there is no ground
    {
      return;
    }
    if (gap <= 0.0)
    {
      time_ = 0.0;
      far_ = 0.0;
      return;
    }
    const Motion motion = this->motionAt(point);
    this->close(
      gap, this->rate(motion.velocity), 0.5 * std::max(0.0, this->rate(motion.bend) + gravity_));
  }
  /// A visit of a place where the ground may be what `standOver` has been given.
  void visitNear(const Vec3& point, double gap)
  {
    if (!(gap < far_))
    {
      return;
    }
    const double inside = gap > 0.0 ? this->insideLocal(point) : -1.0;
    if (inside >= 0.0)
    {
      this->closeNear(point, gap, inside);
    }
    if (inside <= kOnBorder)
    {
      this->visit(point, gap);
    }
  }
  /// Border of the known part of the ground.
  const GridBorder& border() const { return border_; }
  /// Takes the gradients around what is under a point of the rock as known.
  void standOver(const HeightWindow& window, const Vec3& point, double gap)
  {
    if (!(gap >= 0.0))
    {
      return;
    }
    const Motion motion = this->motionAt(point);
    const double across = motion.velocity.head<2>().norm();
    const double soon = timeToCover(gap, this->rate(motion.velocity), gravity_);
    const double cell = window.cellSize(), around = std::min(kAround * across * soon, cell);
    const auto index = [&](double v, int count)
    { return std::clamp(int(v * window.inverseCellSize()), 0, count - 2); };
    const int column0 = index(point.x() - around - window.west(), window.columns());
    const int column1 = index(point.x() + around - window.west(), window.columns());
    const int row0 = index(window.north() - point.y() - around, window.rows());
    const int row1 = index(window.north() - point.y() + around, window.rows());
    local_ = window.gradients(row0, row1, column0, column1);
    border_ = { column0, column1 + 1, row0, row1 + 1 };
    west_ = window.x(border_.west);
    east_ = window.x(border_.east);
    north_ = window.y(border_.north);
    south_ = window.y(border_.south);
    const double off = (local_.tilt - tilt_).norm();
    steeper_ = std::max(0.0, relief_ + off - local_.relief);
    third_ *= 1.0 + 2.0 * off / kappa_;
    fastest_ += 2.0 * off * (velocity_.head<2>().norm() + rim_);
    acceleration_ += 2.0 * off * largestBend_;
    this->updateFar();
  }

  /// A gap of no place of the rock in particular.
  void visitAny(double gap)
  {
    time_ = std::min(time_, timeToCover(gap, fastest_, acceleration_));
    this->updateFar();
  }

private:
  /// Velocity of a material point, and its acceleration but for gravity.
  struct Motion
  {
    Vec3 velocity, bend;
  };
  Motion motionAt(const Vec3& point) const
  {
    const Vec3 lever = point - position_, turning = spin_.cross(lever);
    return { velocity_ + turning, spinRate_.cross(lever) + spin_.cross(turning) };
  }
  /// How far inside the known part of the ground a point is, m; < 0: beside it.
  double insideLocal(const Vec3& p) const
  {
    return std::min({ p.x() - west_, east_ - p.x(), p.y() - south_, north_ - p.y() }) + kOnBorder;
  }
  /// A visit of a material point over the known part, `inside` of its border, m.
  void closeNear(const Vec3& point, double gap, double inside)
  {
    const Motion motion = this->motionAt(point);
    const auto rateOf = [&](const Vec3& w, double across)
    { return local_.tilt.dot(w.head<2>()) - w.z() + local_.relief * across; };
    const double across = motion.velocity.head<2>().norm(), bent = motion.bend.head<2>().norm();
    const double c = rateOf(motion.velocity, across), bend = rateOf(motion.bend, bent) + gravity_;
    this->close(gap, c, 0.5 * std::max(0.0, bend));
    this->close(gap + steeper_ * (inside - kOnBorder), c + steeper_ * across,
      0.5 * std::max(0.0, bend + steeper_ * bent));
  }
  /// A gap (m) that closes by no more than c t + c₂ t² + j t³/6.
  void close(double gap, double c, double c2)
  {
    const auto closed = [&](double t) { return ((third_ * t + c2) * t + c) * t - gap; };
    double after = time_, over = closed(after);
    if (over <= 0.0)
    {
      return; // convex, and not closed by then: not sooner
    }
    // From both sides of the root: tangents from the right, secants from the left.
    after = std::min(after, timeToCover(gap, c, 2.0 * c2));
    over = std::max(closed(after), 1e-300);
    double before = 0.0, under = -gap;
    for (int k = 0; k < 8 && before < 0.98 * after; ++k)
    {
      after -= over / ((3.0 * third_ * after + 2.0 * c2) * after + c);
      over = std::max(closed(after), 1e-300);
      before += (after - before) * under / (under - over);
      under = std::min(closed(before), -1e-300);
    }
    time_ = before;
    this->updateFar();
  }

  double rate(const Vec3& w) const
  {
    return tilt_.x() * w.x() + tilt_.y() * w.y() - w.z() +
      relief_ * std::sqrt(w.x() * w.x() + w.y() * w.y());
  }
  void updateFar() { far_ = std::max(0.0, fastest_ * time_) + 0.5 * acceleration_ * time_ * time_; }

  Vec3 position_, velocity_, spin_;
  Vec3 spinRate_ = Vec3::Zero();
  Eigen::Vector2d tilt_;
  double relief_;
  double gravity_;
  double time_;
  double kappa_ = 1.0;
  double rim_ = 0.0;         ///< m/s
  double largestBend_ = 0.0; ///< m/s²
  double third_ = 0.0;       ///< j/6
  double acceleration_ = 0.0;
  double fastest_ = 0.0;
  double far_ = 0.0;
  // The known part of the ground: none as long as it is inside out.
  GridBorder border_;
  double west_ = 1.0, east_ = -1.0, south_ = 0.0, north_ = 0.0;
  HeightWindow::Gradients local_;
  double steeper_ = 0.0; ///< By how much the slope beyond it may be.
};

} // namespace

double timeToNear(const BlockState& state, double radius, const HeightWindow& window,
  double gravity, double horizon)
{
  const Eigen::Vector2d& tilt = window.tilt();
  const double up = state.position.z() - tilt.dot(state.position.head<2>()) - window.highest();
  const double room = up - radius * std::sqrt(1.0 + tilt.squaredNorm());
  const double rate = tilt.dot(state.velocity.head<2>()) - state.velocity.z();
  return std::min(horizon, timeToCover(room, rate, gravity));
}

double timeToPlane(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  double gravity, double horizon)
{
  if (isRound(rock))
  {
    return timeToNear(state, rock.block().radius(), window, gravity, horizon);
  }
  FirstTouch touch(rock, state, window, 0.0, gravity, horizon);
  const auto over = [&](const Vec3& p)
  { return p.z() - window.tilt().dot(p.head<2>()) - window.highest(); };
  const std::vector<Vec3>& vertices = rock.vertices();
  const auto lowest = std::min_element(vertices.begin(), vertices.end(),
    [&](const Vec3& p, const Vec3& q) { return over(p) < over(q); });
  touch.visit(*lowest, over(*lowest)); // it makes short what the others need
  for (const Vec3& p : vertices)
  {
    touch.visit(p, over(p));
  }
  return touch.time();
}

namespace
{

/// Time for a round body that is so far (m) over the ground, s.
double timeOfRound(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  double gap, double gravity, double horizon)
{
  BlockState still = state; // a sphere does not come nearer by turning
  still.spin = rock.block().isotropic() ? Vec3(Vec3::Zero()) : state.spin;
  FirstTouch any(rock, still, window, window.relief(), gravity, horizon);
  any.visitAny(gap);
  return any.time();
}

} // namespace

double timeToTouch(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  double gravity, double horizon)
{
  if (isRound(rock))
  {
    return timeOfRound(rock, state, window, roundGap(rock, window), gravity, horizon);
  }
  FirstTouch touch(rock, state, window, window.relief(), gravity, horizon);
  visitLowPlaces(
    rock, window, [&] { return touch.far(); },
    [&](const Vec3& place, double gap, const LowFeature&) { touch.visit(place, gap); });
  return touch.time();
}

FlightLook lookAhead(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  const Vec3& near, double gravity, double horizon)
{
  if (isRound(rock))
  {
    const double gap = roundGap(rock, window);
    return { gap, near, timeOfRound(rock, state, window, gap, gravity, horizon) };
  }
  FirstTouch touch(rock, state, window, window.relief(), gravity, horizon);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Vec3 at = rock.position() + rock.map() * near;
  const double under = at.z() - window.elevation(at.x(), at.y());
  touch.standOver(window, at, under);
  touch.visitNear(at, under > 0.0 ? under : infinity); // it makes short what the others need
  double gap = infinity;
  Vec3 lowest = rock.position();
  visitLowPlaces(
    rock, window, [&] { return std::max(touch.far(), gap); },
    [&](const Vec3& place, double over, const LowFeature&)
    {
      touch.visitNear(place, over);
      if (over < gap)
      {
        gap = over;
        lowest = place;
      }
    },
    touch.border());
  return { gap, rock.materialPoint(lowest), touch.time() };
}

} // namespace rockfall
