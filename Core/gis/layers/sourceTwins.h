#pragma once

/// @file
/// Sources that are there twice.

#include "gis/layers/sources.h"

#include <string>
#include <vector>

namespace rockfall::gis
{

/// Notes of rows that release again the rocks of another one at the same place (geometry/twins.h), or
/// over a part of it. Their number and name make no difference.
void tellSourceTwins(
  const std::vector<SourceRow>& rows, const std::string& fileName, std::vector<std::string>& notes);

} // namespace rockfall::gis
