#pragma once

/// @file
/// Properties that choose something of a file which no property names.

#include <string>
#include <vector>

namespace rockfall::filters
{

/// A note if the property `name` chooses something of a file that the property `of` does not name.
inline void tellIdle(const char* name, const std::string& value, const char* of,
  const std::string& file, std::vector<std::string>& notes)
{
  if (!value.empty() && file.empty())
  {
    notes.push_back(
      std::string(name) + " is \"" + value + "\", but has no effect: there is no " + of);
  }
}

} // namespace rockfall::filters
