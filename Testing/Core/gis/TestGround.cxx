// Classes of ground: grids and polygons of any CRS with their tables, on the cells of a terrain.
#include "base/errors.h"
#include "groundLayers.h"
#include "terrain/Surface.h"
#include "terrain/presets.h"

#include <cmath>
#include <numeric>
#include <set>

using namespace rockfall;
using namespace rockfall::testing;
using namespace rockfall::testing::ground;

TEST(Ground, ClassesOnHalfCellsAreTheSameHoweverTheyAreStored)
{
  const Terrain terrain = slope();
  for (const double shift : { 5.0, 0.0, 2.5 })
  {
    for (const double size : { 10.0, 5.0, 20.0 })
    {
      // Cells of the layer whose edges are on the centres of the terrain's, or not.
      RawRaster north;
      north.columns = north.rows = 24;
      north.affine = { west + shift - 8.0 * size, size, 0.0, south + shift + 16.0 * size, 0.0,
        -size };
      north.crs = "EPSG:32632";
      north.type = "Byte";
      north.fill(
        [&](double x, double y)
        {
          return 1.0 +
            double(
              (std::int64_t(std::floor(x / size)) * 7 + std::int64_t(std::floor(y / size)) * 5) %
              3 % 2);
        });
      // Row r and column c of a raster that is stored from the other sides.
      const auto stored = [&](bool southUp, bool mirrored)
      {
        RawRaster raster = north;
        for (int r = 0; r < 24; ++r)
        {
          for (int c = 0; c < 24; ++c)
          {
            raster.values[std::size_t(r * 24 + c)] =
              north.values[std::size_t((southUp ? 23 - r : r) * 24 + (mirrored ? 23 - c : c))];
          }
        }
        if (southUp)
        {
          raster.affine[3] -= 24.0 * size;
          raster.affine[5] = size;
        }
        if (mirrored)
        {
          raster.affine[0] += 24.0 * size;
          raster.affine[1] = -size;
        }
        const MaterialClasses classes = read({ raster.write(), table(), "" }, terrain);
        return std::vector<std::uint8_t>(classes.cells.begin(), classes.cells.end());
      };
      const std::vector<std::uint8_t> expected = stored(false, false);
      EXPECT_EQ(stored(true, false), expected) << shift << ", " << size;
      EXPECT_EQ(stored(false, true), expected) << shift << ", " << size;
      EXPECT_EQ(stored(true, true), expected) << shift << ", " << size;
    }
  }
}

TEST(Ground, RasterOnAnotherGrid)
{
  const Terrain terrain = slope();
  std::vector<std::string> notes;
  const MaterialClasses c =
    read({ halves().write(), table(), "" }, terrain, GroundKind::Restitution, &notes);
  ASSERT_EQ(c.count(), 2);
  ASSERT_EQ(c.cells.size(), 48u);
  for (int cell = 0; cell < 48; ++cell)
  {
    EXPECT_EQ(int(c.cells[std::size_t(cell)]), cell % 8 < 4 ? 1 : 2) << cell;
    EXPECT_EQ(c.at(2 * cell + 1), cell % 8 < 4 ? 1 : 2);
    EXPECT_EQ(c.at(2 * cell + 2), cell % 8 < 4 ? 1 : 2);
  }
  EXPECT_EQ(c.names[1], "talus");
  EXPECT_EQ(c.materials[0].restitution, 0.9);
  EXPECT_EQ(c.materials[1].restitutionDeviation, 0.1);
  EXPECT_TRUE(holds(notes.back(), { "rock 50 %", "talus 50 %" }));
}

TEST(Ground, ClassesThatAreFinerThanTheSlopeAreTold)
{
  const Terrain terrain = slope();
  const auto told = [&](const GroundFiles& files)
  {
    std::vector<std::string> notes;
    read(files, terrain, GroundKind::Restitution, &notes);
    std::erase_if(
      notes, [](const std::string& note) { return note.find("centre") == std::string::npos; });
    return notes;
  };
  EXPECT_TRUE(told({ halves().write(), table(), "" }).empty());
  // A path of 2 m, whose cells of 1 m lie 2 to 4 m beside all centres.
  RawRaster fine = halves();
  fine.columns = 80;
  fine.rows = 60;
  fine.affine = { west, 1.0, 0.0, south + 60.0, 0.0, -1.0 };
  fine.fill([](double x, double) { return x > west + 42.0 && x < west + 44.0 ? 2.0 : 1.0; });
  const std::vector<std::string> path = told({ fine.write(), table(), "" });
  ASSERT_EQ(path.size(), 1u);
  EXPECT_TRUE(holds(
    path[0], { "cells of 1 m, the slope of 10 m", "0 of 48", "in none is \"talus\"", "CellSize" }))
    << path[0];
  // Blocks in scree, by chance under the centres: a tenth of the ground, all of the cells.
  fine.fill(
    [](double x, double y)
    {
      const double u = std::remainder(x - west - 5.0, 10.0),
                   v = std::remainder(y - south - 5.0, 10.0);
      return std::abs(u) < 1.6 && std::abs(v) < 1.6 ? 2.0 : 1.0;
    });
  const std::vector<std::string> blocks = told({ fine.write(), table(), "" });
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_TRUE(holds(blocks[0], { "48 of 48 are mostly of another class", "\"rock\"" }))
    << blocks[0];
  // Polygons: a strip that no centre lies in, and a wide one.
  const std::string wide = box(west, south, west + 40, south + 60, "\"class\":\"1\"");
  EXPECT_TRUE(told({ polygons(wide), table(), "" }).empty());
  const std::string strip = box(west + 42, south, west + 44, south + 60, "\"class\":\"2\"");
  const std::vector<std::string> narrow = told({ polygons(wide + "," + strip), table(), "" });
  ASSERT_EQ(narrow.size(), 1u);
  EXPECT_TRUE(holds(narrow[0],
    { "1 of 2 polygons are narrower than the slope's cells of 10 m", "first feature 2 with 1.94 m",
      "CellSize" }))
    << narrow[0];
}

TEST(Ground, RasterInAnotherCrsAndExtent)
{
  // Longitude and latitude, with its border on the meridian 10.2930° E. By PROJ (gdaltransform) it
  // passes 36.7 m east of the slope's western edge 29 m south of it and, as the meridians converge
  // by 0.93°, 35.8 m and 36.7 m over the slope.
  RawRaster raster;
  raster.columns = 400;
  raster.rows = 200;
  // 1e-5° is 0.77 m east and 1.11 m north.
  raster.affine = { 10.291, 1e-5, 0.0, 46.0476, 0.0, -1e-5 };
  raster.crs = "EPSG:4326";
  raster.type = "Float32";
  raster.fill([](double x, double) { return x < 10.2930 ? 1.0 : 2.0; });
  const Terrain terrain = slope();
  const MaterialClasses c = read({ raster.write(), table(), "" }, terrain);
  for (int cell = 0; cell < 48; ++cell)
  {
    // Centres at 5, 15, 25, 35, 45 m: 35 m is west of it.
    EXPECT_EQ(int(c.cells[std::size_t(cell)]), cell % 8 < 4 ? 1 : 2) << cell;
  }
}

TEST(Ground, WhatTheLayerDoesNotCoverIsOfTheSlopesOwnMaterial)
{
  RawRaster raster = halves();
  raster.affine[0] += 20.0; // its western 20 m are missing
  raster.fill([](double x, double) { return x < west + 60.0 ? 1.0 : 9.0; });
  raster.band = "<NoDataValue>9</NoDataValue>";
  std::vector<std::string> notes;
  const Terrain terrain = slope();
  const MaterialClasses c =
    read({ raster.write(), table(), "" }, terrain, GroundKind::Restitution, &notes);
  for (int cell = 0; cell < 48; ++cell)
  {
    EXPECT_EQ(int(c.cells[std::size_t(cell)]), cell % 8 >= 2 && cell % 8 < 6 ? 1 : 0) << cell;
  }
  EXPECT_TRUE(holds(notes.back(), { "24 of 48 cells" }));
  bool unused = false;
  for (const std::string& note : notes)
  {
    unused = unused || holds(note, { "no cell uses row 2", "talus" });
  }
  EXPECT_TRUE(unused);
}

TEST(Ground, OtherBandsOfARasterDoNotCount)
{
  RawRaster raster = halves(1.0, 7.0);
  raster.band = "<NoDataValue>7</NoDataValue>";
  const std::string other = halves(2.0, 2.0).write("other");
  raster.dataset =
    "<VRTRasterBand dataType=\"Byte\" band=\"2\"><NoDataValue>9</NoDataValue><SimpleSource>"
    "<SourceFilename>" +
    other + "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>";
  const Terrain terrain = slope();
  // With a row for 0, which cells without data must not become.
  const MaterialClasses classes =
    read({ raster.write(), table("class,rv\n1,0.9\n0,0.1\n"), "" }, terrain);
  EXPECT_EQ(int(classes.cells[0]), 1);
  EXPECT_EQ(int(classes.cells[7]), 0);
}

TEST(Ground, PolygonsByNameAndByNumber)
{
  const Terrain terrain = slope();
  const std::string file =
    polygons(box(west - 5, south - 5, west + 40, south + 65, "\"geology\":\"Rock\"") + "," +
      box(west + 40, south - 5, west + 85, south + 30, "\"geology\":\"2.0\""));
  const MaterialClasses c = read({ file, table(), "Geology" }, terrain);
  for (int cell = 0; cell < 48; ++cell)
  {
    const int expected = cell % 8 < 4 ? 1 : cell / 8 >= 3 ? 2 : 0;
    EXPECT_EQ(int(c.cells[std::size_t(cell)]), expected) << cell;
  }
}

TEST(Ground, PolygonsThatOverlapOrCrossThemselvesAreTold)
{
  const Terrain terrain = slope();
  std::vector<std::string> notes;
  const auto text = [&](const std::string& features)
  {
    notes.clear();
    read({ polygons(features), table(), "class" }, terrain, GroundKind::Restitution, &notes);
    return std::accumulate(notes.begin(), notes.end(), std::string());
  };
  const auto zone = [](double from, double to, const std::string& name)
  { return box(west + from, south, west + to, south + 60, "\"class\":" + name); };
  EXPECT_EQ(text(zone(0, 40, "1") + "," + zone(40, 80, "2")).find("overlap"), std::string::npos);
  EXPECT_EQ(text(zone(0, 40, "1") + "," + zone(20, 60, "1")).find("overlap"), std::string::npos);
  EXPECT_NE(
    text(zone(0, 50, "1") + "," + zone(30, 80, "2"))
      .find("polygons of two classes overlap on 12 cells, first at 600035, 5100055 \"rock\" "
            "and \"talus\". The later one counts"),
    std::string::npos)
    << text(zone(0, 50, "1") + "," + zone(30, 80, "2"));
  const std::string bow =
    "{\"type\":\"Feature\",\"properties\":{\"class\":1},\"geometry\":{"
    "\"type\":\"Polygon\",\"coordinates\":[[[600000,5100000],[600080,5100060],"
    "[600080,5100000],[600000,5100060],[600000,5100000]]]}}";
  EXPECT_NE(text(zone(0, 9, "2") + "," + bow)
              .find("1 of 2 polygons have an outline that crosses or touches itself, first row 2"),
    std::string::npos);
}

TEST(Ground, ClassesHaveTheScaleAndOffsetOfTheirBand)
{
  const Terrain terrain = slope();
  const std::string classes = table("class,name,rv\n1,rock,0.9\n2,talus,0.5\n11,scree,0.4\n"
                                    "12,meadow,0.3\n");
  RawRaster raster = halves();
  raster.band = "<Offset>10</Offset><Scale>1</Scale>";
  std::vector<std::string> notes;
  const MaterialClasses c =
    read({ raster.write(), classes, "" }, terrain, GroundKind::Restitution, &notes);
  EXPECT_EQ(std::set<int>(c.cells.begin(), c.cells.end()), (std::set<int>{ 3, 4 }));
  EXPECT_TRUE(
    holds(joined(notes), { "the band's scale 1 and offset 10 were applied to its classes" }));
  raster = halves(10.0, 110.0);
  raster.band = "<Scale>0.1</Scale>"; // 0.1 × 110 is no whole number in doubles
  const MaterialClasses tenths = read({ raster.write(), classes, "" }, terrain);
  EXPECT_EQ(std::set<int>(tenths.cells.begin(), tenths.cells.end()), (std::set<int>{ 1, 3 }));
  raster = halves(10.0, 15.0);
  raster.band = "<Scale>0.1</Scale>";
  EXPECT_TRUE(holds(failure({ raster.write(), classes, "" }),
    { "class 15 (in the cell at 600045", "with scale 0.1 and offset 0 is 1.5", "whole number" }));
}

TEST(Ground, PolygonsInDegrees)
{
  // A box around all of the slope, in longitude and latitude.
  const Terrain terrain = slope();
  const std::string file =
    polygons(box(10.28, 46.03, 10.31, 46.06, "\"class\":1"), "OGC:1.3:CRS84");
  const MaterialClasses c = read({ file, table(), "" }, terrain);
  EXPECT_EQ(std::set<int>(c.cells.begin(), c.cells.end()), std::set<int>{ 1 });
}

TEST(Ground, JointTableAndModels)
{
  SurfaceMaterial sticky;
  sticky.cohesion = 7.0;
  const Terrain terrain = slope("EPSG:32632", sticky);
  const MaterialClasses joints = read(
    { halves().write(), table("class;phi;phi_deviation;cohesion\n1;35;2;\n2;20.5;;100\n"), "" },
    terrain, GroundKind::Joint);
  EXPECT_DOUBLE_EQ(joints.materials[0].frictionAngle, radians(35.0));
  EXPECT_DOUBLE_EQ(joints.materials[0].frictionAngleDeviation, radians(2.0));
  EXPECT_EQ(joints.materials[0].cohesion, 7.0);
  EXPECT_DOUBLE_EQ(joints.materials[1].frictionAngle, radians(20.5));
  EXPECT_EQ(joints.materials[1].frictionAngleDeviation, 0.0);
  EXPECT_EQ(joints.materials[1].cohesion, 100.0);
  const MaterialClasses models = read(
    { halves().write(),
      table("class,rv,model,rt,speed,preset\n1,0.4,SpeedDependent,0.8,5,\n2,,,,,Talus\n"), "" },
    terrain);
  EXPECT_EQ(models.materials[0].restitutionModel, RestitutionModel::SpeedDependent);
  EXPECT_EQ(models.materials[0].tangentialRestitution, 0.8);
  EXPECT_EQ(models.materials[0].restitutionSpeed, 5.0);
  EXPECT_EQ(models.materials[1].restitution, groundPreset("talus").normalRestitution);
  EXPECT_EQ(models.materials[1].restitutionModel, RestitutionModel::SpeedDependent);
}

TEST(Ground, RoughnessOfClasses)
{
  Terrain terrain = slope();
  terrain = Terrain(terrain, {}, { 0.05, 0.1, 2.0, {} });
  const MaterialClasses plain = read({ halves().write(), table(), "" }, terrain);
  EXPECT_TRUE(plain.roughness.empty());
  const MaterialClasses rough =
    read({ halves().write(),
           table("class,rv,roughness_mean,roughness,roughness_length,rg70,rg20,rg10\n1,0.9,,,,,,\n"
                 "2,0.5,-0.2,0.3,1.5,0.1,0.25,0.6\n"),
           "" },
      terrain);
  ASSERT_EQ(rough.roughness.size(), 2u);
  EXPECT_EQ(rough.roughness[0], terrain.roughness());
  EXPECT_EQ(rough.roughness[1], (Roughness{ -0.2, 0.3, 1.5, { 0.1, 0.25, 0.6 } }));
  // A preset's, where the row does not say otherwise.
  const MaterialClasses preset =
    read({ halves().write(), table("class,preset,rv,rg10\n1,,0.9,\n2,talus,,0.3\n"), "" }, terrain);
  ASSERT_EQ(preset.roughness.size(), 2u);
  EXPECT_EQ(preset.roughness[0], terrain.roughness());
  Roughness talus = groundPreset("talus").roughness;
  talus.obstacles[2] = 0.3;
  EXPECT_EQ(preset.roughness[1], talus);
  const auto said = [](const std::string& row)
  {
    return failure(
      { halves().write(), table("class,rv,roughness,roughness_length,rg10\n" + row), "" });
  };
  EXPECT_NE(said("1,0.9,-1,,\n").find("\"roughness\" is -1"), std::string::npos);
  EXPECT_NE(said("1,0.9,,0,0.5\n").find("RoughnessLength is 0"), std::string::npos);
}

TEST(Ground, EachClassDrawsItsOwnNumbers)
{
  SurfaceMaterial own;
  own.restitution = 0.7;
  own.restitutionDeviation = 0.1;
  own.frictionAngleDeviation = radians(3.0);
  const Terrain plain = slope("EPSG:32632", own);
  Terrain terrain = slope("EPSG:32632", own);
  terrain.setRestitutionClasses(read({ halves().write(), table(), "" }, terrain));
  terrain.setJointClasses(
    read({ halves().write(), table("class,phi,phi_deviation\n1,30,2\n2,30,2\n", "joints.csv"), "" },
      terrain, GroundKind::Joint));
  double sum[2] = {}, square[2] = {}, cross = 0.0, frictions = 0.0;
  const int n = 4000;
  for (int i = 0; i < n; ++i)
  {
    const Surface before(plain, 1, i), surface(terrain, 1, i);
    // What the slope draws for itself is what it drew without classes, bit for bit.
    ASSERT_EQ(surface.restitution(), before.restitution());
    ASSERT_EQ(surface.friction(), before.friction());
    const double r[2] = { surface.restitutionAt({ .cfe = 1 }),
      surface.restitutionAt({ .cfe = 15 }) };
    for (int k = 0; k < 2; ++k)
    {
      sum[k] += r[k] / n;
      square[k] += r[k] * r[k] / n;
    }
    cross += (r[0] - 0.9) * (r[1] - 0.5) / n;
    frictions += surface.frictionAt({ .cfe = 1 }) == surface.frictionAt({ .cfe = 15 });
  }
  // Of n draws the mean deviates by σ/√n; four of that. Class 1 is cut at 1, two σ away: its mean
  // is 0.0085 σ less.
  EXPECT_NEAR(sum[0], 0.9 - 0.0085 * 0.05, 4 * 0.05 / std::sqrt(n));
  EXPECT_NEAR(sum[1], 0.5, 4 * 0.1 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(square[1] - sum[1] * sum[1]), 0.1, 4 * 0.1 / std::sqrt(2.0 * n));
  EXPECT_NEAR(cross, 0.0, 4 * 0.05 * 0.1 / std::sqrt(n)); // independent
  EXPECT_EQ(frictions, 0.0);
  const Surface mean = Surface::asSurveyed(terrain);
  EXPECT_EQ(mean.restitutionAt({ .cfe = 1 }), 0.9);
  EXPECT_DOUBLE_EQ(mean.frictionAt({ .cfe = 15 }), std::tan(radians(30.0)));
}

TEST(Ground, DecimalCommasChangeNothing)
{
  const std::string layer = halves().write(), rows = table();
  const CommaLocale commas;
  const Terrain terrain = slope();
  const MaterialClasses c = read({ layer, rows, "" }, terrain);
  EXPECT_EQ(c.materials[0].restitution, 0.9);
  EXPECT_EQ(c.materials[1].restitutionDeviation, 0.1);
  EXPECT_EQ(int(c.cells[0]), 1);
}

TEST(Ground, Presets)
{
  for (const GroundPreset& preset : groundPresets())
  {
    EXPECT_NO_THROW(preset.material().validate()) << preset.name;
    // Friction by slip takes what Rt stands for.
    const SurfaceMaterial m = preset.material();
    EXPECT_TRUE(!m.yielding.slips() || m.tangentialRestitution == 1.0) << preset.name;
    EXPECT_GT(m.yielding.rollingResistance, 0.0) << preset.name << " would let rocks creep";
    EXPECT_EQ(&groundPreset(preset.name), &preset);
    EXPECT_NO_THROW(preset.roughness.validate()) << preset.name;
    EXPECT_EQ(preset.roughness.any(), preset.roughness.isField())
      << preset.name << " would be another ground on other cells";
  }
  EXPECT_TRUE(holds(messageOf<DataError>([] { groundPreset("cheese"); }),
    { "cheese", "rock", "talus", "meadow", "asphalt" }));
}

TEST(Ground, TextGridsWithACornerAndACentreLieWhereBothSay)
{
  const std::string plain = "1 1 1 1 2 2 2 2";
  const auto cells = [&](const std::string& corner)
  {
    const MaterialClasses classes = read({ textClasses(corner, plain), table(), "" }, slope());
    return std::vector<std::uint8_t>(classes.cells.begin(), classes.cells.end());
  };
  EXPECT_EQ(
    cells("xllcorner 600000\nyllcenter 5100005\n"), cells("xllcorner 600000\nyllcorner 5100000\n"));
}
