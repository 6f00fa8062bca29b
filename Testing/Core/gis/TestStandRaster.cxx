// Forests by density from a raster: each cell grows its own stems, and each bad band is told.

#include "base/errors.h"
#include "gis/forest/standRaster.h"
#include "gis/layers/structureLayers.h"
#include "gisFiles.h"
#include "slopes.h"

#include <array>
#include <cmath>
#include <fstream>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr int kSide = 12; // cells of 10 m, one of them beyond the slope on either side
constexpr double kNoData = -1.0;

Terrain site()
{
  return makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
}

using Bands = std::vector<std::vector<float>>;

/// ENVI's raw bands, the north-western corner at −10, 110 + `north`.
std::string raster(const Bands& bands, double north = 0.0, const std::string& header = "")
{
  const std::string name = writeFile("stands.img", "");
  std::ofstream out(name, std::ios::binary);
  for (const std::vector<float>& band : bands)
  {
    out.write(
      reinterpret_cast<const char*>(band.data()), std::streamsize(band.size() * sizeof(float)));
  }
  writeFile("stands.hdr",
    "ENVI\nsamples = 12\nlines = 12\nbands = " + std::to_string(bands.size()) +
      "\nheader offset = 0\nfile type = ENVI Standard\ndata type = 4\ninterleave = bsq\n"
      "byte order = 0\ndata ignore value = -1\nmap info = {Arbitrary, 1, 1, -10, " +
      std::to_string(110.0 + north) + ", 10, 10}\n" + header);
  return name;
}

std::vector<float> all(double value)
{
  return std::vector<float>(kSide * kSide, float(value));
}

StructureFiles treesOf(const std::string& name)
{
  StructureFiles files;
  files.trees = name;
  return files;
}

std::string messageOf(const Bands& bands, double north = 0.0, const std::string& header = "")
{
  std::vector<std::string> notes;
  const std::string name = raster(bands, north, header);
  try
  {
    readStructures(treesOf(name), site(), notes, readStandRaster(name, site(), notes));
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

} // namespace

TEST(StandRaster, EveryCellGrowsItsStems)
{
  // 600 stems of a hectare, or 6 of a cell, in the west; nothing in the east, no data in one row.
  Bands bands = { all(0.0), all(30.0), all(25.0), all(8.0), all(50.0) };
  for (int row = 0; row < kSide; ++row)
  {
    for (int column = 0; column < kSide / 2; ++column)
    {
      bands[0][std::size_t(row * kSide + column)] = float(row == 3 ? kNoData : 600.0);
    }
  }
  const std::string name = raster(bands);
  std::vector<std::string> notes;
  const std::vector<Stand> stands = readStandRaster(name, site(), notes);
  ASSERT_EQ(stands.size(), 9u * 5u); // those over the slope
  const Structures s = readStructures(treesOf(name), site(), notes, stands);
  const double expected = 45.0 * 6.0;
  EXPECT_NEAR(double(s.trees.size()), expected, 4.0 * std::sqrt(expected));
  double sum = 0.0;
  int conifers = 0;
  for (const Tree& tree : s.trees)
  {
    const auto column = int(std::floor((tree.position.x() + 10.0) / 10.0));
    const auto row = int(std::floor((110.0 - tree.position.y()) / 10.0));
    EXPECT_EQ(tree.feature, row * kSide + column + 1);
    EXPECT_LT(column, kSide / 2);
    EXPECT_NE(row, 3);
    EXPECT_EQ(tree.height, 25.0);
    sum += tree.diameter;
    conifers += tree.capacity < 1.01 * stemCapacity(tree.diameter, 0.9);
  }
  const double n = double(s.trees.size());
  EXPECT_NEAR(sum / n, 0.30, 4.0 * 0.08 / std::sqrt(n));
  EXPECT_NEAR(conifers / n, 0.5, 4.0 * 0.5 / std::sqrt(n));

  const Structures again =
    readStructures(treesOf(name), site(), notes, readStandRaster(name, site(), notes));
  ASSERT_EQ(again.trees.size(), s.trees.size());
  EXPECT_EQ(again.trees.back().position, s.trees.back().position);
  EXPECT_EQ(again.trees.back().diameter, s.trees.back().diameter);
}

TEST(StandRaster, ScaleAndOffsetOfBands)
{
  const std::string name = raster({ all(1500.0), all(200.0), all(25.0) }, 0.0,
    "data gain values = {0.1, 0.1, 1}\ndata offset values = {0, 12, 0}\n");
  std::vector<std::string> notes;
  const std::vector<Stand> stands = readStandRaster(name, site(), notes);
  ASSERT_FALSE(stands.empty());
  EXPECT_NEAR(stands[0].stemsPerHectare, 150.0, 1e-9);
  EXPECT_NEAR(stands[0].diameterMean, 0.32, 1e-12);
  EXPECT_EQ(stands[0].height, 25.0);
  const std::vector<std::string> told{ name +
      ": scale 0.1 and offset 0 of band 1 (stems_ha) were applied.",
    name + ": scale 0.1 and offset 12 of band 2 (dbh_mean) were applied." };
  EXPECT_EQ(notes, told);
  EXPECT_NE(messageOf({ all(400.0), all(30.0) }, 0.0, "data gain values = {0, 1}\n")
              .find("band 1 has scale 0 and offset 0"),
    std::string::npos);
}

TEST(StandRaster, BandsThatAreCalledByTheNameOfAnotherPlace)
{
  const Bands bands{ all(150.0), all(20.0), all(32.0) };
  const auto named = [&](const std::string& names)
  { return messageOf(bands, 0.0, "band names = {" + names + "}\n"); };
  EXPECT_TRUE(named("stems_ha, Height (m), dbh_mean")
                .ends_with(": band 2 is called \"Height (m)\", but band 2 of a raster of stands is "
                           "dbh_mean; its bands are stems_ha, dbh_mean, height, dbh_dev, conifers, "
                           "in this order"));
  EXPECT_EQ(named("Stems_ha, DBH mean, height"), "");
  EXPECT_EQ(named("density, diameter, canopy"), "");
}

TEST(StandRaster, BandsInTheUnitOfAnotherPlace)
{
  const std::string name = raster({ all(150.0), all(20.0), all(32.0) });
  const auto inUnits = [&](const std::string& diameter, const std::string& height)
  {
    writeFile("stands.img.aux.xml",
      "<PAMDataset><PAMRasterBand band=\"2\"><UnitType>" + diameter +
        "</UnitType></PAMRasterBand><PAMRasterBand band=\"3\"><UnitType>" + height +
        "</UnitType></PAMRasterBand></PAMDataset>");
    std::vector<std::string> notes;
    return readStandRaster(name, site(), notes);
  };
  EXPECT_FALSE(inUnits("cm", "m").empty());
  EXPECT_FALSE(inUnits("a", "b").empty());
  for (const auto& [diameter, height, said] :
    { std::array{ "m", "m", "band 2 (dbh_mean) has the unit \"m\", it must be in cm" },
      std::array{ "cm", "ft", "band 3 (height) has the unit \"ft\", it must be in m" } })
  {
    EXPECT_EQ(
      rockfall::testing::messageOf<DataError>([&, d = diameter, h = height] { inUnits(d, h); }),
      name + ": " + said);
  }
}

TEST(StandRaster, ATableIsNoRaster)
{
  std::vector<std::string> notes;
  EXPECT_TRUE(
    readStandRaster(writeFile("t.csv", "x,y,diameter,height\n50,50,30,20\n"), site(), notes)
      .empty());
  EXPECT_TRUE(readStandRaster("no such file", site(), notes).empty());
  EXPECT_TRUE(notes.empty());
}

TEST(StandRaster, BadOnesAreTold)
{
  const auto expect = [](const std::string& message, const char* word)
  { EXPECT_NE(message.find(word), std::string::npos) << message; };
  expect(messageOf({ all(400.0) }), "has 1 band; a raster of stands has stems_ha, dbh_mean");
  expect(messageOf({ all(400.0), all(0.3) }), "row 2, column 2: band 2 (dbh_mean) is 0.3");
  expect(messageOf({ all(400.0), all(kNoData) }), "band 2 (dbh_mean) is 0 cm");
  expect(messageOf({ all(-400.0), all(30.0) }), "band 1 (stems_ha) is -400");
  expect(messageOf({ all(400.0), all(30.0), all(0.0) }), "band 3 (height) is 0 m");
  expect(messageOf({ all(400.0), all(30.0), all(20.0), all(31.0) }),
    "band 4 (dbh_dev) is 31 cm, it must be at most the mean");
  expect(messageOf({ all(400.0), all(30.0), all(20.0), all(5.0), all(101.0) }),
    "band 5 (conifers) is 101 %, it must be 0 to 100 %");
  expect(messageOf({ all(0.0), all(30.0) }), "has no cell with stems on the slope");
  expect(messageOf({ all(400.0), all(30.0) }, 1000.0), "does not overlap");
}
