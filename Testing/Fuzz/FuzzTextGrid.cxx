// The second look at grids of text. The first byte says which format GDAL is to take it for.

#include "base/errors.h"
#include "gis/raster/textGrid.h"
#include "temporaryFile.h"

#include <gdal_priv.h>

#include <memory>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  constexpr const char* drivers[] = { "AAIGrid", "GRASSASCIIGrid", "ISG", "XYZ" };
  static const bool ready = (GDALAllRegister(), CPLSetErrorHandler(CPLQuietErrorHandler), true);
  if (!ready || size == 0)
  {
    return 0;
  }
  const std::string name = temporaryFile(data + 1, size - 1, ".asc");
  const char* const allowed[] = { drivers[data[0] % 4], nullptr };
  const std::unique_ptr<GDALDataset> dataset(
    GDALDataset::Open(name.c_str(), GDAL_OF_RASTER, allowed));
  // What a raster may have is decided before, by its size.
  if (dataset && double(dataset->GetRasterXSize()) * dataset->GetRasterYSize() < 1e6)
  {
    try
    {
      rockfall::gis::checkTextGrid(*dataset, name);
    }
    catch (const rockfall::Error&)
    {
      // As it should be.
    }
  }
  return 0;
}
