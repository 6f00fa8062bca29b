#include "gis/layers/barrierUnits.h"

#include "base/text/numberText.h"
#include "terrain/plausible.h"

namespace rockfall::gis
{

void refuseOtherUnits(
  const FeatureRow& row, std::optional<double> height, std::optional<double> capacity)
{
  const double highest = plausible::kNetHeight.refused;
  const double strongest = plausible::kNetCapacity.refused / 1000.0;
  if (height && *height > highest)
  {
    row.failField("height",
      " is " + numberText(*height) + " m, at most " + numberText(highest) +
        " m are meant for a barrier: is it in centimetres?");
  }
  if (capacity && *capacity > strongest)
  {
    row.failField("capacity",
      " is " + numberText(*capacity) + " kJ, at most " + numberText(strongest) +
        " kJ are meant for a barrier: is it in J?");
  }
}

} // namespace rockfall::gis
