#include "block/FreeRotation.h"

#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/math/special_functions/ellint_rj.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

/// Carlson's integrals in double throughout; arguments are valid by construction.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

/// Parts of the spin below this share of it are zero: their squares must not underflow.
constexpr double kNoSpin = 1e-140;
/// 1 − m of the separatrix itself: a state on it for 350 radians of phase.
constexpr double kSeparatrix = 1e-300;

} // namespace

FreeRotation::FreeRotation(const Block& block, const Vec3& spin)
  : spin_(spin)
{
  const double largest = spin.cwiseAbs().maxCoeff();
  scale_ = largest > 0.0 ? std::ldexp(1.0, std::ilogb(largest)) : 1.0;
  if (block.isotropic() || largest == 0.0)
  {
    return;
  }
  // a ≤ b ≤ c and w about their axes.
  const Vec3& abc = block.principalMoments();
  Vec3 w = block.principalAxes().transpose() * (spin / scale_);
  w = (w.array().abs() < kNoSpin).select(0.0, w);
  const Vec3 torque = w.cross(abc.cwiseProduct(w));
  steady_ = torque.isZero(0.0);
  if (steady_)
  {
    return;
  }
  // L² − 2T b > 0: L circles about c, else about a. On the separatrix the rounder side is taken,
  // which also is the one where a symmetric top has no zero in a denominator.
  const double ab = abc[1] - abc[0], bc = abc[2] - abc[1];
  const double difference = abc[2] * bc * w[2] * w[2] - abc[0] * ab * w[0] * w[0];
  const bool aboutLargest = difference > 0.0 || (difference == 0.0 && bc > ab);
  const Mat3& principal = block.principalAxes();
  if (aboutLargest)
  {
    axes_ = principal;
    moments_ = abc;
  }
  else
  {
    axes_ << principal.col(2), -principal.col(1), principal.col(0);
    moments_ = abc.reverse();
    w = Vec3(w[2], -w[1], w[0]);
  }
  if (w[2] < 0.0)
  {
    axes_.rightCols<2>() *= -1.0;
    w.tail<2>() *= -1.0;
  }
  const double i1 = moments_[0], i2 = moments_[1], i3 = moments_[2];
  const double d21 = std::abs(i2 - i1), d32 = std::abs(i3 - i2), d31 = std::abs(i3 - i1);
  const Vec3 w2 = w.cwiseAbs2();
  const double over1 = i2 * d21 * w2[1] + i3 * d31 * w2[2]; // |L² − 2T I₁|
  const double over3 = i1 * d31 * w2[0] + i2 * d32 * w2[1]; // |L² − 2T I₃|
  amplitude_ = { std::sqrt(over3 / (i1 * d31)), std::sqrt(over3 / (i2 * d32)),
    std::sqrt(over1 / (i3 * d31)) };
  rate_ = std::copysign(std::sqrt(over1 * d32 / (i1 * i2 * i3)), i3 - i2);
  complement_ = std::clamp(d31 * std::abs(difference) / (over1 * d32), kSeparatrix, 1.0);

  double mean = 1.0, geometric = std::sqrt(complement_);
  for (depth_ = 0; depth_ < int(mean_.size()) - 1; ++depth_)
  {
    mean_[depth_] = mean;
    geometric_[depth_] = geometric;
    if (std::abs(mean - geometric) <= 1e-8 * mean) // the next mean is exact
    {
      break;
    }
    const double next = 0.5 * (mean + geometric);
    geometric = std::sqrt(mean * geometric);
    mean = next;
  }
  const double last = 0.5 * (mean + geometric);
  quarter_ = 0.5 * std::numbers::pi / last;

  double c = w[0] / amplitude_[0], s = w[1] / amplitude_[1];
  const double length = std::hypot(c, s);
  odd_ = c < 0.0;
  c = std::abs(c) / length;
  s = (odd_ ? -s : s) / length;
  u0_ = s * boost::math::ellint_rf(c * c, c * c + complement_ * s * s, 1.0, InDouble());

  const Vec3 momentum = moments_.cwiseProduct(w);
  momentum_ = momentum.norm();
  roundness_ = std::sqrt(i2 * d31 / (i1 * d32));
  if (d32 >= d21)
  {
    pole_ = 2;
    characteristic_ = -(i3 * d21) / (i1 * d32);
    base_ = momentum_ / i1;
    excess_ = momentum_ * (i3 - i1) / (i1 * i3 * rate_);
  }
  else
  {
    pole_ = 0;
    characteristic_ = -(i1 * over3) / (i3 * over1);
    base_ = momentum_ / i3;
    excess_ = momentum_ * (i1 - i3) / (i1 * i3 * rate_);
  }
  integral0_ = this->thirdKind(s, c);
  fullIntegral_ = 2.0 * this->thirdKind(1.0, 0.0);
  this->anglesOf(odd_ ? -s : s, odd_ ? -c : c, momentum, azimuth0_, polar0_);
}

double FreeRotation::period() const
{
  return steady_ ? 0.0 : 4.0 * quarter_ / (std::abs(rate_) * scale_);
}

/// ∫ n sn²/(1 − n sn²) du = Π(n; φ | m) − F(φ | m) = n/3 sin³φ R_J(cos²φ, 1 − m sin²φ, 1, 1 − n
/// sin²φ) for |φ| ≤ π/2 (DLMF 19.25.14).
double FreeRotation::thirdKind(double s, double c) const
{
  if (s == 0.0 || characteristic_ == 0.0)
  {
    return 0.0;
  }
  const double s2 = s * s, c2 = c * c;
  return characteristic_ / 3.0 * s * s2 *
    boost::math::ellint_rj(c2, c2 + complement_ * s2, 1.0, 1.0 - characteristic_ * s2, InDouble());
}

/// sn and cn for |u| ≤ K by descending Landen transformations (Bulirsch, Numer. Math. 7 (1965) 78).
/// Boost's take the modulus k, in which 1 − m below 1e-16 is lost.
void FreeRotation::jacobi(double u, double& s, double& c) const
{
  if (std::abs(u) < 1e-9)
  {
    s = u;
    c = 1.0;
    return;
  }
  const double last = 0.5 * (mean_[depth_] + geometric_[depth_]);
  s = std::sin(last * u);
  c = std::cos(last * u);
  double a = c / s, dn = 1.0, cs = last * a;
  for (int k = depth_; k >= 0; --k)
  {
    const double b = mean_[k];
    a *= cs;
    cs *= dn;
    dn = (geometric_[k] + a) / (b + a);
    a = cs / b;
  }
  s = std::copysign(1.0 / std::sqrt(1.0 + cs * cs), s);
  c = cs * s;
}

void FreeRotation::anglesOf(
  double s, double c, const Vec3& momentum, double& azimuth, double& polar) const
{
  if (pole_ == 2)
  {
    // L₁ and L₂ may both vanish; their ratio does not.
    azimuth = std::atan2(roundness_ * s, c);
    polar = std::atan2(std::hypot(momentum[0], momentum[1]), momentum[2]);
  }
  else
  {
    azimuth = std::atan2(momentum[2], momentum[1]);
    polar = std::atan2(std::hypot(momentum[1], momentum[2]), momentum[0]);
  }
}

FreeRotation::Attitude FreeRotation::after(double duration) const
{
  if (steady_)
  {
    const Vec3 w = spin_ / scale_;
    const double speed = w.norm();
    if (speed == 0.0)
    {
      return { Quat::Identity(), spin_ };
    }
    return { Quat(Eigen::AngleAxisd(speed * (scale_ * duration), w / speed)), spin_ };
  }
  const double t = scale_ * duration;
  const double u = u0_ + rate_ * t;
  const double halves = std::round(u / (2.0 * quarter_));
  double s, c;
  this->jacobi(u - halves * 2.0 * quarter_, s, c);
  const double integral = halves * fullIntegral_ + this->thirdKind(s, c) - integral0_;
  const double precession = base_ * t + excess_ * integral;
  const double dn = std::sqrt(c * c + complement_ * s * s);
  if ((std::fmod(halves, 2.0) != 0.0) != odd_)
  {
    s = -s;
    c = -c;
  }
  const Vec3 w = amplitude_.cwiseProduct(Vec3(c, s, dn));
  double azimuth, polar;
  this->anglesOf(s, c, moments_.cwiseProduct(w), azimuth, polar);

  // Rz(χ₀) Ry(θ₀) Rz(ψ) Ry(−θ) Rz(−χ) with the pole as z, as a quaternion.
  const double less = 0.5 * (polar0_ - polar), more = 0.5 * (polar0_ + polar);
  const double cosine = std::cos(0.5 * precession), sine = std::sin(0.5 * precession);
  const double left = 0.5 * (azimuth0_ - azimuth), right = 0.5 * (azimuth0_ + azimuth);
  const double w0 = cosine * std::cos(less), z0 = sine * std::cos(more);
  const double x0 = sine * std::sin(more), y0 = cosine * std::sin(less);
  const double cl = std::cos(left), sl = std::sin(left);
  const double cr = std::cos(right), sr = std::sin(right);
  const Vec3 xyz(x0 * cr - y0 * sr, x0 * sr + y0 * cr, w0 * sl + z0 * cl);
  const Vec3 vector =
    axes_ * (pole_ == 2 ? xyz : Vec3(xyz[2], xyz[0], xyz[1])); // z, x, y are axes 1, 2, 3
  const Quat turn(w0 * cl - z0 * sl, vector[0], vector[1], vector[2]);
  return { turn.normalized(), scale_ * (axes_ * w) };
}

} // namespace rockfall
