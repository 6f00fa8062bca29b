#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rockfall
{

/// How many there are of a kind that a note tells, and the first of them in words.
class Tally
{
public:
  /// `words` is asked only if it is the first that `counts`.
  template <class Words>
  void look(bool counts, Words&& words)
  {
    if (counts && ++count_ == 1)
    {
      first_ = words();
    }
  }

  /// Adds a note if there is any: `before`, how many, `between`, the first, `after`.
  void tell(std::vector<std::string>& notes, const std::string& before, const std::string& between,
    const std::string& after) const
  {
    if (count_ > 0)
    {
      notes.push_back(before + std::to_string(count_) + between + first_ + after);
    }
  }

private:
  std::int64_t count_ = 0;
  std::string first_;
};

} // namespace rockfall
