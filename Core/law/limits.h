#pragma once

/// @file
/// Limits of what a user sets on ground and runs, beyond those of law/settings.h: number, unit and
/// reason. Beyond them a number is a mistake, or no run comes to an end.

namespace rockfall
{

// Ground of larger numbers takes all of any speed at once, or nothing at all.
inline constexpr double kMostScarFactor = 100.0;    ///< A thousand times that of Lu et al.
inline constexpr double kMostScarDrag = 1000.0;     ///< C_s and C_ω; at most 4 are measured.
inline constexpr double kMostGroundFriction = 60.0; ///< μ and μ_r; tan 89° is 57.
inline constexpr double kMostSlipRate = 1e6;        ///< κ, 1/m, and β, 1/s: at once.
inline constexpr double kMostGroundDeviation =
  5.0;                                      ///< σ of a logarithm: 150 times as soft or firm.
inline constexpr double kMostAlike = 1e7;   ///< m, over which ground is alike.
inline constexpr double kLeastAlike = 0.01; ///< m; shorter, the ground is gravel.
inline constexpr double kMostRestitutionSpeed = 1e6; ///< m/s; half of any speed is left there.
/// Of one run; their summaries take 5 GB. More fit into runs of their own by FirstIteration.
inline constexpr int kMostIterations = 10'000'000;
inline constexpr int kMostThreads = 1024; ///< More than any machine runs at once.
/// Rounds of open–close, and halvings of a step: 2⁻³⁰ of any Δt is below rounding.
inline constexpr int kMostOpenClose = 1000, kMostCuts = 30;
/// Rocks by iterations; their summaries take 50 GB.
inline constexpr double kMostTrajectories = 1e8;

} // namespace rockfall
