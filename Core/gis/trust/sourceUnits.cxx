#include "gis/trust/sourceUnits.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"
#include "gis/base/writtenName.h"
#include "gis/trust/headers.h"
#include "gis/trust/heightUnit.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <gdal_priv.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

namespace rockfall::gis
{

namespace
{

/// Sources of sources: a virtual raster of virtual ones.
constexpr int kNested = 4;

struct Source
{
  std::string file;
  int band = 1;
};

bool isNamed(const CPLXMLNode* node, const char* name)
{
  return node->eType == CXT_Element && std::strcmp(node->pszValue, name) == 0;
}

/// Whether the virtual raster changes a source's numbers.
bool isChanged(const CPLXMLNode* source)
{
  return CPLAtof(CPLGetXMLValue(source, "ScaleRatio", "1")) != 1.0 ||
    CPLGetXMLNode(source, "LUT") || CPLGetXMLNode(source, "Exponent");
}

/// The sources of a band, as its file's XML has them; none of a band that is computed.
std::vector<Source> sourcesOf(GDALDataset& dataset, int band)
{
  std::vector<Source> sources;
  const char* const* const xml = dataset.GetMetadata("xml:VRT");
  if (!isOfDriver(dataset, "VRT") || !xml || !*xml)
  {
    return sources;
  }
  const CPLXMLTreeCloser root(CPLParseXMLString(*xml));
  const CPLXMLNode* const whole = root ? CPLGetXMLNode(root.get(), "=VRTDataset") : nullptr;
  const std::string folder = CPLGetPath(dataset.GetDescription());
  const auto add = [&](const CPLXMLNode* name, int of)
  {
    if (const std::string file = sourceFile(name, folder); !file.empty())
    {
      sources.push_back({ file, of });
    }
  };
  for (const CPLXMLNode* node = whole ? whole->psChild : nullptr; node; node = node->psNext)
  {
    if (isNamed(node, "GDALWarpOptions"))
    {
      add(CPLGetXMLNode(node, "SourceDataset"), band);
    }
    if (!isNamed(node, "VRTRasterBand") || std::atoi(CPLGetXMLValue(node, "band", "0")) != band ||
      std::strcmp(CPLGetXMLValue(node, "subClass", ""), "VRTDerivedRasterBand") == 0)
    {
      continue;
    }
    for (const CPLXMLNode* source = node->psChild; source; source = source->psNext)
    {
      if (source->eType == CXT_Element && !isChanged(source) &&
        CPLGetXMLNode(source, "SourceFilename") && CPLGetXMLNode(source, "SourceBand"))
      {
        add(CPLGetXMLNode(source, "SourceFilename"),
          std::atoi(CPLGetXMLValue(source, "SourceBand", "1")));
      }
    }
  }
  return sources;
}

/// Units of sources, of the first ones that differ.
class Units
{
public:
  Units(double metres, const std::string& fileName)
    : metres_(metres)
    , fileName_(fileName)
  {
  }

  void look(const std::vector<Source>& sources, int depth)
  {
    // Spread over all of them: tiles of one survey lie together.
    const std::size_t every = (sources.size() + kMostSources - 1) / kMostSources;
    for (std::size_t k = 0; k < sources.size(); ++k)
    {
      stayWanted();
      if (k % every != 0 || asked_ == kMostSources)
      {
        ++unasked_;
        continue;
      }
      ++asked_;
      const Source& source = sources[k];
      // The guards of the whole file hold for its sources: it was looked into, and stays local.
      const DatasetPtr tile(GDALDataset::Open(
        source.file.c_str(), GDAL_OF_READONLY | GDAL_OF_RASTER, openingDrivers()));
      GDALRasterBand* const of = tile ? tile->GetRasterBand(source.band) : nullptr;
      if (!of)
      {
        continue; // who reads it, says so
      }
      const std::string unit = namedUnitOf(*tile, *of);
      if (isNoUnit(unit) && depth < kNested)
      {
        if (const std::vector<Source> inner = sourcesOf(*tile, source.band); !inner.empty())
        {
          this->look(inner, depth + 1);
          continue;
        }
      }
      const auto metres = isNoUnit(unit) ? std::optional(metres_) : metresPer(unit);
      const bool same = metres && std::abs(*metres - metres_) <= 1e-5 * metres_;
      std::optional<std::string>& first = same ? same_ : other_;
      first = first
        ? first
        : source.file + (isNoUnit(unit) ? " has no unit" : " has the unit \"" + unit + "\"");
      otherUnit_ = same || !otherUnit_.empty() ? otherUnit_ : unit;
    }
  }

  std::size_t unasked() const { return unasked_; }

  void require(int band) const
  {
    if (other_)
    {
      throw DataError(fileName_ + ": the heights of band " + std::to_string(band) +
        " have no unit and would be in " + (metres_ == 1.0 ? "metres" : unitsText(metres_)) +
        (same_ ? ", but of its sources " + *other_ + " and " + *same_ + "; bring all to one unit"
               : ", but its source " + *other_ + "; gdal_edit.py -units " + otherUnit_ + " " +
              fileName_ + " says it"));
    }
  }

private:
  double metres_;
  const std::string& fileName_;
  std::size_t asked_ = 0, unasked_ = 0;
  std::optional<std::string> same_, other_; ///< "west.tif has no unit"
  std::string otherUnit_;
};

} // namespace

std::string namedUnitOf(GDALDataset& dataset, GDALRasterBand& band)
{
  std::string unit(trimmed(band.GetUnitType() ? band.GetUnitType() : ""));
  if (isNoUnit(unit))
  {
    const Header saga = sagaHeader(dataset);
    unit = saga.count("unit") ? saga.at("unit") : std::string();
  }
  const PrjHeights prj = isNoUnit(unit) ? prjHeights(dataset) : PrjHeights();
  if (!prj.unit.empty() && prj.unit != "no")
  {
    // A number: units per metre, as 100 for centimetres.
    const auto perMetre = parsedNumber(prj.unit);
    unit = perMetre && *perMetre > 0.0 ? exactly(1.0 / *perMetre) + " m" : prj.unit;
  }
  return unit;
}

std::size_t requireUnitOfSources(
  GDALDataset& dataset, GDALRasterBand& band, double metres, const std::string& fileName)
{
  Units units(metres, fileName);
  units.look(sourcesOf(dataset, band.GetBand()), 1);
  units.require(band.GetBand());
  return units.unasked();
}

} // namespace rockfall::gis
