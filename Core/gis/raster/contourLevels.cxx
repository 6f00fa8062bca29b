#include "gis/raster/contourLevels.h"

#include "base/errors.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

namespace rockfall::gis
{

namespace
{

constexpr double largestStep = 5.0; // times the largest one between the other heights
constexpr double leastStep = 10.0;  // m
constexpr double frameStep = 1.5;   // times the largest one: of a frame, and for a note

bool isAt(const Contours& contours, const Line& line, double z)
{
  const auto first = contours.z.begin() + std::ptrdiff_t(line.first);
  return std::all_of(
    first, first + std::ptrdiff_t(line.count), [z](double value) { return value == z; });
}

Eigen::AlignedBox2d boundsOf(const Contours& contours, const Line& line)
{
  Eigen::AlignedBox2d box;
  for (std::size_t i = line.first; i < line.first + line.count; ++i)
  {
    box.extend(Eigen::Vector2d(contours.x[i], contours.y[i]));
  }
  return box;
}

/// A closed line of four corners, all of them right angles.
bool isRectangle(const Contours& contours, const Line& line)
{
  std::vector<std::array<double, 2>> corners;
  for (std::size_t i = line.first; i < line.first + line.count; ++i)
  {
    const std::array<double, 2> place = { contours.x[i], contours.y[i] };
    if (corners.empty() || corners.back() != place)
    {
      corners.push_back(place);
    }
  }
  if (corners.size() != 5 || corners.front() != corners.back())
  {
    return false;
  }
  for (std::size_t k = 0; k < 4; ++k)
  {
    const auto &a = corners[(k + 3) % 4], &b = corners[k], &c = corners[k + 1];
    const double ux = a[0] - b[0], uy = a[1] - b[1], vx = c[0] - b[0], vy = c[1] - b[1];
    if (std::abs(ux * vx + uy * vy) > 1e-3 * std::hypot(ux, uy) * std::hypot(vx, vy))
    {
      return false;
    }
  }
  return true;
}

void erase(Contours& contours, std::size_t number)
{
  const Line line = contours.lines[number];
  for (std::vector<double>* values : { &contours.x, &contours.y, &contours.z })
  {
    const auto first = values->begin() + std::ptrdiff_t(line.first);
    values->erase(first, first + std::ptrdiff_t(line.count));
  }
  contours.lines.erase(contours.lines.begin() + std::ptrdiff_t(number));
  for (std::size_t k = number; k < contours.lines.size(); ++k)
  {
    contours.lines[k].first -= line.count;
  }
}

/// Of the heights of lines that keep one.
struct Steps
{
  std::size_t others = 0;             ///< Heights other than 0.
  double lowest = 0.0, highest = 0.0; ///< Of those.
  double largest = 0.0;               ///< Step between those.
  double ofZero = 0.0;                ///< From 0 to the next; 0 if no line is at 0.

  explicit Steps(const Contours& contours)
  {
    std::vector<double> levels = levelsOf(contours);
    const auto zero = std::lower_bound(levels.begin(), levels.end(), 0.0);
    if (zero == levels.end() || *zero != 0.0 || levels.size() < 2)
    {
      return;
    }
    ofZero = std::numeric_limits<double>::infinity();
    ofZero = zero != levels.begin() ? std::min(ofZero, -*std::prev(zero)) : ofZero;
    ofZero = std::next(zero) != levels.end() ? std::min(ofZero, *std::next(zero)) : ofZero;
    levels.erase(zero);
    others = levels.size();
    lowest = levels.front();
    highest = levels.back();
    for (std::size_t k = 1; k < levels.size(); ++k)
    {
      largest = std::max(largest, levels[k] - levels[k - 1]);
    }
  }
};

std::int64_t linesAtZero(const Contours& contours)
{
  return std::count_if(contours.lines.begin(), contours.lines.end(),
    [&](const Line& line) { return isAt(contours, line, 0.0); });
}

} // namespace

std::vector<double> levelsOf(const Contours& contours)
{
  std::vector<double> levels;
  for (const Line& line : contours.lines)
  {
    if (isAt(contours, line, contours.z[line.first]))
    {
      levels.push_back(contours.z[line.first]);
    }
  }
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

void leaveOutFrames(Contours& contours, bool drawing, std::vector<std::string>& notes)
{
  for (std::size_t k = 0; k < contours.lines.size(); ++k)
  {
    if (!isAt(contours, contours.lines[k], 0.0) || !isRectangle(contours, contours.lines[k]))
    {
      continue;
    }
    const Eigen::AlignedBox2d frame = boundsOf(contours, contours.lines[k]);
    bool about = contours.lines.size() > 1, higher = false, another = false;
    for (std::size_t other = 0; other < contours.lines.size() && about; ++other)
    {
      about = frame.contains(boundsOf(contours, contours.lines[other]));
      const bool low = isAt(contours, contours.lines[other], 0.0);
      higher = higher || !low;
      another = another || (low && other != k);
    }
    if (!about || !higher)
    {
      continue;
    }
    // The foot of a pyramid is a rectangle at the next height.
    const Steps steps(contours);
    if (!drawing && !another && steps.ofZero <= frameStep * steps.largest)
    {
      notes.push_back(
        "A closed rectangle at 0 m about all other lines was taken as a contour; is it "
        "the frame of a drawing?");
      continue;
    }
    erase(contours, k--);
    notes.push_back("A closed rectangle at 0 m about all other lines was taken for the frame of a "
                    "drawing and left out.");
  }
}

void refuseStrayZeros(const Contours& contours, const std::string& fileName)
{
  const Steps steps(contours);
  if (steps.others >= 3 && steps.ofZero > leastStep && steps.ofZero > largestStep * steps.largest)
  {
    const auto count = linesAtZero(contours);
    throw DataError(fileName + ": " + std::to_string(count) +
      (count == 1 ? " line lies" : " lines lie") + " at exactly 0 m, all others between " +
      number(steps.lowest) + " m and " + number(steps.highest) + " m in steps of up to " +
      number(steps.largest) +
      " m: a frame, or lines without a height? Leave them out of the file, or name the layer of "
      "the contours in LayerName");
  }
}

void noteZeros(const Contours& contours, std::vector<std::string>& notes)
{
  const Steps steps(contours);
  if (steps.ofZero > leastStep && steps.ofZero > frameStep * steps.largest)
  {
    const auto count = linesAtZero(contours);
    notes.push_back(std::to_string(count) + (count == 1 ? " line lies" : " lines lie") +
      " at exactly 0 m, " + number(steps.ofZero) +
      " m from the next height: has a contour no height?");
  }
}

} // namespace rockfall::gis
