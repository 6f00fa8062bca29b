#pragma once

/// @file
/// The implicit slope: node heights of a north-up raster of square cells, whose contact face
/// elements (CFEs) are arithmetic, never a list (METHOD 5; paper 2.3.1).
///
/// Local frame: x east and y north from the lower left (south-west) node, z the elevation. Storage
/// is the raster's: row 0 is the northernmost, so node (row, column) stands at x = column ·
/// cellSize, y = (rows − 1 − row) · cellSize.

#include "base/types.h"
#include "terrain/cellDiagonal.h"
#include "terrain/material.h"
#include "terrain/scatter.h"

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

class Obstacles;
struct Structures;

/// m per unit that a slope's file declares of its numbers, which were multiplied by it; 1 for metres
/// and where nothing is declared. Files beside it may be in the same units and say nothing.
struct FileUnits
{
  double heights = 1.0;
  double plan = 1.0; ///< Of coordinates that have no CRS; else 1.
};

/// Where a raster stands in the world.
struct GridGeometry
{
  int columns = 0;                                   ///< Nodes from west to east, ≥ 2.
  int rows = 0;                                      ///< Nodes from north to south, ≥ 2.
  double cellSize = 0.0;                             ///< m
  double xOrigin = 0.0;                              ///< Real easting of the lower left node, m.
  double yOrigin = 0.0;                              ///< Real northing of the lower left node, m.
  std::string crs;                                   ///< WKT; empty for a local system.
  FileUnits fileUnits{};                             ///< Of the file that was read.
  CellDiagonal diagonal = CellDiagonal::ShorterFold; ///< Of the cells between the nodes.

  std::int64_t nodeCount() const { return std::int64_t(columns) * rows; }
  std::int64_t cellCount() const { return std::int64_t(columns - 1) * (rows - 1); }
  /// The local origin: world = local + origin().
  Vec3 origin() const { return { xOrigin, yOrigin, 0.0 }; }
};

/// A triangle, as looked up by its number.
struct Cfe
{
  std::array<Vec3, 3> nodes; ///< Counter-clockwise seen from above, local frame.
  Vec3 normal;               ///< Unit, upward.
};

/// The slope as read: heights shared, never copied; thread-safe because it never changes.
class Terrain
{
public:
  Terrain() = default;
  /// `heights`: rows × columns in storage order, NaN for nodata. `owner` keeps them alive. Throws
  /// DataError for fewer than 2 rows or columns, a non-positive cell, infinite heights or no CFE at
  /// all.
  Terrain(GridGeometry geometry, std::span<const double> heights, std::shared_ptr<const void> owner,
    SurfaceMaterial material = {}, Roughness roughness = {});
  Terrain(GridGeometry geometry, std::vector<double> heights, SurfaceMaterial material = {},
    Roughness roughness = {});

  /// The same heights, shared, of another material, without classes.
  Terrain(const Terrain& other, SurfaceMaterial material, Roughness roughness);

  const GridGeometry& geometry() const { return geometry_; }
  std::span<const double> heights() const { return heights_; }
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
  double width() const { return (geometry_.columns - 1) * geometry_.cellSize; } ///< Extent in x, m.
  double height() const { return (geometry_.rows - 1) * geometry_.cellSize; }   ///< Extent in y, m.

  /// Cut of the cells. To be called before the terrain is used.
  void setDiagonal(CellDiagonal diagonal) { geometry_.diagonal = diagonal; }
  /// Whether a cell's cut rises (without roughness).
  bool isRising(int row, int column) const
  {
    const double* upper = &heights_[std::size_t(row) * geometry_.columns + column];
    const double* lower = upper + geometry_.columns;
    return isCutRising(geometry_.diagonal, upper[0], upper[1], lower[0], lower[1]);
  }
  double nodeHeight(int row, int column) const
  {
    return heights_[std::size_t(row) * geometry_.columns + column];
  }
  Vec3 node(int row, int column) const
  {
    return { column * geometry_.cellSize, (geometry_.rows - 1 - row) * geometry_.cellSize,
      this->nodeHeight(row, column) };
  }

  /// CFEs are numbered from 1: in cell (row, column) the lower triangle has number
  /// 2 (row (columns−1) + column) + 1, the upper one the next. Numbers of CFEs that touch nodata
  /// are left out, not reused.
  std::int64_t cfeCapacity() const { return 2 * geometry_.cellCount(); }
  bool hasCfe(std::int64_t id) const;
  /// Node indices (row · columns + column), counter-clockwise seen from above.
  std::array<std::int64_t, 3> cfeNodes(std::int64_t id) const;
  Cfe cfe(std::int64_t id) const;
  /// The CFE above or below a place in the local frame, 0 if there is none.
  std::int64_t cfeAt(double x, double y) const;
  /// Elevation of the surface (without roughness), NaN outside it, m.
  double elevation(double x, double y) const;

  /// Upper bound of the node heights (without roughness) of all cells that a box in x–y touches,
  /// from a max-pyramid; −∞ if it touches none. Cost independent of the box.
  double maxHeight(double xMin, double xMax, double yMin, double yMax) const;

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
  /// Whether any of the ground gives way under a rock.
  bool yields() const;
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

  /// Lowest node height (without roughness), m.
  double lowest() const { return lowest_; }

private:
  void buildPyramid();
  /// Throws ParameterError if cells would have to be cut into too many.
  void findRefinement();
  int obstacleClass(std::int64_t cfe, int layerClasses) const;
  const SurfaceMaterial& obstacleMaterial(int number) const; ///< From 1.

  GridGeometry geometry_;
  std::span<const double> heights_;
  std::shared_ptr<const void> owner_;
  SurfaceMaterial material_;
  Roughness roughness_;
  int refinement_ = 1;
  MaterialClasses restitutionClasses_;
  MaterialClasses jointClasses_;
  DeviationPer deviationPer_ = DeviationPer::Iteration;
  std::shared_ptr<const Obstacles> obstacles_;

  struct Level
  {
    int columns = 0, rows = 0;
    std::vector<float> maximum; ///< Rounded up.
  };
  std::shared_ptr<const std::vector<Level>> pyramid_;
  double lowest_ = 0.0;
};

/// The paper's bi-planar test slope (METHOD 9.3): 57.7 m high, 100 m long incline at 30°, then 150
/// m of flat, 100 m wide, falling along +x. Nodes at `cellSize` (m).
Terrain makeBiplanarSlope(double cellSize = 5.0);

} // namespace rockfall
