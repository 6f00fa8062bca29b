#pragma once

/// @file
/// A rock mass that joint sets cut into blocks.

#include "geometry/Polyhedron.h"
#include "geometry/cutting.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// Joints of one orientation, planes right through the mass (persistence 1).
struct JointSet
{
  double dip = 0.0;          ///< δ, below the horizontal, rad, 0 … 90°.
  double dipDirection = 0.0; ///< α, azimuth of the line of dip, clockwise from +y (north), rad.
  double spacing = 1.0;      ///< Mean distance of neighbours along the normal, m, > 0.
  /// Where along the upward normal from the mass's centroid one of the joints is, m.
  double offset = 0.0;
  double spacingDeviation = 0.0;     ///< Standard deviation of the log-normal spacing, m, ≥ 0.
  double orientationDeviation = 0.0; ///< Of a joint's tilt about two axes in its plane, rad, ≥ 0.

  /// n = (sin δ sin α, sin δ cos α, cos δ), upward.
  Vec3 normal() const;
  void validate(const std::string& name) const; ///< Throws ParameterError naming set and value.
};

/// Treatment of blocks that are too thin or too small.
enum class SliverRule
{
  Refuse = 0, ///< An error.
  Drop = 1,   ///< Left out.
  Keep = 2,   ///< Blocks like the others.
};

struct MassCut
{
  SliverRule slivers = SliverRule::Refuse;
  double leastThickness = 0.01; ///< m, ≥ 0; see thicknessOf.
  double leastVolume = 1e-3;    ///< m³, ≥ 0.
  /// If more are to be expected nothing is cut; if more are made all the same cutting ends.
  std::int64_t mostBlocks = 100000;
  std::uint64_t seed = 1; ///< Of the deviations.

  void validate() const; ///< Throws ParameterError naming field and value.
};

struct CutMass
{
  std::vector<Polyhedron> blocks; ///< In the frame of the mass, in the order of the cuts.
  std::int64_t slivers = 0;       ///< Dropped or kept.
  double sliverVolume = 0.0;      ///< Theirs, m³.
};

/// The number of blocks to be expected of joints in general position. In such an arrangement every
/// plane adds one cell, and so does every line of intersection and every triple point inside a
/// convex body; their mean numbers, over all offsets, are
///
///     N = 1 + Σᵢ w(nᵢ) / sᵢ + Σᵢⱼ A(nᵢ × nⱼ) |nᵢ × nⱼ| / (sᵢ sⱼ) + Σᵢⱼₖ V |det(nᵢ, nⱼ, nₖ)| / (sᵢ
///     sⱼ sₖ)
///
/// with w the width of the body along a normal, A the area of its shadow along a direction, V its
/// volume, and sums over different sets.
double expectedBlocks(const Polyhedron& mass, std::span<const JointSet> sets);

/// The planes of a set that can meet the mass, ascending along the set's normal: a function of
/// (seed, number of the set) and of the mass's centroid and size.
std::vector<CuttingPlane> jointPlanes(
  const Polyhedron& mass, const JointSet& set, std::size_t number, std::uint64_t seed);

/// Cuts a mass by all joints of all sets. The volumes of blocks and slivers sum to that of the mass
/// within 1e-12 of it. `origin` is what the mass's coordinates are about, for messages. Throws
/// ParameterError or GeometryError: a set that is parallel to another one within 1° or cuts
/// nothing, too many blocks (with what they would take), slivers.
CutMass cutMass(const Polyhedron& mass, std::span<const JointSet> sets, const MassCut& how,
  const Vec3& origin = Vec3::Zero());

} // namespace rockfall
