/// @file
/// Densities and frequencies that look as if they were in another unit.

#include "geometry/shapes.h"
#include "rock/plausibleRocks.h"

#include <gtest/gtest.h>

namespace rockfall
{

TEST(PlausibleRocks, DensityAndFrequency)
{
  std::vector<Rock> rocks(3);
  for (Rock& rock : rocks)
  {
    rock.shape = makeShape(Shape::Cube, 1.0);
  }
  rocks[2].blockId = 7;
  const auto notes = [&rocks](std::vector<double> frequencies)
  {
    std::vector<std::string> all;
    askAfterRocks(rocks, frequencies, all);
    return all;
  };
  EXPECT_TRUE(notes({}).empty());
  EXPECT_TRUE(notes({ 10.0, 10.0, 1.0 }).empty());
  EXPECT_EQ(notes(std::vector<double>(3, 1e-9)).size(), 1u);
  rocks[2].density = 2.7; // t/m³
  EXPECT_EQ(notes({ 1000.0, 300.0, 100.0 }),
    std::vector<std::string>({ "1 of 3 densities of rocks look implausible, first block 7 with 2.7 "
                               "kg/m³. Rocks have 500 to 5500 kg/m³: is it in kg/m³?",
      "The rocks together fall 1400 times a year: are frequencies rocks per year, not return "
      "periods?" }));
}

TEST(PlausibleRocks, WhatNoRockHas)
{
  Rock usual;
  usual.blockId = 3;
  usual.shape = makeShape(Shape::Cube, 1.0);
  usual.velocity = { 30.0, 0.0, -20.0 };
  usual.angularVelocity = { 0.0, 40.0, 0.0 };
  usual.uncertainty.horizontalDeviation = 20.0;
  usual.uncertainty.verticalDeviation = 2.0;
  const auto notes = [&](auto&& change)
  {
    Rock rock = usual;
    change(rock);
    std::vector<std::string> all;
    askAfterRocks(std::span(&rock, 1), {}, all);
    return all.size() == 1 ? all.front() : std::to_string(all.size()) + " notes";
  };
  EXPECT_EQ(notes([](Rock&) {}), "0 notes");
  const auto has = [&](const char* words, auto&& change)
  {
    const std::string note = notes(change);
    EXPECT_NE(note.find(std::string("first block 3 with ") + words), std::string::npos) << note;
  };
  has("5000 degrees",
    [](Rock& rock)
    {
      rock.uncertainty.attitude = AttitudeLaw::Deviate;
      rock.uncertainty.attitudeDeviation = radians(5000.0);
    });
  has("8000 m³",
    [](Rock& rock)
    {
      rock.shape = makeBox({ 20.0, 20.0, 20.0 });
      rock.angularVelocity.setZero();
    });
  has("0.00059 GPa", [](Rock& rock) { rock.youngModulus = 590e3; });
  has("300 m/s", [](Rock& rock) { rock.velocity = { 300.0, 0.0, 0.0 }; });
  has("311.769 m/s", [](Rock& rock) { rock.angularVelocity = { 360.0, 0.0, 0.0 }; }); // degrees/s
  has("200 m", [](Rock& rock) { rock.uncertainty.horizontalDeviation = 200.0; });
  has("20 m", [](Rock& rock) { rock.uncertainty.verticalDeviation = 20.0; });
}

} // namespace rockfall
