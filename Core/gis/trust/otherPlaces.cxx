#include "gis/trust/otherPlaces.h"

#include "base/errors.h"
#include "gis/base/gdal.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace rockfall::gis
{

namespace
{

using Affine = std::array<double, 6>;

/// Corners that are this far apart are others, in cells: digits of a world file make less, corner
/// for centre makes half a cell.
constexpr double apart = 0.1;

/// The largest distance between the corners of a raster at two places, in cells of the first.
double distance(const Affine& one, const Affine& other, int columns, int rows)
{
  double most = 0.0;
  for (const double row : { 0.0, double(rows) })
  {
    for (const double column : { 0.0, double(columns) })
    {
      const auto off = [&](int k)
      {
        return one[k] - other[k] + column * (one[k + 1] - other[k + 1]) +
          row * (one[k + 2] - other[k + 2]);
      };
      most = std::max(most, std::hypot(off(0), off(3)));
    }
  }
  return most / std::max(std::hypot(one[1], one[4]), std::hypot(one[2], one[5]));
}

std::string placeText(const Affine& affine)
{
  return "its upper left corner at (" + number(affine[0]) + ", " + number(affine[3]) +
    "), cells of " + number(std::hypot(affine[1], affine[4]));
}

/// A statement of where a raster is.
struct Statement
{
  std::string by; ///< "the file itself", "dem.tfw"
  std::optional<Affine> affine;
  CrsPtr crs;
};

/// Of a GeoTIFF without what lies beside it.
std::optional<Statement> ownOf(const std::string& path)
{
  const char* const drivers[] = { "GTiff", nullptr };
  const char* const options[] = { "GEOREF_SOURCES=INTERNAL", nullptr };
  const DatasetPtr alone(
    GDALDataset::Open(path.c_str(), GDAL_OF_READONLY | GDAL_OF_RASTER, drivers, options));
  if (!alone)
  {
    return std::nullopt;
  }
  Statement own{ "the file itself", std::nullopt, horizontalCrs(alone->GetSpatialRef()) };
  if (Affine affine{}; alone->GetGeoTransform(affine.data()) == CE_None)
  {
    own.affine = affine;
  }
  return own;
}

std::optional<Statement> worldFileOf(const std::string& path)
{
  for (const char* const extension : { static_cast<const char*>(nullptr), "wld" })
  {
    Affine affine{};
    char* name = nullptr;
    const bool found = GDALReadWorldFile2(path.c_str(), extension, affine.data(), nullptr, &name);
    const std::string written = name ? CPLGetFilename(name) : "";
    CPLFree(name);
    if (found)
    {
      return Statement{ written, affine, nullptr };
    }
  }
  return std::nullopt;
}

/// A .prj, which GDAL reads for some formats only.
std::optional<Statement> projectionOf(const std::string& path)
{
  const std::string name = CPLResetExtension(path.c_str(), "prj");
  VSIStatBufL status;
  if (name == path || VSIStatL(name.c_str(), &status) != 0)
  {
    return std::nullopt;
  }
  CPLStringList lines(CSLLoad2(name.c_str(), 100, 10000, nullptr));
  OGRSpatialReference crs;
  if (crs.importFromESRI(lines.List()) != OGRERR_NONE)
  {
    return std::nullopt;
  }
  return Statement{ CPLGetFilename(name.c_str()), std::nullopt, horizontalCrs(&crs) };
}

/// Whether the numbers of a place mean the same to both, within so much.
bool meanTheSame(const CrsPtr& one, const CrsPtr& other, double x, double y, double within)
{
  double toX = x, toY = y;
  try
  {
    return CrsChange(one, other).forth(1, &toX, &toY) && std::hypot(toX - x, toY - y) <= within;
  }
  catch (const DataError&)
  {
    return false;
  }
}

} // namespace

void noteOtherPlaces(GDALDataset& dataset, const std::array<double, 6>& affine, const CrsPtr& crs,
  std::vector<std::string>& notes)
{
  const std::string path = dataset.GetDescription();
  std::vector<Statement> others;
  if (isOfDriver(dataset, "GTiff"))
  {
    if (const auto own = ownOf(path))
    {
      others.push_back(*own);
    }
  }
  for (const auto& beside : { worldFileOf(path), projectionOf(path) })
  {
    if (beside)
    {
      others.push_back(*beside);
    }
  }
  const auto isTaken = [&](const Statement& s)
  {
    return !s.affine ||
      distance(affine, *s.affine, dataset.GetRasterXSize(), dataset.GetRasterYSize()) <= apart;
  };
  // The source of the place that is taken: one of these, or the .aux.xml beside the file.
  const auto from = std::find_if(
    others.begin(), others.end(), [&](const Statement& s) { return s.affine && isTaken(s); });
  const std::string aux = std::string(CPLGetFilename(path.c_str())) + ".aux.xml";
  const std::string taken = from != others.end() ? from->by : aux;
  VSIStatBufL status;
  const bool hasAux = VSIStatL((path + ".aux.xml").c_str(), &status) == 0;
  const double within = apart * std::hypot(affine[1], affine[4]);
  for (const Statement& s : others)
  {
    if (!isTaken(s))
    {
      notes.push_back("Its place is said twice: " + s.by + " has " + placeText(*s.affine) +
        ", and " + taken + " " + placeText(affine) + ", which was taken. Remove the wrong one.");
    }
    if (s.crs && !crs)
    {
      notes.push_back("Its CRS in " + s.by + ", " + crsLabel(*s.crs) +
        ", is not read for this format: gdal_edit.py -a_srs puts it into the file.");
    }
    else if (s.crs && !meanTheSame(s.crs, crs, affine[0], affine[3], within))
    {
      notes.push_back("Its CRS is said twice: " + s.by + " has " + crsLabel(*s.crs) + ", and " +
        (hasAux ? aux : "the file itself") + " " + crsLabel(*crs) +
        ", which was taken. Remove the wrong one.");
    }
  }
}

} // namespace rockfall::gis
