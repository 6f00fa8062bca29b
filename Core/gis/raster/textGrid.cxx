#include "gis/raster/textGrid.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"
#include "gis/base/textWords.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <map>

namespace rockfall::gis
{

bool isNumber(std::string word)
{
  std::replace(word.begin(), word.end(), ',', '.');
  char* end = nullptr;
  CPLStrtod(word.c_str(), &end); // a point in every locale; nan and inf in all their spellings
  return end != word.c_str() && *end == '\0' && word.find_first_of("xX") == std::string::npos;
}

namespace
{

/// Numbers row by row from where the header ends, with the words that stand for no data.
class GridCells
{
public:
  GridCells(const std::string& fileName, std::int64_t columns, std::int64_t rows)
    : fileName_(fileName)
    , columns_(columns)
    , rows_(rows)
  {
  }

  /// Words that stand for no data, and a number that does if `ownNulls`.
  std::vector<std::string> nullWords;
  TextGrid result;
  bool sections = false; ///< A word that begins with # ends the numbers.

  void read(Text& text, bool more, std::string word)
  {
    std::int64_t count = 0;
    for (; more && !(sections && word[0] == '#'); more = text.next(word), ++count)
    {
      const bool null = std::find(nullWords.begin(), nullWords.end(), word) != nullWords.end() ||
        (result.ownNulls && this->isNullNumber(word));
      if (null && result.ownNulls && count < columns_ * rows_)
      {
        if (result.nulls.empty())
        {
          result.nulls.assign(std::size_t(columns_ * rows_), 0);
        }
        result.nulls[std::size_t(count)] = 1;
      }
      else if (!null && !isNumber(word))
      {
        throw DataError(fileName_ + ": \"" + word + "\" in row " +
          std::to_string(count / columns_ + 1) + ", column " +
          std::to_string(count % columns_ + 1) + " is not a number");
      }
    }
    if (count != columns_ * rows_)
    {
      throw FileError(fileName_ + ": cannot be read: it has " + std::to_string(count) +
        " numbers, its header promises " + std::to_string(columns_) + " x " +
        std::to_string(rows_) + " = " + std::to_string(columns_ * rows_));
    }
  }

private:
  bool isNullNumber(const std::string& word) const
  {
    return std::any_of(nullWords.begin(), nullWords.end(),
      [&](const std::string& null) {
        return isNumber(null) && isNumber(word) && CPLAtof(null.c_str()) == CPLAtof(word.c_str());
      });
  }

  const std::string& fileName_;
  std::int64_t columns_, rows_;
};

/// The lower left corner by what an ESRI header says along each axis; nothing where GDAL has it.
std::optional<std::array<double, 2>> mixedCorner(
  const std::map<std::string, double>& header, const std::string& fileName)
{
  constexpr std::array axes = { 'x', 'y' };
  std::array<double, 2> corner{};
  std::array<bool, 2> isCentre{}, isSaid{};
  for (std::size_t k = 0; k < 2; ++k)
  {
    const std::string stem = std::string(1, axes[k]) + "ll";
    const auto atCorner = header.find(stem + "corner"), atCentre = header.find(stem + "center");
    isSaid[k] = atCorner != header.end() || atCentre != header.end();
    isCentre[k] = atCorner == header.end() && isSaid[k];
    const auto size = header.find("cellsize"), step = header.find("d" + std::string(1, axes[k]));
    const double cell = step != header.end() ? step->second
      : size != header.end()                 ? size->second
                                             : 0.0;
    corner[k] = !isSaid[k] ? 0.0 : isCentre[k] ? atCentre->second - 0.5 * cell : atCorner->second;
  }
  if (isSaid[0] != isSaid[1])
  {
    const std::string lost(1, axes[isSaid[0] ? 1 : 0]);
    throw DataError(fileName + ": its header says where it is along " + (isSaid[0] ? "x" : "y") +
      " only; " + lost + "llcorner or " + lost + "llcenter is missing");
  }
  return isCentre[0] == isCentre[1] ? std::nullopt : std::optional(corner);
}

/// Pairs of a keyword and its value, until a number stands where a keyword would.
void checkEsri(Text& text, GridCells& cells, const std::string& fileName)
{
  std::string word, value;
  std::map<std::string, double> header;
  bool more = text.next(word);
  while (more && !isNumber(word) && text.next(value))
  {
    if (nameKey(word) == "nodata_value" && !isNumber(value))
    {
      cells.nullWords.push_back(value);
      cells.result.ownNulls = true;
    }
    else if (isNumber(value))
    {
      header.emplace(
        nameKey(word), CPLAtofDelim(value.c_str(), value.find(',') != value.npos ? ',' : '.'));
    }
    more = text.next(word);
    // A grid that begins with a cell of no data.
    if (more && cells.result.ownNulls && word == cells.nullWords.front())
    {
      break;
    }
  }
  for (const char* size : { "cellsize", "dx", "dy" })
  {
    const auto found = header.find(size);
    if (found != header.end() && !(found->second > 0.0))
    {
      throw DataError(fileName + ": its header has " + size + " " + number(found->second) +
        ", it must be above 0");
    }
  }
  cells.result.corner = mixedCorner(header, fileName);
  cells.read(text, more, word);
}

/// Lines with a colon, then the numbers. `*`, or what "null" says, is nodata.
void checkGrass(Text& text, GridCells& cells)
{
  cells.result.ownNulls = true;
  cells.nullWords.push_back("*");
  std::string line;
  while (text.peek() >= 0)
  {
    const int c = text.peek();
    if (!((c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '\n' || c == '\r'))
    {
      break;
    }
    text.line(line);
    const auto colon = line.find(':');
    if (colon == std::string::npos && !trimmed(line).empty())
    {
      break; // a word where the numbers begin is told by the count
    }
    if (colon != std::string::npos && nameKey(trimmed(line.substr(0, colon))) == "null")
    {
      cells.nullWords.emplace_back(trimmed(line.substr(colon + 1)));
    }
  }
  std::string word;
  const bool more = text.next(word);
  cells.read(text, more, word);
}

/// All after the end of the head.
void checkIsg(Text& text, GridCells& cells)
{
  std::string line, word;
  while (text.line(line) && !nameKey(line).starts_with("end_of_head"))
  {
  }
  const bool more = text.next(word);
  cells.read(text, more, word);
}

/// Sections of a keyword and a value; numbers after #GRID unless they are packed (#GTYPE).
void checkGxf(Text& text, GridCells& cells)
{
  std::string line, word;
  bool packed = false;
  while (text.line(line))
  {
    const std::string key = nameKey(trimmed(line));
    if (key.starts_with("#gtyp") && text.line(line))
    {
      packed = std::atoi(line.c_str()) != 0;
    }
    if (key.starts_with("#grid"))
    {
      break;
    }
  }
  if (!packed)
  {
    cells.sections = true;
    const bool more = text.next(word);
    cells.read(text, more, word);
  }
}

} // namespace

TextGrid checkTextGrid(GDALDataset& dataset, const std::string& fileName)
{
  const bool esri = isOfDriver(dataset, "AAIGrid"), grass = isOfDriver(dataset, "GRASSASCIIGrid"),
             isg = isOfDriver(dataset, "ISG"), xyz = isOfDriver(dataset, "XYZ"),
             gxf = isOfDriver(dataset, "GXF");
  if (!(esri || grass || isg || xyz || gxf))
  {
    return {};
  }
  Text text(fileName);
  if (!text.readable())
  {
    return {};
  }
  const int columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  if (xyz)
  {
    return checkXyzPoints(dataset, fileName);
  }
  GridCells cells(fileName, columns, rows);
  esri      ? checkEsri(text, cells, fileName)
    : grass ? checkGrass(text, cells)
    : isg   ? checkIsg(text, cells)
            : checkGxf(text, cells);
  return std::move(cells.result);
}

} // namespace rockfall::gis
