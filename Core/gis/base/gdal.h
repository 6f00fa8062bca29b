#pragma once

/// @file
/// Common parts of the readers of this folder. GDAL's own headers stay in the sources: whoever
/// includes this header needs GDAL's library, not its headers.

#include "base/text/numberText.h"
#include "gis/base/externalReferences.h"
#include "gis/base/stayLocal.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class GDALDataset;
class OGRLayer;

namespace rockfall::gis
{

/// While it lives, what GDAL has to say on this thread is kept here instead of printed, and GDAL
/// keeps to local files (stayLocal.h). One per public call, declared before any dataset, so that
/// closing is silent, too.
class Messages
{
public:
  Messages();
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  /// The first error since the last `clear`; the first, because later ones only repeat that
  /// something went wrong. Empty if there was none.
  const std::string& failure() const { return kept_.failure; }
  /// The first warning since the last `clear`.
  const std::string& warning() const { return kept_.warning; }
  /// The first warning that text in a column of numbers was lost.
  const std::string& lostText() const { return kept_.lostText; }
  void clear() { kept_ = {}; }

  struct Kept
  {
    std::string failure;
    std::string warning;
    std::string lostText;
  };

private:
  Kept kept_;
  StayLocal local_;
};

struct CloseDataset
{
  std::string folder = {}; ///< In memory, removed with it; empty: none.
  void operator()(GDALDataset* dataset) const;
};
using DatasetPtr = std::unique_ptr<GDALDataset, CloseDataset>;

/// Opens for reading. Throws FileError that says which of the usual mistakes it is: no name, no
/// such file, a folder, the other kind of data, or nothing that GDAL knows; also where the file
/// reaches out (externalReferences.h).
DatasetPtr openRaster(const std::string& fileName, Messages& messages);
/// Tables are brought to UTF-8 first (tableFile.h) and spreadsheets have a header in any case.
/// `notes`: what was done to the text. Throws DataError naming file and line for text that is none.
DatasetPtr openVector(
  const std::string& fileName, Messages& messages, std::vector<std::string>* notes = nullptr);

/// Whether GDAL opened the dataset by this driver.
bool isOfDriver(const GDALDataset& dataset, const char* name);

/// A number for a message, with a decimal point in every locale.
inline std::string number(double value)
{
  return numberText(value, 10);
}

/// The shortest text that reads back as this very number.
std::string exactly(double value);

/// "120 x 80": columns first, as GDAL prints sizes.
std::string sizeText(std::int64_t columns, std::int64_t rows);

} // namespace rockfall::gis
