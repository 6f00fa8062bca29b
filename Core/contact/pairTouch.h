#pragma once

/// @file
/// A point on which two rocks touch, before it is a contact.

#include "contact/pairs.h"

#include <span>

namespace rockfall
{

/// A point of touch.
struct Touch
{
  Vec3 point;
  double distance; ///< m
  int feature;     ///< Of the corner's rock: a vertex, or < 0: where an edge is cut.
};

/// The points of touch along an axis (findTouches), valid until the next call on this thread.
std::span<const Touch> touchesAlong(
  const PairBody& first, const PairBody& second, const PairAxis& axis, double reach);

/// The features that touch.
void setFeatures(const Touch& touch, const PairAxis& axis, Contact& contact);

/// Where a touch is: all of a contact that is not its springs'.
void putTouch(const Touch& touch, const PairBody& second, const PairAxis& axis, Contact& contact);

} // namespace rockfall
