// Flight between contacts: the parabola, and torque-free rotation (METHOD 10.3, 10.4).

#include "angularMomentum.h"
#include "verification.h"

#include "block/flight.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::angularMomentum;
using rockfall::testing::kGravity;

namespace
{

struct Body
{
  const char* name;
  Polyhedron shape;
};

std::vector<Body> bodies()
{
  return { { "cube", makeShape(Shape::Cube, 1.0) },
    { "plate 0.93 x 0.93 x 0.47", makeBox({ 0.93, 0.93, 0.47 }) },
    { "box 2.5 x 3 x 1", makeBox({ 2.5, 3.0, 1.0 }) },
    { "tetrahedron", makeShape(Shape::Tetrahedron, 1.0) } };
}

/// Volume of the vertices as the attitude places them: a quaternion that has lost its length shows.
double placedVolume(const Block& block, const Quat& attitude)
{
  const Mat3 turn = attitude.toRotationMatrix();
  double volume = 0.0;
  for (const std::vector<int>& face : block.shape().faces())
  {
    const Vec3 a = turn * block.shape().vertices()[face[0]];
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
    {
      const Vec3 b = turn * block.shape().vertices()[face[k]];
      const Vec3 c = turn * block.shape().vertices()[face[k + 1]];
      volume += a.dot(b.cross(c)) / 6.0;
    }
  }
  return volume;
}

} // namespace

TEST(Flight, CentroidIsOnTheParabola)
{
  const Terrain ground = flatGround(2000.0, surface(0.8, 15.0));
  for (const Body& body : bodies())
  {
    double worst = 0.0;
    for (double timeStep : { 0.001, 0.002, 0.005, 0.0075, 0.01 })
    {
      Rock rock;
      rock.shape = body.shape;
      rock.position = Vec3(900.0, 950.0, 450.0);
      rock.velocity = Vec3(12.0, 7.0, 25.0);
      rock.angularVelocity = Vec3(9.0, -4.0, 14.0);
      SimulationParameters p;
      p.timeStep = timeStep;
      p.endTime = 10.0;
      p.outputInterval = 0.05;
      const Trajectory t = rockfall::testing::simulate(ground, rock, p);
      ASSERT_NEAR(t.samples.back().time, 10.0, 1e-9);
      for (const Sample& s : t.samples)
      {
        const Vec3 way = s.time * rock.velocity - 0.5 * kGravity * s.time * s.time * Vec3::UnitZ();
        worst =
          std::max(worst, (s.position - rock.position - way).norm() / std::max(1.0, way.norm()));
      }
    }
    recordAtMost({ "Projectile with spin",
                   std::string(body.name) +
                     ", largest relative error of place over 10 s, Δt 0.001 "
                     "to 0.01 s",
                   "", "the parabola; only rounding may be left" },
      worst, 1e-9);
  }
}

TEST(Flight, FreeRotationKeepsWhatItMust)
{
  for (const Body& body : bodies())
  {
    const Block block(body.shape, 2500.0, 1e10, 0.1);
    BlockState state;
    state.orientation = uniformAttitude(0.3, 0.6, 0.1);
    state.spin = Vec3(3.0, 5.0, -4.0);
    const Vec3 momentum = angularMomentum(block, state);
    const double energy = rigidKineticEnergy(block, state);
    const double volume = placedVolume(block, state.orientation);
    // 1000 revolutions, in the uneven pieces in which a rock flies between samples and touches.
    const double revolution = 2.0 * std::numbers::pi / state.spin.norm();
    double momentumError = 0.0, energyError = 0.0, volumeError = 0.0;
    for (int piece = 0; piece < 20000; ++piece)
    {
      state = fly(block, state, 0.0, revolution / 20.0 * (0.5 + double(piece % 5) * 0.25));
      momentumError = std::max(
        momentumError, (angularMomentum(block, state) - momentum).norm() / momentum.norm());
      energyError =
        std::max(energyError, std::abs(rigidKineticEnergy(block, state) / energy - 1.0));
      volumeError =
        std::max(volumeError, std::abs(placedVolume(block, state.orientation) / volume - 1.0));
    }
    const std::string head = std::string(body.name) + ", 1000 revolutions in 20,000 pieces: ";
    recordAtMost({ "Torque-free rotation", head + "angular momentum, relative change", "",
                   "an invariant; 1e-8 is far below what any impact does" },
      momentumError, 1e-8);
    recordAtMost({ "Torque-free rotation", head + "energy, relative change", "", "an invariant" },
      energyError, 1e-8);
    recordAtMost({ "Torque-free rotation", head + "volume, relative change", "",
                   "METHOD 10.3: no false expansion" },
      volumeError, 1e-10);
  }
}

TEST(Flight, SymmetricTopFollowsItsClosedForm)
{
  // Two equal moments: the attitude turns by L t/I₁ about L and by (1 − I₃/I₁) ω₃ t about the axis.
  const Block block(makeBox({ 0.93, 0.93, 0.47 }), 2500.0, 1e10, 0.1);
  BlockState state;
  state.spin = Vec3(3.0, 5.0, -4.0);
  const BlockState start = state;
  const double across = block.inertia()(0, 0), along = block.inertia()(2, 2);
  const Vec3 momentum = angularMomentum(block, start);
  const double time = 1000.0 * 2.0 * std::numbers::pi / state.spin.norm();
  const int pieces = 5000;
  for (int k = 0; k < pieces; ++k)
  {
    state = fly(block, state, 0.0, time / pieces);
  }
  const Quat precession(Eigen::AngleAxisd(
    std::fmod(momentum.norm() * time / across, 2.0 * std::numbers::pi), momentum.normalized()));
  const double own = start.spin.z() * (1.0 - along / across) * time;
  const Quat exact =
    precession * Quat(Eigen::AngleAxisd(std::fmod(own, 2.0 * std::numbers::pi), Vec3::UnitZ()));
  recordAtMost({ "Torque-free rotation", "plate, 1000 revolutions: attitude beside the closed form",
                 "rad", "phase error of 6283 rad of turning; 1e-5 is 2e-9 of it" },
    exact.angularDistance(state.orientation), 1e-5);
}

TEST(Flight, IntermediateAxisFlipsOnTime)
{
  // Moments ∝ (10, 7.25, 15.25): x is the intermediate axis. Landau & Lifshitz, Mechanics, § 37.
  const Block block(makeBox({ 2.5, 3.0, 1.0 }), 2500.0, 1e10, 0.1);
  for (double aside : { 1e-3, 1e-2, 1e-1 })
  {
    BlockState state;
    state.spin = Vec3(2.0, 2.0 * aside, 2.0 * aside);
    const double i2 = block.inertia()(0, 0);
    double i1 = block.inertia()(1, 1), i3 = block.inertia()(2, 2);
    const double twice = 2.0 * rigidKineticEnergy(block, state);
    const double square = angularMomentum(block, state).squaredNorm();
    if (square < twice * i2)
    {
      std::swap(i1, i3);
    }
    const double k =
      std::sqrt(((i2 - i1) * (twice * i3 - square)) / ((i3 - i2) * (square - twice * i1)));
    const double rate = std::sqrt((i3 - i2) * (square - twice * i1) / (i1 * i2 * i3));
    const double expected = 4.0 * std::comp_ellint_1(k) / rate;

    // Zero crossings of the spin about the intermediate axis, each found by bisection.
    std::vector<double> crossings;
    std::vector<double> times, spins;
    const double piece = 0.01;
    while (crossings.size() < 11)
    {
      const BlockState next = fly(block, state, 0.0, piece);
      if (next.time < 4.0 * expected)
      {
        times.push_back(next.time);
        spins.push_back(next.spin.x());
      }
      if ((state.spin.x() > 0.0) != (next.spin.x() > 0.0))
      {
        double low = 0.0, high = piece;
        for (int halving = 0; halving < 40; ++halving)
        {
          const double middle = 0.5 * (low + high);
          const bool same =
            (fly(block, state, 0.0, middle).spin.x() > 0.0) == (state.spin.x() > 0.0);
          (same ? low : high) = middle;
        }
        crossings.push_back(state.time + low);
      }
      state = next;
      ASSERT_LT(state.time, 100.0 * expected) << "no flip";
    }
    const double period = (crossings.back() - crossings.front()) / 5.0;
    record({ "Torque-free rotation",
             "box 2.5 x 3 x 1, spin 2 rad/s about the intermediate axis and " + text(aside) +
               " of it about the others: period of two flips, mean of 5",
             "s", "4 K(k)/rate by Jacobi's elliptic functions; bar of 0.1 %" },
      period, expected, 1e-3 * expected);
    addCurve("flips", "aside " + text(aside), times, spins);
  }
}
