// Which spheres overlap, against all pairs one by one.

#include "contact/pair/broadPhase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace rockfall;

namespace
{

bool overlap(const BroadBox& a, const BroadBox& b)
{
  return (a.center - b.center).norm() <= a.radius + b.radius;
}

/// Spheres of 0.05 m up to `ratio` times that in a cube; every seventh is gone, a third lies still.
std::vector<BroadBox> spheres(int count, double ratio, double width, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<BroadBox> boxes(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    boxes[i].center = width * Vec3(u(random) - 0.5, u(random) - 0.5, u(random) - 0.5);
    boxes[i].radius = 0.05 * std::pow(ratio, std::pow(u(random), 3.0));
    boxes[i].present = i % 7 != 3;
    boxes[i].moves = i % 3 != 0;
  }
  return boxes;
}

} // namespace

TEST(BroadPhase, PairsAreThoseWhoseSpheresOverlap)
{
  for (const double ratio : { 1.0, 1.5, 100.0 })
  {
    const std::vector<BroadBox> boxes = spheres(700, ratio, ratio > 2.0 ? 10.0 : 1.0, 1);
    std::vector<std::array<int, 2>> expected;
    for (int i = 0; i < 700; ++i)
    {
      for (int j = i + 1; j < 700; ++j)
      {
        const BroadBox &a = boxes[std::size_t(i)], &b = boxes[std::size_t(j)];
        if (a.present && b.present && (a.moves || b.moves) && overlap(a, b))
        {
          expected.push_back({ i, j });
        }
      }
    }
    EXPECT_GT(expected.size(), 500u) << ratio;
    EXPECT_EQ(findNear(boxes), expected) << ratio;
  }
}

TEST(BroadPhase, WithinABallAreThoseWhoseSpheresOverlapIt)
{
  for (const double ratio : { 1.0, 100.0 })
  {
    const std::vector<BroadBox> boxes = spheres(500, ratio, 5.0, 2);
    BroadPhase map;
    map.place(boxes);
    std::size_t all = 0;
    for (const BroadBox& ball : spheres(50, 100.0, 6.0, 3))
    {
      std::vector<int> expected, found;
      for (int i = 0; i < 500; ++i)
      {
        if (boxes[std::size_t(i)].present && overlap(boxes[std::size_t(i)], ball))
        {
          expected.push_back(i);
        }
      }
      map.within(ball.center, ball.radius, found);
      EXPECT_EQ(found, expected) << ratio;
      all += found.size();
    }
    EXPECT_GT(all, 100u) << ratio;
  }
}

TEST(BroadPhase, SpheresFarApartAndNone)
{
  EXPECT_TRUE(findNear({}).empty());
  std::vector<BroadBox> boxes(4);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    boxes[i].radius = 0.01;
    boxes[i].center = Vec3(1e6 * double(i / 2) + 0.015 * double(i % 2), -1e6 * double(i / 2), 0.0);
  }
  const std::vector<std::array<int, 2>> expected = { { 0, 1 }, { 2, 3 } };
  EXPECT_EQ(findNear(boxes), expected);
  for (BroadBox& box : boxes)
  {
    box.present = false;
  }
  EXPECT_TRUE(findNear(boxes).empty());
}
