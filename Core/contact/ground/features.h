#pragma once

/// @file
/// The geometric tests of single pairs, shared by the pruned and the brute-force search.

#include "contact/Contact.h"
#include "contact/PlacedBlock.h"
#include "terrain/Surface.h"

#include <optional>

namespace rockfall
{

/// Whether the projection of a point on the triangle's plane lies inside it. Beyond a concave edge
/// the plane is still a valid constraint and is extended by `reach`; so a vertex that runs into a
/// valley meets the other side in the step in which it gets there. The edge to the triangle `from`
/// does not count (−1: all do).
bool projectsInside(const SurfacePatch& patch, int triangle, const Vec3& point, double reach,
  double tolerance, int from = -1);

/// Whether a point is straight above or below a triangle of the slope.
bool isStraightOver(
  const SurfacePatch& patch, const SurfacePatch::Triangle& triangle, const Vec3& point);

/// Whether a point `distance` (m) over the plane of a triangle that it projects inside got there
/// through this triangle. Where the ground ends in walls, that is so for a point in the ground that
/// has no shorter way out through one of them, or, of a wall, through the slope. Of an obstacle it
/// is where the middle of the rock came `from` outside (m): before a thin one it is behind the far
/// side, too. Anywhere else it is taken to be.
bool cameThrough(
  const Vec3& from, const SurfacePatch& patch, int triangle, const Vec3& point, double distance);
/// The same of an edge of the rock `distance` (m) over a ridge that it crosses: an upright one,
/// between walls, has it beside it unless a face of the rock is over the top, or less deep under
/// it.
bool cameAcross(const PlacedBlock& rock, const SurfacePatch& patch, int ridge, double distance);

/// Contacts of a vertex with a CFE and of a face with a node, `distance` (m) apart, whether they may
/// be or not.
Contact vertexFaceAt(
  const PlacedBlock& rock, int vertex, const SurfacePatch& patch, int triangle, double distance);
Contact faceVertexAt(
  const PlacedBlock& rock, int face, const SurfacePatch& patch, int node, double distance);

/// Entrance of a rock vertex into a CFE, if the pair is valid or becomes so within `turn` (rad) of
/// the rock; `from` as for projectsInside.
std::optional<Contact> vertexFace(const PlacedBlock& rock, int vertex, const SurfacePatch& patch,
  int triangle, double reach, int from = -1, double turn = 0.0);

/// Entrance of a peak of the slope into a face of the rock.
std::optional<Contact> faceVertex(
  const PlacedBlock& rock, int face, const SurfacePatch& patch, int node, double reach);

/// How a rock came to where it is looked at.
struct CameFrom
{
  Vec3 position;    ///< Of its middle before, m.
  double way = 0.0; ///< That any of its points may have gone since, m.
};

/// How far all of an edge is over one side of a ridge, if it is beyond reach of it, as most
/// candidates are, m; else 0.
double overSide(
  const PlacedBlock& rock, int edge, const SurfacePatch& patch, int ridge, double reach);

/// Entrance of an edge of the rock on a ridge, if the middle of the rock came from outside of both.
std::optional<Contact> edgeEdge(const PlacedBlock& rock, int edge, const SurfacePatch& patch,
  int ridge, double reach, const CameFrom& from);
/// The same of a rock that stands where it is.
std::optional<Contact> edgeEdge(
  const PlacedBlock& rock, int edge, const SurfacePatch& patch, int ridge, double reach);

/// Whether a direction out of the slope lies in the normal cones of both features of a pair, with a
/// slack (sine): the pair is then a face of the Minkowski difference of rock and slope.
bool inVertexCone(const PlacedBlock& rock, int vertex, const Vec3& normal, double slack);
bool inPeakCone(const SurfacePatch& patch, int node, const Vec3& normal, double slack);
bool inEdgeCones(const PlacedBlock& rock, int edge, const SurfacePatch& patch, int ridge,
  const Vec3& normal, double slack);

/// Puts the ridge's line into an edge–edge contact, for the step solver.
void setRidge(const SurfacePatch& patch, int ridge, Contact& contact);

/// The way from the segment q + t w to the segment p + s u where they are nearest, s and t from 0 to 1
/// (m).
Vec3 betweenSegments(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& w);

/// Closest points of two lines p + s u, q + t w; false if they are nearly parallel (sine < 1e-4).
bool closestOnLines(
  const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& w, double& s, double& t);

/// Whether a world point over or under a face of the rock projects inside its polygon.
bool insideRockFace(const PlacedBlock& rock, int face, const Vec3& world, double tolerance);

} // namespace rockfall
