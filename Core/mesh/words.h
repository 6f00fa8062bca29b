#pragma once

/// @file
/// A walk over a text in memory.

#include "base/errors.h"
#include "base/text/plainText.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace rockfall
{

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
  std::string_view rest() const { return text_.substr(at_); }
  bool atEnd() const { return at_ == text_.size(); }

  /// The next word, on this line or a later one; empty at the end of the text.
  std::string_view next();
  /// The next word of this line; empty at its end, where the walk stays.
  std::string_view nextInLine();
  /// Rest of this line, without its end, behind which the walk goes on.
  std::string_view restOfLine();

  /// The next word as a whole number; throws FileError if it is none, or if the text is over.
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
