// Rocks on the rim of a nodata hole, whose corners slip past it or come under it from the side.

#include "rock/placement.h"
#include "slopes.h"
#include "terrain/Surface.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

TEST(Rims, ContactsThatRunOffLoseNoEnergy)
{
  // A corner beyond the rim was no contact any more, and took its spring with it; one that was
  // straight under the slope, but beyond the rim seen square, was found and lost in every step: up
  // to 0.6 m g r in a hundredth of a second, of 1 rock in 17.
  const Terrain terrain = makeSlope(
    31, 1.0,
    [](double x, double y)
    {
      const bool hole = x > 11.5 && x < 18.5 && y > 11.5 && y < 18.5;
      return hole ? std::numeric_limits<double>::quiet_NaN() : 50.0 - 0.2 * x;
    },
    material(0.3, 30.0));
  const Surface surface = Surface::asSurveyed(terrain);
  constexpr std::array shapes = { Shape::Cube, Shape::Icosahedron, Shape::Octahedron };
  SimulationParameters p;
  p.endTime = 3.0;
  p.outputInterval = 0.01;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int fell = 0, released = 0;
  for (int k = 0; k < 300; ++k)
  {
    Rock rock;
    rock.shape = makeShape(shapes[std::size_t(k) % 3], std::pow(4.0, u(random)));
    rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    const double along = 15.0 + 5.0 * u(random);
    const double across = (k % 2 ? 11.0 : 19.0) + 0.6 * u(random);
    const double x = k % 4 < 2 ? across : along, y = k % 4 < 2 ? along : across;
    if (terrain.cfeAt(x, y) == 0)
    {
      continue;
    }
    rock.position = Vec3(x, y, touchingHeight(surface, rock.shape, rock.orientation, x, y) + 1e-3);
    const Trajectory run = simulate(terrain, rock, p);
    const double unit = run.summary.mass * p.gravity * rock.shape.radius();
    double before = 0.0;
    for (const Sample& sample : run.samples)
    {
      // What overlaps is pressed out at 5 mm/s, which gives energy: 5e-5 m g within 0.01 s.
      EXPECT_NEAR(sample.energy.numerical, before, 0.005 * unit)
        << k << ", " << sample.time << " s";
      before = sample.energy.numerical;
    }
    EXPECT_LT(run.summary.energy.numerical, 0.005 * unit) << k;
    ++released;
    fell += run.summary.fate == Fate::LostInNodata;
  }
  EXPECT_GT(released, 150);
  EXPECT_GT(fell, 10);
}
