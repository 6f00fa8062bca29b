#pragma once

/// @file
/// The tags of an XML file one after the other: all that VTK's files need of XML.

#include "mesh/words.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rockfall
{

struct XmlTag
{
  std::string_view name; ///< Of an end tag as well.
  bool isEnd = false;    ///< </name>
  bool isWhole = false;  ///< <name/>
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  std::string_view text; ///< Behind it, up to the next tag.

  /// Empty if it is not there.
  std::string_view operator[](std::string_view attribute) const
  {
    for (const auto& [key, value] : attributes)
    {
      if (key == attribute)
      {
        return value;
      }
    }
    return {};
  }
};

class XmlTags
{
public:
  XmlTags(std::string_view text, std::string name)
    : text_(text)
    , name_(std::move(name))
  {
  }

  /// The next tag; nothing at the end of the file. Comments and declarations are passed over.
  /// Throws FileError for what is no XML.
  std::optional<XmlTag> next();
  /// Text behind the tag that was read last, to the end of the file.
  std::string_view rest() const { return text_.substr(at_); }

private:
  [[noreturn]] void fail(const std::string& what) const;

  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
};

} // namespace rockfall
