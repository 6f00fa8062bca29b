#include "shared/errorReport.h"

#include "base/text/numberText.h"
#include "shared/arrays.h"
#include "shared/streamingPieces.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkOutputWindow.h"
#include "vtkStringArray.h"

#include <algorithm>

namespace rockfall::filters
{

namespace
{

constexpr char errorName[] = "Error", notesName[] = "Notes";

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

std::vector<std::string> notesOf(vtkFieldData* fieldData)
{
  std::vector<std::string> notes;
  auto* kept = vtkStringArray::SafeDownCast(fieldData->GetAbstractArray(notesName));
  for (vtkIdType k = 0; kept && k < kept->GetNumberOfValues(); ++k)
  {
    notes.push_back(kept->GetValue(k));
  }
  return notes;
}

void keepNotes(const std::vector<std::string>& notes, vtkFieldData* fieldData)
{
  std::vector<std::string> all = notesOf(fieldData);
  for (const std::string& note : notes)
  {
    if (std::ranges::find(all, note) == all.end())
    {
      all.push_back(note);
    }
  }
  if (!notes.empty())
  {
    fieldData->RemoveArray(notesName);
    addTexts(fieldData, notesName, all);
  }
}

void showNotes(const std::vector<std::string>& notes, vtkFieldData* fieldData)
{
  std::ranges::for_each(notes, showNote);
  keepNotes(notes, fieldData);
}

std::vector<std::string> IdleProperties::notes() const
{
  std::vector<std::string> notes;
  for (const Note& note : notes_)
  {
    notes.push_back(note.text + (note.properties.empty() ? "" : ": " + note.properties));
  }
  return notes;
}

std::string IdleProperties::textOf(bool on)
{
  return on ? "on" : "off";
}

std::string IdleProperties::textOf(int number)
{
  return std::to_string(number);
}

std::string IdleProperties::textOf(double number)
{
  return numberText(number);
}

std::string IdleProperties::textOf(const Vec3& numbers)
{
  return numberText(numbers.x()) + ", " + numberText(numbers.y()) + ", " + numberText(numbers.z());
}

std::string IdleProperties::textOf(const std::string& text)
{
  return "\"" + text + "\"";
}

void IdleProperties::tellTo(const std::string& cause, const char* name)
{
  const auto same = std::ranges::find(notes_, cause, &Note::text);
  if (same == notes_.end())
  {
    notes_.push_back({ cause, name });
    return;
  }
  same->properties += std::string(", ") + name;
}

} // namespace rockfall::filters
