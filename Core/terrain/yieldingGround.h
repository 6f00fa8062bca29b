#pragma once

/// @file
/// Ground that gives way under a rock: scars, slip-dependent friction, rolling resistance.
///
/// Scars: Lu, Caviezel, Christen, Bühler & Bartelt (2019), Landslides 16, 2353,
/// doi:10.1007/s10346-019-01238-z. A soft layer Σ lies over a hard surface Λ, which is as deep
/// under the surface as this rock's speed makes it:
///
///     d_max = f · M^(1/3) · M_E^(−0.4) · w^0.8 · (r₀/r)^(1/3)
///     F_d   = ½ C_d ρ A v²,  C_d = 1 + C_s            against v, at the centroid
///
/// (their eq. 11; M in kg, M_E in kN/m²). The last factor is 1 where r₀ is 0: scars of all sizes are
/// alike. With it small rocks dig deeper for their size, as grains of soil bear what lies over them:
/// d ~ (2 r)^(2/3) H^(1/3) of spheres dropped by H into grains (Uehara, Ambroso, Ojha & Durian 2003,
/// Physical Review Letters 90, 194301). r is the radius of the sphere of equal volume.
///
/// A is the area of the part of the rock inside Σ, seen along v. With the direction held,
/// E/E₀ = exp(−C_d ρ V/m) after the volume V = ∫ A ds has been swept, whatever the speed. The same
/// volume takes spin: E_rot/E_rot,0 = exp(−C_ω ρ V/m).
///
/// Friction: Leine, Schweizer, Christen, Glover, Bartelt & Gerber (2014), Multibody System Dynamics
/// 32, 241, doi:10.1007/s11044-013-9393-4. μ(s) = μ_min + (2/π)(μ_max − μ_min) arctan(κ s), with
/// ds/dt = |v| while the rock touches and −β s while it does not.
///
/// Rolling resistance: |M_r| ≤ μ_r R λ against the rotation, λ the normal force (Azzoni, La Barbera
/// & Zaninetti 1995). R is the radius of the sphere of equal volume, times inscribed over
/// circumscribed radius: the less round a rock, the more setting down its faces takes already.
///
/// Softness S = exp(σ F) of a place: F a field over the map, drawn per iteration, with mean 0,
/// variance 1 and the correlation exp(−(r/ℓ)²) (RoughField). Soft ground gives deeper scars and
/// more friction: M_E / S, μ(s) S. Rolling resistance is the same everywhere, so that rocks stop.

#include <limits>
#include <span>

namespace rockfall
{

/// The parameters of a kind of ground. As by default it is hard: nothing of this acts.
struct YieldingGround
{
  static constexpr double hard = std::numeric_limits<double>::infinity();

  double modulus = hard;          ///< M_E, Pa, > 0; infinite: no scars.
  double depthFactor = 0.1;       ///< f of eq. 11, in the units of the print, ≥ 0.
  double density = 1700.0;        ///< ρ of the layer, kg/m³, ≥ 0.
  double compaction = 0.0;        ///< C_s, dimensionless, ≥ 0.
  double spinDrag = 0.0;          ///< C_ω, dimensionless, ≥ 0.
  double frictionLeast = 0.0;     ///< μ_min, dimensionless, ≥ 0.
  double frictionMost = 0.0;      ///< μ_max, ≥ μ_min; 0: the friction angle instead.
  double frictionGrowth = 0.0;    ///< κ, 1/m, ≥ 0.
  double frictionDecay = 0.0;     ///< β, 1/s, ≥ 0.
  double rollingResistance = 0.0; ///< μ_r, dimensionless, ≥ 0.
  double deviation = 0.0;         ///< σ of ln S, dimensionless, ≥ 0.
  double deviationLength = 30.0;  ///< ℓ of S, m, > 0 where S deviates.
  double scarRadius = 0.0;        ///< r₀, m, ≥ 0; 0: scars of all sizes are alike.

  bool scars() const { return this->modulus < hard; }
  bool slips() const { return this->frictionMost > 0.0; }
  bool deviates() const { return (this->scars() || this->slips()) && this->deviation > 0.0; }
  /// Whether the ground changes while an impact lasts, which is no event then.
  bool givesWay() const { return this->scars() || this->slips(); }
  bool yields() const { return this->givesWay() || this->rollingResistance > 0.0; }
  /// d_max, m, for a rock of this mass (kg) and volume (m³) whose surface comes down on the ground at
  /// `speed` (m/s).
  double scarDepth(double mass, double volume, double speed, double softness = 1.0) const;
  /// μ after a slip of `s` (m), where S is 1.
  double frictionAfter(double s) const;
  /// Share of the speed, and of the spin, that a volume (m³) swept by a mass (kg) leaves.
  double speedLeft(double volume, double mass) const;
  double spinLeft(double volume, double mass) const;
  /// Share of the speed that goes with a volume (m³) that is small.
  double speedLost(double volume, double mass) const;

  void validate() const; ///< Throws ParameterError naming field and value.

  bool operator==(const YieldingGround&) const = default;
};

/// A parameter of YieldingGround as people type it and files hold it.
struct YieldingField
{
  const char* property; ///< Name in panels and messages.
  const char* column;   ///< Name in tables, lower case.
  const char* unit;     ///< As typed.
  double YieldingGround::*member;
  double scale; ///< Typed unit in SI.
  /// 0 is typed for infinite.
  bool noneIsInfinite;

  double typed(const YieldingGround& ground) const;
  void set(YieldingGround& ground, double typed) const;
};

/// All of them, in the order of the struct, which is that of files.
std::span<const YieldingField> yieldingFields();

} // namespace rockfall
