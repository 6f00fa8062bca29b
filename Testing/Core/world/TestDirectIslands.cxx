// Soft rows against one direct system of all rocks and contacts (directIsland.h), from the same
// states and contacts on.

#include "contact/pairs.h"
#include "directIsland.h"
#include "form.h"
#include "piles.h"
#include "randomScenes.h"
#include "solve/island/SoftSolver.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kNear = 0.02; ///< m
constexpr int kSteps = 8;
constexpr int kFine = 16; ///< Substeps of the direct system.

/// Boxes and icosahedra, turned at random, each over the last one.
Pile randomPile(SceneDraw& draw)
{
  Pile pile;
  pile.ground = floorSlope(draw.even(10.0, 50.0));
  pile.parameters.rockFrictionAngle = radians(draw.even(10.0, 45.0));
  pile.parameters.rockRestitution = 0.0;
  pile.parameters.timeStep = 0.005;
  const int rocks = 2 + draw.among(7);
  double height = 0.0;
  for (int k = 0; k < rocks; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = draw.oneIn(3) ? makeShape(Shape::Icosahedron, draw.even(0.2, 0.6))
                               : makeBox(Vec3(1.0, draw.even(0.5, 1.0), draw.even(0.3, 1.0)));
    rock.orientation =
      Quat(draw.even(-1.0, 1.0), draw.even(-1.0, 1.0), draw.even(-1.0, 1.0), draw.even(-1.0, 1.0))
        .normalized();
    const double radius = rock.shape.radius();
    rock.position = Vec3(20.0 + draw.even(-0.3, 0.3), 20.0 + draw.even(-0.3, 0.3), height + radius);
    height += 2.0 * radius;
    pile.rocks.push_back(rock);
  }
  return pile;
}

/// The rocks of a pile as they are, with springs that carry what their contacts carry.
DirectIsland islandOf(const Pile& pile)
{
  DirectIsland island;
  island.gravity = pile.parameters.gravity;
  for (int i = 0; i < pile.fall->rocks(); ++i)
  {
    island.blocks.push_back(&pile.blocks[std::size_t(i)]);
    island.states.push_back(pile.fall->state(i));
  }
  const auto add = [&](int first, int second, Contact c, double friction)
  {
    c.distance = c.gap();
    c.offset = 0.0;
    if (c.stiffness <= 0.0)
    {
      c.stiffness = c.shearStiffness = pile.parameters.normalPenalty;
    }
    if (c.distance < kNear)
    {
      island.touches.push_back({ first, second, c, friction });
    }
  };
  for (const RockPair* pair : pile.fall->pairs())
  {
    for (const Contact& c : pair->contacts)
    {
      add(pair->first, pair->second, c, pair->law.friction);
    }
  }
  for (int i = 0; i < pile.fall->rocks(); ++i)
  {
    for (const Contact& c : pile.fall->rock(i).body().contacts)
    {
      add(i, -1, c, c.friction);
    }
  }
  return island;
}

/// A step of soft rows. Returns whether there was an impact in it.
bool stepSoftly(DirectIsland& island, double duration)
{
  const std::vector<BlockState> from = island.states;
  std::vector<Touch> touches = island.touches;
  std::vector<IslandBody> bodies(island.states.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
  {
    bodies[i].block = island.blocks[i];
    bodies[i].state = &island.states[i];
  }
  std::vector<IslandContact> asked(touches.size());
  for (std::size_t k = 0; k < asked.size(); ++k)
  {
    const Touch& touch = touches[k];
    double radius = island.blocks[std::size_t(touch.first)]->radius();
    if (touch.second >= 0)
    {
      radius = std::min(radius, island.blocks[std::size_t(touch.second)]->radius());
    }
    asked[k].contact = &touches[k].contact;
    asked[k].first = touch.first;
    asked[k].second = touch.second;
    asked[k].friction = touch.friction;
    asked[k].resting = kRestingSpeed * std::sqrt(island.gravity * radius);
    asked[k].closed = touch.contact.closed();
  }
  SoftSolver().step(lastingStep(duration, island.gravity), bodies, asked, Accept::Any);
  bool struck = false;
  for (std::size_t k = 0; k < asked.size(); ++k)
  {
    Touch& touch = island.touches[k];
    const Vec3 before = touch.contact.normal;
    const Vec3 point = touch.contact.point;
    touch.contact = touches[k].contact;
    touch.contact.point = point;
    touch.carry(from, island.states);
    touch.contact.distance = touch.contact.gap();
    touch.contact.offset = 0.0;
    touch.force = touch.contact.normalForce * (before + touch.contact.normal).normalized();
    struck = struck || asked[k].struck > 0.0;
  }
  return struck;
}

struct Difference
{
  double motion = 0.0; ///< Of what gravity gives in the time.
  double force = 0.0;  ///< Of what a pair, or a rock and the slope, push each other with, or of
                       ///< the lighter one's weight.
};

/// None: there was an impact, not the same contacts push all the time, or no direct solution.
std::optional<Difference> compare(const DirectIsland& start, double step)
{
  DirectIsland soft = start, direct = start;
  using Forces = std::map<std::array<int, 2>, Vec3>;
  Forces forces, expected;
  const auto note = [&](const DirectIsland& island, Forces& to)
  {
    bool same = true;
    for (std::size_t k = 0; k < island.touches.size(); ++k)
    {
      const Touch& touch = island.touches[k];
      to.try_emplace({ touch.first, touch.second }, Vec3::Zero()).first->second +=
        touch.force / kSteps;
      const bool pushes = start.touches[k].contact.closed();
      same = same && pushes == (touch.force.norm() > 0.0) && pushes == touch.contact.closed();
    }
    return same;
  };
  for (int k = 0; k < kSteps; ++k)
  {
    const bool struck = stepSoftly(soft, step);
    direct.step(step, kFine);
    const bool softly = note(soft, forces), directly = note(direct, expected);
    if (struck || !softly || !directly)
    {
      return std::nullopt;
    }
  }
  if (direct.unsettled > 0) // one of fourteen
  {
    return std::nullopt;
  }
  Difference most;
  for (std::size_t i = 0; i < start.states.size(); ++i)
  {
    const Block& block = *start.blocks[i];
    const BlockState &a = soft.states[i], &b = direct.states[i];
    const Vec3 turning = b.orientation.conjugate() * (a.angularVelocity() - b.angularVelocity());
    const double square = (a.velocity - b.velocity).squaredNorm() +
      turning.dot(block.inertia() * turning) / block.mass();
    most.motion = std::max(most.motion, std::sqrt(square) / (start.gravity * kSteps * step));
  }
  for (const auto& [rocks, force] : forces)
  {
    double mass = start.blocks[std::size_t(rocks[0])]->mass();
    mass = rocks[1] < 0 ? mass : std::min(mass, start.blocks[std::size_t(rocks[1])]->mass());
    const Vec3& other = expected[rocks];
    most.force =
      std::max(most.force, (force - other).norm() / std::max(other.norm(), mass * start.gravity));
  }
  return most;
}

} // namespace

TEST(DirectIslands, SoftRowsMoveAndCarryAsOneDirectSystem)
{
  const int count = someOf(500, 1);
  int scenes = 0, within = 0;
  Difference worst;
  for (std::uint64_t seed = 1; scenes < count; ++seed)
  {
    SceneDraw draw(seed);
    Pile pile = randomPile(draw);
    pile.start();
    pile.run(0.2);
    for (int k = 0; k < someOf(20, 3); ++k)
    {
      pile.run(draw.even(0.05, 0.1));
      const DirectIsland island = islandOf(pile);
      const bool any = std::any_of(island.touches.begin(), island.touches.end(),
        [](const Touch& touch) { return touch.contact.closed(); });
      const std::optional<Difference> d =
        any ? compare(island, pile.parameters.timeStep) : std::nullopt;
      if (d)
      {
        ++scenes;
        within += d->motion < 0.01 && d->force < 0.01 ? 1 : 0;
        worst.motion = std::max(worst.motion, d->motion);
        worst.force = std::max(worst.force, d->force);
      }
    }
  }
  // The others: points that all but let go, and faces whose four points share their load otherwise
  // while they slide.
  EXPECT_GE(within, 0.98 * scenes);
  EXPECT_LT(worst.motion, 0.05);
  EXPECT_LT(worst.force, 0.05);
}
