// The innermost loops of crowds: the same bits on every processor, the plain formulas, momentum
// kept, and the springs met where it has settled.

#include "solve/island/crowdKernel.h"

#include "law/contactLaw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

using namespace rockfall::crowd;

namespace
{

struct Crowd
{
  std::vector<Mover> movers;
  std::vector<int> changed;
  std::vector<Batch> batches;
  std::vector<Forces> forces;
};

/// Contacts of random directions between random rocks, no two of a batch on the same rock; with the
/// slope every second one.
Crowd randomCrowd(int rocks, int batches, bool slope, unsigned seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  Crowd crowd;
  crowd.movers.resize(std::size_t(rocks) + 1, Mover{});
  crowd.changed.assign(crowd.movers.size(), 0);
  for (int i = 0; i < rocks; ++i)
  {
    Mover& m = crowd.movers[std::size_t(i)];
    for (int k = 0; k < 3; ++k)
    {
      m.displacement[k] = 1e-2 * u(random);
      m.turn[k] = 1e-2 * u(random);
      m.inertia[k] = 1e-7 * (1.5 + u(random));
    }
    m.displacement[3] = 2e-8 * (1.5 + u(random));
    m.inertia[3] = 1e-8 * u(random);
    m.inertia[4] = 1e-8 * u(random);
    m.inertia[5] = 1e-8 * u(random);
  }
  std::vector<int> order(static_cast<std::size_t>(rocks));
  for (int i = 0; i < rocks; ++i)
  {
    order[std::size_t(i)] = i;
  }
  for (int b = 0; b < batches; ++b)
  {
    std::shuffle(order.begin(), order.end(), random);
    Batch batch = {};
    for (int lane = 0; lane < kLanes; ++lane)
    {
      // Three directions at right angles.
      double n[3] = { u(random), u(random), 1.0 }, t[3] = { n[1], -n[0], 0.0 };
      const double nn = std::hypot(n[0], n[1], n[2]), tt = std::hypot(t[0], t[1]);
      for (int k = 0; k < 3; ++k)
      {
        n[k] /= nn;
        t[k] /= tt;
      }
      const double v[3] = { n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2],
        n[0] * t[1] - n[1] * t[0] };
      for (int k = 0; k < 3; ++k)
      {
        batch.directions[0][k][lane] = n[k];
        batch.directions[1][k][lane] = t[k];
        batch.directions[2][k][lane] = v[k];
        batch.lever[0][k][lane] = 0.5 * u(random);
        batch.lever[1][k][lane] = slope ? 0.0 : 0.5 * u(random);
      }
      batch.w[lane] = 2e-7;
      batch.gap[lane] = 1e-2 * u(random);
      batch.stiffness[lane] = 1e9 / (1.0 + 1e9 * batch.w[lane]);
      batch.shear[lane] = 1e-9;
      batch.gain[lane] = batch.stiffness[lane];
      batch.friction[lane] = 0.3;
      batch.cohesion[lane] = lane == 0 ? 100.0 : 0.0;
      batch.body[0][lane] = order[std::size_t(2 * lane)];
      batch.body[1][lane] = slope ? rocks : order[std::size_t(2 * lane + 1)];
    }
    crowd.batches.push_back(batch);
    crowd.forces.push_back({});
  }
  return crowd;
}

/// Those that this processor can run.
std::vector<const Kernel*> kernelsHere()
{
  std::vector<const Kernel*> kernels = { &kAnywhere };
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2"))
  {
    kernels.push_back(&kAvx2);
  }
#endif
  kernels.push_back(&suitedKernel());
  return kernels;
}

double run(Crowd& crowd, const Kernel& kernel, bool slope, int sweeps)
{
  double change = 0.0;
  for (int number = 0; number < sweeps; ++number)
  {
    Pass pass;
    pass.first = crowd.batches.data();
    pass.forces = crowd.forces.data();
    pass.count = int(crowd.batches.size());
    pass.backwards = number % 2 != 0;
    pass.slope = slope;
    pass.movers = crowd.movers.data();
    pass.changed = crowd.changed.data();
    pass.number = number;
    pass.quiet = 1e-12;
    change = kernel.sweep(pass);
  }
  return change;
}

} // namespace

TEST(CrowdKernel, SameBitsOnEveryProcessor)
{
  for (const bool slope : { false, true })
  {
    Crowd one = randomCrowd(40, 60, slope, 11);
    // Between sweeps forces may be outside of their cones, and pull.
    std::mt19937_64 random(12);
    std::normal_distribution<double> force(0.0, 1e4);
    for (Forces& forces : one.forces)
    {
      for (auto& along : forces.along)
      {
        std::generate(std::begin(along), std::end(along), [&] { return force(random); });
      }
    }
    const Crowd start = one;
    const double a = run(one, kAnywhere, slope, 30);
    for (const Kernel* kernel : kernelsHere())
    {
      Crowd other = start;
      const double b = run(other, *kernel, slope, 30);
      EXPECT_EQ(a, b);
      EXPECT_EQ(one.changed, other.changed);
      EXPECT_EQ(
        std::memcmp(one.movers.data(), other.movers.data(), sizeof(Mover) * one.movers.size()), 0);
      EXPECT_EQ(
        std::memcmp(one.forces.data(), other.forces.data(), sizeof(Forces) * one.forces.size()), 0);
    }
    for (const Forces& forces : one.forces)
    {
      for (int lane = 0; lane < kLanes; ++lane)
      {
        EXPECT_GE(forces.along[0][lane], 0.0); // also where it pulled before; no NaN
      }
    }
  }
}

TEST(CrowdKernel, GoesFurtherInTheSameBits)
{
  // Against the plain formulas.
  const Crowd start = randomCrowd(37, 29, false, 3);
  std::mt19937_64 random(4);
  std::normal_distribution<double> force(0.0, 1e4), displacement(0.0, 1e-2);
  for (const bool anew : { false, true })
  {
    for (const Kernel* kernel : kernelsHere())
    {
      Crowd crowd = start;
      const std::size_t rocks = 37, count = crowd.forces.size();
      std::vector<Forces> forcesBefore(count), forcesAlong(count);
      std::vector<Motion> before(rocks), along(rocks);
      for (std::size_t k = 0; k < count; ++k)
      {
        for (Forces* f : { &crowd.forces[k], &forcesBefore[k], &forcesAlong[k] })
        {
          for (auto& of : f->along)
          {
            std::generate(std::begin(of), std::end(of), [&] { return force(random); });
          }
        }
      }
      for (std::size_t i = 0; i < rocks; ++i)
      {
        for (int k = 0; k < 3; ++k)
        {
          before[i].displacement[k] = displacement(random),
          before[i].turn[k] = displacement(random);
          along[i].displacement[k] = displacement(random),
          along[i].turn[k] = i % 5 == 0 ? 0.0 : displacement(random);
          along[i].displacement[k] *= i % 5 == 0 ? 0.0 : 1.0;
        }
        before[i].displacement[3] = crowd.movers[i].displacement[3];
      }
      double change = 0.0;
      for (std::size_t i = 0; i < rocks; ++i)
      {
        const Mover& m = crowd.movers[i];
        double displacements = 0.0, turns = 0.0;
        for (int k = 0; k < 3; ++k)
        {
          displacements += (m.displacement[k] - before[i].displacement[k]) *
            (m.displacement[k] - before[i].displacement[k]);
          turns += (m.turn[k] - before[i].turn[k]) * (m.turn[k] - before[i].turn[k]);
        }
        change += displacements / m.displacement[3] +
          3.0 * turns / (m.inertia[0] + m.inertia[1] + m.inertia[2]);
      }
      EXPECT_EQ(kernel->changeOf(crowd.movers.data(), before.data(), int(rocks)), change);
      const Crowd was = crowd;
      const std::vector<Forces> forcesWere = forcesBefore, forcesWent = forcesAlong;
      const std::vector<Motion> motionsWere = before, motionsWent = along;
      const Further further = { 0.7, anew, 1e-9, 11 };
      kernel->goForces(
        further, crowd.forces.data(), forcesBefore.data(), forcesAlong.data(), count);
      kernel->goMovers(
        further, crowd.movers.data(), before.data(), along.data(), crowd.changed.data(), rocks);
      const auto expect = [&](double now, double then, double went, double reached, double left)
      {
        EXPECT_EQ(now, reached + 0.7 * went);
        EXPECT_EQ(left, anew ? 0.0 : 0.7 * went + (reached - then));
      };
      for (std::size_t k = 0; k < count; ++k)
      {
        for (int of = 0; of < 3; ++of)
        {
          for (int i = 0; i < kLanes; ++i)
          {
            expect(crowd.forces[k].along[of][i], forcesWere[k].along[of][i],
              forcesWent[k].along[of][i], was.forces[k].along[of][i], forcesAlong[k].along[of][i]);
            EXPECT_EQ(forcesBefore[k].along[of][i], crowd.forces[k].along[of][i]);
          }
        }
      }
      for (std::size_t i = 0; i < rocks; ++i)
      {
        for (int k = 0; k < 3; ++k)
        {
          expect(crowd.movers[i].displacement[k], motionsWere[i].displacement[k],
            motionsWent[i].displacement[k], was.movers[i].displacement[k],
            along[i].displacement[k]);
          expect(crowd.movers[i].turn[k], motionsWere[i].turn[k], motionsWent[i].turn[k],
            was.movers[i].turn[k], along[i].turn[k]);
          EXPECT_EQ(before[i].turn[k], crowd.movers[i].turn[k]);
        }
        EXPECT_EQ(crowd.movers[i].displacement[3], was.movers[i].displacement[3]);
        EXPECT_EQ(crowd.changed[i], i % 5 == 0 ? 0 : 11);
      }
    }
  }
}

TEST(CrowdKernel, MobilityAndSpeculativeGapsAreThoseOfThePlainFormulas)
{
  Crowd crowd = randomCrowd(40, 20, false, 8);
  // Of a contact by itself: the change of the gap per force, and the gap where the rocks go.
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> stiff(1e8, 1e9);
  std::vector<Springs> springs(crowd.batches.size());
  std::vector<Speculative> speculative(crowd.batches.size());
  for (std::size_t k = 0; k < springs.size(); ++k)
  {
    const Batch& b = crowd.batches[k];
    for (int lane = 0; lane < kLanes; ++lane)
    {
      springs[k].penalty[lane] = stiff(random);
      springs[k].shear[lane] = lane == 1 ? 0.0 : stiff(random); // no contact: no number either
      speculative[k].gap[lane] = b.gap[lane];
      for (int side = 0; side < 2; ++side)
      {
        speculative[k].body[side][lane] = b.body[side][lane];
        for (int i = 0; i < 3; ++i)
        {
          speculative[k].normal[i][lane] = b.directions[0][i][lane];
          speculative[k].lever[side][i][lane] = b.lever[side][i][lane];
        }
      }
    }
  }
  const std::vector<Batch> before = crowd.batches;
  for (const Kernel* kernel : kernelsHere())
  {
    std::vector<Batch> batches = before;
    kernel->assemble(batches.data(), springs.data(), crowd.movers.data(), batches.size());
    std::vector<unsigned char> closes(speculative.size());
    const SpeculativePass pass = { speculative.data(), speculative.size(), crowd.movers.data(),
      crowd.changed.data(), 0, closes.data() };
    EXPECT_TRUE(kernel->findClosing(pass));
    int closed = 0;
    for (std::size_t k = 0; k < batches.size(); ++k)
    {
      const Batch& b = batches[k];
      for (int lane = 0; lane < kLanes; ++lane)
      {
        double w[3][3] = {}, gap = b.gap[lane];
        for (int side = 0; side < 2; ++side)
        {
          const Mover& m = crowd.movers[std::size_t(b.body[side][lane])];
          const double* I = m.inertia;
          const double inertia[3][3] = { { I[0], I[3], I[4] }, { I[3], I[1], I[5] },
            { I[4], I[5], I[2] } };
          double moment[3][3]; // of each direction
          for (int d = 0; d < 3; ++d)
          {
            for (int i = 0; i < 3; ++i)
            {
              const int j = (i + 1) % 3, l = (i + 2) % 3;
              moment[d][i] = b.lever[side][j][lane] * b.directions[d][l][lane] -
                b.lever[side][l][lane] * b.directions[d][j][lane];
            }
          }
          for (int i = 0; i < 3; ++i)
          {
            gap += (side == 0 ? 1.0 : -1.0) *
              (m.displacement[i] * b.directions[0][i][lane] + m.turn[i] * moment[0][i]);
            for (int d = 0; d < 3; ++d)
            {
              for (int e = 0; e < 3; ++e)
              {
                w[d][e] += m.displacement[3] * b.directions[d][i][lane] * b.directions[e][i][lane];
                for (int j = 0; j < 3; ++j)
                {
                  w[d][e] += moment[d][i] * inertia[i][j] * moment[e][j];
                }
              }
            }
          }
        }
        const double p = springs[k].penalty[lane], s = springs[k].shear[lane];
        EXPECT_NEAR(b.w[lane], w[0][0], 1e-12 * w[0][0]); // rounding
        EXPECT_NEAR(b.coupling[0][lane], w[0][1], 1e-12 * w[0][0]);
        EXPECT_NEAR(b.coupling[1][lane], w[0][2], 1e-12 * w[0][0]);
        EXPECT_NEAR(b.stiffness[lane], p / (1.0 + p * w[0][0]), 1e-9 * p);
        EXPECT_NEAR(b.shear[lane], s > 0.0 ? 1.0 / s : 0.0, 1e-18);
        const double mobile = std::max(w[1][1], w[2][2]) + std::abs(w[1][2]);
        EXPECT_NEAR(b.gain[lane], s / (1.0 + s * mobile), 1e-9 * p);
        EXPECT_GT(std::abs(gap), 1e-12);
        EXPECT_EQ((closes[k] >> lane & 1) != 0, gap < 0.0);
        closed += gap < 0.0;
      }
    }
    EXPECT_GT(closed, 20);
    EXPECT_LT(closed, 20 * kLanes - 20);
    // Around what has not moved since nothing is looked at.
    SpeculativePass still = pass;
    still.since = 1;
    EXPECT_FALSE(kernel->findClosing(still));
  }
}

TEST(CrowdKernel, MomentumIsKeptAndSpringsAreMet)
{
  Crowd crowd = randomCrowd(40, 30, false, 5);
  const auto momentum = [&](int k)
  {
    double sum = 0.0;
    for (int i = 0; i < 40; ++i)
    {
      const Mover& m = crowd.movers[std::size_t(i)];
      sum += m.displacement[k] / m.displacement[3];
    }
    return sum;
  };
  const double before[3] = { momentum(0), momentum(1), momentum(2) };
  run(crowd, suitedKernel(), false, 3000);
  for (int k = 0; k < 3; ++k)
  {
    // 40 rocks of some 3e7 kg/s² times 1e-2 m.
    EXPECT_NEAR(momentum(k), before[k], 1e-10 * 40 * 3e5);
  }
  int pressed = 0, sliding = 0;
  for (std::size_t at = 0; at < crowd.batches.size(); ++at)
  {
    const Batch& b = crowd.batches[at];
    const Forces& forces = crowd.forces[at];
    for (int lane = 0; lane < kLanes; ++lane)
    {
      double gap = b.gap[lane];
      for (int side = 0; side < 2; ++side)
      {
        const Mover& m = crowd.movers[std::size_t(b.body[side][lane])];
        const double l[3] = { b.lever[side][0][lane], b.lever[side][1][lane],
          b.lever[side][2][lane] };
        for (int k = 0; k < 3; ++k)
        {
          const int i = (k + 1) % 3, j = (k + 2) % 3;
          const double displacement = m.displacement[k] + m.turn[i] * l[j] - m.turn[j] * l[i];
          gap += (side == 0 ? displacement : -displacement) * b.directions[0][k][lane];
        }
      }
      const double normal = forces.along[0][lane];
      // Of a spring of 1e9 N/m, to 1e-9 m.
      EXPECT_NEAR(normal, std::max(0.0, -1e9 * gap), 1.0 + 1e-6 * normal);
      const double shear = std::hypot(forces.along[1][lane], forces.along[2][lane]);
      const double limit = 0.3 * normal + (normal > 0.0 ? b.cohesion[lane] : 0.0);
      EXPECT_LE(shear, limit * (1.0 + 1e-12));
      pressed += normal > 0.0;
      sliding += normal > 0.0 && shear > 0.999 * limit;
    }
  }
  EXPECT_GT(pressed, 20);
  EXPECT_GT(sliding, 5);
}

/// Where the sweeps have settled, forces are those of the one law of a contact for the gap and the
/// travel of its rocks.
TEST(CrowdKernel, SettlesOnTheLawOfTheContact)
{
  for (const bool slope : { false, true })
  {
    Crowd crowd = randomCrowd(40, 30, slope, 5);
    for (Batch& batch : crowd.batches)
    {
      for (int lane = 0; lane < kLanes; lane += 2)
      {
        batch.friction[lane] = 0.7; // more of these lock
      }
    }
    run(crowd, suitedKernel(), slope, 3000);
    int locked = 0, sliding = 0, open = 0;
    for (std::size_t at = 0; at < crowd.batches.size(); ++at)
    {
      const Batch& b = crowd.batches[at];
      for (int lane = 0; lane < kLanes; ++lane)
      {
        double along[3] = {}; // displacement of the first rock less the second
        for (int side = 0; side < 2; ++side)
        {
          const Mover& m = crowd.movers[std::size_t(b.body[side][lane])];
          for (int k = 0; k < 3; ++k)
          {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            const double displacement = m.displacement[k] + m.turn[i] * b.lever[side][j][lane] -
              m.turn[j] * b.lever[side][i][lane];
            for (int direction = 0; direction < 3; ++direction)
            {
              along[direction] +=
                (side == 0 ? displacement : -displacement) * b.directions[direction][k][lane];
            }
          }
        }
        rockfall::ContactLaw law;
        law.penalty = law.shearPenalty = 1e9;
        law.friction = b.friction[lane];
        law.cohesion = b.cohesion[lane];
        law.slip0 = { b.slip[0][lane], b.slip[1][lane] };
        law.evaluate(true, 0.005, b.gap[lane] + along[0], { along[1], along[2] });
        // Stiffness 1e9 N/m times displacements settled to 1e-9 m.
        const auto& forces = crowd.forces[at].along;
        EXPECT_NEAR(forces[0][lane], law.force, 1.0 + 1e-6 * law.force);
        EXPECT_NEAR(forces[1][lane], law.shearForce[0], 1.0 + 1e-5 * law.force);
        EXPECT_NEAR(forces[2][lane], law.shearForce[1], 1.0 + 1e-5 * law.force);
        locked += law.state == rockfall::ContactState::Locked;
        sliding += law.state == rockfall::ContactState::Sliding;
        open += law.state == rockfall::ContactState::Open;
      }
    }
    EXPECT_GT(locked, 2);
    EXPECT_GT(sliding, 5);
    EXPECT_GT(open, 5);
  }
}
