#pragma once

#include <functional>
#include <string>

namespace rockfall
{

/// "a", "b", "c" for a message: the `text` of each item, in quotes. A list of more bytes than
/// `longest` ends there, with dots.
template <class Items, class Text = std::identity>
std::string quotedList(
  const Items& items, Text&& text = {}, std::size_t longest = std::string::npos)
{
  std::string list;
  for (const auto& item : items)
  {
    if (list.size() > longest)
    {
      return list + ", ...";
    }
    list += (list.empty() ? "\"" : ", \"") + std::string(std::invoke(text, item)) + "\"";
  }
  return list;
}

} // namespace rockfall
