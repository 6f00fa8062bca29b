#pragma once

/// @file
/// How the implicit slope travels through the pipeline: as field data of the polydata that shows
/// it.
///
/// | array            | what                                                                      |
/// |------------------|---------------------------------------------------------------------------|
/// | TerrainHeights   | rows × columns node heights, north row first, NaN for nodata, m           |
/// | TerrainGrid      | columns, rows, cell size (m), easting and northing of the south-west node |
/// |                  | (m), stride of the shown mesh (1 = every CFE is shown)                    |
/// | TerrainCellDiagonal | number of the cut of its cells                                         |
/// | TerrainCRS       | WKT of the coordinate system, empty for a local one; with a vertical part |
/// |                  | if the file says what its heights refer to                                |
/// | TerrainFileUnits | m per unit of heights and of coordinates in the slope's file; only if one  |
/// |                  | is not 1                                                                  |
/// | TerrainMaterial  | restitution, its deviation, φ (rad), its deviation, cohesion (N),         |
/// |                  | roughness mean and deviation (m), number of the restitution model,        |
/// |                  | tangential restitution, speed of the speed-dependent model (m/s). Files   |
/// |                  | of before there were models end with the roughness: whole velocity        |
/// | TerrainYielding  | per class, the slope's own first, the parameters of yielding ground       |
/// | LocalOrigin      | world = local + origin, m                                                 |
///
/// Only where there are classes:
///
/// | array                     | what                                                             |
/// |---------------------------|------------------------------------------------------------------|
/// | TerrainRestitutionClass   | class per cell, row by row from the north, one byte; 0: the      |
/// |                           | material above                                                   |
/// | TerrainRestitutionClasses | per class restitution, its deviation, number of the model,       |
/// |                           | tangential restitution, speed (m/s)                              |
/// | TerrainRestitutionNames   | names of the classes                                             |
/// | TerrainJointClass, …      | the same of φ (rad), its deviation, cohesion (N)                 |
///
/// Embankments, trees and barriers: structureFieldData.h.
///
/// Rocks and results carry a reference instead, and trajectories the heights under them
/// (slopeReference.h).
///
/// Arrays, so that it survives shallow copies and saving and reopening as .vtp. The heights are
/// never copied: the array shares the Core's memory on the way out, the Core the array's on the way
/// in.

#include "shared/coordinateFieldData.h"
#include "terrain/Terrain.h"

#include <memory>
#include <optional>
#include <string>

class vtkFieldData;
class vtkPolyData;

namespace rockfall::filters
{

/// Puts the slope into `fieldData`; the arrays keep `terrain` alive.
void writeTerrain(std::shared_ptr<const Terrain> terrain, int stride, vtkFieldData* fieldData);

/// Takes the slope out of a polydata's field data. Throws DataError if there is none, or if the
/// mesh was moved, clipped or otherwise changed since it was made, so that what the user sees is
/// not what the rocks would fall on. Without `withMesh` the field data are all that is looked at.
Terrain readTerrain(vtkPolyData* mesh, bool withMesh = true);

/// Takes out all arrays of a slope, or of a reference to one, but for the CRS.
void dropTerrain(vtkFieldData* data);

/// Whether a slope came with the data, or they refer to one that is at hand.
bool hasTerrain(vtkFieldData* fieldData);

/// The slope that trajectories fell on: that of `mesh`, which may be null, else the one that they
/// refer to, or what their file kept of it, if any. Throws DataError as readTerrain and
/// checkSameCrs, and where the file did not keep enough.
std::optional<Terrain> slopeUnder(vtkPolyData* trajectories, vtkPolyData* mesh);

} // namespace rockfall::filters
