#include "shared/errorReport.h"

#include "shared/arrays.h"
#include "shared/streamingPieces.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkOutputWindow.h"
#include "vtkStringArray.h"

#include <algorithm>

namespace rockfall::filters
{

namespace
{

constexpr char errorName[] = "Error";

} // namespace

void leaveError(vtkAlgorithm* algorithm, const std::string& message)
{
  for (int port = 0; port < algorithm->GetNumberOfOutputPorts(); ++port)
  {
    if (vtkDataObject* output = algorithm->GetOutputDataObject(port))
    {
      output->Initialize();
      addArray<vtkStringArray>(output->GetFieldData(), errorName)->InsertNextValue(message);
    }
  }
}

int fail(vtkAlgorithm* algorithm, const std::string& message)
{
  vtkErrorWithObjectMacro(algorithm, << message);
  leaveError(algorithm, message);
  return 1;
}

int failTogether(vtkAlgorithm* algorithm, const std::string& message)
{
  if (!isFurtherRank())
  {
    return fail(algorithm, message);
  }
  leaveError(algorithm, message);
  return 1;
}

bool inheritFailure(vtkDataObject* input, vtkAlgorithm* algorithm)
{
  auto* error = vtkStringArray::SafeDownCast(input->GetFieldData()->GetAbstractArray(errorName));
  if (!error || error->GetNumberOfValues() == 0)
  {
    return false;
  }
  leaveError(algorithm, error->GetValue(0));
  return true;
}

void showNote(const std::string& note)
{
  vtkOutputWindowDisplayText((note + "\n").c_str());
}

void showNotes(const std::vector<std::string>& notes, vtkFieldData* fieldData)
{
  std::ranges::for_each(notes, showNote);
  addTexts(fieldData, "Notes", notes);
}

} // namespace rockfall::filters
