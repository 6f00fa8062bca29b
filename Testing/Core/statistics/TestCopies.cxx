// Rocks of several runs counted together: by hand.

#include "statistics/copies.h"
#include "statistics/sourceReach.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <utility>
#include <vector>

using namespace rockfall;

namespace
{

using Numbered = std::pair<int, std::int64_t>;

/// Rocks 0 … count − 1 with blocks from `first` on.
void append(std::vector<Numbered>& rocks, int count, std::int64_t first)
{
  for (int rock = 0; rock < count; ++rock)
  {
    rocks.emplace_back(rock, first + rock);
  }
}

} // namespace

TEST(RockRuns, OneRunWhateverItsBlocks)
{
  EXPECT_EQ(RockRuns().count(), 1);
  const RockRuns runs({ { 0, 7 }, { 1, 7 }, { 2, 5 }, { 3, 9 }, { 0, 7 } });
  EXPECT_EQ(runs.count(), 1);
  EXPECT_EQ(runs.of(2, 5), 0);
  EXPECT_FALSE(runs.hasSeveral(0));
}

TEST(RockRuns, BlocksOfOneNumberAreOfTwoRuns)
{
  std::vector<Numbered> rocks;
  append(rocks, 5, 100);
  append(rocks, 3, 0);
  const RockRuns runs(rocks);
  EXPECT_EQ(runs.count(), 2);
  for (int rock = 0; rock < 5; ++rock)
  {
    EXPECT_EQ(runs.of(rock, 100 + rock), 1);
    EXPECT_EQ(runs.hasSeveral(rock), rock < 3);
  }
  EXPECT_EQ(runs.of(2, 2), 0);
  EXPECT_FALSE(runs.hasSeveral(9));
}

TEST(RockRuns, BlocksThatLieAmongThoseOfAnotherRun)
{
  std::vector<Numbered> rocks;
  append(rocks, 10, 0);
  append(rocks, 10, 5);                                           // blocks 5 to 9 are of both
  rocks.insert(rocks.end(), { { 0, 50 }, { 1, 51 }, { 4, 54 } }); // some left out
  const RockRuns runs(rocks);
  EXPECT_EQ(runs.count(), 3);
  for (int rock = 0; rock < 10; ++rock)
  {
    EXPECT_EQ(runs.of(rock, rock), 0);
    EXPECT_EQ(runs.of(rock, 5 + rock), 1);
  }
  EXPECT_EQ(runs.of(4, 54), 2);
}

TEST(Copies, RocksWithTheSameInAllThatIsKnownOfThem)
{
  Copies copies;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::int64_t block : { 10, 30, 20 })
  {
    // In any order; rock 1 of block 20 differs in the last bit of one number.
    for (const double cell : block == 30 ? std::array{ 8.0, 3.0 } : std::array{ 3.0, 8.0 })
    {
      copies.add(0, 0, block, std::array{ cell, 0.1, nan });
      copies.add(1, 0, block, std::array{ cell, block == 10 ? 0.1 : 0.2 });
      copies.add(0, 1, block, std::array{ cell, block == 20 && cell == 8.0 ? 0.1 + 0x1p-56 : 0.1 });
    }
  }
  copies.add(0, 2, 30, std::array{ 3.0, 0.1 }); // in one run alone
  EXPECT_EQ(copies.count(), 2 + 1 + 1);
  EXPECT_TRUE(copyNotes(0).empty());
  ASSERT_EQ(copyNotes(4).size(), 1u);
  EXPECT_EQ(copyNotes(4)[0].rfind("4 rocks fell exactly as another one of their iteration", 0), 0u);
}

TEST(Copies, OtherNumbersAndIterationsAreNone)
{
  Copies copies;
  for (int k = 0; k < 5; ++k)
  {
    copies.add(0, k, k, std::array{ 1.0, 2.0 });
    copies.add(k + 1, 0, k, std::array{ 1.0, 2.0 });
  }
  EXPECT_EQ(copies.count(), 0);
}

/// Source 0 of a run of two rocks, and source 0 of one of two hundred.
TEST(SourceReach, SourcesOfTwoRunsAreTwo)
{
  RockReleases rocks;
  for (int rock = 0; rock < 200; ++rock)
  {
    if (rock < 2)
    {
      rocks.add(rock, 1000 + rock, { .iterations = 1, .source = 0 });
    }
    rocks.add(rock, rock, { .iterations = 1, .source = 0 });
  }
  SourceReach reach(rocks);
  Passage passage;
  passage.rock = 1;
  passage.blockId = 1001;
  reach.add(passage);
  EXPECT_EQ(reach.take(), 0.5);
  passage.blockId = 1;
  reach.add(passage);
  EXPECT_EQ(reach.take(), 1.0 / 200.0);
}
