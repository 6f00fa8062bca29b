#include "gis/trust/bandScale.h"

#include "base/errors.h"
#include "gis/base/gdal.h"

#include <gdal_priv.h>

#include <cmath>

namespace rockfall::gis
{

std::string BandScale::text() const
{
  return "scale " + number(scale) + " and offset " + number(offset);
}

BandScale bandScale(GDALRasterBand& band, const std::string& fileName)
{
  BandScale of;
  int has = 0;
  const double scale = band.GetScale(&has);
  of.scale = has ? scale : 1.0;
  const double offset = band.GetOffset(&has);
  of.offset = has ? offset : 0.0;
  if (!std::isfinite(of.scale) || of.scale == 0.0 || !std::isfinite(of.offset))
  {
    throw DataError(fileName + ": band " + std::to_string(band.GetBand()) + " has " + of.text());
  }
  return of;
}

} // namespace rockfall::gis
