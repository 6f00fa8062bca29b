#include "statistics/path.h"

#include "base/errors.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace rockfall
{

namespace
{

/// The one sign change of f between a and b, where f is monotone.
double bracketed(const Cubic& f, double a, double b)
{
  const bool rising = f(a) < 0.0;
  double s = 0.5 * (a + b);
  for (int k = 0; k < 200; ++k)
  {
    const double value = f(s);
    (((value < 0.0) == rising) ? a : b) = s;
    const double slope = f.c[1] + s * (2.0 * f.c[2] + s * 3.0 * f.c[3]);
    double next = slope != 0.0 ? s - value / slope : a;
    if (!(next > a && next < b))
    {
      next = 0.5 * (a + b);
    }
    if (next == s || !(next > a && next < b))
    {
      break;
    }
    s = next;
  }
  return s;
}

} // namespace

Roots extremes(const Cubic& f, double from, double to)
{
  Roots result;
  const auto keep = [&](double s)
  {
    if (s > from && s < to && (result.count == 0 || s != result.at[0]))
    {
      result.at[std::size_t(result.count++)] = s;
    }
  };
  // 3 c₃ s² + 2 c₂ s + c₁ = 0, without cancellation.
  const double a = 3.0 * f.c[3], half = f.c[2], c = f.c[1];
  const double discriminant = half * half - a * c;
  if (!(discriminant >= 0.0))
  {
    return result;
  }
  const double q = -(half + std::copysign(std::sqrt(discriminant), half));
  if (a != 0.0)
  {
    keep(q / a);
  }
  if (q != 0.0)
  {
    keep(c / q);
  }
  if (result.count == 2 && result.at[1] < result.at[0])
  {
    std::swap(result.at[0], result.at[1]);
  }
  return result;
}

Roots signChanges(const Cubic& f, double from, double to)
{
  Roots result;
  const Roots turns = extremes(f, from, to);
  double a = from;
  for (int k = 0; k <= turns.count; ++k)
  {
    const double b = k < turns.count ? turns.at[std::size_t(k)] : to;
    if ((f(a) < 0.0) != (f(b) < 0.0))
    {
      result.at[std::size_t(result.count++)] = bracketed(f, a, b);
    }
    a = b;
  }
  return result;
}

PathPiece::PathPiece(const PathPoint& a, const PathPoint& b, double mass)
  : a_(a)
  , b_(b)
  , mass_(mass)
  , duration_(b.time - a.time)
{
  for (int k = 0; k < 3; ++k)
  {
    const double d = b.position[k] - a.position[k];
    const double va = duration_ * a.velocity[k], vb = duration_ * b.velocity[k];
    place_[std::size_t(k)].c = { a.position[k], va, 3.0 * d - 2.0 * va - vb, va + vb - 2.0 * d };
  }
}

std::array<double, 2> PathPiece::bounds(int axis) const
{
  const double third = duration_ / 3.0;
  const auto [low, high] =
    std::minmax({ a_.position[axis], a_.position[axis] + third * a_.velocity[axis],
      b_.position[axis] - third * b_.velocity[axis], b_.position[axis] });
  return { low, high };
}

double PathPiece::translationalEnergy(double s) const
{
  return 0.5 * mass_ * this->velocity(s).squaredNorm();
}

double PathPiece::kineticEnergy(double s) const
{
  if (std::isnan(mass_))
  {
    return (1.0 - s) * a_.kineticEnergy + s * b_.kineticEnergy;
  }
  const double spinA = a_.kineticEnergy - 0.5 * mass_ * a_.velocity.squaredNorm();
  const double spinB = b_.kineticEnergy - 0.5 * mass_ * b_.velocity.squaredNorm();
  return this->translationalEnergy(s) + (1.0 - s) * spinA + s * spinB;
}

Cubic PathPiece::height(double groundA, double groundB) const
{
  double offsetA = a_.position.z() - groundA - a_.heightOverGround;
  double offsetB = b_.position.z() - groundB - b_.heightOverGround;
  if (std::isnan(offsetA))
  {
    offsetA = offsetB;
  }
  if (std::isnan(offsetB))
  {
    offsetB = offsetA;
  }
  Cubic result = place_[2];
  result.c[0] -= offsetA;
  result.c[1] -= offsetB - offsetA;
  return result;
}

double PathPiece::maxSpeed(double from, double to) const
{
  // Convex along the piece.
  return std::max(this->velocity(from).norm(), this->velocity(to).norm());
}

double PathPiece::maxKineticEnergy(double from, double to) const
{
  // Convex, too.
  return std::max(this->kineticEnergy(from), this->kineticEnergy(to));
}

double PathPiece::maxRotationRate(double from, double to) const
{
  // The magnitude of what is linear is convex.
  return std::max(this->rotationRate(from).norm(), this->rotationRate(to).norm());
}

void checkPath(const RockPath& path)
{
  const auto refuse = [&path](std::size_t k, const std::string& what)
  {
    throw DataError("The trajectory of iteration " + std::to_string(path.iteration) + ", rock " +
      std::to_string(path.rock) + " has " + what + " at its point " + std::to_string(k + 1));
  };
  for (std::size_t k = 0; k < path.points.size(); ++k)
  {
    const PathPoint& p = path.points[k];
    if (!std::isfinite(p.time) || (k > 0 && p.time < path.points[k - 1].time))
    {
      refuse(k, "a Time that is not finite or earlier than the one before");
    }
    if (!p.position.allFinite())
    {
      refuse(k, "a coordinate that is not finite");
    }
    if (!p.velocity.allFinite())
    {
      refuse(k, "a Velocity that is not finite");
    }
    if (!p.rotationRate.allFinite())
    {
      refuse(k, "a RotationRate that is not finite");
    }
    if (!std::isfinite(p.kineticEnergy))
    {
      refuse(k, "a KineticEnergy that is not finite");
    }
    if (std::isinf(p.heightOverGround))
    {
      refuse(k, "an infinite HeightOverGround");
    }
  }
}

} // namespace rockfall
