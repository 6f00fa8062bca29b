#pragma once

/// @file
/// The slope as fixed, deformable DDA blocks: the two ways of before contact face elements (paper
/// 2.3.1, fig. 4). For verification only: CFEs replace it.
///
/// Every CFE gets a prism of constant depth straight below it. The prisms are either one block
/// together, or one artificial block each. Constant depth, as prisms down to one level would be
/// columns under a high slope, of stiffness E A / depth far below a rock's contact.

#include "block/Block.h"
#include "terrain/Surface.h"

#include <vector>

namespace rockfall
{

enum class SlopeModel : std::uint8_t
{
  OneBlock,         ///< All of the slope is one block (fig. 4, a).
  ArtificialBlocks, ///< One convex block per CFE (fig. 4, b).
};

/// Material of the blocks of the slope.
struct SlopeBlockMaterial
{
  double density = 2500.0;    ///< kg/m³, > 0.
  double youngModulus = 1e10; ///< Pa, > 0.
  double poissonRatio = 0.1;  ///< Dimensionless, 0 … <0.5.
  double depth = 1.0;         ///< Of the prisms, m, > 0.
  /// Stiffness of the spring of one fixed point over E ∛V of a prism, > 0. Shi: 10 to 100.
  double fixity = 100.0;

  void validate() const; ///< Throws ParameterError naming field and value.
};

/// One block of the slope with its 12 unknowns, about its centroid and in world axes. It hardly
/// moves, so that first order will do for its displacement from the start.
///
/// The displacement is measured from where its own weight, its initial stress and its fixed points
/// are in equilibrium, so that none of the three appears.
struct SlopeBlock
{
  VolumeIntegrals integrals;  ///< Local frame of the terrain; second moments about the centroid.
  Mat12 mass = Mat12::Zero(); ///< ρ ∫ Tᵀ T dV
  Mat12 stiffness = Mat12::Zero(); ///< V E of the strains + Σ p Tᵀ T of the fixed points.
  std::vector<Vec3> fixedPoints;   ///< m
  Vec12 displacement = Vec12::Zero();
  Vec12 velocity = Vec12::Zero();

  /// nᵀT for a point of the block (local frame, m) and a direction n.
  Vec12 row(const Vec3& n, const Vec3& point) const
  {
    const Vec3 x = point - integrals.centroid;
    return displacementRow(n, x, x);
  }
  /// Kinetic and elastic, fixed points included, J.
  double energy() const
  {
    return 0.5 * velocity.dot(mass * velocity) + 0.5 * displacement.dot(stiffness * displacement);
  }
};

struct SlopeBlocks
{
  std::vector<SlopeBlock> blocks;
  std::vector<int> ofCfe; ///< Block under CFE k at [k], −1 where there is none.
};

/// Makes the blocks under a surface. Fixed are all base vertices and the slope's outer sides.
SlopeBlocks makeSlopeBlocks(
  const Surface& surface, SlopeModel model, const SlopeBlockMaterial& material);

} // namespace rockfall
