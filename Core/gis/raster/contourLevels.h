#pragma once

/// @file
/// Lines among contours that are none: frames of drawings, and lines whose height is 0 because they
/// have none.

#include "gis/raster/contourLines.h"

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

/// Adds a note if lines lie at exactly 0 m, more than 10 m from the next height and more than one
/// and a half times the largest step between the others.
void noteZeros(const Contours& contours, std::vector<std::string>& notes);

} // namespace rockfall::gis
