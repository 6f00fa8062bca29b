// Crowds that meet fast: what an impact turns within its step must not come to touch unseen.

#include "piles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace rockfall;
using namespace rockfall::testing;

TEST(FastCrowds, RocksThatAnImpactTurnsStayOutOfEachOther)
{
  // A thousand cubes fall on a floor and on each other, in the end at 17 m/s, a tenth of an edge in
  // a step. Contacts that may close only if an impact turns the rocks are part of the step, too:
  // left to be found where the rocks end, the deepest overlap of a run was 1.1 % of an edge on
  // average, and more than 1 % in nine of sixteen; so it is 0.6 %, and 0.75 % at most.
  constexpr int kAcross = 10, kLevels = 10;
  const double edge = std::cbrt(0.6), spacing = 1.75 * edge; // room to be turned in
  const Polyhedron cube = makeShape(Shape::Cube, 0.6);
  double sum = 0.0;
  const std::vector<double> frictions = { 10.0, 20.0, 30.0 };
  for (const double friction : frictions)
  {
    Pile pile;
    pile.ground = makeSlope(
      21, 5.0, [](double, double) { return 0.0; }, material(0.2, friction));
    pile.parameters.rockFrictionAngle = radians(friction);
    pile.parameters.rockRestitution = 0.2;
    pile.parameters.timeStep = 0.005;
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    Vec3 shift = Vec3::Zero();
    for (int k = 0; k < kAcross * kAcross * kLevels; ++k)
    {
      const int place = k % (kAcross * kAcross), level = k / (kAcross * kAcross);
      // No level stands over the other one.
      shift = place == 0 ? Vec3(edge * u(random), edge * u(random), 0.0) : shift;
      Rock rock;
      rock.blockId = k;
      rock.shape = cube;
      rock.position = shift +
        Vec3(50.0 + spacing * (place % kAcross - 4.5), 50.0 + spacing * (place / kAcross - 4.5),
          edge + spacing * level);
      rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
      pile.rocks.push_back(rock);
    }
    pile.start();
    double deepest = 0.0;
    for (int step = 0; pile.fall->time() < 1.8; ++step)
    {
      pile.fall->advance();
      deepest = std::max(deepest, step % 2 == 0 ? pile.overlap() : 0.0);
    }
    EXPECT_LT(deepest, 0.012 * edge) << "friction " << friction << "°";
    sum += deepest;
  }
  EXPECT_LT(sum / double(frictions.size()), 0.008 * edge);
}
