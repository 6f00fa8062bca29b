#include "mesh/words.h"

#include <charconv>

namespace rockfall
{

namespace
{

bool isBlank(char c)
{
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Without the sign that from_chars does not know.
std::string_view withoutPlus(std::string_view word)
{
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  return word.substr(plus ? 1 : 0);
}

} // namespace

bool parseNumber(std::string_view word, double& value)
{
  word = withoutPlus(word);
  const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (next != word.data() + word.size() || word.empty())
  {
    return false;
  }
  if (error == std::errc::result_out_of_range &&
    word.find_first_of("eE") != std::string_view::npos &&
    word.find('-', 1) != std::string_view::npos)
  {
    value = 0.0;
    return true;
  }
  return error == std::errc();
}

bool parseInteger(std::string_view word, std::int64_t& value)
{
  word = withoutPlus(word);
  const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && next == word.data() + word.size() && !word.empty();
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

std::string_view Words::next()
{
  while (at_ < text_.size() && isBlank(text_[at_]))
  {
    line_ += text_[at_++] == '\n' ? 1 : 0;
  }
  return this->nextInLine();
}

std::string_view Words::nextInLine()
{
  while (at_ < text_.size() && isBlank(text_[at_]) && text_[at_] != '\n')
  {
    ++at_;
  }
  const std::size_t start = at_;
  while (at_ < text_.size() && !isBlank(text_[at_]))
  {
    ++at_;
  }
  return text_.substr(start, at_ - start);
}

std::string_view Words::restOfLine()
{
  const std::size_t start = at_;
  const std::size_t end = text_.find('\n', at_);
  at_ = end == std::string_view::npos ? text_.size() : end + 1;
  line_ += end == std::string_view::npos ? 0 : 1;
  std::string_view line = text_.substr(start, std::min(end, text_.size()) - start);
  line.remove_suffix(!line.empty() && line.back() == '\r' ? 1 : 0);
  return line;
}

double Words::number()
{
  const std::string_view word = this->next();
  double value = 0.0;
  if (word.empty())
  {
    this->failTruncated();
  }
  if (!parseNumber(word, value))
  {
    this->fail(inQuotes(word) + " is not a number");
  }
  return value;
}

std::int64_t Words::integer()
{
  const std::string_view word = this->next();
  std::int64_t value = 0;
  if (word.empty())
  {
    this->failTruncated();
  }
  if (!parseInteger(word, value))
  {
    this->fail(inQuotes(word) + " is not a whole number");
  }
  return value;
}

void Words::skip(std::size_t bytes)
{
  at_ += std::min(bytes, text_.size() - at_);
}

void Words::fail(const std::string& what) const
{
  throw FileError(name_ + ", line " + std::to_string(line_) + ": " + what);
}

void Words::failTruncated() const
{
  throw FileError(name_ + ": is truncated: it ends in line " + std::to_string(line_));
}

} // namespace rockfall
