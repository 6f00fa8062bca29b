#pragma once

/// @file
/// Materials of the slope: one, or classes of restitution and of friction, each on a
/// layer of its own over the cells (METHOD 6).

#include "base/types.h"
#include "terrain/roughness.h"
#include "terrain/scatter.h"
#include "terrain/yieldingGround.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// Velocities that the slope's coefficient of restitution acts on after an impact (METHOD 4).
enum class RestitutionModel
{
  /// The paper's: (Vx, Vy, Vz) ← Rv (Vx, Vy, Vz), Rv = `restitution`.
  Velocity = 0,
  /// Rn = `restitution` on the normal velocity of the contact, Rt = `tangentialRestitution` on what
  /// friction left of the tangential one.
  NormalTangential = 1,
  /// The same with Rn(v) = Rn / (1 + (v/K)²), v the normal speed of approach, K =
  /// `restitutionSpeed`: hard impacts crush and lose more. Pfeiffer & Bowen (1989), Computer
  /// simulation of rockfalls, Bulletin of the Association of Engineering Geologists 26(1), 135–146;
  /// the model of the Colorado Rockfall Simulation Program (CRSP).
  SpeedDependent = 2,
};

/// Material of a CFE.
struct SurfaceMaterial
{
  double restitution = 0.8;          ///< Rv, or Rn, as the model has it; dimensionless, 0 … 1.
  double restitutionDeviation = 0.0; ///< Standard deviation of `restitution`, 0 … 1.
  RestitutionModel restitutionModel = RestitutionModel::Velocity;
  double tangentialRestitution = 1.0; ///< Rt, dimensionless, 0 … 1. Not used by Velocity.
  /// K, normal speed at which half of Rn is left, m/s, > 0: 30 ft/s. Used by SpeedDependent only.
  double restitutionSpeed = 9.144;
  double frictionAngle = radians(15.0); ///< φ, rad, 0° … 89°.
  double frictionAngleDeviation = 0.0;  ///< Standard deviation of φ, rad, 0° … 89°.
  double cohesion = 0.0;                ///< c, N per contact point, ≥ 0.
  /// For what its deviations are drawn; nothing: as those of the slope.
  std::optional<DeviationPer> deviationPer = {};
  YieldingGround yielding = {}; ///< Hard as by default. Goes with the restitution, by class.

  void validate() const; ///< Throws ParameterError naming field and value.
};

/// Classes of one kind, and which class each cell belongs to. One byte per cell, nothing where
/// there is no layer: 1e8 cells fit.
struct MaterialClasses
{
  /// Most classes of a layer; class 0 is the slope's own material.
  static constexpr int largest = 255;

  std::vector<std::string> names; ///< Of the classes 1, 2, …
  /// Of the classes 1, 2, …: a restitution layer has its say on restitution only, a joint layer on
  /// friction and cohesion only.
  std::vector<SurfaceMaterial> materials;
  /// Of the classes 1, 2, … of a restitution layer; empty: all are as rough as the slope.
  std::vector<Roughness> roughness;
  std::span<const std::uint8_t> cells; ///< Class per cell, in the order of the cells.
  std::shared_ptr<const void> owner;   ///< Keeps `cells` alive.

  int count() const { return int(materials.size()); }
  /// Throws DataError or ParameterError, saying which `kind` of classes it is about.
  void validate(std::int64_t cellCount, const char* kind) const;
  /// The class of a CFE.
  int at(std::int64_t cfe) const
  {
    return cells.empty() ? 0 : int(cells[std::size_t((cfe - 1) / 2)]);
  }
};

} // namespace rockfall
