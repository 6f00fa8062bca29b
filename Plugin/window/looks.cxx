#include "looks.h"

#include "chartLooks.h"
#include "classLooks.h"
#include "proxyNumbers.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMTransferFunctionProxy.h"
#include "vtkSMViewProxy.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace rockfall::window
{

namespace
{

constexpr Colour kSlope = { 0.76, 0.74, 0.70 };
constexpr Colour kRelease = { 0.10, 0.25, 0.55 };
constexpr Colour kRock = { 0.55, 0.27, 0.07 };
constexpr Colour kBuilt = { 0.20, 0.42, 0.24 };
constexpr Colour kLine = { 0.05, 0.05, 0.05 };
constexpr Colour kPicked = { 0.85, 0.05, 0.55 };
constexpr double kPickedWidth = 6.0; ///< px
/// Lines are flat: drawn as tubes, ParaView hides those on a slope behind it.
constexpr double kPathWidth = 3.0; ///< px
constexpr double kThinPath = 1.0;  ///< px
constexpr int kManyPaths = 50;
constexpr double kBuiltWidth = 2.0; ///< px
constexpr double kMarkerSize = 8.0; ///< px, of blocks from afar
constexpr double kPointSize = 6.0;  ///< px

/// From low to high, as red, green, blue.
using Palette = std::array<Colour, 4>;
constexpr Palette kHeat = { { { 1.00, 0.93, 0.55 }, { 0.99, 0.62, 0.24 }, { 0.86, 0.15, 0.12 },
  { 0.40, 0.00, 0.13 } } };
constexpr Palette kFlow = { { { 0.27, 0.00, 0.33 }, { 0.19, 0.41, 0.56 }, { 0.21, 0.72, 0.47 },
  { 0.99, 0.91, 0.14 } } };
constexpr Palette kHeights = { { { 0.84, 0.89, 0.97 }, { 0.54, 0.71, 0.86 }, { 0.20, 0.45, 0.71 },
  { 0.03, 0.19, 0.42 } } };

/// A sequential palette for each quantity, and how a legend calls it. The first whose name begins an
/// array's is that array's.
struct Quantity
{
  const char* array; ///< Beginning of the array's name.
  const char* words;
  const char* unit; ///< Of the legend; energies are in J in the arrays.
  const Palette* palette;
};
constexpr const char* kKilojoules = "kJ";
constexpr Quantity kQuantities[] = {
  { "Speed", "Speed", "m/s", &kFlow },
  { "Velocity", "Velocity", "m/s", &kFlow },
  { "ReachProbability", "Probability of passing", "", &kHeat },
  { "ExceedanceProbability", "Probability of more energy", "", &kHeat },
  { "AnnualFrequency", "Frequency", "1/a", &kHeat },
  { "Frequency", "Frequency", "1/a", &kHeat },
  { "ReturnPeriod", "Return period", "a", &kHeights },
  { "Intensity", "Intensity", "", &kHeat },
  { "KineticEnergy", "Kinetic energy", kKilojoules, &kHeat },
  { "PotentialEnergy", "Potential energy", kKilojoules, &kHeights },
  { "StrainEnergy", "Strain energy", kKilojoules, &kHeat },
  { "EnergyLoss", "Energy lost", kKilojoules, &kHeat },
  { "FrictionLoss", "Energy lost by friction", kKilojoules, &kHeat },
  { "RestitutionLoss", "Energy lost by restitution", kKilojoules, &kHeat },
  { "VibrationLoss", "Energy lost by vibration", kKilojoules, &kHeat },
  { "DampingLoss", "Energy lost by damping", kKilojoules, &kHeat },
  { "StructureLoss", "Energy lost to structures", kKilojoules, &kHeat },
  { "ScarLoss", "Energy lost to the ground", kKilojoules, &kHeat },
  { "RollingLoss", "Energy lost by rolling", kKilojoules, &kHeat },
  { "NumericalLoss", "Numerical loss", kKilojoules, &kHeat },
  { "GivenToRocks", "Energy given to rocks", kKilojoules, &kHeat },
  { "HeightOverGround", "Height over ground", "m", &kHeights },
  { "RotationRate", "Rotation rate", "rad/s", &kFlow },
  { "AngularVelocity", "Rotation rate", "rad/s", &kFlow },
  { "Impulse", "Impulse", "N s", &kHeat },
  { "Passages", "Passages", "", &kHeat },
  { "Rocks", "Rocks", "", &kHeat },
  { "StoppingPoints", "Rocks that stop", "", &kHeat },
  { "EnergyLineAngle", "Energy line", "°", &kHeights },
  { "EnergyTaken", "Energy taken", kKilojoules, &kHeat },
  { "HeldBefore", "Energy held before", kKilojoules, &kHeat },
  { "BrakingDistance", "Braking distance", "m", &kHeights },
  { "UsefulHeight", "Useful height", "m", &kHeights },
  { "HighestQuantile", "Highest quantile that the rocks can give", "%", &kHeights },
  { "Elevation", "Elevation", "m", &kHeights },
  { "Time", "Time", "s", &kFlow },
  { "Volume", "Volume", "m³", &kFlow },
  { "Mass", "Mass", "kg", &kFlow },
  { "Width", "Width", "m", &kFlow },
  { "Share", "Share of the rocks", "", &kHeat },
  { "Fate", "Fate", "", &kHeat },
  { "Outcome", "Outcome", "", &kHeat },
};

void setColour(vtkSMProxy* proxy, const Colour& colour)
{
  for (const char* property : { "AmbientColor", "DiffuseColor" })
  {
    set(proxy, property, colour[0], colour[1], colour[2]);
  }
  if (auto* drawn = vtkSMPVRepresentationProxy::SafeDownCast(proxy))
  {
    drawn->SetScalarColoring(nullptr, 0);
  }
}

/// A body with its edges; a dot from afar (markers.h).
void setMarker(vtkSMProxy* proxy, const Colour& colour)
{
  setColour(proxy, colour);
  if (auto* representation = vtkSMRepresentationProxy::SafeDownCast(proxy))
  {
    representation->SetRepresentationType("Surface With Edges");
  }
  constexpr double dark = 0.5;
  set(proxy, "EdgeColor", dark * colour[0], dark * colour[1], dark * colour[2]);
  set(proxy, "PointSize", kMarkerSize);
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

/// "ErrorOfIterations" is "error of iterations", "100a" is "100 a".
std::string inWords(const std::string& name)
{
  std::string words;
  for (std::size_t k = 0; k < name.size(); ++k)
  {
    const auto isUpper = [&](std::size_t at)
    { return at < name.size() && name[at] >= 'A' && name[at] <= 'Z'; };
    const bool begins = isUpper(k) && k + 1 < name.size() && !isUpper(k + 1);
    const auto isDigit = [&](std::size_t at)
    { return std::isdigit(static_cast<unsigned char>(name[at])) != 0; };
    const auto isLetter = [&](std::size_t at)
    { return std::isalpha(static_cast<unsigned char>(name[at])) != 0; };
    const bool number =
      k > 0 && ((isDigit(k) && isLetter(k - 1)) || (isLetter(k) && isDigit(k - 1)));
    words += (begins || number) && k > 0 ? " " : "";
    words += begins ? char(name[k] - 'A' + 'a') : name[k];
  }
  return words;
}

/// "KineticEnergy95" is "Kinetic energy, 95 % (kJ)".
std::string titleOf(const std::string& array, const Quantity& quantity)
{
  const std::string rest = array.substr(std::string(quantity.array).size());
  const bool number = rest.find_first_not_of("0123456789") == std::string::npos;
  return quantity.words + (rest.empty() ? "" : ", " + (number ? rest + " %" : inWords(rest))) +
    (*quantity.unit ? std::string(" (") + quantity.unit + ")" : std::string());
}

/// Whole numbers of kJ, or parts of one, as the labels of a palette in J: some four within its range.
void labelInKilojoules(vtkSMProxy* table, vtkSMProxy* bar)
{
  const std::vector<double> points = vtkSMPropertyHelper(table, "RGBPoints").GetDoubleArray();
  if (points.size() < 8 || !bar)
  {
    return;
  }
  const double low = points[0], high = points[points.size() - 4];
  constexpr double labels = 4.0, joules = 1000.0;
  const double about = std::max((high - low) / labels, 1e-9);
  const double power = std::pow(10.0, std::floor(std::log10(about)));
  const double step = power * (about < 2.0 * power ? 1.0 : about < 5.0 * power ? 2.0 : 5.0);
  std::vector<std::string> texts;
  for (double at = std::ceil(low / step - 1e-9) * step; at <= high * (1.0 + 1e-9) + 1e-12;
       at += step)
  {
    const auto number = [](const char* form, double of)
    {
      char text[32];
      std::snprintf(text, sizeof text, form, of);
      return std::string(text);
    };
    const double value = std::abs(at) < 1e-6 * step ? 0.0 : at;
    texts.push_back(number("%.17g", std::clamp(value, low, high)));
    texts.push_back(number("%.6g", value / joules));
  }
  vtkSMPropertyHelper annotations(table, "Annotations");
  annotations.SetNumberOfElements(unsigned(texts.size()));
  for (std::size_t k = 0; k < texts.size(); ++k)
  {
    annotations.Set(unsigned(k), texts[k].c_str());
  }
  table->UpdateVTKObjects();
  set(bar, "DrawTickLabels", 0);
  set(bar, "AddRangeLabels", 0);
  set(bar, "DrawAnnotations", 1);
  bar->UpdateVTKObjects();
}

std::string colouredBy(vtkSMProxy* proxy)
{
  auto* drawn = vtkSMPVRepresentationProxy::SafeDownCast(proxy);
  if (!drawn || !drawn->GetUsingScalarColoring())
  {
    return {};
  }
  const char* array = vtkSMPropertyHelper(proxy, "ColorArrayName").GetInputArrayNameToProcess();
  return array ? array : "";
}

bool is(const Shown& shown, const char* className, int port)
{
  return isOf(shown.source, { className }) && shown.port == port;
}

bool isExceedance(const Shown& shown)
{
  return is(shown, "vtkTrajectoryCollector", 2) || is(shown, "vtkMergeCollectors", 2);
}

} // namespace

bool isOf(vtkSMProxy* proxy, std::initializer_list<const char*> classNames)
{
  return proxy && proxy->GetVTKClassName() &&
    std::any_of(classNames.begin(), classNames.end(),
      [&](const char* name) { return proxy->GetVTKClassName() == std::string(name); });
}

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

Shown wholePaths(const Shown& shown)
{
  return is(shown, "vtkGrowingPaths", 0) ? shownBy(shown.source) : shown;
}

void style(vtkSMProxy* representation)
{
  const Shown shown = shownBy(representation);
  if (!vtkSMPVRepresentationProxy::SafeDownCast(representation))
  {
    return;
  }
  if (is(shown, "vtkDEMToCFESource", 0) || is(shown, "vtkDrawnStructure", 0))
  {
    setColour(representation, kSlope);
    set(representation, "Specular", 0.0);
  }
  else if (is(shown, "vtkRockBlockSource", 0) || is(shown, "vtkJointedRockMass", 0))
  {
    setMarker(representation, kRelease);
  }
  else if (is(shown, "vtkRockfallSimulation", 0))
  {
    setMarker(representation, kRock);
  }
  else if (is(shown, "vtkRockfallSimulation", 1) || is(shown, "vtkGrowingPaths", 0))
  {
    set(representation, "LineWidth", kPathWidth);
  }
  else if (is(shown, "vtkTrajectoryProfile", 1))
  {
    setColour(representation, kPicked);
    set(representation, "LineWidth", kPickedWidth);
  }
  else if (is(shown, "vtkRockfallSimulation", 4) || is(shown, "vtkTrajectoryCollector", 0))
  {
    setColour(representation, kLine);
    set(representation, "PointSize", kPointSize);
  }
  else if (is(shown, "vtkTrajectoryCollector", 3))
  {
    setColour(representation, kLine);
    if (auto* walls = vtkSMRepresentationProxy::SafeDownCast(representation))
    {
      walls->SetRepresentationType("Surface With Edges");
    }
    set(representation, "EdgeColor", kLine[0], kLine[1], kLine[2]);
    set(representation, "LineWidth", kPathWidth);
  }
  else if (is(shown, "vtkDEMToCFESource", 1) || is(shown, "vtkDrawnStructure", 1))
  {
    // Thin as nets and stems are, they are seen by their edges.
    setColour(representation, kBuilt);
    if (auto* built = vtkSMRepresentationProxy::SafeDownCast(representation))
    {
      built->SetRepresentationType("Surface With Edges");
    }
    set(representation, "EdgeColor", 0.5 * kBuilt[0], 0.5 * kBuilt[1], 0.5 * kBuilt[2]);
    set(representation, "LineWidth", kBuiltWidth);
  }
  else if (is(shown, "vtkRockfallHazardMap", 1))
  {
    set(representation, "Specular", 0.0);
  }
  representation->UpdateVTKObjects();
}

namespace
{

/// The range of what colours a representation, joined to `range`; of growing paths that of the whole
/// ones. The source knows it before a representation does.
void addRange(vtkSMProxy* representation, const std::string& array, double range[2])
{
  const Shown shown = wholePaths(shownBy(representation));
  if (!shown.source)
  {
    return;
  }
  vtkPVDataInformation* data = shown.source->GetDataInformation(unsigned(shown.port));
  for (vtkPVDataSetAttributesInformation* arrays :
    { data->GetPointDataInformation(), data->GetCellDataInformation() })
  {
    vtkPVArrayInformation* values = arrays->GetArrayInformation(array.c_str());
    if (values && values->GetNumberOfTuples() > 0)
    {
      const double* own =
        values->GetComponentFiniteRange(values->GetNumberOfComponents() == 1 ? 0 : -1);
      range[0] = std::min(range[0], own[0]);
      range[1] = std::max(range[1], own[1]);
    }
  }
}

/// The palette's range is that of all that is shown in it: two runs have one.
void rescale(vtkSMProxy* representation, vtkSMViewProxy* view)
{
  vtkSMProxy* table = vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy();
  if (!table)
  {
    return;
  }
  const std::string array = colouredBy(representation);
  if (nameNumbers(array, shownBy(representation), table))
  {
    return;
  }
  double range[2] = { std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest() };
  addRange(representation, array, range);
  vtkSMPropertyHelper all(view, "Representations");
  for (unsigned k = 0; k < all.GetNumberOfElements(); ++k)
  {
    vtkSMProxy* other = all.GetAsProxy(k);
    if (other != representation && colouredBy(other) == array &&
      vtkSMPropertyHelper(other, "LookupTable").GetAsProxy() == table &&
      vtkSMPropertyHelper(other, "Visibility").GetAsInt() != 0)
    {
      addRange(other, array, range);
    }
  }
  if (range[0] > range[1])
  {
    return;
  }
  vtkSMTransferFunctionProxy::RescaleTransferFunction(table, range[0], range[1], false);
  table->UpdateVTKObjects();
  const Quantity* quantity = quantityOf(array);
  if (quantity && quantity->unit == kKilojoules)
  {
    labelInKilojoules(table, vtkSMTransferFunctionProxy::FindScalarBarRepresentation(table, view));
  }
}

/// Cells of what is shown now; what ParaView knows of it is that of the last Apply.
std::int64_t cellsOf(const Shown& shown)
{
  auto* made = vtkAlgorithm::SafeDownCast(shown.source->GetClientSideObject());
  vtkDataObject* data = made ? made->GetOutputDataObject(shown.port) : nullptr;
  return data ? data->GetNumberOfElements(vtkDataObject::CELL)
              : shown.source->GetDataInformation(unsigned(shown.port))->GetNumberOfCells();
}

/// Many paths are thin, or they hide the map under them; a width that was chosen stays.
void fitPaths(const Shown& shown, vtkSMProxy* representation)
{
  if (!is(shown, "vtkRockfallSimulation", 1) && !is(shown, "vtkGrowingPaths", 0))
  {
    return;
  }
  const double now = vtkSMPropertyHelper(representation, "LineWidth").GetAsDouble();
  if (now == kPathWidth || now == kThinPath)
  {
    set(representation, "LineWidth", cellsOf(shown) > kManyPaths ? kThinPath : kPathWidth);
    representation->UpdateVTKObjects();
  }
}

/// Whether a legend has colours to explain: none before anything has moved, or where the source
/// failed.
bool showsColours(const Shown& shown, vtkSMViewProxy* view)
{
  return cellsOf(shown) > 0 &&
    (!is(shown, "vtkGrowingPaths", 0) || vtkSMPropertyHelper(view, "ViewTime").GetAsDouble() > 0.0);
}

/// A legend without anything in its colours is hidden, and comes back with it, unless it was hidden
/// by hand.
void followLegend(const Shown& shown, vtkSMProxy* representation, vtkSMViewProxy* view)
{
  constexpr const char* hidden = "RockfallLegendWaits";
  auto* drawn = vtkSMPVRepresentationProxy::SafeDownCast(representation);
  if (!drawn || !drawn->GetUsingScalarColoring())
  {
    return;
  }
  const bool any = showsColours(shown, view);
  if (!any && drawn->IsScalarBarVisible(view))
  {
    drawn->SetScalarBarVisibility(view, false);
    drawn->SetAnnotation(hidden, "1");
  }
  else if (any && drawn->HasAnnotation(hidden))
  {
    drawn->RemoveAnnotation(hidden);
    drawn->SetScalarBarVisibility(view, true);
  }
}

} // namespace

void follow(vtkSMProxy* representation, vtkSMViewProxy* view)
{
  const Shown shown = shownBy(representation);
  if (isExceedance(shown) && representation->GetProperty("XArrayName"))
  {
    followExceedance(shown, representation, view);
    return;
  }
  if (is(shown, "vtkTrajectoryProfile", 0) && representation->GetProperty("XArrayName"))
  {
    followProfile(shown, view);
    return;
  }
  if (shown.source && quantityOf(colouredBy(representation)))
  {
    rescale(representation, view);
    fitPaths(shown, representation);
    followLegend(shown, representation, view);
  }
}

void styleIn(vtkSMProxy* representation, vtkSMViewProxy* view)
{
  const Shown shown = shownBy(representation);
  if (isExceedance(shown))
  {
    if (representation->GetProperty("XArrayName")) // else a table, not a chart
    {
      styleExceedance(shown, representation, view);
    }
    return;
  }
  if (is(shown, "vtkTrajectoryProfile", 0))
  {
    if (representation->GetProperty("XArrayName"))
    {
      styleProfile(representation, view);
      followProfile(shown, view);
    }
    return;
  }
  const std::string array = colouredBy(representation);
  const Quantity* quantity = quantityOf(array);
  auto* drawn = vtkSMPVRepresentationProxy::SafeDownCast(representation);
  if (!shown.source || array.empty() || !quantity || !drawn)
  {
    return;
  }
  vtkSMProxy* table = vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy();
  if (!table)
  {
    return;
  }
  // Once: whoever takes another palette keeps it.
  constexpr const char* done = "RockfallPalette";
  if (!table->HasAnnotation(done))
  {
    std::vector<double> points;
    const Palette& palette = *quantity->palette;
    for (std::size_t k = 0; k < palette.size(); ++k)
    {
      points.push_back(double(k) / double(palette.size() - 1));
      points.insert(points.end(), palette[k].begin(), palette[k].end());
    }
    vtkSMPropertyHelper(table, "RGBPoints").Set(points.data(), unsigned(points.size()));
    vtkSMPropertyHelper(table, "ColorSpace").Set(0); // RGB
    table->SetAnnotation(done, "1");
    table->UpdateVTKObjects();
  }
  rescale(representation, view);
  if (vtkSMPropertyHelper(representation, "Visibility").GetAsInt() == 0)
  {
    return;
  }
  drawn->SetScalarBarVisibility(view, true);
  if (vtkSMProxy* bar = vtkSMTransferFunctionProxy::FindScalarBarRepresentation(table, view))
  {
    vtkSMPropertyHelper(bar, "Title").Set(titleOf(array, *quantity).c_str());
    vtkSMPropertyHelper(bar, "ComponentTitle").Set("");
    // printf's before ParaView 6.1, {} from then on: as the bar's own default is.
    const char* usual = vtkSMPropertyHelper(bar, "RangeLabelFormat").GetAsString();
    const bool printfs = usual == nullptr || std::strchr(usual, '%') != nullptr;
    vtkSMPropertyHelper(bar, "RangeLabelFormat").Set(printfs ? "%.3g" : "{:.3g}");
    bar->UpdateVTKObjects();
    if (quantity->unit == kKilojoules)
    {
      labelInKilojoules(table, bar);
    }
  }
  followLegend(shown, representation, view);
}

} // namespace rockfall::window
