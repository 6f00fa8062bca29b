// Annual frequencies by hand: frequencies are sums of powers of two, so that sums are exact.

#include "base/errors.h"
#include "statistics/HazardRaster.h"
#include "statistics/frequency.h"
#include "statistics/rockReleases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

using namespace rockfall;

namespace
{

constexpr double kJ = 1000.0;
const std::vector<double> swiss = { 30 * kJ, 300 * kJ };

Passage passageOf(std::uint32_t cell, int iteration, int rock, double energy)
{
  Passage passage;
  passage.cell = cell;
  passage.iteration = iteration;
  passage.rock = rock;
  passage.maxima = { float(energy), 1.0, 1.0, 1.0 };
  return passage;
}

/// Ten rocks of two sources in two iterations: 0 to 4 of the upper source, 5 to 9 of the lower one.
/// Classes of volume: 0, 1, 5, 6, 7 small (1/4 a year), 2, 3, 8 medium (1/16), 4, 9 large (1/64).
constexpr std::array<double, 10> yearly = { 0.25, 0.25, 0.0625, 0.0625, 0.015625, 0.25, 0.25, 0.25,
  0.0625, 0.015625 };

RockReleases release()
{
  RockReleases rocks;
  for (int iteration = 0; iteration < 2; ++iteration)
  {
    for (int rock = 0; rock < 10; ++rock)
    {
      rocks.add(rock, 0, { .frequency = yearly[std::size_t(rock)] });
    }
  }
  return rocks;
}

std::vector<Passage> passages()
{
  const double inf = std::numeric_limits<double>::infinity();
  return { // Cell 3: small ones below 30 kJ, a medium one at 30 kJ, a large one twice above 300 kJ.
    passageOf(3, 0, 0, 10 * kJ), passageOf(3, 0, 2, 30 * kJ), passageOf(3, 0, 4, 400 * kJ),
    passageOf(3, 1, 0, 29.999 * kJ), passageOf(3, 1, 4, 300 * kJ),
    // Cell 7: one rock of unknown energy, one large one of the lower source.
    passageOf(7, 0, 5, -inf), passageOf(7, 1, 9, 299 * kJ)
  };
}

std::vector<CellFrequency> cellsOf(const std::vector<Passage>& sorted,
  const std::vector<double>& thresholds, const RockReleases& rocks = release())
{
  std::vector<CellFrequency> cells;
  FrequencySummarizer summarizer(
    thresholds, [&rocks](const Passage& passage) { return rocks.weight(passage); },
    [&cells](const CellFrequency& cell) { cells.push_back(cell); });
  for (const Passage& passage : sorted)
  {
    summarizer.add(passage);
  }
  summarizer.finish();
  return cells;
}

} // namespace

TEST(Frequency, RocksOfOneSampleThatDiffer)
{
  FrequencyRange range;
  EXPECT_FALSE(range.differs());
  range.add(0.1);
  range.add(std::numeric_limits<double>::quiet_NaN());
  range.add(0.3 - 0.2); // the same but for rounding
  EXPECT_TRUE(range.notes().empty());
  range.add(0.4);
  ASSERT_EQ(range.notes().size(), 1u);
  EXPECT_NE(range.notes()[0].find("by up to 4 times"), std::string::npos) << range.notes()[0];

  // Each cell by itself: two sources that do not meet are no reason for a note.
  const auto differing = [](std::initializer_list<Passage> passed)
  {
    const RockReleases rocks = release();
    FrequencySummarizer summarizer(
      {}, [&](const Passage& passage) { return rocks.weight(passage); },
      [](const CellFrequency&) {});
    for (const Passage& passage : passed)
    {
      summarizer.add(passage);
    }
    summarizer.finish();
    return summarizer.differing().differs();
  };
  EXPECT_TRUE(differing({ passageOf(3, 0, 0, kJ), passageOf(3, 0, 4, kJ) }));
  EXPECT_FALSE(differing({ passageOf(3, 0, 0, kJ), passageOf(4, 0, 4, kJ) }));
}

/// What a rock counts is its frequency over its releases: rocks as frequent as each other of ten
/// iterations and of forty.
TEST(Frequency, WeightsOfUnlikeReleases)
{
  RockReleases rocks;
  rocks.add(0, 0, { .iterations = 10, .frequency = 0.5 });
  rocks.add(0, 9, { .iterations = 40, .frequency = 0.5 });
  EXPECT_EQ(rocks.weight(0, 9), 0.0125);
  EXPECT_TRUE(std::isnan(rocks.weight(1, 0)));
  rocks.add(1, 0, {}); // of no frequency that is known
  EXPECT_TRUE(std::isnan(rocks.weight(1, 0)));
  const std::vector<std::string> notes = rocks.weights().notesOnShares();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].rfind("Rocks that are released differ in their frequencies, by up to 4 times, "
                           "but shares at lines count each rock alike",
              0),
    0u)
    << notes[0];
}

TEST(Frequency, OfCellsByHand)
{
  const auto cells = cellsOf(passages(), swiss);
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].cell, 3u);
  EXPECT_EQ(cells[0].rocks, (std::vector<std::int64_t>{ 5, 3, 2 }));
  // Rock 0 came in both iterations: 1/4. Rock 2 in one of two: 1/32. Rock 4 in both: 1/64.
  EXPECT_EQ(cells[0].frequencies,
    (std::vector<double>{ 1.0 / 4 + 1.0 / 32 + 1.0 / 64, 1.0 / 32 + 1.0 / 64, 1.0 / 64 }));
  EXPECT_EQ(cells[1].cell, 7u);
  EXPECT_EQ(cells[1].rocks, (std::vector<std::int64_t>{ 2, 1, 0 }));
  EXPECT_EQ(cells[1].frequencies, (std::vector<double>{ 1.0 / 8 + 1.0 / 128, 1.0 / 128, 0.0 }));
  // Classes of cell 3: 0.297, 0.047, 0.0156 a year are periods of 3.4, 21.3 and 64 years.
  EXPECT_EQ(intensityClass(cells[0].frequencies, 3.0), 0);
  EXPECT_EQ(intensityClass(cells[0].frequencies, 20.0), 1);
  EXPECT_EQ(intensityClass(cells[0].frequencies, 30.0), 2);
  EXPECT_EQ(intensityClass(cells[0].frequencies, 64.0), 3);
}

TEST(Frequency, ExclusiveClassesAddUpToReach)
{
  for (const CellFrequency& cell : cellsOf(passages(), swiss))
  {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      sum += cell.frequencies[k] - (k < 2 ? cell.frequencies[k + 1] : 0.0);
    }
    EXPECT_EQ(sum, cell.frequencies[0]);
  }
}

TEST(Frequency, RoundingMakesNoClass)
{
  const std::vector<double> ten(10, 0.001);
  double sum = 0.0;
  for (const double one : ten)
  {
    sum += one;
  }
  EXPECT_EQ(intensityClass(std::array{ sum }, 100.0), 1);
  EXPECT_EQ(intensityClass(std::array{ 0.00999 }, 100.0), 0);
}

TEST(Frequency, PartsGiveTheSameBits)
{
  // Frequencies that are no sums of powers of two: the order of the sum shows in the last bit.
  std::vector<Passage> all;
  RockReleases rocks;
  for (int rock = 0; rock < 50; ++rock)
  {
    rocks.add(rock, 0, { .frequency = 0.1 / (rock + 3) });
    all.push_back(passageOf(std::uint32_t(rock % 2), 0, rock, rock * 10 * kJ));
  }
  const auto of = [&rocks](std::vector<Passage> parts)
  {
    std::sort(parts.begin(), parts.end());
    return cellsOf(parts, swiss, rocks);
  };
  std::vector<Passage> parts(all.begin() + 20, all.end());
  parts.insert(parts.end(), all.begin(), all.begin() + 20);
  std::reverse(parts.begin(), parts.end());
  const auto whole = of(all), shared = of(parts);
  ASSERT_EQ(whole.size(), shared.size());
  for (std::size_t k = 0; k < whole.size(); ++k)
  {
    EXPECT_EQ(whole[k].rocks, shared[k].rocks);
    EXPECT_EQ(whole[k].frequencies, shared[k].frequencies);
  }
}

TEST(Frequency, PowerLawIsTheIntegralOfItsDensity)
{
  EXPECT_EQ(powerLawFrequency(2.0, 1.0, 0.5, 4.0), 2.0 * (2.0 - 0.25));
  EXPECT_EQ(powerLawFrequency(2.0, 1.0, 4.0, std::numeric_limits<double>::infinity()), 0.5);
  // Simpson's rule over ln V of the density A B V^(−B − 1), so of A B V^−B.
  const double a = 0.3, b = 0.6, v1 = 0.2, v2 = 50.0;
  const int steps = 2000;
  const double width = std::log(v2 / v1) / steps;
  double sum = 0.0;
  for (int k = 0; k <= steps; ++k)
  {
    const double factor = k == 0 || k == steps ? 1.0 : k % 2 ? 4.0 : 2.0;
    sum += factor * a * b * std::pow(v1 * std::exp(k * width), -b);
  }
  EXPECT_NEAR(powerLawFrequency(a, b, v1, v2), sum * width / 3.0, 1e-12); // O(width⁴)
  EXPECT_THROW(powerLawFrequency(1.0, 0.0, 1.0, 2.0), ParameterError);
  EXPECT_THROW(powerLawFrequency(1.0, 1.0, 2.0, 1.0), ParameterError);
}

TEST(Frequency, ProbabilityWithinYears)
{
  EXPECT_EQ(probabilityWithin(0.0, 100.0), 0.0);
  EXPECT_DOUBLE_EQ(probabilityWithin(0.01, 100.0), 1.0 - std::exp(-1.0));
  EXPECT_DOUBLE_EQ(probabilityWithin(1e-20, 1.0), 1e-20); // 1 − exp(−f t) would be 0
}

TEST(Frequency, BadFrequencies)
{
  RockReleases rocks;
  rocks.add(1, 0, { .frequency = 0.5 });
  rocks.add(1, 9, { .frequency = 0.125 }); // of another run
  EXPECT_EQ(rocks.weight(passageOf(0, 0, 1, 0.0)), 0.5);
  EXPECT_THROW(rocks.add(1, 0, { .frequency = 0.25 }), DataError);
  EXPECT_THROW(rocks.add(2, 0, { .frequency = -1.0 }), DataError);
  EXPECT_THROW(rocks.add(2, 0, { .frequency = std::nan("") }), DataError);
  EXPECT_THROW(rocks.weight(passageOf(0, 0, 7, 0.0)), DataError);
}
