#pragma once

/// @file
/// The slope: a grid of heights with what rocks meet on it, its materials, roughness and structures.

#include "base/types.h"
#include "terrain/HeightGrid.h"
#include "terrain/material.h"
#include "terrain/scatter.h"

#include <memory>
#include <span>
#include <vector>

namespace rockfall
{

class Obstacles;
struct Structures;

/// The slope as read; thread-safe because it never changes.
class Terrain : public HeightGrid
{
public:
  Terrain() = default;
  /// Throws as HeightGrid, ParameterError for a material out of range.
  Terrain(GridGeometry geometry, std::span<const double> heights, std::shared_ptr<const void> owner,
    SurfaceMaterial material = {}, Roughness roughness = {});
  Terrain(GridGeometry geometry, std::vector<double> heights, SurfaceMaterial material = {},
    Roughness roughness = {});

  /// The same heights, shared, of another material, without classes.
  Terrain(const Terrain& other, SurfaceMaterial material, Roughness roughness);

  /// Of all cells that no class says anything else of.
  const SurfaceMaterial& material() const { return material_; }
  const Roughness& roughness() const { return roughness_; }
  /// Of a class of restitution.
  const Roughness& roughnessOf(int restitutionClass) const
  {
    return restitutionClass == 0 || restitutionClasses_.roughness.empty()
      ? roughness_
      : restitutionClasses_.roughness[std::size_t(restitutionClass) - 1];
  }
  /// Most by which roughness raises and lowers a node, m, ≥ 0.
  double roughnessHeight() const;
  double roughnessDepth() const;
  /// Whether anything of it differs between iterations.
  bool draws() const;
  /// Into how many parts the side of a cell is cut for what is rough to show, ≥ 1.
  int refinement() const { return refinement_; }

  /// Gives cells a restitution of their own, and a friction of their own (METHOD 6, the restitution
  /// grid and the joint grid). Throws DataError if the cells are not the terrain's or of a class
  /// that is not there, ParameterError for a material out of range. To be called before the terrain
  /// is used.
  void setRestitutionClasses(MaterialClasses classes);
  void setJointClasses(MaterialClasses classes);
  const MaterialClasses& restitutionClasses() const { return restitutionClasses_; }
  const MaterialClasses& jointClasses() const { return jointClasses_; }
  /// Material of a class of either kind; class 0 is material(), and the materials of obstacles
  /// follow those of the layer.
  const SurfaceMaterial& restitutionMaterial(int number) const
  {
    return number == 0 ? material_
      : number <= restitutionClasses_.count()
      ? restitutionClasses_.materials[std::size_t(number) - 1]
      : this->obstacleMaterial(number - restitutionClasses_.count());
  }
  const SurfaceMaterial& jointMaterial(int number) const
  {
    return number == 0                  ? material_
      : number <= jointClasses_.count() ? jointClasses_.materials[std::size_t(number) - 1]
                                        : this->obstacleMaterial(number - jointClasses_.count());
  }
  /// Whether any of the ground yields to a rock, and whether it gives way (YieldingGround).
  bool yields() const { return this->isSoft(&YieldingGround::yields); }
  bool givesWay() const { return this->isSoft(&YieldingGround::givesWay); }
  /// For what the deviations of materials without a say of their own are drawn. To be called before
  /// the terrain is used.
  void setDeviationPer(DeviationPer per) { deviationPer_ = per; }
  DeviationPer deviationPer() const { return deviationPer_; }
  DeviationPer deviationPerOf(const SurfaceMaterial& material) const
  {
    return material.deviationPer.value_or(deviationPer_);
  }
  /// The class of a CFE, also of one of an obstacle.
  int restitutionClassOf(std::int64_t cfe) const
  {
    return obstacles_ && cfe > this->cfeCapacity()
      ? this->obstacleClass(cfe, restitutionClasses_.count())
      : restitutionClasses_.at(cfe);
  }
  int jointClassOf(std::int64_t cfe) const
  {
    return obstacles_ && cfe > this->cfeCapacity() ? this->obstacleClass(cfe, jointClasses_.count())
                                                   : jointClasses_.at(cfe);
  }

  /// Puts embankments, trees and barriers on the slope; nothing if there are none. Throws as
  /// Obstacles. To be called before the terrain is used.
  void setStructures(Structures structures);
  /// Null if there are none.
  const Obstacles* obstacles() const { return obstacles_.get(); }

private:
  bool isSoft(bool (YieldingGround::*how)() const) const;
  /// Throws ParameterError if cells would have to be cut into too many.
  void findRefinement();
  int obstacleClass(std::int64_t cfe, int layerClasses) const;
  const SurfaceMaterial& obstacleMaterial(int number) const; ///< From 1.

  SurfaceMaterial material_;
  Roughness roughness_;
  int refinement_ = 1;
  MaterialClasses restitutionClasses_;
  MaterialClasses jointClasses_;
  DeviationPer deviationPer_ = DeviationPer::Iteration;
  std::shared_ptr<const Obstacles> obstacles_;
};

/// The paper's bi-planar test slope (METHOD 9.3): 57.7 m high, 100 m long incline at 30°, then 150
/// m of flat, 100 m wide, falling along +x. Nodes at `cellSize` (m).
Terrain makeBiplanarSlope(double cellSize = 5.0);

} // namespace rockfall
