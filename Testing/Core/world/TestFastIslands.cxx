// Many rocks that meet fast: what an impact turns within its step must not come to touch unseen.

#include "form.h"
#include "piles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
