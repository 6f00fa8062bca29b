/// @file
/// Densities and frequencies that look as if they were in another unit.

#include "rock/plausibleRocks.h"

#include <gtest/gtest.h>

namespace rockfall
{

TEST(PlausibleRocks, DensityAndFrequency)
{
  std::vector<Rock> rocks(3);
  rocks[2].blockId = 7;
  const auto notes = [&rocks](std::vector<double> frequencies)
  {
    std::vector<std::string> all;
    askAfterRocks(rocks, frequencies, all);
    return all;
  };
  EXPECT_TRUE(notes({}).empty());
  EXPECT_TRUE(notes({ 10.0, 10.0, 1.0 }).empty());
  EXPECT_EQ(notes(std::vector<double>(3, 1e-9)).size(), 1u);
  rocks[2].density = 2.7; // t/m³
  EXPECT_EQ(notes({ 1000.0, 300.0, 100.0 }),
    std::vector<std::string>({ "1 of 3 densities of rocks look implausible, first block 7 with 2.7 "
                               "kg/m³. Rocks have 500 to 5500 kg/m³: is it in kg/m³?",
      "The rocks together fall 1400 times a year: are frequencies rocks per year, not return "
      "periods?" }));
}

} // namespace rockfall
