// Contacts of a crowd that may stay open: speculative, out of the sweeps, until they close.

#include "piles.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kGap = 1e-5;    // m
constexpr double kPenalty = 1e9; // N/m
constexpr double kStep = 0.005;  // s

/// A cube of 1 m at rest, its lower corners so far over the floor that they stay open unless
/// gravity pulls it down.
struct Hanging
{
  Rock cube = brick(Vec3(1.0, 1.0, 1.0), Vec3(0.0, 0.0, 0.5 + kGap), 0);
  Block block{ cube.shape, cube.density, cube.youngModulus, cube.poissonRatio };
  BlockState state;
  std::vector<Contact> corners = std::vector<Contact>(4);
  std::vector<IslandContact> contacts = std::vector<IslandContact>(4);
  std::vector<IslandBody> bodies = std::vector<IslandBody>(1);
  /// Corners that have springs.
  std::ptrdiff_t armed() const
  {
    return std::count_if(
      corners.begin(), corners.end(), [](const Contact& c) { return c.stiffness == kPenalty; });
  }

  IslandOutcome step(double gravity)
  {
    state.position.z() = 0.5 + kGap;
    for (std::size_t k = 0; k < 4; ++k)
    {
      Contact& c = corners[k];
      c.point = Vec3(k % 2 - 0.5, double(k / 2) - 0.5, kGap);
      c.distance = kGap;
      contacts[k].contact = &c;
      contacts[k].first = 0;
      contacts[k].friction = 0.5;
      contacts[k].bare = true;
      EXPECT_TRUE(mayStayOpen(contacts[k], kStep));
    }
    bodies[0].block = &block;
    bodies[0].state = &state;
    IslandSolver solver;
    solver.method = IslandMethod::Crowd;
    solver.stiffness = { kPenalty, 1.0, true };
    const StepRequest request = lastingStep(kStep, gravity, 12);
    return solver.step(request, bodies, contacts, Accept::Converging);
  }
};

} // namespace

TEST(Speculative, GetsItsSpringsAndCarriesWhenItCloses)
{
  Hanging cube;
  const IslandOutcome outcome = cube.step(kGravity);
  EXPECT_TRUE(outcome.accepted);
  EXPECT_EQ(cube.armed(), 4);
  // m (g + way/h²) = F and F = 4 p (−way − gap).
  const double m = cube.block.mass();
  const double force =
    m * (kGravity - kGap / (kStep * kStep)) / (1.0 + m / (4.0 * kPenalty * kStep * kStep));
  double sum = 0.0;
  for (const Contact& c : cube.corners)
  {
    EXPECT_TRUE(c.closed());
    EXPECT_NEAR(c.normalForce, 0.25 * force, 0.01 * force); // four springs that hang together
    EXPECT_NEAR(c.distance, -c.normalForce / kPenalty, 1e-7);
    sum += c.normalForce;
  }
  EXPECT_NEAR(sum, force, 0.01 * force);
  EXPECT_NEAR(cube.state.position.z(), 0.5 - 0.25 * force / kPenalty, 1e-7);
}

TEST(Speculative, NeedsNoSpringsAsLongAsItIsOpen)
{
  Hanging cube;
  const IslandOutcome outcome = cube.step(0.9 * kGap / (kStep * kStep));
  EXPECT_TRUE(outcome.accepted);
  EXPECT_EQ(cube.armed(), 0);
  for (const Contact& c : cube.corners)
  {
    EXPECT_FALSE(c.closed());
    EXPECT_EQ(c.normalForce, 0.0);
    EXPECT_NEAR(c.distance, 0.1 * kGap, 1e-12); // where free fall leads in the step, h² g
  }
}
