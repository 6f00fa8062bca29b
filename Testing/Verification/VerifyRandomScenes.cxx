// Random rocks on random ground, many of them: no energy from nowhere or to nowhere, nothing deep in
// the ground, the same bits on one thread and on two, and no scene without an end.

#include "verification.h"

#include "Core/randomScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace rockfall;
using namespace rockfall::testing;
using namespace rockfall::verification;

namespace
{

/// Records the worst of many scenes, others than those of the project's tests; sceneOf(seed) is one.
template <class SceneOf>
void recordScenes(const std::string& subject, SceneOf&& sceneOf)
{
  const long first = fromEnvironment("ROCKFALL_FIRST_SCENE", 1000);
  const long scenes = fromEnvironment("ROCKFALL_SCENES", count(20, 2000));
  double made = 0.0, lost = 0.0, deepest = 0.0;
  double heard = 0.0;
  int longer = 0, otherBits = 0, run = 0;
  for (long seed = first; seed < first + scenes; ++seed)
  {
    const SceneOutcome outcome = runScene(sceneOf(std::uint64_t(seed)), count(20, 120));
    run += !outcome.refused;
    longer += outcome.givenUp;
    heard = std::max(heard, outcome.heard);
    otherBits += !outcome.sameBits;
    const double share = outcome.released > 0.0 ? outcome.made / outcome.released : 0.0;
    made = std::max(made, share);
    lost = std::max(lost, -share);
    deepest = std::max(deepest, outcome.tooDeep);
    EXPECT_LE(std::abs(outcome.made), 0.01 * outcome.released) << "scene " << seed;
    EXPECT_LE(outcome.gained, 0.01 * outcome.released) << "scene " << seed;
    EXPECT_EQ(outcome.tooDeep, 0.0) << "scene " << seed << ", " << outcome.worst;
  }
  const std::string all = std::to_string(scenes) + " scenes";
  recordAtLeast(
    { subject, "scenes that could be run, of " + all, "", "" }, run, 0.9 * double(scenes));
  recordAtMost(
    { subject, "energy made, of that released, at most", "", "books of a scene" }, made, 0.01);
  recordAtMost(
    { subject, "energy lost to nowhere, of that released, at most", "", "books of a scene" }, lost,
    0.01);
  recordAtMost({ subject, "depth of a vertex beyond what springs explain, of the radius", "", "" },
    deepest, 0.0);
  report({ subject, "scenes given up, as they take too long", "", "" }, longer);
  recordAtMost({ subject, "time until that is heard", "s", "" }, heard, 1.0);
  recordAtMost(
    { subject, "scenes that differ between one thread and two", "", "" }, otherBits, 0.0);
}

} // namespace

TEST(RandomScenes, MakeNoEnergyAndStayOutOfTheGround)
{
  recordScenes("Random scenes", [](std::uint64_t seed) { return randomScene(seed, 20, 2.0); });
}

TEST(RandomScenes, OfRoundRocksCloseTheirBooks)
{
  recordScenes(
    "Random scenes of round rocks", [](std::uint64_t seed) { return roundScene(seed, 2.0); });
}
