#include "rock/fragmentation.h"

#include "base/errors.h"
#include "geometry/cutting.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace rockfall
{

namespace
{

/// Uniform in the volume of a convex body.
Vec3 pointIn(const ConvexPiece& body, double volume, double which, std::array<double, 3> at)
{
  // Of the tetrahedra over the fans of the faces, that which this share of the volume falls in.
  const Vec3& apex = body.points.front();
  double left = which * volume;
  std::array<Vec3, 3> base{ apex, apex, apex };
  for (const std::vector<int>& loop : body.faces)
  {
    for (std::size_t k = 2; k < loop.size() && left >= 0.0; ++k)
    {
      const auto side = [&](std::size_t i)
      { return Vec3(body.points[std::size_t(loop[i])] - apex); };
      const Vec3 a = side(0), b = side(k - 1), c = side(k);
      const double part = a.dot(b.cross(c)) / 6.0;
      if (part > 0.0)
      {
        base = { a, b, c };
        left -= part;
      }
    }
  }
  // Rocchini & Cignoni (2000): the cube folded onto the tetrahedron.
  auto [s, t, u] = at;
  if (s + t > 1.0)
  {
    s = 1.0 - s;
    t = 1.0 - t;
  }
  if (t + u > 1.0)
  {
    const double last = u;
    u = 1.0 - s - t;
    t = 1.0 - last;
  }
  else if (s + t + u > 1.0)
  {
    const double last = u;
    u = s + t + u - 1.0;
    s = 1.0 - t - last;
  }
  return apex + s * base[0] + t * base[1] + u * base[2];
}

/// Cuts a body until its parts are whole or too small.
class Breaker
{
public:
  Breaker(const Fragmentation& law, const Surface& surface, std::uint32_t number, double tolerance)
    : law_(law)
    , surface_(surface)
    , number_(std::uint64_t(number) << 32)
    , tolerance_(tolerance)
  {
  }

  void breakUp(const ConvexPiece& body, bool first)
  {
    const VolumeIntegrals integrals = integrateSimplices(body.points, body.faces);
    if (!(integrals.volume >= law_.leastVolume))
    {
      return;
    }
    const double again = 0.5 + law_.fractalDimension / 6.0;
    for (ConvexPiece below, above;; first = false)
    {
      const std::uint64_t draw = number_ | 2 * count_++;
      const auto [breaks, which] = surface_.drawTwo(Draw::Breaking, draw);
      if (!first && breaks >= again)
      {
        this->keep(body);
        return;
      }
      const auto [s, t] = surface_.drawTwo(Draw::Breaking, draw + 1);
      const std::array<double, 2> a = surface_.drawTwo(Draw::BreakingPlane, draw);
      const auto [u, unused] = surface_.drawTwo(Draw::BreakingPlane, draw + 1);
      // Long bodies break across: the normal is uniform over the sphere for a body with three equal
      // moments, and the more along the longest side the longer that is.
      const double z = 2.0 * a[0] - 1.0, turn = 2.0 * std::numbers::pi * a[1];
      const double across = std::sqrt(1.0 - z * z);
      const Vec3 normal =
        (integrals.second * Vec3(across * std::cos(turn), across * std::sin(turn), z)).normalized();
      const Vec3 through = pointIn(body, integrals.volume, which, { s, t, u });
      if (cutPiece(body, { normal, normal.dot(through) }, tolerance_, below, above))
      {
        this->breakUp(below, false);
        this->breakUp(above, false);
        return;
      }
    }
  }

  std::vector<Polyhedron> take() { return std::move(pieces_); }

private:
  void keep(const ConvexPiece& body)
  {
    try
    {
      pieces_.push_back(Polyhedron::fromFaces(body.points, body.faces));
    }
    catch (const GeometryError&)
    {
      // a sliver, which no rock can be
    }
  }

  const Fragmentation& law_;
  const Surface& surface_;
  std::uint64_t number_;
  std::uint64_t count_ = 0; ///< Of bodies looked at.
  double tolerance_;
  std::vector<Polyhedron> pieces_;
};

} // namespace

double meanFragments(double fractalDimension, double share)
{
  const double power = fractalDimension / 3.0;
  return (1.0 - power) / power * (std::pow(share, -power) - 1.0);
}

std::vector<Polyhedron> fragmentsOf(
  const Polyhedron& body, const Fragmentation& law, const Surface& surface, std::uint32_t number)
{
  Breaker breaker(law, surface, number, cutTolerance * body.radius());
  breaker.breakUp({ body.vertices(), body.faces() }, true);
  return breaker.take();
}

Vec3 spreadVelocity(const Vec3& velocity, const Vec3& normal, const Fragmentation& law,
  const Surface& surface, std::uint32_t number)
{
  const double speed = velocity.norm();
  if (!(law.spread > 0.0) || !(speed > 0.0))
  {
    return velocity;
  }
  const auto [u, v] = surface.drawTwo(Draw::FragmentDirection, number);
  const double along = 1.0 - u * (1.0 - std::cos(law.spread));
  const double aside = std::sqrt(1.0 - along * along), turn = 2.0 * std::numbers::pi * v;
  const Vec3 axis = velocity / speed, side = axis.unitOrthogonal();
  Vec3 turned =
    speed * (along * axis + aside * (std::cos(turn) * side + std::sin(turn) * axis.cross(side)));
  const double into = normal.dot(turned);
  if (into < 0.0 && normal.dot(velocity) >= 0.0)
  {
    turned -= 2.0 * into * normal;
  }
  return turned;
}

} // namespace rockfall
