#include "base/version.h"

namespace rockfall
{

std::string versionText()
{
  return "RockfallDDA " ROCKFALL_VERSION;
}

} // namespace rockfall
