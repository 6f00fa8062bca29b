#pragma once

/// @file
/// Holes of nodata in the slope, which are not its edge.

namespace rockfall
{

class Terrain;

/// Whether there is no CFE at a place on the map, in the local frame, but ground on two opposite
/// sides of it: a pond, a seam between two tiles. Nodata without ground behind, as the corners of a
/// turned raster, is the map's edge.
bool isHole(const Terrain& terrain, double x, double y);

} // namespace rockfall
