#pragma once

/// @file
/// Units of arrays as files name them, and the styles with which QGIS opens layers of a GeoPackage.

#include "gis/layers/layerWriter.h"

#include <string>
#include <vector>

namespace rockfall::filters
{

/// By how an array's name begins; empty without a unit.
std::string unitOf(const std::string& array);

/// QML: paths as red lines, ends by what became of the rock, points by their energy in kJ in the
/// classes of Examples/study_parts/gis.py; every attribute's unit behind its name.
std::string layerStyle(const std::string& layer, const std::vector<LayerField>& fields);

} // namespace rockfall::filters
