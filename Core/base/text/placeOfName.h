#pragma once

#include "base/errors.h"
#include "base/text/nameKey.h"

#include <functional>
#include <iterator>
#include <string>

namespace rockfall
{

/// Place, from 0, of the entry of a table whose `name`, in small letters, is the word (nameKey).
/// Throws ParameterError "Shape is "ball", it must be one of cube, …", of a `field`.
template <class Table, class Name = std::identity>
std::size_t placeOfName(
  const Table& table, const std::string& word, const std::string& field, Name&& name = {})
{
  const std::string wanted = nameKey(word);
  std::string choices;
  for (std::size_t k = 0; k < std::size(table); ++k)
  {
    const std::string known = std::invoke(name, table[k]);
    if (wanted == known)
    {
      return k;
    }
    choices += (k > 0 ? ", " : "") + known;
  }
  throw ParameterError(field + " is \"" + word + "\", it must be one of " + choices);
}

} // namespace rockfall
