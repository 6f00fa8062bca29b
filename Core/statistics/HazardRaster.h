#pragma once

/// @file
/// Passages through the cells of a grid: number of rocks, speeds, heights, energies.

#include "statistics/passages.h"
#include "statistics/path.h"

#include <functional>
#include <vector>

namespace rockfall
{

class Terrain;

/// Keeps one passage per rock, iteration and cell, so that quantiles are exact and parts can be
/// merged. The results depend on what was added, not on the order or on how it was shared out.
class HazardRaster
{
public:
  /// `terrain`, if given, is the ground between the points of a path; its local frame is then the
  /// paths'. Throws ParameterError for a grid without cells or of more than 2³² of them.
  explicit HazardRaster(const CellGrid& grid, const Terrain* terrain = nullptr);

  const CellGrid& grid() const { return grid_; }

  /// Cuts the path at the borders of the cells. A rock wider than a cell
  /// touches every cell under the disc of its width, found along pieces of half
  /// a cell; it stops in the cell of its centre. What is beyond the grid counts
  /// as released, not more. A piece that is added behind its rock, or behind
  /// another piece of it, is a part of that rock's passages and no release. Throws DataError as
  /// checkPath. Not for several
  /// threads at once: use one raster each, and merge.
  void add(const RockPath& path);
  /// Hands `use` the paths from `first` on, `count` of them; several threads ask at once.
  using ReadPaths = std::function<void(
    std::int64_t first, std::int64_t count, const std::function<void(const RockPath&)>& use)>;
  /// Adds paths 0 … count − 1, on all threads. A rock that broke is one of them with its pieces.
  void addAll(std::int64_t count, const ReadPaths& read);
  /// Takes in what another raster of the same grid has. Throws ParameterError for another grid.
  void merge(const HazardRaster& other);

  std::int64_t released() const { return released_; }
  /// All passages in their order.
  const std::vector<Passage>& sorted();
  const Releases& releases() const { return releasedIn_; }

private:
  std::int64_t cellAt(double x, double y) const; ///< −1 beyond the grid.
  void addPiece(const PathPiece& piece, std::array<double, 2> grounds);
  void addVisit(std::int64_t cell, const Maxima& maxima, const Vec3& place);
  Maxima maximaOf(
    const PathPiece& piece, double from, double to, std::array<double, 2> grounds) const;
  /// Of the line from a place up to the release of the path being added, in Passage's steps; a right
  /// angle straight under it.
  std::uint32_t angleAt(const Vec3& place) const;
  void addSwath(const RockPath& path);
  /// Calls use(piece, {ground at its begin, at its end}); false if there is none that takes time.
  template <class Use>
  bool forPieces(const RockPath& path, Use&& use) const;
  void keep(const RockPath& path, const Passage& visit);
  void addWhole(const RockPath& path); ///< Passages of the path, in the order of cells.
  /// Takes the passages from `piece` on, of a piece that came to be in cell `birth`, into those of
  /// its rock.
  void joinRock(std::size_t piece, std::int64_t birth);
  double groundUnder(const PathPoint& point) const;
  double maxHeight(
    const PathPiece& piece, double from, double to, std::array<double, 2> grounds) const;

  CellGrid grid_;
  const Terrain* terrain_;
  std::vector<Passage> passages_;
  Releases releasedIn_;
  std::int64_t released_ = 0;

  // Of the rock being added.
  std::size_t rockBegin_ = 0; ///< Where its passages begin.
  RockPath rock_;             ///< Without points.

  // Of the path being added.
  std::vector<Passage> visits_;
  std::int64_t here_ = -1;
  Vec3 release_ = Vec3::Zero();
  std::vector<double> cuts_;
  mutable std::vector<double> groundCuts_;
};

} // namespace rockfall
