#include "vtkRockAlgorithm.h"

#include "base/RockMaterial.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/streamingPieces.h"
#include "shared/withAbort.h"
#include "sources/rockMaker.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

namespace
{

constexpr int TERRAIN = 1, SHAPE = 2;

} // namespace

//------------------------------------------------------------------------------
vtkRockAlgorithm::vtkRockAlgorithm()
{
  this->SetNumberOfInputPorts(3);
}

//------------------------------------------------------------------------------
vtkRockAlgorithm::~vtkRockAlgorithm() = default;

//------------------------------------------------------------------------------
int vtkRockAlgorithm::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkRockAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  using namespace rockfall::filters;
  if (isFurtherPiece(outputVector))
  {
    return 1;
  }
  Input terrainInput(InputKind::Terrain), shapeInput(InputKind::Shape);
  vtkPolyData* terrain = terrainInput.take(inputVector[TERRAIN]);
  vtkPolyData* shape = shapeInput.take(inputVector[SHAPE]);
  if ((terrain && inheritFailure(terrain, this)) || (shape && inheritFailure(shape, this)))
  {
    return 1;
  }
  return withAbort(this, "The rock blocks do not fit in memory",
    [&]
    {
      terrainInput.require();
      shapeInput.require();
      vtkNew<vtkPolyData> blocks;
      if (terrain)
      {
        keepNotes(notesOf(terrain->GetFieldData()), blocks->GetFieldData()); // to the simulation
      }
      this->MakeBlocks(terrain, shape, blocks);
      vtkPolyData::GetData(outputVector)->ShallowCopy(blocks);
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkRockAlgorithm::CheckSeed() const
{
  if (this->Seed < 0)
  {
    rockfall::filters::refuseProperty("Seed", this->Seed, "at least 0");
  }
}

//------------------------------------------------------------------------------
void vtkRockAlgorithm::FindIdleOfMaterial(rockfall::filters::IdleProperties& idle) const
{
  const auto materials = rockfall::rockMaterials();
  if (this->Material < 1 || this->Material > int(materials.size()))
  {
    return;
  }
  const rockfall::RockMaterial& material = materials[std::size_t(this->Material) - 1];
  const rockfall::filters::RockDefaults usual;
  const auto tell = [&](const char* name, double value, double otherwise, double ofMaterial)
  {
    idle.addTo("The Material replaces what these properties say", name, value,
      value == ofMaterial ? value : otherwise);
  };
  tell("Density", this->Density, usual.density, material.density);
  tell("YoungModulus", this->YoungModulus, usual.youngModulus, material.youngModulus);
  tell("PoissonRatio", this->PoissonRatio, usual.poissonRatio, material.poissonRatio);
}

//------------------------------------------------------------------------------
void vtkRockAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto printVector = [&](const char* name, const double v[3])
  { os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << "\n"; };
  const auto printName = [&](const char* name, const std::string& text)
  { os << indent << name << ": " << (text.empty() ? "(none)" : text) << "\n"; };
  printVector("Center", this->Center);
  printVector("Lengths", this->Lengths);
  printVector("Orientation", this->Orientation);
  printVector("Velocity", this->Velocity);
  os << indent << "Material: " << this->Material << "\n";
  printName("MaterialName", this->MaterialName);
  os << indent << "Density: " << this->Density << "\n";
  os << indent << "YoungModulus: " << this->YoungModulus << "\n";
  os << indent << "PoissonRatio: " << this->PoissonRatio << "\n";
  os << indent << "PlaceOnGround: " << this->PlaceOnGround << "\n";
  os << indent << "ReleaseHeight: " << this->ReleaseHeight << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "MaximumRocks: " << this->MaximumRocks << "\n";
  printName("SourceName", this->SourceName);
  os << indent << "FirstBlockId: " << this->FirstBlockId << "\n";
}
