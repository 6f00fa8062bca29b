#pragma once

/// @file
/// Every physical and numerical constant of the engine, once: unit, value, and what changes if it
/// is changed. A share or a factor is dimensionless; r is the radius of a rock, of two rocks the
/// smaller radius; g is gravity. Parameters that a user sets, with their defaults and `validate()`,
/// are in rock/parameters.h, terrain/material.h and terrain/yieldingGround.h.
///
/// Not here: grain sizes of loops and cache lines (beside the loops), tolerances of readers (gis/,
/// mesh/, geometry/), the deviates of roughness.h and scatter.h, which go with what they draw, and
/// guards against underflow (beside their formulas).

namespace rockfall
{

// ---------------------------------------------------------------------------------------------
// 1  Law of a contact

/// Coulomb's limit is μ N + c from where the normal force N is c over this, μ N + this · N below.
/// At the literal limit a contact that carries next to nothing holds by all of c and one that opens
/// by nothing. Higher: nearer to the literal limit; open–close goes round in circles between the
/// two.
inline constexpr double kCohesionPerForce = 20.0;
/// Contact points of the same two bodies that have all of c each; more share what so many have. Two
/// faces have four points where edges are parallel, eight where rounding turns them. Higher:
/// cohesion of a joint hangs on rounding.
inline constexpr int kCohesivePoints = 4;
/// Least coefficient of restitution of a dashpot; below, a contact behaves as at this one. Lower:
/// damping beyond any that matters, and contacts that creep open.
inline constexpr double kLeastRestitution = 0.01;
/// Damping ratio of slip at an impact. High, so that a contact that sticks leaves without slip
/// (rigid-body impact: no tangential restitution). Lower: shear springs give slip back.
inline constexpr double kShearDamping = 5.0;
/// Normal stiffness of contacts of two rocks, N/m (METHOD 9.1). Stiffer ones keep walls and columns
/// from coming to rest: they drift by millimetres.
inline constexpr double kPublishedPenalty = 1e9;
/// Frequency of a lone rock on its penalty spring on the slope, rad/s. On a softer spring a rock
/// turns while it goes on along the slope, and it jumps lower: with 600 by 5 to 28 % on hard ground,
/// by 12 to 40 % out of scars. A stiffer one changes jumps and ways by 2 % at most, and takes
/// shorter steps.
inline constexpr double kSlopeFrequency = 1e4;

// ---------------------------------------------------------------------------------------------
// 2  Step of contact

/// Steps per half period of a vertex on its penalty spring. More: the order in which vertices touch
/// is resolved finer, at that cost; energy does not depend on it.
inline constexpr double kStepsPerImpact = 8.0;
/// Largest displacement in a step of contact as a share of r, and largest rotation, rad. Larger:
/// faster, levers and normals of mid-step less exact.
inline constexpr double kTravelPerStep = 0.1;
/// Impact depth, share of r, in which a contact with the slope stops a rock however fast it comes:
/// the spring is stiffened to that. Larger: softer and cheaper impacts, deeper overlap.
inline constexpr double kDeepestImpact = 0.1;
/// The same as a share of the thickness, which rules for slabs and splinters.
inline constexpr double kDeepestOfThin = 0.25;
/// The same between two rocks, share of r. Larger: stones pressed into each other.
inline constexpr double kDeepestPairImpact = 0.01;
/// Share of the sum of all squared frequencies that one motion on many springs feels. Lower: longer
/// steps, impacts on several corners less resolved.
inline constexpr double kOneMotionShare = 0.25;
/// Least squared frequency of an impact on several points as a share of a point's own, however
/// their forces cancel. Lower: dashpots without bound.
inline constexpr double kLowestImpactMode = 0.05;
/// Strain that vibrates this many times faster than the contact springs follows the contact forces
/// as at rest (6 unknowns). Higher: more rocks with 12 unknowns, slower.
inline constexpr double kStiffBesideContacts = 4.0;
/// The same for strain faster than this, rad/s. Rocks that strike rock touch for T = 2.9 (m² / (R
/// E*² v))^⅕ (Hertz), some 3 ms for 1 m³: 30 rad and more of any vibration of a rock, which is not
/// excited then. A penalty spring is stiffer, and would excite it.
inline constexpr double kFastVibration = 1000.0;
/// Gravity in √(g r) at least, m/s², so that speeds of rest exist without gravity.
inline constexpr double kLeastGravity = 1e-3;
/// Acceleration that a lasting step goes on with at most, in g. Higher: what an impact left moves a
/// rock on.
inline constexpr double kMostLag = 3.0;
/// Share of the time to an impact that is one lasting step, so that a gap is left. Nearer to 1: the
/// impact begins within that step.
inline constexpr double kUpToImpact = 0.98;
/// Gap that may close however the rock goes, as rounding hides it, share of r.
inline constexpr double kHiddenGap = 1e-6;
/// Longest Δt, s. A rock falls 5 cm in it; contacts of a longer one are met wrongly.
inline constexpr double kMostTimeStep = 0.1;

// ---------------------------------------------------------------------------------------------
// 3  Open–close iteration

/// Open–close has settled when no state changes and gaps move by less than this share of their
/// change over the step. The energy error of a step is of the order of this share of its work.
inline constexpr double kGapTolerance = 1e-7;
/// Energy that the lag of a lasting step may give, share of m g r: more, and it is solved without.
/// Larger: rocks that rattle are fed; smaller: more damping.
inline constexpr double kGainOfLag = 1e-6;
/// By how much rounding moves gaps from one iteration to the next, share of r.
inline constexpr double kGapRounding = 3e-14;
/// A correction turns back if its product with the last one is below −this times the square of the
/// last: part of it is taken then. Lower: damping of corrections that converge.
inline constexpr double kTurnsBack = 0.25;
/// Least part of a correction that is taken. Lower: slower where the iteration cycles.
inline constexpr double kLeastCorrection = 0.125;

// ---------------------------------------------------------------------------------------------
// 4  Impacts and rest

/// A touch comes down if its point approaches at more than this share of the speed of the rock
/// (20.5°); else it glances or rolls. A polyhedron of 1280 faces that rolls sets down at up to 0.24
/// of its speed. Lower: rolling is adjusted as impacts.
inline constexpr double kComesDown = 0.35;
/// A touch comes down, too, if as fast as from a drop of this share of r.
inline constexpr double kFallsDown = 0.25;
/// A touch is an event if its point approaches at more than this share of the speed (11.5°), or as
/// from a drop of this share of r. Lower: more events, same motion.
inline constexpr double kSteepTouch = 0.2;
inline constexpr double kDropOfTouch = 0.05;
/// A touch slower than this share of √(g r) is no impact. Higher: low rebounds are damped away.
inline constexpr double kRestingSpeed = 1e-2;
/// A rock lies still that has been slower than this share of √(g r) for this time, s. Higher speed
/// or shorter time: creeping rocks stop early.
inline constexpr double kStillSpeed = 1e-3;
inline constexpr double kStillTime = 0.5;
/// An island sleeps, too, when each rock has stayed within this share of r for this time, s:
/// contacts are points without a moment, and a rock wedged between two may swing about them for
/// ever. Longer: piles that never sleep.
inline constexpr double kLingerTime = 3.0;
inline constexpr double kLingerWay = 0.03;
/// A rock that goes away faster and faster stays awake: it comes back by less than this share of its
/// way, and goes by so much further in the second half of the time than in the first. Lower:
/// creeping piles stay awake.
inline constexpr double kComesBack = 0.01;
inline constexpr double kFaster = 0.1;
/// Rotation counts against that from this share of √(g r) at the rim on. Rock that breaks at 50 MPa
/// bears a cube on a patch of 0.016 r^1.5 (SI), whose friction at μ = 0.7 takes 0.3 √r m/s off the
/// rim in a second: 0.03 √r m/s stops in a tenth of one, whatever the size.
inline constexpr double kLingerRim = 0.01;
/// Velocities that differ by this share only are the same.
inline constexpr double kSameVelocity = 1e-9;

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
/// Flight over the plane that no node is above, in steps of an impact, that is taken without a look
/// at the ground itself. Larger: more looks; smaller: shorter ways between them.
inline constexpr double kClearSteps = 8.0;
/// Bound of the flight, in the same, over which that plane is looked at anew. No result depends on
/// it but by the times that are looked at.
inline constexpr double kFarSteps = 50.0;
/// Impacts as events in no time, after which springs go on.
inline constexpr int kImpactsAtOnce = 12;

// ---------------------------------------------------------------------------------------------
// 5  Overlap and its recovery

/// Speed at which a loose overlap is recovered, m/s. Faster: pinched stones are shot out.
inline constexpr double kRecover = 0.005;
/// Deepest loose overlap, share of r.
inline constexpr double kLooseOverlap = 1e-3;
/// Compression that a spring holds in any case, share of r; beyond, it holds what its two sides
/// brought to it. Larger: others press rocks into each other, and springs shoot them out.
inline constexpr double kFirm = 0.02;
/// Factor on what two sides brought, for what gravity and rounding add while they stop each other.
inline constexpr double kSomeMore = 1.1;

// ---------------------------------------------------------------------------------------------
// 6  Contact detection on the slope

/// Edges that bend by less are flat and no feature, sine of the angle. Above the rounding of node
/// heights of a plane (1e-12), below any slope that a survey can tell.
inline constexpr double kFlatBend = 1e-7;
/// Edges of rock and slope nearer to parallel than this sine are no pair.
inline constexpr double kParallelOnSlope = 1e-4;
/// Share of r by which strain and tolerances make a rock no larger than its box.
inline constexpr double kAroundBox = 0.01;
/// What rounding may hide of a way that pairs are kept over, share of r.
inline constexpr double kSureTravel = 1e-7;
/// Slack of the normal cones, sine of the angle: pairs do not get lost between two cones by
/// rounding or by small penetration. Larger: wrong entrances at edges.
inline constexpr double kConeSlack = 0.02;
/// Deepest overlap at which a pair still enters, share of r.
inline constexpr double kDeepestEntrance = 0.1;
/// The same as a share of the thickness, which rules for slabs and splinters. Larger: a ridge whose
/// end touches one side of a slab is taken for one that has come in on the other side.
inline constexpr double kDeepestEntranceOfThin = 0.5;
/// Displacement, share of r, until the pairs that can touch are gathered again. Larger: rarer
/// searches over more pairs; no result depends on it.
inline constexpr double kCandidateSlack = 0.05;
/// The same of a rock among others with nothing of the slope near.
inline constexpr double kFarCandidateSlack = 0.4;
/// Distance beyond what may close in a step in which pairs are gathered, too, at least, share of it.
/// Larger: rarer searches over more pairs.
inline constexpr double kCandidatesBeyond = 0.5;
/// The same of a rock among others, which goes that far in a step.
inline constexpr double kCandidatesBeyondAmong = 1.0;
/// Part of that displacement by which they are gathered ahead of the rock, as it goes, so that they
/// serve on the way there, too. 1: rounding may undo that; 0: they serve half as long.
inline constexpr double kCandidatesAhead = 0.9;
/// Displacement in r until the height of the ground under a rock among others is looked up again.
inline constexpr double kGroundHeightBound = 4.0;
/// Displacement over which heights are gathered in flight, in r or cells, whichever is larger.
inline constexpr double kHeightWindow = 4.0;
/// Longest flight that is looked at at once, s.
inline constexpr double kLongFlight = 1.0;
/// Across an edge that bends by less than this (cosine) the nearer of two planes is the exit, so
/// that depth is continuous when a vertex crosses it; across a sharper one the entrance stays.
inline constexpr double kSmoothTurn = 0.5;
/// Reach of an edge past its end, in depths of the overlap: where two exits under 60° are equally
/// deep lies within.
inline constexpr double kEdgeExtension = 2.0;
/// Reach of a contact past its feature with nothing there to take over, in its compressions.
/// Smaller: springs that are dropped lose their energy.
inline constexpr double kRunOff = 50.0;
/// Reach of planes beyond a concave edge, for what is gathered for several steps, in distances.
inline constexpr double kBeyondConcave = 2.0;

// ---------------------------------------------------------------------------------------------
// 7  Contact detection between rocks

/// An axis replaces the last one if its gap is larger by this share of r, edges by twice as much.
/// Smaller: axes that alternate from step to step, springs that lose their compression.
inline constexpr double kAxisHysteresis = 1e-3;
/// Edges nearer to parallel than this sine are no pair.
inline constexpr double kParallelEdges = 1e-3;
/// Points nearer than this share of r are one.
inline constexpr double kOnePoint = 1e-3;
/// A point that has moved on its rock by less than this share of r since the last step is the same.
inline constexpr double kSamePoint = 0.05;

// ---------------------------------------------------------------------------------------------
// 8  Mass fall: pairs and steps

/// Neighbours are near within this many times the displacement that is known, which may yet grow.
inline constexpr double kWider = 1.1;
/// Steps that a rock may go on in its ball as it passes others now, and otherwise, of the known
/// displacement. More: rarer searches over more pairs.
inline constexpr double kBallSteps = 9.0, kBallOtherwise = 0.5;
/// Longest displacement that is not passed on, as a factor.
inline constexpr double kNoMore = 1.0 + 1e-6;
/// Factor on the speed of approach at the start of a step for what comes near within it. Larger:
/// more contacts, fewer found late.
inline constexpr double kFasterApproach = 1.5;
/// Factor on the step for which rocks that may meet are found. An impact is given at the beginning
/// of its substep, and what is struck goes further by up to one of them.
inline constexpr double kStruckEarly = 1.25;
/// Share of a step's way by which a rock of an island that strikes the slope must be away from
/// others to take the step by itself. Less: it may come to overlap one of them.
inline constexpr double kLoneWay = 0.25;
/// Turn (rad, by the root of how slender a rock is), and way past each other (of a radius), from
/// which the rocks of a contact weigh otherwise than where the step began. Higher: a splinter that
/// spins is pushed by more than it weighs, and the more the next time.
inline constexpr double kWeighedTurn = 0.05;
/// Step of an island in steps of rocks that are alone. Longer: faster, more cuts.
inline constexpr double kIslandTravel = 2.0;
/// Cuts of the step of an island that is far from settled.
inline constexpr int kIslandCuts = 6;
/// In an island a contact is made for a gap below this share of r. An impact turns rocks
/// within the step, and what is found only at its end may be past by then (cubes at 17 m/s, Δt 5
/// ms: mean deepest overlap 0.6 % of an edge, with 2e-3 1.1 %).
inline constexpr double kSurely = 3e-2;
/// Depth beyond the predicted one that was missed, share of r. Smaller: more steps solved twice.
inline constexpr double kMissed = 2e-3;
/// Looks after which no further trees are let go: they hold for the rest of the step.
inline constexpr int kTreeLooks = 8;
/// Share of its capacity below which a tree is not asked what drives rocks into it takes of that in
/// a step. Larger: pushes of many steps go unseen; smaller: more steps solved twice.
inline constexpr double kAskedShare = 0.01;
/// Share by which the push of a tree has grown when it is asked again.
inline constexpr double kMorePush = 0.1;
/// Shortest step, s; the end of a run is as near.
inline constexpr double kTooShort = 1e-9;

// ---------------------------------------------------------------------------------------------
// 9  Mass fall: looks at the end of a step

/// Looks for missed contacts in a step: this many as long as any are missed, this many if deep.
inline constexpr int kMissLooks = 2, kMostMissLooks = 4;
/// A step whose last look finds more than this share of r is far from settled.
inline constexpr double kDeepMiss = 0.01;
/// A step that finds more than this share of r at its end is cut before it is solved again.
inline constexpr double kCutMiss = 0.1;
/// Depth that leaves nothing deep behind it, share of r.
inline constexpr double kWorthALook = 0.25 * kDeepMiss;
/// Gap of a contact that is let go, m.
inline constexpr double kAbsent = 1e3;

// ---------------------------------------------------------------------------------------------
// 10  Islands: soft rows in substeps (solve/island/SoftSolver.h)

/// Substeps of Δt. Fewer: columns and walls creep (5: 1e-4 m for ten cubes).
inline constexpr int kSubsteps = 8;
/// Highest frequency of a row, share of the substep rate. Higher: its force alternates.
inline constexpr double kSoftFrequency = 0.25;
/// Damping ratio of a row. Lower: tall columns sway; higher: walls creep.
inline constexpr double kSoftDamping = 3.0;
/// Speed at which overlap goes, between rocks and on the slope, m/s. The same on both: a stone under
/// a boulder of 50 times its size stays in the slope.
inline constexpr double kOverlapGoes = 1.0;
inline constexpr double kOverlapGoesOnSlope = 10.0;
/// Stress at which a corner is crushed to a patch that bears what presses it, Pa: from here on rock
/// is strong (ISRM 1978). Higher: rocks swing on two points for longer.
inline constexpr double kCrushingStress = 5e7;
/// Radius of the largest such patch, share of r. Larger: splinters under load turn less.
inline constexpr double kLargestPatch = 0.05;
/// Sweeps that make forces balance after the rocks have moved. Fewer: walls of 50 cubes never rest.
inline constexpr int kRelaxSweeps = 3;
/// Share to which the spin of an island's rock is right after a substep. Higher: needles that spin
/// fast gain energy.
inline constexpr double kTurnExact = 1e-3;
/// Most sweeps of either kind.
/// Fewer: needles under heavy rocks are spun up (10), a stone under a rock of 60 times its mass
/// goes into the slope (200).
inline constexpr int kMostSweeps = 1000;
/// Generations of impacts in a substep, and of those behind them that stop a jam. Fewer: what rocks
/// in touch pass on to each other at restitution 0 is left over (half of it with each generation);
/// a stone under a rock of M times its mass strikes up to √M π times.
inline constexpr int kGenerations = 50;
/// Sweeps over the impacts of a generation, until none changes by this share of its speed, or of
/// the resting speed.
inline constexpr int kImpactSweeps = 200;
inline constexpr double kImpactExact = 1e-3;
inline constexpr double kImpactQuiet = 0.1;
/// Points of the same two rocks share an impact if they would close in so many substeps.
inline constexpr double kSharedImpact = 1.5;
/// Deepest overlap that a step may add, share of r; deeper, it is cut. Less: more cuts.
inline constexpr double kDeepStep = 0.02;
/// Motion that is none, share of r.
inline constexpr double kNoMotion = 1e-7;
/// Rocks of a strip.
inline constexpr int kRocksOfStrip = 64;

// ---------------------------------------------------------------------------------------------
// 11  Ground that yields

/// Λ sinks if deeper by this share of its depth and of r. Smaller: more steps in which Λ moves.
inline constexpr double kDeeperScar = 0.1;
inline constexpr double kShallowScar = 0.01;
/// Λ rises if this share of its depth is gained.
inline constexpr double kHigherScar = 0.3;
/// Least vertical part of the normal of ground with scars: not walls, not trees.
inline constexpr double kSteepestScar = 0.3;
/// Clearance of Λ from a rock that it rises under, share of r.
inline constexpr double kScarClearance = 1e-6;
/// Least share of the speed that is left by a piece of a flight through soil. Larger: finer pieces.
inline constexpr double kLeastLeft = 0.8;
/// Share of the speed that soil may take until a rock that leaves it is looked at again.
inline constexpr double kLostOverScar = 0.1;
/// Turn of a rock in such a piece, rad. Larger: coarser volumes.
inline constexpr double kTurnInSoil = 0.2;
/// Shortest piece, s.
inline constexpr double kShortestPiece = 1e-6;
/// For how long hops in one scar are one impact, s. Beyond it each draws its restitution anew: a
/// rock whose impact had drawn 1 would hop on its face for ever.
inline constexpr double kOneImpact = 1.0;
/// Displacements that are none, m, and passages of corners through the surface, share of the
/// motion, that are one.
inline constexpr double kNoWay = 1e-9;
inline constexpr double kSameBreak = 1e-9;

// ---------------------------------------------------------------------------------------------
// 12  Slope, roughness, structures

/// Largest friction angle, degrees, drawn ones too: tan φ is 57 here.
inline constexpr double kSteepestFriction = 89.0;
/// Distance of the knots of a rough field in correlation lengths ℓ. The cubic B-spline, as a
/// kernel on white noise, has the variance of exp(−2 r²/ℓ²) at √3/2; here the correlation is within
/// 0.011 of exp(−(r/ℓ)²) at all lags, and the slope within 1 % of √2 σ/ℓ.
inline constexpr double kFieldKnots = 0.84;
/// Nodes per length. At ½ ℓ the facets have 94 % of the root mean square slope of the field, at ¼ ℓ
/// 98 %, and 101 % of nodes that are raised to keep σ (Roughness::onNodes); an obstacle is ℓ across.
inline constexpr double kNodesOfField = 2.0;
inline constexpr double kNodesOfObstacles = 4.0;
/// Shares of the obstacles of the first height, and of the first two (rg70, rg20, rg10).
inline constexpr double kMostObstacles = 0.7, kManyObstacles = 0.9;
/// Depth of a wall at a hole of nodata, m: far deeper than a rock comes until it has left.
inline constexpr double kWallDepth = 1000.0;
/// Depth of the foot of an embankment under the ground and what roughness lowers it by, m.
inline constexpr double kFootDepth = 0.5;
/// Height of a crest in which a side must have come to the ground, m.
inline constexpr double kLongestSide = 200.0;
/// Share of its height by which a crest may be off the ground that it follows. Smaller: more
/// stations.
inline constexpr double kCrestTolerance = 0.05;
/// Longest mitre in widths; a longer one folds.
inline constexpr double kLongestMitre = 5.0;
/// Depth below its feet to which an embankment goes on upright where the ground has scars, m.
inline constexpr double kScarBesideWall = 4.0;
/// Deviation of the faces of a side in a bend with one common foot, share of its slope.
inline constexpr double kFanTolerance = 0.5;
/// Depth of a stem under the ground, m, and per metre of its diameter.
inline constexpr double kRootDepth = 2.0;
inline constexpr double kRootPerDiameter = 3.0;
/// Barriers passed within this displacement are at one place, m.
inline constexpr double kSamePlace = 1e-6;
/// End of the line of a piece of a barrier, share of its length.
inline constexpr double kPieceEnd = 1e-9;

// ---------------------------------------------------------------------------------------------
// 13  Recording

/// Time between the knots before and after a velocity changes at once, s: a path has one point at a
/// time.
inline constexpr double kInstant = 1e-9;
/// Samples no further apart are at one time, s.
inline constexpr double kOneTime = 0.5 * kInstant;
/// Deviation of the path between two samples from the motion, in r. Smaller: more samples.
inline constexpr double kPathTolerance = 0.01;
/// Places where the ground's slope under a round rock is looked at, share of r.
inline constexpr double kGroundAside = 1e-3;

// ---------------------------------------------------------------------------------------------
// 14  Release

/// Largest height over the slope, m: 1000 m read as feet are 2000 m too high.
inline constexpr double kHighestRelease = 500.0;
/// Speed of a release that may be in flight, m/s: a slower one high over the slope is a mistake.
inline constexpr double kInFlight = 5.0;
/// Depth under its own weight, share of r; deeper, rocks do not always come to rest and energy gets
/// lost: pₙ is refused.
inline constexpr double kDeepestAtRest = 0.02;
/// Limits beyond any rock, or beyond what ends and fits into numbers.
///@{
inline constexpr double kMostSpeed = 1000.0; ///< m/s; also of the outermost point by rotation.
inline constexpr double kMostSpin = 1e4;     ///< rad/s
inline constexpr double kMostDensity = 1e5;  ///< kg/m³; the densest metal has 2.3e4.
inline constexpr double kMostModulus = 1e15; ///< Pa; diamond has 1.2e12.
inline constexpr double kMostVolume = 1e9;   ///< m³
// The least numbers there are leave no mass to share a force.
inline constexpr double kLeastDensity = 1.0;    ///< kg/m³; air has 1.2.
inline constexpr double kLeastModulus = 1000.0; ///< Pa; jelly has some.
inline constexpr double kLeastVolume = 1e-9;    ///< m³, a grain of sand.
/// Pa, a hundredth of fresh snow: softer ground lets rocks through without a force.
inline constexpr double kLeastGroundModulus = 1e3;
// Further out no run comes to an end.
inline constexpr double kLeastTimeStep = 1e-6;    ///< s; 1 m³ on pₙ 1e15 N/m swings as fast.
inline constexpr double kMostEndTime = 1e5;       ///< s; the slowest rock creeps for minutes.
inline constexpr double kMostGravity = 1000.0;    ///< m/s²; the Sun has 274.
inline constexpr double kMostPenalty = 1e15;      ///< N/m; a step of an impact is 1e-7 s there.
inline constexpr double kMostShearRatio = 1000.0; ///< Of shear to normal stiffness.
inline constexpr double kMostCohesion = 1e12;     ///< N; the weight of a mountain on one point.
///@}
/// Overlap that only touches, share of r: rounding of rocks laid down by computed coordinates.
inline constexpr double kTouch = 1e-6;
/// Vertical part of the normal of a triangle on which nothing stands but on its edges.
inline constexpr double kUpright = 1e-9;
/// End of a lift, between these, in touches.
inline constexpr double kEndsAt = -0.9, kEndsBelow = -0.8;
/// Axes that a lift uses at most: none is used twice, and few are.
inline constexpr int kMostAxes = 1000;
/// Displacement in depths by which rocks are pushed apart, so that it ends: the mean of several
/// displacements is less than each.
inline constexpr double kPushApart = 1.1;
inline constexpr int kMostPasses = 5000;
/// Passes after which masses no longer count, and of two that lie on each other the upper one gives
/// way.
inline constexpr int kPushPatience = 100;
/// A rock is on another one where its way out rises by more, sine of its slope.
inline constexpr double kUpward = 0.5;
/// Places drawn for one rock until it is on the slope: about a release, and of a source.
inline constexpr int kMostDraws = 1000;
inline constexpr int kMostDrawsOfSource = 10000;

// ---------------------------------------------------------------------------------------------
// 15  Limits of what a user sets on ground and runs: beyond them it is a mistake, or no end

// Ground of larger numbers takes all of any speed at once, or nothing at all.
inline constexpr double kMostScarFactor = 100.0;    ///< A thousand times that of Lu et al.
inline constexpr double kMostScarRadius = 100.0;    ///< r₀, m; larger than rocks are.
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
