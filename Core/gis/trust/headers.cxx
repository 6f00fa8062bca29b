#include "gis/trust/headers.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"
#include "gis/trust/heightUnit.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <memory>
#include <set>

namespace rockfall::gis
{

namespace
{

/// A header is not longer than this, whatever the file says.
constexpr int mostHeaderLines = 100'000;
constexpr int longestLine = 100'000; // bytes

/// Calls `use` for each line until it returns false or the file ends.
void forEachLine(const std::string& fileName, const std::function<bool(const std::string&)>& use)
{
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(
    VSIFOpenL(fileName.c_str(), "rb"), VSIFCloseL);
  for (int i = 0; file && i < mostHeaderLines; ++i)
  {
    const char* line = CPLReadLine2L(file.get(), longestLine, nullptr);
    if (!line || !use(line))
    {
      return;
    }
  }
}

/// The file of this extension beside the data, whatever the case of its letters; else empty.
std::string beside(const std::string& fileName, const std::string& extension)
{
  for (const std::string& written : { extension, std::string(CPLString(extension).toupper()) })
  {
    std::string path = CPLResetExtension(fileName.c_str(), written.c_str());
    VSIStatBufL status;
    if (VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0)
    {
      return path;
    }
  }
  return {};
}

std::string sagaHeaderFile(GDALDataset& dataset)
{
  const std::string name = dataset.GetDescription();
  if (!EQUAL(CPLGetExtension(name.c_str()), "sg-grd-z"))
  {
    return beside(name, "sgrd");
  }
  const std::string folder = "/vsizip/{" + name + "}"; // no ending of a zip file by itself
  const CPLStringList files(VSIReadDir(folder.c_str()));
  for (int i = 0; i < files.size(); ++i)
  {
    if (EQUAL(CPLGetExtension(files[i]), "sgrd"))
    {
      return folder + "/" + files[i];
    }
  }
  return {};
}

} // namespace

Header sagaHeader(GDALDataset& dataset)
{
  Header header;
  const std::string path = isOfDriver(dataset, "SAGA") ? sagaHeaderFile(dataset) : std::string();
  if (!path.empty())
  {
    forEachLine(path,
      [&header](const std::string& line)
      {
        const auto equals = line.find('=');
        if (equals != std::string::npos)
        {
          header.emplace(nameKey(line.substr(0, equals)), trimmed(line.substr(equals + 1)));
        }
        return true;
      });
  }
  return header;
}

Header grassHeader(const std::string& fileName)
{
  Header header;
  forEachLine(fileName,
    [&header](const std::string& line)
    {
      const auto colon = line.find(':');
      if (colon == std::string::npos)
      {
        return trimmed(line).empty();
      }
      header.emplace(nameKey(line.substr(0, colon)), trimmed(line.substr(colon + 1)));
      return true;
    });
  return header;
}

PrjHeights prjHeights(GDALDataset& dataset)
{
  PrjHeights heights;
  const std::string path = beside(dataset.GetDescription(), "prj");
  if (path.empty())
  {
    return heights;
  }
  std::string text;
  forEachLine(path,
    [&](const std::string& line)
    {
      const std::string low = nameKey(line);
      if (low.starts_with("zunits"))
      {
        heights.unit = trimmed(low.substr(6));
      }
      text += low;
      return text.size() < std::size_t(longestLine);
    });
  const std::string shift = "parameter[\"vertical_shift\",";
  const auto vertical = text.find("vertcs[");
  const auto at = vertical == std::string::npos ? vertical : text.find(shift, vertical);
  if (at != std::string::npos)
  {
    heights.verticalShift = CPLAtof(text.c_str() + at + shift.size());
  }
  return heights;
}

std::optional<DrawingUnit> drawingUnit(GDALDataset& dataset, const std::string& fileName)
{
  std::optional<int> code;
  if (isOfDriver(dataset, "DXF"))
  {
    // Pairs of lines, a number that says what it is and a value; $INSUNITS, 70, its value.
    bool found = false, codeLine = true;
    std::string group;
    forEachLine(fileName,
      [&](const std::string& line)
      {
        const std::string value(trimmed(line));
        codeLine = !codeLine;
        if (!codeLine)
        {
          group = value;
          return true;
        }
        if (found && group == "70")
        {
          code = std::atoi(value.c_str());
          return false;
        }
        found = group == "9" && value == "$INSUNITS";
        return !(group == "0" && value == "ENDSEC");
      });
  }
  else if (isOfDriver(dataset, "CAD"))
  {
    for (const char* name : { "INSUNITS", "$INSUNITS" })
    {
      if (const char* value = dataset.GetMetadataItem(name))
      {
        code = std::atoi(value);
      }
    }
  }
  if (!code)
  {
    return std::nullopt;
  }
  constexpr double inch = kFoot / 12.0, mile = 5280.0 * kFoot, none = 0.0;
  // In the order of the codes, from unitless to US survey mile; m.
  constexpr std::array metres = { none, inch, kFoot, mile, 0.001, 0.01, 1.0, 1000.0, 1e-6 * inch,
    1e-3 * inch, 3.0 * kFoot, 1e-10, 1e-9, 1e-6, 0.1, 10.0, 100.0, 1e9, 149597870700.0,
    9460730472580800.0, 3.0856775814913673e16, kSurveyFoot, kSurveyFoot / 12.0, 3.0 * kSurveyFoot,
    5280.0 * kSurveyFoot };
  constexpr std::array names = { "unitless", "inches", "feet", "miles", "millimetres",
    "centimetres", "metres", "kilometres", "microinches", "mils", "yards", "angstroms",
    "nanometres", "microns", "decimetres", "decametres", "hectometres", "gigametres",
    "astronomical units", "light years", "parsecs", "US survey feet", "US survey inches",
    "US survey yards", "US survey miles" };
  DrawingUnit unit;
  unit.code = *code;
  if (*code >= 0 && std::size_t(*code) < metres.size())
  {
    unit.name = names[std::size_t(*code)];
    unit.metres = metres[std::size_t(*code)] > 0.0 ? metres[std::size_t(*code)] : 1.0;
  }
  return unit;
}

namespace
{

/// Modes of the geometries in an element and behind it.
void gatherModes(const CPLXMLNode* node, std::set<std::string>& modes)
{
  for (; node; node = node->psNext)
  {
    const bool geometry = node->eType == CXT_Element &&
      (EQUAL(node->pszValue, "Point") || EQUAL(node->pszValue, "LineString") ||
        EQUAL(node->pszValue, "Polygon"));
    if (geometry)
    {
      modes.insert(CPLGetXMLValue(node, "altitudeMode", "clampToGround"));
    }
    else
    {
      gatherModes(node->psChild, modes);
    }
  }
}

} // namespace

std::string kmlMode(const std::string& fileName)
{
  const CPLXMLTreeCloser root(CPLParseXMLFile(fileName.c_str()));
  CPLStripXMLNamespace(root.get(), nullptr, TRUE);
  std::set<std::string> modes;
  gatherModes(root.get(), modes);
  if (modes.size() > 1)
  {
    throw DataError(fileName + ": has geometries of altitudeMode " + *modes.begin() + " and " +
      *modes.rbegin() +
      ", and this GDAL, without libkml, does not say which is whose; make a file of each");
  }
  return modes.empty() ? "clampToGround" : *modes.begin();
}

} // namespace rockfall::gis
