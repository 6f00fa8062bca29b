#include "block/Block.h"

#include "base/errors.h"
#include "base/text/numberText.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace rockfall
{

// T is linear in X, T = T₀ + Σ Xₖ Tₖ, and first moments vanish about the centroid:
// ∫ Tᵀ T dV = V T₀ᵀ T₀ + Σₖₗ (∫ Xₖ Xₗ dV) Tₖᵀ Tₗ.
Mat12 integrateMass(double density, double volume, const Mat3& second)
{
  using Mat3x12 = Eigen::Matrix<double, 3, 12>;
  const auto matrixT = [](const Vec3& x)
  {
    Mat3x12 t;
    for (int axis = 0; axis < 3; ++axis)
    {
      t.row(axis) = displacementRow(Vec3::Unit(axis), x, x).transpose();
    }
    return t;
  };
  const Mat3x12 constant = matrixT(Vec3::Zero());
  std::array<Mat3x12, 3> linear;
  for (int k = 0; k < 3; ++k)
  {
    linear[k] = matrixT(Vec3::Unit(k)) - constant;
  }
  Mat12 integral = volume * constant.transpose() * constant;
  for (int k = 0; k < 3; ++k)
  {
    for (int l = 0; l < 3; ++l)
    {
      integral += second(k, l) * linear[k].transpose() * linear[l];
    }
  }
  return density * integral;
}

Mat6 isotropicElasticity(double youngModulus, double poissonRatio)
{
  const double factor = youngModulus / ((1.0 + poissonRatio) * (1.0 - 2.0 * poissonRatio));
  Mat6 e = Mat6::Zero();
  e.topLeftCorner<3, 3>().setConstant(factor * poissonRatio);
  e.diagonal().head<3>().setConstant(factor * (1.0 - poissonRatio));
  e.diagonal().tail<3>().setConstant(0.5 * youngModulus / (1.0 + poissonRatio));
  return e;
}

namespace
{

/// Share of its radius by which a block's centroid may be off the origin: what single precision
/// leaves.
constexpr double kCentred = 1e-6;

bool isZero(const Vec6& v)
{
  return v.cwiseAbs().sum() == 0.0;
}

Vec12 bodyVelocity(const BlockState& state)
{
  Vec12 v;
  v << state.orientation.conjugate() * state.velocity, state.spin, state.strainRate;
  return v;
}

} // namespace

Block::Block(Polyhedron shape, double density, double youngModulus, double poissonRatio)
  : shape_(std::move(shape))
  , radius_(shape_.radius())
  , volume_(shape_.integrals().volume)
  , youngModulus_(youngModulus)
  , poissonRatio_(poissonRatio)
  , density_(density)
{
  const VolumeIntegrals& integrals = shape_.integrals();
  const Vec3& centroid = integrals.centroid;
  if (!(centroid.norm() <= kCentred * shape_.radius()))
  {
    throw GeometryError("block: the centroid of its shape is at (" + numberText(centroid.x()) +
      ", " + numberText(centroid.y()) + ", " + numberText(centroid.z()) +
      ") m, but must be at the origin");
  }
  mass_ = density * integrals.volume;
  massMatrix_ = integrateMass(density, integrals.volume, integrals.second);
  elasticity_ = integrals.volume * isotropicElasticity(youngModulus, poissonRatio);
  inertia_ = density * (integrals.second.trace() * Mat3::Identity() - integrals.second);
  inverseInertia_ = inertia_.inverse();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(inertia_);
  const Vec3 principal = axes.eigenvalues();
  principal_ = principal;
  axes_ = axes.eigenvectors();
  if (axes_.determinant() < 0.0)
  {
    axes_.col(1) *= -1.0;
  }
  if (!(principal[0] > 0.0))
  {
    throw GeometryError("a block has the principal moment of inertia " + numberText(principal[0]) +
      " kg m², it must be positive");
  }
  const Mat6 strainMass = massMatrix_.block<6, 6>(kStrain, kStrain);
  strainFrequency_ = std::sqrt(
    Eigen::GeneralizedSelfAdjointEigenSolver<Mat6>(elasticity_, strainMass).eigenvalues()[0]);
  thickness_ = 2.0 * shape_.radius();
  for (std::size_t f = 0; f < shape_.normals().size(); ++f)
  {
    double deepest = 0.0;
    for (const Vec3& x : shape_.vertices())
    {
      deepest = std::max(deepest, shape_.offsets()[f] - shape_.normals()[f].dot(x));
    }
    thickness_ = std::min(thickness_, deepest);
  }
  isotropic_ = principal[2] - principal[0] < 1e-9 * principal[2];
  largestMobility_ = 0.0;
  for (const Vec3& x : shape_.vertices())
  {
    // δ = n/m + I⁻¹(x × f) × x for f = n: the mobility is I/m − [x] I⁻¹ [x].
    Mat3 cross;
    cross << 0.0, -x.z(), x.y(), x.z(), 0.0, -x.x(), -x.y(), x.x(), 0.0;
    const Mat3 turning = cross.transpose() * inverseInertia_ * cross;
    const double largest = Eigen::SelfAdjointEigenSolver<Mat3>(turning).eigenvalues()[2];
    largestMobility_ = std::max(largestMobility_, 1.0 / mass_ + largest);
    for (int k = 0; k < 3; ++k)
    {
      reach_[k] = std::max(reach_[k], axes.eigenvectors().col(k).cross(x).norm());
    }
  }
}

Vec3 Block::largestSpin(const Vec3& spin) const
{
  const Vec3 momentum = inertia_ * spin;
  const double l2 = momentum.squaredNorm(), twice = spin.dot(momentum);
  const Vec3 inverse = principal_.cwiseInverse(); // falling
  // Lᵢ² ≤ excess / difference, by elimination of the largest or the smallest moment.
  const double overLargest = std::max(0.0, twice - l2 * inverse[2]) + 1e-12 * twice;
  const double underSmallest = std::max(0.0, l2 * inverse[0] - twice) + 1e-12 * l2 * inverse[0];
  const auto least = [&](double excess, double difference)
  { return excess < l2 * difference ? excess / difference : l2; };
  const double l0 = least(overLargest, inverse[0] - inverse[2]);
  const double l1 = std::min(
    least(overLargest, inverse[1] - inverse[2]), least(underSmallest, inverse[0] - inverse[1]));
  const double l3 = least(underSmallest, inverse[0] - inverse[2]);
  return Vec3(std::sqrt(l0), std::sqrt(l1), std::sqrt(l3)).cwiseProduct(inverse);
}

double Block::largestRimSpeed(const Vec3& spin) const
{
  if (isotropic_)
  {
    return spin.norm() * radius_;
  }
  const Vec3 bound = this->largestSpin(spin);
  return std::min(bound.dot(reach_), bound.norm() * radius_);
}

Mat3 strainTensor(const Vec6& e)
{
  Mat3 t;
  t << e[0], 0.5 * e[5], 0.5 * e[4], //
    0.5 * e[5], e[1], 0.5 * e[3],    //
    0.5 * e[4], 0.5 * e[3], e[2];
  return t;
}

double rigidKineticEnergy(const Block& block, const BlockState& state)
{
  return 0.5 * block.mass() * state.velocity.squaredNorm() +
    0.5 * state.spin.dot(block.inertia() * state.spin);
}

double kineticEnergy(const Block& block, const BlockState& state)
{
  if (isZero(state.strain) && isZero(state.strainRate))
  {
    return rigidKineticEnergy(block, state);
  }
  const Vec12 v = bodyVelocity(state);
  return 0.5 * v.dot(block.massMatrix() * v);
}

double strainEnergy(const Block& block, const BlockState& state)
{
  return isZero(state.strain) ? 0.0 : 0.5 * state.strain.dot(block.elasticity() * state.strain);
}

double relaxStrain(const Block& block, BlockState& state)
{
  const double before = kineticEnergy(block, state) + strainEnergy(block, state);
  const Vec12 p = block.massMatrix() * bodyVelocity(state);
  state.spin = block.inverseInertia() * Vec3(p.segment<3>(kRotation));
  state.strain.setZero();
  state.strainRate.setZero();
  return before - rigidKineticEnergy(block, state);
}

} // namespace rockfall
