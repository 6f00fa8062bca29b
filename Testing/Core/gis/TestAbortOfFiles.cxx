#include "gis/raster/raster.h"
#include "gis/raster/tin.h"
#include "gisFiles.h"
#include "patience.h"
#include "run/releasePlaces.h"
#include "slopes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

using namespace rockfall;
using namespace rockfall::testing;

TEST(Abort, OfATriangulation)
{
  gis::TinPoints points;
  for (int k = 0; k < 200000; ++k)
  {
    points.x.push_back(std::fmod(k * 0.754877666, 1.0) * 1000.0);
    points.y.push_back(std::fmod(k * 0.569840291, 1.0) * 1000.0);
    points.z.push_back(k % 100);
  }
  GridGeometry target;
  target.columns = target.rows = 10;
  target.cellSize = 100.0;
  const double heard =
    heardAfter([&] { gis::interpolateTin(std::move(points), target, 0.0, 0.0, "points"); });
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
}

TEST(Abort, OfReadingARaster)
{
  constexpr int size = 3000;
  std::string text = "ncols 3000\nnrows 3000\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  for (int row = 0; row < size; ++row)
  {
    for (int column = 0; column < size; ++column)
    {
      text += "12.5 ";
    }
    text += "\n";
  }
  const std::string path = writeFile("large.asc", text);
  const double heard = heardAfter([&] { readRaster(path); });
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
  std::filesystem::remove(path);
}

TEST(Abort, OfSpreadingRocksOverSteepGround)
{
  const Terrain terrain = makePlane(3000, 1.0, radians(40.0), 0.0, material(0.3, 0.3));
  ReleaseDefaults many;
  many.amount = 5'000'000;
  many.mostRocks = 10'000'000;
  const double heard = heardAfter([&] { steepPlaces(terrain, radians(30.0), many); });
  EXPECT_GE(heard, 0.0);
  EXPECT_LE(heard, kHeard);
}
