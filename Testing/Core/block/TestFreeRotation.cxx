// Torque-free rotation in closed form (METHOD 10.4), against an integration that knows nothing of
// it.

#include "angularMomentum.h"
#include "block/FreeRotation.h"
#include "block/flight.h"
#include "form.h"
#include "geometry/shapes.h"

#include <boost/numeric/odeint.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace rockfall;
using rockfall::testing::angularMomentum;

namespace
{

struct Body
{
  const char* name;
  Block block;
};

Block blockOf(const Polyhedron& shape)
{
  return Block(shape, 2500.0, 1e10, 0.1);
}

/// From equal moments to three different ones, flat, round and long.
const std::vector<Body>& bodies()
{
  const Quat tilt(Eigen::AngleAxisd(0.8, Vec3(1.0, -2.0, 0.5).normalized()));
  static const std::vector<Body> all = {
    { "cube", blockOf(makeShape(Shape::Cube, 1.0)) },
    { "tetrahedron", blockOf(makeShape(Shape::Tetrahedron, 1.0)) },
    { "plate", blockOf(makeBox({ 0.93, 0.93, 0.47 })) },
    { "column", blockOf(makeBox({ 0.5, 0.5, 2.0 })) },
    { "box", blockOf(makeBox({ 2.5, 3.0, 1.0 })) },
    { "tilted box", blockOf(makeBox({ 1.0, 2.0, 3.0 }).transformed(1.0, tilt, Vec3::Zero())) },
    { "tilted plate", blockOf(makeBox({ 1.0, 1.0, 0.3 }).transformed(1.0, tilt, Vec3::Zero())) },
    { "nearly a plate", blockOf(makeBox({ 1.0, 1.0 + 1e-7, 0.4 })) },
    { "nearly a column", blockOf(makeBox({ 0.4, 0.4 + 1e-7, 1.0 })) },
    { "nearly a cube", blockOf(makeBox({ 1.0, 1.0 + 2e-6, 1.0 + 3e-6 })) },
    { "needle", blockOf(makeBox({ 1.0, 1.1, 100.0 })) },
    { "sheet", blockOf(makeBox({ 1.0, 1.3, 0.001 })) },
  };
  return all;
}

Vec3 randomVector(std::mt19937_64& random)
{
  std::normal_distribution<double> n(0.0, 1.0);
  return { n(random), n(random), n(random) };
}

double uniform(std::mt19937_64& random, double from, double to)
{
  return std::uniform_real_distribution<double>(from, to)(random);
}

/// A spin in body axes whose parts about the principal axes differ by up to `decades` powers of
/// ten.
Vec3 randomSpin(std::mt19937_64& random, const Block& block, double decades)
{
  Vec3 w = randomVector(random);
  for (double& part : w)
  {
    part *= std::pow(10.0, -uniform(random, 0.0, decades));
  }
  return block.principalAxes() * w;
}

/// Euler's equations and q̇ = ½ q ∘ (0, w), by Runge, Kutta and Fehlberg's rule of order 7(8) with a
/// local error of 1e-15.
FreeRotation::Attitude integrate(const Block& block, const Vec3& spin, double duration)
{
  using State = std::vector<double>;
  namespace odeint = boost::numeric::odeint;
  const auto rates = [&](const State& x, State& rate, double)
  {
    const Vec3 w(x[4], x[5], x[6]);
    const Quat q(x[3], x[0], x[1], x[2]);
    const Quat dq = q * Quat(0.0, 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z());
    const Vec3 dw = -(block.inverseInertia() * w.cross(block.inertia() * w));
    rate = { dq.x(), dq.y(), dq.z(), dq.w(), dw.x(), dw.y(), dw.z() };
  };
  State x = { 0.0, 0.0, 0.0, 1.0, spin.x(), spin.y(), spin.z() };
  auto rule = odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(1e-15, 1e-15);
  const double first = std::min(duration, 0.01 / spin.norm());
  odeint::integrate_adaptive(rule, rates, x, 0.0, duration, first);
  return { Quat(x[3], x[0], x[1], x[2]).normalized(), Vec3(x[4], x[5], x[6]) };
}

double angleBetween(const Quat& a, const Quat& b)
{
  return 2.0 * (a.conjugate() * b).vec().norm();
}

double energy(const Block& block, const Vec3& spin)
{
  return 0.5 * spin.dot(block.inertia() * spin);
}

} // namespace

TEST(FreeRotation, AgreesWithAnIntegrationOfEulersEquations)
{
  const int trials = rockfall::testing::isSmallForm() ? 5 : 250;
  std::mt19937_64 random(1);
  double worst = 0.0;
  for (const Body& body : bodies())
  {
    for (double decades : { 0.0, 2.0, 6.0, 12.0 })
    {
      for (int trial = 0; trial < trials; ++trial)
      {
        const Vec3 spin =
          std::pow(10.0, uniform(random, -3.0, 3.0)) * randomSpin(random, body.block, decades);
        const double duration = uniform(random, 0.0, 20.0) / spin.norm();
        const auto exact = FreeRotation(body.block, spin).after(duration);
        const auto integrated = integrate(body.block, spin, duration);
        const double angle = angleBetween(exact.turn, integrated.turn);
        const double share = (exact.spin - integrated.spin).norm() / spin.norm();
        worst = std::max({ worst, angle, share });
        // Near the intermediate axis deviations grow by exp(½ · 20 rad) = 2e4 for these bodies, and
        // the needle's moments differ by 5e3: from 1e-15 that makes 5e-11 at most, rad.
        ASSERT_LT(angle, 5e-11) << body.name << ", spin " << spin.transpose();
        ASSERT_LT(share, 5e-11) << body.name << ", spin " << spin.transpose();
      }
    }
  }
  std::printf("largest deviation %.1e rad\n", worst);
}

TEST(FreeRotation, TwoHalvesAreOneWhole)
{
  std::mt19937_64 random(2);
  for (const Body& body : bodies())
  {
    for (int trial = 0; trial < 1000; ++trial)
    {
      const Vec3 spin = randomSpin(random, body.block, trial % 2 == 0 ? 0.0 : 8.0);
      // Back and forth.
      const double duration = uniform(random, -20.0, 20.0) / spin.norm();
      const double part = uniform(random, 0.0, 1.0) * duration;
      const FreeRotation rotation(body.block, spin);
      const auto whole = rotation.after(duration);
      const auto first = rotation.after(part);
      const auto second = FreeRotation(body.block, first.spin).after(duration - part);
      // As above.
      ASSERT_LT(angleBetween(first.turn * second.turn, whole.turn), 5e-11) << body.name;
      ASSERT_LT((second.spin - whole.spin).norm(), 5e-11 * spin.norm()) << body.name;
    }
  }
}

TEST(FreeRotation, AThousandTurnsKeepAngularMomentumAndEnergy)
{
  std::mt19937_64 random(3);
  for (const Body& body : bodies())
  {
    double largest[2] = { 0.0, 0.0 };
    for (int trial = 0; trial < 50; ++trial)
    {
      BlockState start;
      start.orientation = Quat(Eigen::AngleAxisd(1.0, randomVector(random).normalized()));
      start.spin = randomSpin(random, body.block, trial % 2 == 0 ? 0.0 : 12.0);
      const double duration = 2000.0 * std::numbers::pi / start.spin.norm();
      const Vec3 momentum = angularMomentum(body.block, start);
      const double before = energy(body.block, start.spin);
      for (int calls : { 1, 100000 })
      {
        if (calls > 1 && trial > 1)
        {
          continue; // 0.1 s each
        }
        BlockState s = start;
        for (int k = 0; k < calls; ++k)
        {
          s = fly(body.block, s, 0.0, duration / calls);
        }
        const double turned = (angularMomentum(body.block, s) - momentum).norm() / momentum.norm();
        const double gained = std::abs(energy(body.block, s.spin) - before) / before;
        // Rounding: some 1e-16 in one call (5e3 times that for the needle, whose L is nearly all
        // about two axes), and at worst all of one sign in many.
        const double tolerance = calls == 1 ? 1e-12 : 1e-10;
        EXPECT_LT(turned, tolerance) << body.name << ", " << calls << " calls";
        EXPECT_LT(gained, tolerance) << body.name << ", " << calls << " calls";
        double& most = largest[calls > 1];
        most = std::max({ most, turned, gained });
      }
    }
    std::printf("%s: %.1e in one call, %.1e in 1e5\n", body.name, largest[0], largest[1]);
  }
}

TEST(FreeRotation, ManyFlightsEndWhereOneDoes)
{
  std::mt19937_64 random(4);
  for (const Body& body : bodies())
  {
    // About the axis of the largest moment, wobbling: nothing amplifies.
    const Vec3 spin = body.block.principalAxes() * Vec3(0.1, 0.2, 1.0);
    BlockState s;
    s.spin = spin;
    const double duration = 2000.0 * std::numbers::pi / spin.norm();
    const auto whole = FreeRotation(body.block, spin).after(duration);
    for (int k = 0; k < 100000; ++k)
    {
      s = fly(body.block, s, 0.0, duration / 100000.0);
    }
    // A speed that is off by up to 1e-10 at the end, as above, after 6283 rad.
    EXPECT_LT(angleBetween(s.orientation, whole.turn), 5e-7) << body.name;
  }
}

TEST(FreeRotation, TheIntermediateAxisFlipsInTheTimeOfTheClosedForm)
{
  for (const Vec3& lengths : { Vec3(2.5, 3.0, 1.0), Vec3(1.0, 2.0, 3.0) })
  {
    const Block block = blockOf(makeBox(lengths));
    const Vec3& i = block.principalMoments();
    for (double aside : { 1e-1, 1e-3, 1e-6 })
    {
      const Vec3 w = 5.0 * Vec3(aside, 1.0, 0.7 * aside);
      // Textbook form (Landau and Lifshitz, Mechanics, § 37), with L² > 2T I₂ or not; in long
      // double, as it takes differences.
      using Long3 = Eigen::Matrix<long double, 3, 1>;
      const Long3 il = i.cast<long double>(), wl = w.cast<long double>();
      const long double l2 = il.cwiseProduct(wl).squaredNorm(), twice = il.dot(wl.cwiseAbs2());
      const bool large = l2 > twice * il[1];
      const long double i1 = large ? il[0] : il[2], i2 = il[1], i3 = large ? il[2] : il[0];
      const long double rate = std::sqrt((i3 - i2) * (l2 - twice * i1) / (i1 * i2 * i3));
      const long double m = (i2 - i1) * (twice * i3 - l2) / ((i3 - i2) * (l2 - twice * i1));
      const double expected = double(4.0L * std::comp_ellint_1(std::sqrt(m)) / rate);

      // From one sign change of the middle component to the next but one.
      const FreeRotation rotation(block, block.principalAxes() * w);
      const double step = 1e-3;
      std::vector<double> changes;
      double last = w[1];
      for (int k = 1; changes.size() < 3 && k < 200000; ++k)
      {
        const double now = block.principalAxes().col(1).dot(rotation.after(step * k).spin);
        if (now * last < 0.0)
        {
          changes.push_back(step * (k - now / (now - last)));
        }
        last = now;
      }
      ASSERT_EQ(changes.size(), 3u);
      // The bar is 0.1 %. Interpolation in a step of 1e-3 s, at 5 rad/s, leaves 1e-8 s; long double
      // leaves 1e-7 of 1 − m = 1e-12.
      EXPECT_NEAR(changes[2] - changes[0], expected, 1e-6 * expected) << aside;
      EXPECT_NEAR(rotation.period(), expected, 1e-6 * expected) << aside;
    }
  }
}

TEST(FreeRotation, SpinsAboutAPrincipalAxisAreSteadyHoweverNearly)
{
  const Block block = blockOf(makeBox({ 2.5, 3.0, 1.0 }));
  const Mat3& axes = block.principalAxes();
  for (int axis = 0; axis < 3; ++axis)
  {
    const Vec3 pure = 7.0 * axes.col(axis);
    const Quat expected(Eigen::AngleAxisd(0.7, axes.col(axis)));
    const auto turned = FreeRotation(block, pure).after(0.1);
    EXPECT_EQ(turned.spin, pure);
    EXPECT_LT(angleBetween(turned.turn, expected), 1e-15);
    for (double aside : { 1e-5, 1e-10, 1e-50, 1e-120, 1e-150, 1e-200, 1e-310 })
    {
      const Vec3 spin = axes * (7.0 * Vec3::Unit(axis) + Vec3(aside, -aside, 0.5 * aside));
      const FreeRotation rotation(block, spin);
      const auto nearly = rotation.after(0.1);
      // Over a tenth of a turn what is aside hardly grows; the phase, up to 300 rad on the way to
      // the intermediate axis, is good to a few 1e-16 of itself.
      EXPECT_LT(angleBetween(nearly.turn, expected), 2.0 * aside + 1e-12) << axis << ' ' << aside;
      EXPECT_LT((nearly.spin - spin).norm(), 10.0 * aside + 1e-12) << axis << ' ' << aside;
      double lowest = 1.0;
      for (int k = 0; k < 1000; ++k)
      {
        const double time = k * 1e-3 * (rotation.period() > 0.0 ? rotation.period() : 1.0);
        lowest = std::min(lowest, rotation.after(time).spin.dot(axes.col(axis)) / 7.0);
      }
      // Only the intermediate axis turns over, if there is anything to start it.
      EXPECT_EQ(lowest < -0.99, axis == 1 && aside > 1e-140) << axis << ' ' << aside;
      EXPECT_TRUE(lowest < -0.99 || lowest > 0.99) << axis << ' ' << aside;
    }
  }
}

TEST(FreeRotation, SpinsWithoutSizeOrOnTheSeparatrix)
{
  const Block block = blockOf(makeBox({ 2.5, 3.0, 1.0 }));
  // Similar motions at any speed, to the last digits of 20 rad.
  const Vec3 spin(0.4, 1.0, -0.6);
  const auto expected = FreeRotation(block, spin).after(20.0);
  for (double scale : { 1e-300, 1e-160, 1e-20, 1e20, 1e150, 1e300 })
  {
    const auto scaled = FreeRotation(block, scale * spin).after(20.0 / scale);
    EXPECT_LT(angleBetween(scaled.turn, expected.turn), 1e-13) << scale;
    EXPECT_LT((scaled.spin / scale - expected.spin).norm(), 1e-13) << scale;
  }
  EXPECT_EQ(FreeRotation(block, Vec3::Zero()).after(1e6).spin, Vec3(Vec3::Zero()));
  EXPECT_EQ(FreeRotation(block, spin).after(0.0).spin.norm(), spin.norm());

  // L² = 2T I₂: the spin tends to the intermediate axis and stays, as far as rounding lets it.
  const Vec3& i = block.principalMoments();
  const Vec3 w(std::sqrt(i[2] * (i[2] - i[1])), 0.0, std::sqrt(i[0] * (i[1] - i[0])));
  const Vec3 separatrix = block.principalAxes() * w.normalized();
  const FreeRotation rotation(block, separatrix);
  EXPECT_GT(rotation.parameter(), 1.0 - 1e-14);
  const auto integrated = integrate(block, separatrix, 15.0);
  // 1 − m is 1e-16 or so by rounding, differently in both, which exp(½ · 15 rad) makes 2e-13.
  EXPECT_LT(angleBetween(rotation.after(15.0).turn, integrated.turn), 1e-11);
  EXPECT_GT(std::abs(rotation.after(15.0).spin.dot(block.principalAxes().col(1))), 0.8);
  for (double time : { 1e2, 1e4, 1e6, 1e9 })
  {
    const auto later = rotation.after(time);
    EXPECT_NEAR(energy(block, later.spin) / energy(block, separatrix), 1.0, 1e-14);
    EXPECT_TRUE(later.turn.coeffs().allFinite());
  }
}
