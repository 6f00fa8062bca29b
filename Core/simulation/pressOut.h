#pragma once

/// @file
/// How an overlap that was found, not made, is pressed out of a lasting contact.

#include "contact/Contact.h"

#include <algorithm>

namespace rockfall
{

constexpr double kPressOut = 0.005;    ///< Speed, m/s.
constexpr double kPressOutDeep = 0.1;  ///< The same beyond a loose overlap, m/s.
constexpr double kLooseOverlap = 1e-3; ///< Share of the radius.

/// A step of `h` (s): by `slow` (m), or fast if deeper than `loose` (m).
inline void pressOut(Contact& c, double h, double slow, double loose)
{
  const double way = c.offset < -loose ? kPressOutDeep * h : slow;
  c.offset = c.offset < 0.0 ? std::min(0.0, c.offset + way) : std::max(0.0, c.offset - way);
}

} // namespace rockfall
