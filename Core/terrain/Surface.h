#pragma once

/// @file
/// The slope as one realisation sees it, and the small explicit piece of it under a rock.

#include "base/random.h"
#include "law/settings.h"
#include "terrain/Terrain.h"
#include "terrain/scatter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace rockfall
{

/// A terrain with the random numbers of one iteration put on it (METHOD 7). A value: two surfaces
/// of the same terrain, seed and iteration are the same.
class Surface
{
public:
  Surface(const Terrain& terrain, std::uint64_t seed, int iteration);
  /// Without roughness and with the mean material.
  static Surface asSurveyed(const Terrain& terrain);

  const Terrain& terrain() const { return *terrain_; }
  /// Uniform in (0, 1), for whatever is drawn in this iteration beside the surface.
  std::array<double, 2> drawTwo(Draw purpose, std::uint64_t index) const
  {
    return uniformDeviates(seed_, iteration_, purpose, index);
  }
  // Deviates drawn per iteration, of class 0.
  double restitution() const { return restitution_; }               ///< Rv, clamped to 0 … 1.
  double friction() const { return friction_; }                     ///< tan φ
  double cohesion() const { return terrain_->material().cohesion; } ///< N

  // The ground at a touch: the numbers of its class, drawn for what the deviations of the class are
  // drawn for. Per iteration each class draws its own.
  int restitutionClass(std::int64_t cfe) const { return terrain_->restitutionClassOf(cfe); }
  /// For what a class of restitution is drawn; Iteration if nothing is.
  DeviationPer deviationPer(int restitutionClass) const
  {
    return this->perOf(terrain_->restitutionMaterial(restitutionClass));
  }
  double restitutionAt(const GroundTouch& touch) const;
  double frictionAt(const GroundTouch& touch) const; ///< tan φ
  /// S of a restitution class at a place (yieldingGround.h), 1 where it does not deviate.
  double softnessAt(int restitutionClass, const Vec3& place) const;
  /// No touch of the slope itself has more.
  double largestRestitution() const;
  double cohesionAt(std::int64_t cfe) const
  {
    return terrain_->jointMaterial(terrain_->jointClassOf(cfe)).cohesion;
  }

  /// The nodes as rocks meet them: the terrain's, or finer ones that show its roughness, cut into
  /// triangles as those.
  struct Grid
  {
    int columns, rows;
    double cellSize; ///< m
    int parts;       ///< Of the side of one of the terrain's cells.
    double height() const { return (rows - 1) * cellSize; } ///< Extent in y, m.
  };
  const Grid& grid() const { return grid_; }
  /// Number of the CFE that holds the lower or the upper triangle of a cell of the grid.
  std::int64_t cfeOf(int row, int column, bool upper) const
  {
    const int p = grid_.parts, r = row % p, c = column % p;
    const std::int64_t cell =
      std::int64_t(row / p) * (terrain_->geometry().columns - 1) + column / p;
    if (p == 1)
    {
      return 2 * cell + (upper ? 2 : 1);
    }
    // Cells of the grid above the cut of the terrain's cell have a negative offset.
    const int off = terrain_->isRising(row / p, column / p) ? r + c + 1 - p : r - c;
    return 2 * cell + (off < 0 || (off == 0 && upper) ? 2 : 1);
  }
  double nodeHeight(int row, int column) const; ///< With roughness, NaN for nodata, m.
  double elevation(double x, double y) const;   ///< With roughness, NaN outside, m.
  /// The same, and beyond the edge of the slope what makes a rock leave it as it would go on: where
  /// the ground falls towards the edge it goes on falling as it did, as far outside as inside;
  /// elsewhere it goes on level. So nothing out there is higher than the edge.
  double apronHeight(int row, int column) const
  {
    const Grid& g = grid_;
    const int r = std::clamp(row, 0, g.rows - 1), c = std::clamp(column, 0, g.columns - 1);
    const double edge = this->nodeHeight(r, c);
    if (r == row && c == column)
    {
      return edge;
    }
    const double inside = this->nodeHeight(
      std::clamp(2 * r - row, 0, g.rows - 1), std::clamp(2 * c - column, 0, g.columns - 1));
    return inside > edge ? 2.0 * edge - inside : edge;
  }
  /// Upper bound of the surface over a box, m; −∞ if there is none.
  double maxHeight(double xMin, double xMax, double yMin, double yMax) const
  {
    return terrain_->maxHeight(xMin, xMax, yMin, yMax) + roughnessBound_;
  }

private:
  explicit Surface(const Terrain& terrain);
  static std::uint64_t nextNumber();
  double surveyedNode(int row, int column) const; ///< With what each node is drawn, m.
  /// Of a cell of the terrain.
  const Roughness& roughnessIn(int row, int column) const;
  void drawMaterials();
  DeviationPer perOf(const SurfaceMaterial& material) const
  {
    return drawn_ ? terrain_->deviationPerOf(material) : DeviationPer::Iteration;
  }
  /// Standard normal deviate of what is drawn per impact or per place.
  double deviate(DeviationPer per, Draw purpose, const GroundTouch& touch) const;
  double restitutionOf(int restitutionClass) const ///< Drawn per iteration.
  {
    return restitutionClass == 0 ? restitution_ : restitutions_[std::size_t(restitutionClass) - 1];
  }

  const Terrain* terrain_;
  /// No other surface has it, but for copies: by it a thread knows whose nodes it remembers.
  std::uint64_t number_ = nextNumber();
  std::uint64_t seed_ = 0;
  std::uint32_t iteration_ = 0;
  bool drawn_ = false; ///< Else all numbers are means.
  Grid grid_;
  bool rough_ = false;               ///< Nodes are drawn.
  bool field_ = false;               ///< There are fields over the map.
  std::vector<Roughness> roughness_; ///< Of the restitution classes 0, 1, …, for these nodes.
  double roughnessBound_ = 0.0;
  double restitution_ = 0.0;
  double friction_ = 0.0;            ///< tan φ
  std::vector<double> restitutions_; ///< Of the restitution classes 1, 2, …
  std::vector<double> frictions_;    ///< tan φ of the joint classes 1, 2, …
};

/// An explicit piece of surface: the triangles near a rock with their edges and nodes. Contact code
/// sees nothing else, so that any triangulated surface can serve it.
struct SurfacePatch
{
  struct Triangle
  {
    std::array<int, 3> nodes; ///< Counter-clockwise from outside.
    /// Across edge k (nodes k, k+1): the other triangle (−1: none here) and the edge's bend.
    std::array<int, 3> neighbours;
    std::array<signed char, 3> bends; ///< +1 convex (ridge), 0 flat, −1 concave (valley).
    bool rising = false;              ///< Cut of its cell (cellDiagonal.h).
    bool firm = false;                ///< Stays where it is when Λ of a scar sinks.
    Vec3 normal;
    double offset;    ///< normal · x on the plane, m.
    std::int64_t cfe; ///< 0: touches nodata. On the apron that of the nearest cell.
    std::int64_t key; ///< The same triangle has the same key in every patch.
    /// In a lower triangle the ridges of its cell: west, south, diagonal; −1: none.
    std::array<int, 3> ridges;
  };
  /// A convex edge between two triangles: the only kind that an edge of a rock can touch. At the
  /// rim of a hole the ground goes down in an upright wall, so that rims are ridges, too.
  struct Ridge
  {
    std::array<int, 2> nodes;
    std::array<int, 2> triangles;
    std::array<int, 2> wings; ///< The third node of each triangle.
    std::int64_t key;         ///< The same edge has the same key in every patch.
  };
  struct Node
  {
    Vec3 position;
    std::int64_t key;
    std::int64_t cfe;  ///< One of the CFEs here, 0 if there is none.
    bool peak;         ///< On a ridge, all neighbours known: a rock's face can touch it.
    bool firm = false; ///< As of its triangles.
    std::array<int, 8> neighbours; ///< Of a peak; one of them again where there are fewer.
  };

  std::vector<Node> nodes;
  std::vector<Triangle> triangles;
  std::vector<Ridge> ridges;

  /// Key of a side of a triangle of the slope: of its cell's west, south, diagonal, and after a gap
  /// east and north.
  static std::int64_t sideKey(const Triangle& triangle, int side)
  {
    constexpr std::array<int, 3> numbers[2][2] = { { { 0, 1, 2 }, { 2, 4, 5 } },
      { { 2, 1, 4 }, { 0, 2, 5 } } };
    const std::int64_t upper = triangle.key & 1;
    return 3 * (triangle.key - upper) + numbers[triangle.rising][upper][std::size_t(side)];
  }

  /// Sign of the bend across a side of a triangle with this normal, as in Triangle::bends. `arm`:
  /// from the side to the other triangle's third node, m.
  static signed char bendOf(const Vec3& normal, const Vec3& arm)
  {
    const double drop = -normal.dot(arm);
    const bool flat = drop * drop <= kFlatBend * kFlatBend * arm.squaredNorm();
    return flat ? 0 : (drop > 0.0 ? 1 : -1);
  }

  /// How many of each are the slope's; those of walls under rims follow, then those of obstacles.
  int slopeNodes = 0, slopeTriangles = 0, slopeRidges = 0;
  int wallTriangles = 0; ///< How many are walls'.
  bool isWall(int triangle) const
  {
    return triangle >= slopeTriangles && triangle < slopeTriangles + wallTriangles;
  }
  /// The slope's triangle straight over or under a place, −1 over a hole and beyond the patch.
  int triangleAt(double x, double y) const
  {
    const double c = (x - west) / cellSize, r = (north - y) / cellSize;
    if (!(c >= 0.0 && r >= 0.0 && c <= nodeColumns - 1 && r <= nodeRows - 1))
    {
      return -1;
    }
    const int column = std::min(int(c), nodeColumns - 2), row = std::min(int(r), nodeRows - 2);
    const int lower = 2 * (row * (nodeColumns - 1) + column);
    const bool rising = triangles[std::size_t(lower)].rising;
    const int i = isInLower(rising, c - column, r - row) ? lower : lower + 1;
    return triangles[std::size_t(i)].cfe != 0 ? i : -1;
  }

  /// Cells gathered: rows [row0, row1], columns [column0, column1]; empty if row1 < row0.
  int row0 = 0, row1 = -1, column0 = 0, column1 = -1;
  /// Node (row, column) of the patch is number row · nodeColumns + column, cell likewise with one
  /// column less; two triangles per cell, the lower one first.
  int nodeColumns = 0, nodeRows = 0;
  double west = 0.0, north = 0.0, cellSize = 1.0; ///< Of node (0, 0), m.

  /// x–y box in which a rock may stand for this patch to be enough, m.
  double xMin = 0.0, xMax = -1.0, yMin = 0.0, yMax = -1.0;

  bool covers(double x0, double x1, double y0, double y1) const
  {
    return x0 >= xMin && x1 <= xMax && y0 >= yMin && y1 <= yMax;
  }
};

/// The heights under the way of a rock, without features: what flight looks at.
class HeightWindow
{
public:
  /// All nodes of the cells that a box (local frame, m) meets. Reuses memory.
  void gather(const Surface& surface, double xMin, double xMax, double yMin, double yMax);
  void clear() { rows_ = 0; }

  int rows() const { return rows_; }       ///< Of nodes, from the north.
  int columns() const { return columns_; } ///< Of nodes, from the west.
  double cellSize() const { return cellSize_; }
  double inverseCellSize() const { return inverse_; }
  double x(int column) const { return west_ + column * cellSize_; }
  double y(int row) const { return north_ - row * cellSize_; }
  double west() const { return west_; }
  double north() const { return north_; }
  double z(int row, int column) const { return z_[std::size_t(row) * columns_ + column]; }
  /// Elevation of the surface, NaN where there is none in the window, m.
  double elevation(double x, double y) const
  {
    const double c = (x - west_) * inverse_, r = (north_ - y) * inverse_;
    if (!(c >= 0.0 && r >= 0.0 && c <= columns_ - 1 && r <= rows_ - 1))
    {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const int column = std::min(int(c), columns_ - 2), row = std::min(int(r), rows_ - 2);
    const double s = c - column, t = r - row;
    const double* upper = &z_[std::size_t(row) * columns_ + column];
    const double* lower = upper + columns_;
    if (this->isRising(row, column))
    {
      return isInLower(true, s, t)
        ? lower[1] + (1.0 - s) * (lower[0] - lower[1]) + (1.0 - t) * (upper[1] - lower[1])
        : upper[0] + s * (upper[1] - upper[0]) + t * (lower[0] - upper[0]);
    }
    return isInLower(false, s, t)
      ? upper[0] + t * (lower[0] - upper[0]) + s * (lower[1] - lower[0])
      : upper[0] + s * (upper[1] - upper[0]) + t * (lower[1] - upper[1]);
  }
  /// Whether a cell's cut rises (cellDiagonal.h). A cell is in the window.
  bool isRising(int row, int column) const
  {
    return anyRising_ && rising_[std::size_t(row) * (columns_ - 1) + column] != 0;
  }
  /// Whether there is a cell whose cut rises, or one whose cut does not.
  bool anyIs(bool rising) const { return rising ? anyRising_ : anyFalling_; }
  /// Mean of the gradients (∂z/∂x, ∂z/∂y) of the CFEs, and the farthest that one of them is from
  /// it.
  const Eigen::Vector2d& tilt() const { return tilt_; }
  double relief() const { return relief_; }
  /// Gradients of CFEs: none is farther from `tilt` than `relief`.
  struct Gradients
  {
    Eigen::Vector2d tilt = Eigen::Vector2d::Zero(); ///< Mean of the tilts.
    double relief = 0.0;
  };
  /// Of the CFEs of rows and columns of cells, with ground all over them.
  Gradients gradients(int row0, int row1, int column0, int column1) const;
  /// Whether there is ground all over it.
  bool whole() const { return whole_; }
  /// No node is higher than tilt · (x, y) + highest, m; −∞ if there is none.
  double highest() const { return highest_; }
  bool covers(double x0, double x1, double y0, double y1) const
  {
    return rows_ > 0 && x0 >= xMin_ && x1 <= xMax_ && y0 >= yMin_ && y1 <= yMax_;
  }

private:
  friend class GroundHeightBound;
  /// Finds the cuts of all cells.
  void cut(CellDiagonal rule);
  /// use(Δz along x, Δz along y) of the CFEs of rows and columns of cells, over one cell.
  template <class Use>
  void visitGradients(int row0, int row1, int column0, int column1, const Use& use) const
  {
    for (int r = row0; r <= row1; ++r)
    {
      const double* upper = &z_[std::size_t(r) * columns_];
      const double* lower = upper + columns_;
      for (int c = column0; c <= column1; ++c)
      {
        const int k = this->isRising(r, c) ? c + 1 : c, other = 2 * c + 1 - k; // sides along y
        use(lower[c + 1] - lower[c], upper[k] - lower[k]);
        use(upper[c + 1] - upper[c], upper[other] - lower[other]);
      }
    }
  }

  std::vector<double> z_;             ///< NaN for nodata.
  std::vector<unsigned char> rising_; ///< By cell.
  bool anyRising_ = false, anyFalling_ = false;
  int rows_ = 0, columns_ = 0;
  double cellSize_ = 0.0, inverse_ = 0.0, west_ = 0.0, north_ = 0.0;
  double xMin_ = 0.0, xMax_ = -1.0, yMin_ = 0.0, yMax_ = -1.0;
  Eigen::Vector2d tilt_ = Eigen::Vector2d::Zero();
  double relief_ = 0.0, highest_ = 0.0;
  bool whole_ = false;
};

/// A plane that no ground is above, within a box: what is sure to be in the air is told by it
/// alone.
class GroundHeightBound
{
public:
  GroundHeightBound() = default;
  explicit GroundHeightBound(const HeightWindow& window);

  /// Whether a box (half its width, m) about a place is in the one that this is for.
  bool covers(const Vec3& at, double half) const
  {
    return at.x() - half >= xMin_ && at.x() + half <= xMax_ && at.y() - half >= yMin_ &&
      at.y() + half <= yMax_;
  }
  /// Whether no ground is within a ball.
  bool isUnder(const Vec3& at, double radius) const
  {
    return at.z() - tilt_.dot(at.head<2>()) - highest_ > radius * slant_ &&
      this->covers(at, radius);
  }

private:
  Eigen::Vector2d tilt_ = Eigen::Vector2d::Zero();
  double highest_ = std::numeric_limits<double>::infinity(); ///< Of the plane over (0, 0), m.
  double slant_ = 1.0;                                       ///< √(1 + |tilt|²)
  double xMin_ = 0.0, xMax_ = -1.0, yMin_ = 0.0, yMax_ = -1.0;
};

/// Gathers the cells under a box (local frame, m) with a ring of one cell around them, by index
/// arithmetic [paper eq. 1]. Reuses the memory of `patch`. Obstacles are not among them
/// (Obstacles::append).
void gatherPatch(
  const Surface& surface, double xMin, double xMax, double yMin, double yMax, SurfacePatch& patch);

} // namespace rockfall
