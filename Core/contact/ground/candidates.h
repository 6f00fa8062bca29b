#pragma once

/// @file
/// The pairs of features of a rock and the slope that can touch.

#include "contact/PlacedBlock.h"
#include "terrain/Surface.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace rockfall
{

/// How far any point of a rock can have come from look to look, m: what was farther off at a look
/// need not be looked at before that way is gone.
class RockTravel
{
public:
  RockTravel() = default;
  explicit RockTravel(const PlacedBlock& start);
  double to(const PlacedBlock& rock);
  void lower(double by) { position_.z() -= by; } ///< The ground sinks by this, m.

private:
  double way_ = 0.0; ///< m
  Vec3 position_ = Vec3::Zero();
  Quat orientation_ = Quat::Identity();
  Eigen::Matrix<double, 6, 1> strain_ = Eigen::Matrix<double, 6, 1>::Zero();
};

/// The pairs of features that can touch while the rock stays near where it stood: found once, then
/// looked through at every step.
struct CandidatePairs
{
  struct Pair
  {
    int rock;  ///< Vertex or edge.
    int patch; ///< Triangle or ridge.
    /// Ways that the rock may go (m), by the last look, before it may be on a plane of the patch's
    /// feature, and beside the triangle no longer. Looks write them.
    mutable double over = -std::numeric_limits<double>::infinity();
    mutable double beside = -std::numeric_limits<double>::infinity();
  };
  mutable RockTravel travel;
  std::vector<Pair> vertexFace;
  std::vector<Pair> edgeEdge;
  std::vector<int> peaks; ///< Nodes of the patch.
  /// Work space: per triangle the vertices, modulo 64, that are not far over its plane.
  std::vector<std::uint64_t> under;
  double distance = -1.0;       ///< Within which they were gathered, m; < 0: not at all.
  Vec3 position = Vec3::Zero(); ///< Of the rock then.
  Quat orientation = Quat::Identity();
  Eigen::Matrix<double, 6, 1> strain = Eigen::Matrix<double, 6, 1>::Zero();

  /// How much further the rock (of this radius) may move until a pair within `reach` of it might
  /// not be among them, m; < 0: it might not be now.
  double room(const BlockState& state, double radius, double reach) const;
  bool empty() const { return vertexFace.empty() && edgeEdge.empty() && peaks.empty(); }
};

/// Finds all pairs within `distance` (m).
void gatherCandidates(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double distance, CandidatePairs& candidates);

/// Lower bound of the time (s, at most `horizon`) in which a pair of them that is apart now can close
/// in free flight. 0 where the rock overlaps the slope.
double timeToClose(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  const CandidatePairs& candidates, double gravity, double horizon);

} // namespace rockfall
