#pragma once

/// @file
/// Rolling resistance of a rock on the slope (Azzoni, La Barbera & Zaninetti 1995; the rolling
/// friction cone of contact mechanics): |M_r| ≤ μ_r R λ against the rotation; what holds while the
/// rotation is zero.

#include "block/Block.h"
#include "contact/Contact.h"

#include <vector>

namespace rockfall
{

/// R, m: the radius of the sphere of equal volume, by how round the block is (its inscribed radius
/// over its circumscribed one). What is not round sets down faces instead, which takes a part of
/// its own.
double rollingArm(const Block& block);

/// Place where the slope carries a rock, and how: of a step by forces, of an impact that is an event by
/// impulses.
struct Support
{
  double force = 0.0;         ///< Normal, N (N s).
  double sliding = 0.0;       ///< The part of it that slides, N (N s).
  Vec3 moment = Vec3::Zero(); ///< Sum of places by their forces, N m (N m s).

  void add(double part, bool slides, const Vec3& at);
  Vec3 point() const { return this->moment / this->force; } ///< m
};

/// Support by the mean forces of a step.
Support supportOf(const std::vector<Contact>& contacts);

/// Takes the moment's impulse of a step of `h` (s) from the motion and returns the energy that it
/// took, J, ≥ 0. `coefficient`: μ_r. With impulses for forces h is 1.
///
/// A rock that sticks turns about where the slope carries it, so that speed goes with the spin; one
/// that slides loses spin alone. The rotation is never reversed.
double resistRolling(
  const Block& block, const Support& support, double coefficient, double h, BlockState& state);

} // namespace rockfall
