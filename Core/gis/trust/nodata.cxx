#include "gis/trust/nodata.h"

#include "base/abort.h"
#include "base/text/plainText.h"
#include "gis/trust/headers.h"
#include "gis/trust/heightUnit.h"

#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>

namespace rockfall::gis
{

namespace
{

/// The numbers in "{-999,-888}", "-999;-888" or "-999".
std::vector<double> numbersOf(const char* text)
{
  std::vector<double> numbers;
  std::string word;
  for (const char c : std::string(text ? text : "") + ",")
  {
    if (c != ',' && c != ';' && c != '{' && c != '}' && c != ' ')
    {
      word += c;
      continue;
    }
    if (const auto number = parsedNumber(word))
    {
      numbers.push_back(*number);
    }
    word.clear();
  }
  return numbers;
}

/// Cells whose heights are near each other.
struct Group
{
  std::int64_t count = 0;
  double low = 0.0, high = 0.0; // m

  double range() const { return high - low; }
};

constexpr double split = 10.0;  // m; heights so far apart begin another group
constexpr double nearby = 50.0; // m; no gap of a slope that anybody would look at twice

/// Groups from the lowest to the highest.
std::vector<Group> groupsOf(const std::vector<double>& heights)
{
  constexpr int bins = int((kHighest - kDeepest) / split) + 1;
  std::vector<Group> all(bins);
  std::size_t seen = 0;
  for (const double height : heights)
  {
    if (++seen % 65536 == 0)
    {
      stayWanted();
    }
    if (!(height >= kDeepest && height <= kHighest))
    {
      continue;
    }
    Group& bin = all[std::size_t((height - kDeepest) / split)];
    bin.low = bin.count > 0 ? std::min(bin.low, height) : height;
    bin.high = bin.count > 0 ? std::max(bin.high, height) : height;
    ++bin.count;
  }
  std::vector<Group> groups;
  for (const Group& bin : all)
  {
    if (bin.count == 0)
    {
      continue;
    }
    if (groups.empty() || bin.low - groups.back().high > split)
    {
      groups.push_back(bin);
      continue;
    }
    groups.back().high = bin.high;
    groups.back().count += bin.count;
  }
  return groups;
}

/// Whether a number is one that programs write for no data.
bool isUsualMark(double raw)
{
  constexpr std::array marks = { -99999.0, -32768.0, -32767.0, -9999.0, -9998.0, -8888.0, -1000.0,
    -999.0, -888.0, -500.0, -99.0, -88.0, 99.0, 999.0, 9999.0, 32767.0, 65535.0, 99999.0 };
  return std::any_of(marks.begin(), marks.end(),
    [raw](double mark)
    {
      return std::abs(raw - mark) <= 1e-6 * std::abs(mark) ||
        (std::trunc(raw) == mark && std::abs(raw - mark) > 0.8);
    }); // −999.9 and the like
}

} // namespace

Nodata::Nodata(GDALDataset& dataset, GDALRasterBand& band, const Heights& heights)
  : single_(band.GetRasterDataType() == GDT_Float32)
  , heights_(heights)
  , least_(-std::numeric_limits<double>::infinity())
  , most_(std::numeric_limits<double>::infinity())
{
  int has = 0;
  const double value = band.GetNoDataValue(&has);
  if (has)
  {
    values_.push_back(value);
  }
  if (isOfDriver(dataset, "netCDF"))
  {
    for (const char* name : { "_FillValue", "missing_value" })
    {
      for (const double number : numbersOf(band.GetMetadataItem(name)))
      {
        values_.push_back(number);
      }
    }
    // Bytes may be unsigned by an attribute of their own; GDAL sees to these.
    if (band.GetRasterDataType() != GDT_Byte)
    {
      const auto least = numbersOf(band.GetMetadataItem("valid_min"));
      const auto most = numbersOf(band.GetMetadataItem("valid_max"));
      const auto both = numbersOf(band.GetMetadataItem("valid_range"));
      least_ = both.size() == 2 ? both[0] : !least.empty() ? least[0] : least_;
      most_ = both.size() == 2 ? both[1] : !most.empty() ? most[0] : most_;
    }
  }
  if (const Header saga = sagaHeader(dataset); saga.count("nodata_value"))
  {
    const auto range = numbersOf(saga.at("nodata_value").c_str());
    if (range.size() == 2)
    {
      ranges_.emplace_back(std::min(range[0], range[1]), std::max(range[0], range[1]));
    }
  }
}

bool Nodata::matches(double raw, double declared) const
{
  if (raw == declared)
  {
    return true;
  }
  const double apart = std::abs(raw - declared);
  // Single precision: the value was written as a decimal number, −9999.9 or the famous
  // −3.4028235e38, which do not come back as the float that stands in the cells.
  if (single_ && apart <= 2.0 * FLT_EPSILON * std::abs(declared))
  {
    return true;
  }
  // A number that is no height anyway may have been rounded to six digits, 1.70141e+38, and the
  // extremes of double precision beyond what it holds.
  const double height = heights_.metres(raw);
  if (height >= kDeepest && height <= kHighest)
  {
    return false;
  }
  const auto held = [](double x) { return std::clamp(x, -DBL_MAX, DBL_MAX); };
  // Halves, because the difference of two extremes is infinite.
  return std::abs(0.5 * held(raw) - 0.5 * held(declared)) <= 0.5e-5 * std::abs(held(declared));
}

bool Nodata::operator()(double raw) const
{
  if (std::isnan(raw))
  {
    return std::any_of(
      values_.begin(), values_.end(), [](double value) { return std::isnan(value); });
  }
  return raw < least_ || raw > most_ ||
    std::any_of(values_.begin(), values_.end(),
      [&](double value) { return !std::isnan(value) && this->matches(raw, value); }) ||
    std::any_of(ranges_.begin(), ranges_.end(),
      [raw](const auto& range) { return raw >= range.first && raw <= range.second; });
}

void noteMarks(const std::vector<double>& heights, const Heights& meaning, const std::string& what,
  const std::string& remedy, std::vector<std::string>& notes)
{
  const std::vector<Group> groups = groupsOf(heights);
  if (groups.size() < 2)
  {
    return;
  }
  const auto rawOf = [&](double height)
  {
    const double raw = (height - meaning.offset) / meaning.scale;
    return std::abs(raw - std::round(raw)) < 1e-6 * std::abs(raw) ? std::round(raw) : raw;
  };
  const auto isMark = [&](const Group& group)
  { return group.range() == 0.0 && isUsualMark(rawOf(group.low)); };
  // The ground: the most cells that are not all alike, and what goes on from there.
  std::size_t first = 0;
  const auto better = [&](const Group& a, const Group& b)
  {
    const bool aGround = a.range() > 0.0, bGround = b.range() > 0.0;
    return aGround != bGround ? aGround : isMark(a) != isMark(b) ? !isMark(a) : a.count > b.count;
  };
  for (std::size_t k = 1; k < groups.size(); ++k)
  {
    first = better(groups[k], groups[first]) ? k : first;
  }
  std::size_t last = first;
  Group ground = groups[first];
  for (bool grown = true; grown;)
  {
    grown = false;
    const double reach = std::max(nearby, ground.range());
    if (first > 0 && ground.low - groups[first - 1].high <= reach && !isMark(groups[first - 1]))
    {
      ground.low = groups[--first].low;
      grown = true;
    }
    if (last + 1 < groups.size() && groups[last + 1].low - ground.high <= reach &&
      !isMark(groups[last + 1]))
    {
      ground.high = groups[++last].high;
      grown = true;
    }
  }
  // One note for all of them, those of most cells first.
  std::vector<Group> apart;
  for (std::size_t k = 0; k < groups.size(); ++k)
  {
    if (k < first || k > last)
    {
      apart.push_back(groups[k]);
    }
  }
  if (apart.empty())
  {
    return;
  }
  std::stable_sort(
    apart.begin(), apart.end(), [](const Group& a, const Group& b) { return a.count > b.count; });
  constexpr std::size_t mostNamed = 4;
  std::string text;
  std::int64_t others = 0;
  for (std::size_t k = 0; k < apart.size(); ++k)
  {
    const Group& group = apart[k];
    if (k >= mostNamed)
    {
      others += group.count;
      continue;
    }
    const bool below = group.high < ground.low;
    text += (k > 0 ? "; " : "") + std::to_string(group.count) + (k > 0 ? "" : " " + what) +
      (group.range() == 0.0
          ? " are exactly " + number(group.low) + " m, "
          : " are between " + number(group.low) + " and " + number(group.high) + " m, ") +
      number(below ? ground.low - group.high : group.low - ground.high) + " m " +
      (below ? "below" : "above") + " the ground" +
      (k > 0 ? "" : " of " + number(ground.low) + " to " + number(ground.high) + " m");
  }
  notes.push_back(text + (others > 0 ? "; and " + std::to_string(others) + " more" : "") +
    ". If that stands for no data, " + remedy +
    (remedy.ends_with(' ') ? exactly(rawOf(apart.front().low)) + " says so" : ""));
}

} // namespace rockfall::gis
