#pragma once

/// @file
/// The innermost loops of a crowd's solver: one pass of projected Gauss–Seidel over contacts that
/// are dealt out in batches of eight, of which no two share a rock, so that they are reckoned side
/// by side in vector registers. Plain numbers only: this is compiled for every x86-64 processor,
/// for those with AVX2 and for those with AVX-512, to the same bits (no fused operations).

#include <cstddef>

namespace rockfall::crowd
{

constexpr int kLanes = 8;

/// The part of a rock that a sweep meets.
struct alignas(64) Mover
{
  double displacement[4]; ///< Displacement of the centroid, m; h²/m, m/N.
  double turn[4];         ///< Cayley vector of the turn, rad; unused.
  double inertia[8];      ///< h² I⁻¹, world: xx, yy, zz, xy, xz, yz, 1/(N m); unused.
};

/// The part of the contacts of a batch that a sweep meets; the last index is the contact.
struct alignas(64) Batch
{
  double directions[3][3][kLanes]; ///< Normal and two tangents; their x, y, z.
  double lever[2][3][kLanes];      ///< From the rocks' centroids, m.
  double w[kLanes];                ///< nᵀ J A⁻¹ Jᵀ n, m/N
  double coupling[2][kLanes];      ///< Of a normal force with the two tangents, m/N.
  double gap[kLanes];              ///< At the start of the step, m.
  double stiffness[kLanes];        ///< p/(1 + p w), N/m
  double shear[kLanes];            ///< 1/pₛ, m/N
  double gain[kLanes];             ///< Step towards the locked spring, N/m.
  double friction[kLanes];         ///< tan φ
  double cohesion[kLanes];         ///< N
  double slip[2][kLanes];          ///< m
  int body[2][kLanes];             ///< Index of the mover.
};

/// Springs of a batch, for `assemble`; 0 in lanes that hold none.
struct alignas(64) Springs
{
  double penalty[kLanes]; ///< pₙ, N/m
  double shear[kLanes];   ///< pₛ, N/m
};

/// Contacts that may stay open: all that tells whether they do.
struct alignas(64) Speculative
{
  double normal[3][kLanes];
  double lever[2][3][kLanes]; ///< From the rocks' centroids, m.
  double gap[kLanes];         ///< At the start of the step, m.
  int body[2][kLanes];        ///< Index of the mover.
};

/// Forces of the contacts of a batch along their directions, N.
struct alignas(64) Forces
{
  double along[3][kLanes];
};

/// A run of batches, swept in their order or backwards.
struct Pass
{
  const Batch* first;
  Forces* forces; ///< Of the same contacts.
  int count;
  bool backwards;
  bool slope; ///< Contacts with the slope: the second rock is none.
  Mover* movers;
  int* changed; ///< By mover: the last sweep in which it was moved by more than `quiet`.
  int number;   ///< Of this sweep. Batches around which nothing changed are left out.
  double quiet; ///< m
};

/// A look at contacts that are speculative.
struct SpeculativePass
{
  const Speculative* first;
  std::size_t count;
  Mover* movers;         ///< Read only.
  const int* changed;    ///< By mover, as for a pass.
  int since;             ///< Contacts of which no rock has moved since this sweep stay as they are.
  unsigned char* closes; ///< Out, by batch: a bit for each one that is closed where the rocks go.
};

/// Displacement (m) and Cayley vector (rad) of a mover, as they lie in it.
struct alignas(32) Motion
{
  double displacement[4];
  double turn[4];
};

/// Between two sweeps: all that a sweep has changed goes on by `share` of the direction that it
/// went in so far.
struct Further
{
  double share;
  bool anew;    ///< From here on another direction begins.
  double quiet; ///< A mover that goes further than this (m, rad) counts as moved
  int number;   ///< in this sweep.
};

/// The loops, as compiled for one kind of processor.
struct Kernel
{
  /// The largest change of a displacement, m.
  double (*sweep)(const Pass& pass);
  /// Fills in `w`, `coupling`, `stiffness`, `shear` and `gain` from directions, levers, springs and
  /// the movers' mobility.
  void (*assemble)(Batch* batches, const Springs* springs, Mover* movers, std::size_t count);
  bool (*findClosing)(const SpeculativePass& pass); ///< Whether any closes.
  /// How far movers have come since `before`, in the norm of kinetic energy with a ball's inertia
  /// for that of each rock, N m.
  double (*changeOf)(const Mover* movers, const Motion* before, int count);
  /// `now`, `before` and `along` are gone over together.
  void (*goForces)(
    const Further& further, Forces* now, Forces* before, Forces* along, std::size_t count);
  void (*goMovers)(const Further& further, Mover* now, Motion* before, Motion* along, int* changed,
    std::size_t count);
};
extern const Kernel kAnywhere, kAvx2, kAvx512;

/// The one that suits the processor best.
const Kernel& suitedKernel();

} // namespace rockfall::crowd
