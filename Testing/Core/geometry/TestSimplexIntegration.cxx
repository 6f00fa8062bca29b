/// Simplex integration against closed forms, against a Monte Carlo count, and far from the origin.

#include "geometry/simplexIntegration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rockfall
{

namespace
{

// Sums of some tens of products of numbers near 1.
constexpr double kIntegralRounding = 1e-14;

const std::vector<std::vector<int>> tetrahedron = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 },
  { 0, 3, 2 } };
const std::vector<std::vector<int>> hexahedron = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 },
  { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };

std::vector<Vec3> boxCorners(const Vec3& low, const Vec3& high)
{
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
  {
    points.emplace_back(
      (i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z());
  }
  return points;
}

} // namespace

TEST(SimplexIntegration, UnitSimplex)
{
  const std::vector<Vec3> points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  const VolumeIntegrals result = integrateSimplices(points, tetrahedron);
  EXPECT_NEAR(result.volume, 1.0 / 6.0, kIntegralRounding);
  EXPECT_LT((result.centroid - Vec3::Constant(0.25)).norm(), kIntegralRounding);
  // ∫x² = 1/60 and ∫xy = 1/120 about the corner; less V/16 about the centroid.
  const Mat3 expected =
    Mat3::Constant(1.0 / 120.0 - 1.0 / 96.0) + Mat3(Vec3::Constant(1.0 / 120.0).asDiagonal());
  EXPECT_LT((result.second - expected).norm(), kIntegralRounding);
}

TEST(SimplexIntegration, Box)
{
  const Vec3 lengths(2.0, 3.0, 0.5); // m
  const Vec3 low(-0.3, 0.4, 5.0);
  const VolumeIntegrals result = integrateSimplices(boxCorners(low, low + lengths), hexahedron);
  EXPECT_NEAR(result.volume, 3.0, 3.0 * kIntegralRounding);
  EXPECT_LT((result.centroid - low - 0.5 * lengths).norm(), 6.0 * kIntegralRounding);
  const Mat3 expected = (3.0 / 12.0 * lengths.cwiseAbs2()).asDiagonal();
  EXPECT_LT((result.second - expected).norm(), 3.0 * kIntegralRounding);
}

TEST(SimplexIntegration, NotConvex)
{
  // A 2 × 2 × 1 slab without one quarter: three unit cubes.
  std::vector<Vec3> points;
  for (const double z : { 0.0, 1.0 })
  {
    for (const auto& [x, y] : std::vector<std::pair<double, double>>{
           { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } })
    {
      points.emplace_back(x, y, z);
    }
  }
  std::vector<std::vector<int>> faces = { { 5, 4, 3, 2, 1, 0 }, { 6, 7, 8, 9, 10, 11 } };
  for (int i = 0; i < 6; ++i)
  {
    const int j = (i + 1) % 6;
    faces.push_back({ i, j, j + 6, i + 6 });
  }
  const VolumeIntegrals result = integrateSimplices(points, faces);
  EXPECT_NEAR(result.volume, 3.0, 3.0 * kIntegralRounding);
  EXPECT_LT((result.centroid - Vec3(5.0 / 6.0, 5.0 / 6.0, 0.5)).norm(), 3.0 * kIntegralRounding);
  // Σ V/12 + (offset of each cube)²: 3/12 + 1/9 + 1/9 + 4/9.
  EXPECT_NEAR(result.second(0, 0), 0.25 + 6.0 / 9.0, 3.0 * kIntegralRounding);
  // Offsets (−⅓, −⅓), (⅔, −⅓), (−⅓, ⅔).
  EXPECT_NEAR(result.second(0, 1), -3.0 / 9.0, 3.0 * kIntegralRounding);
}

TEST(SimplexIntegration, MonteCarlo)
{
  // A sheared, tapered box, whose inside is told by six half spaces.
  std::vector<Vec3> points = boxCorners(Vec3::Zero(), Vec3::Ones());
  for (Vec3& p : points)
  {
    const double narrow = 1.0 - 0.4 * p.z();
    p = Vec3(narrow * p.x() + 0.3 * p.z(), narrow * p.y() - 0.1 * p.z(), p.z());
  }
  const VolumeIntegrals result = integrateSimplices(points, hexahedron);

  std::mt19937_64 generator(20140902);
  std::uniform_real_distribution<double> uniform(-0.2, 1.2);
  constexpr int draws = 400000;
  const double weight = 1.4 * 1.4 * 1.4 / draws; // m³ per draw
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (int i = 0; i < draws; ++i)
  {
    const Vec3 p(uniform(generator), uniform(generator), uniform(generator));
    const double narrow = 1.0 - 0.4 * p.z();
    const double x = (p.x() - 0.3 * p.z()) / narrow, y = (p.y() + 0.1 * p.z()) / narrow;
    if (p.z() >= 0 && p.z() <= 1 && x >= 0 && x <= 1 && y >= 0 && y <= 1)
    {
      const Vec3 arm = p - result.centroid;
      volume += weight;
      first += weight * arm;
      second += weight * arm * arm.transpose();
    }
  }
  // A count's standard deviation is weight √(draws p (1 − p)) = 0.0018 m³; four of them. The
  // moments' integrands are below 1 m and 1 m², so theirs is less.
  constexpr double statistical = 0.0072;
  EXPECT_NEAR(result.volume, volume, statistical);
  EXPECT_LT(first.cwiseAbs().maxCoeff(), statistical);
  EXPECT_LT((result.second - second).cwiseAbs().maxCoeff(), statistical);
}

TEST(SimplexIntegration, ShiftInvariance)
{
  // Eighths survive the shift exactly, so nothing but the integration can lose digits.
  const Vec3 low(-0.625, 0.375, 1.0), high(0.5, 2.25, 1.875), shift(5e5, 4e6, 2048.0);
  const VolumeIntegrals near = integrateSimplices(boxCorners(low, high), hexahedron);
  const VolumeIntegrals far = integrateSimplices(boxCorners(low + shift, high + shift), hexahedron);
  EXPECT_NEAR(far.volume, near.volume, kIntegralRounding);
  EXPECT_LT((far.second - near.second).norm(), kIntegralRounding);
  // The centroid itself is rounded to the grid of doubles at 4e6, 2⁻³¹ m apart.
  EXPECT_LT((far.centroid - shift - near.centroid).norm(), 0x1p-30);
}

TEST(SimplexIntegration, InvertedFacesGiveNegativeVolume)
{
  std::vector<std::vector<int>> inverted = hexahedron;
  for (std::vector<int>& loop : inverted)
  {
    std::reverse(loop.begin(), loop.end());
  }
  const VolumeIntegrals result =
    integrateSimplices(boxCorners(Vec3::Zero(), Vec3::Ones()), inverted);
  EXPECT_NEAR(result.volume, -1.0, kIntegralRounding);
  EXPECT_LT((result.centroid - Vec3::Constant(0.5)).norm(), kIntegralRounding);
}

TEST(SimplexIntegration, NothingAndFlat)
{
  const VolumeIntegrals nothing = integrateSimplices({}, {});
  EXPECT_EQ(nothing.volume, 0.0);
  const std::vector<Vec3> flat = { { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 }, { 1, 1, 1 } };
  const VolumeIntegrals result = integrateSimplices(flat, tetrahedron);
  EXPECT_EQ(result.volume, 0.0);
  EXPECT_TRUE(result.centroid.allFinite());
}

} // namespace rockfall
