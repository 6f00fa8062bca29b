#include "rock/fates.h"

namespace rockfall
{

std::string fateName(Fate fate)
{
  if (fate == kLostInNodata)
  {
    return "lost in nodata";
  }
  switch (fate)
  {
    case Fate::Rested:
      return "rested";
    case Fate::LeftDomain:
      return "left the domain";
    case Fate::Caught:
      return "caught";
    case Fate::Moving:
      break;
  }
  return "moving";
}

} // namespace rockfall
