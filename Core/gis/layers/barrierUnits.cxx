#include "gis/layers/barrierUnits.h"

#include "base/text/numberText.h"

namespace rockfall::gis
{

void refuseOtherUnits(
  const FeatureRow& row, std::optional<double> height, std::optional<double> capacity)
{
  if (height && *height > kMostBarrierHeight)
  {
    row.failField("height",
      " is " + numberText(*height) + " m, at most " + numberText(kMostBarrierHeight) +
        " m are meant for a barrier: is it in centimetres?");
  }
  if (capacity && *capacity > kMostBarrierCapacity)
  {
    row.failField("capacity",
      " is " + numberText(*capacity) + " kJ, at most " + numberText(kMostBarrierCapacity) +
        " kJ are meant for a barrier: is it in J?");
  }
}

} // namespace rockfall::gis
