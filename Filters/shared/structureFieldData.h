#pragma once

/// @file
/// How embankments, trees and barriers travel with the slope: as a map has them, so that whoever
/// reads them builds the same obstacles.
///
/// | array                     | what, per tuple                                                  |
/// |---------------------------|------------------------------------------------------------------|
/// | TerrainEmbankments        | feature, height (m), elevation (m), width of the crest (m),      |
/// |                           | slopes of the mountain and the valley side, material, points     |
/// | TerrainEmbankmentPoints   | x, y in the local frame, m                                       |
/// | TerrainTrees              | feature, x, y, diameter (m), height (m), capacity (J), material  |
/// | TerrainLyingStems         | number of the tuple in TerrainTrees, x, y of its other end       |
/// | TerrainBarriers           | feature, height (m), capacity (J), absorbs, records, overhang,   |
/// |                           | braking distance (m), residual height, room (m³/m), points       |
/// | TerrainBarrierPoints      | x, y in the local frame, m                                       |
/// | TerrainStructureMaterials | restitution, its deviation, its model, tangential restitution,   |
/// |                           | speed (m/s), φ (rad), its deviation (rad), cohesion (N)          |
///
/// An embankment that has a height has no elevation, which is then 0, and the other way round; a
/// capacity or a room without limit is −1, and so is the residual height of what does not wear: VTK's XML readers do not understand their writers' "nan" and
/// "inf".

#include "terrain/Terrain.h"
#include "terrain/structures.h"

#include "vtkType.h"

class vtkFieldData;
class vtkPolyData;

namespace rockfall::filters
{

/// Nothing if there are none.
void writeStructures(const Terrain& terrain, vtkFieldData* fieldData);

/// Takes all their arrays out.
void dropStructures(vtkFieldData* fieldData);

/// None if there are no such arrays. Throws DataError if they do not belong together.
Structures readStructures(vtkFieldData* fieldData);

/// Structures on the slope as triangles and quads in world coordinates, with the cell arrays
/// StructureKind (0 embankment, 1 tree, 2 barrier), StructureId (number in its layer) and CFEId (0
/// for barriers, which are no CFEs). Trees take at most `mostCells` triangles: of more, every
/// second, third … is there, which is what is returned; else 1.
int makeStructureMesh(const Terrain& terrain, vtkIdType mostCells, vtkPolyData* mesh);

} // namespace rockfall::filters
