// Rocks that come to an island or leave it: what they are in the middle of goes on.

#include "piles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Up to a time, s: how many rocks the largest group has been that there was.
int mostTogether(Pile& pile, double until)
{
  int most = 0;
  while (pile.fall->time() < until && pile.fall->advance())
  {
    most = std::max(most, pile.largestIsland());
  }
  return most;
}

} // namespace

TEST(Handovers, WhoHasLeftAnIslandReboundsAsWhoNeverWasInOne)
{
  // Two posts that part fall on the floor, each by itself, on four corners at once. (A cube's mass
  // as one of its corners feels it is just a quarter of its own: it would show nothing.)
  for (const double e : { 0.2, 0.5, 0.8 })
  {
    SurfaceMaterial ground = material(e, 0.0);
    ground.restitutionModel = RestitutionModel::NormalTangential;
    const auto rebounds = [&](bool met)
    {
      Pile pile;
      pile.ground = makeSlope(
        9, 5.0, [](double, double) { return 0.0; }, ground);
      pile.parameters.endTime = 1.0;
      pile.parameters.rockRestitution = 0.9;
      const Vec3 post(0.6, 0.6, 2.0);
      pile.rocks = { brick(post, Vec3(20.0, 20.0, 2.5), 0), brick(post, Vec3(20.7, 20.0, 2.5), 1) };
      pile.rocks[met ? 0 : 1].velocity = Vec3(4.0, 0.0, 0.0);
      pile.make();
      std::vector<double> ratios;
      for (const Trajectory& t : pile.fall->run())
      {
        const auto floor = std::find_if(t.impacts.begin(), t.impacts.end(),
          [](const ImpactEvent& i) { return i.normal.z() > 0.9; });
        EXPECT_NE(floor, t.impacts.end());
        if (floor != t.impacts.end())
        {
          ratios.push_back(-floor->velocityAfter.z() / floor->velocityBefore.z());
        }
      }
      return ratios;
    };
    for (const bool met : { false, true })
    {
      for (const double ratio : rebounds(met))
      {
        EXPECT_NEAR(ratio, e, 0.02) << met; // the impact is resolved with some eight steps
      }
    }
  }
}

TEST(Handovers, ImpactsOnTheSlopeUnderWayGoOnInAnIsland)
{
  // A cube falls on its face; another one flies past it while it is pressed in.
  constexpr double kFaster = 60.0, kDuration = 2.5e-3;
  for (const RestitutionModel model :
    { RestitutionModel::Velocity, RestitutionModel::NormalTangential })
  {
    for (const double e : { 0.3, 0.6, 1.0 })
    {
      for (const double over : { 0.25, 0.5, 0.75 })
      {
        SurfaceMaterial ground = material(e, 0.0);
        ground.restitutionModel = model;
        Pile pile;
        pile.ground = makeSlope(
          9, 150.0, [](double, double) { return 0.0; }, ground);
        pile.parameters.endTime = 1.1;
        const double joined = 1.01, touches = joined - over * kDuration;
        const double drop = 0.5 * kGravity * touches * touches, speed = kGravity * touches;
        pile.rocks = { brick(Vec3(1, 1, 1), Vec3(500.0, 500.0, 0.5 + drop), 0),
          brick(Vec3(1, 1, 1),
            Vec3(501.015, 498.85 - kFaster * joined, 1.6 + 0.5 * kGravity * joined * joined), 1) };
        pile.rocks[1].velocity = Vec3(0.0, kFaster, 0.0);
        pile.make();
        pile.fall->release();
        EXPECT_EQ(mostTogether(pile, 1.07), 2);
        const BlockState& state = pile.fall->state(0);
        const double up = std::sqrt(
          state.velocity.z() * state.velocity.z() + 2.0 * kGravity * (state.position.z() - 0.5));
        EXPECT_GT(state.velocity.z(), 0.0);
        // Of a step of 5 ms: gravity is in it once.
        EXPECT_NEAR(up / speed, e, 0.01) << over << ' ' << int(model);
        ASSERT_EQ(pile.fall->rock(0).trajectory().impacts.size(), 1u);
        EXPECT_EQ(pile.fall->rock(1).trajectory().impacts.size(), 0u);
      }
    }
  }
}

TEST(Handovers, WhatTurnsDeeperThanTheStepReckonedIsNoCompression)
{
  // A cube lies on a larger one with a spring of 1e10 N/m under each corner, and tips by 1e-5:
  // 5 μm deeper on one side would be 5e4 N that nothing has pressed in.
  constexpr double kStiffness = 1e10, kCompressed = 1e-8, kTip = 1e-5;
  const Block small(makeBox(Vec3::Constant(1.0)), 2700.0, 1e10, 0.2);
  const Block large(makeBox(Vec3::Constant(3.0)), 2700.0, 1e10, 0.2);
  BlockState under, over;
  over.position = Vec3(0.1, 0.2, 2.0 - kCompressed);
  const auto body = [](const Block& block, const BlockState& state)
  {
    PlacedBlock placed;
    placed.place(block, state);
    PairBody result;
    result.update(placed);
    return result;
  };
  RockPair pair;
  const PairBody second = body(large, under);
  updatePair(body(small, over), second, 0.01, pair);
  ASSERT_EQ(pair.contacts.size(), 4u);
  for (Contact& c : pair.contacts)
  {
    c.stiffness = c.shearStiffness = kStiffness;
    c.state = ContactState::Locked;
    c.offset = c.distance + kCompressed;
  }
  over.orientation = Quat(Eigen::AngleAxisd(kTip, Vec3::UnitY()));
  updatePair(body(small, over), second, 0.01, pair);
  ASSERT_EQ(pair.contacts.size(), 4u);
  for (const Contact& c : pair.contacts)
  {
    const double rise = -kTip * (c.point.x() - over.position.x()); // of this corner, m
    EXPECT_NEAR(c.distance, rise - kCompressed, 1e-9);
    EXPECT_NEAR(c.gap(), std::max(rise, 0.0) - kCompressed, 1e-9);
  }
}
