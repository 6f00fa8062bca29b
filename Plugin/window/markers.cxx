#include "markers.h"

#include "looks.h"

#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRepresentationProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace rockfall::window
{

namespace
{

constexpr double kLeastPixels = 7.0; ///< Of a body that is drawn as one.
constexpr double kPi = 3.14159265358979;

/// Size of a body and what stands for it from afar; 0 for what is no marker.
struct Marker
{
  double size = 0.0; ///< m
  const char* fromAfar = "Points";
};

Marker markerOf(const Shown& shown)
{
  const bool blocks =
    isOf(shown.source, { "vtkRockBlockSource", "vtkJointedRockMass", "vtkRockfallSimulation" }) &&
    shown.port == 0;
  if (blocks)
  {
    vtkPVArrayInformation* volume = shown.source->GetDataInformation(unsigned(shown.port))
                                      ->GetCellDataInformation()
                                      ->GetArrayInformation("Volume");
    return { volume ? std::cbrt(std::max(0.0, volume->GetComponentRange(0)[1])) : 0.0, "Points" };
  }
  if (isOf(shown.source, { "vtkTrajectoryCollector" }) && shown.port == 3)
  {
    return { vtkSMPropertyHelper(shown.source, "BarrierHeight").GetAsDouble(), "Wireframe" };
  }
  return {};
}

/// Metres per pixel at the middle of what is shown; 0 if the view has no camera.
double pixelAt(const double bounds[6], vtkSMViewProxy* view)
{
  if (!view->GetProperty("CameraPosition") || !view->GetProperty("ViewSize"))
  {
    return 0.0;
  }
  double position[3], size[2];
  vtkSMPropertyHelper(view, "CameraPosition").Get(position, 3);
  vtkSMPropertyHelper(view, "ViewSize").Get(size, 2);
  double square = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    square += std::pow(0.5 * (bounds[2 * k] + bounds[2 * k + 1]) - position[k], 2);
  }
  const double height = std::max(1.0, size[1]);
  if (vtkSMPropertyHelper(view, "CameraParallelProjection").GetAsInt())
  {
    return 2.0 * vtkSMPropertyHelper(view, "CameraParallelScale").GetAsDouble() / height;
  }
  const double angle = vtkSMPropertyHelper(view, "CameraViewAngle").GetAsDouble() * kPi / 180.0;
  return 2.0 * std::sqrt(square) * std::tan(0.5 * angle) / height;
}

} // namespace

bool fitMarker(vtkSMProxy* representation, vtkSMViewProxy* view)
{
  const Shown shown = shownBy(representation);
  auto* drawn = vtkSMRepresentationProxy::SafeDownCast(representation);
  if (!shown.source || !drawn || !drawn->GetProperty("Representation"))
  {
    return false;
  }
  const Marker marker = markerOf(shown);
  double bounds[6];
  shown.source->GetDataInformation(unsigned(shown.port))->GetBounds(bounds);
  if (!(marker.size > 0.0) || bounds[0] > bounds[1])
  {
    return false;
  }
  const double pixel = pixelAt(bounds, view);
  const std::string now = vtkSMPropertyHelper(representation, "Representation").GetAsString();
  const std::string nearby = "Surface With Edges";
  if (!(pixel > 0.0) || (now != nearby && now != marker.fromAfar))
  {
    return false;
  }
  const std::string wanted = marker.size < kLeastPixels * pixel ? marker.fromAfar : nearby;
  if (wanted == now)
  {
    return false;
  }
  drawn->SetRepresentationType(wanted.c_str());
  representation->UpdateVTKObjects();
  return true;
}

} // namespace rockfall::window
