#pragma once

/// @file
/// Roughness and scatter of a terrain as field data of its mesh.

#include "terrain/Terrain.h"

class vtkFieldData;

namespace rockfall::filters
{

void writeRoughness(const Terrain& terrain, vtkFieldData* fieldData);

/// `known`: what there is without an array of its own. Throws DataError if an array is not what
/// `writeRoughness` makes.
Roughness readRoughness(vtkFieldData* fieldData, const Roughness& known);
/// Of the classes of restitution; empty if they have none of their own.
std::vector<Roughness> readClassRoughness(vtkFieldData* fieldData, int classes);
DeviationPer readDeviationPer(vtkFieldData* fieldData);
/// For what the deviations of classes are drawn, where these have a say of their own.
void readClassDeviationPer(
  vtkFieldData* fieldData, MaterialClasses& restitution, MaterialClasses& joint);

} // namespace rockfall::filters
