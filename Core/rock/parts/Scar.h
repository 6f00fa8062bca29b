#pragma once

/// @file
/// The scar that a rock makes in yielding ground (terrain/yieldingGround.h), from the first touch
/// until the rock is out of the ground again.
///
/// The hard surface Λ lies `depth` straight under the surface, for this rock and this scar alone:
/// the piece of the slope that the rock's contacts see is lowered by it, so that every kind of
/// contact meets Λ. When Λ moves:
/// - it sinks under a corner that comes down on it, to the depth of that corner's own speed, if
///   that is deeper (by a tenth, and by a hundredth of the radius);
/// - it rises with the rock while nothing touches it, no further than the rock is away from it, so
///   that no energy is made. A rock that tumbles climbs out of its scar so, and pays for every
///   corner that it sets down;
/// - it is the surface again when the rock is out of the ground.

#include "contact/Contact.h"
#include "contact/ground/submerged.h"
#include "terrain/yieldingGround.h"

#include <functional>

namespace rockfall
{

class Scar
{
public:
  bool open() const { return depth_ > 0.0; }
  double depth() const { return depth_; }     ///< Of Λ now, straight down, m.
  double deepest() const { return deepest_; } ///< Of Λ so far, m.
  double length() const { return length_; }   ///< Way along the surface so far, m.
  /// Whether the rock has been down on Λ, or on its way out.
  bool turned() const { return turned_; }
  const Vec3& normal() const { return surface_.normal; } ///< Of the ground under it.
  double area() const { return area_; }                  ///< Of the rock's part inside, m².
  /// The class of ground that it is in, as restitution classes count.
  int ground() const { return ground_; }

  /// Λ sinks to `depth` (m) under a contact; the surface is over Λ there.
  void sink(double depth, int ground, const Contact& contact);
  /// Λ rises by this, m; at the surface the scar is closed.
  void rise(double by);
  /// Where the rock is on Λ now; its plane follows the ground.
  void touch(const Contact& contact);
  /// Follows a step of contact to `rock`: returns the volume swept, m³, by the areas at its ends.
  double sweep(const Vec3& from, const PlacedBlock& rock);
  /// Follows a flight along `way` (m). `at`: the pose at a fraction of it, 0 … 1. Without rotation
  /// exact: between the places where a corner passes the surface the area is quadratic. With it by
  /// the areas at its ends, and quadratic from where the first corner dips in or to where the last
  /// one is out: such a flight must turn the rock by little (kTurnInSoil).
  using Poses = std::function<const PlacedBlock&(double)>;
  double sweep(const Vec3& way, const Poses& at, bool turns);
  void leave() { turned_ = true; }
  /// The rock is above the surface as a whole, as far as its plane tells.
  bool cleared() const { return lowest_ >= 0.0; }

private:
  double sweepStraight(const Vec3& way, const Poses& at);
  double sweepTurning(const Vec3& way, const PlacedBlock& rock); ///< `rock` as it is at the end.
  /// Books the volume (m³) of a way (m), and what of the rock is inside at its end.
  double book(double volume, const Vec3& way, const Submerged& end);

  double depth_ = 0.0, deepest_ = 0.0, length_ = 0.0;
  // At the end of the last motion.
  double area_ = 0.0;   ///< Of the part inside, m².
  double lowest_ = 0.0; ///< Height of the lowest corner over the surface, m.
  int ground_ = 0;
  bool turned_ = false;
  Plane surface_; ///< Under the rock.
};

} // namespace rockfall
