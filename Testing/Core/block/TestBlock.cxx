// The block with its 12 unknowns and its free flight (METHOD 1, 10.3, 10.4).

#include "angularMomentum.h"
#include "base/errors.h"
#include "block/Block.h"
#include "block/flight.h"
#include "geometry/shapes.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using rockfall::testing::angularMomentum;

namespace
{

Vec3 randomVector(std::mt19937& random)
{
  std::normal_distribution<double> n(0.0, 1.0);
  return { n(random), n(random), n(random) };
}

} // namespace

TEST(Block, DisplacementRowIsTheMatrixOfTheMethod)
{
  // T of METHOD 1, written out.
  const double X = 0.3, Y = -0.7, Z = 1.1;
  Eigen::Matrix<double, 3, 12> t;
  t << 1, 0, 0, 0, Z, -Y, X, 0, 0, 0, Z / 2, Y / 2, //
    0, 1, 0, -Z, 0, X, 0, Y, 0, Z / 2, 0, X / 2,    //
    0, 0, 1, Y, -X, 0, 0, 0, Z, Y / 2, X / 2, 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Vec12 row = displacementRow(Vec3::Unit(axis), Vec3(X, Y, Z), Vec3(X, Y, Z));
    EXPECT_LT((row.transpose() - t.row(axis)).norm(), 1e-15);
  }
}

TEST(Block, MassMatrixGivesTheKineticEnergyOfAnyFirstOrderMotion)
{
  // Oracle: midpoint sum over 40³ cells of a box; its error is 1/40² of the second moments.
  const Vec3 lengths(2.0, 3.0, 1.0);
  const Block block(makeBox(lengths), 2500.0, 1e10, 0.1);
  std::mt19937 random(5);
  for (int trial = 0; trial < 5; ++trial)
  {
    Vec12 v;
    for (int k = 0; k < 12; ++k)
    {
      v[k] = std::normal_distribution<double>(0.0, 1.0)(random);
    }
    const int n = 40;
    double sum = 0.0;
    for (int i = 0; i < n * n * n; ++i)
    {
      const Vec3 cell(i % n, (i / n) % n, i / (n * n));
      const Vec3 x = ((cell.array() + 0.5) / n - 0.5) * lengths.array();
      for (int axis = 0; axis < 3; ++axis)
      {
        const double velocity = displacementRow(Vec3::Unit(axis), x, x).dot(v);
        sum += 0.5 * 2500.0 * velocity * velocity * lengths.prod() / (n * n * n);
      }
    }
    EXPECT_NEAR(0.5 * v.dot(block.massMatrix() * v), sum, 1e-3 * sum);
  }
  // And the closed form of the rigid part: m (b² + c²) / 12.
  EXPECT_NEAR(block.inertia()(0, 0), block.mass() * (9.0 + 1.0) / 12.0, 1e-9 * block.mass());
}

TEST(Block, ElasticityIsThatOfAnIsotropicBody)
{
  const double e = 2e10, nu = 0.2;
  const Block block(makeShape(Shape::Cube, 2.0), 2500.0, e, nu);
  // Uniaxial stress: εx = σ/E, εy = εz = −ν σ/E must give the stress back.
  Vec6 strain;
  strain << 1.0 / e, -nu / e, -nu / e, 0, 0, 0;
  Vec6 expected = Vec6::Zero();
  expected[0] = 2.0; // V σ with σ = 1
  EXPECT_LT((block.elasticity() * strain - expected).norm(), 1e-12);
  // Shear modulus E / 2(1+ν) on an engineering strain.
  EXPECT_DOUBLE_EQ(block.elasticity()(4, 4) / (2.0 * e / (2.0 * (1.0 + nu))), 1.0);
}

TEST(Flight, CentroidStaysOnTheParabola)
{
  const Block block(makeShape(Shape::Eota221, 1.0), 2500.0, 1e10, 0.1);
  BlockState start;
  start.velocity = Vec3(3.0, -2.0, 8.0);
  start.spin = Vec3(4.0, 5.0, -6.0);
  BlockState s = start;
  for (int k = 0; k < 1000; ++k)
  {
    s = fly(block, s, 9.81, 0.01);
  }
  const Vec3 expected = 10.0 * start.velocity - Vec3(0, 0, 0.5 * 9.81 * 100.0);
  EXPECT_LT((s.position - expected).norm(), 1e-9 * expected.norm());
}

TEST(Flight, KeepsAngularMomentumAndEnergy)
{
  std::mt19937 random(6);
  for (const Polyhedron& shape : { makeShape(Shape::Cube, 1.0), makeBox({ 0.93, 0.93, 0.47 }),
         makeBox({ 2.5, 3.0, 1.0 }), makeShape(Shape::Tetrahedron, 1.0) })
  {
    const Block block(shape, 2500.0, 1e10, 0.1);
    BlockState start;
    start.orientation = Quat::UnitRandom();
    start.spin = 10.0 * randomVector(random).normalized();
    const BlockState end = fly(block, start, 9.81, 10.0); // some 16 turns
    const Vec3 before = angularMomentum(block, start), after = angularMomentum(block, end);
    EXPECT_LT((after - before).norm(), 1e-12 * before.norm());
    const double e0 = 0.5 * start.spin.dot(block.inertia() * start.spin);
    const double e1 = 0.5 * end.spin.dot(block.inertia() * end.spin);
    // Rounding.
    EXPECT_NEAR(e1, e0, 1e-12 * e0);
  }
}

TEST(Flight, TheIntermediateAxisFlips)
{
  // A box spun about its middle axis turns over (METHOD 10.4); about the others it does not.
  const Block block(makeBox({ 2.5, 3.0, 1.0 }), 2500.0, 1e10, 0.1);
  Eigen::Index middle = 0;
  const Vec3 moments = block.inertia().diagonal();
  for (int k = 0; k < 3; ++k)
  {
    if (moments[k] != moments.minCoeff() && moments[k] != moments.maxCoeff())
    {
      middle = k;
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    BlockState s;
    s.spin = 5.0 * Vec3::Unit(axis) + Vec3(1e-3, 1e-3, 1e-3);
    double lowest = 1.0;
    for (int k = 0; k < 400; ++k)
    {
      s = fly(block, s, 0.0, 0.05);
      lowest = std::min(lowest, s.spin[axis] / 5.0);
    }
    EXPECT_EQ(lowest < -0.9, axis == middle) << "axis " << axis;
  }
}

TEST(Block, RelaxingStrainKeepsMomenta)
{
  const Block block(makeBox({ 2.0, 1.0, 0.5 }), 2500.0, 1e10, 0.1);
  BlockState s;
  s.orientation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  s.velocity = Vec3(1, 2, 3);
  s.spin = Vec3(3, -1, 2);
  s.strain << 1e-5, -2e-5, 1e-5, 3e-5, 0, 1e-5;
  s.strainRate << 0.1, 0.2, -0.1, 0.3, 0.1, 0.2;
  const Vec3 momentum = angularMomentum(block, s);
  const double before = kineticEnergy(block, s) + strainEnergy(block, s);
  const double dropped = relaxStrain(block, s);
  EXPECT_LT((angularMomentum(block, s) - momentum).norm(), 1e-12 * momentum.norm());
  EXPECT_GT(dropped, 0.0);
  EXPECT_NEAR(kineticEnergy(block, s) + dropped, before, 1e-10 * before);
}

TEST(Block, ShapeOffItsCentroidIsRefused)
{
  const Polyhedron box = makeBox({ 2.0, 1.0, 0.5 });
  const Polyhedron off = box.transformed(1.0, Quat::Identity(), Vec3(0.0, 1e-3, 0.0));
  const auto make = [](const Polyhedron& shape) { return Block(shape, 2500.0, 1e10, 0.1); };
  EXPECT_THROW(make(off), GeometryError);
  EXPECT_NO_THROW(make(off.centred()));
}
