#pragma once

/// @file
/// The part of the slope near one rock: what its contacts and its flight look at, gathered when it
/// is asked for and kept while it serves.
///
/// From coarse to fine: a bound of the heights about the rock, the heights under its way, the
/// surface under it, and the pairs of features of rock and slope that may touch.

#include "contact/ground/candidates.h"
#include "rock/parts/RockBody.h"
#include "rock/parts/StructuresOnWay.h"
#include "terrain/Surface.h"

#include <array>

namespace rockfall
{

class GroundNear
{
public:
  GroundNear(const Surface& surface, double gravity)
    : surface_(surface)
    , gravity_(gravity)
  {
  }

  // No ground

  /// Whether no ground is under the way of a flight (s).
  bool clearFor(const RockBody& body, double duration) const;
  /// Whether no ground is within a reach of the rock (m) for sure, among others; looks for how high
  /// it is where that is not known.
  bool isClear(const RockBody& body, const StructuresOnWay& structures, double reach);
  /// The same where it is known, wherever the rock may be.
  bool isClearAt(const RockBody& body, const Vec3& place, double reach) const
  {
    return heightBound_.isUnder(place, body.block.radius() + reach);
  }

  // Heights under the way of a flight

  void ensureWindow(const RockBody& body, double duration);
  const HeightWindow& window() const { return window_; }
  /// Lower bound of the time to the first touch of the ground in free flight, s.
  double timeToGround(const RockBody& body, double duration);

  // The surface under the rock, and what of it may touch

  const SurfacePatch& patch() const { return patch_; }
  /// By this margin (m) around where the rock is placed, and what stands there.
  void ensurePatch(const RockBody& body, const StructuresOnWay& structures, double margin);
  void forgetPatch();
  /// The surface, but for what is firm on it, lies lower by this, m, and `depth` (m) lower in all, now
  /// and where it is gathered next.
  void lower(double by, double depth);
  const CandidatePairs& candidates() const { return candidates_; } ///< By ensureCandidates.
  /// `among`: many others.
  void ensureCandidates(
    const RockBody& body, const StructuresOnWay& structures, double reach, bool among = false);
  void forgetCandidates() { candidates_.distance = -1.0; }
  /// Candidates for where a step of an island would end, by a way (m).
  const CandidatePairs& candidatesAt(
    const RockBody& body, const StructuresOnWay& structures, const BlockState& end, double way);

private:
  /// Least and most x and y (m) that a flight comes over.
  std::array<double, 4> boxOfWay(const RockBody& body, double duration) const;

  const Surface& surface_;
  double gravity_;     ///< m/s²
  double depth_ = 0.0; ///< By which the surface is lowered, m.
  GroundHeightBound heightBound_;
  CandidatePairs candidates_;
  SurfacePatch patch_;
  HeightWindow window_;
  SurfacePatch holed_; ///< Under the way of a flight that comes over holes.
};

} // namespace rockfall
