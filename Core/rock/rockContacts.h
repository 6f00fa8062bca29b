#pragma once

/// @file
/// The laws of contact of all pairs of rocks, by their materials.

#include "contact/pairs.h"
#include "rock/Rock.h"
#include "rock/parameters.h"

#include <span>
#include <vector>

namespace rockfall
{

/// Throws ParameterError naming the pair, the field and the value: a pair without two names, a
/// pair twice (also in reverse order), a value out of range, more than 255 materials.
void validateRockContacts(std::span<const RockContactPair> pairs);

/// A dense table over the materials that `rockContactPairs` names; all others are one kind, which
/// has the parameters' restitution, friction angle and cohesion with everything.
class RockContacts
{
public:
  RockContacts(std::span<const Rock> rocks, const SimulationParameters& parameters);

  /// Of two rocks by their indices, the same in either order.
  const PairLaw& between(int first, int second) const
  {
    return laws_[std::size_t(kindOf_[std::size_t(first)]) * kinds_ +
      std::size_t(kindOf_[std::size_t(second)])];
  }
  double largestRestitution() const;

private:
  std::size_t kinds_ = 1;
  std::vector<int> kindOf_;   ///< By rock; 0: a material of no pair, or none.
  std::vector<PairLaw> laws_; ///< kinds × kinds, symmetric.
};

} // namespace rockfall
