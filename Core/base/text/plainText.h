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
bool parseNumber(std::string_view word, double& value);
/// The same; nothing if any of the word is no number.
std::optional<double> parsed(std::string_view word);
/// The whole word as a whole number.
bool parseInteger(std::string_view word, std::int64_t& value);
/// ASCII letters only.
std::string lowerCase(std::string_view text);
/// As in C's locale.
bool isBlank(char c);
/// Without the blanks at either end; a part of `text`.
std::string_view trimmed(std::string_view text);
/// For a message: at most 60 bytes, what cannot be printed as "?".
std::string inQuotes(std::string_view text);

} // namespace rockfall
