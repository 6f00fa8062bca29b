#pragma once

/// @file
/// Lists of which there are many, for long.

#include <vector>

namespace rockfall
{

/// Appends to a list that grows by an eighth where it is full: by itself it would double, and a
/// third of the memory of all lists would be empty.
template <typename T>
void append(std::vector<T>& list, const T& value)
{
  if (list.size() == list.capacity())
  {
    list.reserve(list.size() + list.size() / 8 + 4);
  }
  list.push_back(value);
}

} // namespace rockfall
