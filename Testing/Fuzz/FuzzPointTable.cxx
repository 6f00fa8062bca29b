// The reader of tables of points.

#include "base/errors.h"
#include "mesh/pointTable.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  try
  {
    rockfall::parsePointTable({ reinterpret_cast<const char*>(data), size }, "file");
  }
  catch (const rockfall::Error&)
  {
    // As it should be.
  }
  return 0;
}
