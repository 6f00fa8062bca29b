#pragma once

/// @file
/// Structures on the slope, as a map has them: embankments, trees and barriers.
/// Places in the local frame of the terrain, m.

#include "base/types.h"
#include "terrain/material.h"

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

/// A stem: an upright prism.
struct Tree
{
  std::int64_t feature = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double diameter = 0.3; ///< Of the stem, m, > 0.
  double height = 20.0;  ///< Over the ground under its axis, m, > 0.
  /// A rock that touches it with more kinetic energy breaks it and loses this much, J, ≥ 0.
  double capacity = std::numeric_limits<double>::infinity();
  int material = 0;
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
  bool absorbs = true;  ///< Takes its capacity from a rock that breaks it.
  bool records = false; ///< Lets all pass and only notes it.
};

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
