#include "base/text/plainText.h"

#include <charconv>

namespace rockfall
{

namespace
{

/// Without the sign that from_chars does not know.
std::string_view withoutPlus(std::string_view word)
{
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  return word.substr(plus ? 1 : 0);
}

} // namespace

bool isBlank(char c)
{
  return c == ' ' || (c >= '\t' && c <= '\r');
}

std::optional<double> parsedNumber(std::string_view word)
{
  word = withoutPlus(word);
  double value = 0.0;
  const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (next != word.data() + word.size() || word.empty())
  {
    return std::nullopt;
  }
  if (error == std::errc::result_out_of_range &&
    word.find_first_of("eE") != std::string_view::npos &&
    word.find('-', 1) != std::string_view::npos)
  {
    return 0.0;
  }
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> parsedInteger(std::string_view word)
{
  word = withoutPlus(word);
  std::int64_t value = 0;
  const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc() && next == word.data() + word.size() && !word.empty();
  return whole ? std::optional(value) : std::nullopt;
}

std::string lowerCase(std::string_view text)
{
  std::string lower(text);
  for (char& c : lower)
  {
    c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  }
  return lower;
}

std::string_view trimmed(std::string_view text)
{
  while (!text.empty() && isBlank(text.front()))
  {
    text.remove_prefix(1);
  }
  while (!text.empty() && isBlank(text.back()))
  {
    text.remove_suffix(1);
  }
  return text;
}

std::string inQuotes(std::string_view text)
{
  std::string shown = "\"";
  for (const char c : text.substr(0, 60))
  {
    shown += c >= ' ' && c != '\x7f' ? c : (c & '\x80') != 0 ? c : '?';
  }
  // A letter of several bytes is not cut in two.
  while (text.size() > 60 && shown.size() > 1 && (shown.back() & '\x80') != 0)
  {
    shown.pop_back();
  }
  return shown + (text.size() > 60 ? "…\"" : "\"");
}

} // namespace rockfall
