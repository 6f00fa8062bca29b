/// Height of a rock over the ground, and what is sure of its flight, against all faces over all CFEs.

#include "block/flight.h"
#include "contact/ground/candidates.h"
#include "contact/ground/heightOver.h"
#include "contact/ground/motion.h"
#include "contact/ground/timeToTouch.h"
#include "form.h"
#include "slopes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <vector>

namespace rockfall::testing
{

namespace
{

constexpr Shape kShapes4[] = { Shape::Cube, Shape::Tetrahedron, Shape::Icosahedron,
  Shape::Eota221 };
constexpr double kGround = 16.0; // m

/// Twice the area of the triangle of a → b and p in plan, m²: > 0 on the left.
double leftOf(const Vec3& a, const Vec3& b, const Vec3& p)
{
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

/// The part of a polygon that is on the left of a → b in plan.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& a, const Vec3& b)
{
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double u = leftOf(a, b, p), v = leftOf(a, b, q);
    if (u >= 0.0)
    {
      kept.push_back(p);
    }
    if ((u < 0.0) != (v < 0.0))
    {
      kept.push_back(p + u / (u - v) * (q - p));
    }
  }
  return kept;
}

/// The least height of faces that look down over CFEs: at a corner of what the two share in plan, m.
double leastHeight(const PlacedBlock& rock, const HeightWindow& window)
{
  double least = std::numeric_limits<double>::infinity();
  const auto& faces = rock.block().shape().faces();
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    if (!(rock.normal(int(f)).z() < 0.0))
    {
      continue;
    }
    std::vector<Vec3> polygon;
    for (const int v : faces[f])
    {
      polygon.push_back(rock.vertices()[std::size_t(v)]);
    }
    for (int row = 0; row + 1 < window.rows(); ++row)
    {
      for (int column = 0; column + 1 < window.columns(); ++column)
      {
        const auto node = [&](int r, int c)
        { return Vec3(window.x(column + c), window.y(row + r), window.z(row + r, column + c)); };
        const Vec3 nw = node(0, 0), ne = node(0, 1), sw = node(1, 0), se = node(1, 1);
        if (nw.x() > rock.upper().x() || ne.x() < rock.lower().x() || sw.y() > rock.upper().y() ||
          nw.y() < rock.lower().y())
        {
          continue;
        }
        const bool rising = std::abs(ne.z() - sw.z()) < std::abs(se.z() - nw.z());
        for (const auto& [a, b, c] :
          { std::array{ nw, sw, rising ? ne : se }, std::array{ rising ? sw : nw, se, ne } })
        {
          for (const Vec3& p : clipped(clipped(clipped(polygon, a, b), b, c), c, a))
          {
            const double all = leftOf(a, b, c);
            const double ground =
              (leftOf(b, c, p) * a.z() + leftOf(c, a, p) * b.z() + leftOf(a, b, p) * c.z()) / all;
            least = std::min(least, p.z() - ground);
          }
        }
      }
    }
  }
  return least;
}

/// A slope of 35° with nodes up to `rough` (m) off it; or level ground with some nodes so high.
Terrain roughSlope(std::mt19937_64& random, double rough, bool stones = false)
{
  std::uniform_real_distribution<double> off(-rough, rough), share(0.0, 1.0);
  return makeSlope(int(kGround) + 1, 1.0,
    [&](double x, double y)
    { return stones ? (share(random) < 0.2 ? rough : 0.0) : 0.7 * x - 0.1 * y + off(random); });
}

/// A rock somewhere over the middle of the slope, its lowest point `height` (m) over the ground.
class Flying
{
public:
  Flying(const Terrain& terrain, Shape shape, double volume, double height, std::mt19937_64& random)
    : surface_(Surface::asSurveyed(terrain))
    , block(makeShape(shape, volume), 2700.0, 5e10, 0.2)
  {
    window.gather(surface_, 0.1, kGround - 0.1, 0.1, kGround - 0.1);
    std::uniform_real_distribution<double> in(-1.0, 1.0);
    const auto any = [&] { return Vec3(in(random), in(random), in(random)); };
    state.position = Vec3(8.0 + in(random), 8.0 + in(random), 20.0);
    const Vec3 axis = any(), turn = any();
    state.orientation = Quat(Eigen::AngleAxisd(3.0 * turn.x(), axis.normalized()));
    state.velocity = 8.0 * any() - 6.0 * Vec3::UnitZ();
    state.spin = 10.0 * turn;
    this->raise(height);
  }
  /// Turned as the grid is: a cube of 2 m has its vertices over nodes, and nodes under its edges.
  void alignToGrid()
  {
    state.orientation = Quat::Identity();
    state.position.head<2>() = Eigen::Vector2d(8.0, 8.0);
    this->raise(0.1);
  }
  void raise(double height)
  {
    rock.place(block, state);
    state.position.z() += height - leastHeight(rock, window);
    rock.place(block, state);
  }

private:
  Surface surface_;

public:
  Block block;
  BlockState state;
  HeightWindow window;
  PlacedBlock rock;
};

} // namespace

TEST(TimeToTouch, HeightIsTheLeastOfAllFacesOverAllCfes)
{
  std::mt19937_64 random(4);
  for (int k = 0; k < someOf(400, 40); ++k)
  {
    const Terrain terrain = roughSlope(random, k % 5 == 0 ? 0.0 : 0.5);
    Flying flying(terrain, kShapes4[k % 4], k % 8 < 4 ? 1.0 : 8.0, 0.3, random);
    if (k % 3 == 0)
    {
      flying.alignToGrid();
    }
    const double height = leastHeight(flying.rock, flying.window);
    EXPECT_NEAR(heightOver(flying.rock, flying.window, -1.0), height, 1e-9) << k;
    EXPECT_LE(heightOver(flying.rock, flying.window, 0.5), 0.5) << k;
    const FlightLook look =
      lookAhead(flying.rock, flying.state, flying.window, Vec3::Zero(), kGravity, 1.0);
    EXPECT_NEAR(look.gap, height, 1e-9) << k;
    const Vec3 lowest = flying.state.position + flying.rock.map() * look.lowest;
    EXPECT_NEAR(lowest.z() - flying.window.elevation(lowest.x(), lowest.y()), height, 1e-9) << k;
  }
}

TEST(TimeToTouch, NoRockTouchesBeforeItIsSaid)
{
  std::mt19937_64 random(9);
  int touched = 0;
  for (int k = 0; k < someOf(400, 20); ++k)
  {
    const bool skims = k % 3 == 1;
    const Terrain terrain = roughSlope(random, skims ? 0.8 : 0.05 * (1 + k % 10), skims);
    Flying flying(terrain, kShapes4[k % 4], 0.5, skims ? 0.005 : 0.02 * (1 + k % 15), random);
    if (skims)
    {
      flying.state.velocity *= 3.0;
      flying.state.velocity.z() = 0.5;
      flying.state.spin *= 0.1;
    }
    else if (k % 3 == 2)
    {
      flying.state.velocity.setZero();
      flying.state.spin *= 4.0;
    }
    // As a flight goes on: the place that was lowest is known of the look before.
    Vec3 lowest = Vec3::Zero();
    BlockState state = flying.state;
    for (int look = 0; look < 40; ++look)
    {
      flying.rock.place(flying.block, state);
      const FlightLook ahead = lookAhead(flying.rock, state, flying.window, lowest, kGravity, 0.15);
      const double touch = timeToTouch(flying.rock, state, flying.window, kGravity, 0.15);
      const double plane = timeToPlane(flying.rock, state, flying.window, kGravity, 0.15);
      const double sure = std::max({ ahead.free, touch, plane });
      if (ahead.gap < 1e-4 || state.time > 0.15)
      {
        touched += ahead.gap < 1e-4;
        break;
      }
      ASSERT_GT(ahead.free, 0.0) << k;
      for (int i = 1; i <= 16; ++i)
      {
        flying.rock.place(flying.block, fly(flying.block, state, kGravity, sure * i / 16.0));
        ASSERT_GT(leastHeight(flying.rock, flying.window), -1e-9) << k << ", " << look << ", " << i;
      }
      state = fly(flying.block, state, kGravity, sure);
      lowest = ahead.lowest;
    }
  }
  EXPECT_GT(touched, someOf(400, 20) / 4);
}

// Pairs of features next to the rock: from look to look, as it slides and hops over the ground.
TEST(TimeToTouch, NoPairClosesBeforeItIsSaid)
{
  std::mt19937_64 random(13);
  int looks = 0;
  for (int k = 0; k < someOf(400, 40); ++k)
  {
    const Terrain terrain = roughSlope(random, 0.05 * (1 + k % 10), k % 3 == 1);
    const double height = std::array{ 1e-6, 1e-4, 0.01 }[std::size_t(k / 3 % 3)];
    Flying flying(terrain, kShapes4[k % 4], 0.5, height, random);
    if (k % 5 == 0) // edges along ridges, or nearly
    {
      flying.state.orientation = Quat(Eigen::AngleAxisd(0.002 * k, Vec3(0.6, 0.0, 0.8)));
      flying.raise(height);
    }
    if (k % 3 == 1) // along the ground
    {
      flying.state.velocity.z() = 0.0;
      flying.state.spin *= 0.01;
    }
    else if (k % 3 == 2) // turns on the spot
    {
      flying.state.velocity.setZero();
    }
    const double r = flying.block.radius(), reach = 0.1;
    SurfacePatch patch;
    gatherPatch(Surface::asSurveyed(terrain), 4.0, 12.0, 4.0, 12.0, patch);
    CandidatePairs candidates;
    gatherCandidates(flying.rock, flying.state, patch, reach, candidates);
    BlockState state = flying.state;
    for (int look = 0; look < 20; ++look)
    {
      flying.rock.place(flying.block, state);
      const double room = candidates.room(state, r, 0.0);
      if (room < 0.01 * reach || leastHeight(flying.rock, flying.window) < 1e-7)
      {
        break;
      }
      const double fastest = state.velocity.norm() + flying.block.largestRimSpeed(state.spin);
      const double free = timeToClose(
        flying.rock, state, patch, candidates, kGravity, timeToCover(room, fastest, kGravity));
      ASSERT_GT(free, 0.0) << k << ", " << look;
      ++looks;
      for (int i = 1; i <= 16; ++i)
      {
        flying.rock.place(flying.block, fly(flying.block, state, kGravity, free * i / 16.0));
        ASSERT_GT(leastHeight(flying.rock, flying.window), -1e-9) << k << ", " << look << ", " << i;
      }
      state = fly(flying.block, state, kGravity, free);
    }
  }
  EXPECT_GT(looks, someOf(400, 40));
}

// A beam that lies across a ridge, both level: whatever rounding has made of its distance, it may
// close at once, unless it is surely apart.
TEST(TimeToTouch, AnEdgeThatLiesOnARidgeIsNotFree)
{
  const Terrain roof =
    makeSlope(17, 1.0, [](double x, double) { return 10.0 - 0.5 * std::abs(x - 8.0); });
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(roof), 4.0, 12.0, 4.0, 12.0, patch);
  const Block beam(makeBox(Vec3(3.0, 0.3, 0.3)), 2700.0, 5e10, 0.2);
  for (const double distance : { 1e-3, 0.0, -1e-15, -1e-12, -1e-6, -1e-4, -1e-3 })
  {
    for (const double fall : { -5.0, -0.05, 0.05 }) // m/s
    {
      BlockState state;
      state.orientation = Quat(Eigen::AngleAxisd(radians(45.0), Vec3::UnitX()));
      state.position = Vec3(8.03, 8.5, 10.0 + 0.15 * std::sqrt(2.0) + distance);
      state.velocity.z() = fall;
      PlacedBlock rock;
      rock.place(beam, state);
      CandidatePairs candidates;
      gatherCandidates(rock, state, patch, 0.1, candidates);
      const double free = timeToClose(rock, state, patch, candidates, kGravity, 0.02);
      const double sure = distance > 0.0 ? timeToCover(distance, -fall, kGravity) : 0.0;
      EXPECT_NEAR(free, std::min(0.02, sure), 1e-9) << distance << ", " << fall;
    }
  }
}

} // namespace rockfall::testing
