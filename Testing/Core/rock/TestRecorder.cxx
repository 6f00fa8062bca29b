// Samples of a path between the ends of steps.

#include "rock/parts/Recorder.h"

#include "slopes.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Samples of one step of 10 ms from (0, 0, 10), at the even times 0, 1, 2, … ms and its knots.
std::vector<Sample> samplesOfStep(const Vec3& before, const Vec3& after, const Vec3& way)
{
  const Terrain slope = makePlane(5, 5.0, 0.0, 0.0, material(0.5, 30.0));
  const Surface surface(slope, 1, 0);
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.2);
  SimulationParameters p;
  p.outputInterval = 0.001;
  RockBody body(block);
  body.state.position = Vec3(10.0, 10.0, 10.0);
  body.state.velocity = before;
  const BlockState from = body.state;
  Recorder recorder(surface, block, p);
  recorder.begin(body);
  body.state.time = 0.01;
  body.state.position += way;
  body.state.velocity = after;
  recorder.recordBetween(body, from, body.state, true);
  return recorder.trajectory().samples;
}

} // namespace

// A rock lies, and another strikes it at the end of a step: until then it stays where it is. The
// cubic curve between both ends would go 4/27 of a step's way back first.
TEST(Recorder, ARockThatIsStruckAtTheEndOfAStepStaysUntilThen)
{
  const Vec3 after(0.0, 0.0, 20.0);
  for (const Sample& s : samplesOfStep(Vec3::Zero(), after, Vec3::Zero()))
  {
    EXPECT_LT((s.position - Vec3(10.0, 10.0, 10.0)).norm(), 1e-9) << s.time;
    EXPECT_LT((s.velocity - (s.time < 0.01 - 5e-10 ? Vec3(Vec3::Zero()) : after)).norm(), 1e-9)
      << s.time;
  }
}

// What came in between is not known, but the ends are out of the ground.
TEST(Recorder, ARockThatIsStruckWithinAStepGoesStraight)
{
  const Vec3 before(6.0, 0.0, -12.0), after(4.0, 3.0, 9.0);
  for (const double share : { 0.0, 0.25, 0.8, 1.0 })
  {
    const Vec3 way = 0.01 * (share * before + (1.0 - share) * after);
    const std::vector<Sample> samples = samplesOfStep(before, after, way);
    EXPECT_GE(samples.size(), 11u);
    for (const Sample& s : samples)
    {
      EXPECT_LT((s.position - Vec3(10.0, 10.0, 10.0) - s.time / 0.01 * way).norm(), 1e-7)
        << share << ' ' << s.time;
    }
    EXPECT_LT((samples.back().velocity - after).norm(), 1e-9);
  }
}

// The most that the energy rises over its least so far, and neither what other rocks give nor what
// a spring returns.
TEST(Recorder, EnergyFromNowhereIsKeptWhateverIsLostBefore)
{
  const Terrain slope = makePlane(5, 5.0, 0.0, 0.0, material(0.5, 30.0));
  const Surface surface(slope, 1, 0);
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.2);
  RockBody body(block);
  body.state.velocity.x() = 10.0; // 125 kJ
  Recorder recorder(surface, block, {});
  recorder.begin(body);
  const double& gained = recorder.trajectory().summary.gained;
  const auto goTo = [&](double speed, double spring, double given)
  {
    body.state.velocity.x() = speed;
    body.springEnergy = spring;
    body.energy.exchanged = given;
    recorder.follow(body);
  };
  goTo(4.0, 0.0, 0.0); // 20 kJ
  EXPECT_EQ(gained, 0.0);
  goTo(0.0, 20e3, 0.0);
  goTo(4.0, 0.0, 0.0);
  EXPECT_NEAR(gained, 0.0, 1e-9);
  goTo(6.0, 0.0, -25e3); // 45 kJ, of which others gave 25
  EXPECT_NEAR(gained, 0.0, 1e-9);
  goTo(8.0, 0.0, -25e3); // 80 kJ
  EXPECT_NEAR(gained, 35e3, 1e-6);
  goTo(2.0, 0.0, -25e3);
  goTo(6.0, 0.0, -25e3); // 5 to 45 kJ
  EXPECT_NEAR(gained, 40e3, 1e-6);
  goTo(0.0, 0.0, -25e3);
  EXPECT_NEAR(gained, 40e3, 1e-6);
}
