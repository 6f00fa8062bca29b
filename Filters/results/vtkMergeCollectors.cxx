#include "vtkMergeCollectors.h"

#include "base/errors.h"
#include "counts/lostRocks.h"
#include "results/collectorOutputs.h"
#include "results/mergedCrossings.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/streamingPieces.h"
#include "shared/terrainFieldData.h"
#include "shared/withAbort.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <iterator>
#include <vector>

vtkStandardNewMacro(vtkMergeCollectors);

//------------------------------------------------------------------------------
vtkMergeCollectors::vtkMergeCollectors()
{
  this->SetNumberOfOutputPorts(3);
}

//------------------------------------------------------------------------------
vtkMergeCollectors::~vtkMergeCollectors() = default;

//------------------------------------------------------------------------------
int vtkMergeCollectors::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkMergeCollectors::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkPolyData" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMergeCollectors::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  namespace filters = rockfall::filters;
  if (filters::isFurtherPiece(outputVector))
  {
    return 1;
  }
  return filters::withAbort(this, "The merged crossings do not fit in memory",
    [&]
    {
      // The parts of composite data are as good as inputs of their own.
      std::vector<vtkPolyData*> inputs;
      for (int k = 0; k < inputVector[0]->GetNumberOfInformationObjects(); ++k)
      {
        for (vtkDataObject* part : filters::leavesOf(vtkDataObject::GetData(inputVector[0], k)))
        {
          filters::Input taken(filters::InputKind::Crossings, int(inputs.size()) + 1);
          inputs.push_back(taken.take(part));
          taken.require();
          if (filters::inheritFailure(inputs.back(), this))
          {
            return 1;
          }
        }
      }
      if (inputs.empty())
      {
        throw rockfall::DataError("The Input is empty");
      }
      // New ones: the outputs already have the field data of the first input.
      vtkNew<vtkPolyData> points;
      const filters::MergedCrossings merged = filters::mergeCrossings(inputs, points);
      std::vector<rockfall::LineSummary> summaries;
      const auto released = std::int64_t(merged.released.size());
      for (std::size_t k = 0; k < merged.lines.size(); ++k)
      {
        summaries.push_back(
          rockfall::summarizeLine(merged.lines[k], int(k), merged.crossings, released));
      }
      vtkNew<vtkTable> table, exceedance;
      const std::vector<rockfall::LostRocks> lost =
        filters::lostBefore(merged.lines.size(), merged.crossings, merged.released);
      std::vector<std::string> notes = merged.notes;
      std::ranges::move(
        filters::lineNotes(summaries, merged.lines, lost, merged.releases.weights()),
        std::back_inserter(notes));
      filters::writeLines(summaries, merged.lines, lost, table);
      vtkFieldData* const told[] = { table->GetFieldData(), points->GetFieldData() };
      filters::tellOn(told, notes);
      filters::writeExceedance(summaries, released, exceedance);
      for (vtkTable* made : { table.Get(), exceedance.Get() })
      {
        filters::copyCoordinateSystem(points->GetFieldData(), made->GetFieldData());
      }
      vtkPolyData::GetData(outputVector, 0)->ShallowCopy(points);
      vtkTable::GetData(outputVector, 1)->ShallowCopy(table);
      vtkTable::GetData(outputVector, 2)->ShallowCopy(exceedance);
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkMergeCollectors::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
