#include "chartLooks.h"

#include "proxyNumbers.h"

#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"

#include <algorithm>
#include <string>
#include <utility>

namespace rockfall::window
{

namespace
{

constexpr const char* kDisc = "4"; ///< Of a chart's markers.
constexpr const char* kNoMarker = "0";
constexpr const char* kShare = "ShareOfPassing"; ///< Values of a chart of exceedance.

/// The largest value of a column that is drawn; 0 without one.
double most(vtkPVDataInformation* data, const char* column)
{
  vtkPVArrayInformation* values = data->GetRowDataInformation()->GetArrayInformation(column);
  return values ? values->GetComponentRange(0)[1] : 0.0;
}

/// Titles that have room in a chart of 300 x 190 px.
void fitTexts(vtkSMViewProxy* view)
{
  constexpr int axes = 11, title = 14; // points
  for (const char* axis : { "Left", "Bottom", "Right" })
  {
    set(view, (std::string(axis) + "AxisTitleFontSize").c_str(), axes);
  }
  set(view, "ChartTitleFontSize", title);
}

} // namespace

void styleProfile(vtkSMProxy* representation, vtkSMViewProxy* view)
{
  struct Series
  {
    const char* column;
    const char* label; ///< Null for what is not drawn.
    const char* corner;
    Colour colour;
  };
  constexpr Series all[] = {
    { "Time", nullptr, "0", {} },
    { "Distance", nullptr, "0", {} },
    { "Elevation", nullptr, "0", {} },
    { "Speed", "Speed (m/s)", "0", { 0.19, 0.41, 0.56 } },
    { "EnergyInKilojoules", "Kinetic energy (kJ)", "1", { 0.86, 0.15, 0.12 } },
    { "HeightOverGround", "Height over ground (m)", "0", { 0.35, 0.35, 0.35 } },
  };
  vtkSMPropertyHelper(representation, "UseIndexForXAxis").Set(0);
  vtkSMPropertyHelper(representation, "XArrayName").Set("Distance");
  for (const Series& series : all)
  {
    vtkSMPropertyHelper(representation, "SeriesVisibility")
      .SetStatus(series.column, series.label ? 1 : 0);
    if (series.label)
    {
      Colour colour = series.colour; // SetStatus wants it without const
      vtkSMPropertyHelper(representation, "SeriesLabel").SetStatus(series.column, series.label);
      vtkSMPropertyHelper(representation, "SeriesPlotCorner")
        .SetStatus(series.column, series.corner);
      vtkSMPropertyHelper(representation, "SeriesColor")
        .SetStatus(series.column, colour.data(), int(colour.size()));
      vtkSMPropertyHelper(representation, "SeriesLineThickness").SetStatus(series.column, "2");
    }
  }
  representation->UpdateVTKObjects();
  vtkSMPropertyHelper title(view, "ChartTitle");
  if (const char* given = title.GetAsString(); !given || !*given)
  {
    title.Set("One rock along its way");
  }
  fitTexts(view);
  vtkSMPropertyHelper(view, "BottomAxisTitle").Set("Distance in plan (m)");
  vtkSMPropertyHelper(view, "LeftAxisTitle").Set("Speed (m/s), height (m)");
  vtkSMPropertyHelper(view, "RightAxisTitle").Set("Kinetic energy (kJ)");
  view->UpdateVTKObjects();
}

void followProfile(const Shown& shown, vtkSMViewProxy* view)
{
  constexpr double room = 1.4; // the legend lies over the curves
  vtkPVDataInformation* data = shown.source->GetDataInformation(unsigned(shown.port));
  const double left = std::max(most(data, "Speed"), most(data, "HeightOverGround"));
  const double right = most(data, "EnergyInKilojoules");
  for (const auto& [axis, end] : { std::pair{ "Left", left }, std::pair{ "Right", right } })
  {
    const std::string name = axis;
    set(view, (name + "AxisUseCustomRange").c_str(), end > 0.0);
    set(view, (name + "AxisRangeMinimum").c_str(), 0.0);
    set(view, (name + "AxisRangeMaximum").c_str(), room * end);
  }
  view->UpdateVTKObjects();
}

void followExceedance(const Shown& shown, vtkSMProxy* representation, vtkSMViewProxy* view)
{
  vtkPVDataInformation* data = shown.source->GetDataInformation(unsigned(shown.port));
  vtkPVArrayInformation* lines = data->GetRowDataInformation()->GetArrayInformation("Line");
  const bool any = data->GetNumberOfRows() > 0;
  const bool several =
    any && lines && lines->GetComponentRange(0)[1] > lines->GetComponentRange(0)[0];
  vtkSMPropertyHelper(representation, "SeriesLineStyle").SetStatus(kShare, several ? "0" : "1");
  vtkSMPropertyHelper(representation, "SeriesMarkerStyle")
    .SetStatus(kShare, several ? kDisc : kNoMarker);
  representation->UpdateVTKObjects();
  const std::string usual = "Energy at the line";
  const std::string none = "No rock passes the line";
  const std::string noneYet = "No rock has passed the line yet";
  const bool goesOn = data->GetFieldDataInformation()->GetArrayInformation("RunGoesOn");
  const std::string& now = any ? usual : goesOn ? noneYet : none;
  vtkSMPropertyHelper title(view, "ChartTitle");
  const std::string given = title.GetAsString() ? title.GetAsString() : "";
  // Of a second study with a number behind.
  for (const std::string& own : { usual, none, noneYet })
  {
    if (given.starts_with(own))
    {
      title.Set((now + given.substr(own.size())).c_str());
    }
  }
  if (given.empty())
  {
    title.Set(now.c_str());
  }
  view->UpdateVTKObjects();
}

void styleExceedance(const Shown& shown, vtkSMProxy* representation, vtkSMViewProxy* view)
{
  vtkSMPropertyHelper(representation, "UseIndexForXAxis").Set(0);
  vtkSMPropertyHelper(representation, "XArrayName").Set("EnergyInKilojoules");
  vtkSMPropertyHelper visible(representation, "SeriesVisibility");
  for (const char* column :
    { "Line", "KineticEnergy", "EnergyInKilojoules", "HeightOverGround", "ShareOfReleased" })
  {
    visible.SetStatus(column, 0);
  }
  visible.SetStatus(kShare, 1);
  Colour colour = { 0.86, 0.15, 0.12 }; // SetStatus wants it without const
  vtkSMPropertyHelper(representation, "SeriesColor")
    .SetStatus(kShare, colour.data(), int(colour.size()));
  vtkSMPropertyHelper(representation, "SeriesLabel")
    .SetStatus(kShare, "Share of the rocks that pass");
  vtkSMPropertyHelper(representation, "SeriesLineThickness").SetStatus(kShare, "2");
  vtkSMPropertyHelper(representation, "SeriesMarkerSize").SetStatus(kShare, "6");
  fitTexts(view);
  vtkSMPropertyHelper(view, "BottomAxisTitle").Set("Kinetic energy (kJ)");
  vtkSMPropertyHelper(view, "LeftAxisTitle").Set("Share with this or more");
  set(view, "LeftAxisUseCustomRange", 1);
  set(view, "LeftAxisRangeMinimum", 0.0);
  set(view, "LeftAxisRangeMaximum", 1.0 + 1e-6); // or steps of 0.05 end before it, by rounding
  followExceedance(shown, representation, view);
}

} // namespace rockfall::window
