#include "gis/trust/heights.h"

#include "base/errors.h"
#include "base/text/columnName.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "gis/trust/bandScale.h"
#include "gis/trust/headers.h"
#include "gis/trust/heightReference.h"
#include "gis/trust/heightUnit.h"
#include "gis/trust/sourceUnits.h"

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <optional>

namespace rockfall::gis
{

namespace
{

/// Two names of one unit differ by rounding, a foot and a survey foot by 2·10⁻⁶.
bool sameLength(double a, double b)
{
  return std::abs(a - b) <= 1e-5 * std::abs(b);
}

std::string unitOfAxis(const OGRSpatialReference& crs, double metres)
{
  const char* name = nullptr;
  if (crs.IsCompound() && crs.GetTargetLinearUnits("VERT_CS", &name) > 0.0 && name && *name)
  {
    return name;
  }
  return metres == 1.0 ? "metre" : isFoot(metres) ? "foot" : number(metres) + " m";
}

/// m per unit of the coordinates; 1 for angles.
double planeUnit(const OGRSpatialReference* crs)
{
  if (!crs || crs->IsEmpty() || crs->IsGeographic() || crs->IsGeocentric())
  {
    return 1.0;
  }
  const double metres = crs->GetLinearUnits();
  return metres > 0.0 && std::isfinite(metres) ? metres : 1.0;
}

/// Declarations of the heights of one band, one after the other.
class BandHeights
{
public:
  BandHeights(GDALDataset& dataset, GDALRasterBand& band, const std::string& fileName,
    std::vector<std::string>& notes)
    : dataset_(dataset)
    , band_(band)
    , fileName_(fileName)
    , notes_(notes)
    , where_(" of band " + std::to_string(band.GetBand()))
  {
  }

  Heights find()
  {
    this->findScale();
    const auto axis = verticalAxis(dataset_.GetSpatialRef());
    const auto unit = this->namedUnit();
    if (axis && unit && !sameLength(*unit, axis->metres))
    {
      this->fail("have the unit \"" + unitName_ + "\", but the vertical axis of the CRS is in " +
        unitOfAxis(*dataset_.GetSpatialRef(), axis->metres) +
        "; correct one of them, e.g. gdal_edit.py -units, or gdal_translate -a_srs");
    }
    double metres = unit ? *unit : axis ? axis->metres : 1.0;
    if (!unit)
    {
      if (const std::size_t unasked = requireUnitOfSources(dataset_, band_, metres, fileName_))
      {
        notes_.push_back("The heights have no unit and were taken to be in " +
          (metres == 1.0 ? "metres" : unitsText(metres)) + "; " + std::to_string(unasked) +
          " of the raster's sources were not asked for theirs.");
      }
    }
    if (metres != 1.0)
    {
      notes_.push_back(unit
          ? "Heights in \"" + unitName_ + "\" were multiplied by " + number(metres) +
            " to be metres."
          : "Heights were multiplied by " + number(metres) + ", the unit of the vertical " +
            (dataset_.GetSpatialRef()->IsCompound() ? "CRS." : "axis of the CRS."));
    }
    if (this->isDown(axis ? std::optional(axis->down) : std::nullopt))
    {
      metres = -metres;
      notes_.push_back(
        "Heights are depths, which count downwards (" + downBy_ + "); their sign was changed.");
    }
    if (!axis && !unit)
    {
      this->noteFeet();
    }
    heights_.scale *= metres;
    heights_.offset *= metres;
    // Where a format has no unit, -a_scale of gdal_translate says it.
    const double scale = std::abs(heights_.scale);
    heights_.unit = metres == 1.0 && isFoot(scale) ? scale : std::abs(metres);
    heights_.reference = heightCrs(dataset_.GetSpatialRef());
    this->findEllipsoid();
    return heights_;
  }

private:
  [[noreturn]] void fail(const std::string& what) const
  {
    throw DataError(fileName_ + ": the heights" + where_ + " " + what);
  }

  void findScale()
  {
    const BandScale own = bandScale(band_, fileName_);
    heights_.scale = own.scale;
    heights_.offset = own.offset;
    if (own.changes())
    {
      notes_.push_back("The band's " + own.text() + " were applied.");
    }
    const Header saga = sagaHeader(dataset_);
    if (saga.count("z_factor"))
    {
      this->multiply("Z_FACTOR", saga.at("z_factor"));
    }
    if (saga.count("z_offset"))
    {
      this->add("Z_OFFSET", saga.at("z_offset"));
    }
    if (isOfDriver(dataset_, "GRASSASCIIGrid"))
    {
      const Header grass = grassHeader(dataset_.GetDescription());
      if (grass.count("multiplier"))
      {
        this->multiply("multiplier", grass.at("multiplier"));
      }
    }
  }

  void multiply(const char* name, const std::string& text)
  {
    const auto factor = parsedNumber(text);
    if (!factor || !std::isfinite(*factor) || *factor == 0.0)
    {
      throw DataError(fileName_ + ": its header has " + name + " \"" + text +
        "\", it must be a number that is not 0");
    }
    if (*factor != 1.0)
    {
      heights_.scale *= *factor;
      heights_.offset *= *factor;
      notes_.push_back("Heights were multiplied by " + number(*factor) + ", the " + name +
        " of the file's header.");
    }
  }

  void add(const char* name, const std::string& text)
  {
    const auto offset = parsedNumber(text);
    if (!offset || !std::isfinite(*offset))
    {
      throw DataError(
        fileName_ + ": its header has " + name + " \"" + text + "\", it must be a finite number");
    }
    if (*offset != 0.0)
    {
      heights_.offset += *offset;
      notes_.push_back(
        "To the heights " + number(*offset) + " was added, the " + name + " of the file's header.");
    }
  }

  /// Metres per unit by name; nothing if none is named.
  std::optional<double> namedUnit()
  {
    unitName_ = namedUnitOf(dataset_, band_);
    const PrjHeights prj = prjHeights(dataset_);
    if (prj.verticalShift != 0.0)
    {
      this->fail("are shifted by " + number(prj.verticalShift) +
        " (Vertical_Shift of the VERTCS in the .prj file), which is not taken into account; shift "
        "them first, and write 0 there");
    }
    if (isNoUnit(unitName_))
    {
      return std::nullopt;
    }
    const auto metres = metresPer(unitName_);
    if (!metres)
    {
      this->fail("have the unit \"" + unitName_ +
        "\", which is not known (gdal_edit.py -units m, or ft, says which it is)");
    }
    return metres;
  }

  /// Text of a variable's attribute, whatever GDAL puts before its name.
  std::string attribute(const char* name) const
  {
    const char* value = band_.GetMetadataItem(name);
    if (!value)
    {
      const char* variable = band_.GetMetadataItem("NETCDF_VARNAME");
      value =
        dataset_.GetMetadataItem(variable ? (std::string(variable) + "#" + name).c_str() : name);
    }
    return nameKey(value ? value : "");
  }

  bool isDown(std::optional<bool> axis)
  {
    const std::string positive = this->attribute("positive");
    const std::string standard = this->attribute("standard_name");
    std::optional<bool> down = axis;
    downBy_ = "the vertical axis of the CRS";
    if (positive == "up" || positive == "down")
    {
      const bool said = positive == "down";
      if (axis && *axis != said)
      {
        this->fail("are \"positive\" " + positive + ", but the vertical axis of the CRS points " +
          (*axis ? "down" : "up") + "; correct one of them");
      }
      down = said;
      downBy_ = "positive: down";
    }
    else if (!axis && standard.find("depth") != std::string::npos)
    {
      down = true;
      downBy_ = "standard_name: " + standard;
    }
    return down.value_or(false);
  }

  /// Coordinates in feet and heights in nothing.
  void noteFeet()
  {
    const OGRSpatialReference* crs = dataset_.GetSpatialRef();
    const double plane = planeUnit(crs);
    if (sameLength(plane, 1.0))
    {
      return;
    }
    notes_.push_back("The CRS " + crsLabel(*crs) + " is in " + unitsText(plane) +
      ", and nothing says what its heights are in; they were taken as metres. If they are " +
      unitsText(plane) + ", gdal_translate -a_scale " + exactly(plane) + " says so");
  }

  /// A variable over the reference ellipsoid, by its name.
  void findEllipsoid()
  {
    const CrsPtr horizontal = horizontalCrs(dataset_.GetSpatialRef());
    if (heights_.reference || !horizontal || horizontal->IsLocal() ||
      this->attribute("standard_name").find("above_reference_ellipsoid") == std::string::npos)
    {
      return;
    }
    OGRSpatialReference high(*horizontal);
    high.PromoteTo3D(nullptr);
    heights_.reference = heightCrs(&high);
  }

  GDALDataset& dataset_;
  GDALRasterBand& band_;
  const std::string& fileName_;
  std::vector<std::string>& notes_;
  std::string where_;
  std::string unitName_, downBy_;
  Heights heights_;
};

} // namespace

Heights heightsOf(GDALDataset& dataset, GDALRasterBand& band, const std::string& fileName,
  std::vector<std::string>& notes)
{
  return BandHeights(dataset, band, fileName, notes).find();
}

Heights LayerHeights::ofColumn(const std::string& name) const
{
  Heights heights = *this;
  if (const auto metres = metresPer(ColumnName(name).unit))
  {
    heights.scale = scale < 0.0 ? -*metres : *metres;
    heights.unit = *metres;
  }
  return heights;
}

void LayerHeights::tell(std::vector<std::string>& notes) const
{
  for (const std::string& text : { note, doubt })
  {
    if (!text.empty())
    {
      notes.push_back(text);
    }
  }
}

LayerHeights heightsOf(GDALDataset& dataset, OGRLayer& layer, const std::string& fileName,
  std::vector<std::string>& notes)
{
  const OGRSpatialReference* crs = definedCrs(layer.GetSpatialRef());
  LayerHeights heights;
  heights.horizontal = horizontalCrs(crs);
  heights.reference = heightCrs(crs);
  heights.planeDeclared = crs != nullptr;
  const bool local = heights.horizontal && heights.horizontal->IsLocal();
  if (local)
  {
    heights.plane = planeUnit(crs);
    heights.horizontal.reset();
    if (!sameLength(heights.plane, 1.0))
    {
      notes.push_back(fileName + ": its local coordinates were multiplied by " +
        number(heights.plane) + " to be metres.");
    }
  }
  if (const auto axis = verticalAxis(crs))
  {
    heights.scale = axis->down ? -axis->metres : axis->metres;
    heights.unit = axis->metres;
    heights.heightsDeclared = true;
    if (heights.scale != 1.0)
    {
      heights.note = fileName + ": its heights were multiplied by " + number(heights.scale) +
        ", the unit" + (axis->down ? ", and the direction downwards," : "") + " of the vertical " +
        (crs->IsCompound() ? "CRS." : "axis of its CRS.");
    }
    return heights;
  }
  if (const auto drawing = drawingUnit(dataset, fileName); drawing && !crs)
  {
    if (!drawing->metres)
    {
      throw DataError(fileName + ": its $INSUNITS is " + std::to_string(drawing->code) +
        ", which is the code of no unit");
    }
    heights.plane = heights.scale = heights.unit = *drawing->metres;
    heights.planeDeclared = heights.heightsDeclared = true;
    if (heights.scale != 1.0)
    {
      notes.push_back(fileName + ": its coordinates and heights in " + drawing->name +
        " ($INSUNITS " + std::to_string(drawing->code) + ") were multiplied by " +
        number(heights.scale) + " to be metres.");
    }
    return heights;
  }
  const PrjHeights prj = prjHeights(dataset);
  if (prj.verticalShift != 0.0)
  {
    throw DataError(fileName + ": its heights are shifted by " + number(prj.verticalShift) +
      " (Vertical_Shift of the VERTCS in the .prj file), which is not taken into account; shift "
      "them first, and write 0 there");
  }
  if (const double plane = planeUnit(crs); !sameLength(plane, 1.0))
  {
    const char* code = crs->GetAuthorityCode(nullptr);
    heights.doubt = fileName + ": its CRS " + crsLabel(*crs) + " is in " + unitsText(plane) +
      ", and nothing says what its heights are in; they were taken as metres. If they are " +
      unitsText(plane) + ", a vertical CRS says so" +
      (code && isFoot(plane) ? std::string(", as ogr2ogr -a_srs EPSG:") + code + "+6360 does"
                             : std::string());
  }
  if (isOfDriver(dataset, "LIBKML") || isOfDriver(dataset, "KML"))
  {
    heights.kml = heights.heightsDeclared = true;
    if (isOfDriver(dataset, "KML"))
    {
      heights.kmlMode = nameKey(kmlMode(fileName));
    }
    OGRSpatialReference egm96;
    if (egm96.SetFromUserInput("EPSG:4326+5773") == OGRERR_NONE)
    {
      heights.reference = heightCrs(&egm96);
    }
  }
  return heights;
}

Altitude altitudeOf(const LayerHeights& heights, const FeatureRow& row)
{
  if (!heights.kml)
  {
    return Altitude::Datum;
  }
  const std::string mode = nameKey(row.text({ "altitudemode" }).value_or(heights.kmlMode));
  return mode == "absolute"        ? Altitude::Datum
    : mode.starts_with("relative") ? Altitude::Ground
                                   : Altitude::None;
}

} // namespace rockfall::gis
