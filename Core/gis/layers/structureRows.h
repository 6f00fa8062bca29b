#pragma once

/// @file
/// Rows of layers of structures, brought to the terrain, and the reader of each kind of them.
/// Internal to gis/: needs GDAL's headers.

#include "gis/layers/LayerFile.h"
#include "gis/layers/layerPlaces.h"
#include "gis/layers/structureLayers.h"
#include "gis/trust/heightReference.h"

#include <array>
#include <functional>
#include <map>
#include <optional>

namespace rockfall::gis
{

inline constexpr double kJ = 1000.0; // J
inline constexpr double cm = 0.01;   // m

/// Places in the terrain's local frame.
class StructurePlaces
{
public:
  StructurePlaces(const std::string& fileName, const LayerHeights& heights, const Terrain& terrain,
    std::vector<std::string>& notes);

  Eigen::Vector2d at(const FeatureRow& row, double x, double y)
  {
    return places_.at(row, x, y) - origin_;
  }
  /// The lines of a row.
  std::vector<std::vector<Eigen::Vector2d>> lines(const FeatureRow& row);
  /// Elevation over what the terrain's refer to, m, of a column's number, at the row's place.
  double elevation(const FeatureRow& row, const char* column, double number);

  /// Throws DataError if all places are beside the terrain.
  void requireOverlap() const;
  void tellDoubt() const { places_.doubt.tell(notes_); }

private:
  const std::string& fileName_;
  const LayerHeights& heights_;
  const Terrain& terrain_;
  std::vector<std::string>& notes_;
  LayerPlaces places_;
  Eigen::Vector2d origin_;
  std::optional<HeightChange> heightChange_; ///< Made for the first elevation.
};

/// Materials of rows that have their own, each kept once. What a row does not give is the slope's
/// own, with its deviation; what it gives has none.
class OwnMaterials
{
public:
  OwnMaterials(const SurfaceMaterial& base, std::vector<SurfaceMaterial>& all)
    : base_(base)
    , all_(all)
  {
  }

  /// Number of the row's own, 0 if it has none.
  int of(const FeatureRow& row);

private:
  SurfaceMaterial base_;
  std::vector<SurfaceMaterial>& all_;
  std::map<std::array<double, 6>, int> numbers_;
};

/// Layer to read, with the structures that were read and what was done to the data.
struct StructureReader
{
  const StructureFiles& files;
  const Terrain& terrain;
  OwnMaterials& own;
  Structures& all;
  std::vector<std::string>& notes;

  /// Calls `use` for every row with its number, then tells a layer beside the terrain. `numbers`:
  /// names of columns that are read.
  void forEachRow(const LayerWish& wish, const ColumnNames& numbers,
    const std::function<void(const FeatureRow&, std::int64_t, StructurePlaces&)>& use) const;
  /// Each with the name of the file.
  void tell(const std::string& fileName, const std::vector<std::string>& sentences) const;

  void readEmbankments() const;
  /// Trees of their own first, then those of stands, of a layer or of the `cells` of a raster. Gives
  /// how many are of their own.
  std::size_t readTrees(std::span<const Stand> cells) const;
  void readBarriers() const;
};

/// A layer of lines by the name that the user gives it in `property`.
LayerWish lineWish(const std::string& fileName, const std::string& layer, const char* property);

/// A number above 0 that a row must have: "it is `what`".
double needed(const FeatureRow& row, const char* field, const char* what);

} // namespace rockfall::gis
