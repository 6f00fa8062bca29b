#pragma once

/// @file
/// Places drawn uniformly from polygons and lines in plan.

#include "base/types.h"

#include <array>
#include <vector>

namespace rockfall
{

/// Places of equal chance within rings in the x–y plane: what an odd number of them encloses, so
/// that holes and several parts need no telling apart, and rings may cross. Cut into trapezoids
/// once, at the heights of corners and crossings; a place then costs a search in them.
class PolygonSampler
{
public:
  /// `rings`: their corners, m, closed or not.
  explicit PolygonSampler(const std::vector<std::vector<Vec3>>& rings);

  double area() const { return cumulated_.empty() ? 0.0 : cumulated_.back(); } ///< m²
  /// Trapezoids that the area is cut into, their corners counter-clockwise, m.
  std::vector<std::array<Eigen::Vector2d, 4>> pieces() const;
  /// The place of three numbers from 0 to 1. Area must not be 0.
  Eigen::Vector2d at(double u, double v, double w) const;

private:
  struct Side;
  struct Trapezoid
  {
    double y0, y1;        ///< m
    double left0, right0; ///< x at y0, m
    double left1, right1; ///< x at y1, m
  };
  /// Takes what lies between two heights, m, of the sides that reach over both; sorts them.
  void addSlab(std::vector<const Side*>& across, double y0, double y1);

  std::vector<Trapezoid> trapezoids_;
  std::vector<double> cumulated_; ///< Area up to and with each, m².
};

/// Places of equal chance along lines, by their length in plan.
class LineSampler
{
public:
  explicit LineSampler(const std::vector<std::vector<Vec3>>& lines);

  double length() const { return cumulated_.empty() ? 0.0 : cumulated_.back(); } ///< In plan, m.
  /// The place of a number from 0 to 1; z between that of the corners. Length must not be 0.
  Vec3 at(double u) const;

private:
  std::vector<std::array<Vec3, 2>> segments_;
  std::vector<double> cumulated_; ///< Length up to and with each, m.
};

} // namespace rockfall
