#pragma once

/// @file
/// Passages of a run in a file, so that the map of many runs can be made without having any of them
/// in memory.
///
/// A file has, little endian: the 8 bytes "RFPASS08"; columns and rows (int32 each); cell size,
/// west, south (double); x, y, z of the local origin (double); bytes of the CRS (uint64) and the
/// CRS as WKT; number of the slope's content (uint64, 0: not known); bytes of the run's properties
/// (uint64) and their text; number of iterations (uint64) and for each its number (int64) and how
/// many rocks were released in it (int64); whom the run lost: rocks, still moving, over the edge,
/// in nodata, unmoved (int64), the latest time of one that still moved (double), the pieces that
/// rocks broke into (int64); number of rocks whose frequency or source is known (uint64), and for
/// each its number, block, iterations that released it, source (int64, the lowest: not known) and
/// frequency (double, 1/a, NaN: not known); number of passages (uint64), and the passages in their
/// order, in parts of kPassagesOfPart, each packed by itself (gis/base/packing.h): first the bytes
/// that each part takes (uint32), then the parts. A passage is 40 bytes: cell (uint32), entries (15
/// bits), whether the rock came to rest there (1) and the energy-line angle (16), iteration, rock
/// (int32), block (int64), the four largest values (float).

#include "base/types.h"
#include "statistics/lost.h"
#include "statistics/passages.h"
#include "statistics/rockReleases.h"
#include "statistics/runOrigin.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace rockfall
{

class HazardRaster;

/// The first bytes of a file.
constexpr char passageMagic[8] = { 'R', 'F', 'P', 'A', 'S', 'S', '0', '8' };
/// Source in a file of a rock whose source is not known.
constexpr std::int64_t kSourceNotKnown = std::numeric_limits<std::int64_t>::min();
/// Of each file that is read one part is in memory.
constexpr std::size_t kPassagesOfPart = 4096;

/// Statements of a file on itself.
struct PassageFile
{
  std::string fileName;
  CellGrid grid;              ///< In the world's frame, m.
  Vec3 origin = Vec3::Zero(); ///< Of the paths' frame, m.
  std::string crs;            ///< WKT; empty for a local system.
  RunOrigin run;
  Releases releases;
  LostRocks lost;                   ///< Of all of the run, whatever came to the map.
  RockReleases rocks;               ///< Whose frequency or source is known.
  std::uint64_t passages = 0;       ///< How many there are.
  std::vector<std::uint64_t> parts; ///< Byte with which each begins, and the end.
};

/// Writes what was added to `raster`, whose frame has its origin at `origin`,
/// into `fileName`: beside, and renamed when it is whole. Throws FileError, DataError if a rock has two sources.
void writePassages(HazardRaster& raster, const Vec3& origin, const std::string& crs,
  const std::string& fileName, const LostRocks& lost = {}, const RockReleases& rocks = {},
  const RunOrigin& run = {});

/// Reads all but the passages. Throws FileError that names the file if it is none, of another
/// version, not of the length that it must have, or of numbers that no run has.
PassageFile readPassageFile(const std::string& fileName);

/// Several files as one. Whatever the passages are shared out over files, the results are the same
/// bits, and those of one raster that has them all.
class PassageFiles
{
public:
  /// Throws ParameterError without a name, FileError as readPassageFile, DataError that names the
  /// file whose grid or CRS is not that of the first, or which alone has frequencies or has none.
  explicit PassageFiles(const std::vector<std::string>& fileNames);

  const CellGrid& grid() const { return files_.front().grid; } ///< In the world's frame, m.
  const Vec3& origin() const { return files_.front().origin; }
  const std::string& crs() const { return files_.front().crs; }
  const Releases& releases() const { return releases_; }
  const LostRocks& lost() const { return lost_; }
  const RockReleases& rocks() const { return rocks_; }
  /// On files whose runs differ from the first.
  const std::vector<std::string>& notes() const { return notes_; }

  /// All passages in their order, as they are. Merges the files on the way, with 64 MB of memory for
  /// all of them. Throws FileError.
  void forEach(const std::function<void(const Passage&)>& use) const;

private:
  std::vector<PassageFile> files_;
  Releases releases_; ///< Of all files.
  LostRocks lost_;    ///< Likewise.
  RockReleases rocks_;
  std::vector<std::string> notes_;
};

} // namespace rockfall
