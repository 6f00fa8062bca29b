// What is kept of a trajectory, its way to another process, and the hash of its motion.

#include "piles.h"

#include "base/errors.h"
#include "rock/retention.h"
#include "run/packing.h"
#include "run/stateHash.h"

#include <gtest/gtest.h>

#include <set>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Sample sampleAt(double time, SampleKind kind, bool contact)
{
  Sample sample;
  sample.time = time;
  sample.kind = kind;
  sample.contact = contact;
  sample.position = Vec3(time, 2.0, 3.0);
  sample.velocity = Vec3(1.0, time, -1.0);
  sample.energy.friction = 10.0 * time;
  return sample;
}

std::vector<ImpactEvent> twoImpacts()
{
  std::vector<ImpactEvent> impacts(2);
  impacts[0].time = 0.7;
  impacts[1].time = 1.5;
  impacts[1].cfe = 77;
  return impacts;
}

/// Flies, touches at 0.7, takes off at 0.8, touches at 1.5 and slides round a corner to rest.
Trajectory fall(const std::vector<ImpactEvent>& impacts = twoImpacts(), bool keep = true)
{
  using enum SampleKind;
  Trajectory t;
  t.samples = { sampleAt(0.0, Even, false), sampleAt(0.5, Even, false), sampleAt(0.7, Knot, false),
    sampleAt(0.75, Knot, true), sampleAt(0.8, Knot, false), sampleAt(1.0, Even, false),
    sampleAt(1.5, Knot, false), sampleAt(1.8, Knot, true), sampleAt(2.0, Even, true),
    sampleAt(2.3, End, true) };
  t.summary.rock = 3;
  t.summary.iteration = 4;
  t.summary.blockId = 5;
  t.summary.maxHeightOverGround = 1.25;
  for (const ImpactEvent& impact : impacts)
  {
    noteImpact(t, impact, keep);
  }
  return t;
}

std::vector<double> timesKept(Retention retention)
{
  Trajectory t = fall();
  thin(t, retention);
  std::vector<double> times;
  for (const Sample& sample : t.samples)
  {
    times.push_back(sample.time);
  }
  return times;
}

} // namespace

TEST(Retention, KeepsWhatItSays)
{
  using Times = std::vector<double>;
  EXPECT_EQ(timesKept(Retention::Nothing), Times());
  EXPECT_EQ(timesKept(Retention::StoppingPoints), Times({ 2.3 }));
  EXPECT_EQ(timesKept(Retention::Events), Times({ 0.0, 0.7, 0.8, 1.5, 2.3 }));
  EXPECT_EQ(timesKept(Retention::Thinned), Times({ 0.0, 0.7, 0.75, 0.8, 1.5, 1.8, 2.3 }));
  EXPECT_EQ(timesKept(Retention::Full).size(), 10u);
  // One that never moved is its own end.
  const std::vector<Sample> one = { sampleAt(0.0, SampleKind::End, false) };
  EXPECT_TRUE(keptSamples(one, Retention::Nothing).empty());
  EXPECT_EQ(keptSamples(one, Retention::Events).size(), 1u);
  EXPECT_TRUE(keptSamples({}, Retention::Full).empty());
}

namespace
{

/// Rocks of 0.3 m³ over each other, each so far (m) along x from the one under it.
Pile leaningColumn(Shape shape, int rocks, double along)
{
  Pile pile;
  pile.ground = floorSlope();
  Rock rock;
  rock.shape = makeShape(shape, 0.3);
  for (rock.blockId = 0; rock.blockId < rocks; ++rock.blockId)
  {
    rock.position = Vec3(20.0 + along * double(rock.blockId), 20.0, 1.0 + double(rock.blockId));
    pile.rocks.push_back(rock);
  }
  return pile;
}

} // namespace

TEST(Retention, PathsHaveOnePointAtATime)
{
  // Steps of Δt end where samples are due, but for rounding.
  Pile pile = leaningColumn(Shape::Icosahedron, 12, 0.03);
  pile.parameters.outputInterval = 0.05;
  pile.parameters.endTime = 3.0;
  pile.make();
  int even = 0;
  for (const Trajectory& t : pile.fall->run())
  {
    double fastest = 0.0;
    for (std::size_t k = 1; k < t.samples.size(); ++k)
    {
      EXPECT_GT(t.samples[k].time - t.samples[k - 1].time, 4e-10);
    }
    for (const Sample& sample : t.samples)
    {
      const double due = std::round(sample.time / 0.05) * 0.05;
      even += std::abs(sample.time - due) < 1e-9;
      fastest = std::max(fastest, sample.velocity.norm());
    }
    EXPECT_LE(fastest, t.summary.maxSpeed);
    // Lists of many thousand rocks have no room that stays empty.
    EXPECT_LE(8 * t.samples.capacity(), 9 * t.samples.size() + 40);
    EXPECT_LE(8 * t.impacts.capacity(), 9 * t.impacts.size() + 40);
  }
  EXPECT_GE(even, 12 * 20);
}

namespace
{

/// Eight rocks fall on each other.
std::vector<Trajectory> fallsKeeping(const Kept& kept)
{
  Pile pile = leaningColumn(Shape::Cube, 8, 0.05);
  pile.parameters.kept = kept;
  pile.parameters.endTime = 2.0;
  pile.make();
  return pile.fall->run();
}

} // namespace

TEST(Retention, NoMoreIsCollectedThanIsKept)
{
  const std::vector<Trajectory> whole = fallsKeeping({});
  std::size_t listed = 0;
  for (const Retention retention : { Retention::Nothing, Retention::StoppingPoints,
         Retention::Events, Retention::Thinned, Retention::Full })
  {
    const bool impacts = retention == Retention::Events;
    std::vector<Trajectory> falls = fallsKeeping({ retention, impacts });
    ASSERT_EQ(falls.size(), whole.size());
    for (std::size_t k = 0; k < falls.size(); ++k)
    {
      Trajectory& t = falls[k];
      EXPECT_EQ(motionHash(t), motionHash(whole[k]));
      EXPECT_GT(t.summary.impacts, 0);
      EXPECT_EQ(t.impacts.size(), impacts ? std::size_t(t.summary.impacts) : 0u);
      EXPECT_EQ(t.impacts.capacity() > 0, impacts);
      listed += t.impacts.size();
      const std::vector<std::size_t> kept = keptSamples(whole[k].samples, retention);
      // Besides the first one and two that may still change; with next to no room that is empty.
      EXPECT_LE(t.samples.size(), kept.size() + 3);
      EXPECT_LE(8 * t.samples.capacity(), 9 * t.samples.size() + 40);
      thin(t, retention);
      ASSERT_EQ(t.samples.size(), kept.size());
      for (std::size_t n = 0; n < kept.size(); ++n)
      {
        const Sample& sample = whole[k].samples[kept[n]];
        EXPECT_EQ(t.samples[n].time, sample.time);
        EXPECT_EQ(t.samples[n].kind, sample.kind);
        EXPECT_EQ(t.samples[n].position, sample.position);
        EXPECT_EQ(t.samples[n].energy.numerical, sample.energy.numerical);
      }
    }
  }
  EXPECT_GT(listed, 20u);
}

TEST(Packing, IsTheSameOnTheOtherSide)
{
  std::vector<char> bytes;
  Trajectory empty;
  empty.summary.rock = 9;
  pack(fall(), bytes);
  pack(empty, bytes);
  pack(fall(), bytes);
  std::span<const char> left(bytes);
  for (int k = 0; k < 3; ++k)
  {
    const Trajectory t = unpack(left);
    if (k == 1)
    {
      EXPECT_EQ(t.summary.rock, 9);
      EXPECT_TRUE(t.samples.empty() && t.impacts.empty());
      continue;
    }
    EXPECT_EQ(motionHash(t), motionHash(fall()));
    ASSERT_EQ(t.samples.size(), 10u);
    EXPECT_EQ(t.samples[3].time, 0.75);
    EXPECT_EQ(t.samples[3].kind, SampleKind::Knot);
    EXPECT_TRUE(t.samples[3].contact);
    EXPECT_EQ(t.samples[3].energy.friction, 7.5);
    ASSERT_EQ(t.impacts.size(), 2u);
    EXPECT_EQ(t.impacts[1].cfe, 77);
    EXPECT_EQ(t.summary.blockId, 5);
    EXPECT_EQ(t.summary.maxHeightOverGround, 1.25);
  }
  EXPECT_TRUE(left.empty());
}

TEST(Packing, SaysWhereItEnds)
{
  std::vector<char> bytes;
  pack(fall(), bytes);
  for (std::size_t size : { std::size_t(0), std::size_t(15), std::size_t(40), bytes.size() - 1 })
  {
    std::span<const char> part(bytes.data(), size);
    EXPECT_THROW(unpack(part), DataError) << size;
  }
}

TEST(StateHash, TellsEveryBitOfTheMotion)
{
  std::set<std::uint64_t> hashes;
  const auto add = [&](auto change)
  {
    Trajectory t = fall();
    change(t);
    hashes.insert(motionHash(t));
  };
  add([](Trajectory&) {});
  add([](Trajectory& t) { t.summary.rock = 4; });
  add([](Trajectory& t) { t.summary.iteration = 5; });
  add([](Trajectory& t) { t.summary.fate = Fate::Rested; });
  add([](Trajectory& t) { t.summary.stop.y() = 1e-300; });
  add([](Trajectory& t) { t.summary.stop.y() = -0.0; });
  add([](Trajectory& t) { t.summary.energy.friction = 1e-300; });
  add([](Trajectory& t) { t.summary.contactSteps = 1; });
  add([](Trajectory& t) { t.samples.back().orientation.x() = 1e-300; });
  add([](Trajectory& t) { t.samples.back().velocity.x() = std::nextafter(1.0, 2.0); });
  const auto addImpacts = [&](auto change)
  {
    std::vector<ImpactEvent> impacts = twoImpacts();
    change(impacts);
    hashes.insert(motionHash(fall(impacts)));
  };
  addImpacts([](auto& impacts) { impacts[0].impulse = 1e-300; });
  addImpacts([](auto& impacts) { impacts[1].cfe = 78; });
  addImpacts([](auto& impacts) { std::swap(impacts[0].time, impacts[1].time); });
  addImpacts([](auto& impacts) { impacts.pop_back(); });
  EXPECT_EQ(hashes.size(), 14u);
  // What is only looked at is not part of it.
  add([](Trajectory& t) { thin(t, Retention::StoppingPoints); });
  add([](Trajectory& t) { t.summary.maxHeightOverGround = 9.0; });
  hashes.insert(motionHash(fall(twoImpacts(), false)));
  addImpacts([](auto& impacts) { std::swap(impacts[0], impacts[1]); }); // one was found later
  EXPECT_EQ(hashes.size(), 14u);
}

TEST(StateHash, DependsOnTheOrderAndHasSixteenDigits)
{
  StateHash a, b, none;
  a.add(1);
  a.add(2);
  b.add(2);
  b.add(1);
  EXPECT_NE(a.value(), b.value());
  EXPECT_EQ(none.text(), "0000000000000000");
  EXPECT_EQ(a.text().size(), 16u);
  EXPECT_EQ(std::stoull(a.text(), nullptr, 16), a.value());
  EXPECT_NE(a.text(), b.text());
}
