#pragma once

/// @file
/// The 3D DDA block with its 12 first-order displacement variables (METHOD 1; Shi 2001).
///
/// Every matrix here is written in body axes about the centroid, where inertia and elasticity are
/// constant: the block turns exactly, and strain and stress turn with it, so that no volume is made
/// by rotation (METHOD 10.3).

#include "base/types.h"
#include "geometry/Polyhedron.h"

namespace rockfall
{

/// Order of the unknowns: D = (u, v, w, rx, ry, rz, εx, εy, εz, γyz, γzx, γxy).
constexpr int kRotation = 3;
constexpr int kStrain = 6;

/// Two directions side by side, coordinate by coordinate.
using TwoDirections = std::array<Eigen::Array2d, 3>;

inline TwoDirections twoDirections(const Vec3& first, const Vec3& second)
{
  return { Eigen::Array2d(first.x(), second.x()), Eigen::Array2d(first.y(), second.y()),
    Eigen::Array2d(first.z(), second.z()) };
}

/// Part of a block that never changes.
class Block
{
public:
  Block() = default;
  /// `shape` has its centroid at the origin (GeometryError); density kg/m³, Young's modulus Pa,
  /// Poisson's ratio.
  Block(Polyhedron shape, double density, double youngModulus, double poissonRatio);

  const Polyhedron& shape() const { return shape_; }
  double mass() const { return mass_; }       ///< kg
  double volume() const { return volume_; }   ///< m³
  double density() const { return density_; } ///< kg/m³
  double radius() const { return radius_; }   ///< Of the bounding sphere about the centroid, m.
  /// M = ρ ∫ Tᵀ T dV, 12 × 12, body axes.
  const Mat12& massMatrix() const { return massMatrix_; }
  /// V E, 6 × 6: strain energy ½ εᵀ (V E) ε with engineering shear strains, J.
  const Mat6& elasticity() const { return elasticity_; }
  const Mat3& inertia() const { return inertia_; }               ///< kg m², body axes.
  const Mat3& inverseInertia() const { return inverseInertia_; } ///< 1/(kg m²)
  /// Principal moments of inertia, rising, kg m².
  const Vec3& principalMoments() const { return principal_; }
  /// Principal axes as columns, right-handed: from principal to body axes.
  const Mat3& principalAxes() const { return axes_; }
  /// All three principal moments equal (to 1e-9): free rotation is then steady.
  bool isotropic() const { return isotropic_; }
  /// Largest 1/(effective mass) that a contact at a vertex can see, 1/kg.
  double largestMobility() const { return largestMobility_; }
  /// 1/(effective mass) of the rigid block along `n` at the point x about the centroid, 1/kg.
  double mobility(const Vec3& n, const Vec3& x) const
  {
    const Vec3 moment = x.cross(n);
    return 1.0 / mass_ + moment.dot(inverseInertia_ * moment);
  }
  /// How far a unit force along `n` at the material point x moves that point by the block's uniform
  /// strain alone, at rest: J (V E)⁻¹ Jᵀ with the strain part J of nᵀT, m/N.
  double compliance(const Vec3& n, const Vec3& x) const
  {
    const double along = n.dot(x);
    return ((1.0 + poissonRatio_) * 0.5 * (x.squaredNorm() + along * along) -
             poissonRatio_ * along * along) /
      (youngModulus_ * volume_);
  }
  // The same for two directions at once.
  Eigen::Array2d mobility(const TwoDirections& n, const Vec3& x) const
  {
    const TwoDirections m = { x.y() * n[2] - x.z() * n[1], x.z() * n[0] - x.x() * n[2],
      x.x() * n[1] - x.y() * n[0] };
    const Mat3& j = inverseInertia_;
    const Eigen::Array2d turned[3] = { j(0, 0) * m[0] + j(0, 1) * m[1] + j(0, 2) * m[2],
      j(1, 0) * m[0] + j(1, 1) * m[1] + j(1, 2) * m[2],
      j(2, 0) * m[0] + (j(2, 1) * m[1] + j(2, 2) * m[2]) };
    return 1.0 / mass_ + (m[0] * turned[0] + m[1] * turned[1] + m[2] * turned[2]);
  }
  Eigen::Array2d compliance(const TwoDirections& n, const Vec3& x) const
  {
    const Eigen::Array2d along = n[0] * x.x() + n[1] * x.y() + n[2] * x.z();
    return ((1.0 + poissonRatio_) * 0.5 * (x.squaredNorm() + along * along) -
             poissonRatio_ * along * along) /
      (youngModulus_ * this->volume());
  }
  /// Largest mobility, at the vertex that is farthest out and along its radius, m/N.
  double largestCompliance() const { return radius_ * radius_ / (youngModulus_ * volume_); }
  /// Lowest angular frequency of the uniform strains of the free block, rad/s.
  double strainFrequency() const { return strainFrequency_; }
  /// The least distance between a face and the parallel plane that the block ends at, m.
  double thickness() const { return thickness_; }
  /// Bounds of |ωᵢ| about the principal axes, for ever in free rotation from `spin` (body axes),
  /// rad/s: L² = Σ Lᵢ² and 2T = Σ Lᵢ² / Iᵢ are kept, and what the other two axes hold is not
  /// negative.
  Vec3 largestSpin(const Vec3& spin) const;
  /// No point of the block ever moves faster about the centroid than this in free rotation, m/s.
  double largestRimSpeed(const Vec3& spin) const;

private:
  // Members that every step asks for lie together.
  Polyhedron shape_;
  double radius_ = 0.0; ///< The shape's, m.
  double volume_ = 0.0; ///< The shape's, m³.
  double mass_ = 0.0;
  double largestMobility_ = 0.0;
  double youngModulus_ = 0.0; ///< Pa
  double poissonRatio_ = 0.0;
  Mat3 inverseInertia_ = Mat3::Zero();
  Mat3 inertia_ = Mat3::Zero();
  bool isotropic_ = true;
  Vec3 principal_ = Vec3::Ones(); ///< Principal moments, kg m².
  Vec3 reach_ = Vec3::Zero();     ///< Largest distance of a vertex from each principal axis, m.
  Mat3 axes_ = Mat3::Identity();  ///< Principal axes.
  double density_ = 0.0;
  double strainFrequency_ = 0.0;
  double thickness_ = 0.0;
  Mat12 massMatrix_ = Mat12::Zero();
  Mat6 elasticity_ = Mat6::Zero();
};

/// Motion of a block. Translation in world axes, strain in body axes.
struct BlockState
{
  double time = 0.0;                   ///< s
  Vec3 position = Vec3::Zero();        ///< Centroid, m.
  Quat orientation = Quat::Identity(); ///< Body to world.
  Vec3 velocity = Vec3::Zero();        ///< m/s
  Vec3 spin = Vec3::Zero();            ///< Angular velocity in body axes, rad/s.
  Vec6 strain = Vec6::Zero();          ///< εx εy εz γyz γzx γxy
  Vec6 strainRate = Vec6::Zero();      ///< 1/s

  Vec3 angularVelocity() const { return orientation * spin; } ///< World axes, rad/s.
};

/// The symmetric tensor of a strain vector with engineering shears.
Mat3 strainTensor(const Vec6& strain);

/// The strain part of nᵀT.
inline Vec6 strainRow(const Vec3& n, const Vec3& x)
{
  Vec6 row;
  row << n.x() * x.x(), n.y() * x.y(), n.z() * x.z(), 0.5 * (n.y() * x.z() + n.z() * x.y()),
    0.5 * (n.z() * x.x() + n.x() * x.z()), 0.5 * (n.x() * x.y() + n.y() * x.x());
  return row;
}

/// The row nᵀT of METHOD 1 for a direction n: J·D = n · (displacement). The lever of the rotation
/// may differ from that of the strain (see the step solver). All in body axes.
inline Vec12 displacementRow(const Vec3& n, const Vec3& rotationLever, const Vec3& x)
{
  Vec12 row;
  row.head<3>() = n;
  row.segment<3>(kRotation) = rotationLever.cross(n);
  row.segment<6>(kStrain) = strainRow(n, x);
  return row;
}

/// M = ρ ∫ Tᵀ T dV of a body with these integrals (density kg/m³, volume m³, second moments about
/// the centroid m⁵), 12 × 12.
Mat12 integrateMass(double density, double volume, const Mat3& second);
/// Isotropic elasticity with engineering shear strains, Pa, 6 × 6.
Mat6 isotropicElasticity(double youngModulus, double poissonRatio);

/// Kinetic energy of translation and rotation, J.
double rigidKineticEnergy(const Block& block, const BlockState& state);
/// Kinetic energy of all 12 variables, J.
double kineticEnergy(const Block& block, const BlockState& state);
/// Elastic energy of the block, J.
double strainEnergy(const Block& block, const BlockState& state);

/// Drops strain and strain rate, keeping momentum and angular momentum: what a block does when it
/// takes off, its vibration dying out long before the next impact. Returns the energy dropped, J.
double relaxStrain(const Block& block, BlockState& state);

} // namespace rockfall
