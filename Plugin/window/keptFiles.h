#pragma once

/// @file
/// Files that a saved state names.

class pqPipelineSource;

namespace rockfall::window
{

/// Load State with "Only Use Files In Data Directory" empties the fields whose files it misses, and a
/// slope without a file is the test slope. States therefore keep the names a second time, as
/// annotations: an emptied field gets its name back, and its source says that the file is not there.
void keepFiles(pqPipelineSource* source);

} // namespace rockfall::window
