#include "vtkDEMToCFESource.h"

#include "base/require.h"
#include "base/text/numberText.h"
#include "geometry/shell.h"
#include "gis/base/externalReferences.h"
#include "gis/forest/standRaster.h"
#include "gis/layers/structureLayers.h"
#include "gis/raster/contours.h"
#include "gis/raster/ground.h"
#include "gis/raster/raster.h"
#include "shared/arrays.h"
#include "shared/errorReport.h"
#include "shared/structureFieldData.h"
#include "shared/terrainFieldData.h"
#include "shared/terrainMesh.h"
#include "shared/withAbort.h"
#include "terrain/Terrain.h"
#include "terrain/plausible.h"
#include "terrain/presets.h"

#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <iterator>

vtkStandardNewMacro(vtkDEMToCFESource);

namespace
{

constexpr double testSlopeCellSize = 5.0; // m
constexpr char groundName[] = "Ground";   // field array: the ground in words

} // namespace

//------------------------------------------------------------------------------
vtkDEMToCFESource::vtkDEMToCFESource()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

//------------------------------------------------------------------------------
vtkDEMToCFESource::~vtkDEMToCFESource() = default;

//------------------------------------------------------------------------------
rockfall::SurfaceMaterial vtkDEMToCFESource::MakeMaterial() const
{
  const auto presets = rockfall::groundPresets();
  if (this->Preset < 0 || this->Preset > int(presets.size()))
  {
    throw rockfall::ParameterError("Preset is " + std::to_string(this->Preset) +
      ", it must be 0 (none) to " + std::to_string(presets.size()));
  }
  rockfall::SurfaceMaterial material;
  material.restitution = this->RestitutionCoefficient;
  material.restitutionDeviation = this->RestitutionDeviation;
  material.restitutionModel = rockfall::RestitutionModel(this->RestitutionModel);
  material.tangentialRestitution = this->TangentialRestitution;
  material.restitutionSpeed = this->RestitutionSpeed;
  material.frictionAngle = rockfall::radians(this->FrictionAngle);
  material.frictionAngleDeviation = rockfall::radians(this->FrictionAngleDeviation);
  material.cohesion = this->Cohesion;
  const double yielding[] = { this->GroundModulus, this->ScarDepthFactor, this->GroundDensity,
    this->ScarCompaction, this->ScarSpinDrag, this->SlipFrictionMin, this->SlipFrictionMax,
    this->SlipFrictionGrowth, this->SlipFrictionDecay, this->RollingResistance,
    this->GroundDeviation, this->GroundDeviationLength, this->ScarRadius };
  const auto fields = rockfall::yieldingFields();
  for (std::size_t k = 0; k < fields.size(); ++k)
  {
    fields[k].set(material.yielding, yielding[k]);
  }
  if (this->Preset > 0)
  {
    material.validate(); // what it replaces must not be wrong in silence
    material = presets[std::size_t(this->Preset) - 1].material();
    material.cohesion = this->Cohesion;
  }
  return material;
}

//------------------------------------------------------------------------------
rockfall::Terrain vtkDEMToCFESource::ReadSlope(
  std::vector<std::string>& notes, bool& contours) const
{
  rockfall::ContourOptions lines;
  lines.cellSize = this->CellSize;
  lines.elevationField = this->ElevationField;
  lines.relaxFlats = this->RelaxFlats != 0;
  rockfall::RasterOptions raster;
  raster.cellSize = this->CellSize;
  raster.band = this->Band;
  rockfall::RasterSurface surface =
    rockfall::readSlope(this->FileName, this->LayerName, raster, lines);
  contours = surface.contours;
  notes = std::move(surface.notes);
  return rockfall::Terrain(std::move(surface.geometry), std::move(surface.heights));
}

//------------------------------------------------------------------------------
void vtkDEMToCFESource::SetMaximumDisplayCells(vtkIdType cells)
{
  if (cells != this->MaximumDisplayCells)
  {
    const bool read = this->SlopeTime == this->GetMTime();
    this->MaximumDisplayCells = cells;
    this->Modified();
    this->SlopeTime = read ? this->GetMTime() : 0; // the slope is still that of the properties
  }
}

//------------------------------------------------------------------------------
std::shared_ptr<const rockfall::Terrain> vtkDEMToCFESource::MakeSlope(
  std::vector<std::string>& notes)
{
  if (this->Slope && this->SlopeTime == this->GetMTime())
  {
    notes = this->SlopeNotes;
    return this->Slope;
  }
  this->Slope.reset();
  const rockfall::AllowReferences references(this->AllowReferences != 0);
  const rockfall::SurfaceMaterial material = this->MakeMaterial();
  material.validate();
  rockfall::Roughness roughness;
  roughness.mean = this->RoughnessMean;
  roughness.deviation = this->RoughnessDeviation;
  roughness.length = this->RoughnessLength;
  roughness.obstacles = { this->ObstacleHeight70, this->ObstacleHeight20, this->ObstacleHeight10 };
  roughness.validate();
  if (this->Preset > 0)
  {
    roughness = rockfall::groundPresets()[std::size_t(this->Preset) - 1].roughness;
  }
  rockfall::require(this->CellSize >= 0.0, "CellSize", this->CellSize, " m", "0 or positive");
  bool contours = false;
  rockfall::Terrain slope = this->FileName.empty()
    ? rockfall::makeBiplanarSlope(this->CellSize > 0.0 ? this->CellSize : testSlopeCellSize)
    : this->ReadSlope(notes, contours);
  slope = rockfall::Terrain(slope, material, roughness);
  slope.setDiagonal(rockfall::cellDiagonalFrom(this->CellDiagonal));
  const rockfall::DeviationPer chosen = rockfall::deviationPerFrom(this->DeviationPer);
  slope.setDeviationPer(this->Preset > 0
      ? rockfall::groundPresets()[std::size_t(this->Preset) - 1].deviationPer()
      : chosen);
  this->UpdateProgress(0.6);
  slope.setRestitutionClasses(readGround(rockfall::GroundKind::Restitution,
    { this->RestitutionLayer, this->RestitutionTable, this->RestitutionField,
      this->RestitutionLayerName, this->RestitutionTableSheet, this->JointTable.empty() },
    slope, notes));
  slope.setJointClasses(readGround(rockfall::GroundKind::Joint,
    { this->JointLayer, this->JointTable, this->JointField, this->JointLayerName,
      this->JointTableSheet, this->RestitutionTable.empty() },
    slope, notes));
  slope.setStructures(
    readStructures({ this->EmbankmentFile, this->TreeFile, this->BarrierFile, this->TreesBreak != 0,
                     this->EmbankmentLayerName, this->TreeLayerName, this->BarrierLayerName },
      slope, notes, readStandRaster(this->TreeFile, slope, notes)));
  askAfterGround(slope, notes);
  if (this->Preset > 0)
  {
    rockfall::groundPresets()[std::size_t(this->Preset) - 1].warn(notes);
  }
  std::ranges::move(this->IdleNotes(contours), std::back_inserter(notes));
  if (this->Preset == 0 && !material.yielding.yields() && slope.restitutionClasses().count() == 0)
  {
    notes.emplace_back(
      "The ground is bare rock, for comparison with published DDA: on it rocks walk "
      "on for minutes. Choose a Preset for ground that yields");
  }
  this->Slope = std::make_shared<const rockfall::Terrain>(std::move(slope));
  this->SlopeNotes = notes;
  this->SlopeTime = this->GetMTime();
  return this->Slope;
}

//------------------------------------------------------------------------------
int vtkDEMToCFESource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  try
  {
    const rockfall::filters::HeardAbort heard(this);
    rockfall::require(this->MaximumDisplayCells >= 2, "MaximumDisplayCells",
      double(this->MaximumDisplayCells), "", "at least 2");

    std::vector<std::string> notes;
    const std::shared_ptr<const rockfall::Terrain> terrain = this->MakeSlope(notes);
    rockfall::stayWanted();

    const int stride = rockfall::filters::displayStride(*terrain, this->MaximumDisplayCells);
    if (stride > 1)
    {
      notes.push_back("The mesh shows one node in " + std::to_string(stride) +
        " each way, because all " + std::to_string(terrain->cfeCapacity()) +
        " CFEs would be more than Maximum Display Cells; the simulation uses every node");
    }
    vtkNew<vtkPolyData> structures;
    const int trees =
      rockfall::filters::makeStructureMesh(*terrain, this->MaximumDisplayCells, structures);
    if (trees > 1)
    {
      notes.push_back("One tree in " + std::to_string(trees) +
        " is shown, because all would be more than Maximum Display Cells; the simulation uses all");
    }
    vtkNew<vtkPolyData> mesh;
    rockfall::filters::makeTerrainMesh(*terrain, stride, mesh);
    rockfall::filters::writeTerrain(terrain, stride, mesh->GetFieldData());
    const auto kept = rockfall::filters::addArray<vtkStringArray>(mesh->GetFieldData(), "Notes");
    for (const std::string& note : notes)
    {
      // A note on a layer or a table begins with its name.
      const std::string* files[] = { &this->EmbankmentFile, &this->TreeFile, &this->BarrierFile,
        &this->RestitutionLayer, &this->RestitutionTable, &this->JointLayer, &this->JointTable };
      const bool named = std::any_of(std::begin(files), std::end(files),
        [&](const std::string* file) { return !file->empty() && note.starts_with(*file); });
      rockfall::filters::showNote(
        named ? note : (this->FileName.empty() ? "DEM to CFE Mesh" : this->FileName) + ": " + note);
      kept->InsertNextValue(note);
    }
    rockfall::filters::addArray<vtkStringArray>(mesh->GetFieldData(), groundName)
      ->InsertNextValue(
        rockfall::groundTitle(this->Preset, terrain->material(), terrain->restitutionClasses()));
    rockfall::filters::copyCoordinateSystem(mesh->GetFieldData(), structures->GetFieldData());
    vtkPolyData::GetData(outputVector, 1)->ShallowCopy(structures);
    rockfall::filters::rememberRanges(mesh);
    output->ShallowCopy(mesh);
    return 1;
  }
  catch (const rockfall::Aborted&)
  {
    return rockfall::filters::giveUp(this);
  }
  catch (const rockfall::Error& error)
  {
    // Messages of the terrain itself do not know the file.
    std::string message = error.what();
    const auto names = [&](const std::string& file)
    { return !file.empty() && message.find(file) != std::string::npos; };
    if (!this->FileName.empty() && !names(this->FileName) && !names(this->RestitutionLayer) &&
      !names(this->RestitutionTable) && !names(this->JointLayer) && !names(this->JointTable) &&
      !names(this->EmbankmentFile) && !names(this->TreeFile) && !names(this->BarrierFile))
    {
      message = this->FileName + ": " + message;
    }
    return rockfall::filters::fail(this, message);
  }
  catch (...)
  {
    return rockfall::filters::fail(this,
      rockfall::filters::reasonOf((this->FileName.empty() ? "The test slope" : this->FileName) +
        " at a cell size of " + rockfall::numberText(this->CellSize) +
        " m (0: its own) does not fit in memory"));
  }
}

//------------------------------------------------------------------------------
void vtkDEMToCFESource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName.empty() ? "(none)" : this->FileName) << "\n";
  os << indent << "LayerName: " << this->LayerName << "\n";
  os << indent << "RestitutionLayerName: " << this->RestitutionLayerName << "\n";
  os << indent << "RestitutionTableSheet: " << this->RestitutionTableSheet << "\n";
  os << indent << "JointLayerName: " << this->JointLayerName << "\n";
  os << indent << "JointTableSheet: " << this->JointTableSheet << "\n";
  os << indent << "EmbankmentLayerName: " << this->EmbankmentLayerName << "\n";
  os << indent << "TreeLayerName: " << this->TreeLayerName << "\n";
  os << indent << "BarrierLayerName: " << this->BarrierLayerName << "\n";
  os << indent << "CellSize: " << this->CellSize << "\n";
  os << indent << "CellDiagonal: " << this->CellDiagonal << "\n";
  os << indent << "Band: " << this->Band << "\n";
  os << indent << "ElevationField: " << this->ElevationField << "\n";
  os << indent << "RelaxFlats: " << this->RelaxFlats << "\n";
  os << indent << "AllowReferences: " << this->AllowReferences << "\n";
  os << indent << "Preset: " << this->Preset << "\n";
  os << indent << "RestitutionLayer: " << this->RestitutionLayer << "\n";
  os << indent << "RestitutionTable: " << this->RestitutionTable << "\n";
  os << indent << "RestitutionField: " << this->RestitutionField << "\n";
  os << indent << "JointLayer: " << this->JointLayer << "\n";
  os << indent << "JointTable: " << this->JointTable << "\n";
  os << indent << "JointField: " << this->JointField << "\n";
  os << indent << "EmbankmentFile: " << this->EmbankmentFile << "\n";
  os << indent << "TreeFile: " << this->TreeFile << "\n";
  os << indent << "TreesBreak: " << this->TreesBreak << "\n";
  os << indent << "BarrierFile: " << this->BarrierFile << "\n";
  os << indent << "RestitutionModel: " << this->RestitutionModel << "\n";
  os << indent << "RestitutionCoefficient: " << this->RestitutionCoefficient << "\n";
  os << indent << "RestitutionDeviation: " << this->RestitutionDeviation << "\n";
  os << indent << "TangentialRestitution: " << this->TangentialRestitution << "\n";
  os << indent << "RestitutionSpeed: " << this->RestitutionSpeed << "\n";
  os << indent << "GroundModulus: " << this->GroundModulus << "\n";
  os << indent << "ScarDepthFactor: " << this->ScarDepthFactor << "\n";
  os << indent << "GroundDensity: " << this->GroundDensity << "\n";
  os << indent << "ScarCompaction: " << this->ScarCompaction << "\n";
  os << indent << "ScarSpinDrag: " << this->ScarSpinDrag << "\n";
  os << indent << "SlipFrictionMin: " << this->SlipFrictionMin << "\n";
  os << indent << "SlipFrictionMax: " << this->SlipFrictionMax << "\n";
  os << indent << "SlipFrictionGrowth: " << this->SlipFrictionGrowth << "\n";
  os << indent << "SlipFrictionDecay: " << this->SlipFrictionDecay << "\n";
  os << indent << "RollingResistance: " << this->RollingResistance << "\n";
  os << indent << "GroundDeviation: " << this->GroundDeviation << "\n";
  os << indent << "GroundDeviationLength: " << this->GroundDeviationLength << "\n";
  os << indent << "ScarRadius: " << this->ScarRadius << "\n";
  os << indent << "FrictionAngle: " << this->FrictionAngle << "\n";
  os << indent << "FrictionAngleDeviation: " << this->FrictionAngleDeviation << "\n";
  os << indent << "Cohesion: " << this->Cohesion << "\n";
  os << indent << "RoughnessMean: " << this->RoughnessMean << "\n";
  os << indent << "RoughnessDeviation: " << this->RoughnessDeviation << "\n";
  os << indent << "RoughnessLength: " << this->RoughnessLength << "\n";
  os << indent << "ObstacleHeight70: " << this->ObstacleHeight70 << "\n";
  os << indent << "ObstacleHeight20: " << this->ObstacleHeight20 << "\n";
  os << indent << "ObstacleHeight10: " << this->ObstacleHeight10 << "\n";
  os << indent << "DeviationPer: " << this->DeviationPer << "\n";
  os << indent << "MaximumDisplayCells: " << this->MaximumDisplayCells << "\n";
}
