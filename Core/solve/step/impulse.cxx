#include "solve/step/impulse.h"

#include "law/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

/// A point with what it needs in each part.
struct Point
{
  std::array<Vec3, 3> axis;     ///< Normal and two directions across it.
  std::array<Vec3, 3> arm;      ///< Lever × axis, m.
  std::array<Vec3, 3> turn;     ///< Angular velocity by a unit impulse along it, 1/(kg m).
  std::array<double, 3> across; ///< Velocity across by unit impulses across, inverted: 11, 12, 22.
  std::array<double, 3> speed;  ///< Along the axes, m/s.
  std::array<double, 3> part;   ///< Of the impulse at hand, N s.
  double stored = 0.0;          ///< E, J.
  bool back = false;            ///< In restitution.
};

std::array<double, 3> speeds(const Point& p, const Vec3& v, const Vec3& w)
{
  return { p.axis[0].dot(v) + p.arm[0].dot(w), p.axis[1].dot(v) + p.arm[1].dot(w),
    p.axis[2].dot(v) + p.arm[2].dot(w) };
}

Point placed(const ImpulseBody& body, const ImpulsePoint& given)
{
  Point p;
  p.axis[0] = given.normal;
  p.axis[1] = given.normal.unitOrthogonal();
  p.axis[2] = given.normal.cross(p.axis[1]);
  for (int k = 0; k < 3; ++k)
  {
    p.arm[k] = given.lever.cross(p.axis[k]);
    p.turn[k] = body.inverseInertia * p.arm[k];
  }
  const double a = body.inverseMass + p.arm[1].dot(p.turn[1]), b = p.arm[1].dot(p.turn[2]),
               d = body.inverseMass + p.arm[2].dot(p.turn[2]);
  const double inverse = 1.0 / (a * d - b * b);
  p.across = { d * inverse, -b * inverse, a * inverse };
  return p;
}

/// Coulomb's law over a part: what stops all slip in it, or the limit against the slip. `slip`: at
/// the part's end without it, m/s; `limit`: N s.
std::array<double, 2> frictionOf(const Point& p, double slip1, double slip2, double limit)
{
  const double stop1 = -(p.across[0] * slip1 + p.across[1] * slip2);
  const double stop2 = -(p.across[1] * slip1 + p.across[2] * slip2);
  const double size2 = stop1 * stop1 + stop2 * stop2;
  if (size2 <= limit * limit)
  {
    return { stop1, stop2 };
  }
  const double now2 = p.speed[1] * p.speed[1] + p.speed[2] * p.speed[2];
  if (now2 > 1e-24)
  {
    const double share = -limit / std::sqrt(now2);
    return { share * p.speed[1], share * p.speed[2] };
  }
  const double share = limit / std::sqrt(size2);
  return { share * stop1, share * stop2 };
}

/// Share of a part until something begins or ends at a point: compression, or what is stored.
/// `gain`: of the normal speed over all of the part, m/s.
double shareUntilTurn(const Point& p, double gain, double restitution, double still)
{
  const double w = p.speed[0];
  if (!p.back)
  {
    return w + gain > 0.0 ? std::min(1.0, -w / gain) : 1.0;
  }
  // s dP (w + ½ s gain) = e² E
  const double left = restitution * restitution * p.stored;
  const double along = p.part[0] * w, half = p.part[0] * (w + 0.5 * gain);
  double share = 1.0;
  if (half >= left && left > 0.0)
  {
    const double root = std::sqrt(std::max(0.0, along * along + 2.0 * p.part[0] * gain * left));
    share = std::min(1.0, 2.0 * left / (along + root));
  }
  return w > still && w + gain < 0.0 ? std::min(share, -w / gain) : share;
}

} // namespace

void resolveImpulse(ImpulseBody& body, std::span<ImpulsePoint> given, double quiet)
{
  std::array<Point, kMostImpulsePoints> points;
  const std::size_t count = std::min(given.size(), kMostImpulsePoints);
  double frequency2 = 0.0, fastest = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    points[i] = placed(body, given[i]);
    points[i].speed = speeds(points[i], body.velocity, body.angularVelocity);
    frequency2 += given[i].stiffness * (body.inverseMass + points[i].arm[0].dot(points[i].turn[0]));
    fastest = std::max(fastest, -points[i].speed[0]);
  }
  const double h = std::numbers::pi / (kImpulseParts * std::sqrt(frequency2));
  const double still = 1e-9 * fastest;
  for (int k = 0; k < kMostImpulseParts; ++k)
  {
    // Normal impulses of a part, all at once, so that none is before the others.
    Vec3 v = body.velocity, w = body.angularVelocity;
    bool any = false;
    for (std::size_t i = 0; i < count; ++i)
    {
      Point& p = points[i];
      p.part = { 0.0, 0.0, 0.0 };
      const double comes = p.back ? 0.0 : std::max(0.0, -p.speed[0]);
      if (p.stored > 0.0 || comes > quiet)
      {
        any = true;
        p.part[0] = h *
          (std::sqrt(2.0 * given[i].stiffness * p.stored) + 0.5 * h * given[i].stiffness * comes);
        v += (p.part[0] * body.inverseMass) * p.axis[0];
        w += p.part[0] * p.turn[0];
      }
    }
    if (!any)
    {
      break;
    }
    for (std::size_t n = 0; n < count; ++n)
    {
      // From both sides in turn: points that stick hold each other.
      const std::size_t i = k % 2 == 0 ? n : count - 1 - n;
      Point& p = points[i];
      if (p.part[0] > 0.0 && given[i].friction > 0.0)
      {
        const std::array<double, 3> u = speeds(p, v, w);
        const auto [x, y] = frictionOf(p, u[1], u[2], given[i].friction * p.part[0]);
        p.part[1] = x;
        p.part[2] = y;
        v += body.inverseMass * (x * p.axis[1] + y * p.axis[2]);
        w += x * p.turn[1] + y * p.turn[2];
      }
    }
    const Vec3 dv = v - body.velocity, dw = w - body.angularVelocity;
    std::array<std::array<double, 3>, kMostImpulsePoints> gains;
    double share = 1.0;
    for (std::size_t i = 0; i < count; ++i)
    {
      gains[i] = speeds(points[i], dv, dw);
      if (points[i].part[0] > 0.0)
      {
        share =
          std::min(share, shareUntilTurn(points[i], gains[i][0], given[i].restitution, still));
      }
    }
    body.velocity += share * dv;
    body.angularVelocity += share * dw;
    for (std::size_t i = 0; i < count; ++i)
    {
      Point& p = points[i];
      const std::array<double, 3>& gain = gains[i];
      const double e = given[i].restitution;
      const double work = share * p.part[0] * (p.speed[0] + 0.5 * share * gain[0]);
      given[i].impulse += share * p.part[0];
      given[i].restitutionLoss -= work;
      given[i].frictionLoss -= share *
        (p.part[1] * (p.speed[1] + 0.5 * share * gain[1]) +
          p.part[2] * (p.speed[2] + 0.5 * share * gain[2]));
      for (int d = 0; d < 3; ++d)
      {
        p.speed[d] += share * gain[d];
      }
      if (p.part[0] > 0.0)
      {
        const double left =
          p.stored - (p.back && work > 0.0 ? work / std::max(e * e, 1e-12) : work);
        p.stored = !p.back || left > 1e-12 * p.stored ? std::max(0.0, left) : 0.0;
      }
      // A point turns where it was stopped, or where others push it back.
      p.back = p.speed[0] > -still;
      p.stored = p.back && e * e < 1e-12 ? 0.0 : p.stored;
    }
  }
}

} // namespace rockfall
