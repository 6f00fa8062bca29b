#pragma once

/// @file
/// How a filter tells its user what is wrong, and what was done.

#include <string>
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

/// Shows each, and keeps them in the field array Notes of an output if there are any.
void showNotes(const std::vector<std::string>& notes, vtkFieldData* fieldData);

} // namespace rockfall::filters
