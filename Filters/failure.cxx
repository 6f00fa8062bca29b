#include "failure.h"

#include "arrays.h"
#include "pieces.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkExecutive.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkStringArray.h"

#include <cstring>

namespace rockfall::filters
{

namespace
{

/// Listens to an executive's errors and passes on all but "returned failure for request".
class FailureEcho : public vtkCommand
{
public:
  static FailureEcho* New() { return new FailureEcho; }
  void Execute(vtkObject*, unsigned long, void* data) override
  {
    const char* text = static_cast<const char*>(data);
    if (text && !std::strstr(text, "returned failure for request"))
    {
      vtkOutputWindowDisplayErrorText(text);
    }
  }
};

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
  vtkExecutive* executive = algorithm->GetExecutive();
  if (!executive->HasObserver(vtkCommand::ErrorEvent))
  {
    vtkNew<FailureEcho> echo;
    executive->AddObserver(vtkCommand::ErrorEvent, echo);
  }
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return controller && controller->GetNumberOfProcesses() > 1 ? 1 : 0;
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
  if (notes.empty())
  {
    return;
  }
  const auto kept = addArray<vtkStringArray>(fieldData, "Notes");
  for (const std::string& note : notes)
  {
    showNote(note);
    kept->InsertNextValue(note);
  }
}

} // namespace rockfall::filters
