#pragma once

/// @file
/// A contact between two rocks, or of a rock with the slope (METHOD 3).

#include "base/types.h"
#include "law/ContactState.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace rockfall
{

/// The fundamental contacts. All others reduce to these.
enum class ContactKind : std::uint8_t
{
  VertexFace, ///< A vertex of the rock on a CFE.
  FaceVertex, ///< A face of the rock on a node of the slope.
  EdgeEdge,   ///< An edge of the rock on a ridge of the slope.
};

/// Four lines of the cache, in the order of their use: most who go over many contacts need the
/// first one or two, and the last is for edges.
struct alignas(64) Contact
{
  ContactKind kind = ContactKind::VertexFace;
  ContactState state = ContactState::Open;
  int rockFeature = -1;            ///< Vertex, face or edge of the rock.
  int patchFeature = -1;           ///< Triangle, node or ridge in the patch at hand.
  std::int64_t surfaceFeature = 0; ///< Key of the triangle, node or ridge: the same across patches.
  std::int64_t cfe = 0;            ///< A CFE that the contact is on, for material and output.
  double distance = 0.0;           ///< Signed geometric gap along the normal, m; < 0 penetrates.
  /// A pair that is found already overlapping carries no force at the overlap it was found with (≤
  /// 0), so that finding it makes no energy; m.
  double offset = 0.0;
  double normalForce = 0.0; ///< Mean over the last step, N.
  double shearForce = 0.0;  ///< Magnitude, mean over the last step, N.

  Vec3 normal = Vec3::UnitZ(); ///< Out of the slope, world, unit.
  Vec3 point = Vec3::Zero();   ///< Where the rock touches, world, m.
  // Springs and dashpots, given when it is admitted (0: as the step's request says).
  double stiffness = 0.0;      ///< pₙ, N/m.
  double shearStiffness = 0.0; ///< pₛ, N/m.

  Vec3 slip = Vec3::Zero();  ///< s₀, elongation of the shear spring, world, m.
  double dashpot = 0.0;      ///< Along the normal, during impacts, N s/m.
  double stopped = 1e300;    ///< Mass that this dashpot stops, kg.
  double shearDashpot = 0.0; ///< In its plane, during impacts, N s/m.
  /// Of the ground under it, given before every step (< 0: as the step's request says).
  double friction = -1.0; ///< tan φ
  double cohesion = -1.0; ///< N

  double frequency2 = 0.0; ///< Of the block on this spring alone, squared, 1/s².
  /// EdgeEdge: a point of the ridge and its direction, world.
  std::array<Vec3, 2> ridge = { Vec3::Zero(), Vec3::Zero() };

  bool closed() const { return state != ContactState::Open; }
  double gap() const { return distance - offset; } ///< d₀, m.
  double springEnergy() const                      ///< In both springs, J.
  {
    const double compressed = std::min(0.0, this->gap());
    return this->closed()
      ? 0.5 * stiffness * compressed * compressed + 0.5 * shearStiffness * slip.squaredNorm()
      : 0.0;
  }
};

inline std::ptrdiff_t closedCount(const std::vector<Contact>& contacts)
{
  return std::count_if(
    contacts.begin(), contacts.end(), [](const Contact& c) { return c.closed(); });
}

inline bool anyClosed(const std::vector<Contact>& contacts)
{
  return std::any_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.closed(); });
}

/// In the springs of the closed ones, J.
inline double springEnergyOf(const std::vector<Contact>& contacts)
{
  return std::accumulate(contacts.begin(), contacts.end(), 0.0,
    [](double sum, const Contact& c) { return sum + c.springEnergy(); });
}

} // namespace rockfall
