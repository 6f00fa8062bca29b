#pragma once

/// @file
/// Structures that protect better than any that is built or grows, ground that stops what no ground
/// does, rocks of no rock: ranges of their numbers, and the same structure given twice.
///
/// Beyond a range a note asks; what only another unit explains is an error (`refused`). The table
/// of docs/structures.md has the same rows with their sources.

#include "terrain/stand.h"
#include "terrain/structures.h"

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

class Terrain;

struct PlausibleRange
{
  double least, most;
  double refused = std::numeric_limits<double>::infinity(); ///< Above it an error.

  bool has(double value) const { return value >= least && value <= most; }
};

namespace plausible
{

/// Of a stem at breast height, m. Veteran trees of Europe's forests come to 2 m.
inline constexpr PlausibleRange kStemDiameter{ 0.02, 2.0, 10.0 };
/// Height of a tree over its stem's diameter, dimensionless. Solitary trees have some 30, dense
/// stands up to 150 (yield tables).
inline constexpr PlausibleRange kSlenderness{ 20.0, 200.0 };
/// Of a lying stem, m: the tallest trees of Europe have some 65 m; shorter is a stump.
inline constexpr PlausibleRange kLyingLength{ 0.5, 60.0 };
/// A stem's capacity over that of its diameter, dimensionless: factors of species are 0.9 to 1.7
/// (Dorren & Berger 2006).
inline constexpr PlausibleRange kStemCapacity{ 0.1, 5.0 };
/// Of a net over ground, m. Kits stand 2 to 10 m high.
inline constexpr PlausibleRange kNetHeight{ 1.0, 12.0, 30.0 };
/// Of a net, J. The lowest class of EAD 340059-00-0106 has 100 kJ, the largest kits sold 10,000 kJ.
inline constexpr PlausibleRange kNetCapacity{ 100e3, 10e6, 100e6 };
/// Way on which a net stops its capacity, m. Kits are let out by 2 to 9 m in tests at their MEL.
inline constexpr PlausibleRange kBraking{ 0.5, 12.0 };
/// Share of a net's height that is left after such a test: category A has half and more.
/// Below 2 % it looks like a share instead of per cent; 0 is asked for.
inline constexpr PlausibleRange kResidual{ 0.02, 0.95 };
/// Of what fills a net to the rope, m³ per m of it: half a metre deep to a slope that is filled.
inline constexpr PlausibleRange kNetRoom{ 0.5, 100.0 };
/// Of an embankment's crest over ground, m. The highest rockfall dams have some 25 m.
inline constexpr PlausibleRange kDamHeight{ 0.5, 30.0 };
/// Of an embankment's crest, m.
inline constexpr PlausibleRange kCrestWidth{ 0.2, 20.0 };
/// Of an embankment's side, m across per m down: a wall to 11°.
inline constexpr PlausibleRange kSideSlope{ 0.0, 5.0 };
/// Cross-sections of a stand's stems at breast height, m² per hectare: forests of Europe have 20 to
/// 70, the densest that are known twice as much.
inline constexpr PlausibleRange kBasalArea{ 1.0, 150.0 };
/// Share of a stand's stems; less, but not 0, looks like a share instead of per cent.
inline constexpr PlausibleRange kConifers{ 0.02, 1.0 };
/// φ of ground, degrees; 0 is asked for. Radians are below, and no scree stands as steep as 60°.
inline constexpr PlausibleRange kFrictionAngle{ 2.0, 60.0 };
/// Ground that yields, in the order and SI of yieldingFields(). Lu et al. (2019) have M_E 10 to
/// 25 MN/m², C_s 0.1 to 4 and friction of 0.55 to 2; STONE rolls at 0.3 to 0.8.
inline constexpr PlausibleRange kYielding[] = {
  { 1e5, 1e9 },      // M_E, Pa: wet bog to compacted gravel
  { 0.0, 0.5 },      // f of a scar's depth: 0.1 in print
  { 300.0, 3000.0 }, // density, kg/m³: peat to gravel
  { 0.0, 10.0 },     // C_s
  { 0.0, 10.0 },     // C_ω
  { 0.0, 2.0 },      // μ_min
  { 0.0, 4.0 },      // μ_max
  { 0.0, 100.0 },    // κ, 1/m
  { 0.0, 1000.0 },   // β, 1/s
  { 0.0, 1.0 },      // μ_r
  { 0.0, 1.0 },      // σ of softness
  { 1.0, 1000.0 },   // its length, m
  { 0.0, 5.0 },      // r₀, m
};
/// K of restitution, m/s: half of Rn is gone. CRSP has 9 m/s.
inline constexpr PlausibleRange kRestitutionSpeed{ 0.5, 100.0 };
/// Deviations of Rv and φ, degrees: more, and half of what is drawn is cut off.
inline constexpr PlausibleRange kRestitutionDeviation{ 0.0, 0.5 };
inline constexpr PlausibleRange kFrictionDeviation{ 0.0, 20.0 };
/// c of ground and structures, N per contact point: 100 kN hold a rock of 4 m³ on a wall.
inline constexpr PlausibleRange kCohesion{ 0.0, 1e5 };
/// Mean and deviation of the ground's heights from the survey, m: beyond it they are cm, or the
/// survey's own.
inline constexpr PlausibleRange kRoughness{ 0.0, 1.0 };
/// Length of roughness, m; 0 is a height for each node.
inline constexpr PlausibleRange kRoughnessLength{ 0.05, 50.0 };
/// Heights of obstacles, m: Rockyfor3D's field sheets go to 1 m and more in blocks.
inline constexpr PlausibleRange kObstacle{ 0.0, 3.0 };
/// Of a rock, kg/m³: pumice to ores.
inline constexpr PlausibleRange kRockDensity{ 500.0, 5500.0 };
/// Of a rock, m³: a pebble of 2 cm to more than what falls in one piece.
inline constexpr PlausibleRange kRockVolume{ 1e-5, 1000.0 };
/// Of a rock, Pa: soft enough for large steps, to more than basalt's.
inline constexpr PlausibleRange kYoung{ 1e7, 2e11 };
/// Of a rock's centre, and by its spin of its outermost point, m/s: none falls faster.
inline constexpr PlausibleRange kReleaseSpeed{ 0.0, 80.0 };
/// Deviations of the places of rocks, m, in plan and up.
inline constexpr PlausibleRange kPlaceDeviation{ 0.0, 50.0 };
inline constexpr PlausibleRange kHeightDeviation{ 0.0, 10.0 };
/// Deviation of attitudes, degrees: beyond it they are as good as random.
inline constexpr PlausibleRange kAttitudeDeviation{ 0.0, 180.0 };
/// Of all rocks of a slope together, 1/a: a return period of 100,000 years is no office's.
inline constexpr PlausibleRange kRocksPerYear{ 1e-5, 100.0 };
/// Of a rock at rest over the ground, or over a rock under it, m: beyond it the heights may be those
/// of another slope.
inline constexpr PlausibleRange kReleaseHeight{ 0.0, 10.0 };

} // namespace plausible

/// Adds one sentence for each kind of number out of its range, with how many and the first one's.
void askAfterNumbers(const Structures& structures, std::vector<std::string>& notes);

/// The same for each kind of which some stand where another one does, or over a part of it. Lines that
/// record are none of them. `origin`: of the local frame, m.
void askAfterTwins(const Structures& structures, std::vector<std::string>& notes,
  const Eigen::Vector2d& origin = Eigen::Vector2d::Zero());

/// The same of the slope's own ground and its classes: φ, roughness, obstacles.
void askAfterGround(const Terrain& terrain, std::vector<std::string>& notes);

/// The same of how often the rocks of a slope fall, 1/a.
void askAfterFrequency(double perYear, std::vector<std::string>& notes);

/// The same of stands: too dense, or over one another, which those of a raster's cells are not.
void askAfterStands(
  std::span<const Stand> stands, std::vector<std::string>& notes, bool cells = false);

} // namespace rockfall
