#pragma once

/// @file
/// Constants of impacts as events, which go on from section 4 of law/settings.h.

namespace rockfall
{

/// Steps of a half period of a touched point on a spring, by which impulses that share an impact
/// are told from each other. More: slip within an impact is followed finer, at that cost; energy
/// does not depend on it.
inline constexpr double kImpulseParts = 16.0;
/// Most such steps, for points that push each other back; what is left comes in again.
inline constexpr int kMostImpulseParts = 400;
/// Approach that an impulse leaves, share of the speed of a touch that is no impact. Lower: more
/// parts where points push each other back.
inline constexpr double kQuietImpulse = 0.05;
/// Gap within which points share an impact, share of r. Larger: corners that would touch a little
/// later act at once.
inline constexpr double kSharedTouch = 1e-3;
/// Gap to which a touch is found in time, share of r.
inline constexpr double kTouchFound = 1e-5;
/// Time that is none, s.
inline constexpr double kNoTime = 1e-9;
/// Impacts as events in no time, after which springs go on.
inline constexpr int kImpactsAtOnce = 12;

} // namespace rockfall
