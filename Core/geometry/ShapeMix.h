#pragma once

/// @file
/// Shapes in proportion.

#include "geometry/shapes.h"

#include <string>
#include <vector>

namespace rockfall
{

/// Shapes, each with its weight; at least one.
struct ShapeMix
{
  struct Part
  {
    Shape shape = Shape::Cube;
    double weight = 1.0; ///< Dimensionless, ≥ 0.
    bool operator==(const Part&) const = default;
  };
  std::vector<Part> parts;

  ShapeMix() = default;
  ShapeMix(Shape shape)
    : parts{ { shape, 1.0 } }
  {
  }
  /// "cube", "cube:2;icosahedron:1": names as `shapeFromName` has them, with weights or without
  /// (1). Throws ParameterError naming the part that is wrong.
  static ShapeMix fromText(const std::string& text);

  /// The shape of a number from 0 to 1.
  Shape pick(double u) const;

  bool operator==(const ShapeMix&) const = default;
};

} // namespace rockfall
