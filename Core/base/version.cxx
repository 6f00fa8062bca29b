#include "base/version.h"

namespace rockfall
{

const char* versionNumber()
{
  return ROCKFALL_VERSION;
}

std::string versionText()
{
  return "RockfallDDA " + std::string(versionNumber());
}

} // namespace rockfall
