// Parallels of a line.

#include "base/errors.h"
#include "statistics/familyOfLines.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;

namespace
{

CollectorLine roadOf(std::vector<Eigen::Vector2d> points)
{
  CollectorLine line;
  line.name = "road";
  line.points = std::move(points);
  line.barrierHeight = 3.0;
  return line;
}

std::string errorOf(CollectorLine line, int count, double spacing)
{
  std::vector<CollectorLine> lines = { std::move(line) };
  try
  {
    addParallels(lines, count, spacing);
  }
  catch (const ParameterError& error)
  {
    return error.what();
  }
  return "none";
}

} // namespace

TEST(FamilyOfLines, ARightAngleKeepsItsDistance)
{
  // East, then north: the left is inside of the bend.
  std::vector<CollectorLine> lines = { roadOf({ { 0, 0 }, { 10, 0 }, { 10, 20 } }),
    roadOf({ { 0, 0 }, { 5, 0 } }) };
  addParallels(lines, 2, 2.0);
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[0].offset, 0.0);
  EXPECT_EQ(lines[2].offset, 4.0);
  EXPECT_EQ(lines[2].name, "road +4 m");
  EXPECT_EQ(lines[2].barrierHeight, 3.0);
  const Eigen::Vector2d expected[] = { { 0, 4 }, { 6, 4 }, { 6, 20 } };
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_LT((lines[2].points[std::size_t(k)] - expected[k]).norm(), 1e-12);
  }
  EXPECT_LT((lines[5].points[1] - Eigen::Vector2d(5, 4)).norm(), 1e-12);
}

TEST(FamilyOfLines, AClosedLineHasAClosedParallel)
{
  // A house, clockwise: its left is outside.
  std::vector<CollectorLine> lines = { roadOf(
    { { 0, 0 }, { 0, 20 }, { 10, 20 }, { 10, 0 }, { 0, 0 } }) };
  addParallels(lines, 1, 5.0);
  const Eigen::Vector2d expected[] = { { -5, -5 }, { -5, 25 }, { 15, 25 }, { 15, -5 }, { -5, -5 } };
  ASSERT_EQ(lines[1].points.size(), 5u);
  for (int k = 0; k < 5; ++k)
  {
    EXPECT_LT((lines[1].points[std::size_t(k)] - expected[k]).norm(), 1e-12) << k;
  }
  EXPECT_EQ(lines[1].points.front(), lines[1].points.back()); // to the last bit
}

TEST(FamilyOfLines, WhatHasNoParallel)
{
  const CollectorLine bent = roadOf({ { 0, 0 }, { 10, 0 }, { 10, 20 } });
  EXPECT_EQ(errorOf(bent, 1, 9.9), "none");
  EXPECT_NE(errorOf(bent, 1, 10.1).find("piece 1 is too short"), std::string::npos);
  EXPECT_EQ(errorOf(bent, 1, -30.0), "none");
  EXPECT_NE(
    errorOf(roadOf({ { 0, 0 }, { 10, 0 }, { 0, 0.1 } }), 1, 1.0).find("turns back at its point 2"),
    std::string::npos);
  EXPECT_NE(errorOf(bent, 1, 0.0).find("ParallelSpacing is 0"), std::string::npos);
  EXPECT_NE(errorOf(bent, -1, 1.0).find("ParallelLines is -1"), std::string::npos);
  EXPECT_NE(errorOf(bent, 1000, 1.0).find("1000 at most"), std::string::npos);
  EXPECT_EQ(errorOf(bent, 0, NAN), "none");
}
