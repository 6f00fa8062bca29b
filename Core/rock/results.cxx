#include "rock/results.h"

namespace rockfall
{

std::string fateName(Fate fate)
{
  switch (fate)
  {
    case Fate::Rested:
      return "rested";
    case Fate::LeftDomain:
      return "left the domain";
    case Fate::Caught:
      return "caught";
    case Fate::LostInNodata:
      return "lost in nodata";
    case Fate::Moving:
      break;
  }
  return "moving";
}

} // namespace rockfall
