// Passages into a file; reading them is in passageFile.cxx.

#include "base/errors.h"
#include "base/parallel.h"
#include "gis/base/outputFile.h"
#include "gis/base/packing.h"
#include "statistics/HazardRaster.h"
#include "statistics/passageFile.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

namespace rockfall
{

namespace
{

template <typename T>
void put(std::ostream& out, const T& value)
{
  out.write(reinterpret_cast<const char*>(&value), sizeof(T));
}

void putText(std::ostream& out, const std::string& text)
{
  put(out, std::uint64_t(text.size()));
  out.write(text.data(), std::streamsize(text.size()));
}

constexpr std::size_t kPartsAtOnce = 64; ///< In memory, packed.

/// In parts, behind the bytes that each takes.
void putPassages(std::ostream& out, const std::vector<Passage>& passages)
{
  const std::size_t parts = (passages.size() + kPassagesOfPart - 1) / kPassagesOfPart;
  std::vector<std::uint32_t> lengths(parts);
  const std::streampos table = out.tellp();
  const auto putLengths = [&]
  {
    out.write(reinterpret_cast<const char*>(lengths.data()),
      std::streamsize(parts * sizeof(std::uint32_t)));
  };
  putLengths(); // to be overwritten
  std::vector<std::vector<char>> packed;
  for (std::size_t first = 0; first < parts; first += kPartsAtOnce)
  {
    packed.resize(std::min(kPartsAtOnce, parts - first));
    forEach(packed.size(), 1,
      [&](std::size_t k)
      {
        const std::size_t begin = (first + k) * kPassagesOfPart;
        const std::size_t count = std::min(kPassagesOfPart, passages.size() - begin);
        packed[k] =
          gis::pack({ reinterpret_cast<const char*>(&passages[begin]), count * sizeof(Passage) },
            sizeof(Passage));
      });
    for (std::size_t k = 0; k < packed.size(); ++k)
    {
      lengths[first + k] = std::uint32_t(packed[k].size());
      out.write(packed[k].data(), std::streamsize(packed[k].size()));
    }
  }
  out.seekp(table);
  putLengths();
}

} // namespace

void writePassages(HazardRaster& raster, const Vec3& origin, const std::string& crs,
  const std::string& fileName, const LostRocks& lost, const RockReleases& rocks,
  const RunOrigin& run)
{
  rocks.requireOneSource();
  gis::OutputFile file(fileName);
  std::ofstream out(file.temporary(), std::ios::binary);
  const CellGrid& grid = raster.grid();
  out.write(passageMagic, sizeof(passageMagic));
  put(out, std::int32_t(grid.columns));
  put(out, std::int32_t(grid.rows));
  for (const double value : { grid.cellSize, origin.x() + grid.west, origin.y() + grid.south,
         origin.x(), origin.y(), origin.z() })
  {
    put(out, value);
  }
  putText(out, crs);
  put(out, run.slope);
  putText(out, run.properties);
  put(out, std::uint64_t(raster.releases().size()));
  for (const auto& [iteration, count] : raster.releases())
  {
    put(out, std::int64_t(iteration));
    put(out, count);
  }
  for (const std::int64_t count :
    { lost.rocks, lost.moving, lost.overEdge, lost.inNodata, lost.unmoved })
  {
    put(out, count);
  }
  put(out, lost.endTime);
  put(out, lost.pieces);
  put(out, std::uint64_t(rocks.all().size()));
  for (const auto& [rock, release] : rocks.all())
  {
    for (const std::int64_t number : { std::int64_t(rock.first), rock.second, release.iterations,
           release.source.value_or(kSourceNotKnown) })
    {
      put(out, number);
    }
    put(out, release.frequency.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  const std::vector<Passage>& passages = raster.sorted();
  put(out, std::uint64_t(passages.size()));
  putPassages(out, passages);
  out.close();
  if (!out)
  {
    throw FileError(fileName + ": cannot be written: " + std::strerror(errno));
  }
  file.commit();
}

} // namespace rockfall
