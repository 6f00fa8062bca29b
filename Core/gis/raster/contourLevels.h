#pragma once

/// @file
/// Lines among contours that are none: frames of drawings, and lines whose height is 0 because they
/// have none.

#include "gis/raster/contourLines.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// The heights of the lines that keep one, each once, in order.
std::vector<double> levelsOf(const Contours& contours);

/// Takes out closed rectangles at exactly 0 m that lie about all other lines, as the frame of a
/// drawing does. In what is no `drawing` it is kept if 0 m is the next height after those and no
/// other line's. A note says so.
void leaveOutFrames(Contours& contours, bool drawing, std::vector<std::string>& notes);

/// Throws DataError naming the file where lines at exactly 0 m stand off from all other heights, by
/// more than 10 m and five times the largest step between those.
void refuseStrayZeros(const Contours& contours, const std::string& fileName);

/// Lines at exactly 0 m that are let pass, and what lies beside them.
class ZeroLines
{
public:
  explicit ZeroLines(const Contours& contours);

  /// The heights of a triangle of the TIN.
  void see(const std::array<double, 3>& corners);
  /// Adds a note if 0 m is more than 10 m from the next height and more than one and a half times
  /// the largest step between the others, or if most of what lies beside it is farther off than that.
  void tell(std::vector<std::string>& notes) const;

private:
  std::int64_t lines_ = 0;
  double next_ = 0.0, largest_ = 0.0;     ///< Height next to 0, step between the others, m.
  std::int64_t beside_ = 0, farther_ = 0; ///< Triangles.
};

} // namespace rockfall::gis
