#pragma once

/// @file
/// A step of soft rows as its contacts and rocks take it on: motion, springs, books.

#include "solve/island/softRows.h"

#include <vector>

namespace rockfall::soft
{

class Writer
{
public:
  Writer(const Step& step, const Movers& movers, const Rows& rows)
    : step_(step)
    , movers_(movers)
    , rows_(rows)
  {
  }

  /// Whether rocks are deep in each other that were not.
  bool isDeep() const;
  void write(IslandOutcome& outcome);

private:
  void writeContact(std::size_t row) const;
  void bookContacts(IslandOutcome& outcome);
  void writeBody(std::size_t i);

  /// Books of a rock.
  struct Books
  {
    double slope;     ///< Work of contacts with the slope on it, J.
    double rocks;     ///< Work of other rocks on it, J.
    double held;      ///< In springs on the slope where the step began, J.
    double strongest; ///< Impulse of a contact, N s.
    std::size_t by;   ///< Row of this contact.
  };

  const Step& step_;
  const Movers& movers_;
  const Rows& rows_;
  std::vector<Books> books_;
};

} // namespace rockfall::soft
