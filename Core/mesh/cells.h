#pragma once

/// @file
/// VTK's lists of cells, as its files have them.

#include "mesh/MeshBuilder.h"

#include <functional>
#include <vector>

namespace rockfall
{

using UseCell = std::function<void(std::size_t number, std::span<const std::int64_t> ids)>;

/// Lengths and numbers in turn: 3 0 1 2 4 …  Throws FileError, beginning with `what`, if the
/// lengths do not fit.
inline void forEachCell(
  std::span<const std::int64_t> cells, const std::string& what, const UseCell& use)
{
  std::size_t number = 0;
  for (std::size_t at = 0; at < cells.size(); ++number)
  {
    const std::int64_t length = cells[at++];
    if (length < 0 || std::uint64_t(length) > cells.size() - at)
    {
      throw FileError(what + ": cell " + std::to_string(number) + " has " + std::to_string(length) +
        " points, there is room for " + std::to_string(cells.size() - at));
    }
    use(number, cells.subspan(at, std::size_t(length)));
    at += std::size_t(length);
  }
}

/// Ends of the cells, after a first one that is 0 if `withFirst`, and the numbers of all cells.
inline void forEachCell(std::span<const std::int64_t> offsets, bool withFirst,
  std::span<const std::int64_t> ids, const std::string& what, const UseCell& use)
{
  std::int64_t start = 0;
  for (std::size_t k = 0; k < offsets.size(); ++k)
  {
    const std::int64_t end = offsets[k];
    if (end < start || end > std::int64_t(ids.size()) || (k == 0 && withFirst && end != 0))
    {
      throw FileError(what + ": offset " + std::to_string(k) + " is " + std::to_string(end) +
        ", it must be " + std::to_string(start) + " to " + std::to_string(ids.size()));
    }
    if (k > 0 || !withFirst)
    {
      use(withFirst ? k - 1 : k, ids.subspan(std::size_t(start), std::size_t(end - start)));
    }
    start = end;
  }
}

} // namespace rockfall
