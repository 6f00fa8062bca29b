// The index of boxes against looking at all of them, and what a query costs where boxes are
// crowded.

#include "terrain/BoxIndex.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace rockfall;

namespace
{

constexpr double kWood = 300.0; // m

class Random
{
public:
  double uniform(double a, double b) { return a + (b - a) * (double(engine_() >> 11) * 0x1p-53); }

private:
  std::mt19937_64 engine_{ 5 };
};

/// A wood, and a tree at `far` in both directions if that is not 0.
std::vector<FlatBox> wood(int count, double far, Random& random)
{
  std::vector<FlatBox> boxes;
  for (int k = 0; k < count; ++k)
  {
    const double x = random.uniform(0, kWood), y = random.uniform(0, kWood);
    boxes.push_back({ x - 0.2, x + 0.2, y - 0.2, y + 0.2, random.uniform(10, 30) });
  }
  if (far > 0.0)
  {
    boxes.push_back({ far, far + 0.4, far, far + 0.4, 20.0 });
  }
  return boxes;
}

bool meet(const FlatBox& a, const FlatBox& b)
{
  return a.xMin <= b.xMax && a.xMax >= b.xMin && a.yMin <= b.yMax && a.yMax >= b.yMin;
}

} // namespace

TEST(BoxIndex, FindsWhatLookingAtAllFinds)
{
  Random random;
  for (const double far : { 0.0, 5000.0 })
  {
    std::vector<FlatBox> boxes = wood(400, far, random);
    for (int k = 0; k < 20; ++k) // and long ones, as the faces of an embankment
    {
      const double x = random.uniform(0, kWood), y = random.uniform(0, kWood);
      boxes.push_back({ x, x + random.uniform(0, 80), y, y + random.uniform(0, 5), 40.0 });
    }
    const BoxIndex index(boxes);
    for (int k = 0; k < 300; ++k)
    {
      const double x = random.uniform(-20, kWood), y = random.uniform(-20, kWood);
      const FlatBox query{ x, x + random.uniform(0, 30), y, y + random.uniform(0, 30), 0.0 };
      std::multiset<int> found;
      index.visit(query.xMin, query.xMax, query.yMin, query.yMax, [&](int i) { found.insert(i); });
      double top = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < boxes.size(); ++i)
      {
        EXPECT_LE(found.count(int(i)), 1u);
        if (meet(boxes[i], query))
        {
          EXPECT_EQ(found.count(int(i)), 1u);
          top = std::max(top, boxes[i].top);
        }
      }
      EXPECT_GE(index.top(query.xMin, query.xMax, query.yMin, query.yMax), top);
    }
  }
}

/// One tree by itself, kilometres away, must not make all cells as large as the wood.
TEST(BoxIndex, ALonelyBoxDoesNotSpoilTheCells)
{
  double seen[2] = { 0.0, 0.0 };
  for (int far = 0; far < 2; ++far)
  {
    Random random;
    const BoxIndex index(wood(10000, far * 3000.0, random));
    for (int k = 0; k < 500; ++k)
    {
      const double x = random.uniform(0, kWood), y = random.uniform(0, kWood);
      index.visit(x, x + 3.0, y, y + 3.0, [&](int) { seen[far] += 1.0 / 500.0; });
    }
  }
  // Boxes that a query looks at. The cells are 3 m without it; with it they would be 30 m, with 100
  // boxes each, and are 7.5 m.
  EXPECT_LT(seen[0], 5.0);
  EXPECT_LT(seen[1], 20.0);
}

TEST(BoxIndex, BoxesInOnePlaceAndNone)
{
  EXPECT_EQ(BoxIndex().top(-1, 1, -1, 1), -std::numeric_limits<double>::infinity());
  const std::vector<FlatBox> boxes(1000, FlatBox{ 5.0, 5.0, 7.0, 7.0, 3.0 });
  const BoxIndex index(boxes);
  int found = 0;
  index.visit(4, 6, 6, 8, [&](int) { ++found; });
  EXPECT_EQ(found, 1000);
  index.visit(6, 8, 6, 8, [&](int) { ++found; });
  EXPECT_EQ(found, 1000);
}
