// Random rocks on random ground, many of them: no energy from nowhere or to nowhere, nothing deep in
// the ground, the same bits on one thread and on two, and no scene without an end.

#include "verification.h"

#include "Core/randomScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using namespace rockfall;
using namespace rockfall::testing;
using namespace rockfall::verification;

namespace
{

/// The worst of many scenes.
class Scenes
{
public:
  explicit Scenes(std::string subject)
    : subject_(std::move(subject))
  {
  }

  void add(long seed, const SceneOutcome& outcome)
  {
    ++scenes_;
    run_ += !outcome.refused;
    givenUp_ += outcome.givenUp;
    otherBits_ += !outcome.sameBits;
    heard_ = std::max(heard_, outcome.heard);
    tooDeep_ = std::max(tooDeep_, outcome.tooDeep);
    const double share = outcome.released > 0.0 ? outcome.made / outcome.released : 0.0;
    made_ = std::max(made_, share);
    lost_ = std::max(lost_, -share);
    EXPECT_LE(outcome.made, 0.01 * outcome.released) << "scene " << seed;
    EXPECT_LE(-outcome.made, 0.01 * outcome.released) << "scene " << seed;
    EXPECT_LE(outcome.gained, 0.01 * outcome.released) << "scene " << seed;
    EXPECT_EQ(outcome.tooDeep, 0.0) << "scene " << seed << ", " << outcome.worst;
  }

  void record() const
  {
    const std::string all = std::to_string(scenes_) + " scenes";
    recordAtLeast(
      { subject_, "scenes that could be run, of " + all, "", "" }, run_, 0.9 * double(scenes_));
    recordAtMost(
      { subject_, "energy made, of that released, at most", "", "books of a scene" }, made_, 0.01);
    recordAtMost(
      { subject_, "energy lost to nowhere, of that released, at most", "", "books of a scene" },
      lost_, 0.01);
    recordAtMost(
      { subject_, "depth of a vertex beyond what springs explain, of the radius", "", "" },
      tooDeep_, 0.0);
    report({ subject_, "scenes given up, as they take too long", "", "" }, givenUp_);
    recordAtMost({ subject_, "time until that is heard", "s", "" }, heard_, 1.0);
    recordAtMost(
      { subject_, "scenes that differ between one thread and two", "", "" }, otherBits_, 0.0);
  }

private:
  std::string subject_;
  long scenes_ = 0;
  int run_ = 0, givenUp_ = 0, otherBits_ = 0;
  double made_ = 0.0, lost_ = 0.0, heard_ = 0.0, tooDeep_ = 0.0;
};

} // namespace

// Others than those of the project's tests.
TEST(RandomScenes, MakeNoEnergyAndStayOutOfTheGround)
{
  const long first = fromEnvironment("ROCKFALL_FIRST_SCENE", 1000);
  const long end = first + fromEnvironment("ROCKFALL_SCENES", count(20, 2000));
  Scenes scenes("Random scenes");
  for (long seed = first; seed < end; ++seed)
  {
    scenes.add(seed, runScene(randomScene(std::uint64_t(seed), 20, 2.0), count(20, 120)));
  }
  scenes.record();
}

TEST(RandomScenes, OfRoundRocksCloseTheirBooks)
{
  const long first = fromEnvironment("ROCKFALL_FIRST_SCENE", 1000);
  const long end = first + fromEnvironment("ROCKFALL_SCENES", count(20, 2000));
  Scenes scenes("Random scenes of round rocks");
  for (long seed = first; seed < end; ++seed)
  {
    scenes.add(seed, runScene(roundScene(std::uint64_t(seed), 2.0), count(20, 120)));
  }
  scenes.record();
}
