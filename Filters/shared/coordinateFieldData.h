#pragma once

/// @file
/// Coordinate system of data, as field data: TerrainCRS, its WKT, and LocalOrigin, m.

#include "base/types.h"
#include "terrain/Terrain.h"

#include <string>

class vtkFieldData;

namespace rockfall::filters
{

inline constexpr char kCrsArray[] = "TerrainCRS";
inline constexpr char kOriginArray[] = "LocalOrigin";

/// m per unit of heights and of coordinates in the slope's file; only there if one is not 1.
inline constexpr char kFileUnitsArray[] = "TerrainFileUnits";

void writeFileUnits(const FileUnits& units, vtkFieldData* fieldData);
FileUnits readFileUnits(vtkFieldData* fieldData);

/// Puts TerrainCRS alone there; nothing if `wkt` is empty, because nothing is known then.
void writeCrs(const std::string& wkt, vtkFieldData* fieldData);

/// TerrainCRS as WKT; empty if it is not there.
std::string readCrs(vtkFieldData* fieldData);

/// Throws DataError if both have a TerrainCRS and not the same one. `who` begins the message: "The
/// Rocks are".
void checkSameCrs(vtkFieldData* fieldData, const std::string& who, vtkFieldData* terrain);

/// Puts TerrainCRS and LocalOrigin there.
void writeCoordinateSystem(const std::string& wkt, const Vec3& origin, vtkFieldData* fieldData);

/// Copies TerrainCRS and LocalOrigin, for the outputs that stand in the same coordinates.
void copyCoordinateSystem(vtkFieldData* from, vtkFieldData* to);

} // namespace rockfall::filters
