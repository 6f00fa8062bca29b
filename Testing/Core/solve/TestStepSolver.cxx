// One step against the method's equations, written out here a second time (METHOD 2, 3).

#include "angularMomentum.h"
#include "geometry/shapes.h"
#include "law/springs.h"
#include "solve/step/StepSolver.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using rockfall::testing::angularMomentum;

TEST(Springs, ConserveEnergyWhateverThePhase)
{
  const double p = 1e9; // N/m
  const auto stored = [&](double d) { return 0.5 * p * std::min(d, 0.0) * std::min(d, 0.0); };
  for (double d0 : { -3e-3, -1e-5, 0.0, 1e-6, 2e-3 })
  {
    for (double d1 : { -2e-3, -1e-6, 0.0, 1e-5, 4e-3 })
    {
      const NormalSpring s = conservingSpring(p, d0, d1);
      EXPECT_GE(s.force, 0.0);
      EXPECT_GE(s.stiffness, 0.0);
      EXPECT_NEAR(
        s.force * (d1 - d0), stored(d0) - stored(d1), 1e-12 * (stored(d0) + stored(d1)) + 1e-20);
      // The tangent is the derivative.
      const double step = 1e-9;
      const NormalSpring up = conservingSpring(p, d0, d1 + step);
      if (d1 != 0.0 && d0 != d1)
      {
        EXPECT_NEAR(s.stiffness, (s.force - up.force) / step, 1e-3 * p);
      }
    }
  }
}

TEST(StepSolver, AVertexOnAPlaneIsTheMethodsSystem)
{
  // A cube with one vertex 0.1 mm in a frictionless plane, at rest, one damped step: with the gap
  // linear in D the solution of METHOD 2 and 3, force at the end of the step, is closed.
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.1);
  BlockState state;
  Contact c;
  c.kind = ContactKind::VertexFace;
  c.rockFeature = 0;
  c.normal = Vec3(0.1, -0.2, 1.0).normalized();
  c.distance = -1e-4;
  c.state = ContactState::Sliding;
  const Vec3 x = block.shape().vertices()[0];
  c.point = x;
  std::vector<Contact> contacts{ c };
  StepRequest request;
  request.duration = 1e-4;
  request.kind = StepKind::Lasting;
  StepSolver solver;
  const StepOutcome outcome = solver.step(block, request, contacts, state);
  ASSERT_TRUE(outcome.settled);

  // K = M/h² + E + pₙ (Tᵀn)(Tᵀn)ᵀ, F = ∫Tᵀf dV − pₙ d₀ Tᵀn, from rest (Ḋ¹ = D/h).
  const double h = request.duration;
  const Vec12 j = displacementRow(c.normal, x, x);
  Mat12 k = block.massMatrix() / (h * h) + request.normalPenalty * j * j.transpose();
  k.block<6, 6>(kStrain, kStrain) += block.elasticity();
  Vec12 f = -request.normalPenalty * c.distance * j;
  f[2] -= block.mass() * request.gravity;
  const Vec12 d = k.partialPivLu().solve(f);
  // The solver's lever is at mid-step: it differs by the rotation of the step, 1e-5.
  EXPECT_LT((state.position - d.head<3>()).norm(), 1e-4 * d.head<3>().norm());
  EXPECT_LT((state.velocity - d.head<3>() / h).norm(), 1e-4 * d.head<3>().norm() / h);
  EXPECT_LT((state.spin - d.segment<3>(3) / h).norm(), 1e-4 * d.segment<3>(3).norm() / h);
  EXPECT_LT((state.strain - d.tail<6>()).norm(), 1e-3 * d.tail<6>().norm());
  EXPECT_NEAR(contacts[0].distance, c.distance + j.dot(d), 1e-9);
}

TEST(StepSolver, ConservesEnergyAndAngularMomentumWithoutFriction)
{
  std::mt19937 random(3);
  std::normal_distribution<double> n(0.0, 1.0);
  StepSolver solver;
  for (int trial = 0; trial < 50; ++trial)
  {
    const Block block(
      makeShape(trial % 2 ? Shape::Eota221 : Shape::Tetrahedron, 1.0), 2500.0, 1e10, 0.2);
    BlockState state;
    state.orientation = Quat(n(random), n(random), n(random), n(random)).normalized();
    state.velocity = Vec3(n(random), n(random), n(random) - 5.0);
    state.spin = 3.0 * Vec3(n(random), n(random), n(random));
    const int vertex = trial % int(block.shape().vertices().size());
    Contact c;
    c.rockFeature = vertex;
    c.normal = Vec3::UnitZ();
    c.point = state.orientation * block.shape().vertices()[vertex];
    c.distance = 0.0;
    std::vector<Contact> contacts{ c };
    StepRequest request;
    request.duration = 2e-4;
    request.kind = StepKind::Impact;
    request.gravity = 0.0;
    double spring = 0.0;
    const auto energy = [&]
    { return kineticEnergy(block, state) + strainEnergy(block, state) + spring; };
    const double before = energy();
    const Vec3 spin = angularMomentum(block, state);
    const Vec3 arm0 = state.position, velocity0 = state.velocity;
    for (int k = 0; k < 60; ++k)
    {
      const StepOutcome o = solver.step(block, request, contacts, state);
      ASSERT_TRUE(o.settled);
      EXPECT_EQ(o.frictionWork, 0.0);
      spring = o.springEnergy;
      contacts[0].point = state.position +
        state.orientation *
          ((Mat3::Identity() + strainTensor(state.strain)) * block.shape().vertices()[vertex]);
      // The gap is linear in D to the last digit: what the step predicted is where the vertex is.
      const double height = contacts[0].point.z() - c.point.z();
      EXPECT_NEAR(contacts[0].distance, height, 1e-9);
      contacts[0].distance = height;
    }
    EXPECT_NEAR(energy(), before, 1e-7 * before);
    // Vertical forces have no moment about any vertical axis: the angular momentum about that of
    // the origin stays.
    const auto aboutVertical = [&](const Vec3& own, const Vec3& x, const Vec3& v)
    { return own.z() + block.mass() * x.cross(v).z(); };
    EXPECT_NEAR(aboutVertical(angularMomentum(block, state), state.position, state.velocity),
      aboutVertical(spin, arm0, velocity0), 1e-7 * (spin.norm() + block.mass()));
  }
}

TEST(StepSolver, GravityAloneIsTheParabola)
{
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.1);
  for (StepKind kind : { StepKind::Impact })
  {
    BlockState state;
    state.velocity = Vec3(1, 2, 3);
    std::vector<Contact> none;
    StepRequest request;
    request.kind = kind;
    request.duration = 0.01;
    StepSolver solver;
    for (int k = 0; k < 100; ++k)
    {
      ASSERT_TRUE(solver.step(block, request, none, state).settled);
    }
    EXPECT_LT((state.position - Vec3(1, 2, 3 - 0.5 * 9.81)).norm(), 1e-12);
  }
}
