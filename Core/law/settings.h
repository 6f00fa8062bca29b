#pragma once

/// @file
/// Constants of contact and rest that single rocks, groups and slopes of blocks have in common.

namespace rockfall
{

/// Steps per half period of a vertex on its penalty spring: the impact is then resolved well enough
/// for the order in which several vertices touch, and energy does not depend on it at all.
constexpr double kStepsPerImpact = 8.0;
/// Largest part of the rock's radius, and largest angle (rad), covered in a step of contact.
constexpr double kTravelPerStep = 0.1;
/// A rock lies still when it has been slower than this share of √(g r) for this long (s).
constexpr double kStillSpeed = 1e-3;
constexpr double kStillTime = 0.5;
/// A touch slower than this share of √(g r) is no impact: r is the rock's radius.
constexpr double kRestingSpeed = 1e-2;
/// Damping ratio of slip at an impact: high, so that a contact that sticks leaves without slip and
/// not with what its shear spring gives back (rigid-body impact: no tangential restitution).
constexpr double kShearDamping = 5.0;

} // namespace rockfall
