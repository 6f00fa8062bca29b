#include "gis/raster/rasterFile.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/text/plainText.h"
#include "gis/base/progress.h"
#include "gis/trust/heightUnit.h"
#include "gis/trust/nodata.h"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall::gis
{

namespace
{

/// A node of exactly 0 is suspect if the next one is so much higher or deeper, m: no cliff, or a wall
/// of more than 76° that is no quay.
constexpr double suspectStep = 100.0, suspectWall = 20.0, suspectSlope = 4.0;
/// Rounding to whole numbers of so many metres makes terraces if so many cells are level, and if the
/// slope has so many steps.
constexpr double coarse = 0.3, terraces = 0.25, steps = 10.0;
/// With fewer steps they look like classes, if so many cells are level, and neighbours differ by
/// more than a step.
constexpr double patches = 0.5;

/// The band of transparency, if it is not the mask already: GDAL makes none of one of real numbers.
GDALRasterBand* alphaBand(GDALDataset& dataset, const GDALRasterBand* heights)
{
  for (int band = 1; band <= dataset.GetRasterCount(); ++band)
  {
    GDALRasterBand* alpha = dataset.GetRasterBand(band);
    if (alpha != heights && alpha->GetColorInterpretation() == GCI_AlphaBand)
    {
      return alpha;
    }
  }
  return nullptr;
}

} // namespace

RasterFile::RasterFile(
  const std::string& fileName, int band, Messages& messages, std::vector<std::string>& notes)
  : fileName_(fileName)
  , messages_(messages)
  , notes_(notes)
  , dataset_(openRaster(fileName, messages))
  , bandNumber_(band)
{
  const int bands = dataset_->GetRasterCount();
  if (bands == 0)
  {
    // netCDF, HDF5: the file is a container, and the rasters have names of their own.
    const char* inside =
      CSLFetchNameValue(dataset_->GetMetadata("SUBDATASETS"), "SUBDATASET_1_NAME");
    throw FileError(fileName + ": has no raster band" +
      (inside
          ? std::string("; it is a container, give one of its rasters as the file name, e.g. ") +
            inside
          : ""));
  }
  if (band < 1 || band > bands)
  {
    throw DataError(fileName + ": band " + std::to_string(band) + " was asked for, the file has " +
      (bands == 1 ? "1 band" : std::to_string(bands) + " bands"));
  }
  band_ = dataset_->GetRasterBand(band);
  alpha_ = alphaBand(*dataset_, band_);
  const GDALDataType type = band_->GetRasterDataType();
  if (GDALDataTypeIsComplex(type))
  {
    throw DataError(fileName + ": band " + std::to_string(band) + " is of complex type " +
      GDALGetDataTypeName(type) + ", heights are real numbers");
  }
  columns_ = dataset_->GetRasterXSize();
  rows_ = dataset_->GetRasterYSize();
  if (columns_ < 2 || rows_ < 2)
  {
    throw DataError(fileName + ": has " + std::to_string(columns_) + " columns and " +
      std::to_string(rows_) + " rows, at least 2 of each are needed");
  }
  text_ = checkContent(*dataset_, fileName);
  place_ = rasterPlace(*dataset_, *band_, text_, fileName_, notes_);
  heights_ = heightsOf(*dataset_, *band_, fileName_, notes_);
  this->noteColours();
  this->noteBands();
}

void RasterFile::noteBands()
{
  const int bands = dataset_->GetRasterCount() - (alpha_ ? 1 : 0);
  const GDALColorInterp colour = band_->GetColorInterpretation();
  // Of further axes (netCDF) and of pictures there is a note already.
  if (bands < 2 || bandNumber_ != 1 || isOfDriver(*dataset_, "netCDF") ||
    (colour >= GCI_RedBand && colour <= GCI_BlueBand))
  {
    return;
  }
  const std::string name(trimmed(band_->GetDescription()));
  notes_.push_back("Of " + std::to_string(bands) + " bands the first one" +
    (name.empty() ? "" : ", \"" + name + "\",") + " was taken as heights; Band takes another.");
}

void RasterFile::noteColours()
{
  const GDALColorInterp colour = band_->GetColorInterpretation();
  if (colour == GCI_PaletteIndex || (colour >= GCI_RedBand && colour <= GCI_BlueBand))
  {
    notes_.push_back("Band " + std::to_string(bandNumber_) + " is a picture's colour (" +
      GDALGetColorInterpretationName(colour) + "); its numbers were taken as heights in metres.");
  }
  else if (band_->GetRasterDataType() == GDT_Byte && heights_.scale == 1.0 &&
    heights_.offset == 0.0)
  {
    notes_.push_back("Band " + std::to_string(bandNumber_) +
      " has whole numbers up to 255, as hillshades and maps of classes have; they were taken as "
      "heights in metres.");
  }
}

void RasterFile::requireCoverage()
{
  int hasNodata = 0;
  band_->GetNoDataValue(&hasNodata);
  if (hasNodata || !(band_->GetMaskFlags() & GMF_ALL_VALID) || alpha_)
  {
    return;
  }
  double share = 100.0; // of what is there, %
  const int status = band_->GetDataCoverageStatus(0, 0, columns_, rows_, 0, &share);
  if (!(status & GDAL_DATA_COVERAGE_STATUS_UNIMPLEMENTED) &&
    (status & GDAL_DATA_COVERAGE_STATUS_EMPTY))
  {
    throw DataError(fileName_ + ": no tile or block holds " + number(100.0 - share) +
      " % of band " + std::to_string(bandNumber_) +
      ", and the file declares no nodata value: they would be heights of 0 (gdalbuildvrt "
      "-vrtnodata -9999, or gdal_edit.py -a_nodata -9999, declares it)");
  }
}

void RasterFile::noteOddNodes(const std::vector<double>& heights, double step)
{
  std::int64_t zeros = 0, suspect = 0, spikes = 0;
  std::string first; // spike
  for (int row = 0; row < rows_; ++row)
  {
    stayWanted();
    for (int column = 0; column < columns_; ++column)
    {
      const double height = heights[std::size_t(row) * columns_ + column];
      if (std::isnan(height))
      {
        continue;
      }
      // The least way up, and down, to what is around; the most to the four nearest.
      double over = HUGE_VAL, under = HUGE_VAL, beside = 0.0;
      int neighbours = 0;
      for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r)
      {
        for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c)
        {
          const double other = heights[std::size_t(r) * columns_ + c];
          if ((r != row || c != column) && !std::isnan(other))
          {
            over = std::min(over, height - other);
            under = std::min(under, other - height);
            ++neighbours;
            beside = r == row || c == column ? std::max(beside, std::abs(other)) : beside;
          }
        }
        if (height != 0.0 && over < step && under < step)
        {
          break;
        }
      }
      zeros += height == 0.0;
      suspect += height == 0.0 && beside > step;
      if (neighbours >= 3 && std::max(over, under) >= step && ++spikes == 1)
      {
        first = number(std::round(std::max(over, under))) + " m " +
          (over > 0.0 ? "above" : "below") + " in row " + std::to_string(row + 1) + ", column " +
          std::to_string(column + 1);
      }
    }
  }
  const std::size_t told = notes_.size();
  const std::string nodes = "nodes of band " + std::to_string(bandNumber_);
  if (suspect > 0)
  {
    notes_.push_back(std::to_string(zeros) + " " + nodes + " are exactly 0 m, " +
      std::to_string(suspect) + " of them beside ground more than " + number(step) +
      " m off. If 0 stands for no data, gdal_edit.py -a_nodata 0 says so");
  }
  noteMarks(heights, heights_, nodes, "gdal_edit.py -a_nodata ", notes_);
  if (spikes > 0 && notes_.size() == told) // else they are these
  {
    notes_.push_back(std::to_string(spikes) + " " + nodes + " stand alone, more than " +
      number(step) + " m above or below all around, first " + first +
      ": faults of the survey, on which rocks bounce or are caught?");
  }
}

void RasterFile::noteTerraces(const std::vector<double>& heights)
{
  if (std::abs(heights_.scale) < coarse)
  {
    return;
  }
  double least = HUGE_VAL, most = -HUGE_VAL;
  std::int64_t level = 0, all = 0, changes = 0, jumps = 0;
  for (int row = 0; row < rows_; ++row)
  {
    stayWanted();
    for (int column = 0; column < columns_; ++column)
    {
      const std::size_t i = std::size_t(row) * columns_ + column;
      const double raw = (heights[i] - heights_.offset) / heights_.scale;
      if (std::isnan(raw))
      {
        continue;
      }
      if (std::abs(raw - std::round(raw)) > 1e-6)
      {
        return;
      }
      least = std::min(least, raw);
      most = std::max(most, raw);
      if (row + 1 < rows_ && column + 1 < columns_ && !std::isnan(heights[i + columns_ + 1]))
      {
        ++all;
        const double change = std::abs(heights[i + 1] - heights[i]) / std::abs(heights_.scale);
        changes += change > 0.5;
        jumps += change > 1.5;
        level += heights[i] == heights[i + 1] && heights[i] == heights[i + columns_] &&
          heights[i] == heights[i + columns_ + 1];
      }
    }
  }
  if (all > 0 && least >= 0.0 && most > least && most - least < steps &&
    double(level) >= patches * double(all) && 4 * jumps >= changes &&
    band_->GetRasterDataType() != GDT_Byte)
  {
    notes_.push_back("All heights are whole numbers from " + number(least) + " to " + number(most) +
      ", in level patches: is it a map of classes?");
  }
  if (all > 0 && most - least >= steps && double(level) >= terraces * double(all))
  {
    notes_.push_back("All heights are whole numbers, and " +
      number(std::round(100.0 * double(level) / double(all))) +
      " % of the cells are level: terraces of the rounding, on which rocks come to rest. Take a "
      "DEM with decimals, or a CellSize that smooths them");
  }
}

SourceGrid RasterFile::read()
{
  requireMemory(double(columns_) * rows_, fileName_);
  this->requireCoverage();
  SourceGrid grid;
  grid.columns = columns_;
  grid.rows = rows_;
  grid.affine = place_.affine;
  grid.heights.resize(std::size_t(columns_) * rows_);

  // Whole blocks of the file, of about 4 million nodes.
  int blockColumns = 1, blockRows = 1;
  band_->GetBlockSize(&blockColumns, &blockRows);
  blockRows = std::clamp(blockRows, 1, rows_);
  const int blocks = std::max(1, (1 << 22) / columns_ / blockRows);
  const int step = int(std::min<std::int64_t>(std::int64_t(blocks) * blockRows, rows_));
  for (std::int64_t first = 0; first < rows_; first += step)
  {
    stayWanted();
    const int count = int(std::min<std::int64_t>(step, rows_ - first));
    this->readRows(int(first), count, grid.heights.data() + first * columns_);
    // No block is asked for twice: GDAL's cache would only be a second copy.
    band_->FlushCache();
  }
  if (std::all_of(
        grid.heights.begin(), grid.heights.end(), [](double height) { return std::isnan(height); }))
  {
    throw DataError(fileName_ + ": all " + sizeText(columns_, rows_) + " nodes of band " +
      std::to_string(bandNumber_) + " are nodata");
  }

  const double cell = place_.crs && place_.crs->IsGeographic()
    ? suspectStep
    : std::hypot(place_.affine[1], place_.affine[4]);
  const double suspicious = std::clamp(suspectSlope * cell, suspectWall, suspectStep);
  this->noteOddNodes(grid.heights, suspicious);
  this->noteTerraces(grid.heights);

  if (place_.affine[2] == 0.0 && place_.affine[4] == 0.0 && place_.affine[5] > 0.0)
  {
    for (int row = 0; row < rows_ / 2; ++row)
    {
      const auto upper = grid.heights.begin() + std::ptrdiff_t(row) * columns_;
      const auto lower = grid.heights.begin() + std::ptrdiff_t(rows_ - 1 - row) * columns_;
      std::swap_ranges(upper, upper + columns_, lower);
    }
    grid.affine[3] += rows_ * grid.affine[5];
    grid.affine[5] = -grid.affine[5];
    notes_.push_back("The file's " + std::to_string(rows_) +
      " rows run from south to north; they were turned over.");
  }
  return grid;
}

void RasterFile::readRows(int first, int count, double* values)
{
  const auto fail = [&]
  {
    throw FileError(fileName_ + ": rows " + std::to_string(first + 1) + " to " +
      std::to_string(first + count) + " of band " + std::to_string(bandNumber_) +
      " cannot be read: " + messages_.failure());
  };
  messages_.clear();
  if (!gis::readRows(*band_, first, count, GDT_Float64, values) || !messages_.failure().empty())
  {
    fail();
  }

  // A mask made from the nodata value says nothing new, unless the value has 64 bits and is not a
  // double, or is one of all bands together. Real masks and alpha bands do.
  const int flags = band_->GetMaskFlags();
  const GDALDataType type = band_->GetRasterDataType();
  const bool wide = type == GDT_Int64 || type == GDT_UInt64;
  std::vector<GByte> mask;
  std::vector<double> alpha;
  if (alpha_ && !(flags & GMF_ALPHA))
  {
    alpha.resize(std::size_t(count) * columns_);
    if (!gis::readRows(*alpha_, first, count, GDT_Float64, alpha.data()))
    {
      fail();
    }
  }
  if (!(flags & GMF_ALL_VALID) && (!(flags & GMF_NODATA) || wide || (flags & GMF_PER_DATASET)))
  {
    mask.resize(std::size_t(count) * columns_);
    if (!gis::readRows(*band_->GetMaskBand(), first, count, GDT_Byte, mask.data()))
    {
      fail();
    }
  }

  const Nodata nodata(*dataset_, *band_, heights_);
  const auto isNull = [&](std::size_t i)
  {
    return text_.ownNulls
      ? !text_.nulls.empty() && text_.nulls[std::size_t(first) * columns_ + i] != 0
      : nodata(values[i]);
  };
  for (std::size_t i = 0; i < std::size_t(count) * columns_; ++i)
  {
    const double raw = values[i];
    if ((!mask.empty() && mask[i] == 0) || (!alpha.empty() && alpha[i] == 0.0) || isNull(i))
    {
      values[i] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    values[i] = heights_.metres(raw);
    if (!(values[i] >= kDeepest && values[i] <= kHighest))
    {
      this->check(first + int(i / columns_), int(i % columns_), raw, values[i]);
    }
  }
}

void RasterFile::check(int row, int column, double raw, double height) const
{
  const std::string where = " in row " + std::to_string(row + 1) + ", column " +
    std::to_string(column + 1) + " of band " + std::to_string(bandNumber_);
  if (!std::isfinite(raw))
  {
    throw DataError(fileName_ + ": the height" + where + " is " + number(raw) +
      " and that is not the file's nodata value");
  }
  throw DataError(fileName_ + ": the height" + where + " is " + number(height) +
    " m; a nodata value that the file does not declare? (gdal_edit.py -a_nodata " + exactly(raw) +
    " declares it)");
}

} // namespace rockfall::gis
