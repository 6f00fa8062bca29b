// The reader of meshes. The first byte says which format.

#include "base/errors.h"
#include "mesh/meshFile.h"

#include <cstddef>
#include <cstdint>
#include <iterator>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  constexpr const char* formats[] = { ".ply", ".stl", ".obj" };
  if (size > 0)
  {
    try
    {
      const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
      rockfall::parseMesh(formats[data[0] % std::size(formats)], bytes, "file");
    }
    catch (const rockfall::Error&)
    {
      // As it should be.
    }
  }
  return 0;
}
