#pragma once

/// @file
/// A contact between a rock and the slope (METHOD 3), and the rock's geometry as it stands.

#include "block/Block.h"
#include "law/ContactState.h"
#include "terrain/Surface.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
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
  // What it is made of, given when it is admitted (0: as the step's request says).
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

/// In the springs of the closed ones, J.
inline double springEnergyOf(const std::vector<Contact>& contacts)
{
  return std::accumulate(contacts.begin(), contacts.end(), 0.0,
    [](double sum, const Contact& c) { return sum + c.springEnergy(); });
}

/// A block as it stands in the world: what contact detection reads.
class PlacedBlock
{
public:
  void place(const Block& block, const BlockState& state);

  const Block& block() const { return *block_; }
  const Vec3& position() const { return position_; }
  const Mat3& rotation() const { return rotation_; }
  /// Of the reference shape, strained, to world axes.
  const Mat3& map() const { return map_; }
  // Found when they are asked for first, by whoever has the block: not by several threads at once.
  const std::vector<Vec3>& vertices() const ///< World, m.
  {
    this->findVertices();
    return vertices_;
  }
  Vec3 lower() const ///< Corner of the bounding box, m.
  {
    this->findVertices();
    return lower_;
  }
  Vec3 upper() const
  {
    this->findVertices();
    return upper_;
  }
  Vec3 normal(int face) const ///< World, outward, unit.
  {
    return rotation_ * block_->shape().normals()[face];
  }

  /// Signed distance of a world point over a face; the strain of the block is undone first.
  double faceDistance(int face, const Vec3& world) const
  {
    const Vec3 x = this->materialPoint(world);
    return block_->shape().normals()[face].dot(x) - block_->shape().offsets()[face];
  }
  /// The face over which a world point is farthest out, or least deep if it is inside.
  int outermostFace(const Vec3& world) const;
  /// The undeformed body coordinates of a world point.
  Vec3 materialPoint(const Vec3& world) const
  {
    return undeform_ * (rotation_.transpose() * (world - position_));
  }

private:
  void findVertices() const
  {
    if (!found_)
    {
      this->placeVertices();
    }
  }
  void placeVertices() const;

  const Block* block_ = nullptr;
  Vec3 position_ = Vec3::Zero();
  Mat3 rotation_ = Mat3::Identity();
  Mat3 map_ = Mat3::Identity();
  Mat3 undeform_ = Mat3::Identity(); ///< (I + ε)⁻¹
  mutable bool found_ = true;        ///< What follows.
  mutable std::vector<Vec3> vertices_;
  mutable Vec3 lower_ = Vec3::Zero();
  mutable Vec3 upper_ = Vec3::Zero();
};

/// The pairs of features that can touch while the rock stays near where it stood: found once, then
/// looked through at every step.
struct CandidatePairs
{
  struct Pair
  {
    int rock;  ///< Vertex or edge.
    int patch; ///< Triangle or ridge.
  };
  std::vector<Pair> vertexFace;
  std::vector<Pair> edgeEdge;
  std::vector<int> peaks; ///< Nodes of the patch.
  /// Work space: per triangle the vertices, modulo 64, that are not far over its plane.
  std::vector<std::uint64_t> under;
  double distance = -1.0;       ///< Within which they were gathered, m; < 0: not at all.
  Vec3 position = Vec3::Zero(); ///< Of the rock then.
  Quat orientation = Quat::Identity();

  /// How much further the rock (of this radius) may move until a pair within `reach` of it might
  /// not be among them, m; < 0: it might not be now.
  double room(const BlockState& state, double radius, double reach) const;
  bool empty() const { return vertexFace.empty() && edgeEdge.empty() && peaks.empty(); }
};

/// Finds all pairs within `distance` (m).
void gatherCandidates(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double distance, CandidatePairs& candidates);

class PairBody;

/// Gaps between a rock and the slope that may close within a step.
struct SlopeReach
{
  Vec3 velocity; ///< Of the rock's centroid, m/s.
  double speed;  ///< What turning and other rocks may add to it, in any direction, m/s.
  double time;   ///< For which it goes on, s.
  double least;  ///< Gaps that may close however it moves, m.
  double most;   ///< No gap that is wider does, m.

  /// The widest one along a normal of the slope, m.
  double along(const Vec3& normal) const
  {
    return std::min(most, least + time * std::max(0.0, speed - normal.dot(velocity)));
  }
};

/// Finds the pairs that can be contacts where the rock stands now and may close within a step, and
/// few others: for one that goes on so far in a step that candidates would not serve the next. Only
/// on a patch that is all slope.
void gatherNow(const PlacedBlock& rock, const PairBody& body, const SurfacePatch& patch,
  const SlopeReach& reach, CandidatePairs& candidates);
/// The same of vertices that are straight under the slope, and peaks in the rock, by more than
/// `allowed` (m).
void gatherUnder(const PlacedBlock& rock, const PairBody& body, const SurfacePatch& patch,
  double allowed, CandidatePairs& candidates);

/// Brings the closed contacts of the last step, and the open ones that still overlap, to where the
/// rock stands now, hands them over between neighbouring features, and adds every pair of the
/// candidates that can close within `reach` (m), and within `turn` (rad) of the rock.
///
/// A pair enters only through a valid configuration, with the normal inside both features' normal
/// cones and the projection inside both features, at a gap of about zero; once closed it stays,
/// whatever the cones say, until it opens: the entrance is the physically first one and does not
/// flip (METHOD 10.6). Flat and concave edges of the slope are no features, so a smooth plane cut
/// into many CFEs gives the contacts of one (METHOD 10.5).
void updateContacts(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double reach, std::vector<Contact>& contacts,
  double turn = 0.0);

/// Lower bound of the time (s, at most `horizon`) in which a pair of the candidates that is apart
/// now can close in free flight. 0 where the rock overlaps the slope.
double timeToClose(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  const CandidatePairs& candidates, double gravity, double horizon);

/// The net under the entrance rules: every candidate vertex of the rock that is under the slope by
/// more than `allowed` (m), and every peak as deep inside the rock, gets a contact that carries no
/// force at the overlap it is found with and resists any further one, unless it has a contact
/// already.
void holdOverlap(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double allowed, std::vector<Contact>& contacts);

/// Whether any vertex or peak is that deep.
bool overlaps(const PlacedBlock& rock, const SurfacePatch& patch, const CandidatePairs& candidates,
  double allowed);

/// The same entrance rules by brute force over all pairs, without pruning: the oracle of the tests.
void findEntrancesBruteForce(
  const PlacedBlock& rock, const SurfacePatch& patch, double reach, std::vector<Contact>& contacts);

/// Lower bound of the time (s, at most `horizon`) to the first touch in free flight over the
/// window, which must hold all that the rock can come over until then. For every place where the
/// gap along the vertical can be least, it is covered at the speed that this point of the rock has,
/// towards a slope that may differ from the window's mean by as much as any of its CFEs does. 0
/// where the two overlap.
double timeToTouch(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  double gravity, double horizon);
/// The same for the bounding sphere over the plane that no node of the window is above.
double timeToNear(const BlockState& state, double radius, const HeightWindow& window,
  double gravity, double horizon);

/// Lower bound of the time (s, at most `horizon`) to the first touch of an obstacle in free flight.
/// Where the bounding sphere comes to one within `close` (s), `rock` is placed there and looked at
/// itself. Trees that are `gone` (ascending) do not count.
double timeToObstacle(PlacedBlock& rock, const BlockState& state, const Block& block,
  const Obstacles& obstacles, std::span<const int> gone, double gravity, double close,
  double horizon);

/// How far a rock is from touching.
struct Clearance
{
  double distance = 0.0; ///< Lower bound of the distance to the patch, m; ≤ 0: may touch.
  double time = 0.0;     ///< Lower bound of the time to the first touch in free flight, s.
};

/// Conservative: per CFE the best of the separating axes (its normal, the world axes, the faces of
/// the rock, the cross products of edges: complete for convex bodies). A fixed axis n is approached
/// no faster than |ω| r − n·v plus gravity. Times beyond `horizon` (s) are not told apart, which
/// spares most of the axes.
Clearance clearance(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double gravity, double horizon);

/// Deepest penetration of the rock's vertices under the slope of the patch and of its peaks into
/// the rock, m, ≥ 0. Edges that cross and obstacles are not looked at.
double penetration(const PlacedBlock& rock, const SurfacePatch& patch);

} // namespace rockfall
