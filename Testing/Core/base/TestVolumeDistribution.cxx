// Volumes by each law: quantiles against closed forms, bounds kept, and what is out of range.

#include "base/VolumeDistribution.h"
#include "base/errors.h"
#include "gisFiles.h"

#include <cmath>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

VolumeDistribution law(VolumeLaw kind, double mean, double deviation, double least, double most)
{
  VolumeDistribution d;
  d.law = kind;
  d.mean = mean;
  d.deviation = deviation;
  d.minimum = least;
  d.maximum = most;
  return d;
}

/// Mean of the volumes by the midpoint rule over their shares.
double mean(const VolumeDistribution& d)
{
  const int n = 20000;
  double sum = 0.0;
  for (int k = 0; k < n; ++k)
  {
    sum += d.quantile((k + 0.5) / n);
  }
  return sum / n;
}

/// 97.725 % of a normal distribution is below its mean and two deviations.
constexpr double twoSigma = 0.977249868051821;

} // namespace

TEST(VolumeDistribution, quantilesAreThoseOfTheLaws)
{
  EXPECT_EQ(law(VolumeLaw::Fixed, 2.5, 1, 1, 2).quantile(0.3), 2.5);
  EXPECT_DOUBLE_EQ(law(VolumeLaw::Uniform, 1, 1, 1.0, 3.0).quantile(0.25), 1.5);
  const VolumeDistribution normal = law(VolumeLaw::Normal, 5.0, 0.5, 0.0, 0.0);
  EXPECT_NEAR(normal.quantile(0.5), 5.0, 1e-12);
  EXPECT_NEAR(normal.quantile(twoSigma), 6.0, 1e-9);
  // ln V has σ² = ln(1 + (s/m)²) and its mean at ln m − σ²/2.
  const VolumeDistribution log = law(VolumeLaw::LogNormal, 2.0, 1.0, 0.0, 0.0);
  const double sigma = std::sqrt(std::log(1.25));
  EXPECT_NEAR(log.quantile(0.5), 2.0 * std::exp(-0.5 * sigma * sigma), 1e-12);
  EXPECT_NEAR(log.quantile(twoSigma), log.quantile(0.5) * std::exp(2.0 * sigma), 1e-8);
  EXPECT_NEAR(mean(log), 2.0, 2e-3); // the midpoint rule misses a part of the tail
  // N(> V) ∝ V⁻ᵇ.
  VolumeDistribution power = law(VolumeLaw::PowerLaw, 1, 1, 0.1, 10.0);
  power.exponent = 0.5;
  for (double v : { 0.2, 1.0, 7.0 })
  {
    const double below =
      (std::pow(0.1, -0.5) - std::pow(v, -0.5)) / (std::pow(0.1, -0.5) - std::pow(10.0, -0.5));
    EXPECT_NEAR(power.quantile(below), v, 1e-12 * v) << v;
  }
}

TEST(VolumeDistribution, boundsCutOffInProportion)
{
  // Symmetric bounds keep the mean; a half line from the mean on has its median at 0.6745 σ.
  EXPECT_NEAR(mean(law(VolumeLaw::Normal, 5.0, 2.0, 4.0, 6.0)), 5.0, 1e-9);
  EXPECT_NEAR(
    law(VolumeLaw::Normal, 5.0, 2.0, 5.0, 0.0).quantile(0.5), 5.0 + 2.0 * 0.674489750196, 1e-9);
  for (const VolumeLaw kind :
    { VolumeLaw::Uniform, VolumeLaw::Normal, VolumeLaw::LogNormal, VolumeLaw::PowerLaw })
  {
    const VolumeDistribution d = law(kind, 1.0, 2.0, 0.5, 3.0);
    d.validate();
    double before = 0.0;
    for (double u : { 1e-17, 0.001, 0.5, 0.999, 1.0 - 1e-16 })
    {
      const double v = d.quantile(u);
      EXPECT_GE(v, 0.5);
      EXPECT_LE(v, 3.0);
      EXPECT_GE(v, before);
      before = v;
    }
  }
  EXPECT_GT(law(VolumeLaw::Normal, 1.0, 5.0, 0.0, 0.0).quantile(1e-17), 0.0);
  EXPECT_EQ(law(VolumeLaw::Normal, 1.0, 0.0, 0.0, 0.0).quantile(0.9), 1.0);
}

TEST(VolumeDistribution, namesAndErrors)
{
  for (int k = 0; k < 5; ++k)
  {
    EXPECT_EQ(volumeLawFromName(volumeLawName(VolumeLaw(k))), VolumeLaw(k));
  }
  EXPECT_EQ(volumeLawFromName("PowerLaw"), VolumeLaw::PowerLaw);
  const auto error = [](const VolumeDistribution& d)
  { return messageOf<ParameterError>([&] { d.validate(); }); };
  EXPECT_TRUE(holds(error(law(VolumeLaw(9), 1, 1, 1, 2)), { "VolumeLaw is 9" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::Fixed, 0, 1, 1, 2)), { "Volume is 0" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::Normal, NAN, 1, 0, 0)), { "Volume is nan" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::Normal, 1, -1, 0, 0)), { "VolumeDeviation is -1" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::LogNormal, 1, 1e200, 0, 0)),
    { "VolumeDeviation is 1e+200", "a thousand times Volume, which is 1" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::Fixed, 1, 1, -1, 0)), { "VolumeMinimum is -1" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::Uniform, 1, 1, 1, 0)), { "VolumeMaximum is 0" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::Uniform, 1, 1, 3, 2)), { "VolumeMaximum is 2", "is 3" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::PowerLaw, 1, 1, 0, 2)), { "VolumeMinimum is 0" }));
  EXPECT_TRUE(
    holds(error(law(VolumeLaw::Normal, 1, 0.1, 5, 9)), { "leave nothing", "5", "9", "0.1" }));
  EXPECT_TRUE(holds(error(law(VolumeLaw::Normal, 1, 0, 5, 9)), { "Volume is 1", "within" }));
  VolumeDistribution power = law(VolumeLaw::PowerLaw, 1, 1, 1, 2);
  power.exponent = 0.0;
  EXPECT_TRUE(holds(error(power), { "VolumeExponent is 0" }));
}
