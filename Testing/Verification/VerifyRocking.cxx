// A slender block rocks on its corners (Housner 1963).

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;

namespace
{

constexpr double kHalfBreadth = 0.25, kHalfHeight = 1.0; // m

/// Tilted by θ₀ (rad) about one lower edge, which lies on the ground, and let go.
Rock tilted(double tilt)
{
  Rock rock;
  rock.shape = makeBox({ 2.0 * kHalfBreadth, 1.0, 2.0 * kHalfHeight });
  rock.orientation = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  const Vec3 edge(kHalfBreadth, 0.0, -kHalfHeight);
  rock.position = Vec3(10.0, 10.0, 0.0) - rock.orientation * edge;
  return rock;
}

double tiltOf(const Sample& s)
{
  const Vec3 up = s.orientation * Vec3::UnitZ();
  return std::atan2(up.x(), up.z());
}

/// When the tilt first passes through zero, s; −1 if it does not.
double quarterPeriod(const Trajectory& t)
{
  for (std::size_t k = 1; k < t.samples.size(); ++k)
  {
    const double before = tiltOf(t.samples[k - 1]), now = tiltOf(t.samples[k]);
    if (before > 0.0 && now <= 0.0)
    {
      return t.samples[k - 1].time +
        (t.samples[k].time - t.samples[k - 1].time) * before / (before - now);
    }
  }
  return -1.0;
}

} // namespace

TEST(Rocking, QuarterPeriodIsHousners)
{
  const double radius = std::hypot(kHalfBreadth, kHalfHeight);
  const double alpha = std::atan2(kHalfBreadth, kHalfHeight);
  const double p = std::sqrt(3.0 * kGravity / (4.0 * radius));
  for (double share : { 0.25, 0.5, 0.75 })
  {
    const double tilt = share * alpha;
    const double housner = std::acosh(1.0 / (1.0 - share)) / p;
    // Without Housner's sin θ ≈ θ: θ̈ = −p² sin(α − θ), t = ∫ dθ / θ̇ by the midpoint rule in
    // θ = θ₀ (1 − s²), which takes the root at the start away.
    double exact = 0.0;
    constexpr int kPanels = 20000;
    for (int k = 0; k < kPanels; ++k)
    {
      const double s = (k + 0.5) / kPanels, theta = tilt * (1.0 - s * s);
      // ½ θ̇² = p² (cos(α − θ₀) − cos(α − θ)).
      const double rate =
        p * std::sqrt(2.0 * std::max(0.0, std::cos(alpha - tilt) - std::cos(alpha - theta)));
      exact += 2.0 * tilt * s / kPanels / std::max(rate, 1e-300);
    }
    SimulationParameters parameters;
    parameters.endTime = 1.5;
    parameters.outputInterval = 0.001;
    const Trajectory t = rockfall::testing::simulate(
      flatGround(20.0, surface(0.8, 60.0), 3), tilted(tilt), parameters);
    const double measured = quarterPeriod(t);
    const std::string head =
      "half-sizes 0.25 x 1 m, θ₀ = " + text(share) + " α: quarter period before the first impact";
    record({ "Rocking block", head, "s",
             "Housner's T/4 = acosh(1/(1 − θ₀/α))/p, p² = 3g/4R (T = 1.972 s at θ₀ = α/2); his "
             "sin θ ≈ θ is good to 0.5 % here" },
      measured, housner, 0.01 * housner);
    record({ "Rocking block", head + ", beside the equation with the sine", "s",
             "by quadrature; 0.3 % for springs and Δt" },
      measured, exact, 0.003 * exact);
    if (share == 0.5)
    {
      std::vector<double> times, tilts;
      for (const Sample& s : t.samples)
      {
        times.push_back(s.time);
        tilts.push_back(degrees(tiltOf(s)));
      }
      addCurve("rocking", "this code", times, tilts);
      std::vector<double> exactTimes, exactTilts;
      for (double time = 0.0; time < housner; time += 0.01)
      {
        exactTimes.push_back(time);
        exactTilts.push_back(degrees(alpha - (alpha - tilt) * std::cosh(p * time)));
      }
      addCurve("rocking", "Housner, to the first impact", exactTimes, exactTilts);
    }
  }
}
