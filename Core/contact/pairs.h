#pragma once

/// @file
/// Contacts between two rocks (METHOD 3): the direction in which they are apart, or part again the
/// shortest way, and the points on which they touch along it.
///
/// Vertex–vertex, vertex–edge, edge–face and face–face contacts reduce to the two fundamental ones:
/// vertices of either rock on a face of the other, and crossings of edges. Where two faces lie on
/// each other, these are the corners of the polygon that they share.

#include "contact/Contact.h"
#include "contact/PlacedBlock.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace rockfall
{

/// A direction in which two convex bodies can be told apart, from the second to the first.
struct PairAxis
{
  enum class Kind : std::uint8_t
  {
    None,
    FaceOfFirst,
    FaceOfSecond,
    Edges,
  };
  Kind kind = Kind::None;
  /// The proof, when last asked, that no direction is better than that of the face: a vertex of the
  /// other rock, or −2 − i: vertex i of the face's loop; −1: not looked for, less than all of
  /// these: nothing did (see pairAxis.cxx).
  std::int16_t witness = -1;
  int first = -1;              ///< Face or edge of the first rock.
  int second = -1;             ///< Of the second one.
  Vec3 normal = Vec3::UnitZ(); ///< World, unit.
  double distance = 0.0;       ///< Gap along it, m; < 0: overlap.
};

/// A rock as it stands, laid out for the search of axes: coordinate by coordinate, in fours, the
/// last vertex and face repeated to fill them up.
class PairBody
{
public:
  void update(const PlacedBlock& block);

  std::span<const Polyhedron::Edge> edges;
  double radius = 0.0;          ///< Of the bounding sphere about the centroid, m.
  double inside = 0.0;          ///< Radius of a ball about the centroid that the rock holds, m.
  Vec3 position = Vec3::Zero(); ///< Place for which all this stands.
  Mat3 rotation = Mat3::Zero();

  using Four = ShapeLayout::Four;
  int vertexFours() const { return vertexFours_; }
  int faceFours() const { return faceFours_; }
  int vertices() const { return shape_->vertices; }
  int faces() const { return shape_->faces; }
  std::span<const int> loop(int face) const { return shape_->loop(face); }
  /// n · x of four vertices, from vertex 4 i, m.
  Four alongVertices(const Vec3& n, int i) const { return along(n, data_.data() + 12 * i); }
  /// n · (normal) of four faces, from face 4 i.
  Four alongNormals(const Vec3& n, int i) const { return along(n, faceData() + 16 * i); }
  /// How far over four faces' planes a point is, from face 4 i, m.
  Four overFaces(const Vec3& point, int i) const
  {
    const double* of = faceData() + 16 * i;
    return along(point, of) - Eigen::Map<const Four>(of + 12);
  }
  /// Of all planes the farthest that a point is over one, m; < 0: so deep it is inside.
  double overAll(const Vec3& point) const
  {
    Four most = this->overFaces(point, 0);
    for (int i = 1; i < faceFours_; ++i)
    {
      most = most.max(this->overFaces(point, i));
    }
    return most.maxCoeff();
  }
  /// World, m.
  Vec3 vertex(int i) const
  {
    const double* of = data_.data() + 12 * (i >> 2) + (i & 3);
    return { of[0], of[4], of[8] };
  }
  /// World, outward, unit.
  Vec3 normal(int face) const
  {
    const double* of = faceData() + 16 * (face >> 2) + (face & 3);
    return { of[0], of[4], of[8] };
  }
  /// normal · x on the face, m.
  double offset(int face) const { return faceData()[16 * (face >> 2) + 12 + (face & 3)]; }

private:
  /// Of four vectors, given by their x, their y and their z.
  static Four along(const Vec3& n, const double* of)
  {
    using Lane = Eigen::Map<const Four>;
    return Lane(of) * n.x() + Lane(of + 4) * n.y() + Lane(of + 8) * n.z();
  }
  const double* faceData() const { return data_.data() + 12 * vertexFours_; }

  const ShapeLayout* shape_ = nullptr;
  int vertexFours_ = 0, faceFours_ = 0;
  std::vector<double> data_; ///< As in the shape's layout, but in world axes.
};

/// The axis of the largest gap; `last` stays as long as no other one is better by more than a
/// thousandth of the smaller radius, so that it does not flip between equals (METHOD 10.6). If any
/// axis shows a gap beyond `reach` (m), that one is returned at once.
PairAxis findAxis(
  const PairBody& first, const PairBody& second, const PairAxis& last, double reach);

/// The axis of the largest gap of all, by however little; `known` is one of them.
PairAxis bestAxis(const PairBody& first, const PairBody& second, const PairAxis& known = {});

/// The points of touch along an axis: gaps up to `reach` (m). An overlap that has none along it,
/// since another one is a little better, is looked at along that, and `axis` is it then. For a
/// VertexFace contact the point is on the first rock and the face on the second, for FaceVertex the
/// other way round; EdgeEdge has an edge of each. `rockFeature` and `surfaceFeature` are numbers of
/// features of the first and second rock, `ridge` the line of the second one's edge. Only those
/// with gaps under `below` (m) are told.
void findTouches(const PairBody& first, const PairBody& second, PairAxis& axis, double reach,
  std::vector<Contact>& contacts, double below = std::numeric_limits<double>::infinity());

/// The law of the contacts of two rocks.
struct PairLaw
{
  double restitution = 0.0; ///< Dimensionless, 0 … 1.
  double friction = 0.0;    ///< tan φ
  double cohesion = 0.0;    ///< N per contact point.
  double damping = 0.0;     ///< ζ for the restitution, dimensionless.
};

/// Two rocks that are or were near each other, with what lasts from step to step. What is asked of
/// those that do not touch is in the first line of the cache, and in the two behind it.
struct alignas(64) RockPair
{
  PairAxis axis;
  bool touched = false; ///< Closed contacts in the last step (see touchedAt).
  bool linked = false;  ///< The rocks may touch in the step at hand.
  bool known = false;   ///< The axis has been found for where the rocks stand now.
  /// The axis was found at the end of the last step, where the rocks still stand: exact if they
  /// overlap, else some direction in which they are apart.
  bool seen = false;
  int first = -1;       ///< Index of a rock.
  int second = -1;      ///< Index of a rock, larger.
  bool strikes = false; ///< An impact is under way.
  std::vector<Contact> contacts;
  PairAxis before; ///< The axis of the last step, if known or seen.
  PairAxis end;    ///< At the end of the step at hand, as long as it is being solved.
  PairLaw law;     ///< Of the materials that meet.
  /// The impact under way between the first touch and parting or settling.
  struct Impact
  {
    double time = 0.0;                               ///< Of the first touch, s.
    double approach = 0.0;                           ///< m/s
    double loss = 0.0;                               ///< J
    double largest = 0.0;                            ///< Force, N.
    Vec3 point = Vec3::Zero();                       ///< m
    Vec3 impulse = Vec3::Zero();                     ///< On the first rock, N s.
    Vec3 before[2] = { Vec3::Zero(), Vec3::Zero() }; ///< Velocities, m/s.
  };
  Impact impact;
  double lastingLoss = 0.0; ///< Taken by contacts outside of impacts, springs included, J.
  double touchedAt = -std::numeric_limits<double>::infinity(); ///< End of the last such step, s.

  /// These are its contacts, in as much memory as they need: most who are near each other touch
  /// nothing.
  void keep(std::span<const Contact> all)
  {
    if (all.empty())
    {
      std::vector<Contact>().swap(contacts);
    }
    else
    {
      contacts.assign(all.begin(), all.end());
    }
  }
};

/// How a rock moves past another.
struct PairMotion
{
  Vec3 velocity;                 ///< Of the first one's centroid less the second one's, m/s.
  std::array<Vec3, 2> spins;     ///< rad/s
  std::array<Vec3, 2> positions; ///< Of the centroids, m.

  PairMotion(const BlockState& first, const BlockState& second)
    : PairMotion(first.velocity - second.velocity,
        { first.angularVelocity(), second.angularVelocity() }, { first.position, second.position })
  {
  }
  PairMotion(const Vec3& passing, const std::array<Vec3, 2>& theirSpins,
    const std::array<Vec3, 2>& theirPositions)
    : velocity(passing)
    , spins(theirSpins)
    , positions(theirPositions)
  {
  }
  /// First less second, m/s.
  Vec3 at(const Vec3& point) const
  {
    return velocity + spins[0].cross(point - positions[0]) - spins[1].cross(point - positions[1]);
  }
};

/// Gaps that may close within a step.
struct ClosingGaps
{
  const PairMotion& motion;
  double time;  ///< Time for which the rocks go on, s.
  double least; ///< Gaps that may close however the rocks move, m.
  double rims;  ///< Speed at most by turning, of both together, m/s.

  /// The widest one along a normal, m,
  double along(const Vec3& normal) const
  {
    return least + time * std::max(0.0, rims - normal.dot(motion.velocity));
  }
  /// and at points, along one normal for all.
  struct AtPoints
  {
    double time, least;
    double closing; ///< Speed at which the rocks close at the origin, m/s,
    Vec3 slope;     ///< and what it grows by from there, 1/s.

    double at(const Vec3& point) const
    {
      return least + time * std::max(0.0, closing + slope.dot(point));
    }
  };
  AtPoints atPoints(const Vec3& normal) const
  {
    const Vec3 a = motion.spins[0].cross(normal), b = motion.spins[1].cross(normal);
    return { time, least,
      b.dot(motion.positions[1]) - a.dot(motion.positions[0]) - normal.dot(motion.velocity),
      a - b };
  }
};

/// Brings a pair's contacts to where the rocks stand: points that were there keep their springs,
/// new ones get none. A pair that is found overlapping without having touched carries no force at
/// the depth at which it is found. With `closing` only gaps that may close become contacts.
void updatePair(const PairBody& first, const PairBody& second, double reach, RockPair& pair,
  const ClosingGaps* closing = nullptr);

} // namespace rockfall
