// Joint sets that cannot cut a rock mass, or cut it into what is no block.

#include "base/errors.h"
#include "geometry/shapes.h"
#include "massCuts.h"

#include <gtest/gtest.h>

#include <limits>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

template <typename Failure>
void expectError(const Polyhedron& mass, const std::vector<JointSet>& sets, const MassCut& how,
  const std::vector<std::string>& words)
{
  try
  {
    cutMass(mass, sets, how, Vec3(1000.0, 2000.0, 300.0));
    ADD_FAILURE() << "no error with " << words.front();
  }
  catch (const Failure& error)
  {
    for (const std::string& word : words)
    {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
        << word << " is not in: " << error.what();
    }
  }
}

} // namespace

TEST(JointSets, SliversAreNamedDroppedOrKept)
{
  const Polyhedron mass = makeBox(Vec3(3.0, 3.0, 3.0));
  // The upper joint is 5 mm below the top.
  const std::vector<JointSet> sets = { jointSet(0.0, 0.0, 2.0, 1.495), jointSet(90.0, 90.0, 2.0) };
  expectError<GeometryError>(mass, sets, {},
    { "slivers: 2 of the 6 blocks", "MinimumThickness, 0.01 m", "0.005",
      "at (999.25, 2000, 301.4975)", "0.045", "Slivers" });
  MassCut how;
  how.slivers = SliverRule::Drop;
  CutMass cut = cutMass(mass, sets, how);
  EXPECT_EQ(cut.blocks.size(), 4u);
  EXPECT_EQ(cut.slivers, 2);
  EXPECT_NEAR(cut.sliverVolume, 0.045, 1e-12);
  how.slivers = SliverRule::Keep;
  cut = cutMass(mass, sets, how);
  EXPECT_EQ(cut.blocks.size(), 6u);
  EXPECT_EQ(cut.slivers, 2);
  EXPECT_NEAR(sumOf(cut), 27.0, 27e-12);
  // Too thin for a polyhedron (3 V / A below 1e-4 of its extent).
  expectError<GeometryError>(mass, { jointSet(0.0, 0.0, 2.0, 1.49999) }, how,
    { "too thin", "at (1000, 2000, 301.4", "Drop" });
  how.slivers = SliverRule::Drop;
  how.leastThickness = 10.0;
  expectError<GeometryError>(mass, sets, how, { "nothing", "all 6" });
}

TEST(JointSets, BadInput)
{
  const Polyhedron mass = makeBox(Vec3(3.0, 3.0, 3.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const JointSet good = jointSet(0.0, 0.0, 1.0, 0.5);
  expectError<ParameterError>(mass, {}, {}, { "JointSets is empty" });
  expectError<ParameterError>(
    mass, { good, jointSet(90.0, 0.0, 0.0) }, {}, { "joint set 2", "spacing is 0 m" });
  expectError<ParameterError>(
    mass, { good, jointSet(90.0, 0.0, nan) }, {}, { "joint set 2", "spacing is nan" });
  expectError<ParameterError>(
    mass, { jointSet(nan, 0.0, 1.0) }, {}, { "joint set 1", "dip is nan", "0 to 90" });
  expectError<ParameterError>(
    mass, { jointSet(91.0, 0.0, 1.0) }, {}, { "joint set 1", "dip is 91" });
  expectError<ParameterError>(
    mass, { jointSet(10.0, nan, 1.0) }, {}, { "joint set 1", "dip direction is nan" });
  JointSet bad = good;
  bad.spacingDeviation = -1.0;
  expectError<ParameterError>(mass, { bad }, {}, { "spacing deviation is -1" });
  bad.spacingDeviation = 1e300;
  expectError<ParameterError>(mass, { bad }, {}, { "spacing deviation is 1e+300", "ten times" });
  bad = good;
  bad.offset = 1e17;
  expectError<ParameterError>(mass, { bad }, {}, { "offset is 1e+17 m", "a million spacings" });
  bad = good;
  bad.orientationDeviation = nan;
  expectError<ParameterError>(mass, { bad }, {}, { "orientation deviation is nan" });
  expectError<ParameterError>(mass, { good, jointSet(90.0, 0.0, 9.0, 4.0) }, {},
    { "joint set 2", "spacing 9 m", "cuts nothing", "3 m wide" });
  expectError<ParameterError>(mass, { good, jointSet(90.0, 0.0, 1.0), jointSet(0.5, 30.0, 0.7) },
    {}, { "joint set 1", "joint set 3", "parallel within 1°" });
  // Vertical planes whose dip directions are opposite.
  expectError<ParameterError>(
    mass, { jointSet(90.0, 10.0, 1.0), jointSet(90.0, 190.0, 0.7) }, {}, { "parallel" });
  expectError<ParameterError>(
    mass, { jointSet(0.0, 0.0, 0.001) }, {}, { "joint set 1", "slivers", "MinimumThickness" });
  // A million by mistake: says what it would cost, before it is cut.
  expectError<ParameterError>(mass,
    { jointSet(0.0, 0.0, 0.03), jointSet(90.0, 0.0, 0.03), jointSet(90.0, 90.0, 0.03) }, {},
    { "1030301 blocks", "MaximumRocks, which is 100000", "8.3 GB" });
  MassCut how;
  how.leastThickness = nan;
  expectError<ParameterError>(mass, { good }, how, { "MinimumThickness is nan" });
  how = {};
  how.leastVolume = -1.0;
  expectError<ParameterError>(mass, { good }, how, { "MinimumVolume is -1" });
  how = {};
  how.slivers = SliverRule(3);
  expectError<ParameterError>(mass, { good }, how, { "Slivers is 3" });
}

TEST(JointSets, NoMoreThanMaximumRocks)
{
  const Polyhedron mass = makeBox(Vec3(3.0, 3.0, 3.0));
  MassCut how;
  how.slivers = SliverRule::Keep;
  how.mostBlocks = 27;
  const std::vector<JointSet> cubes = { jointSet(0.0, 0.0, 1.0, 0.5),
    jointSet(90.0, 90.0, 1.0, 0.5), jointSet(90.0, 0.0, 1.0, 0.5) };
  // On average such joints make 64 blocks.
  expectError<ParameterError>(
    mass, cubes, how, { "into some 64 blocks", "MaximumRocks, which is 27", "GB" });
  // Log-normal spacings whose deviation is ten times the mean: most are far less than that.
  const Polyhedron column = makeBox(Vec3(3.0, 3.0, 30.0));
  JointSet close = jointSet(0.0, 0.0, 1.0);
  close.spacingDeviation = 10.0;
  const std::vector<JointSet> sets = { close };
  how.mostBlocks = 1000;
  const std::int64_t count = std::int64_t(cutMass(column, sets, how).blocks.size());
  ASSERT_GT(count, 31); // that many are to be expected
  how.mostBlocks = count;
  EXPECT_EQ(std::int64_t(cutMass(column, sets, how).blocks.size()), count);
  how.mostBlocks = count - 1;
  expectError<ParameterError>(column, sets, how,
    { "joint set 1",
      "270 m³ into more blocks than MaximumRocks, which is " + std::to_string(count - 1),
      "some 31 on average" });
}
