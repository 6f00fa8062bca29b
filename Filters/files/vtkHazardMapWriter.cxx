#include "vtkHazardMapWriter.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "files/layerStyles.h"
#include "gis/raster/rasterWriter.h"
#include "shared/coordinateFieldData.h"
#include "shared/inputs.h"
#include "shared/streamingPieces.h"
#include "shared/withAbort.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkErrorCode.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkHazardMapWriter);

namespace
{

/// What a reader of the file has to know of the map: numbers, as its thresholds and the rocks that
/// were lost, and notes.
std::vector<std::pair<std::string, std::string>> statementsOf(vtkFieldData* fields)
{
  std::vector<std::pair<std::string, std::string>> statements;
  for (int k = 0; k < fields->GetNumberOfArrays(); ++k)
  {
    vtkAbstractArray* array = fields->GetAbstractArray(k);
    const std::string name = array->GetName() ? array->GetName() : "";
    if (auto* notes = vtkStringArray::SafeDownCast(array); notes && name == "Notes")
    {
      for (vtkIdType n = 0; n < notes->GetNumberOfValues(); ++n)
      {
        statements.emplace_back("Note " + std::to_string(n + 1), notes->GetValue(n));
      }
    }
    auto* number = vtkDataArray::SafeDownCast(array);
    if (number && number->GetNumberOfValues() == 1 && !name.empty() && !name.starts_with("Terrain"))
    {
      statements.emplace_back(name, rockfall::numberText(number->GetTuple1(0), 15));
    }
  }
  return statements;
}

rockfall::MapImage mapOf(vtkImageData* image)
{
  vtkDataArray* marker = image->GetFieldData()->GetArray("HazardMap");
  if (!marker || marker->GetNumberOfValues() != 7)
  {
    throw rockfall::DataError("The Input is no hazard map: its field data has no array HazardMap "
                              "of 7 numbers, as Rockfall Hazard Map makes it");
  }
  int extent[6];
  double origin[3], spacing[3];
  image->GetExtent(extent);
  image->GetOrigin(origin);
  image->GetSpacing(spacing);
  rockfall::filters::checkTuples(
    image->GetCellData(), image->GetNumberOfCells(), "The Input", "cell");
  rockfall::MapImage map;
  map.columns = extent[1] - extent[0];
  map.rows = extent[3] - extent[2];
  if (std::abs(spacing[1] - spacing[0]) > 1e-6 * spacing[0])
  {
    throw rockfall::DataError("The Input has cells of " + rockfall::numberText(spacing[0]) + " x " +
      rockfall::numberText(spacing[1]) + " m; those of a map are square");
  }
  map.cellSize = spacing[0];
  map.west = origin[0] + extent[0] * spacing[0];
  map.south = origin[1] + extent[2] * spacing[1];
  map.crs = rockfall::filters::readCrs(image->GetFieldData());
  map.metadata.emplace_back(
    "Trajectories", std::to_string(std::int64_t(marker->GetComponent(0, 5))));
  std::ranges::move(statementsOf(image->GetFieldData()), std::back_inserter(map.metadata));
  vtkCellData* cells = image->GetCellData();
  for (int k = 0; k < cells->GetNumberOfArrays(); ++k)
  {
    vtkDataArray* array = cells->GetArray(k);
    if (!array || array->GetNumberOfComponents() != 1 || !array->GetName() ||
      vtkDataSetAttributes::GhostArrayName() == std::string_view(array->GetName()))
    {
      continue;
    }
    rockfall::MapBand& band = map.bands.emplace_back();
    band.name = array->GetName();
    band.unit = rockfall::filters::unitOf(band.name);
    band.fill = [array, columns = map.columns](int row, std::span<float> values)
    {
      const vtkIdType first = vtkIdType(row) * columns;
      const auto take = [&](auto* numbers)
      {
        const auto* from = numbers->GetPointer(first);
        std::copy(from, from + values.size(), values.begin());
      };
      if (auto* floats = vtkFloatArray::SafeDownCast(array))
      {
        take(floats); // a call for each of 10⁸ values takes as long as the rest of the file
      }
      else if (auto* counts = vtkIntArray::SafeDownCast(array))
      {
        take(counts);
      }
      else
      {
        for (std::size_t c = 0; c < values.size(); ++c)
        {
          values[c] = float(array->GetTuple1(first + vtkIdType(c)));
        }
      }
    };
  }
  return map;
}

} // namespace

//------------------------------------------------------------------------------
vtkHazardMapWriter::vtkHazardMapWriter() = default;

//------------------------------------------------------------------------------
vtkHazardMapWriter::~vtkHazardMapWriter() = default;

//------------------------------------------------------------------------------
int vtkHazardMapWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkHazardMapWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  rockfall::filters::requestOwnPieces(request, inputs, 1);
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

//------------------------------------------------------------------------------
void vtkHazardMapWriter::WriteData()
{
  try
  {
    vtkImageData* image = rockfall::filters::oneImage(this->GetInput(), "The Input");
    if (!image || (image->GetNumberOfCells() == 0 && rockfall::filters::isFurtherRank()))
    {
      return; // the first rank has it all
    }
    rockfall::writeGeoTiff(this->FileName, mapOf(image));
  }
  catch (...)
  {
    this->SetErrorCode(vtkErrorCode::FileFormatError);
    vtkErrorMacro(<< rockfall::filters::reasonOf(
                    this->FileName + ": there is not enough memory to write it"));
  }
}

//------------------------------------------------------------------------------
void vtkHazardMapWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
}
