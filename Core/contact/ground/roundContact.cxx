#include "contact/ground/roundContact.h"

#include "contact/ground/contactTransfer.h"
#include "contact/ground/features.h"
#include "contact/ground/motion.h"
#include "geometry/roundBody.h"
#include "law/settings.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

namespace rockfall
{

namespace
{

/// Distances that differ by rounding only, share.
constexpr double kSameRound = 1e-9;

/// Of a triangle nearest to the origin.
struct Nearest
{
  Vec3 place;
  int first = -1, last = -1; ///< Corners of its edge, twice its node; −1: on the face.
};

Nearest nearestTo(const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Vec3 ab = b - a, ac = c - a;
  const double abA = -ab.dot(a), acA = -ac.dot(a);
  if (abA <= 0.0 && acA <= 0.0)
  {
    return { a, 0, 0 };
  }
  const double abB = -ab.dot(b), acB = -ac.dot(b);
  if (abB >= 0.0 && acB <= abB)
  {
    return { b, 1, 1 };
  }
  const double abC = -ab.dot(c), acC = -ac.dot(c);
  if (acC >= 0.0 && abC <= acC)
  {
    return { c, 2, 2 };
  }
  const double overC = abA * acB - abB * acA;
  if (overC <= 0.0 && abA >= 0.0 && abB <= 0.0)
  {
    return { a + abA / (abA - abB) * ab, 0, 1 };
  }
  const double overB = abC * acA - abA * acC;
  if (overB <= 0.0 && acA >= 0.0 && acC <= 0.0)
  {
    return { a + acA / (acA - acC) * ac, 2, 0 };
  }
  const double overA = abB * acC - abC * acB;
  if (overA <= 0.0 && acB - abB >= 0.0 && abC - acC >= 0.0)
  {
    return { b + (acB - abB) / ((acB - abB) + (abC - acC)) * (c - b), 1, 2 };
  }
  const double scale = 1.0 / (overA + overB + overC);
  return { a + overB * scale * ab + overC * scale * ac };
}

/// Where a round body and a triangle touch, or would.
struct Touch
{
  int triangle = -1;
  Nearest at;          ///< In the axes of the unit sphere.
  double rho = 0.0;    ///< Of the nearest place, there.
  double distance = 0; ///< m
  Vec3 normal;         ///< Towards the body, world.
  Vec3 point;          ///< Of the body, world.
};

class Round
{
public:
  Round(const SurfacePatch& patch, const Vec3& centre, const Mat3& axes)
    : patch_(patch)
    , centre_(centre)
    , axes_(axes)
    , inverse_(axes_.inverse())
  {
  }
  Round(const PlacedBlock& rock, const SurfacePatch& patch)
    : Round(patch, rock.position(), roundAxes(rock))
  {
  }

  Touch touch(int triangle) const
  {
    return this->touchAt(triangle,
      nearestTo(this->seen(triangle, 0), this->seen(triangle, 1), this->seen(triangle, 2)));
  }

  /// The touch on the same face, on the line of the same edge, or at the same node.
  Touch touchOn(const Touch& other) const
  {
    Nearest at = other.at;
    if (at.first >= 0)
    {
      at.place = this->seen(other.triangle, at.first);
      const Vec3 along = this->seen(other.triangle, at.last) - at.place;
      at.place -= along * (along.dot(at.place) / std::max(along.squaredNorm(), 1e-300));
    }
    return this->touchAt(other.triangle, at);
  }

  /// Whether the body is on the outer side of the triangle there, or has slipped under the slope through
  /// it. Beside a narrow ridge it is on the inner side of the far flank, and never came in there.
  bool isOutside(const Touch& touch) const
  {
    const SurfacePatch::Triangle& t = patch_.triangles[std::size_t(touch.triangle)];
    if (touch.at.first >= 0)
    {
      return touch.normal.dot(t.normal) > 0.0;
    }
    return t.normal.dot(centre_) > t.offset ||
      (touch.triangle < patch_.slopeTriangles && this->isUnderSlope());
  }

  /// Whether a triangle has the edge or the node of another one's touch.
  bool shares(int triangle, const Touch& touch) const
  {
    const auto& own = patch_.triangles[std::size_t(triangle)].nodes;
    const auto& nodes = patch_.triangles[std::size_t(touch.triangle)].nodes;
    const auto has = [&](int node) { return own[0] == node || own[1] == node || own[2] == node; };
    return has(nodes[std::size_t(touch.at.first)]) && has(nodes[std::size_t(touch.at.last)]);
  }

private:
  /// Whether the centre is straight under a triangle of the slope.
  bool isUnderSlope() const
  {
    if (!under_)
    {
      const auto end = patch_.triangles.begin() + patch_.slopeTriangles;
      under_ = std::any_of(patch_.triangles.begin(), end,
        [this](const SurfacePatch::Triangle& t)
        { return t.normal.dot(centre_) < t.offset && isStraightOver(patch_, t, centre_); });
    }
    return *under_;
  }

  /// Corner of a triangle, in the axes of the unit sphere.
  Vec3 seen(int triangle, int corner) const
  {
    const SurfacePatch::Triangle& t = patch_.triangles[std::size_t(triangle)];
    return inverse_ * (patch_.nodes[std::size_t(t.nodes[corner])].position - centre_);
  }

  Touch touchAt(int triangle, const Nearest& at) const
  {
    const SurfacePatch::Triangle& t = patch_.triangles[std::size_t(triangle)];
    Touch touch;
    touch.triangle = triangle;
    touch.at = at;
    touch.rho = touch.at.place.norm();
    if (touch.at.first < 0)
    {
      // A plane has a normal, wherever the centre is.
      const double height = t.normal.dot(centre_) - t.offset;
      const double reach = roundReach(axes_, t.normal);
      touch.normal = t.normal;
      touch.distance = height - reach;
      touch.point = centre_ - axes_ * (axes_.transpose() * t.normal) / reach;
      return touch;
    }
    const Vec3 out = -(inverse_.transpose() * touch.at.place);
    const double size = std::max(out.norm(), std::numeric_limits<double>::min());
    touch.normal = out / size;
    touch.distance = touch.rho * (touch.rho - 1.0) / size;
    touch.point = centre_ + axes_ * (touch.at.place / std::max(touch.rho, 1e-300));
    return touch;
  }

  const SurfacePatch& patch_;
  Vec3 centre_;
  Mat3 axes_, inverse_;
  mutable std::optional<bool> under_; ///< isUnderSlope, once it has been asked for.
};

/// visit(touch) of those within a reach (m) that no triangle which shares the place has nearer.
template <class Numbers, class Visit>
void visitTouches(const Round& round, const Numbers& triangles, double reach, const Visit& visit)
{
  thread_local std::vector<Touch> touches;
  touches.clear();
  for (const int triangle : triangles)
  {
    const Touch touch = round.touch(triangle);
    if (touch.distance <= reach && round.isOutside(touch))
    {
      touches.push_back(touch);
    }
  }
  for (const Touch& touch : touches)
  {
    const bool hidden = touch.at.first >= 0 &&
      std::any_of(touches.begin(), touches.end(),
        [&](const Touch& other)
        {
          // Of two at one place the first one counts.
          const double same = kSameRound * touch.rho;
          return other.triangle != touch.triangle && round.shares(other.triangle, touch) &&
            (other.rho < touch.rho - same ||
              (other.rho <= touch.rho + same &&
                (other.at.first < 0 || other.triangle < touch.triangle)));
        });
    if (!hidden)
    {
      visit(touch);
    }
  }
}

/// Largest speed of the rim that brings it nearer, m/s: a sphere does not come nearer by turning.
double rimSpeed(const PlacedBlock& rock, const BlockState& state)
{
  return rock.block().isotropic() ? 0.0 : rock.block().largestRimSpeed(state.spin);
}

/// Lower bound of the time until a touch closes, s.
double closingTime(const Touch& touch, const BlockState& state, double rim, double gravity)
{
  return timeToCover(touch.distance, rim - touch.normal.dot(state.velocity),
    gravity * std::max(0.0, touch.normal.z()));
}

std::vector<int>& workNumbers()
{
  thread_local std::vector<int> numbers;
  return numbers;
}

const std::vector<int>& numbersOf(const CandidatePairs& candidates)
{
  std::vector<int>& numbers = workNumbers();
  numbers.clear();
  for (const CandidatePairs::Pair& pair : candidates.vertexFace)
  {
    numbers.push_back(pair.patch);
  }
  return numbers;
}

/// Gives each touch the contact that goes over to it, −1: none. It is the one with the nearest normal,
/// as that turns no faster than the body rolls; the nearest pair of all first, or a place that is new
/// takes what its neighbour carries.
void pairByNormal(
  const std::vector<Touch>& touches, const std::vector<Contact>& carry, std::vector<int>& taken)
{
  taken.assign(touches.size(), -1);
  const auto isLeft = [&](std::size_t contact)
  { return std::find(taken.begin(), taken.end(), int(contact)) == taken.end(); };
  for (;;)
  {
    double nearest = kSmoothTurn;
    std::size_t touch = touches.size(), contact = 0;
    for (std::size_t i = 0; i < touches.size(); ++i)
    {
      for (std::size_t k = 0; taken[i] < 0 && k < carry.size(); ++k)
      {
        const double turn = touches[i].normal.dot(carry[k].normal);
        if (turn > nearest && isLeft(k))
        {
          nearest = turn;
          touch = i;
          contact = k;
        }
      }
    }
    if (touch == touches.size())
    {
      return;
    }
    taken[touch] = int(contact);
  }
}

/// One spring with the energy of both, where two places have become one.
void mergeLeft(
  const std::vector<Touch>& touches, const std::vector<int>& taken, std::vector<Contact>& carry)
{
  for (std::size_t k = 0; k < carry.size(); ++k)
  {
    if (std::find(taken.begin(), taken.end(), int(k)) != taken.end())
    {
      continue;
    }
    const Contact& left = carry[k];
    double nearest = kSmoothTurn;
    int next = -1;
    for (std::size_t i = 0; i < touches.size(); ++i)
    {
      const double turn = touches[i].normal.dot(left.normal);
      if (taken[i] >= 0 && turn > nearest)
      {
        nearest = turn;
        next = taken[i];
      }
    }
    if (next >= 0)
    {
      joinSprings(carry[std::size_t(next)], left);
    }
  }
}

void turnTo(Contact& contact, const Vec3& normal, const Vec3& point)
{
  contact.normal = normal;
  contact.point = point;
  contact.slip -= normal.dot(contact.slip) * normal;
}

} // namespace

void gatherRound(
  const PlacedBlock& rock, const SurfacePatch& patch, double distance, CandidatePairs& candidates)
{
  const Round round(rock, patch);
  const Vec3 lower = rock.lower().array() - distance, upper = rock.upper().array() + distance;
  for (int i = 0; i < int(patch.triangles.size()); ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[std::size_t(i)];
    const auto corner = [&](int k) -> const Vec3&
    { return patch.nodes[std::size_t(t.nodes[k])].position; };
    // No bound below: what has slipped under the slope must be found.
    if (t.cfe == 0 ||
      (corner(0).cwiseMax(corner(1)).cwiseMax(corner(2)).array() < lower.array()).any() ||
      (corner(0).cwiseMin(corner(1)).cwiseMin(corner(2)).head<2>().array() >
        upper.head<2>().array())
        .any())
    {
      continue;
    }
    if (round.touch(i).distance <= distance)
    {
      candidates.vertexFace.push_back({ -1, i });
    }
  }
}

void updateRound(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double reach, std::vector<Contact>& contacts)
{
  thread_local std::vector<Contact> carry;
  carry.clear();
  std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(carry),
    [](const Contact& c) { return c.closed(); });
  thread_local std::vector<Touch> touches;
  touches.clear();
  visitTouches(Round(rock, patch), numbersOf(candidates), reach,
    [&](const Touch& touch) { touches.push_back(touch); });
  thread_local std::vector<int> taken;
  pairByNormal(touches, carry, taken);
  mergeLeft(touches, taken, carry);
  contacts.clear();
  for (std::size_t i = 0; i < touches.size(); ++i)
  {
    const Touch& touch = touches[i];
    const SurfacePatch::Triangle& t = patch.triangles[std::size_t(touch.triangle)];
    const bool goesOn = taken[i] >= 0;
    Contact& c = contacts.emplace_back(goesOn ? carry[std::size_t(taken[i])] : Contact{});
    const double gap = c.gap();
    c.kind = ContactKind::VertexFace;
    c.rockFeature = -1;
    c.patchFeature = touch.triangle;
    c.surfaceFeature = t.key;
    c.cfe = t.cfe;
    turnTo(c, touch.normal, touch.point);
    c.distance = touch.distance;
    // The step has conserved energy with the gap that it predicted. On an edge or a node the body
    // turns away from the plane of the step; a spring that gave way there would lose what it holds.
    c.offset = goesOn ? c.distance - gap : std::min(0.0, c.distance);
  }
}

void turnToMiddle(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double h, std::vector<Contact>& contacts)
{
  if (contacts.empty())
  {
    return;
  }
  const Vec3 spin = state.angularVelocity();
  const double turn = 0.5 * h * spin.norm();
  const Mat3 axes = roundAxes(rock);
  const Mat3 turned = turn > 0.0
    ? Mat3(Eigen::AngleAxisd(turn, spin.normalized()).toRotationMatrix())
    : Mat3(Mat3::Identity());
  const Vec3 centre = rock.position() + 0.5 * h * state.velocity;
  const Round now(patch, rock.position(), axes), middle(patch, centre, turned * axes);
  for (Contact& c : contacts)
  {
    const Touch touch = middle.touchOn(now.touch(c.patchFeature));
    turnTo(c, touch.normal, rock.position() + (touch.point - centre));
  }
}

double roundTimeToClose(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  const CandidatePairs& candidates, double gravity, double horizon)
{
  const Round round(rock, patch);
  const double rim = rimSpeed(rock, state);
  double time = horizon;
  for (const int triangle : numbersOf(candidates))
  {
    const Touch touch = round.touch(triangle);
    if (round.isOutside(touch))
    {
      time = std::min(time, closingTime(touch, state, rim, gravity));
    }
  }
  return time;
}

Clearance roundClearance(const PlacedBlock& rock, const BlockState& state,
  const SurfacePatch& patch, double gravity, double horizon, bool ofScar)
{
  const Round round(rock, patch);
  const double rim = rimSpeed(rock, state);
  Clearance result;
  result.distance = std::numeric_limits<double>::infinity();
  result.time = horizon;
  for (int i = 0; i < int(patch.triangles.size()); ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[std::size_t(i)];
    if (t.cfe == 0 || (ofScar && t.firm))
    {
      continue;
    }
    const Touch touch = round.touch(i);
    if (round.isOutside(touch))
    {
      result.distance = std::min(result.distance, touch.distance);
      result.time = std::min(result.time, closingTime(touch, state, rim, gravity));
    }
  }
  return result;
}

double roundPenetration(const PlacedBlock& rock, const SurfacePatch& patch)
{
  std::vector<int>& numbers = workNumbers();
  numbers.clear();
  for (int i = 0; i < patch.slopeTriangles; ++i)
  {
    if (patch.triangles[std::size_t(i)].cfe != 0)
    {
      numbers.push_back(i);
    }
  }
  double deepest = 0.0;
  visitTouches(Round(rock, patch), numbers, 0.0,
    [&](const Touch& touch) { deepest = std::max(deepest, -touch.distance); });
  return deepest;
}

namespace
{

/// Smaller root of |w + t u|² = 1 with what is across a direction left; ∞ if there is none.
double firstOn(const Vec3& w, const Vec3& u)
{
  const double a = u.squaredNorm(), b = w.dot(u), c = w.squaredNorm() - 1.0;
  const double root = b * b - a * c;
  return root >= 0.0 && a > 0.0 ? (-b - std::sqrt(root)) / a
                                : std::numeric_limits<double>::infinity();
}

} // namespace

double roundDrop(const Mat3& axes, const Vec3& centre, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Mat3 inverse = axes.inverse();
  const std::array<Vec3, 3> v = { inverse * (a - centre), inverse * (b - centre),
    inverse * (c - centre) };
  const Vec3 up = inverse.col(2); // the triangle comes up towards the unit sphere
  double drop = std::numeric_limits<double>::infinity();
  Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]);
  n *= (n.dot(up) < 0.0 ? -1.0 : 1.0) / std::max(n.norm(), 1e-300);
  if (const double rise = n.dot(up); rise > 1e-12 * up.norm())
  {
    const double t = (-1.0 - n.dot(v[0])) / rise;
    const Nearest at = nearestTo(v[0] + t * up, v[1] + t * up, v[2] + t * up);
    if (at.first < 0)
    {
      return t;
    }
  }
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Vec3 edge = v[(k + 1) % 3] - v[k];
    const double length = edge.squaredNorm();
    const auto across = [&](const Vec3& x) -> Vec3 { return x - edge.dot(x) / length * edge; };
    const double t = firstOn(across(v[k]), across(up));
    const double along = std::isfinite(t) ? -edge.dot(v[k] + t * up) / length : -1.0;
    drop = along >= 0.0 && along <= 1.0 ? std::min(drop, t) : drop;
    drop = std::min(drop, firstOn(v[k], up));
  }
  return drop;
}

} // namespace rockfall
