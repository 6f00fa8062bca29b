// Embankments of a layer.
#include "gis/layers/structureRows.h"

#include "base/text/numberText.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"

#include <algorithm>
#include <cmath>

namespace rockfall::gis
{

namespace
{

/// Sides of embankments, m across per m down. Engineers of Europe write rise : run (1:1.5, 2:3),
/// others run : rise (3:2), and mean the same side: of a ratio the larger number is the way across.
class Sides
{
public:
  std::optional<double> of(const FeatureRow& row, const char* field)
  {
    const auto text = row.text(field);
    const auto colon = text ? text->find(':') : std::string::npos;
    if (colon == std::string::npos)
    {
      return row.notNegative(field);
    }
    const auto one = parsedNumber(trimmed(text->substr(0, colon)));
    const auto other = parsedNumber(trimmed(text->substr(colon + 1)));
    if (!one || !other || !(*one > 0.0) || !(*other > 0.0))
    {
      row.failField(field,
        " is \"" + *text +
          "\", it must be a ratio of two numbers above 0, as 2:3, or the metres across per metre "
          "down, as 1.5");
    }
    const auto [down, across] = std::minmax(*one, *other);
    ratios_.try_emplace(std::string(trimmed(*text)), across / down);
    return across / down;
  }

  void tell(const std::string& fileName, std::vector<std::string>& notes) const
  {
    std::string list;
    for (const auto& [text, slope] : ratios_)
    {
      list += (list.empty() ? "" : ", ") + text + " as " + numberText(slope, 4) +
        " m across per m down (" + numberText(degrees(std::atan(1.0 / slope)), 3) + " degrees)";
    }
    if (!list.empty())
    {
      notes.push_back(fileName + ": of a ratio the larger number is taken as the way across: " +
        list + ". A side steeper than 45 degrees is a number, as 0.5.");
    }
  }

private:
  std::map<std::string, double> ratios_;
};

} // namespace

void StructureReader::readEmbankments() const
{
  LayerWish wish = lineWish(files.embankments, files.embankmentLayer, "EmbankmentLayerName");
  wish.columns = { { "width" }, { "height", "crest" } };
  Sides sides;
  this->forEachRow(wish,
    { "height", "crest", "width", "slope", "slope_up", "slope_down", "rv", "rn", "rt", "phi",
      "cohesion" },
    [&](const FeatureRow& row, std::int64_t count, StructurePlaces& places)
    {
      Embankment e;
      e.feature = count;
      e.name = row.text("name").value_or("");
      const auto height = row.positive("height"), crest = row.number("crest");
      if (bool(height) == bool(crest))
      {
        row.fail(height ? "has a \"height\" and a \"crest\"; it must have one of them"
                        : "has no \"height\" over ground and no \"crest\" elevation, in m");
      }
      e.height = height.value_or(e.height);
      e.elevation = crest ? places.elevation(row, "crest", *crest) : e.elevation;
      e.crestWidth = needed(row, "width", "the width of the crest in m");
      const auto both = sides.of(row, "slope"), up = sides.of(row, "slope_up"),
                 down = sides.of(row, "slope_down");
      if (!both && !(up && down))
      {
        row.fail("has no \"slope\" of its sides (as 1.5 or 2:3), nor \"slope_up\" and "
                 "\"slope_down\"");
      }
      e.mountainSlope = up ? *up : *both;
      e.valleySlope = down ? *down : *both;
      e.material = own.of(row);
      for (std::vector<Eigen::Vector2d>& line : places.lines(row))
      {
        e.points = std::move(line);
        all.embankments.push_back(e);
      }
    });
  sides.tell(wish.fileName, notes);
}

} // namespace rockfall::gis
