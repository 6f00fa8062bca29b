#pragma once

/// @file
/// Sentences on numbers out of their plausible range.

#include "base/text/numberText.h"
#include "terrain/plausible.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace rockfall
{

/// What is out of a range: how many, and the first one in words.
class Doubt
{
public:
  explicit Doubt(std::string ask)
    : ask_(std::move(ask))
  {
  }

  /// `name`: the number of a feature, or words. `words` is asked only if it is the first.
  template <class Name, class Words>
  void look(bool fits, const Name& name, Words&& words)
  {
    ++all_;
    if (!fits && ++count_ == 1)
    {
      first_ = nameOf(name) + words();
    }
  }

  void tell(const char* kind, std::vector<std::string>& notes) const
  {
    if (count_ > 0)
    {
      notes.push_back(std::to_string(count_) + " of " + std::to_string(all_) + " " + kind +
        " look implausible, first " + first_ + ". " + ask_);
    }
  }

private:
  static std::string nameOf(std::int64_t feature) { return "feature " + std::to_string(feature); }
  static std::string nameOf(const std::string& name) { return name; }

  std::string ask_, first_;
  std::int64_t all_ = 0, count_ = 0;
};

/// "2 to 200" in units of `unit`.
inline std::string between(const PlausibleRange& range, double unit = 1.0)
{
  return numberText(range.least / unit, 6) + " to " + numberText(range.most / unit, 6);
}

} // namespace rockfall
