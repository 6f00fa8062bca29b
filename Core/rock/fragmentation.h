#pragma once

/// @file
/// The law by which a rock breaks into pieces, after the fractal model of rockfalls (Ruiz-Carulla,
/// Corominas & Mavrouli 2017, Landslides 14, 875–889; Perfect 1997, Eng. Geol. 48): a body that has
/// broken is cut in two, and each part breaks again with a probability P that does not depend on
/// its size. Here a cut goes through a point drawn uniformly in the body, so that the shares of the
/// two volumes are uniform in 0 … 1. The mean number of pieces of at least x times the volume is
/// then a power law at every size:
///
///     N(≥ x) = (1 − τ)/τ (x^−τ − 1),   τ = D/3,   P = (1 + τ)/2
///
/// and x^(1−τ) of the mass is in smaller ones. The number of the body, not its motion, decides how
/// it breaks.

#include "geometry/Polyhedron.h"
#include "rock/parameters.h"
#include "terrain/Surface.h"

#include <cstdint>
#include <vector>

namespace rockfall
{

/// Mean number of pieces of at least `share` of the volume, 0 < share ≤ 1.
double meanFragments(double fractalDimension, double share);

/// More are refused: of a rock, in the mean.
constexpr double kMostFragments = 1000.0;

/// Pieces of at least the least volume, in place in the body. A piece too thin for a polyhedron is
/// left out.
std::vector<Polyhedron> fragmentsOf(
  const Polyhedron& body, const Fragmentation& law, const Surface& surface, std::uint32_t number);

/// A velocity turned by an angle of at most the law's spread about itself, uniform over the cone. It
/// does not point into the ground of this normal unless the one given does.
Vec3 spreadVelocity(const Vec3& velocity, const Vec3& normal, const Fragmentation& law,
  const Surface& surface, std::uint32_t number);

} // namespace rockfall
