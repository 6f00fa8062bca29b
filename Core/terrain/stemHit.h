#pragma once

/// @file
/// Share of a stem's energy that a hit beside its middle takes.
///
/// Offset o of a hit: the distance of the rock's way from the stem's axis, square to both, over the
/// largest at which it still touches: the rock's reach towards the stem, across its way, and the
/// stem's radius; 0 in the middle, 1 a graze. For a round rock that is the offset of the touch from
/// the axis in radii of the stem, as the law has it.
///
///     ΔE/E = −0.046 + 1.026 / (1 + 10^(−8.007 (0.58 − o)))      (Dorren 2016, Rockyfor3D)
///
/// The share is 0.98 at o = 0, 0.79 at 0.5, 0.06 at 0.7, and below 0, here 0, from about 0.75 on.
///
/// A stem holds what comes with no more than this share of its capacity E; of more it takes the
/// share. The velocity towards the axis is √(1 − o²) of the velocity, its energy 1 − o² of the
/// rock's: with more than E there the stem breaks; with less it stands, and the rock slips past
/// along it, turned by arccos o.
///
/// A stem pushes square to its axis, and takes nothing of what a rock has along it; what comes down on
/// its top, or on an end of one that lies, it pushes back. Whether it breaks is asked of all of the
/// energy, as the law has it of rocks that come along slopes.
///
/// A lying stem has the ground behind it, and nothing slips past below: it breaks by the same rule,
/// and takes the same share; with less towards its axis it stands, and is an obstacle from which a
/// rock rebounds or over which it rolls. Its offset is square to its axis and the rock's way: a
/// ball of radius R that rolls at it, of radius r on the same ground, has o = (R − r) / (R + r).

#include <algorithm>
#include <cmath>

namespace rockfall
{

/// Dimensionless, 0 to 0.98.
inline double stemShare(double offset)
{
  return std::max(0.0, -0.046 + 1.026 / (1.0 + std::pow(10.0, -8.007 * (0.58 - offset))));
}

/// Part of a rock's energy (J) in its velocity towards the axis, J.
inline double energyTowards(double offset, double energy)
{
  return (1.0 - offset * offset) * energy;
}

} // namespace rockfall
