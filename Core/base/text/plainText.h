#pragma once

/// @file
/// Numbers and words of texts, whatever the locale.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rockfall
{

/// The whole word as a number with a decimal point, nan and inf included; too small a one is 0.
/// Nothing if any of the word is no number.
std::optional<double> parsedNumber(std::string_view word);
/// The same of a whole number.
std::optional<std::int64_t> parsedInteger(std::string_view word);
/// ASCII letters only.
std::string lowerCase(std::string_view text);
/// As in C's locale.
bool isBlank(char c);
/// Without the blanks at either end; a part of `text`.
std::string_view trimmed(std::string_view text);
/// For a message: at most 60 bytes, what cannot be printed as "?".
std::string inQuotes(std::string_view text);

} // namespace rockfall
