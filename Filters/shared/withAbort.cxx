#include "shared/withAbort.h"

#include "base/errors.h"
#include "shared/errorReport.h"
#include "shared/streamingPieces.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"

#include <new>

namespace rockfall::filters
{

namespace
{

bool isWanted(vtkAlgorithm* algorithm)
{
  if (!isFurtherRank())
  {
    algorithm->UpdateProgress(algorithm->GetProgress());
  }
  return !algorithm->CheckAbort();
}

} // namespace

HeardAbort::HeardAbort(vtkAlgorithm* algorithm)
  : scope_([algorithm] { return isWanted(algorithm); })
{
}

std::string reasonOf(const std::string& noMemory)
{
  try
  {
    throw;
  }
  catch (const Error& error)
  {
    return error.what();
  }
  catch (const std::bad_alloc&)
  {
    return noMemory;
  }
  catch (const std::length_error&)
  {
    return noMemory; // of a container that could never be so long
  }
  catch (const std::exception& error)
  {
    return std::string("An error of the program, please report it: ") + error.what();
  }
  catch (...)
  {
    return "An error of the program, please report it";
  }
}

int giveUp(vtkAlgorithm* algorithm)
{
  for (int port = 0; port < algorithm->GetNumberOfOutputPorts(); ++port)
  {
    if (vtkDataObject* output = algorithm->GetOutputDataObject(port))
    {
      output->Initialize();
    }
  }
  algorithm->SetAbortOutput(true);
  return 1;
}

int withAbort(
  vtkAlgorithm* algorithm, const std::string& noMemory, const std::function<int()>& work)
{
  try
  {
    const HeardAbort heard(algorithm);
    return work();
  }
  catch (const Aborted&)
  {
    return giveUp(algorithm);
  }
  catch (...)
  {
    return fail(algorithm, reasonOf(noMemory));
  }
}

} // namespace rockfall::filters
