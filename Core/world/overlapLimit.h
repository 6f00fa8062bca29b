#pragma once

/// @file
/// How deep contacts of rocks that fall together may be pressed in.
///
/// A spring of a light rock is made for what the rock itself brings. Under a boulder it would take
/// the boulder's energy, at an overlap as large as the stone, and give it to the stone: hundreds of
/// m/s. In nature the stone is crushed.

#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

/// The deepest overlap (m) at which a spring (N/m) holds no more energy than two that meet at
/// `speed` (m/s) have between them. `mass`: the reduced one, kg; `radius`: the smaller one, m. What
/// is deeper others have pressed in.
inline double deepestBetween(double radius, double speed, double mass, double stiffness)
{
  return std::max(kFirm * radius, kSomeMore * speed * std::sqrt(mass / stiffness));
}

} // namespace rockfall
