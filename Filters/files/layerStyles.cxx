#include "files/layerStyles.h"

#include "rock/results.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace rockfall::filters
{

namespace
{

/// A symbol of one layer: a line, or a marker with a thin outline.
std::string symbol(const std::string& name, bool line, const std::string& colour)
{
  return "<symbol name=\"" + name + "\" type=\"" + (line ? "line" : "marker") +
    R"(" alpha="1" clip_to_extent="1" force_rhr="0"><layer class=")" +
    (line ? "SimpleLine" : "SimpleMarker") + R"(" enabled="1" locked="0" pass="0"><prop k=")" +
    (line ? "line_color" : "color") + "\" v=\"" + colour + "\"/>" +
    (line
        ? R"(<prop k="line_width" v="0.2"/><prop k="line_width_unit" v="MM"/>)"
        : R"(<prop k="name" v="circle"/><prop k="outline_color" v="35,35,35,255"/>)"
          R"(<prop k="outline_width" v="0.2"/><prop k="size" v="2"/><prop k="size_unit" v="MM"/>)") +
    "</layer></symbol>";
}

constexpr const char* open =
  R"( symbollevels="0" enableorderby="0" forceraster="0")"; ///< Of every renderer.

std::string oneSymbol(bool line, const std::string& colour)
{
  return std::string("<renderer-v2 type=\"singleSymbol\"") + open + "><symbols>" +
    symbol("0", line, colour) + "</symbols></renderer-v2>";
}

std::string byFate()
{
  constexpr std::array<const char*, 6> colours = { "35,35,35,255", "240,59,32,255",
    "254,178,76,255", "67,162,202,255", "200,200,200,255", "153,112,171,255" };
  static_assert(std::size(colours) == std::size_t(Fate::Broken) + 1); // each has one
  std::string categories, symbols;
  for (std::size_t k = 0; k < colours.size(); ++k)
  {
    const std::string number = std::to_string(k);
    categories += "<category value=\"" + number + "\" symbol=\"" + number + "\" label=\"" +
      fateName(Fate(int(k))) + "\" render=\"true\"/>";
    symbols += symbol(number, false, colours[k]);
  }
  return std::string("<renderer-v2 type=\"categorizedSymbol\" attr=\"Fate\"") + open +
    "><categories>" + categories + "</categories><symbols>" + symbols + "</symbols></renderer-v2>";
}

std::string byEnergy()
{
  const std::pair<double, const char*> classes[] = { { 10, "255,255,178,255" },
    { 30, "254,217,118,255" }, { 100, "254,178,76,255" }, { 300, "253,141,60,255" },
    { 1000, "240,59,32,255" }, { 3000, "189,0,38,255" }, { 1e9, "103,0,13,255" } }; // kJ
  std::string ranges, symbols;
  std::string low = "0";
  int k = 0;
  for (const auto& [most, colour] : classes)
  {
    const std::string number = std::to_string(k++);
    const std::string high = std::to_string(std::int64_t(most));
    const std::string label = most > 1e8 ? "above " + low
      : k == 1                           ? "up to " + high
                                         : low + " to " + high;
    ranges += "<range lower=\"" + low + "\" upper=\"" + high + "\" symbol=\"" + number +
      "\" render=\"true\" label=\"" + label + " kJ\"/>";
    symbols += symbol(number, false, colour);
    low = high;
  }
  return std::string("<renderer-v2 type=\"graduatedSymbol\" graduatedMethod=\"GraduatedColor\" "
                     "attr=\"&quot;KineticEnergy&quot; * 0.001\"") +
    open + "><ranges>" + ranges + "</ranges><symbols>" + symbols + "</symbols></renderer-v2>";
}

} // namespace

std::string unitOf(const std::string& array)
{
  static const std::pair<const char*, const char*> units[] = { { "EnergyLineAngle", "degrees" },
    { "KineticEnergy", "J" }, { "TranslationalEnergy", "J" }, { "RotationalEnergy", "J" },
    { "PotentialEnergy", "J" }, { "StrainEnergy", "J" }, { "Energy", "J" }, { "Speed", "m/s" },
    { "Velocity", "m/s" }, { "HeightOverGround", "m" }, { "TopHeight", "m" },
    { "RotationRate", "rad/s" }, { "Mass", "kg" }, { "Volume", "m³" }, { "Width", "m" },
    { "Time", "s" }, { "Distance", "m" }, { "HorizontalAngle", "°" }, { "VerticalAngle", "°" },
    { "AnnualFrequency", "1/a" }, { "ReturnPeriod", "a" } };
  for (const auto& [start, unit] : units)
  {
    if (array.rfind(start, 0) == 0)
    {
      return unit;
    }
  }
  return {};
}

std::string layerStyle(const std::string& layer, const std::vector<LayerField>& fields)
{
  const auto has = [&](const char* name)
  {
    return std::any_of(
      fields.begin(), fields.end(), [&](const LayerField& field) { return field.name == name; });
  };
  std::string aliases;
  for (const LayerField& field : fields)
  {
    const std::string unit = unitOf(field.name);
    if (!unit.empty())
    {
      aliases += "<alias field=\"" + field.name + "\" index=\"0\" name=\"" + field.name + " (" +
        unit + ")\"/>";
    }
  }
  const std::string renderer = layer == "trajectories" ? oneSymbol(true, "189,0,38,160")
    : layer == "ends" && has("Fate")                   ? byFate()
    : has("KineticEnergy")                             ? byEnergy()
                                                       : oneSymbol(false, "240,59,32,255");
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n<qgis version=\"3.22\" "
         "hasScaleBasedVisibilityFlag=\"0\" styleCategories=\"AllStyleCategories\">\n" +
    renderer + "\n<aliases>" + aliases + "</aliases>\n</qgis>\n";
}

} // namespace rockfall::filters
