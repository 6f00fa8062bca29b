/// @file
/// Rocks that start in the air, as those of another slope do, and those that may.

#include "run/releaseHeights.h"
#include "slopes.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// A cube of 2 m, its lower side so high over flat ground.
Rock cubeAt(std::int64_t block, double x, double gap, double speed = 0.0)
{
  Rock rock;
  rock.blockId = block;
  rock.shape = makeBox({ 2.0, 2.0, 2.0 });
  rock.position = { x, 20.0, 51.0 + gap };
  rock.velocity = { speed, 0.0, 0.0 };
  return rock;
}

std::vector<std::string> notesOf(const std::vector<Rock>& rocks)
{
  std::vector<std::string> notes;
  askAfterHeights(makeSlope(21, 5.0, [](double, double) { return 50.0; }), rocks, notes);
  return notes;
}

} // namespace

TEST(ReleaseHeights, RocksOfAnotherSlopeAreTold)
{
  EXPECT_TRUE(notesOf({ cubeAt(1, 20.0, 0.0), cubeAt(2, 40.0, 9.9) }).empty());
  EXPECT_EQ(notesOf({ cubeAt(1, 20.0, 0.0), cubeAt(2, 40.0, 30.0), cubeAt(3, 60.0, 30.0) }),
    std::vector<std::string>({ "2 of 3 heights of rocks over the ground look implausible, first "
                               "block 2 at 30 m. Rocks start up to 10 m over the ground or other "
                               "rocks: do their heights belong to this slope?" }));
}

TEST(ReleaseHeights, RocksInFlightAndOnOtherRocksMayBeHigh)
{
  EXPECT_TRUE(notesOf({ cubeAt(1, 40.0, 30.0, 12.0) }).empty());
  std::vector<Rock> tower;
  for (int k = 0; k < 16; ++k)
  {
    tower.push_back(cubeAt(k, 40.0, 2.0 * k));
  }
  EXPECT_TRUE(notesOf(tower).empty());
  // A tower in the air hangs by its lowest block.
  for (Rock& rock : tower)
  {
    rock.position.z() += 30.0;
  }
  const auto notes = notesOf(tower);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].find("1 of 16 heights of rocks"), 0u) << notes[0];
}
