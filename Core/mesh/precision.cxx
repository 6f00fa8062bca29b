#include "mesh/precision.h"

#include "base/errors.h"
#include "base/text/numberText.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Digits that streams and %g write unless they are told otherwise.
constexpr int kUsualDigits = 6;

/// Of words that tell single precision, which has 7 digits, from double.
constexpr int kLongDigits = 8;

/// Halves, quarters … are exact in either precision and say nothing.
bool isRound(double value)
{
  const double fine = value * 1024.0;
  return fine == std::floor(fine);
}

/// Least share of a body that a coordinate may be off by.
constexpr double kMostRounding = 1e-3;

} // namespace

void WrittenDigits::add(std::string_view word, double value)
{
  any_ = true;
  if (!std::isfinite(value))
  {
    return;
  }
  const std::size_t e = word.find_first_of("eE");
  const std::string_view mantissa = word.substr(0, e);
  int digits = 0, trailing = 0;
  bool decimals = false;
  for (const char c : mantissa)
  {
    decimals = decimals || c == '.';
    if (c >= '0' && c <= '9')
    {
      digits += digits > 0 || c != '0' ? 1 : 0;
      trailing = c == '0' ? trailing + 1 : 0;
    }
  }
  this->addLong(value, decimals ? digits - trailing : digits);
  digits_ = std::max(digits_, digits);
  largest_ = std::max(largest_, std::abs(value));
  if (e != std::string_view::npos)
  {
    exponentDigits_ = std::max(exponentDigits_, digits);
    exponentLargest_ = std::max(exponentLargest_, std::abs(value));
  }
  else if (decimals)
  {
    paddedDecimals_ = paddedDecimals_ || trailing > 0;
    sixWithDecimals_ = sixWithDecimals_ || digits == kUsualDigits;
  }
}

void WrittenDigits::addLong(double value, int digits)
{
  if (digits < kLongDigits || !(std::abs(value) < 1e38))
  {
    return;
  }
  const double half = 0.5 * std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits + 1);
  const bool single = std::abs(double(float(value)) - value) <= 1.01 * half;
  double_ = double_ || !single;
  single_ += single && !isRound(value) ? 1 : 0;
}

bool WrittenDigits::sixDigitsAtMost() const
{
  return digits_ <= kUsualDigits && sixWithDecimals_ && !paddedDecimals_;
}

double WrittenDigits::rounding() const
{
  const auto lastDigit = [](double value, int digits)
  { return value > 0.0 ? 0.5 * std::pow(10.0, std::floor(std::log10(value)) - digits + 1) : 0.0; };
  const double byExponent = lastDigit(exponentLargest_, std::max(exponentDigits_, kUsualDigits));
  const double bySix =
    this->sixDigitsAtMost() && largest_ >= 1e5 ? lastDigit(largest_, kUsualDigits) : 0.0;
  return std::max(byExponent, bySix);
}

std::string WrittenDigits::describe() const
{
  return "with " + std::to_string(std::max(exponentDigits_, kUsualDigits)) + " digits";
}

double singleRounding(double magnitude)
{
  return magnitude > 0.0 && std::isfinite(magnitude) ? std::ldexp(1.0, std::ilogb(magnitude) - 24)
                                                     : 0.0;
}

double largestCoordinate(std::span<const Vec3> points)
{
  double largest = 0.0;
  for (const Vec3& p : points)
  {
    for (int k = 0; k < 3; ++k)
    {
      largest = std::isfinite(p[k]) ? std::max(largest, std::abs(p[k])) : largest;
    }
  }
  return largest;
}

bool lookSingle(std::span<const Vec3> points)
{
  bool crooked = false;
  for (const Vec3& p : points)
  {
    for (int k = 0; k < 3; ++k)
    {
      if (!(std::abs(p[k]) < 1e38) || double(float(p[k])) != p[k])
      {
        return false;
      }
      crooked = crooked || !isRound(p[k]);
    }
  }
  return crooked;
}

void checkRounding(std::span<const Vec3> points, double rounding, const std::string& name,
  const std::string& stored, const std::string& remedy)
{
  if (!(rounding > 0.0) || points.empty())
  {
    return;
  }
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 extent = high - low;
  if (!extent.allFinite())
  {
    return; // what is not finite has an error of its own
  }
  // A body that is flat by rounding has lost its least extent.
  const double least = extent.minCoeff() > 0.0 ? extent.minCoeff() : extent.maxCoeff();
  if (rounding > kMostRounding * least)
  {
    throw DataError(name + " has its coordinates, of up to " +
      numberText(largestCoordinate(points), 10) + " m, " + stored + ": rounded by up to " +
      numberText(rounding, 3) + " m, more than a thousandth of its " + numberText(least, 3) +
      " m. " + remedy);
  }
}

} // namespace rockfall
