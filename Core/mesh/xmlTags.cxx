#include "mesh/xmlTags.h"

#include <algorithm>

namespace rockfall
{

namespace
{

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view takeUntil(std::string_view& text, std::string_view ends)
{
  const std::string_view taken = text.substr(0, text.find_first_of(ends));
  text.remove_prefix(taken.size());
  return taken;
}

void skipBlanks(std::string_view& text)
{
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
}

} // namespace

void XmlTags::fail(const std::string& what) const
{
  const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at_), '\n');
  throw FileError(name_ + ", line " + std::to_string(line) + ": " + what);
}

std::optional<XmlTag> XmlTags::next()
{
  while (true)
  {
    const std::size_t start = text_.find('<', at_);
    if (start == std::string_view::npos)
    {
      return {};
    }
    at_ = start;
    const std::string_view left = text_.substr(at_);
    const bool comment = left.substr(0, 4) == "<!--";
    if (!comment && left.substr(0, 2) != "<?" && left.substr(0, 2) != "<!")
    {
      break;
    }
    const std::string_view end = comment ? "-->" : ">";
    const std::size_t found = left.find(end);
    if (found == std::string_view::npos)
    {
      this->fail("is no XML: what begins here has no end");
    }
    at_ += found + end.size();
  }
  std::string_view left = text_.substr(at_ + 1);
  XmlTag tag;
  tag.isEnd = !left.empty() && left[0] == '/';
  left.remove_prefix(tag.isEnd ? 1 : 0);
  tag.name = takeUntil(left, " \t\r\n/>");
  for (skipBlanks(left); !left.empty() && left[0] != '>' && left[0] != '/'; skipBlanks(left))
  {
    const std::string_view key = takeUntil(left, "= \t\r\n/>");
    skipBlanks(left);
    if (left.empty() || left[0] != '=' || key.empty())
    {
      this->fail("is no XML: the tag " + inQuotes(tag.name) + " has an attribute without a value");
    }
    left.remove_prefix(1);
    skipBlanks(left);
    const char quote = left.empty() ? ' ' : left[0];
    const std::size_t end = left.find(quote, 1);
    if ((quote != '"' && quote != '\'') || end == std::string_view::npos)
    {
      this->fail("is no XML: the attribute " + inQuotes(key) + " has no value in quotes");
    }
    tag.attributes.emplace_back(key, left.substr(1, end - 1));
    left.remove_prefix(end + 1);
  }
  tag.isWhole = !left.empty() && left[0] == '/';
  left.remove_prefix(tag.isWhole ? 1 : 0);
  if (left.empty() || left[0] != '>' || tag.name.empty())
  {
    this->fail("is no XML: a tag has no end");
  }
  left.remove_prefix(1);
  at_ = text_.size() - left.size();
  tag.text = left.substr(0, left.find('<'));
  return tag;
}

} // namespace rockfall
