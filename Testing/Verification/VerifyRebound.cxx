// METHOD 9.1 and 10.1 (paper figs 12, 13): a cube dropped face down, elastic.

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;

namespace
{

Rock cubeOver(double height, double youngModulus)
{
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(10.0, 10.0, 0.5 + height);
  rock.youngModulus = youngModulus;
  return rock;
}

/// Rebound over incident velocity, both brought to the height of the floor along the parabola.
double reboundRatio(const Trajectory& t, double height)
{
  const Sample* s = lastInFlight(t);
  if (!s)
  {
    return 0.0;
  }
  const double squared =
    s->velocity.z() * s->velocity.z() + 2.0 * kGravity * (s->position.z() - 0.5);
  return std::sqrt(std::max(0.0, squared) / (2.0 * kGravity * height));
}

SimulationParameters dropParameters(double timeStep, double penalty)
{
  SimulationParameters p;
  p.timeStep = timeStep;
  p.normalPenalty = penalty;
  p.endTime = 1.0; // before the second touch: 3 t₁ is 1.35 s and more
  p.outputInterval = 0.01;
  return p;
}

/// Ratios for drops from 1 to 3 m.
std::vector<double> ratios(const Terrain& floor, int drops, double youngModulus,
  const SimulationParameters& p, std::int64_t& unsettled)
{
  std::vector<Rock> rocks;
  std::vector<double> heights;
  for (int k = 0; k < drops; ++k)
  {
    heights.push_back(drops > 1 ? 1.0 + 2.0 * k / (drops - 1) : 2.0);
    rocks.push_back(cubeOver(heights.back(), youngModulus));
  }
  const std::vector<Trajectory> runs = simulateAll(floor, rocks, p);
  std::vector<double> result;
  for (int k = 0; k < drops; ++k)
  {
    result.push_back(reboundRatio(runs[k], heights[k]));
    unsettled += runs[k].summary.unsettledSteps;
  }
  return result;
}

/// The same drop by another way, as a reference: the cube's own variables for a face-down fall
/// (centroid, εx, εy, εz; the others stay zero), four springs under it, velocity Verlet at a
/// hundredth of the stiffest period, until it has left for good. Nothing is dissipated: what the
/// centroid lacks is in the cube's vibration.
double referenceRatio(double youngModulus, double penalty, double height)
{
  constexpr double kDensity = 2500.0, kPoisson = 0.1; // 1 m³
  const double lambda = youngModulus * kPoisson / ((1.0 + kPoisson) * (1.0 - 2.0 * kPoisson));
  const double mu = 0.5 * youngModulus / (1.0 + kPoisson);
  const double strainMass = kDensity / 12.0; // ρ∫x² dV
  const double stiffest = std::sqrt(
    (3.0 * lambda + 2.0 * mu) / strainMass + 4.0 * penalty * (1.0 / kDensity + 0.25 / strainMass));
  const double h = 2.0 * std::numbers::pi / stiffest / 100.0;
  const double incident = std::sqrt(2.0 * kGravity * height);
  double w = 0.0, rate = -incident;
  Vec3 strain = Vec3::Zero(), strainRate = Vec3::Zero();
  double pull = 0.0; // acceleration of the centroid
  Vec3 strainPull = Vec3::Zero();
  const auto accelerate = [&]
  {
    const double force = -4.0 * penalty * std::min(0.0, w - 0.5 * strain.z());
    pull = force / kDensity - kGravity;
    strainPull = -(Vec3::Constant(lambda * strain.sum()) + 2.0 * mu * strain);
    strainPull.z() -= 0.5 * force;
    strainPull /= strainMass;
  };
  accelerate();
  for (double time = 0.0; time < 0.5 && w < 0.1 * height; time += h)
  {
    rate += 0.5 * h * pull;
    strainRate += 0.5 * h * strainPull;
    w += h * rate;
    strain += h * strainRate;
    accelerate();
    rate += 0.5 * h * pull;
    strainRate += 0.5 * h * strainPull;
  }
  return std::sqrt(std::max(0.0, rate * rate + 2.0 * kGravity * w)) / incident;
}

} // namespace

TEST(Rebound, RatioIsOneWhateverThePhaseOfTheStep)
{
  const Terrain floor = flatGround(20.0, surface(1.0, 15.0), 5);
  const int drops = count(40, 200);
  for (double penalty : { 1e8, 1e9, 1e10, 1e11, 1e12 })
  {
    double lowest = 10.0, highest = 0.0;
    std::int64_t unsettled = 0;
    for (double timeStep : { 0.01, 0.005, 0.001 })
    {
      for (double ratio : ratios(floor, drops, 1e11, dropParameters(timeStep, penalty), unsettled))
      {
        lowest = std::min(lowest, ratio);
        highest = std::max(highest, ratio);
      }
    }
    const std::string head = "penalty " + text(penalty) + " N/m, E 1e11 Pa, " +
      std::to_string(drops) + " heights of 1 to 3 m, Δt 0.01, 0.005 and 0.001 s: ";
    const char* reason = "1 in theory (METHOD 9.1); a literal DDA gives 0.03 to 2.81 (METHOD 10.1)";
    record({ "Elastic rebound", head + "least ratio", "", reason }, lowest, 1.0, 0.01);
    record({ "Elastic rebound", head + "greatest ratio", "", reason }, highest, 1.0, 0.01);
    report({ "Elastic rebound", head + "unsettled steps", "", "" }, double(unsettled));
  }
}

TEST(Rebound, FallsBelowOneGigapascal)
{
  // Paper fig. 13.
  const Terrain floor = flatGround(20.0, surface(1.0, 15.0), 5);
  std::int64_t unsettled = 0;
  std::vector<double> moduli;
  for (double modulus = 1e6; modulus < 2e11; modulus *= 10.0)
  {
    moduli.push_back(modulus);
  }
  for (double penalty : { 1e7, 1e8, 1e9, 1e10, 1e11, 1e12 })
  {
    // The reference takes 1e7 steps for the stiffest springs and says nothing new there.
    const bool referred = penalty <= 1e9;
    std::vector<double> reference;
    for (double modulus : moduli)
    {
      if (referred && modulus <= 1e10)
      {
        reference.push_back(referenceRatio(modulus, penalty, 2.0));
      }
    }
    if (referred)
    {
      addCurve("rebound", "reference, penalty " + text(penalty) + " N/m",
        std::span(moduli).first(reference.size()), reference);
    }
    for (double timeStep : { 0.01, 0.005 })
    {
      std::vector<double> curve;
      double highest = 0.0;
      for (double modulus : moduli)
      {
        const std::vector<double> r =
          ratios(floor, count(3, 20), modulus, dropParameters(timeStep, penalty), unsettled);
        double sum = 0.0;
        for (double ratio : r)
        {
          sum += ratio;
          highest = std::max(highest, ratio);
        }
        curve.push_back(sum / double(r.size()));
      }
      addCurve(
        "rebound", "Δt " + text(timeStep) + " s, penalty " + text(penalty) + " N/m", moduli, curve);
      const std::string head =
        "fig. 13, Δt " + text(timeStep) + " s, penalty " + text(penalty) + " N/m: ";
      recordAtMost(
        { "Elastic rebound", head + "greatest ratio of all moduli", "", "no energy may be made" },
        highest, 1.01);
      record({ "Elastic rebound", head + "mean ratio at E 1e11 Pa", "",
               "a stiff block keeps its energy (paper 3.1)" },
        curve.back(), 1.0, 0.01);
      if (penalty >= 1e9)
      {
        recordAtMost({ "Elastic rebound", head + "mean ratio at E 1e6 Pa", "",
                       "paper 3.1: below E = 1e9 Pa the block's deformation takes energy" },
          curve[0], 0.95);
        recordAtLeast({ "Elastic rebound", head + "mean ratio at E 1e6 Pa", "",
                        "it takes a part of it: at 1e9 N/m the reference keeps 0.80" },
          curve[0], 0.5);
      }
      for (std::size_t k = 0; k < reference.size(); ++k)
      {
        record(
          { "Elastic rebound", head + "mean ratio at E " + text(moduli[k]) + " Pa", "",
            "the same variables and springs integrated by another rule, nothing dissipated; what "
            "the vibration holds at take-off depends on its phase, hence 0.15" },
          curve[k], reference[k], 0.15);
      }
    }
  }
}

TEST(Rebound, VelocityHistory)
{
  // Paper fig. 12: the velocity against time through two bounces. The slope made of CFEs;
  // VerifyBlockSlope.cxx has the slope as a fixed block.
  const Terrain floor = flatGround(20.0, surface(1.0, 15.0), 5);
  for (double timeStep : { 0.01, 0.005 })
  {
    SimulationParameters p = dropParameters(timeStep, 1e9);
    p.endTime = 3.0;
    p.outputInterval = 0.01;
    const Trajectory t = rockfall::testing::simulate(floor, cubeOver(2.0, 1e11), p);
    std::vector<double> times, speeds;
    double worst = 0.0;
    const double first = std::sqrt(2.0 * 2.0 / kGravity);
    for (const Sample& s : t.samples)
    {
      times.push_back(s.time);
      speeds.push_back(s.velocity.z());
      // Saw tooth of an instantaneous elastic rebound, away from the jumps.
      const double phase = std::remainder(s.time, 2.0 * first);
      if (std::abs(std::abs(phase) - first) > 0.03)
      {
        worst = std::max(worst, std::abs(s.velocity.z() + kGravity * phase));
      }
    }
    addCurve("velocity-history", "CFEs, Δt " + text(timeStep) + " s", times, speeds);
    recordAtMost({ "Elastic rebound",
                   "fig. 12, Δt " + text(timeStep) +
                     " s, drop of 2 m: largest deviation from the saw tooth in 3 s, away from the "
                     "impacts",
                   "m/s",
                   "the contact of a penalty spring lasts π √(m/4p), 2.5 ms, which the closed form "
                   "lacks: g times that per bounce, and 1 % of 6.26 m/s for the ratio" },
      worst, 0.05 + 0.0626);
  }
}
