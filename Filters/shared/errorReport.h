#pragma once

/// @file
/// How a filter tells its user what is wrong, what was done, and what has no effect.

#include "base/types.h"

#include <string>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkFieldData;

namespace rockfall::filters
{

/// Reports `message` as the one error of this execution, empties every output and returns 1, to be
/// returned from RequestData. 0 would stop the pipeline: representations of ParaView would go on
/// showing what was before the error, also when it is mended, other ranks would go on to filters
/// that this one would not reach, and the executive would report a second error for one cause. The
/// message stays in the field array "Error" of the outputs.
int fail(vtkAlgorithm* algorithm, const std::string& message);

/// As fail, for what every rank finds at once: the first one reports it.
int failTogether(vtkAlgorithm* algorithm, const std::string& message);

/// Empties the outputs but for the message, without a report.
void leaveError(vtkAlgorithm* algorithm, const std::string& message);

/// True if `input` is what a failed filter left, and then passes its "Error" on to the outputs: who
/// comes after it must not report its emptiness as another error.
bool inheritFailure(vtkDataObject* input, vtkAlgorithm* algorithm);

/// Shows a line that is neither an error nor a warning, in ParaView's output messages and on the
/// terminal of a batch run.
void showNote(const std::string& note);

/// Notes of an output: its field array Notes.
std::vector<std::string> notesOf(vtkFieldData* fieldData);

/// Keeps notes behind those that are there, each once. An array that other data share stays as it
/// is.
void keepNotes(const std::vector<std::string>& notes, vtkFieldData* fieldData);

/// Shows each, and keeps them.
void showNotes(const std::vector<std::string>& notes, vtkFieldData* fieldData);

/// Properties that a user set and that have no effect on what a filter makes. Only a value other
/// than the usual one is told: who has set nothing hears nothing, and what a window fills in, as the
/// numbers of a preset, is usual too.
class IdleProperties
{
public:
  /// A property by its name in ParaView: "ReleaseHeight is 2 m, but has no effect: `why`".
  template <typename Value>
  void add(const char* name, const Value& value, const Value& usual, const std::string& why,
    const char* unit = "")
  {
    if (value != usual)
    {
      this->tell(std::string(name) + " is " + textOf(value) + unit + ", but has no effect: " + why);
    }
  }

  /// One of several with the same cause: "`cause`: FragmentationEnergy, LeastFragment".
  template <typename Value>
  void addTo(const std::string& cause, const char* name, const Value& value, const Value& usual)
  {
    if (value != usual)
    {
      this->tellTo(cause, name);
    }
  }

  std::vector<std::string> notes() const;

private:
  struct Note
  {
    std::string text;       ///< A note, or a cause.
    std::string properties; ///< That have this cause.
  };

  static std::string textOf(bool on);
  static std::string textOf(int number);
  static std::string textOf(double number);
  static std::string textOf(const Vec3& numbers);
  static std::string textOf(const std::string& text);
  void tell(std::string note) { notes_.push_back({ std::move(note), "" }); }
  void tellTo(const std::string& cause, const char* name);

  std::vector<Note> notes_;
};

} // namespace rockfall::filters
