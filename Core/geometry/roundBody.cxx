#include "geometry/roundBody.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

/// Fewest vertices of a mesh that is fine enough.
constexpr std::size_t kFewestOnRound = 60;
/// Distance of its vertices from the surface, share of the semi-axes: what single precision leaves.
constexpr double kOnRound = 2e-6;
/// Least distance of a face from the centre, share of that of the plane that touches the body: 14°
/// from the middle of a face to its corners.
constexpr double kFineRound = 0.97;

} // namespace

VolumeIntegrals RoundBody::integrals() const
{
  VolumeIntegrals result;
  result.volume = 4.0 / 3.0 * std::numbers::pi * axes.determinant();
  result.centroid = centre;
  result.second = result.volume / 5.0 * (axes * axes);
  return result;
}

std::optional<RoundBody> roundBodyOf(
  std::span<const Vec3> points, std::span<const Vec3> normals, std::span<const double> offsets)
{
  if (points.size() < kFewestOnRound)
  {
    return std::nullopt;
  }
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points)
  {
    middle += p / double(points.size());
  }
  double size = 0.0;
  for (const Vec3& p : points)
  {
    size = std::max(size, (p - middle).norm());
  }
  // xᵀ M x + b · x = 1 by least squares, of places about the middle in units of their size.
  using Nine = Eigen::Matrix<double, 9, 1>;
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  Nine right = Nine::Zero();
  const auto rowAt = [&](const Vec3& p)
  {
    const Vec3 x = (p - middle) / size;
    Nine row;
    row << x.cwiseAbs2(), 2.0 * x.y() * x.z(), 2.0 * x.z() * x.x(), 2.0 * x.x() * x.y(), x;
    return row;
  };
  for (const Vec3& p : points)
  {
    const Nine row = rowAt(p);
    normal.noalias() += row * row.transpose();
    right += row;
  }
  const Nine fit = normal.ldlt().solve(right);
  for (const Vec3& p : points)
  {
    if (!(std::abs(fit.dot(rowAt(p)) - 1.0) < 2.0 * kOnRound))
    {
      return std::nullopt;
    }
  }
  Mat3 m;
  m << fit[0], fit[5], fit[4], fit[5], fit[1], fit[3], fit[4], fit[3], fit[2];
  const Vec3 b = fit.tail<3>();
  const Vec3 off = -0.5 * m.ldlt().solve(b);
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(m / (1.0 + off.dot(m * off)));
  if (!(eigen.eigenvalues()[0] > 0.0))
  {
    return std::nullopt;
  }
  RoundBody body;
  Vec3 semi = size * eigen.eigenvalues().cwiseInverse().cwiseSqrt();
  if (semi[0] - semi[2] < kOnRound * semi[0])
  {
    semi.setConstant(semi.mean()); // a sphere to the last digit: it turns as one
    body.axes = semi[0] * Mat3::Identity();
  }
  else
  {
    body.axes = eigen.eigenvectors() * semi.asDiagonal() * eigen.eigenvectors().transpose();
  }
  body.centre = middle + size * off;
  body.most = semi[0];
  body.least = semi[2];
  for (std::size_t f = 0; f < normals.size(); ++f)
  {
    const double inside = offsets[f] - normals[f].dot(body.centre);
    if (!(inside > kFineRound * (body.axes * normals[f]).norm()))
    {
      return std::nullopt;
    }
  }
  return body;
}

} // namespace rockfall
