#include "shared/roughnessFieldData.h"

#include "base/errors.h"
#include "shared/arrays.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"

#include <array>

namespace rockfall::filters
{

namespace
{

constexpr char roughnessName[] = "TerrainRoughness";
constexpr char classRoughnessName[] = "TerrainRestitutionRoughness";
constexpr char deviationPerName[] = "TerrainDeviationPer";
constexpr char restitutionPerName[] = "TerrainRestitutionDeviationPer";
constexpr char jointPerName[] = "TerrainJointDeviationPer";
constexpr double asSlope = -1.0; ///< In the place of a number of DeviationPer.
constexpr int numbersOfOne = 6;

std::array<double, numbersOfOne> numbersOf(const Roughness& r)
{
  return { r.mean, r.deviation, r.length, r.obstacles[0], r.obstacles[1], r.obstacles[2] };
}

void writePer(const MaterialClasses& classes, const char* name, vtkFieldData* fieldData)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  bool any = false;
  for (const SurfaceMaterial& m : classes.materials)
  {
    any = any || m.deviationPer;
    array->InsertNextValue(m.deviationPer ? double(*m.deviationPer) : asSlope);
  }
  if (any)
  {
    fieldData->AddArray(array);
  }
}

void readPer(vtkFieldData* fieldData, const char* name, MaterialClasses& classes)
{
  vtkDataArray* array = fieldData->GetArray(name);
  if (!array)
  {
    return; // as the slope
  }
  if (array->GetNumberOfValues() != classes.count())
  {
    throw DataError("The Terrain input's field array " + std::string(name) + " has " +
      std::to_string(array->GetNumberOfValues()) + " numbers, it must have " +
      std::to_string(classes.count()));
  }
  for (int k = 0; k < classes.count(); ++k)
  {
    const int width = array->GetNumberOfComponents();
    const double per = array->GetComponent(k / width, k % width);
    if (per != asSlope)
    {
      classes.materials[std::size_t(k)].deviationPer = deviationPerFrom(per);
    }
  }
}

/// As many tuples as there are; nothing if there is no such array.
std::vector<Roughness> readAll(vtkFieldData* fieldData, const char* name, int count)
{
  std::vector<Roughness> all;
  vtkDataArray* array = fieldData->GetArray(name);
  if (!array)
  {
    return all;
  }
  // Files may arrange one tuple as numbers.
  if (array->GetNumberOfValues() != vtkIdType(count) * numbersOfOne)
  {
    throw DataError("The Terrain input's field array " + std::string(name) + " has " +
      std::to_string(array->GetNumberOfValues()) + " numbers, it must have " +
      std::to_string(count * numbersOfOne));
  }
  const int width = array->GetNumberOfComponents();
  const auto number = [&](int k) { return array->GetComponent(k / width, k % width); };
  for (int k = 0; k < count; ++k)
  {
    const int at = k * numbersOfOne;
    all.push_back({ number(at), number(at + 1), number(at + 2),
      { number(at + 3), number(at + 4), number(at + 5) } });
    all.back().validate();
  }
  return all;
}

} // namespace

void writeRoughness(const Terrain& terrain, vtkFieldData* fieldData)
{
  addArray<vtkDoubleArray>(fieldData, roughnessName, numbersOfOne)
    ->InsertNextTuple(numbersOf(terrain.roughness()).data());
  if (!terrain.restitutionClasses().roughness.empty())
  {
    const auto classes = addArray<vtkDoubleArray>(fieldData, classRoughnessName, numbersOfOne);
    for (const Roughness& r : terrain.restitutionClasses().roughness)
    {
      classes->InsertNextTuple(numbersOf(r).data());
    }
  }
  addArray<vtkDoubleArray>(fieldData, deviationPerName)
    ->InsertNextValue(double(terrain.deviationPer()));
  writePer(terrain.restitutionClasses(), restitutionPerName, fieldData);
  writePer(terrain.jointClasses(), jointPerName, fieldData);
}

Roughness readRoughness(vtkFieldData* fieldData, const Roughness& known)
{
  const std::vector<Roughness> own = readAll(fieldData, roughnessName, 1);
  return own.empty() ? known : own.front();
}

std::vector<Roughness> readClassRoughness(vtkFieldData* fieldData, int classes)
{
  return readAll(fieldData, classRoughnessName, classes);
}

DeviationPer readDeviationPer(vtkFieldData* fieldData)
{
  vtkDataArray* array = fieldData->GetArray(deviationPerName);
  if (!array || array->GetNumberOfValues() != 1)
  {
    return DeviationPer::Iteration; // of a file from before there was a choice
  }
  return deviationPerFrom(array->GetComponent(0, 0));
}

void readClassDeviationPer(
  vtkFieldData* fieldData, MaterialClasses& restitution, MaterialClasses& joint)
{
  readPer(fieldData, restitutionPerName, restitution);
  readPer(fieldData, jointPerName, joint);
}

} // namespace rockfall::filters
