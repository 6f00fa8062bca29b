#pragma once

/// @file
/// Units of the rasters that a virtual one is made of: programs that join tiles drop them.
/// Internal to gis/.

#include <cstddef>
#include <string>

class GDALDataset;
class GDALRasterBand;

namespace rockfall::gis
{

/// The unit that a band has by its own word, by a SAGA header or by a .prj file beside it; empty or
/// a word for none (isNoUnit) if there is none.
std::string namedUnitOf(GDALDataset& dataset, GDALRasterBand& band);

/// Sources of which the unit is asked: each is opened for it.
inline constexpr std::size_t kMostSources = 500;

/// Throws DataError, naming both files and units, if heights of a source are in another unit than
/// `metres` (m per unit), the one that a virtual band without a unit of its own has. Of sources
/// whose numbers the virtual raster changes nothing is asked, and of more than `kMostSources` of no
/// more of them, spread over all. Returns how many were left out for that.
std::size_t requireUnitOfSources(
  GDALDataset& dataset, GDALRasterBand& band, double metres, const std::string& fileName);

} // namespace rockfall::gis
