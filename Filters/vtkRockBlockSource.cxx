#include "vtkRockBlockSource.h"

#include "base/errors.h"
#include "failure.h"
#include "rockMaker.h"
#include "terrainFieldData.h"

#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <new>

vtkStandardNewMacro(vtkRockBlockSource);

namespace
{

rockfall::Vec3 vec3(const double v[3])
{
  return { v[0], v[1], v[2] };
}

} // namespace

//------------------------------------------------------------------------------
vtkRockBlockSource::vtkRockBlockSource()
{
  this->SetNumberOfInputPorts(0);
}

//------------------------------------------------------------------------------
vtkRockBlockSource::~vtkRockBlockSource() = default;

//------------------------------------------------------------------------------
int vtkRockBlockSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  try
  {
    rockfall::filters::RockDefaults defaults;
    rockfall::shapeName(rockfall::Shape(this->Shape)); // throws if there is no such shape
    defaults.shape = rockfall::Shape(this->Shape);
    defaults.volume = this->Volume;
    defaults.lengths = vec3(this->Lengths);
    defaults.orientation = vec3(this->Orientation);
    defaults.velocity = vec3(this->Velocity);
    defaults.angularVelocity = vec3(this->AngularVelocity);
    defaults.density = this->Density;
    defaults.youngModulus = this->YoungModulus;
    defaults.poissonRatio = this->PoissonRatio;
    defaults.shapeFile = this->ShapeFileName;
    if (this->ShapeFileMode != CONVEX_HULL && this->ShapeFileMode != AS_IT_IS)
    {
      throw rockfall::ParameterError("ShapeFileMode is " + std::to_string(this->ShapeFileMode) +
        ", it must be 0 (convex hull) or 1 (as it is)");
    }
    defaults.shapeFileAsItIs = this->ShapeFileMode == AS_IT_IS;
    defaults.scaleToVolume = this->ScaleToVolume;

    std::vector<rockfall::SourceRow> rows;
    std::string crs;
    if (this->FileName.empty())
    {
      crs = rockfall::wktOfCrs(this->TargetCRS);
      rows.emplace_back().position = vec3(this->Center);
    }
    else
    {
      rows = rockfall::readSources(this->FileName, this->TargetCRS, &crs);
    }

    rockfall::filters::RockMaker maker(defaults);
    std::vector<rockfall::filters::ReleasedRock> rocks;
    for (const rockfall::SourceRow& row : rows)
    {
      const vtkIdType blockId = this->FirstBlockId + vtkIdType(rocks.size());
      try
      {
        rocks.push_back(maker.make(row, blockId));
      }
      catch (const rockfall::ParameterError& error)
      {
        // The row is what the user can find again; the block's number is not.
        throw rockfall::ParameterError(
          (this->FileName.empty() ? std::string()
                                  : this->FileName + ", row " + std::to_string(row.row) + ": ") +
          error.what());
      }
    }
    vtkNew<vtkPolyData> blocks;
    rockfall::filters::writeRocks(rocks, blocks);
    rockfall::filters::writeCrs(crs, blocks->GetFieldData());
    for (const std::string& note : maker.notes())
    {
      rockfall::filters::showNote(note);
    }
    output->ShallowCopy(blocks);
    return 1;
  }
  catch (const rockfall::Error& error)
  {
    return rockfall::filters::fail(this, error.what());
  }
  catch (const std::bad_alloc&)
  {
    return rockfall::filters::fail(this, "The rock blocks do not fit in memory");
  }
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto printVector = [&](const char* name, const double v[3])
  { os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << "\n"; };
  os << indent << "Shape: " << this->Shape << "\n";
  os << indent << "Volume: " << this->Volume << "\n";
  printVector("Lengths", this->Lengths);
  os << indent
     << "ShapeFileName: " << (this->ShapeFileName.empty() ? "(none)" : this->ShapeFileName) << "\n";
  os << indent << "ShapeFileMode: " << this->ShapeFileMode << "\n";
  os << indent << "ScaleToVolume: " << this->ScaleToVolume << "\n";
  printVector("Center", this->Center);
  printVector("Orientation", this->Orientation);
  printVector("Velocity", this->Velocity);
  printVector("AngularVelocity", this->AngularVelocity);
  os << indent << "Density: " << this->Density << "\n";
  os << indent << "YoungModulus: " << this->YoungModulus << "\n";
  os << indent << "PoissonRatio: " << this->PoissonRatio << "\n";
  os << indent << "FileName: " << (this->FileName.empty() ? "(none)" : this->FileName) << "\n";
  os << indent << "TargetCRS: " << (this->TargetCRS.empty() ? "(none)" : this->TargetCRS) << "\n";
  os << indent << "FirstBlockId: " << this->FirstBlockId << "\n";
}
