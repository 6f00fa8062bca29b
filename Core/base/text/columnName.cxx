#include "base/text/columnName.h"

#include "base/text/lengthUnit.h"
#include "base/text/nameKey.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

namespace rockfall
{

namespace
{

/// A word of a name: where it begins and ends.
struct Word
{
  std::size_t begin, end;
};

bool isSign(char c)
{
  return !(c < 0 || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'));
}

std::vector<Word> placesOfWords(std::string_view name)
{
  const auto isSmall = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto isCapital = [](char c) { return c >= 'A' && c <= 'Z'; };
  std::vector<Word> words;
  bool inside = false;
  for (std::size_t i = 0; i < name.size(); ++i)
  {
    if (isSign(name[i]))
    {
      inside = false;
      continue;
    }
    if (!inside || (isCapital(name[i]) && isSmall(name[i - 1])))
    {
      words.push_back({ i, i });
    }
    words.back().end = i + 1;
    inside = true;
  }
  return words;
}

} // namespace

ColumnName::ColumnName(const std::string& written)
{
  const std::size_t open = written.find_first_of("[(");
  const bool brackets = open != std::string::npos && open > 0;
  const std::vector<Word> places =
    placesOfWords(std::string_view(written).substr(0, brackets ? open : std::string::npos));
  std::transform(places.begin(), places.end(), std::back_inserter(words),
    [&](const Word& w) { return nameKey(written.substr(w.begin, w.end - w.begin)); });
  if (brackets)
  {
    const std::size_t from = open + 1;
    const std::size_t close = std::min(written.find_first_of("])", from), written.size());
    name = nameKey(written.substr(0, open));
    unit = nameKey(written.substr(from, close - from));
    return;
  }
  name = nameKey(written);
  for (std::size_t k = places.size(); k-- > 1;)
  {
    const bool last = k + 1 == words.size(); // else "in" is no inch
    if (!lengthUnit(words[k]) || (words[k] == "in" && !last))
    {
      continue;
    }
    std::size_t first = k;
    unit = words[k];
    for (; first > 1 && (words[first - 1] == "us" || words[first - 1] == "survey"); --first)
    {
      unit = words[first - 1] + " " + unit;
    }
    if (first == k && !last && words[k + 1] == "us")
    {
      unit += " us";
    }
    first -= first > 1 && words[first - 1] == "in";
    name = nameKey(written.substr(0, places[first - 1].end));
    return;
  }
}

} // namespace rockfall
