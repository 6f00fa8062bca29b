#include "shared/coordinateFieldData.h"

#include "base/errors.h"
#include "gis/layers/sources.h"
#include "shared/arrays.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkStringArray.h"

namespace rockfall::filters
{

void writeCrs(const std::string& wkt, vtkFieldData* fieldData)
{
  if (!wkt.empty())
  {
    addArray<vtkStringArray>(fieldData, kCrsArray)->InsertNextValue(wkt);
  }
}

std::string readCrs(vtkFieldData* fieldData)
{
  auto* crs = vtkStringArray::SafeDownCast(fieldData->GetAbstractArray(kCrsArray));
  return crs && crs->GetNumberOfValues() > 0 ? std::string(crs->GetValue(0)) : std::string();
}

void writeFileUnits(const FileUnits& units, vtkFieldData* fieldData)
{
  if (units.heights != 1.0 || units.plan != 1.0)
  {
    const double both[] = { units.heights, units.plan };
    addArray<vtkDoubleArray>(fieldData, kFileUnitsArray, 2)->InsertNextTuple(both);
  }
}

FileUnits readFileUnits(vtkFieldData* fieldData)
{
  vtkDataArray* both = fieldData->GetArray(kFileUnitsArray);
  return both && both->GetNumberOfComponents() == 2 && both->GetNumberOfTuples() == 1
    ? FileUnits{ both->GetComponent(0, 0), both->GetComponent(0, 1) }
    : FileUnits{};
}

void checkSameCrs(vtkFieldData* fieldData, const std::string& who, vtkFieldData* terrain)
{
  const std::string own = readCrs(fieldData), ground = readCrs(terrain);
  if (own != ground && !sameCrs(own, ground))
  {
    throw DataError(
      who + " in " + labelOfCrs(own) + ", but the Terrain is in " + labelOfCrs(ground));
  }
  if (const std::string heights = own == ground ? std::string() : differentHeights(own, ground);
      !heights.empty())
  {
    throw DataError(who + " in another height system than the Terrain: their heights refer to " +
      heights + "; connect the Terrain where the layer is read, which brings them to its own");
  }
}

void writeCoordinateSystem(const std::string& wkt, const Vec3& origin, vtkFieldData* fieldData)
{
  addArray<vtkStringArray>(fieldData, kCrsArray)->InsertNextValue(wkt);
  addArray<vtkDoubleArray>(fieldData, kOriginArray, 3)->InsertNextTuple(origin.data());
}

void copyCoordinateSystem(vtkFieldData* from, vtkFieldData* to)
{
  for (const char* name : { kCrsArray, kOriginArray })
  {
    if (vtkAbstractArray* array = from->GetAbstractArray(name))
    {
      to->AddArray(array);
    }
  }
}

} // namespace rockfall::filters
