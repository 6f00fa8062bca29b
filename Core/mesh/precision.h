#pragma once

/// @file
/// Coordinates that were rounded before anybody read them: single precision has 0.5 m between two
/// numbers at a northing of 5,200,000 m, and a text of six digits 10 m.

#include "base/types.h"

#include <span>
#include <string>
#include <string_view>

namespace rockfall
{

/// Precision in which a text's numbers were written. A program that writes six digits gives
/// 812.13 for z and 5.20046e+06 for a northing.
class WrittenDigits
{
public:
  void add(std::string_view word, double value);
  /// Half of the last digit of the largest number, m; 0 where every number is as long as it needs.
  double rounding() const;
  /// "with 6 digits"
  std::string describe() const;
  bool any() const { return any_; } ///< Else there is no text.
  /// Whether the numbers were of single precision before they were written: long ones are all such
  /// numbers to their last digit, and not because they are round.
  bool lookSingle() const { return single_ > 1 && !double_; }

private:
  bool sixDigitsAtMost() const;
  void addLong(double value, int digits);

  int digits_ = 0;         ///< Most significant ones of a word.
  int exponentDigits_ = 0; ///< The same of words with an exponent.
  double exponentLargest_ = 0.0, largest_ = 0.0;
  bool any_ = false, paddedDecimals_ = false, sixWithDecimals_ = false;
  int single_ = 0;      ///< Long words that are of single precision, and not round.
  bool double_ = false; ///< A number that is not was met.
};

/// Half the distance between two numbers of single precision at this magnitude, m.
double singleRounding(double magnitude);

/// Whether the coordinates went through single precision though they are stored in double: all of
/// them have its bits, and not only because they are round.
bool lookSingle(std::span<const Vec3> points);

double largestCoordinate(std::span<const Vec3> points); ///< Of the finite ones.

/// Throws DataError if `rounding` (m) is more than a thousandth of the body's least extent. The
/// message begins with `name`, says how the points are `stored`, and ends with the remedy.
void checkRounding(std::span<const Vec3> points, double rounding, const std::string& name,
  const std::string& stored, const std::string& remedy);

} // namespace rockfall
