#include "vtkDrawnStructure.h"

#include "base/hectare.h"
#include "base/require.h"
#include "base/text/numberText.h"
#include "run/releasePlaces.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/streamingPieces.h"
#include "shared/structureFieldData.h"
#include "shared/terrainFieldData.h"
#include "shared/withAbort.h"
#include "sources/drawnSource.h"
#include "terrain/plausible.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

vtkStandardNewMacro(vtkDrawnStructure);

namespace
{

using rockfall::kHectare;
using rockfall::SourceGeometry;
using rockfall::SourceRow;
using rockfall::Structures;
using rockfall::Terrain;

constexpr vtkIdType kMostShown = 4000000; ///< Triangles of stems.

void requirePositive(double value, const char* name, const char* unit, bool zeroToo = false)
{
  if (!(zeroToo ? value >= 0.0 : value > 0.0) || !std::isfinite(value))
  {
    throw rockfall::ParameterError(std::string(name) + " is " + rockfall::numberText(value) + " " +
      unit + ", it must be finite and " + (zeroToo ? "not negative" : "positive"));
  }
}

/// In plan, in the terrain's frame.
std::vector<Eigen::Vector2d> placesOf(const SourceRow& row, const Terrain& terrain)
{
  std::vector<Eigen::Vector2d> places;
  for (const rockfall::Vec3& point : row.parts.front())
  {
    places.push_back((point - terrain.geometry().origin()).head<2>());
  }
  return places;
}

/// Numbers in a layer go on.
template <typename Things>
std::int64_t nextFeature(const Things& things)
{
  std::int64_t last = 0;
  for (const auto& thing : things)
  {
    last = std::max(last, thing.feature);
  }
  return last + 1;
}

} // namespace

//------------------------------------------------------------------------------
vtkDrawnStructure::vtkDrawnStructure()
{
  this->SetNumberOfOutputPorts(2);
}

//------------------------------------------------------------------------------
vtkDrawnStructure::~vtkDrawnStructure() = default;

//------------------------------------------------------------------------------
int vtkDrawnStructure::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  return 1;
}

//------------------------------------------------------------------------------
void vtkDrawnStructure::CheckProperties() const
{
  if (this->Kind < NET || this->Kind > FOREST)
  {
    throw rockfall::ParameterError("Kind is " + std::to_string(this->Kind) +
      ", it must be 0 (net), 1 (embankment) or 2 (forest)");
  }
  requirePositive(this->Height, "Height", "m");
  requirePositive(this->TreeHeight, "TreeHeight", "m");
  requirePositive(this->Capacity, "Capacity", "kJ", true);
  requirePositive(this->Braking, "Braking", "m", true);
  rockfall::require(this->Residual >= 0.0 && this->Residual <= 100.0, "Residual", this->Residual,
    " %", "between 0 and 100");
  requirePositive(this->Fill, "Fill", "m³/m", true);
  requirePositive(this->CrestWidth, "CrestWidth", "m");
  requirePositive(this->SideSlope, "SideSlope", "m across per m down", true);
  requirePositive(this->StemsPerHectare, "StemsPerHectare", "stems");
  requirePositive(this->Diameter, "Diameter", "cm");
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkDrawnStructure::IdleNotes() const
{
  rockfall::filters::IdleProperties idle;
  const vtkNew<vtkDrawnStructure> usual;
  const char* kinds[] = { "net", "embankment", "forest" };
  const std::string cause =
    std::string("The Kind is ") + kinds[this->Kind] + ", which these properties say nothing of";
  const auto tell = [&](const char* name, double vtkDrawnStructure::*value)
  { idle.addTo(cause, name, this->*value, usual->*value); };
  if (this->Kind == FOREST)
  {
    tell("Height", &vtkDrawnStructure::Height);
  }
  else
  {
    tell("StemsPerHectare", &vtkDrawnStructure::StemsPerHectare);
    tell("Diameter", &vtkDrawnStructure::Diameter);
    tell("TreeHeight", &vtkDrawnStructure::TreeHeight);
    idle.addTo(cause, "TreesBreak", this->TreesBreak, usual->TreesBreak);
  }
  if (this->Kind != EMBANKMENT)
  {
    tell("CrestWidth", &vtkDrawnStructure::CrestWidth);
    tell("SideSlope", &vtkDrawnStructure::SideSlope);
  }
  if (this->Kind != NET)
  {
    tell("Capacity", &vtkDrawnStructure::Capacity);
    tell("Braking", &vtkDrawnStructure::Braking);
    idle.addTo(cause, "Wears", this->Wears, usual->Wears);
    tell("Residual", &vtkDrawnStructure::Residual);
    tell("Fill", &vtkDrawnStructure::Fill);
  }
  else if (!this->Wears)
  {
    idle.add("Residual", this->Residual, usual->Residual, "Wears is off", " %");
  }
  return idle.notes();
}

//------------------------------------------------------------------------------
int vtkDrawnStructure::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  namespace filters = rockfall::filters;
  if (filters::isFurtherPiece(outputVector))
  {
    return 1;
  }
  filters::Input taken(filters::InputKind::Terrain);
  vtkPolyData* input = taken.take(inputVector[0]);
  if (!input)
  {
    return filters::fail(this, "The Terrain input is missing");
  }
  if (filters::inheritFailure(input, this))
  {
    return 1;
  }
  return filters::withAbort(this, "The slope with the drawn structure does not fit in memory",
    [&]
    {
      taken.require();
      this->CheckProperties();
      filters::readTerrain(input); // says if it is no slope, or no longer the one it was
      Structures structures = filters::readStructures(input->GetFieldData());
      vtkNew<vtkPolyData> bare;
      for (int k = 0; k < input->GetFieldData()->GetNumberOfArrays(); ++k)
      {
        bare->GetFieldData()->AddArray(input->GetFieldData()->GetAbstractArray(k));
      }
      filters::dropStructures(bare->GetFieldData());
      Terrain slope = filters::readTerrain(bare, false);

      std::vector<std::array<double, 3>> points = filters::drawnPoints(this->Points);
      if (points.empty())
      {
        const std::array<double, 6> placed = filters::middleLine(slope);
        std::copy(placed.begin(), placed.end(), this->PlacedLine);
        points = { { placed[0], placed[1], placed[2] }, { placed[3], placed[4], placed[5] } };
      }
      Structures drawn; // by itself, for notes
      const std::vector<SourceRow> rows = filters::drawnRows(
        this->Kind == FOREST ? SourceGeometry::Polygon : SourceGeometry::Line, points, &slope);
      if (this->Kind == NET)
      {
        rockfall::Barrier net;
        net.feature = nextFeature(structures.barriers);
        net.name = "drawn net";
        net.points = placesOf(rows.front(), slope);
        net.height = this->Height;
        net.capacity = this->Capacity * 1000.0;
        net.braking = this->Braking;
        net.residual = this->Wears ? 0.01 * this->Residual : net.residual;
        net.room = this->Fill > 0.0 ? this->Fill : net.room;
        drawn.barriers = { net };
        structures.barriers.push_back(std::move(net));
      }
      else if (this->Kind == EMBANKMENT)
      {
        rockfall::Embankment dam;
        dam.feature = nextFeature(structures.embankments);
        dam.name = "drawn embankment";
        dam.points = placesOf(rows.front(), slope);
        dam.height = this->Height;
        dam.crestWidth = this->CrestWidth;
        dam.mountainSlope = dam.valleySlope = this->SideSlope;
        drawn.embankments = { dam };
        structures.embankments.push_back(std::move(dam));
      }
      else
      {
        rockfall::ReleaseDefaults density;
        density.intensity = this->StemsPerHectare / kHectare;
        rockfall::Tree tree;
        tree.feature = nextFeature(structures.trees);
        tree.diameter = 0.01 * this->Diameter;
        tree.height = this->TreeHeight;
        if (this->TreesBreak)
        {
          tree.capacity = rockfall::stemCapacity(tree.diameter);
        }
        drawn.trees = { tree };
        for (const rockfall::ReleasePlace& place :
          rockfall::releasePlaces(rows, &slope, density, "Points"))
        {
          tree.position = (place.position - slope.geometry().origin()).head<2>();
          structures.trees.push_back(tree);
          ++tree.feature;
        }
      }
      std::vector<std::string> notes;
      rockfall::askAfterNumbers(drawn, notes);
      if (this->Kind != FOREST) // stems drawn at random may stand side by side
      {
        drawn.barriers = structures.barriers;
        drawn.embankments = structures.embankments;
        rockfall::askAfterTwins(drawn, notes, slope.geometry().origin().head<2>());
      }
      slope.setStructures(std::move(structures));
      const auto terrain = std::make_shared<const Terrain>(std::move(slope));

      vtkPolyData* output = vtkPolyData::GetData(outputVector, 0);
      output->ShallowCopy(input);
      vtkNew<vtkFieldData> fields;
      vtkFieldData* old = bare->GetFieldData();
      for (int k = 0; k < old->GetNumberOfArrays(); ++k)
      {
        fields->AddArray(old->GetAbstractArray(k));
      }
      filters::writeStructures(*terrain, fields);
      std::ranges::move(this->IdleNotes(), std::back_inserter(notes));
      filters::showNotes(notes, fields);
      output->SetFieldData(fields);
      vtkNew<vtkPolyData> shown;
      filters::makeStructureMesh(*terrain, kMostShown, shown);
      filters::copyCoordinateSystem(fields, shown->GetFieldData());
      vtkPolyData::GetData(outputVector, 1)->ShallowCopy(shown);
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkDrawnStructure::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kind: " << this->Kind << "\n";
  os << indent << "Points: " << this->Points.size() / 3 << "\n";
  os << indent << "PlacedLine:";
  for (const double number : this->PlacedLine)
  {
    os << " " << number;
  }
  os << "\n";
  os << indent << "Height: " << this->Height << "\n";
  os << indent << "Capacity: " << this->Capacity << "\n";
  os << indent << "Braking: " << this->Braking << "\n";
  os << indent << "Wears: " << this->Wears << "\n";
  os << indent << "Residual: " << this->Residual << "\n";
  os << indent << "Fill: " << this->Fill << "\n";
  os << indent << "CrestWidth: " << this->CrestWidth << "\n";
  os << indent << "SideSlope: " << this->SideSlope << "\n";
  os << indent << "StemsPerHectare: " << this->StemsPerHectare << "\n";
  os << indent << "Diameter: " << this->Diameter << "\n";
  os << indent << "TreeHeight: " << this->TreeHeight << "\n";
  os << indent << "TreesBreak: " << this->TreesBreak << "\n";
}
