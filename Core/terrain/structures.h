#pragma once

/// @file
/// Structures on the slope, as a map has them: embankments, trees and barriers.
/// Places in the local frame of the terrain, m.

#include "base/types.h"
#include "terrain/material.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace rockfall
{

/// An embankment or a dam along a line: a flat crest between two planes that go down into the
/// ground, cut off upright at both ends. Between two of its points the crest is straight.
struct Embankment
{
  std::int64_t feature = 0; ///< Number in its layer, from 1.
  std::string name;         ///< For people.
  std::vector<Eigen::Vector2d> points;
  /// Of the crest over the ground under its axis, m, > 0; NaN: it has an elevation.
  double height = std::numeric_limits<double>::quiet_NaN();
  double elevation = std::numeric_limits<double>::quiet_NaN(); ///< Of the crest, m.
  double crestWidth = 1.0;                                     ///< m, > 0.
  /// Horizontal way per vertical, ≥ 0 (0: a wall), of the side where the ground is higher, and of
  /// the other one.
  double mountainSlope = 1.5;
  double valleySlope = 1.5;
  int material = 0; ///< 0: the slope's own; else Structures::materials[material − 1].
};

/// Longest stem, standing or lying, m.
inline constexpr double kLongestStem = 150.0;

/// A stem: an upright prism, or one that lies straight between two places.
struct Tree
{
  std::int64_t feature = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double diameter = 0.3; ///< Of the stem, m, > 0.
  double height = 20.0;  ///< Over the ground under its axis, m, > 0; of a lying one not used.
  /// A rock that touches it with more kinetic energy breaks it and loses this much, J, ≥ 0.
  double capacity = std::numeric_limits<double>::infinity();
  int material = 0;
  /// Other end of a lying stem; NaN: it stands.
  Eigen::Vector2d end = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

  bool lies() const { return !std::isnan(end.x()); }
};

/// A barrier or a net: an upright plane without thickness.
struct Barrier
{
  std::int64_t feature = 0;
  std::string name;
  std::vector<Eigen::Vector2d> points;
  double height = 0.0; ///< Over ground, m, > 0.
  /// Kinetic energy that it stops, J, ≥ 0; with more a rock breaks it and loses this much.
  double capacity = std::numeric_limits<double>::infinity();
  /// Share of a rock's height that may stand over the rope of a net that holds it, and of its width
  /// beside an end, 0 to 0.5. 0: the freeboard of guidelines, half a block between the highest path
  /// of centres and the rope (ONR 24810): kits are tested below it.
  double overhang = 0.0;
  /// Way behind the line on which a rock of its capacity comes to rest, m, ≥ 0; 0: not known.
  double braking = 0.0;
  /// Share of its height that is left once what it holds has used up its capacity, 0 to 1; NaN: it
  /// does not wear, and is as new for every rock.
  double residual = std::numeric_limits<double>::quiet_NaN();
  /// Volume of rock that fills it to the rope, m³ per m of its length, > 0; infinite: nothing does.
  double room = std::numeric_limits<double>::infinity();
  bool absorbs = true;  ///< Takes its capacity from a rock that breaks it.
  bool records = false; ///< Lets all pass and only notes it.
};

/// Energy (J) and volume (m³) of the rocks that a barrier has held.
struct BarrierLoad
{
  double energy = 0.0;
  double volume = 0.0;
};

/// A barrier as the next rock meets it.
struct BarrierState
{
  double capacity = 0.0; ///< J
  double rope = 0.0;     ///< Height of its upper rope over its foot, m.
  double fill = 0.0;     ///< Depth of what lies before it, m.
};

/// Whether what it holds changes a barrier for the next rock.
bool isLoaded(const Barrier& barrier);

/// A barrier that wears has lost the energy of what it held of its capacity, and of its height in
/// proportion. What it holds lies before it, spread along its length, and as deep in its height as
/// in its room.
BarrierState stateOf(const Barrier& barrier, const BarrierLoad& load);

/// How far behind its line a barrier stops a rock of this energy (J), m: its brakes pull out as a
/// spring does, up to `braking` at its capacity, and stay so if it wears.
double brakingDistance(const Barrier& barrier, const BarrierLoad& before, double energy);

struct Structures
{
  std::vector<Embankment> embankments;
  std::vector<Tree> trees;
  std::vector<Barrier> barriers;
  std::vector<SurfaceMaterial> materials;

  bool any() const { return !embankments.empty() || !trees.empty() || !barriers.empty(); }
};

/// The most energy (J) that a stem of this diameter (m) takes before it breaks: 38.7 d^2.31 with d
/// in cm, for a hit in its middle (Dorren & Berger 2006, Stem breakage of trees and energy
/// dissipation during rockfall impacts, Tree Physiology 26(1), 63–71), times a factor for the
/// species: the formula is silver fir's.
double stemCapacity(double diameter, double factor = 1.0);

} // namespace rockfall
