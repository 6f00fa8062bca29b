// Grids that are written as points, one a line.
#include "gis/raster/textGrid.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "base/text/tableText.h"
#include "gis/base/gdal.h"
#include "gis/base/textWords.h"

#include <cpl_conv.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace rockfall::gis
{

namespace
{

/// At most one of so many nodes may have a point, or else it is no grid.
constexpr double mostMissing = 100.0;
constexpr double fewXyzNodes = 1e5; // nobody minds
constexpr double shortest = 6.0;    // bytes of a line, as "1 2 3"
/// Points may be so far from their nodes, in cells.
constexpr double onNodeWithin = 0.02;

/// Whether the commas of a line are decimal ones: something else stands between its numbers.
bool hasDecimalCommas(const std::string& line)
{
  if (line.find(',') == std::string::npos)
  {
    return false;
  }
  const auto isBlank = [](char c) { return c == ' ' || c == '\t'; };
  for (std::size_t i = 1; i + 1 < line.size(); ++i)
  {
    if (line[i] == ';' ||
      (isBlank(line[i]) && line[i - 1] != ',' && !isBlank(line[i - 1]) && line[i + 1] != ',' &&
        !isBlank(line[i + 1])))
    {
      return true;
    }
  }
  return false;
}

/// The words of a line of an XYZ file: blanks may be many, a comma or semicolon stands for one.
void takeWords(const std::string& line, std::vector<std::string_view>& words)
{
  const bool decimal = hasDecimalCommas(line);
  words.assign(1, {});
  bool separated = false; // by blanks alone since the last word
  for (const char& c : line)
  {
    if (c == ' ' || c == '\t')
    {
      if (!words.back().empty())
      {
        words.emplace_back();
        separated = true;
      }
    }
    else if ((c == ',' && !decimal) || c == ';')
    {
      if (!separated || words.back().size())
      {
        words.emplace_back();
      }
      separated = false;
    }
    else
    {
      std::string_view& word = words.back();
      word = { word.empty() ? &c : word.data(), word.size() + 1 };
      separated = false;
    }
  }
  if (words.back().empty())
  {
    words.pop_back();
  }
}

/// A word with a point or a comma as decimal mark.
std::optional<double> numberIn(std::string_view word)
{
  if (const auto plain = parsedNumber(word))
  {
    return plain;
  }
  std::string text(word);
  std::replace(text.begin(), text.end(), ',', '.');
  return isNumber(text) ? std::optional(CPLAtof(text.c_str())) : std::nullopt;
}

/// The points of an XYZ file, one a line. The first line may be a header that says in which columns
/// the coordinates are. GDAL reads nodes without a point as 0, or as a number that it declares but
/// the band cannot hold.
class Points
{
public:
  Points(GDALDataset& dataset, const std::string& fileName)
    : fileName_(fileName)
    , columns_(dataset.GetRasterXSize())
    , rows_(dataset.GetRasterYSize())
  {
    dataset.GetGeoTransform(affine_);
  }

  TextGrid check()
  {
    Text text(fileName_);
    VSIStatBufL status;
    if (!text.readable() || VSIStatL(fileName_.c_str(), &status) != 0)
    {
      return {};
    }
    this->requireEnough("at most ", double(status.st_size) / shortest);
    std::string line;
    std::vector<std::string_view> words;
    for (std::int64_t number = 1; text.line(line); ++number)
    {
      if (line.empty() || line[0] == '#' || line[0] == '/')
      {
        continue;
      }
      takeWords(line, words);
      if (number == 1 && !words.empty() && !numberIn(words[0]))
      {
        this->readHeader(words);
      }
      else if (!words.empty())
      {
        ++points_;
        this->findNode(line, words, number);
      }
    }
    this->requireEnough("", double(points_));
    TextGrid result;
    if (std::find(found_.begin(), found_.end(), 0) != found_.end())
    {
      result.ownNulls = true;
      for (std::uint8_t& found : found_)
      {
        found = !found;
      }
      result.nulls = std::move(found_);
    }
    return result;
  }

private:
  std::size_t needed() const { return std::max({ at_[0], at_[1], at_[2] }) + 1; }

  void readHeader(const std::vector<std::string_view>& words)
  {
    const std::initializer_list<const char*> names[] = { { "x", "lon", "east" },
      { "y", "lat", "north" }, { "z", "alt", "height" } };
    for (std::size_t k = 0; k < words.size(); ++k)
    {
      const std::string word = nameKey(trimmed(words[k]));
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        for (const char* name : names[axis])
        {
          at_[axis] = word.starts_with(name) ? k : at_[axis];
        }
      }
    }
  }

  void findNode(
    const std::string& line, const std::vector<std::string_view>& words, std::int64_t number)
  {
    const auto fail = [&](const std::string& what)
    { throw DataError(lineName(fileName_, std::size_t(number)) + ": " + what); };
    if (words.size() < needed())
    {
      fail("\"" + line + "\" is no point: it has " + std::to_string(words.size()) +
        " numbers, x, y and z are needed");
    }
    double place[3] = {};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const std::string_view word = words[at_[axis]];
      const auto value = numberIn(word);
      if (!value)
      {
        fail("\"" + std::string(word) + "\" is not a number");
      }
      place[axis] = *value;
    }
    if (found_.empty())
    {
      found_.assign(std::size_t(columns_) * std::size_t(rows_), 0);
    }
    const double column = (place[0] - affine_[0]) / affine_[1] - 0.5;
    const double row = (place[1] - affine_[3]) / affine_[5] - 0.5;
    if (std::abs(column - std::round(column)) > onNodeWithin ||
      std::abs(row - std::round(row)) > onNodeWithin)
    {
      fail("the point " + gis::number(place[0]) + ", " + gis::number(place[1]) +
        " is on no node of a grid of even steps, as the first lines make one");
    }
    if (column > -0.5 && column < columns_ - 0.5 && row > -0.5 && row < rows_ - 0.5)
    {
      found_[std::size_t(std::round(row)) * std::size_t(columns_) +
        std::size_t(std::round(column))] = 1;
    }
  }

  /// Before and after they are read.
  void requireEnough(const char* most, double points) const
  {
    const double nodes = double(columns_) * rows_;
    if (nodes > fewXyzNodes && nodes > mostMissing * points)
    {
      throw FileError(fileName_ + ": its " + most + gis::number(std::floor(points)) +
        " points make a grid of " + sizeText(columns_, rows_) +
        " nodes, nearly all of them without a height; it is no grid, or some of its points are "
        "wrong");
    }
  }

  const std::string& fileName_;
  int columns_, rows_;
  double affine_[6] = { 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 };
  std::size_t at_[3] = { 0, 1, 2 }; // columns of x, y and z
  std::int64_t points_ = 0;
  std::vector<std::uint8_t> found_; // per node
};

} // namespace

TextGrid checkXyzPoints(GDALDataset& dataset, const std::string& fileName)
{
  return Points(dataset, fileName).check();
}

} // namespace rockfall::gis
