#include "slopeView.h"

#include "vtkAlgorithm.h"
#include "vtkPolyData.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"

#include <algorithm>
#include <cmath>

namespace rockfall::window
{

namespace
{

constexpr double kElevation = 35.0 * 3.14159265358979 / 180.0; ///< Of the camera, rad.
/// From the slope's centre, in half diagonals: all of it is in the picture.
constexpr double kDistance = 2.1;
constexpr vtkIdType kMostPoints = 20000; ///< Of those that the plane is fitted to.

struct Way
{
  double x = 0.0, y = -1.0; ///< From the south where there is no slope.
};

/// Downhill, in plan: the gradient of the plane that fits best.
Way downhill(vtkPolyData* mesh)
{
  double b[6];
  mesh->GetBounds(b);
  const double cx = 0.5 * (b[0] + b[1]), cy = 0.5 * (b[2] + b[3]);
  const vtkIdType step = std::max<vtkIdType>(1, mesh->GetNumberOfPoints() / kMostPoints);
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0, sx = 0.0, sy = 0.0, sz = 0.0, n = 0.0;
  for (vtkIdType k = 0; k < mesh->GetNumberOfPoints(); k += step)
  {
    double p[3];
    mesh->GetPoint(k, p);
    const double x = p[0] - cx, y = p[1] - cy, z = p[2];
    xx += x * x;
    xy += x * y;
    yy += y * y;
    xz += x * z;
    yz += y * z;
    sx += x;
    sy += y;
    sz += z;
    n += 1.0;
  }
  const double a = xx - sx * sx / n, c = xy - sx * sy / n, d = yy - sy * sy / n;
  const double e = xz - sx * sz / n, f = yz - sy * sz / n, determinant = a * d - c * c;
  if (!(determinant > 0.0))
  {
    return {};
  }
  const double gx = (d * e - c * f) / determinant, gy = (a * f - c * e) / determinant;
  const double steepness = std::hypot(gx, gy);
  return steepness > 1e-3 ? Way{ -gx / steepness, -gy / steepness } : Way{};
}

} // namespace

void lookFromValley(vtkSMSourceProxy* slope, vtkSMViewProxy* view)
{
  auto* algorithm = vtkAlgorithm::SafeDownCast(slope->GetClientSideObject());
  auto* mesh = algorithm ? vtkPolyData::SafeDownCast(algorithm->GetOutputDataObject(0)) : nullptr;
  if (!mesh || mesh->GetNumberOfPoints() == 0 || !view->GetProperty("CameraPosition"))
  {
    return;
  }
  double b[6];
  mesh->GetBounds(b);
  const double centre[3] = { 0.5 * (b[0] + b[1]), 0.5 * (b[2] + b[3]), 0.5 * (b[4] + b[5]) };
  const double distance =
    kDistance * 0.5 * std::sqrt(std::pow(b[1] - b[0], 2) + std::pow(b[3] - b[2], 2));
  const Way way = downhill(mesh);
  const double position[3] = { centre[0] + distance * std::cos(kElevation) * way.x,
    centre[1] + distance * std::cos(kElevation) * way.y,
    centre[2] + distance * std::sin(kElevation) };
  const double up[3] = { 0.0, 0.0, 1.0 };
  vtkSMPropertyHelper(view, "CameraPosition").Set(position, 3);
  vtkSMPropertyHelper(view, "CameraFocalPoint").Set(centre, 3);
  vtkSMPropertyHelper(view, "CameraViewUp").Set(up, 3);
  vtkSMPropertyHelper(view, "CenterOfRotation").Set(centre, 3);
  if (view->GetProperty("UseLight")) // the light kit: a key light from above, a fill from below
  {
    vtkSMPropertyHelper(view, "UseLight").Set(1);
  }
  view->UpdateVTKObjects();
}

} // namespace rockfall::window
