#include "base/text/numberText.h"

#include <charconv>

namespace rockfall
{

std::string numberText(double value, int digits)
{
  char text[32];
  const auto end =
    std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr;
  return std::string(text, end);
}

} // namespace rockfall
