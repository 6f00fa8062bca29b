#include "gis/trust/unitDoubt.h"

#include "base/text/columnName.h"
#include "gis/base/gdal.h"
#include "gis/trust/heightUnit.h"

namespace rockfall::gis
{

namespace
{

std::string takenAsMetres(const char* what, double unit)
{
  return " says no unit, so that it and its like were taken as metres, but the slope's file has "
         "its " +
    std::string(what) + " in " + unitsText(unit) + ". If these are in " + unitsText(unit) +
    " too, ";
}

} // namespace

UnitDoubt::UnitDoubt(const LayerHeights& layer, const FileUnits& slope)
{
  slope_.heights = layer.heightsDeclared || !layer.doubt.empty() ? 1.0 : slope.heights;
  slope_.plan = layer.planeDeclared ? 1.0 : slope.plan;
}

void UnitDoubt::height(const FeatureRow& row, const std::string& column, double number)
{
  if (slope_.heights == 1.0 || !height_.empty() || metresPer(ColumnName(column).unit))
  {
    return;
  }
  height_ = row.where() + ": " + (column.empty() ? "its z" : "its field \"" + column + "\"") +
    " of " + gis::number(number) + takenAsMetres("heights", slope_.heights) +
    (column == "z" || column == "Z"
        ? "call the field \"z_ft\", or by what it is in; \"z_m\" are metres"
        : "a vertical CRS of the layer says so");
}

void UnitDoubt::place(const std::string& where, double x, double y)
{
  if (slope_.plan == 1.0 || !place_.empty())
  {
    return;
  }
  place_ = where + ": its place " + gis::number(x) + ", " + gis::number(y) +
    takenAsMetres("coordinates", slope_.plan) + "multiply them by " + exactly(slope_.plan);
}

void UnitDoubt::tell(std::vector<std::string>& notes) const
{
  for (const std::string& text : { place_, height_ })
  {
    if (!text.empty())
    {
      notes.push_back(text);
    }
  }
}

} // namespace rockfall::gis
