// Elastic drops in any attitude, no friction: onto faces, ridges and peaks, nothing may be lost or
// made (METHOD 10.1, 10.4, 10.6).

#include "verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;
using rockfall::testing::makeSlope;

namespace
{

struct Ground
{
  const char* name;
  Terrain terrain;
  bool plane;
  Vec3 normal; ///< Of a plane.
};

std::vector<Ground> grounds()
{
  const SurfaceMaterial smooth = surface(1.0, 0.0);
  const auto slope = [&](auto z) { return makeSlope(25, 2.0, z, smooth); };
  return {
    { "horizontal plane", slope([](double, double) { return 0.0; }), true, Vec3::UnitZ() },
    { "plane of 17°", slope([](double x, double) { return -0.3 * (x - 24.0); }), true,
      Vec3(0.3, 0.0, 1.0).normalized() },
    { "ridge", slope([](double x, double) { return -0.5 * std::abs(x - 24.0); }), false,
      Vec3::UnitZ() },
    { "peak", slope([](double x, double y) { return -0.4 * std::hypot(x - 24.0, y - 24.0); }),
      false, Vec3::UnitZ() },
  };
}

} // namespace

class Attitudes : public ::testing::TestWithParam<int>
{
};

TEST_P(Attitudes, ElasticDropKeepsEnergyAndMomentum)
{
  const Ground ground = grounds()[std::size_t(GetParam())];
  const int attitudes = count(100, 1000);
  const double drop = 3.0; // m, of the centroid over the ground below
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (Shape shape : { Shape::Cube, Shape::Tetrahedron, Shape::Octahedron, Shape::Dodecahedron,
         Shape::Icosahedron, Shape::Eota221 })
  {
    std::vector<Rock> rocks;
    for (int k = 0; k < attitudes; ++k)
    {
      Rock rock;
      rock.shape = makeShape(shape, 1.0);
      rock.orientation = uniformAttitude(u(random), u(random), u(random));
      rock.angularVelocity = 3.0 * u(random) * uniformDirection(u(random), u(random));
      rock.velocity = 0.5 * uniformDirection(u(random), u(random));
      rock.position = Vec3(24.0 + u(random) - 0.5, 24.0 + u(random) - 0.5, drop);
      rock.youngModulus = 1e11;
      rocks.push_back(rock);
    }
    SimulationParameters p;
    p.endTime = 1.2;
    p.outputInterval = 0.01;
    const std::vector<Trajectory> runs = simulateAll(ground.terrain, rocks, p);
    int measured = 0, within = 0;
    double worst = 0.0, spin = 0.0, along = 0.0;
    double numerical = 0.0, vibration = 0.0, damping = 0.0, held = 0.0;
    std::int64_t unsettled = 0;
    for (int k = 0; k < attitudes; ++k)
    {
      const Trajectory& t = runs[k];
      unsettled += t.summary.unsettledSteps;
      const double fall = t.summary.mass * kGravity * drop;
      numerical = std::max(numerical, std::abs(t.summary.energy.numerical) / fall);
      vibration = std::max(vibration, std::abs(t.summary.energy.vibration) / fall);
      damping = std::max(damping, std::abs(t.summary.energy.damping) / fall);
      const Sample* end = lastInFlight(t);
      if (!end)
      {
        continue; // still in touch: nothing to measure
      }
      ++measured;
      held = std::max(held, end->energy.strain / fall);
      const Sample& start = t.samples.front();
      const double change =
        mechanicalEnergy(rocks[k], *end, kGravity) - mechanicalEnergy(rocks[k], start, kGravity);
      worst = std::max(worst, std::abs(change) / fall);
      within += std::abs(change) <= 0.01 * fall;
      if (ground.plane)
      {
        // A frictionless plane pushes along its normal only: the angular momentum about the normal
        // stays, and so does the momentum along the plane but for gravity's share.
        const Vec3 before = angularMomentum(rocks[k], start),
                   after = angularMomentum(rocks[k], *end);
        const double scale = std::max(before.norm(), after.norm());
        spin = std::max(spin, std::abs(ground.normal.dot(after - before)) / scale);
        const Vec3 gain =
          end->velocity - start.velocity + kGravity * (end->time - start.time) * Vec3::UnitZ();
        along = std::max(along, (gain - gain.dot(ground.normal) * ground.normal).norm());
      }
    }
    const std::string head =
      shapeName(shape) + ", " + ground.name + ", " + std::to_string(attitudes) + " attitudes: ";
    const std::string subject = "Elastic drop in any attitude";
    recordAtLeast({ subject, head + "share seen in flight after an impact", "",
                    "the others are in touch at 1.2 s: too many of them would make the rest void" },
      double(measured) / attitudes, 0.8);
    recordAtMost({ subject, head + "largest change of mechanical energy, share of the fall", "",
                   "elastic and frictionless: only the block's vibration may go" },
      worst, 0.01);
    report({ subject, head + "share of attitudes within 1 %", "", "" },
      double(within) / std::max(1, measured));
    recordAtMost({ subject, head + "largest numerical remainder of the energy audit", "",
                   "every joule is booked" },
      numerical, 0.005);
    recordAtMost(
      { subject, head + "largest share left in springs and strain in flight", "",
        "in flight nothing is compressed: a contact may only be let go when it is slack" },
      held, 1e-6);
    report({ subject, head + "largest share that went into vibration", "", "" }, vibration);
    report({ subject, head + "largest share that damped steps of lasting contact took", "", "" },
      damping);
    if (ground.plane)
    {
      recordAtMost({ subject, head + "largest change of angular momentum about the normal", "",
                     "no friction, no torque about the normal; relative to the momentum" },
        spin, 1e-6);
      recordAtMost({ subject, head + "largest change of velocity along the plane", "m/s",
                     "no friction; gravity's share taken out" },
        along, 1e-6);
    }
    EXPECT_EQ(unsettled, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Grounds, Attitudes, ::testing::Range(0, 4));
