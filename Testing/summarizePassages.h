#pragma once

/// @file
/// Cells of a raster or of files, summed up one after the other.

#include "statistics/HazardRaster.h"
#include "statistics/passageFile.h"

namespace rockfall::testing
{

/// Calls `use` for each cell that anything passed, in the order of cells. Throws DataError if a rock
/// was added twice for an iteration.
inline void summarize(HazardRaster& raster, const UseCell& use)
{
  CellSummarizer summarizer(raster.releases(), use);
  for (const Passage& passage : raster.sorted())
  {
    summarizer.add(passage);
  }
  summarizer.finish();
}

/// The same of all passages of some files. Throws FileError, too.
inline void summarize(const PassageFiles& files, const UseCell& use)
{
  CellSummarizer summarizer(files.releases(), use);
  files.forEach([&summarizer](const Passage& passage) { summarizer.add(passage); });
  summarizer.finish();
}

} // namespace rockfall::testing
