// The search for contacts (METHOD 5): with the index its cost does not grow with the slope; by
// brute force it does. What is gathered decides the test; time is reported.

#include "verification.h"

#include "bruteForce.h"
#include "contact/ground/detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

using namespace rockfall;
using namespace rockfall::testing;
using namespace rockfall::verification;

namespace
{

/// Gently rough, so that there are ridges and peaks; the same everywhere.
Terrain roughGround(int nodes)
{
  return rockfall::testing::makeSlope(
    nodes, 1.0, [](double x, double y) { return 0.1 * std::sin(2.0 * x) * std::cos(1.7 * y); },
    surface(0.8, 15.0));
}

struct Search
{
  std::size_t triangles = 0, contacts = 0;
  double microseconds = 0.0; ///< Per call, the quickest of several rounds.
};

BlockState standing(const Terrain& terrain)
{
  BlockState state;
  const double middle = std::floor(0.5 * terrain.width()) + 0.3;
  state.position = Vec3(middle, middle, 0.62);
  state.orientation = uniformAttitude(0.3, 0.1, 0.8);
  return state;
}

Search indexed(const Terrain& terrain)
{
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.1);
  const Surface ground = Surface::asSurveyed(terrain);
  const BlockState state = standing(terrain);
  Search search;
  search.microseconds = 1e300;
  constexpr int kCalls = 2000;
  constexpr double kReach = 0.3; // m
  for (int round = 0; round < 9; ++round)
  {
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < kCalls; ++k)
    {
      PlacedBlock placed;
      placed.place(block, state);
      const Vec3 lower = placed.lower(), upper = placed.upper();
      SurfacePatch patch;
      gatherPatch(ground, lower.x() - kReach, upper.x() + kReach, lower.y() - kReach,
        upper.y() + kReach, patch);
      CandidatePairs candidates;
      gatherCandidates(placed, state, patch, kReach, candidates);
      std::vector<Contact> contacts;
      updateContacts(placed, patch, candidates, kReach, contacts);
      search.triangles = patch.triangles.size();
      search.contacts = contacts.size();
    }
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
    search.microseconds = std::min(search.microseconds, took.count() / kCalls);
  }
  return search;
}

Search bruteForce(const Terrain& terrain)
{
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.1);
  SurfacePatch whole;
  gatherPatch(Surface::asSurveyed(terrain), 0.0, terrain.width(), 0.0, terrain.height(), whole);
  PlacedBlock placed;
  placed.place(block, standing(terrain));
  Search search;
  search.microseconds = 1e300;
  for (int round = 0; round < 3; ++round)
  {
    const auto begin = std::chrono::steady_clock::now();
    std::vector<Contact> contacts;
    findEntrancesBruteForce(placed, whole, 0.3, contacts);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
    search.microseconds = std::min(search.microseconds, took.count());
    search.triangles = whole.triangles.size();
    search.contacts = contacts.size();
  }
  return search;
}

} // namespace

TEST(Search, CostDoesNotGrowWithTheSlope)
{
  const std::string subject = "CFE search";
  std::vector<double> cells, indexTimes, bruteCells, bruteTimes;
  Search smallest, largest;
  for (int nodes : { 11, 33, 101, 317, 1001 })
  {
    const Terrain terrain = roughGround(nodes);
    const double count = double(terrain.geometry().cellCount());
    const Search search = indexed(terrain);
    (cells.empty() ? smallest : largest) = search;
    cells.push_back(count);
    indexTimes.push_back(search.microseconds);
    report({ subject, "time per call with the index, " + text(count) + " cells", "µs",
             "quickest round of nine; never decides" },
      search.microseconds);
    if (nodes <= 101)
    {
      const Search brute = bruteForce(terrain);
      EXPECT_EQ(brute.contacts, search.contacts) << "the index has to find what brute force finds";
      bruteCells.push_back(count);
      bruteTimes.push_back(brute.microseconds);
    }
  }
  addCurve("search", "with the index", cells, indexTimes);
  addCurve("search", "brute force", bruteCells, bruteTimes);
  record(
    { subject, "CFEs looked at, 1e6 cells over 1e2 cells", "", "the same place, the same CFEs" },
    double(largest.triangles) / double(smallest.triangles), 1.0, 0.0);
  report({ subject, "time with the index, 1e6 cells over 1e2 cells", "",
           "1 within 10 % on a quiet machine; never decides" },
    indexTimes.back() / indexTimes.front(), 1.0);
  report({ subject, "time by brute force, growth per growth of the slope (exponent)", "",
           "1: linear; never decides" },
    observedOrder(bruteCells, bruteTimes), 1.0);
}
