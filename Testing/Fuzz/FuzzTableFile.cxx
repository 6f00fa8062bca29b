// Tables in any encoding made readable for GDAL.

#include "base/errors.h"
#include "gis/base/tableFile.h"
#include "temporaryFile.h"

#include <cpl_error.h>
#include <cpl_vsi.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  CPLSetErrorHandler(CPLQuietErrorHandler); // files beside it that are not there
  const std::string name = temporaryFile(data, size, ".csv");
  try
  {
    std::vector<std::string> notes;
    const rockfall::gis::TableFile table = rockfall::gis::readableTable(name, notes);
    if (!table.folder.empty())
    {
      VSIRmdirRecursive(table.folder.c_str());
    }
  }
  catch (const rockfall::Error&)
  {
    // As it should be.
  }
  return 0;
}
