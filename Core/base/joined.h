#pragma once

/// @file
/// Things that are joined, by the one that each is joined to (union–find).

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rockfall
{

/// First of those that are joined to `i`; shortens the way there.
inline int headOf(std::vector<int>& joined, int i)
{
  int* const heads = joined.data();
  while (heads[i] != i)
  {
    i = heads[i] = heads[heads[i]];
  }
  return i;
}

inline void joinTwo(std::vector<int>& joined, int i, int j)
{
  const int a = headOf(joined, i), b = headOf(joined, j);
  joined[std::size_t(std::max(a, b))] = std::min(a, b);
}

} // namespace rockfall
