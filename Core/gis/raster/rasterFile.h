#pragma once

/// @file
/// One band of a raster file as heights in metres, before anything is done to its geometry.

#include "gis/base/gdal.h"
#include "gis/raster/rasterPlace.h"
#include "gis/raster/resample.h"
#include "gis/trust/heights.h"
#include "terrain/Terrain.h"

#include <string>
#include <vector>

class GDALRasterBand;

namespace rockfall::gis
{

/// An open raster whose band has been found fit to be heights: real numbers, 2 × 2 nodes or more.
/// Changes of the data stand in `notes`.
class RasterFile
{
public:
  RasterFile(
    const std::string& fileName, int band, Messages& messages, std::vector<std::string>& notes);

  /// The horizontal CRS; null if the file has none or only an engineering one.
  const CrsPtr& crs() const { return place_.crs; }
  /// CRS of the heights; see heightCrs. Null if the file does not say it.
  const CrsPtr& reference() const { return heights_.reference; }
  FileUnits units() const { return { heights_.unit, place_.metres }; }
  /// False for a picture without world coordinates, which is given cells of 1 m.
  bool georeferenced() const { return place_.georeferenced; }

  /// All heights, read by blocks of rows straight into their final place; NaN for nodata. Northern
  /// row first if the rows run along the x axis at all.
  SourceGrid read();

private:
  void noteColours();
  void noteBands();
  /// Throws where parts of the file hold nothing and would be read as 0.
  void requireCoverage();
  /// Says what looks like a nodata value that nobody declared: nodes of 0 beside ground more than
  /// `step` (m) off, and marks; if none does, which nodes are by `step` above or below all around.
  void noteOddNodes(const std::vector<double>& heights, double step);
  /// Says that heights were rounded to whole numbers, where that makes terraces.
  void noteTerraces(const std::vector<double>& heights);
  void readRows(int first, int count, double* values);
  void check(int row, int column, double raw, double height) const;

  std::string fileName_;
  Messages& messages_;
  std::vector<std::string>& notes_;
  DatasetPtr dataset_;
  GDALRasterBand* band_ = nullptr;
  GDALRasterBand* alpha_ = nullptr; ///< Null if there is none.
  int bandNumber_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  RasterPlace place_;
  Heights heights_;
  TextGrid text_;
};

} // namespace rockfall::gis
