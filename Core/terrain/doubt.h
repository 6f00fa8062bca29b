#pragma once

/// @file
/// Sentences on numbers out of their plausible range.

#include "base/Tally.h"
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
  /// `kind`: plural of what is looked at; `ask`: sentences behind how many and the first.
  Doubt(std::string kind, std::string ask)
    : kind_(std::move(kind))
    , ask_(std::move(ask))
  {
  }

  /// `name`: of the one that is looked at. `words` is asked only if it is the first.
  template <class Words>
  void look(bool fits, const std::string& name, Words&& words)
  {
    ++all_;
    tally_.look(!fits, [&] { return name + words(); });
  }

  /// The same of a number, told in `unit` (with the blank before it), which is `scale` of SI.
  void look(
    bool fits, const std::string& name, double value, const std::string& unit, double scale = 1.0)
  {
    this->look(fits, name, [&] { return " with " + numberText(value / scale, 6) + unit; });
  }

  void look(const PlausibleRange& range, const std::string& name, double value,
    const std::string& unit, double scale = 1.0)
  {
    this->look(range.has(value), name, value, unit, scale);
  }

  void tell(std::vector<std::string>& notes) const
  {
    tally_.tell(notes, "",
      " of " + std::to_string(all_) + " " + kind_ + " look implausible, first ", ". " + ask_);
  }

private:
  std::string kind_, ask_;
  std::int64_t all_ = 0;
  Tally tally_;
};

/// Tells of each, in their order.
template <class... Doubts>
void tellAll(std::vector<std::string>& notes, const Doubts&... doubts)
{
  (doubts.tell(notes), ...);
}

inline std::string featureText(std::int64_t feature)
{
  return "feature " + std::to_string(feature);
}

/// "2 to 200" in units of `unit`.
inline std::string between(const PlausibleRange& range, double unit = 1.0)
{
  return numberText(range.least / unit, 6) + " to " + numberText(range.most / unit, 6);
}

} // namespace rockfall
