// Many rocks that meet fast: what an impact turns within its step must not come to touch unseen.

#include "form.h"
#include "law/settings.h"
#include "piles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

using namespace rockfall;
using namespace rockfall::testing;

TEST(FastIslands, RocksThatAnImpactTurnsStayOutOfEachOther)
{
  // Ten levels of cubes fall on a floor and on each other, in the end at 17 m/s, a tenth of an edge
  // in a step. Contacts that may close only if an impact turns the rocks are part of the step, too.
  constexpr double kVolume = 0.6;
  const double edge = std::cbrt(kVolume);
  double sum = 0.0;
  std::vector<std::pair<double, int>> heaps = { { 10.0, 3 }, { 30.0, 9 }, { 40.0, 7 } };
  constexpr int kAcross = 7;
  int levels = 10;
  if (isSmallForm())
  {
    heaps.resize(1);
    levels = 2;
  }
  for (const auto& [friction, seed] : heaps)
  {
    Pile pile;
    pile.ground = makeSlope(
      21, 5.0, [](double, double) { return 0.0; }, material(0.2, friction));
    pile.parameters.rockFrictionAngle = radians(friction);
    pile.parameters.rockRestitution = 0.2;
    pile.parameters.timeStep = 0.005;
    pile.rocks = levelsOfCubes(levels * kAcross * kAcross, kAcross, kVolume, seed);
    pile.start();
    double deepest = 0.0;
    while (pile.fall->time() < 1.8)
    {
      pile.fall->advance();
      deepest = std::max(deepest, pile.overlap());
    }
    EXPECT_LT(deepest, 0.01 * edge) << "friction " << friction << "°";
    sum += deepest;
  }
  EXPECT_LT(sum / double(heaps.size()), 0.007 * edge);
}

TEST(FastIslands, AGapThatTurnsShutCutsTheStep)
{
  // Two cubes that meet at 50 m/s, turning: the normal between two edges turns so far within the
  // step that its end finds the gap shut. The step adds no more overlap than any other one.
  for (const std::uint64_t seed : { 50659u, 51681u })
  {
    std::mt19937_64 random(seed);
    const auto even = [&] { return 2.0 * double(random() >> 11) * 0x1p-53 - 1.0; };
    Pile pile;
    pile.ground = makeSlope(
      21, 5.0, [](double, double) { return 0.0; }, material(0.2, 30.0));
    pile.parameters.rockFrictionAngle = radians(30.0);
    pile.parameters.rockRestitution = 0.5 + 0.5 * even();
    pile.parameters.timeStep = 0.005;
    const double speed = 10.0 * std::pow(3.0, even());
    pile.rocks.assign(2, {});
    for (int k = 0; k < 2; ++k)
    {
      Rock& rock = pile.rocks[std::size_t(k)];
      rock.blockId = k;
      rock.shape = makeShape(Shape::Cube, 1.0);
      const double w = even(), x = even(), y = even(), z = even();
      rock.orientation = Quat(w, x, y, z).normalized();
      const double side = even(), up = even();
      rock.position = Vec3(k == 0 ? 48.5 : 51.5, 50.0 + 0.5 * side, 50.0 + 0.5 * up);
      rock.velocity = Vec3(k == 0 ? speed : -speed, 0.0, 0.0);
      const double p = even(), q = even(), r = even();
      rock.angularVelocity = 10.0 * Vec3(p, q, r);
    }
    pile.start();
    double deepest = 0.0;
    while (pile.fall->time() < 4.0 / speed)
    {
      pile.fall->advance();
      deepest = std::max(deepest, pile.overlap());
    }
    EXPECT_LT(deepest, kDeepStep * pile.blocks[0].radius()) << seed;
  }
}
