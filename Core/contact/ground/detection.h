#pragma once

/// @file
/// Entrances: which pairs become contacts, and which overlap without one (METHOD 3, 10).

#include "contact/Contact.h"
#include "contact/ground/candidates.h"
#include "contact/ground/features.h"

#include <vector>

namespace rockfall
{

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

/// The net under the entrance rules: every candidate vertex of the rock that is under the slope by
/// more than `allowed` (m), and every peak as deep inside the rock, gets a contact that carries no
/// force at the overlap it is found with and resists any further one, unless it has a contact
/// already. `from`: where the middle of the rock was when the step began, as it may have gone through
/// an obstacle within it; if it has gone a way, edges that came across a ridge on it get one, too.
void guardPenetration(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double allowed, const CameFrom& from,
  std::vector<Contact>& contacts);

/// Whether any of them is that deep.
bool overlaps(const PlacedBlock& rock, const SurfacePatch& patch, const CandidatePairs& candidates,
  double allowed, const CameFrom& from);

/// Whether a vertex, peak or edge of the candidates is that deep in what none of the contacts holds,
/// edges deeper than any of these by so much: a step has gone past where they would have met.
bool passed(const PlacedBlock& rock, const SurfacePatch& patch, const CandidatePairs& candidates,
  double allowed, const CameFrom& from, std::vector<Contact>& contacts);

/// Adds an entrance unless the contacts that are already there stand for it.
void admit(const SurfacePatch& patch, const Contact& candidate, std::vector<Contact>& contacts);

/// Deepest penetration of the rock's vertices under the slope of the patch and of its peaks into
/// the rock, m, ≥ 0. Edges that cross and obstacles are not looked at.
double penetration(const PlacedBlock& rock, const SurfacePatch& patch);

} // namespace rockfall
