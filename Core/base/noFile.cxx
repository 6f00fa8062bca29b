#include "base/noFile.h"

#include <filesystem>
#include <system_error>

#ifdef __linux__
#include <sys/vfs.h>
#endif

namespace rockfall
{

std::string noFile(const std::string& fileName)
{
  std::error_code failed;
  if (std::filesystem::is_other(std::filesystem::status(fileName, failed)))
  {
    return "a pipe or device";
  }
#ifdef __linux__
  // proc, sysfs, debugfs and tracefs, as their files call themselves; some wait for events.
  struct statfs system;
  if (statfs(fileName.c_str(), &system) == 0)
  {
    for (const long kind : { 0x9fa0, 0x62656572, 0x64626720, 0x74726163 })
    {
      if (system.f_type == kind)
      {
        return "a file of the kernel's";
      }
    }
  }
#endif
  return {};
}

} // namespace rockfall
