#pragma once

/// @file
/// Records of one size, packed without loss: first bytes of all, second bytes of all and so on, as
/// neighbours are alike there, deflated by the zlib that GDAL has.

#include <cstddef>
#include <span>
#include <vector>

namespace rockfall::gis
{

/// Packs whole records of `size` bytes; they stay as they are where that makes them no shorter.
std::vector<char> pack(std::span<const char> records, std::size_t size);

/// Fills `records` with what was packed. False: `packed` is not of so many records.
bool unpack(std::span<const char> packed, std::size_t size, std::span<char> records);

} // namespace rockfall::gis
