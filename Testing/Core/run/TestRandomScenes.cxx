// Random rocks on random ground: no energy from nowhere, nothing in the ground, the same bits on
// one thread and on two. The full form is VerifyRandomScenes.

#include "form.h"
#include "randomScenes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

void expectSound(const SceneOutcome& outcome)
{
  ASSERT_FALSE(outcome.refused || outcome.givenUp);
  EXPECT_TRUE(outcome.sameBits);
  EXPECT_LE(std::abs(outcome.made), 0.01 * outcome.released);
  EXPECT_LE(outcome.gained, 0.01 * outcome.released);
  EXPECT_EQ(outcome.tooDeep, 0.0) << outcome.worst;
}

} // namespace

class RandomScenes : public ::testing::TestWithParam<int>
{
};

TEST_P(RandomScenes, MakeNoEnergyAndStayOutOfTheGround)
{
  const double seconds = isSmallForm() ? 0.5 : 1.0;
  expectSound(runScene(randomScene(std::uint64_t(GetParam()), 12, seconds), 240.0));
}

// Rocks alone, and falls of up to twelve; in 131 some are thrown into pits and wedged, in
// 153 a plate topples onto its face.
INSTANTIATE_TEST_SUITE_P(Seeds, RandomScenes, ::testing::Values(41, 44, 47, 50, 53, 56, 131, 153));

// Spheres and ellipsoids: alone, as they do not collide.
TEST(RandomScene, RoundRocksKeepTheirBooks)
{
  for (std::uint64_t seed = 910000; seed < 910040; ++seed)
  {
    SCOPED_TRACE(seed);
    expectSound(runScene(roundScene(seed, 2.0), 240.0));
  }
}

// A tetrahedron that is jammed between two edges, with an overlap and friction of 55°, is pressed
// out of them in an island. It comes to rest; if the impulses that press it out lasted
// (`SoftSolver::takeBackPress`), it would leave with ten times what gravity released.
TEST(RandomScene, AJammedRockIsNotThrown)
{
  const SceneOutcome outcome = runScene(randomScene(7600383, 20, 1.0), 240.0);
  ASSERT_FALSE(outcome.refused || outcome.givenUp);
  EXPECT_LE(outcome.gained, 1e-6 * outcome.released);
  EXPECT_LE(std::abs(outcome.made), 0.01 * outcome.released);
}

// A stone of 0.4 kg lies on the slope and a rock of 26 kg falls on it: it strikes the two in turn
// more than twelve times within a substep. If the rest is left to the sweeps, books say that the
// slope has given it 10 J, and it the rock above.
TEST(RandomScene, AStoneUnderARockHandsOnWhatItWasGiven)
{
  const SceneOutcome outcome = runScene(randomScene(8100250, 20, 2.0), 240.0);
  ASSERT_FALSE(outcome.refused || outcome.givenUp);
  EXPECT_EQ(outcome.gained, 0.0);
  EXPECT_LE(std::abs(outcome.made), 0.01 * outcome.released);
}
