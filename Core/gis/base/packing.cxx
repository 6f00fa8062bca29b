#include "gis/base/packing.h"
#include "gis/base/gdal.h"

#include <cpl_conv.h>
#include <cpl_string.h>

#include <algorithm>

namespace rockfall::gis
{

namespace
{

/// Room for data that zlib cannot shorten: a share of the length and bytes more. In a buffer that is
/// too short GDAL 3.6 loses memory.
constexpr std::size_t kShareMore = 64, kBytesMore = 64;
constexpr int kLevel = 1; ///< Of zlib's nine: higher ones take twice the time to save 3 %.

} // namespace

std::vector<char> pack(std::span<const char> records, std::size_t size)
{
  const std::size_t count = records.size() / size;
  std::vector<char> sorted(records.size());
  std::vector<char> packed(records.size() + records.size() / kShareMore + kBytesMore);
  for (std::size_t k = 0; k < count; ++k)
  {
    for (std::size_t byte = 0; byte < size; ++byte)
    {
      sorted[byte * count + k] = records[k * size + byte];
    }
  }
  const Messages silent;
  std::size_t length = 0;
  const void* done =
    CPLZLibDeflate(sorted.data(), sorted.size(), kLevel, packed.data(), packed.size(), &length);
  if (!done || length >= records.size())
  {
    return { records.begin(), records.end() };
  }
  packed.resize(length);
  return packed;
}

bool unpack(std::span<const char> packed, std::size_t size, std::span<char> records)
{
  if (packed.size() == records.size())
  {
    std::copy(packed.begin(), packed.end(), records.begin());
    return true;
  }
  std::vector<char> sorted(records.size());
  const Messages silent;
  std::size_t length = 0;
  if (!CPLZLibInflate(packed.data(), packed.size(), sorted.data(), sorted.size(), &length) ||
    length != records.size())
  {
    return false;
  }
  const std::size_t count = records.size() / size;
  for (std::size_t k = 0; k < count; ++k)
  {
    for (std::size_t byte = 0; byte < size; ++byte)
    {
      records[k * size + byte] = sorted[byte * count + k];
    }
  }
  return true;
}

} // namespace rockfall::gis
