#pragma once

/// @file
/// Contact of a sphere or an ellipsoid with the slope, in closed form.
///
/// Seen in axes in which the body is the unit sphere (x = c + A s, A with its strain and attitude),
/// a triangle stays a triangle. Its place q nearest to the centre, on the face, on an edge or at a
/// node, is where they touch, and the plane that touches there tells them apart:
///
///     n ∝ −A⁻ᵀ s_q,   d = ρ (ρ − 1) / |A⁻ᵀ s_q|,   ρ = |s_q|
///
/// Of triangles that share the edge or the node the nearest one counts: so flat and concave edges
/// are not felt. A contact has no feature of the rock (Contact::rockFeature −1).

#include "contact/Contact.h"
#include "contact/ground/candidates.h"
#include "contact/ground/clearance.h"
#include "geometry/roundBody.h"

namespace rockfall
{

/// gatherCandidates, updateContacts, overlaps, timeToClose, clearance and penetration of a round
/// body.
void gatherRound(
  const PlacedBlock& rock, const SurfacePatch& patch, double distance, CandidatePairs& candidates);
void updateRound(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double reach, std::vector<Contact>& contacts);
/// Normals and points of contacts as they are in the middle of a step of h (s), which then meets the
/// curvature of the body, and that of edges and nodes, to the second order. The body stays where it is.
void turnToMiddle(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double h, std::vector<Contact>& contacts);
double roundTimeToClose(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  const CandidatePairs& candidates, double gravity, double horizon);
Clearance roundClearance(const PlacedBlock& rock, const BlockState& state,
  const SurfacePatch& patch, double gravity, double horizon, bool ofScar);
double roundPenetration(const PlacedBlock& rock, const SurfacePatch& patch);

/// How far a round body with the axes A about a centre may go straight down until it touches a
/// triangle, m; < 0: how far it has to go up; ∞: it misses it.
double roundDrop(const Mat3& axes, const Vec3& centre, const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace rockfall
