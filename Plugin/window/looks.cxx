#include "looks.h"

#include "vtkSMIntVectorProperty.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMTransferFunctionProxy.h"
#include "vtkSMViewProxy.h"

#include <array>
#include <string>
#include <vector>

namespace rockfall::window
{

namespace
{

using Colour = std::array<double, 3>;

constexpr Colour kSlope = { 0.76, 0.74, 0.70 };
constexpr Colour kRelease = { 0.10, 0.25, 0.55 };
constexpr Colour kRock = { 0.55, 0.27, 0.07 };
constexpr Colour kBuilt = { 0.20, 0.42, 0.24 };
constexpr Colour kLine = { 0.05, 0.05, 0.05 };
constexpr double kPathWidth = 3.0;   ///< px
constexpr double kMarkerWidth = 5.0; ///< px, of edges of blocks, so that they are seen from afar
constexpr double kPointSize = 6.0;   ///< px

/// From low to high, as red, green, blue.
using Palette = std::array<Colour, 4>;
constexpr Palette kHeat = { { { 1.00, 0.93, 0.55 }, { 0.99, 0.62, 0.24 }, { 0.86, 0.15, 0.12 },
  { 0.40, 0.00, 0.13 } } };
constexpr Palette kFlow = { { { 0.27, 0.00, 0.33 }, { 0.19, 0.41, 0.56 }, { 0.21, 0.72, 0.47 },
  { 0.99, 0.91, 0.14 } } };
constexpr Palette kHeights = { { { 0.84, 0.89, 0.97 }, { 0.54, 0.71, 0.86 }, { 0.20, 0.45, 0.71 },
  { 0.03, 0.19, 0.42 } } };

/// One sequential palette for each quantity, and how a legend calls it.
struct Quantity
{
  const char* array; ///< What the array's name begins with.
  const char* title;
  const Palette& palette;
};
constexpr Quantity kQuantities[] = {
  { "Speed", "Speed (m/s)", kFlow },
  { "ReachProbability", "Probability of passing", kHeat },
  { "KineticEnergy", "Kinetic energy (J)", kHeat },
  { "HeightOverGround", "Height over ground (m)", kHeights },
  { "RotationRate", "Rotation rate (rad/s)", kFlow },
  { "Passages", "Passages", kHeat },
  { "Rocks", "Rocks", kHeat },
  { "StoppingPoints", "Rocks that stop", kHeat },
  { "Elevation", "Elevation (m)", kHeights },
  { "Time", "Time (s)", kFlow },
};

template <typename... Values>
void set(vtkSMProxy* proxy, const char* property, Values... values)
{
  if (!proxy->GetProperty(property))
  {
    return; // of another version or kind of representation
  }
  vtkSMPropertyHelper helper(proxy, property);
  if (vtkSMIntVectorProperty::SafeDownCast(proxy->GetProperty(property)))
  {
    const std::array<int, sizeof...(values)> numbers = { int(values)... };
    helper.Set(numbers.data(), unsigned(numbers.size()));
    return;
  }
  const std::array<double, sizeof...(values)> numbers = { double(values)... };
  helper.Set(numbers.data(), unsigned(numbers.size()));
}

void setColour(vtkSMProxy* proxy, const Colour& colour)
{
  for (const char* property : { "AmbientColor", "DiffuseColor" })
  {
    set(proxy, property, colour[0], colour[1], colour[2]);
  }
  vtkSMPVRepresentationProxy::SetScalarColoring(proxy, nullptr, 0);
}

/// Blocks of a metre on slopes of kilometres: edges of some pixels are seen from everywhere.
void setMarker(vtkSMProxy* proxy, const Colour& colour)
{
  setColour(proxy, colour);
  if (auto* representation = vtkSMRepresentationProxy::SafeDownCast(proxy))
  {
    representation->SetRepresentationType("Surface With Edges");
  }
  set(proxy, "EdgeColor", colour[0], colour[1], colour[2]);
  set(proxy, "LineWidth", kMarkerWidth);
}

const Quantity* quantityOf(const std::string& array)
{
  for (const Quantity& quantity : kQuantities)
  {
    if (array.rfind(quantity.array, 0) == 0)
    {
      return &quantity;
    }
  }
  return nullptr;
}

/// "KineticEnergy95" is "Kinetic energy (J), 95 %".
std::string titleOf(const std::string& array, const Quantity& quantity)
{
  const std::string rest = array.substr(std::string(quantity.array).size());
  if (rest.empty())
  {
    return quantity.title;
  }
  const bool number = rest.find_first_not_of("0123456789") == std::string::npos;
  return std::string(quantity.title) + ", " +
    (number                 ? rest + " %"
        : rest == "Mean"    ? "mean"
        : rest == "Maximum" ? "maximum"
                            : rest);
}

std::string colouredBy(vtkSMProxy* proxy)
{
  if (!vtkSMPVRepresentationProxy::GetUsingScalarColoring(proxy))
  {
    return {};
  }
  const char* array = vtkSMPropertyHelper(proxy, "ColorArrayName").GetInputArrayNameToProcess();
  return array ? array : "";
}

bool is(const Shown& shown, const char* name, int port)
{
  return shown.source && shown.source->GetXMLName() == std::string(name) && shown.port == port;
}

} // namespace

Shown shownBy(vtkSMProxy* representation)
{
  if (!representation || !representation->GetProperty("Input"))
  {
    return {};
  }
  vtkSMPropertyHelper input(representation, "Input");
  if (input.GetNumberOfElements() == 0)
  {
    return {};
  }
  return { vtkSMSourceProxy::SafeDownCast(input.GetAsProxy()), int(input.GetOutputPort()) };
}

void style(vtkSMProxy* representation)
{
  const Shown shown = shownBy(representation);
  if (!vtkSMPVRepresentationProxy::SafeDownCast(representation))
  {
    return;
  }
  if (is(shown, "DEMToCFEMesh", 0) || is(shown, "DrawnStructure", 0))
  {
    setColour(representation, kSlope);
    set(representation, "Specular", 0.0);
  }
  else if (is(shown, "RockRelease", 0) || is(shown, "RockBlocks", 0) ||
    is(shown, "JointedRockMass", 0))
  {
    setMarker(representation, kRelease);
  }
  else if (is(shown, "RockfallSimulation", 0))
  {
    setMarker(representation, kRock);
  }
  else if (is(shown, "RockfallSimulation", 1) || is(shown, "RockPaths", 0))
  {
    set(representation, "LineWidth", kPathWidth);
    set(representation, "RenderLinesAsTubes", 1);
  }
  else if (is(shown, "RockfallSimulation", 4) || is(shown, "TrajectoryCollector", 0))
  {
    setColour(representation, kLine);
    set(representation, "PointSize", kPointSize);
    set(representation, "RenderPointsAsSpheres", 1);
  }
  else if (is(shown, "TrajectoryCollector", 3))
  {
    setColour(representation, kLine);
    if (auto* walls = vtkSMRepresentationProxy::SafeDownCast(representation))
    {
      walls->SetRepresentationType("Surface With Edges");
    }
    set(representation, "EdgeColor", kLine[0], kLine[1], kLine[2]);
    set(representation, "LineWidth", kPathWidth);
  }
  else if (is(shown, "DEMToCFEMesh", 1) || is(shown, "DrawnStructure", 1))
  {
    setColour(representation, kBuilt);
  }
  else if (is(shown, "RockfallHazardMap", 1))
  {
    set(representation, "Specular", 0.0);
  }
  representation->UpdateVTKObjects();
}

void rescale(vtkSMProxy* representation)
{
  if (quantityOf(colouredBy(representation)))
  {
    vtkSMPVRepresentationProxy::RescaleTransferFunctionToDataRange(representation, false, false);
  }
}

void styleIn(vtkSMProxy* representation, vtkSMViewProxy* view)
{
  const Shown shown = shownBy(representation);
  if (is(shown, "TrajectoryCollector", 2) || is(shown, "MergeCollectors", 2))
  {
    if (!representation->GetProperty("XArrayName"))
    {
      return; // a table, not a chart
    }
    vtkSMPropertyHelper(representation, "UseIndexForXAxis").Set(0);
    vtkSMPropertyHelper(representation, "XArrayName").Set("EnergyInKilojoules");
    vtkSMPropertyHelper visible(representation, "SeriesVisibility");
    for (const char* column :
      { "Line", "KineticEnergy", "EnergyInKilojoules", "HeightOverGround", "ShareOfReleased" })
    {
      visible.SetStatus(column, 0);
    }
    visible.SetStatus("ShareOfPassing", 1);
    vtkSMPropertyHelper(representation, "SeriesLabel")
      .SetStatus("ShareOfPassing", "Share of the rocks that pass");
    vtkSMPropertyHelper(representation, "SeriesLineThickness").SetStatus("ShareOfPassing", "2");
    representation->UpdateVTKObjects();
    vtkSMPropertyHelper(view, "ChartTitle").Set("Energy at the line");
    vtkSMPropertyHelper(view, "BottomAxisTitle").Set("Kinetic energy (kJ)");
    vtkSMPropertyHelper(view, "LeftAxisTitle").Set("Share with at least this energy");
    view->UpdateVTKObjects();
    return;
  }
  const std::string array = colouredBy(representation);
  const Quantity* quantity = quantityOf(array);
  if (!shown.source || array.empty() || !quantity ||
    !vtkSMPVRepresentationProxy::SafeDownCast(representation))
  {
    return;
  }
  vtkSMProxy* table = vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy();
  if (!table)
  {
    return;
  }
  std::vector<double> points;
  for (std::size_t k = 0; k < quantity->palette.size(); ++k)
  {
    points.push_back(double(k) / double(quantity->palette.size() - 1));
    points.insert(points.end(), quantity->palette[k].begin(), quantity->palette[k].end());
  }
  vtkSMPropertyHelper(table, "RGBPoints").Set(points.data(), unsigned(points.size()));
  vtkSMPropertyHelper(table, "ColorSpace").Set(0); // RGB
  table->UpdateVTKObjects();
  vtkSMPVRepresentationProxy::RescaleTransferFunctionToDataRange(representation, false, false);
  if (vtkSMPropertyHelper(representation, "Visibility").GetAsInt() == 0)
  {
    return;
  }
  vtkSMPVRepresentationProxy::SetScalarBarVisibility(representation, view, true);
  if (vtkSMProxy* bar = vtkSMTransferFunctionProxy::FindScalarBarRepresentation(table, view))
  {
    vtkSMPropertyHelper(bar, "Title").Set(titleOf(array, *quantity).c_str());
    vtkSMPropertyHelper(bar, "ComponentTitle").Set("");
    vtkSMPropertyHelper(bar, "RangeLabelFormat").Set("%.3g");
    bar->UpdateVTKObjects();
  }
}

} // namespace rockfall::window
