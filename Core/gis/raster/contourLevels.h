#pragma once

/// @file
/// Lines among contours that are none: frames of drawings, and lines whose height is 0 because they
/// have none.

#include "base/types.h"
#include "gis/raster/contourLines.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
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

/// Lines at exactly 0 m that are let pass, and what lies beside each of them.
class ZeroLines
{
public:
  explicit ZeroLines(const Contours& contours);

  /// A vertex of the TIN that is of this line.
  void own(std::size_t line, double x, double y);
  /// The corners of a triangle of the TIN.
  void see(const std::array<Vec3, 3>& corners);
  /// Adds a note if 0 m is more than 10 m from the next height and more than one and a half times
  /// the largest step between the others, or on lines of which most that lies beside them is farther
  /// off than that: a shore may be among them.
  void tell(std::vector<std::string>& notes) const;

private:
  struct Beside
  {
    std::int64_t all = 0, farther = 0; ///< Triangles.
  };
  double next_ = 0.0, largest_ = 0.0; ///< Height next to 0, step between the others, m.
  std::map<std::size_t, Beside> lines_;
  std::map<std::pair<double, double>, std::size_t> owners_; ///< Of vertices.
};

} // namespace rockfall::gis
