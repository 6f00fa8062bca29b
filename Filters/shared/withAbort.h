#pragma once

/// @file
/// Work of a filter that may fail, take long, and be given up.

#include "base/abort.h"

#include <functional>
#include <string>

class vtkAlgorithm;

namespace rockfall::filters
{

/// While it lives, the loops of the Core on this thread (base/abort.h) hear that the algorithm is
/// to abort. Some times a second they tell its progress, by which ParaView passes an abort on.
class HeardAbort
{
public:
  explicit HeardAbort(vtkAlgorithm* algorithm);

private:
  AbortScope scope_;
};

/// The message of the exception that is being handled, of whatever type: `noMemory` where what was
/// to be made was too large. For a handler of all exceptions: one that passes would end ParaView.
std::string reasonOf(const std::string& noMemory);

/// Empties every output of what was given up and marks it as aborted. Returns 1, to be returned
/// from RequestData.
int giveUp(vtkAlgorithm* algorithm);

/// RequestData's work, which returns what RequestData is to return. Aborted
/// becomes empty outputs, any other exception the algorithm's one error (reasonOf).
int withAbort(
  vtkAlgorithm* algorithm, const std::string& noMemory, const std::function<int()>& work);

} // namespace rockfall::filters
