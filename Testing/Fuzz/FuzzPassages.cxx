// The reader of files of passages: the header, and the sums over what follows.

#include "base/errors.h"
#include "statistics/passageFile.h"
#include "temporaryFile.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const std::string name = temporaryFile(data, size);
  try
  {
    const rockfall::PassageFiles files({ name });
    const rockfall::UseCell look = [](const rockfall::CellSummary& cell)
    {
      if (!(cell.reach >= 0.0 && cell.reach <= 1.0) || cell.passages < 1)
      {
        __builtin_trap(); // no probability
      }
    };
    rockfall::CellSummarizer summarizer(files.releases(), look);
    files.forEach([&summarizer](const rockfall::Passage& passage) { summarizer.add(passage); });
    summarizer.finish();
  }
  catch (const rockfall::Error&)
  {
    // As it should be.
  }
  return 0;
}
