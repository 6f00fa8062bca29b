#pragma once

/// @file
/// Torque-free rotation in closed form, by Jacobi's elliptic functions.
///
/// Euler's equations are solved by w₁ = w₁ₘ cn u, w₂ = w₂ₘ sn u, w₃ = w₃ₘ dn u with u = u₀ + p t
/// (R. van Zon and J. Schofield, J. Comput. Phys. 225 (2007) 145). Axis 3 is the principal axis
/// that the angular momentum L circles about in the body, axis 2 the intermediate one. The attitude
/// is what turns L, as the body sees it at t, into L, as it saw it at the start, times a turn about
/// L by the precession angle
///
///     ψ(t) = L [ t/I₁ + (I₃ − I₁)/(I₁ I₃ p) ∫ n sn² / (1 − n sn²) du ],
///
/// an elliptic integral of the third kind (they take theta functions). Where it departs from there:
/// - Differences such as L² − 2T I₃ and 1 − m are sums of like signs or have one subtraction only,
///   so that symmetric tops, nearly steady spins and the separatrix (m → 1) lose no digits.
/// - ψ is measured from the pole that L's path through the body is roundest about: axis 3 as above
///   or axis 1, for which 1 and 3 change places in the formula. Then |n| ≤ 3 for any body.

#include "block/Block.h"

#include <array>

namespace rockfall
{

/// All of a free rotation that one spin starts. Made once per flight, asked for any time.
class FreeRotation
{
public:
  /// From `spin` in body axes, rad/s.
  FreeRotation(const Block& block, const Vec3& spin);

  struct Attitude
  {
    Quat turn; ///< Body axes at the time asked for to body axes at the start, unit.
    Vec3 spin; ///< Body axes of that time, rad/s.
  };
  /// After `duration` (s, of either sign). Angular momentum and energy are kept to rounding, a few
  /// 1e-16 relative per call; errors of phase and precession are 1e-16 of the angle turned, times
  /// what the motion itself amplifies near the intermediate axis.
  Attitude after(double duration) const;

  /// Parameter m = k² of the elliptic functions, 0 … 1; 0 for a steady spin.
  double parameter() const { return steady_ ? 0.0 : 1.0 - complement_; }
  /// Time in which the spin returns to itself in body axes, 4 K/|p|, s; 0 for a steady spin.
  double period() const;

private:
  double thirdKind(double s, double c) const;
  void jacobi(double u, double& s, double& c) const;
  void anglesOf(double s, double c, const Vec3& momentum, double& azimuth, double& polar) const;

  bool steady_ = true;
  Vec3 spin_ = Vec3::Zero(); ///< At the start, body axes, rad/s.
  /// A power of two near |spin|, 1/s: to divide by it rounds nothing. All below is for
  /// spin_/scale_.
  double scale_ = 1.0;
  Mat3 axes_ = Mat3::Identity();  ///< Columns: axes 1, 2, 3 in body axes.
  Vec3 moments_ = Vec3::Zero();   ///< I₁, I₂, I₃, kg m².
  Vec3 amplitude_ = Vec3::Zero(); ///< w₁ₘ, w₂ₘ, w₃ₘ
  double complement_ = 0.0;       ///< 1 − m
  double rate_ = 0.0;             ///< p
  double quarter_ = 0.0;          ///< K
  double u0_ = 0.0;  ///< Phase at the start, within ±K of an even or odd multiple of 2 K.
  bool odd_ = false; ///< The one of the two.
  int depth_ = 0;    ///< Of the arithmetic–geometric mean of 1 and √(1 − m).
  std::array<double, 20> mean_;
  std::array<double, 20> geometric_;
  // The pole about which ψ is measured.
  int pole_ = 2;                ///< 2: axis 3, 0: axis 1.
  double characteristic_ = 0.0; ///< n
  double base_ = 0.0;           ///< ψ̇ where sn = 0.
  double excess_ = 0.0;         ///< Factor of the integral.
  double integral0_ = 0.0;      ///< The integral from sn = 0 to the start.
  double fullIntegral_ = 0.0;   ///< And over 2 K.
  double roundness_ = 0.0;      ///< Of L's path about axis 3: L₂ₘ/L₁ₘ.
  double momentum_ = 0.0;       ///< |L|
  double azimuth0_ = 0.0;       ///< Of L about the pole, at the start.
  double polar0_ = 0.0;         ///< Angle of L from the pole, at the start.
};

} // namespace rockfall
