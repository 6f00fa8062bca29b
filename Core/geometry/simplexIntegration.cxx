#include "geometry/simplexIntegration.h"

namespace rockfall
{

VolumeIntegrals integrateSimplices(
  std::span<const Vec3> points, std::span<const std::vector<int>> faces)
{
  VolumeIntegrals result;
  if (points.empty())
  {
    return result;
  }
  // With r inside the body no digit of a large coordinate enters a product. Summing differences
  // keeps r itself inside at any distance from the origin.
  Vec3 reference = Vec3::Zero();
  for (const Vec3& point : points)
  {
    reference += point - points.front();
  }
  reference = points.front() + reference / double(points.size());

  double zeroth = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const std::vector<int>& face : faces)
  {
    for (std::size_t i = 2; i < face.size(); ++i)
    {
      const Vec3 a = points[face[0]] - reference;
      const Vec3 b = points[face[i - 1]] - reference;
      const Vec3 c = points[face[i]] - reference;
      const Vec3 s = a + b + c;
      const double jacobian = a.dot(b.cross(c));
      zeroth += jacobian;
      first += jacobian * s;
      second +=
        jacobian * (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
    }
  }
  result.volume = zeroth / 6.0;
  result.centroid = reference;
  result.second = second / 120.0;
  if (result.volume != 0.0)
  {
    const Vec3 arm = first / (24.0 * result.volume);
    result.centroid += arm;
    result.second -= result.volume * arm * arm.transpose();
  }
  return result;
}

} // namespace rockfall
