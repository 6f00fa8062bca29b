/// @file
/// Numbers of the ground and of stands that look as if they were in another unit.

#include "terrain/Terrain.h"
#include "terrain/plausible.h"
#include "terrain/presets.h"

#include <gtest/gtest.h>

namespace rockfall
{

namespace
{

std::vector<std::string> notesOf(double friction, const Roughness& roughness)
{
  GridGeometry g;
  g.columns = g.rows = 3;
  g.cellSize = 10.0;
  SurfaceMaterial material;
  material.frictionAngle = radians(friction);
  std::vector<std::string> notes;
  askAfterGround(Terrain(g, std::vector<double>(9, 0.0), material, roughness), notes);
  return notes;
}

Stand square(std::int64_t feature, double west, double stems = 400.0, double diameter = 0.35)
{
  Stand stand;
  stand.feature = feature;
  stand.stemsPerHectare = stems;
  stand.diameterMean = diameter;
  stand.rings = { { { west, 0, 0 }, { west + 100, 0, 0 }, { west + 100, 50, 0 },
    { west, 50, 0 } } };
  return stand;
}

TEST(Plausible, Ground)
{
  Roughness roughness;
  roughness.deviation = 0.2;
  roughness.length = 2.0;
  roughness.obstacles = { 0.1, 0.5, 1.0 };
  for (const double friction : { 0.0, 15.0, 35.0, 60.0 })
  {
    EXPECT_TRUE(notesOf(friction, roughness).empty()) << friction;
  }
  EXPECT_EQ(notesOf(80.0, roughness),
    std::vector<std::string>({ "1 of 1 friction angles of the ground look implausible, first the "
                               "slope's own with 80 degrees. Ground has 2 to 60 degrees: is it in "
                               "degrees?" }));
  EXPECT_EQ(notesOf(0.6, roughness).size(), 1u); // radians
  roughness.mean = 5.0;
  EXPECT_NE(notesOf(35.0, roughness).at(0).find("with a mean of 5 m"), std::string::npos);
  roughness.mean = 0.0;
  roughness.deviation = 5.0; // centimetres
  roughness.obstacles = { 10.0, 30.0, 60.0 };
  EXPECT_EQ(notesOf(35.0, roughness).size(), 2u);
}

TEST(Plausible, GroundInPascals)
{
  GridGeometry g;
  g.columns = g.rows = 3;
  g.cellSize = 10.0;
  SurfaceMaterial material;
  const auto notes = [&](double modulus)
  {
    material.yielding.modulus = modulus;
    std::vector<std::string> all;
    askAfterGround(Terrain(g, std::vector<double>(9, 0.0), material, {}), all);
    return all;
  };
  EXPECT_TRUE(notes(13e6).empty());
  EXPECT_TRUE(notes(YieldingGround::hard).empty());
  ASSERT_EQ(notes(13e12).size(), 1u);
  EXPECT_NE(notes(13e12)[0].find("the slope's own with 1.3e+07 MN/m²"), std::string::npos)
    << notes(13e12)[0];
}

TEST(Plausible, RestitutionsOfTheGroundInEachOthersPlace)
{
  GridGeometry g;
  g.columns = g.rows = 3;
  g.cellSize = 10.0;
  const auto notes = [&](const SurfaceMaterial& own, const std::vector<SurfaceMaterial>& classes)
  {
    MaterialClasses layer;
    layer.materials = classes;
    layer.names.assign(classes.size(), "scree");
    auto cells = std::make_shared<std::vector<std::uint8_t>>(4, 1);
    layer.cells = *cells;
    layer.owner = cells;
    Terrain terrain(g, std::vector<double>(9, 0.0), own);
    if (!classes.empty())
    {
      terrain.setRestitutionClasses(layer);
    }
    std::vector<std::string> all;
    askAfterGround(terrain, all);
    return all;
  };
  SurfaceMaterial material;
  material.restitutionModel = RestitutionModel::NormalTangential;
  material.restitution = 0.35; // Hoek's outcrops
  material.tangentialRestitution = 0.85;
  EXPECT_TRUE(notes(material, { material }).empty());
  SurfaceMaterial swapped = material;
  std::swap(swapped.restitution, swapped.tangentialRestitution);
  const std::vector<std::string> told = notes(swapped, {});
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(
    told[0].find("1 of 1 restitutions of the ground look implausible, first the slope's own "
                 "with Rn 0.85 and Rt 0.35."),
    0u)
    << told[0];
  ASSERT_EQ(notes(material, { swapped }).size(), 1u);
  EXPECT_NE(notes(material, { swapped })[0].find("first class \"scree\""), std::string::npos);
  swapped.restitutionModel = RestitutionModel::Velocity; // which does not use Rt
  EXPECT_TRUE(notes(swapped, {}).empty());
  // A modulus belongs to the restitution's classes as well.
  material.yielding.modulus = 13e12;
  ASSERT_EQ(notes({}, { material }).size(), 1u);
  EXPECT_NE(
    notes({}, { material })[0].find("class \"scree\" with 1.3e+07 MN/m²"), std::string::npos);
}

TEST(Plausible, GroundThatStopsEveryRock)
{
  GridGeometry g;
  g.columns = g.rows = 3;
  g.cellSize = 10.0;
  const auto notes = [&](auto&& change, Roughness roughness = {})
  {
    SurfaceMaterial material = groundPreset("talus").material();
    change(material);
    std::vector<std::string> all;
    askAfterGround(Terrain(g, std::vector<double>(9, 0.0), material, roughness), all);
    return all;
  };
  for (const char* preset : { "rock", "asphalt", "bedrock with boulders", "talus",
         "talus with vegetation", "soil", "meadow" })
  {
    const GroundPreset& ground = groundPreset(preset);
    EXPECT_TRUE(notes([&](SurfaceMaterial& m) { m = ground.material(); }, ground.roughness).empty())
      << preset;
  }
  const auto one = [&](auto&& change, const char* words)
  {
    const std::vector<std::string> told = notes(change);
    ASSERT_EQ(told.size(), 1u) << words;
    EXPECT_NE(told[0].find(words), std::string::npos) << told[0];
  };
  one([](SurfaceMaterial& m) { m.yielding.rollingResistance = 30.0; },
    "values of RollingResistance of the ground look implausible, first the slope's own with 30.");
  one([](SurfaceMaterial& m) { m.yielding.frictionMost = 60.0; }, "SlipFrictionMax");
  one([](SurfaceMaterial& m) { m.yielding.compaction = 500.0; }, "ScarCompaction");
  one([](SurfaceMaterial& m) { m.yielding.density = 1.7; }, "with 1.7 kg/m³. GroundDensity is 300");
  one([](SurfaceMaterial& m) { m.restitutionSpeed = 0.001; }, "speeds of restitution");
  one([](SurfaceMaterial& m) { m.restitutionDeviation = 0.9; }, "deviations of restitution");
  one([](SurfaceMaterial& m) { m.frictionAngleDeviation = radians(30.0); }, "with 30 degrees");
  Roughness centimetres;
  centimetres.deviation = 0.1;
  centimetres.length = 200.0;
  ASSERT_EQ(notes([](SurfaceMaterial&) {}, centimetres).size(), 1u);
  EXPECT_NE(notes([](SurfaceMaterial&) {}, centimetres)[0].find("with 200 m"), std::string::npos);
}

TEST(Plausible, Nets)
{
  Barrier net;
  net.feature = 1;
  net.height = 4.0;
  net.capacity = 1e6;
  net.braking = 6.0;
  net.residual = 0.6;
  const auto notes = [](const Barrier& barrier)
  {
    Structures all;
    all.barriers = { barrier };
    std::vector<std::string> told;
    askAfterNumbers(all, told);
    return told;
  };
  EXPECT_TRUE(notes(net).empty());
  net.braking = 50.0;
  net.residual = 1.0;
  ASSERT_EQ(notes(net).size(), 2u);
  EXPECT_NE(notes(net)[0].find("first feature 1 with 50 m"), std::string::npos);
  EXPECT_NE(notes(net)[1].find("first feature 1 with 100 %"), std::string::npos);
  // A share for per cent, litres for m³.
  net.braking = 6.0;
  net.residual = 0.005;
  net.room = 4000.0;
  ASSERT_EQ(notes(net).size(), 2u);
  EXPECT_NE(notes(net)[0].find("first feature 1 with 0.5 %"), std::string::npos);
  EXPECT_NE(notes(net)[1].find("first feature 1 with 4000 m³/m"), std::string::npos);
  Barrier endless;
  endless.feature = 2;
  endless.height = 4.0;
  ASSERT_EQ(notes(endless).size(), 1u);
  EXPECT_NE(notes(endless)[0].find("stops every rock"), std::string::npos);
}

TEST(Plausible, MaterialsOfStructures)
{
  Structures all;
  all.materials.resize(2);
  all.materials[1].frictionAngle = radians(0.6);
  all.materials[1].cohesion = 1e6;
  Embankment dam;
  dam.feature = 4;
  dam.height = 3.0;
  dam.crestWidth = 1.0;
  dam.mountainSlope = dam.valleySlope = 1.5;
  dam.material = 1;
  all.embankments = { dam };
  std::vector<std::string> told;
  askAfterNumbers(all, told);
  EXPECT_TRUE(told.empty());
  all.embankments[0].material = 2;
  askAfterNumbers(all, told);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].find("1 of 1 friction angles of structures look implausible, first feature 4 "
                         "with 0.6 degrees"),
    0u)
    << told[0];
  EXPECT_NE(told[1].find("first feature 4 with 1e+06 N"), std::string::npos) << told[1];
}

TEST(Plausible, CrowdsOfTrees)
{
  const auto notes = [](double apart)
  {
    Structures all;
    for (int k = 0; k < 400; ++k)
    {
      Tree tree;
      tree.position = { apart * (k % 20), apart * double(k / 20) };
      tree.diameter = 0.5;
      tree.height = 25.0;
      all.trees.push_back(tree);
    }
    std::vector<std::string> told;
    askAfterTwins(all, told);
    return told;
  };
  EXPECT_TRUE(notes(5.0).empty()); // a hectare of 79 m²
  const auto crowd = notes(0.5);
  ASSERT_EQ(crowd.size(), 1u);
  EXPECT_EQ(
    crowd[0].find("1 of 1 squares of 50 m with trees look implausible, first one with 314 "), 0u)
    << crowd[0];
}

TEST(Plausible, Stands)
{
  const auto notes = [](std::vector<Stand> stands)
  {
    std::vector<std::string> all;
    askAfterStands(stands, all);
    return all;
  };
  EXPECT_TRUE(notes({ square(1, 0.0), square(2, 100.0), square(3, 198.0) }).empty());
  const auto dense = notes({ square(1, 0.0), square(2, 100.0, 20000.0) });
  ASSERT_EQ(dense.size(), 1u);
  EXPECT_EQ(
    dense[0].find("1 of 2 stands look implausible, first feature 2: 20000 stems of 35 cm"), 0u)
    << dense[0];
  EXPECT_EQ(notes({ square(1, 0.0, 0.04) }).size(), 1u); // stems per square metre
  Stand mixed = square(1, 0.0);                          // 0.8 for 80 %
  mixed.conifers = 0.008;
  EXPECT_EQ(notes({ mixed }).size(), 1u);
  Stand thin = square(1, 0.0);
  thin.diameterMean = 0.0035;
  EXPECT_EQ(notes({ thin }).at(0).find("1 of 1 mean diameters of stands look implausible"), 0u);
  thin.diameterMean = 0.1;
  thin.height = 24.0;
  EXPECT_EQ(
    notes({ thin }).at(0).find("1 of 1 stands look implausible, first feature 1: 24 m high"), 0u)
    << notes({ thin }).at(0);
  Stand strong = square(1, 0.0);
  strong.broadleafFactor = 170.0;
  EXPECT_EQ(notes({ strong }).size(), 1u);
  const auto twice = notes({ square(1, 0.0), square(2, 300.0), square(3, 310.0) });
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_NE(
    twice[0].find("first feature 3, which shares 4600 m² with feature 2"), std::string::npos)
    << twice[0];
  EXPECT_EQ(notes({ square(1, 0.0), square(2, 70.0) }).size(), 1u);
  // A clearing is no ground of the stand around it.
  Stand around = square(1, 0.0), within = square(2, 20.0);
  within.rings = { { { 20, 10, 0 }, { 40, 10, 0 }, { 40, 30, 0 }, { 20, 30, 0 } } };
  EXPECT_EQ(notes({ around, within }).size(), 1u);
  around.rings.push_back(within.rings.front());
  EXPECT_TRUE(notes({ around, within }).empty());
}

} // namespace

} // namespace rockfall
