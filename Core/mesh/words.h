#pragma once

/// @file
/// Words and numbers of a text in memory, whatever the locale.

#include "base/errors.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace rockfall
{

/// The whole word as a number with a decimal point, nan and inf included; too small a one is 0.
bool parseNumber(std::string_view word, double& value);
/// The whole word as a whole number.
bool parseInteger(std::string_view word, std::int64_t& value);
/// ASCII letters only.
std::string lowerCase(std::string_view text);
/// Without the blanks at either end.
std::string_view trimmed(std::string_view text);
/// For a message: at most 60 bytes, what cannot be printed as "?".
std::string inQuotes(std::string_view text);

/// Walks over the words of a text and knows the line.
class Words
{
public:
  /// `name` is that of the file, for messages.
  Words(std::string_view text, std::string name)
    : text_(text)
    , name_(std::move(name))
  {
  }

  const std::string& name() const { return name_; }
  int line() const { return line_; }           ///< From 1, of the word that was read last.
  std::size_t position() const { return at_; } ///< Of the byte behind that word.
  std::string_view rest() const { return text_.substr(at_); }
  bool atEnd() const { return at_ == text_.size(); }

  /// The next word, on this line or a later one; empty at the end of the text.
  std::string_view next();
  /// The next word of this line; empty at its end, where the walk stays.
  std::string_view nextInLine();
  /// Rest of this line, without its end, behind which the walk goes on.
  std::string_view restOfLine();

  /// The next word as a number; throws FileError if it is none, or if the text is over.
  double number();
  std::int64_t integer();
  /// Moves on by bytes, for what stands between texts; at most to the end.
  void skip(std::size_t bytes);

  /// Throws FileError: "name, line 7: what".
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void failTruncated() const;

private:
  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

} // namespace rockfall
