// Passages into a file; reading them is in passageFile.cxx.

#include "base/errors.h"
#include "gis/base/outputFile.h"
#include "statistics/HazardRaster.h"
#include "statistics/passageFile.h"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace rockfall
{

namespace
{

template <typename T>
void put(std::ostream& out, const T& value)
{
  out.write(reinterpret_cast<const char*>(&value), sizeof(T));
}

} // namespace

void writePassages(HazardRaster& raster, const Vec3& origin, const std::string& crs,
  const std::string& fileName, const LostRocks& lost, const RockFrequencies& frequencies)
{
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
  put(out, std::uint64_t(crs.size()));
  out.write(crs.data(), std::streamsize(crs.size()));
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
  put(out, std::uint64_t(frequencies.releases().size()));
  for (const auto& [rock, release] : frequencies.releases())
  {
    put(out, std::int64_t(rock.first));
    put(out, rock.second);
    put(out, release.iterations);
    put(out, release.frequency);
  }
  const std::vector<Passage>& passages = raster.sorted();
  put(out, std::uint64_t(passages.size()));
  out.write(reinterpret_cast<const char*>(passages.data()),
    std::streamsize(passages.size() * sizeof(Passage)));
  out.close();
  if (!out)
  {
    throw FileError(fileName + ": cannot be written: " + std::strerror(errno));
  }
  file.commit();
}

} // namespace rockfall
