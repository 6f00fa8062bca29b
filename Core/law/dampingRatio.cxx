#include "law/springs.h"

namespace rockfall
{

namespace
{

constexpr double kMost = 8.0;      ///< ζ of kLeastRestitution is less.
constexpr int kHalvings = 50;      ///< Of 0 … kMost.
constexpr int kByNewton = 43;      ///< Halvings that an approximate root stands for.
constexpr double kCritical = 0.02; ///< ζ so near to 1 loses digits: halved all the way.

/// −ln e.
double exponent(double z)
{
  if (std::abs(z - 1.0) < 1e-6)
  {
    return 2.0;
  }
  return z < 1.0 ? 2.0 * z * std::acos(z) / std::sqrt(1.0 - z * z)
                 : 2.0 * z * std::acosh(z) / std::sqrt(z * z - 1.0);
}

bool isCritical(double z)
{
  return !(std::abs(z - 1.0) > kCritical);
}

/// ζ to some 12 digits, or something critical.
double approximate(double wanted)
{
  constexpr double a = 1.0 / std::numbers::pi, b = 2.0 * a * a * a, c = 0.0131;
  constexpr int steps = 6;
  constexpr double last = 1e-8; // a step that leaves its square as error
  double z = wanted < 2.0 ? wanted * (a + wanted * (b + c * wanted)) : 0.5 * std::exp(0.5 * wanted);
  for (int k = 0; k < steps && !isCritical(z); ++k)
  {
    const double e = exponent(z);
    const double step = (e - wanted) * (1.0 - z * z) / (e / z - 2.0 * z);
    z -= step;
    if (std::abs(step) < last * z)
    {
      break;
    }
  }
  return z;
}

} // namespace

double dampingRatio(double restitution)
{
  if (restitution >= 1.0)
  {
    return 0.0;
  }
  const double wanted = -std::log(std::max(restitution, kLeastRestitution));
  double low = 0.0, high = kMost;
  int done = 0;
  // The result is that of halving, to the last bit, which runs are compared by. Where Newton's root
  // lies between two neighbours of a halving, all coarser ones would have led there.
  if (const double z = approximate(wanted); !isCritical(z))
  {
    const double width = std::ldexp(kMost, -kByNewton);
    const double begin = std::floor(z / width) * width;
    if (exponent(begin) < wanted && exponent(begin + width) >= wanted)
    {
      low = begin;
      high = begin + width;
      done = kByNewton;
    }
  }
  for (int k = done; k < kHalvings; ++k)
  {
    const double middle = 0.5 * (low + high);
    (exponent(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace rockfall
