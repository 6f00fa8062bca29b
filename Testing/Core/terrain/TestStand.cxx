// Stems drawn from the numbers of an inventory.

#include "base/errors.h"
#include "form.h"
#include "slopes.h"
#include "terrain/Obstacles.h"
#include "terrain/stand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// A square of one hectare at (0, 0), with a hole of a quarter of it.
Stand hectare(bool hole = false)
{
  const auto square = [](double from, double to) -> std::vector<Vec3> {
    return { { from, from, 0 }, { to, from, 0 }, { to, to, 0 }, { from, to, 0 } };
  };
  Stand stand;
  stand.feature = 3;
  stand.rings = { square(0.0, 100.0) };
  if (hole)
  {
    stand.rings.push_back(square(25.0, 75.0));
  }
  stand.stemsPerHectare = 400.0;
  stand.diameterMean = 0.32;
  stand.diameterDeviation = 0.12;
  stand.conifers = 0.7;
  return stand;
}

} // namespace

/// Over 200 draws of 400 stems: each figure within 4 standard errors of what was asked for.
TEST(Stand, DensitiesDiametersAndSpecies)
{
  constexpr int draws = 200;
  double sum = 0.0, squares = 0.0, diameters = 0.0, spread = 0.0, conifers = 0.0;
  for (int seed = 1; seed <= draws; ++seed)
  {
    const std::vector<Tree> trees = growStand(hectare(), true, std::uint64_t(seed));
    const double n = double(trees.size());
    sum += n;
    squares += (n - 400.0) * (n - 400.0);
    for (const Tree& tree : trees)
    {
      diameters += tree.diameter;
      spread += (tree.diameter - 0.32) * (tree.diameter - 0.32);
      conifers += tree.capacity < 1.3 * stemCapacity(tree.diameter) ? 1.0 : 0.0;
    }
  }
  EXPECT_NEAR(sum / draws, 400.0, 4.0 * std::sqrt(400.0 / draws));
  EXPECT_NEAR(squares / draws / 400.0, 1.0, 4.0 * std::sqrt(2.0 / draws)); // as Poisson's
  EXPECT_NEAR(diameters / sum, 0.32, 4.0 * 0.12 / std::sqrt(sum));
  const double shape = std::pow(0.32 / 0.12, 2); // its excess is 6 / shape
  EXPECT_NEAR(spread / sum / (0.12 * 0.12), 1.0, 4.0 * std::sqrt((2.0 + 6.0 / shape) / sum));
  EXPECT_NEAR(conifers / sum, 0.7, 4.0 * std::sqrt(0.21 / sum));
}

TEST(Stand, PlacesKeepTheirDistanceAndTheHole)
{
  Stand stand = hectare(true);
  stand.spacing = 2.0;
  const std::vector<Tree> trees = growStand(stand, false);
  EXPECT_NEAR(double(trees.size()), 300.0, 4.0 * std::sqrt(300.0));
  for (std::size_t a = 0; a < trees.size(); ++a)
  {
    const Eigen::Vector2d& p = trees[a].position;
    EXPECT_FALSE(p.x() > 25.0 && p.x() < 75.0 && p.y() > 25.0 && p.y() < 75.0);
    EXPECT_TRUE(std::isinf(trees[a].capacity));
    for (std::size_t b = 0; b < a; ++b)
    {
      EXPECT_GE((trees[b].position - p).norm(), 2.0);
    }
  }
  const std::vector<Tree> again = growStand(stand, false);
  ASSERT_EQ(again.size(), trees.size());
  EXPECT_EQ(again.back().position, trees.back().position);
  EXPECT_EQ(again.back().diameter, trees.back().diameter);
  stand.spacing = 10.0;
  EXPECT_THROW(growStand(stand, false), DataError);
  stand.stemsPerHectare = 1e9;
  EXPECT_THROW(growStand(stand, false), DataError);
}

/// A cube of 1 m that flies straight through a stand meets the stems that reach into its way: 2 %
/// of an independent count over all stems, and as many as density times width times way.
TEST(Stand, StemsMetAreThoseOfARayCount)
{
  Stand stand = hectare();
  stand.stemsPerHectare = 1000.0;
  std::vector<Tree> trees = growStand(stand, true);
  std::erase_if(trees, [](const Tree& tree) { return tree.position.x() < 12.0; }); // starts free
  double width = 0.0;
  for (Tree& tree : trees)
  {
    tree.capacity = 0.0; // takes nothing, so that the way is straight
    width += 1.0 + tree.diameter;
  }
  Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  Structures structures;
  structures.trees = trees;
  terrain.setStructures(structures);
  SimulationParameters parameters;
  parameters.rigid = true;
  parameters.endTime = 0.8;
  std::size_t met = 0, counted = 0;
  for (int ray = 0; ray < 40; ++ray)
  {
    Rock rock;
    rock.shape = makeShape(Shape::Cube, 1.0);
    rock.position = Vec3(10.0, 10.0 + 2.0 * ray, 115.0);
    rock.velocity = Vec3(100.0, 0.0, 0.0);
    met += simulate(terrain, rock, parameters).structures.size();
    for (std::size_t k = 0; k < trees.size(); ++k)
    {
      const Eigen::Vector2d& p = trees[k].position;
      counted += std::abs(p.y() - rock.position.y()) < 0.5 * (1.0 + trees[k].diameter) &&
          p.x() - 0.5 * trees[k].diameter < 90.5
        ? 1
        : 0;
    }
  }
  EXPECT_GT(counted, 300u);
  EXPECT_NEAR(double(met), double(counted), 0.02 * double(counted));
  const double expected = 0.1 * (width / double(trees.size())) * 78.5 * 40.0;
  EXPECT_NEAR(double(counted), expected, 4.0 * std::sqrt(expected) + 0.02 * expected);
}

/// Cubes of 0.3 m thrown through a stand are held as often as by stems listed one by one, which
/// another generator draws: within the 95 % interval of the difference.
TEST(Stand, HoldsAsManyAsItsStemsOneByOne)
{
  const int draws = someOf(30, 4);
  constexpr int rays = 40;
  Stand stand = hectare();
  stand.stemsPerHectare = 300.0;
  Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  SimulationParameters parameters;
  parameters.rigid = true;
  parameters.endTime = 1.7;
  const auto passed = [&](std::vector<Tree> trees)
  {
    std::erase_if(trees, [](const Tree& tree) { return tree.position.x() < 12.0; }); // starts free
    Structures structures;
    structures.trees = std::move(trees);
    terrain.setStructures(structures);
    int count = 0;
    for (int ray = 0; ray < rays; ++ray)
    {
      Rock rock;
      rock.shape = makeShape(Shape::Cube, 0.027);
      rock.position = Vec3(10.0, 10.0 + 2.0 * ray, 117.0);
      rock.velocity = Vec3(55.0, 0.0, 0.0); // 102 kJ; a stem of 32 cm takes 116 kJ × factor
      count += simulate(terrain, rock, parameters).summary.stop.x() > 80.0 ? 1 : 0;
    }
    return count;
  };
  std::mt19937 random(4);
  std::poisson_distribution<int> number(300.0);
  std::uniform_real_distribution<double> place(0.0, 100.0), species(0.0, 1.0);
  const double shape = std::pow(0.32 / 0.12, 2);
  std::gamma_distribution<double> diameter(shape, 0.32 / shape);
  double drawn = 0.0, listed = 0.0;
  for (int k = 1; k <= draws; ++k)
  {
    drawn += passed(growStand(stand, true, std::uint64_t(k)));
    std::vector<Tree> trees(std::size_t(number(random)));
    for (Tree& tree : trees)
    {
      tree.position.x() = place(random);
      tree.position.y() = place(random);
      tree.diameter = diameter(random);
      tree.capacity = stemCapacity(tree.diameter, species(random) < 0.7 ? 0.9 : 1.7);
    }
    listed += passed(std::move(trees));
  }
  const double all = draws * rays;
  EXPECT_GT(listed / all, 0.1);
  EXPECT_LT(listed / all, 0.9);
  const double p = 0.5 * (drawn + listed) / all;
  EXPECT_NEAR(drawn / all, listed / all, 1.96 * std::sqrt(2.0 * p * (1.0 - p) / all));
  RecordProperty("Passed", std::to_string(drawn / all) + ", " + std::to_string(listed / all));
}
