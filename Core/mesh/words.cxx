#include "mesh/words.h"

#include <algorithm>

namespace rockfall
{

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

std::int64_t Words::integer()
{
  const std::string_view word = this->next();
  if (word.empty())
  {
    this->failTruncated();
  }
  const auto value = parsedInteger(word);
  if (!value)
  {
    this->fail(inQuotes(word) + " is not a whole number");
  }
  return *value;
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
