#include "gis/base/progress.h"

#include "base/abort.h"

namespace rockfall::gis
{

int CPL_STDCALL isWanted(double, const char*, void*)
{
  try
  {
    stayWanted();
    return TRUE;
  }
  catch (const Aborted&)
  {
    return FALSE; // no exception may pass through GDAL
  }
}

bool readRows(GDALRasterBand& band, int first, int count, GDALDataType type, void* values)
{
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  how.pfnProgress = isWanted;
  const int columns = band.GetXSize();
  const CPLErr result =
    band.RasterIO(GF_Read, 0, first, columns, count, values, columns, count, type, 0, 0, &how);
  stayWanted();
  return result == CE_None;
}

} // namespace rockfall::gis
