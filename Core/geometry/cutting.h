#pragma once

/// @file
/// Convex bodies cut by planes right through: Shi's block cutting with joints of persistence 1.

#include "base/types.h"

#include <vector>

namespace rockfall
{

/// The points x with normal · x = offset.
struct CuttingPlane
{
  Vec3 normal = Vec3::UnitZ(); ///< Unit.
  double offset = 0.0;         ///< m
};

/// A convex body in the making: loops counter-clockwise seen from outside.
struct ConvexPiece
{
  std::vector<Vec3> points; ///< m
  std::vector<std::vector<int>> faces;
};

/// Vertices as near to a plane as this, relative to the extent of the whole that is cut, lie in it:
/// some 450 times the rounding of a double, and so more than what the few operations of a cut
/// leave, and so little that the volumes of all pieces still sum to the whole within 1e-12.
constexpr double cutTolerance = 1e-13;

/// Cuts a piece in two. False if the plane leaves all of it on one side; nothing is made then.
///
/// Vertices within `tolerance` (m) of the plane are in it, and belong to both. A new vertex is a
/// function of its edge's ends alone, whichever piece the edge is of, so that neighbours which are
/// cut one after the other by the same planes keep faces with the same points, bit for bit. Throws
/// GeometryError if the cut is no simple loop, which a body that is not convex makes.
bool cutPiece(const ConvexPiece& piece, const CuttingPlane& plane, double tolerance,
  ConvexPiece& below, ConvexPiece& above);

/// The least distance between a face and the plane parallel to it that the body ends at, m.
double thicknessOf(const ConvexPiece& piece);

} // namespace rockfall
